//! Text of the machine file's own: what its templates are filled with, and where their lines come.

use post_machine::description::{Machine, OutputUnits, ProgramRules, Smoothing, TextPlace};
use post_machine::diagnostic::Diagnostic;
use post_machine::program_text::{Extents, Facts, OperationFacts, ProgramFacts, ToolFacts};
use post_plugin::Event;

use super::EmitStage;
use crate::findings::Findings;
use crate::job_facts::JobFacts;
use crate::program::ToolChange;

/// The templates of a machine, and what is known at this place of the program.
pub(super) struct ProgramTexts<'a> {
    rules: &'a ProgramRules,
    facts: Facts,
    /// Numbers of the tools in the order of their changes, if they are known ahead.
    changes: Vec<u32>,
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
        };
        Self {
            rules: &machine.program,
            facts: Facts { program, ..Facts::default() },
            changes: ahead
                .map(|ahead| ahead.changes.iter().map(|tool| tool.number).collect())
                .unwrap_or_default(),
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
        self.changed += 1;
        self.facts.last_tool = self.facts.tool.replace(tool_facts(tool));
        let behind = self.changes.get(self.changed..).unwrap_or_default();
        self.facts.next_tool = behind.iter().copied().find(|next| *next != tool.number);
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
        self.facts.operation =
            name.map(|name| OperationFacts { name: name.to_owned(), number: self.operations });
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

fn tool_facts(tool: &ToolChange) -> ToolFacts {
    ToolFacts {
        number: tool.number,
        register: tool.register,
        name: tool.name.clone(),
        length: tool.length,
        diameter: tool.diameter,
        corner_radius: tool.corner_radius,
    }
}

impl EmitStage<'_> {
    /// The lines that the machine file has for this place, numbered like any other; false if it has none.
    pub(super) fn say(&mut self, line: u64, at: TextPlace) -> bool {
        let Some(lines) = self.texts.lines(line, at) else {
            return false;
        };
        for text in &lines {
            self.writer.push(line, Event::Word { text });
        }
        true
    }

    /// The lines that stand in the place of those that the next event would write, if the machine file has any.
    pub(super) fn instead(&mut self, line: u64, at: TextPlace) {
        let lines = self.texts.lines(line, at).unwrap_or_default();
        if !lines.is_empty() {
            let text = lines.join("\n");
            self.writer.push(line, Event::Instead { text: &text });
        }
    }
}
