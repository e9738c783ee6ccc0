//! Tools, their lengths and the spindle.

use std::f64::consts::PI;

use post_grammar::{LoadTool, Record, Sense, SpindleUnit, SpindleWord};
use post_machine::description::{NoseRule, ToolLength};

use super::modal::{ClModal, CourseItems, RecordResult};
use crate::{ProgramEvent, SpindleState};

/// No file has more tools.
const MOST_TOOLS: usize = 1_000;

/// A middle of a corner that is no farther from where a plain corner has it is there, units of the file.
const SAME_CORNER: f64 = 1e-4;

/// A tool as the CL file has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClTool {
    /// Its number.
    pub number: u32,
    /// Register of its length: that of the file, else the tool's number.
    pub register: u32,
    /// From the gauge line to the tip, mm, where the file gives it and the machine file lets it count
    /// (`control.tool_length`).
    pub length: Option<f64>,
    /// Diameter of its cutter, mm, where the file describes it before it loads the tool.
    pub diameter: Option<f64>,
    /// Radius of its corner, mm, where the file describes an end that is flat but for it and a side along the axis; else 0.
    pub corner_radius: f64,
    /// Its name, empty if it has none.
    pub name: String,
    /// Line that loads it first.
    pub line: u64,
}

/// The tool in the spindle, and the spindle.
#[derive(Debug, Default)]
pub(super) struct ClTools {
    all: Vec<ClTool>,
    /// Number, register and length (as written) of the tool in the spindle.
    loaded: Option<(u32, u32, Option<f64>)>,
    /// The tool that the file before left in the spindle.
    left: Option<(u32, u32, Option<f64>)>,
    /// The tool of the cutter that was described last, if the file loads none.
    due: Option<u32>,
    /// Cutters in the order of their tools: where their length stands, and their numbers.
    cutters: Vec<(usize, Vec<f64>, String)>,
    /// Of the cutter described last, mm.
    diameter: Option<f64>,
    /// Likewise, for the tool that is loaded next.
    next_diameter: Option<f64>,
    next_corner: f64,
    length: Option<f64>,
    name: String,
    rpm: Option<f64>,
    /// m/min, and the most revolutions a minute.
    surface: Option<(f64, Option<f64>)>,
    counter: bool,
    spindle: SpindleState,
    /// The file said what the spindle does since the tool came.
    said: bool,
}

impl ClTools {
    pub(super) fn all(&self) -> &[ClTool] {
        &self.all
    }

    /// What is known of tools where another file begins.
    pub(super) fn of_next_file(self) -> Self {
        let left = self.loaded.or(self.left);
        Self { all: self.all, cutters: self.cutters, left, ..Self::default() }
    }

    /// Number of the tool in the spindle.
    pub(super) fn loaded(&self) -> Option<u32> {
        self.loaded.map(|(number, ..)| number)
    }

    /// Revolutions a minute, if they are known.
    pub(super) fn rpm(&self) -> Option<f64> {
        self.rpm.filter(|rpm| *rpm > 0.0)
    }

    pub(super) fn spindle(&self) -> SpindleState {
        self.spindle
    }

    /// The tool of the operation that begins.
    pub(super) fn name(&mut self, name: Option<&str>) {
        name.unwrap_or_default().clone_into(&mut self.name);
    }
}

impl ClModal {
    /// TLDATA: diameter, corner radius, length, taper of the side, angle of the end.
    pub(super) fn tool_data(&mut self, kinds: &[String], numbers: &[f64]) -> RecordResult {
        let mill = kinds.iter().any(|kind| kind == "MILL");
        let straight = numbers.iter().skip(3).all(|angle| *angle == 0.0);
        let corner = numbers.get(1).filter(|_| mill && straight);
        self.cutter(numbers, 2, corner.copied())
    }

    /// CUTTER: diameter, corner radius, where its middle is from the axis and above the tip, angles of end and side, length.
    pub(super) fn apt_cutter(&mut self, numbers: &[f64]) -> RecordResult {
        let of = |place: usize| numbers.get(place).copied();
        let corner = of(1).filter(|corner| {
            let plain = [0.5 * numbers[0] - corner, *corner, 0.0, 0.0];
            let told = numbers.iter().skip(2).zip(plain);
            told.into_iter().all(|(told, plain)| libm::fabs(told - plain) <= SAME_CORNER)
        });
        self.cutter(numbers, 6, corner)
    }

    /// A cutter's description; its length stands at `length` among the numbers.
    fn cutter(&mut self, numbers: &[f64], length: usize, corner: Option<f64>) -> RecordResult {
        let of = |place: usize| numbers.get(place).map(|size| size * self.scale);
        let (diameter, length_of) = (of(0), of(length));
        self.tools.diameter = diameter;
        self.tools.next_diameter = diameter;
        self.tools.next_corner = corner.map_or(0.0, |corner| corner * self.scale);
        self.tools.length = length_of;
        if self.settings.tool_from_cutter {
            let cutter = (length, numbers.to_vec(), self.tools.name.clone());
            let known = self.tools.cutters.iter().position(|known| *known == cutter);
            let place = known.unwrap_or(self.tools.cutters.len());
            if known.is_none() && place < MOST_TOOLS {
                self.tools.cutters.push(cutter);
            }
            self.tools.due = u32::try_from(place + 1).ok();
        }
        Ok(())
    }

    /// Loads the tool that the user names, or that belongs to the cutter, ahead of the first record that needs one.
    pub(super) fn load_due(&mut self, record: &Record<'_>, out: &mut CourseItems) -> RecordResult {
        let told = match self.tools.loaded {
            None => self.settings.tool.take(),
            Some(_) => None,
        };
        let Some(number) = told.or(self.tools.due.take()) else {
            return Ok(());
        };
        let tool = LoadTool { number, ..LoadTool::default() };
        self.load(record, &tool, out)
    }

    /// Neither a tool nor the spindle waits for the next move.
    pub(super) fn is_ready(&self) -> bool {
        let loads = self.settings.tool.is_some() && self.tools.loaded.is_none();
        let turns = self.settings.spindle.is_some() && !self.tools.said;
        !loads && self.tools.due.is_none() && !turns
    }

    /// A `LOADTL` of the file, which goes before what the user names.
    pub(super) fn load_read(
        &mut self,
        record: &Record<'_>,
        tool: &LoadTool,
        out: &mut CourseItems,
    ) -> RecordResult {
        if self.strange.catia && tool.described {
            return Ok(());
        }
        self.settings.tool = None;
        self.tools.due = None;
        self.end_spline(record, out)?;
        let mut tool = tool.clone();
        let mut radius = None;
        let some = |register: u32| Some(register).filter(|register| *register > 0);
        if self.strange.mills
            && let Some((register, body)) = tool.of_autodesk()
        {
            self.strange.autodesk = true;
            self.tools.length = Some(body * self.scale);
            tool.register = some(register);
        } else if self.strange.catia
            && let Some(registers) = tool.of_catia()
        {
            [radius, tool.register] = registers.map(some);
        }
        self.load(record, &tool, out)?;
        self.use_register(radius);
        Ok(())
    }

    fn load(
        &mut self,
        record: &Record<'_>,
        tool: &LoadTool,
        out: &mut CourseItems,
    ) -> RecordResult {
        let register = tool.register.unwrap_or(tool.number);
        if tool.number == 0 || register == 0 {
            let message = "tool 0 and length register 0 mean none";
            return Err(self.fault(record, message.to_owned()));
        }
        // NX loads in every operation: the same tool stays in the spindle.
        let loaded = Some((tool.number, register, tool.length));
        if self.tools.loaded == loaded {
            return Ok(());
        }
        let described = match self.settings.tool_length {
            ToolLength::Cl => self.tools.length,
            ToolLength::Assembly => None,
        };
        let length = tool.length.map(|length| length * self.scale);
        self.measured |= tool.length.is_some();
        self.tools.loaded = loaded;
        if let Some(rule) = &self.settings.nose {
            match rule.shift(tool.number) {
                Some(shift) => self.frames.count_by(shift),
                None => return Err(self.fault(record, NoseRule::lack(tool.number)[0].clone())),
            }
        }
        self.tools.said = false;
        if std::mem::take(&mut self.compensated) {
            let (side, register) = (0, None);
            self.tell(record, ProgramEvent::Compensation { side, register }, out);
        }
        self.forget_register();
        let known = self.tools.all.iter().any(|known| known.number == tool.number);
        if !known {
            if self.tools.all.len() >= MOST_TOOLS {
                let message = format!("more than {MOST_TOOLS} tools");
                return Err(self.fault(record, message));
            }
            self.tools.all.push(ClTool {
                number: tool.number,
                register,
                length: length.or(described),
                diameter: self.tools.next_diameter,
                corner_radius: self.tools.next_corner,
                name: self.tools.name.clone(),
                line: record.line,
            });
        }
        (self.tools.next_diameter, self.tools.next_corner) = (None, 0.0);
        self.lost();
        if self.tools.left.take() == loaded {
            return Ok(());
        }
        let name = Some(self.tools.name.clone()).filter(|name| !name.is_empty());
        let number = Some(tool.number);
        self.tell(record, ProgramEvent::ToolChange { number, name }, out);
        Ok(())
    }

    /// The spindle that the user names, ahead of the first point of a tool for which the file has none.
    pub(super) fn spindle_due(&mut self, record: &Record<'_>, out: &mut CourseItems) {
        if self.tools.said {
            return;
        }
        let Some(rpm) = self.settings.spindle else {
            return;
        };
        self.tools.said = true;
        self.tools.rpm = Some(rpm);
        self.turns(record, out);
    }

    /// The spindle turns as is known of it.
    fn turns(&mut self, record: &Record<'_>, out: &mut CourseItems) {
        let rpm = self.tools.rpm.unwrap_or(0.0);
        let spindle = match self.tools.counter {
            true => SpindleState::CounterClockwise(rpm),
            false => SpindleState::Clockwise(rpm),
        };
        self.tools.spindle = spindle;
        self.tell(record, ProgramEvent::Spindle(spindle), out);
    }

    pub(super) fn spindle(
        &mut self,
        record: &Record<'_>,
        word: SpindleWord,
        out: &mut CourseItems,
    ) -> RecordResult {
        self.load_due(record, out)?;
        self.tools.said = true;
        // Autodesk's posts write ON where the spindle stops, and OFF where it starts.
        let on = SpindleWord::On { speed: None, unit: SpindleUnit::Rpm, sense: None, most: None };
        let word = match word {
            SpindleWord::Off if self.strange.autodesk => on,
            word if self.strange.autodesk && word == on => SpindleWord::Off,
            word => word,
        };
        let (speed, unit, sense, most) = match word {
            SpindleWord::Off | SpindleWord::Orient => {
                self.tools.spindle = match word {
                    SpindleWord::Off => SpindleState::Off,
                    _ => SpindleState::Oriented,
                };
                self.tell(record, ProgramEvent::Spindle(self.tools.spindle), out);
                return Ok(());
            }
            SpindleWord::On { speed, unit, sense, most } => (speed, unit, sense, most),
        };
        if let Some(sense) = sense {
            self.tools.counter = sense == Sense::CounterClockwise;
        }
        let metres = match (speed, unit) {
            (Some(speed), SpindleUnit::SurfaceMetric) => Some(speed),
            (Some(speed), SpindleUnit::SurfaceInch) => Some(speed * 0.3048),
            (Some(_), SpindleUnit::Rpm) => None,
            (None, _) => self.tools.surface.map(|(metres, _)| metres),
        };
        if let Some(metres) = metres.filter(|_| self.settings.surface_speed) {
            let most = most.or(self.tools.surface.and_then(|(_, most)| most));
            self.tools.surface = Some((metres, most));
            self.tools.rpm = None;
            let clockwise = !self.tools.counter;
            self.tools.spindle = SpindleState::Surface { speed: metres, most, clockwise };
            self.tell(record, ProgramEvent::Spindle(self.tools.spindle), out);
            return Ok(());
        }
        self.tools.surface = None;
        match (speed, metres) {
            (Some(_), Some(metres)) => {
                let Some(diameter) = self.tools.diameter.filter(|diameter| *diameter > 0.0) else {
                    let message = "a surface speed needs the cutter's diameter";
                    return Err(self.fault(record, message.to_owned()));
                };
                let rpm = metres * 1000.0 / (PI * diameter);
                self.tools.rpm = Some(most.map_or(rpm, |most| rpm.min(most)));
            }
            (Some(rpm), None) => self.tools.rpm = Some(rpm),
            (None, _) => {}
        }
        // CAM systems write 0 where nobody gave a speed.
        self.tools.rpm = self.tools.rpm().or(self.settings.spindle);
        self.turns(record, out);
        Ok(())
    }
}
