//! Text of the machine file's own: what its templates are filled with, and where their lines come.

use post_machine::axis_words;
use post_machine::description::{Machine, OutputUnits, ProgramRules, Smoothing, TextPlace};
use post_machine::diagnostic::Diagnostic;
use post_machine::program_text::{
    CompensationFacts, Extents, Facts, OperationFacts, PlaneFacts, ProgramFacts, SpindleFacts,
    ToolFacts,
};
use post_machine::tilted_plane::TiltedPlane;
use post_plugin::{Compensation, Coolant, Event, Spindle, SpindleSense};

use super::EmitStage;
use crate::findings::Findings;
use crate::job_facts::{JobFacts, ProgramPreview};
use crate::program::ToolChange;

/// The templates of a machine, and what is known at this place of the program.
pub(super) struct ProgramTexts<'a> {
    rules: &'a ProgramRules,
    facts: Facts,
    /// The tools in the order of their changes, if they are known ahead.
    changes: Vec<ToolFacts>,
    /// The tool that each operation begins with, by its place among them, likewise.
    begins_with: Vec<Option<usize>>,
    /// Largest feed of each operation, likewise.
    feeds: Vec<Option<f64>>,
    /// Changes so far.
    changed: usize,
    operations: u32,
    /// What was wrong with a text since the last batch.
    faults: Vec<Diagnostic>,
}

impl<'a> ProgramTexts<'a> {
    pub(super) fn new(machine: &'a Machine, job: &JobFacts) -> Self {
        let ahead = job.ahead.as_ref();
        let program = ProgramFacts {
            name: job.program.clone(),
            cl_file: job.cl_file.clone(),
            machine: machine.name.clone(),
            dialect: machine.control.dialect.clone(),
            units: match machine.control.units {
                OutputUnits::Mm => "mm",
                OutputUnits::Inch => "inch",
            }
            .to_owned(),
            tolerance: machine.accuracy.tolerance,
            axis_tolerance: machine.accuracy.axis_tolerance.to_degrees(),
            tools: ahead.map(|ahead| ahead.tools().into_iter().map(tool_facts).collect()),
            extents: ahead.and_then(|ahead| ahead.extents).map(|[min, max]| Extents { min, max }),
            time: ahead.and_then(|ahead| ahead.time_s),
            stock: machine.stock_extents().map(|[min, max]| Extents { min, max }),
        };
        Self {
            rules: &machine.program,
            facts: Facts { program, ..Facts::default() },
            changes: ahead.map(changes).unwrap_or_default(),
            begins_with: ahead.map(|ahead| ahead.begins_with.clone()).unwrap_or_default(),
            feeds: ahead.map(|ahead| ahead.feeds.clone()).unwrap_or_default(),
            changed: 0,
            operations: 0,
            faults: Vec::new(),
        }
    }

    /// The lines for a place; none if the machine file has no text for it.
    fn lines(&mut self, line: u64, at: TextPlace) -> Option<Vec<String>> {
        let text = self.rules.text(at)?;
        self.facts.line = line;
        match text.lines(&self.facts) {
            Ok(lines) => Some(lines),
            Err(fault) => {
                self.faults.push(*fault);
                None
            }
        }
    }

    /// What was wrong since the last call.
    pub(super) fn tell(&mut self, findings: &Findings) {
        for fault in self.faults.drain(..) {
            findings.add(fault);
        }
    }

    /// The next tool is made ready after each change.
    pub(super) fn preselects(&self) -> bool {
        self.rules.preselect
    }

    /// A tool is about to come.
    pub(super) fn tool(&mut self, tool: &ToolChange) {
        let speed = self.changes.get(self.changed).and_then(|known| known.speed);
        self.changed += 1;
        self.facts.last_tool = self.facts.tool.replace(ToolFacts { speed, ..tool_facts(tool) });
        let behind = self.changes.get(self.changed..).unwrap_or_default();
        let mut numbers = behind.iter().map(|next| next.number);
        self.facts.next_tool = numbers.find(|next| *next != tool.number);
    }

    /// Some tool was changed before the one that is about to come.
    pub(super) fn any_tool(&self) -> bool {
        self.facts.tool.is_some()
    }

    /// The tool after the one that has come, if another comes.
    pub(super) fn next_tool(&self) -> Option<u32> {
        self.facts.next_tool
    }

    /// An operation begins, or none is open any more.
    pub(super) fn operation(&mut self, name: Option<&str>) {
        self.operations += u32::from(name.is_some());
        let feed = self.feeds.get(self.operations.saturating_sub(1) as usize).copied().flatten();
        self.facts.operation = name.map(|name| OperationFacts {
            name: name.to_owned(),
            number: self.operations,
            feed,
        });
    }

    /// The warning that a text for operations was written nowhere, where the program has none.
    pub(super) fn without_operations(&self) -> Option<Diagnostic> {
        let places = [TextPlace::BeforeOperation, TextPlace::AfterOperation];
        let unwritten = places
            .into_iter()
            .filter(|place| self.operations == 0 && self.rules.text(*place).is_some());
        let names: Vec<&str> = unwritten.map(TextPlace::key).collect();
        if names.is_empty() {
            return None;
        }
        let message = format!(
            "[program] {} is written nowhere: the CL file names no operation",
            names.join(" and ")
        );
        Some(
            Diagnostic::warning("program-text", message)
                .help("after_tool_change comes behind every tool change"),
        )
    }

    /// Takes by how much the control may leave the path from here on.
    pub(super) fn smoothing(&mut self, smoothing: Option<Smoothing>) {
        self.facts.tolerance = smoothing.map(|smoothing| smoothing.tolerance);
        self.facts.axis_tolerance = smoothing.and_then(|smoothing| smoothing.axis_tolerance);
    }
}

/// The tools of all changes, with the speed that each first gets.
fn changes(ahead: &ProgramPreview) -> Vec<ToolFacts> {
    let speeds = ahead.speeds.iter().copied().chain(std::iter::repeat(None));
    let changes = ahead.changes.iter().zip(speeds);
    changes.map(|(tool, speed)| ToolFacts { speed, ..tool_facts(tool) }).collect()
}

fn tool_facts(tool: &ToolChange) -> ToolFacts {
    ToolFacts {
        number: tool.number,
        register: tool.register,
        name: tool.name.clone(),
        length: tool.length,
        diameter: tool.diameter,
        corner_radius: tool.corner_radius,
        speed: None,
    }
}

fn spindle_facts(event: &Event<'_>) -> Option<SpindleFacts> {
    let (speed, surface_speed, sense) = match *event {
        Event::Spindle(Spindle::On { rpm, sense }) => (Some(rpm), None, sense),
        Event::SurfaceSpeed { speed, sense, .. } => (None, Some(speed), sense),
        _ => return None,
    };
    let direction = match sense {
        SpindleSense::Clockwise => "cw",
        SpindleSense::CounterClockwise => "ccw",
    };
    Some(SpindleFacts { speed, surface_speed, direction: direction.to_owned() })
}

fn coolant_name(coolant: Coolant) -> Option<String> {
    let name = match coolant {
        Coolant::Off => return None,
        Coolant::Flood => "flood",
        Coolant::Mist => "mist",
        Coolant::Through => "through",
        Coolant::Air => "air",
    };
    Some(name.to_owned())
}

fn compensation_facts(compensation: Compensation) -> Option<CompensationFacts> {
    let (side, register) = match compensation {
        Compensation::Off => return None,
        Compensation::Left { register } => ("left", register),
        Compensation::Right { register } => ("right", register),
    };
    Some(CompensationFacts { side: side.to_owned(), register })
}

/// A plane; it has `angles` where the control is told any.
fn plane_facts(plane: &TiltedPlane, angles: bool) -> PlaneFacts {
    PlaneFacts {
        angles: angles.then_some(plane.angles),
        origin: plane.origin.into(),
        normal: plane.normal().into(),
    }
}

impl EmitStage<'_> {
    /// The lines that the machine file has for this place, filled with what is known here.
    fn text(&mut self, line: u64, at: TextPlace) -> Option<Vec<String>> {
        self.texts.rules.text(at)?;
        let facts = &mut self.texts.facts;
        facts.spindle = self.spindle.commanded.as_ref().and_then(spindle_facts);
        facts.coolant = self.coolant.commanded.and_then(coolant_name);
        facts.work_offset = self.offset;
        facts.compensation = self.compensation.commanded.and_then(compensation_facts);
        let angles = self.writer.format().plane_angles.order().is_some();
        facts.plane = self.plane.wanted.as_deref().map(|plane| plane_facts(plane, angles));
        // The tool of an operation may come behind its name.
        let first = (self.texts.operations as usize).checked_sub(1);
        let first = first.filter(|_| at == TextPlace::BeforeOperation);
        let first = first.and_then(|place| *self.texts.begins_with.get(place)?);
        let Some(first) = first.and_then(|change| self.texts.changes.get(change).cloned()) else {
            return self.texts.lines(line, at);
        };
        let present = self.texts.facts.tool.replace(first);
        let lines = self.texts.lines(line, at);
        self.texts.facts.tool = present;
        lines
    }

    /// Lines behind or before a turn of the rotary axes to `words`.
    pub(super) fn say_turned(&mut self, line: u64, at: TextPlace, words: &[f64]) {
        if self.texts.rules.text(at).is_none() {
            return;
        }
        let places = axis_words::order(self.machine).into_iter().zip(words);
        let named = places.map(|(place, word)| (&self.machine.axes[place], *word));
        let rotary = named.filter(|(axis, _)| axis.joint.rotary);
        self.texts.facts.rotary =
            Some(rotary.map(|(axis, word)| (axis.name.clone(), word)).collect());
        self.say(line, at);
        self.texts.facts.rotary = None;
    }

    /// Lines of the file that are no part of the program: the very first and last.
    pub(super) fn say_bare(&mut self, line: u64, at: TextPlace) {
        let lines = self.text(line, at).unwrap_or_default();
        self.writer.bare_lines(&lines);
    }

    /// The lines that the machine file has for this place, numbered like any other; false if it has none.
    pub(super) fn say(&mut self, line: u64, at: TextPlace) -> bool {
        let Some(lines) = self.text(line, at) else {
            return false;
        };
        for text in &lines {
            self.writer.push(line, Event::Word { text });
        }
        true
    }

    /// The lines that stand in the place of those that the next event would write, if the machine file has any.
    pub(super) fn instead(&mut self, line: u64, at: TextPlace) {
        let lines = self.text(line, at).unwrap_or_default();
        if !lines.is_empty() {
            let text = lines.join("\n");
            self.writer.push(line, Event::Instead { text: &text });
        }
    }
}
