//! Tools, cutters, spindle and radius compensation.

use post_grammar::text::excerpt;
use post_grammar::{
    Argument, CoolantWord, Cutcom, CutterSide, LoadTool, Record, Sense, SpindleUnit, SpindleWord,
    WordUsage,
};
use post_plugin::{Compensation, Coolant, Spindle, SpindleSense};

use super::cam_system::CompensatedPoints;
use super::{ClInterpreter, CutterDescription, SHOWN_NAME, StepSink};
use crate::program::limits::{MOST_COORDINATE, MOST_TOOLS};
use crate::program::{Command, ProgramStep, ToolChange};
use post_machine::description::{CompensationOnCentre, NoseRule, ToolLength};
use post_machine::diagnostic::{Diagnostic, Short};

impl ClInterpreter {
    pub(super) fn set_coolant(
        &mut self,
        record: &Record<'_>,
        word: &CoolantWord,
        emit: &mut StepSink<'_>,
    ) {
        let coolant = match word {
            CoolantWord::Off => Coolant::Off,
            CoolantWord::On => self.coolant,
            CoolantWord::Flood => Coolant::Flood,
            CoolantWord::Mist => Coolant::Mist,
            CoolantWord::Through => Coolant::Through,
            CoolantWord::Air => Coolant::Air,
        };
        if coolant != Coolant::Off {
            self.coolant = coolant;
        }
        self.load_told(record, emit);
        emit(ProgramStep::Command(Command::Coolant(coolant)));
    }

    /// Makes a tool ready, unless it is the one that is loaded.
    pub(super) fn select_tool(&self, number: u32, emit: &mut StepSink<'_>) {
        if self.tools.loaded.map(|(loaded, ..)| loaded) != Some(number) {
            emit(ProgramStep::Command(Command::Preselect(number)));
        }
    }

    pub(super) fn spindle(
        &mut self,
        record: &Record<'_>,
        spindle: SpindleWord,
        emit: &mut StepSink<'_>,
    ) {
        self.spindle.said = true;
        self.spindle.may_cut = self.need_not_turn();
        let step = match self.spindle_meant(record, spindle) {
            SpindleWord::Off => Spindle::Off,
            SpindleWord::Orient => Spindle::Orient,
            SpindleWord::On { speed, unit, sense, most } => {
                if let Some(sense) = sense {
                    self.spindle.sense = match sense {
                        Sense::Clockwise => SpindleSense::Clockwise,
                        Sense::CounterClockwise => SpindleSense::CounterClockwise,
                    };
                }
                let kept = match speed {
                    Some(speed) => Some((speed, unit)).filter(|_| unit != SpindleUnit::Rpm),
                    None => self
                        .spindle
                        .surface_speed
                        .map(|(speed, _)| (speed, SpindleUnit::SurfaceMetric)),
                };
                if let Some((speed, unit)) = kept.filter(|_| self.reading.surface_speed) {
                    self.spindle.may_cut = true;
                    self.surface_speed(record, (speed, unit, most), emit);
                    return;
                }
                self.spindle.surface_speed = None;
                if let Some(speed) = speed {
                    let per_minute = match unit {
                        SpindleUnit::Rpm => None,
                        SpindleUnit::SurfaceMetric => Some(speed * 1000.0),
                        SpindleUnit::SurfaceInch => Some(speed * 304.8),
                    };
                    self.spindle.rpm = match (per_minute, self.tools.diameter) {
                        (None, _) => Some(speed),
                        (Some(surface), Some(diameter)) if diameter > 0.0 => {
                            let rpm = surface / (std::f64::consts::PI * diameter);
                            Some(most.map_or(rpm, |most| rpm.min(most)))
                        }
                        _ => {
                            self.spindle.may_cut = true;
                            self.fault(
                                record,
                                "spindle",
                                "a surface speed needs the cutter's diameter".to_owned(),
                                "put a CUTTER or TLDATA before it",
                            );
                            return;
                        }
                    };
                }
                // Whatever is wrong with it, that it does not turn is not said too.
                self.spindle.may_cut = true;
                // CAM systems write 0 where no speed was given.
                self.spindle.rpm =
                    self.spindle.rpm.filter(|rpm| *rpm > 0.0).or(self.reading.spindle.speed());
                let Some(rpm) = self.spindle.rpm else {
                    self.fault(
                        record,
                        "spindle",
                        "the spindle is switched on, and no speed above zero was given".to_owned(),
                        "the CAM system must write one; --spindle RPM is for spindles without one",
                    );
                    return;
                };
                Spindle::On { rpm, sense: self.spindle.sense }
            }
        };
        emit(ProgramStep::Command(Command::Spindle(step)));
    }

    /// Autodesk's stock APT posts stop the spindle by `SPINDL/ON` and start it by `SPINDL/OFF`: the two are exchanged in the
    /// posts' own table.
    fn spindle_meant(&mut self, record: &Record<'_>, spindle: SpindleWord) -> SpindleWord {
        let on = SpindleWord::On { speed: None, unit: SpindleUnit::Rpm, sense: None, most: None };
        let meant = match spindle {
            SpindleWord::Off if self.writer.autodesk => on,
            spindle if self.writer.autodesk && spindle == on => SpindleWord::Off,
            _ => return spindle,
        };
        if !std::mem::replace(&mut self.writer.told_spindle, true) {
            self.warn(
                record,
                "spindle",
                "SPINDL/ON stops the spindle and SPINDL/OFF starts it, as Autodesk's stock APT posts write it".to_owned(),
            );
        }
        meant
    }

    pub(super) fn load(&mut self, record: &Record<'_>, tool: &LoadTool, emit: &mut StepSink<'_>) {
        let register = tool.register.unwrap_or(tool.number);
        if tool.number == 0 || register == 0 {
            self.fault(
                record,
                "tool",
                "tool 0 and length register 0 mean none: the tool's length would not be known"
                    .to_owned(),
                "let the CAM system number its tools from 1",
            );
            return;
        }
        let cutter = match self.reading.tool_length {
            ToolLength::Cl => self.tools.cutter_length,
            ToolLength::Assembly => None,
        };
        let mut length = tool.length.map(|length| length * self.scale).or(cutter);
        if let Some(length) = length.take_if(|length| libm::fabs(*length) > MOST_COORDINATE) {
            self.fault(
                record,
                "tool",
                format!(
                    "a tool of {} mm: none is longer than {MOST_COORDINATE:e} mm",
                    Short(length)
                ),
                "is a decimal point missing, or are the units wrong (--units)?",
            );
        }
        // NX repeats LOAD in every operation; the same tool stays in the spindle.
        let loaded = Some((tool.number, register, tool.length));
        if self.tools.loaded == loaded {
            return;
        }
        self.tools.loaded = loaded;
        self.take_nose(record, tool.number);
        if self.cycles.in_force.is_some() {
            self.warn(
                record,
                "cycle",
                format!(
                    "the cycle before this tool change goes on behind it: tool {} makes a hole at every point until CYCLE/OFF",
                    tool.number
                ),
            );
        }
        self.measured |= tool.length.is_some();
        self.compensation.register = None;
        self.tools.cutter_changed = false;
        self.tools.due = None;
        self.tools.moved = false;
        self.spindle.said = false;
        self.due = true;
        if self.compensation.on {
            self.compensation.on = false;
            emit(ProgramStep::Command(Command::Compensate(Compensation::Off)));
            self.warn(
                record,
                "compensation",
                "the tool is changed with cutter compensation in force; it is switched off"
                    .to_owned(),
            );
        }
        // The cutter of a tool before says nothing of this one.
        let cutter = std::mem::take(&mut self.tools.cutter);
        // The tool comes from the changer: no arc begins where the last one stood.
        self.tip = None;
        if self.left.tool.take() == loaded {
            // The file before had the same: it stays in the spindle.
            return;
        }
        emit(ProgramStep::Command(Command::Tool(ToolChange {
            number: tool.number,
            register,
            length,
            diameter: cutter[0],
            corner_radius: cutter[1],
            name: self.tools.name.clone(),
        })));
    }

    /// The points of the tool that is loaded are others of its nose than the control counts by, if the machine file has it so.
    fn take_nose(&mut self, record: &Record<'_>, number: u32) {
        let Some(rule) = &self.reading.nose else {
            return;
        };
        match rule.shift(number) {
            Some(shift) => self.frame.take_on(shift),
            None => {
                let [message, help] = NoseRule::lack(number);
                self.fault(record, "tool", message, &help);
            }
        }
    }

    /// Loads the tool that the user names or that belongs to the cutter, before the first record that needs one.
    pub(super) fn load_told(&mut self, record: &Record<'_>, emit: &mut StepSink<'_>) {
        let told = match self.tools.loaded {
            None => self.reading.tool.take(),
            Some(_) => None,
        };
        if let Some(number) = told.or(self.tools.due) {
            let tool = LoadTool { number, ..LoadTool::default() };
            self.load(record, &tool, emit);
            self.tools.due = None;
        }
    }

    /// A `LOADTL` of the file.
    pub(super) fn load_read(
        &mut self,
        record: &Record<'_>,
        tool: &LoadTool,
        emit: &mut StepSink<'_>,
    ) {
        if self.writer.catia && tool.described {
            // LOADTL loads it.
            self.count("TOOLNO", record, WordUsage::Ignored);
            return;
        }
        let (tool, radius_register) = self.by_position(tool);
        let tool = &tool;
        self.tools.file_loads = true;
        if self.reading.tool_from_cutter {
            self.fault(
                record,
                "tool",
                "the file loads its tools itself: their numbers are not those of --tool-from-cutter".to_owned(),
                "leave --tool-from-cutter out",
            );
        }
        if let Some(told) = self.reading.tool.take().filter(|told| *told != tool.number) {
            self.fault(
                record,
                "tool",
                format!("the file loads tool {} itself, --tool says {told}", tool.number),
                "leave --tool out: it is for a file that loads none",
            );
        }
        if !tool.rest.is_empty() {
            let rest: Vec<String> = tool
                .rest
                .iter()
                .map(|argument| match argument {
                    Argument::Number(number) => number.to_string(),
                    Argument::Word(word) => word.clone(),
                })
                .collect();
            let message = format!(
                "of this tool change is left out: {}",
                excerpt(&rest.join(", "), SHOWN_NAME)
            );
            self.warn(record, "tool", message);
        }
        self.load(record, tool, emit);
        self.compensation.register = radius_register.or(self.compensation.register);
    }

    /// The tool change with the numbers that its writer has by position, and the register of the cutter's radius.
    fn by_position(&mut self, tool: &LoadTool) -> (LoadTool, Option<u32>) {
        let mut read = tool.clone();
        let some = |register: u32| (register > 0).then_some(register);
        if self.writer.milling
            && let Some((register, body)) = tool.of_autodesk()
        {
            self.writer.autodesk = true;
            read.register = some(register);
            // That of the tool's body is no length from the gauge line.
            self.tools.cutter_length = Some(body * self.scale);
            read.rest.clear();
            return (read, None);
        }
        if self.writer.catia
            && let Some([radius, length]) = tool.of_catia()
        {
            read.register = some(length);
            read.rest.clear();
            return (read, some(radius));
        }
        (read, None)
    }

    /// A cutter's description; `length` is where its length stands.
    pub(super) fn cutter(&mut self, record: &Record<'_>, numbers: &[f64], length: usize) {
        let far = |number: &&f64| libm::fabs(**number * self.scale) > MOST_COORDINATE;
        if let Some(size) = numbers.iter().find(far) {
            let message = format!(
                "a cutter with {}: no size of one is larger than {MOST_COORDINATE:e} mm",
                Short(*size)
            );
            self.fault(record, "cutter", message, "");
            return;
        }
        let cutter =
            CutterDescription { length, numbers: numbers.to_vec(), name: self.tools.name.clone() };
        // Files that load their tools describe the cutter just before or after that.
        let other = self.tools.described.as_ref().is_some_and(|before| {
            if before.length == length {
                before.numbers != cutter.numbers
            } else {
                before.numbers.first() != cutter.numbers.first()
            }
        });
        if self.reading.tool_from_cutter {
            let known = self.tools.cutters.iter().position(|known| *known == cutter);
            let place = known.unwrap_or(self.tools.cutters.len());
            if known.is_none() {
                self.tools.cutters.push(cutter.clone());
            }
            if self.tools.cutters.len() > MOST_TOOLS {
                self.tools.cutters.pop();
                self.fault(
                    record,
                    "tool",
                    format!("more than {MOST_TOOLS} different cutters"),
                    "is this the CL file of one program?",
                );
                return;
            }
            self.tools.due = u32::try_from(place + 1).ok();
        } else {
            self.tools.cutter_changed |= other && self.tools.moved;
        }
        self.due = true;
        self.tools.described = Some(cutter);
        self.tools.diameter = numbers.first().map(|diameter| diameter * self.scale);
        let size = |place: usize| numbers.get(place).map(|size| size * self.scale);
        self.tools.cutter = [size(0), size(1)];
        self.tools.cutter_length = numbers.get(length).map(|length| length * self.scale);
    }

    pub(super) fn cutcom(&mut self, record: &Record<'_>, cutcom: Cutcom, emit: &mut StepSink<'_>) {
        self.load_told(record, emit);
        let side = match cutcom.side {
            Some(CutterSide::Off) => {
                self.compensation.on = false;
                emit(ProgramStep::Command(Command::Compensate(Compensation::Off)));
                return;
            }
            Some(side) => {
                self.compensation.side = Some(side);
                Some(side)
            }
            None => self.compensation.side,
        };
        if let Some(plane @ (0 | 1)) = cutcom.plane {
            let place = self.place(record);
            let name = if plane == 0 { "YZPLAN" } else { "ZXPLAN" };
            self.findings.push(
                Diagnostic::error(
                    "compensation",
                    format!(
                        "CUTCOM in {name}: programs compensate in the plane of X and Y alone (G17)"
                    ),
                )
                .help("let the CAM system write the tool centre path, with CUTCOM/OFF")
                .at(place),
            );
            return;
        }
        self.compensation.register = cutcom.register.or(self.compensation.register);
        let tool = self.tools.loaded.map(|(number, ..)| number);
        let register = self.compensation.register.or(tool).unwrap_or(1);
        self.compensation.on |= matches!(side, Some(CutterSide::Left | CutterSide::Right));
        if side.is_some() {
            self.check_on_centre(record, register);
        }
        match side {
            Some(CutterSide::Left) => {
                emit(ProgramStep::Command(Command::Compensate(Compensation::Left { register })))
            }
            Some(CutterSide::Right) => {
                emit(ProgramStep::Command(Command::Compensate(Compensation::Right { register })))
            }
            // CAMWorks switches it ON first and names the side in the next record.
            Some(CutterSide::Off) | None => {}
        }
    }

    /// Points of the tool's centre are already off the contour by its radius: a register that holds the radius would
    /// add it once more. Reported once a file.
    fn check_on_centre(&mut self, record: &Record<'_>, register: u32) {
        let option = self.reading.compensation_on_centre;
        let (why, presumed) = match self.writer.points() {
            CompensatedPoints::Centre(why) => (why, false),
            CompensatedPoints::Presumed(why) if option != CompensationOnCentre::Contour => {
                (why, true)
            }
            CompensatedPoints::Contour
                if self.writer.autodesk && !self.compensation.told_on_centre =>
            {
                self.compensation.told_on_centre = true;
                let message = format!(
                    "CUTCOM in a file of Autodesk's, which does not say what its points are: with compensation \"in control\" they are the contour, \
                     with \"wear\" the tool's centre, and register {register} must hold the wear alone"
                );
                self.warn(record, "compensation", message);
                return;
            }
            CompensatedPoints::Presumed(_) | CompensatedPoints::Contour => return,
        };
        if std::mem::replace(&mut self.compensation.told_on_centre, true) {
            return;
        }
        let place = self.place(record);
        let path = format!("the points are the tool's centre ({why})");
        let finding = match option {
            CompensationOnCentre::Refuse | CompensationOnCentre::Contour => Diagnostic::error(
                "compensation",
                format!("CUTCOM where {path}: with the radius in register {register} the part would be off by the radius"),
            )
            .help(match presumed {
                false => {
                    "let the CAM system put out the contour; or, where that register holds the tool's wear alone, \
                     [control] compensation_on_centre = \"wear\" (--set control.compensation_on_centre=wear)"
                }
                true => {
                    "where that register holds the tool's wear alone: [control] compensation_on_centre = \"wear\" \
                     (--set control.compensation_on_centre=wear); where the CAM system puts out the contour: \"contour\""
                }
            }),
            CompensationOnCentre::Wear => Diagnostic::warning(
                "compensation",
                format!("CUTCOM where {path}: register {register} must hold the tool's wear alone, not its radius"),
            ),
        };
        self.findings.push(finding.at(place));
    }
}
