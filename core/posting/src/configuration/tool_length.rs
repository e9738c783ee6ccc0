//! How long the tools are, by whoever says it, and which were used.

use post_machine::description::{ToolData, ToolTable};
use post_machine::diagnostic::Diagnostic;
use serde::Serialize;

use super::ConfigurationStage;
use crate::program::ToolChange;
use crate::program::limits::MOST_TOOLS;

/// A tool that was used.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReportedTool {
    /// Tool number; none if the CL file loads no tool.
    pub number: Option<u32>,
    /// The length that was assumed, mm from the gauge point to the tip.
    pub length_mm: f64,
    /// Source of the length.
    pub source: LengthSource,
}

/// Source of the length of a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LengthSource {
    /// `--tool-length`.
    Option,
    /// `[tools]`.
    MachineFile,
    /// The file of tools (`--tools`, `[tools] file`).
    ToolTable,
    /// `LOADTL/…,LENGTH`, or with `tool_length = "cl"` the cutter.
    ClFile,
    /// Not given: 0 was taken.
    Unknown,
}

impl ConfigurationStage<'_> {
    /// Finds the length of a tool.
    pub(super) fn measure(&mut self, tool: &ToolChange) {
        let listed = self.listed(tool).and_then(ToolData::total_length);
        let by_register = self.machine.tool_table.as_ref().is_some_and(|file| file.by_register);
        let table = || {
            let mut tools = self.machine.tools.iter().filter(|_| !by_register);
            tools.find(|(number, _)| *number == tool.number).map(|(_, length)| *length)
        };
        let given = [
            (self.told_length, LengthSource::Option),
            (listed, LengthSource::ToolTable),
            (table(), LengthSource::MachineFile),
            (tool.length, LengthSource::ClFile),
        ];
        let mut given = given.into_iter().filter_map(|(length, source)| Some((length?, source)));
        let known = given.next();
        self.length = known.map(|(length, _)| length);
        self.source = known.map_or(LengthSource::Unknown, |(_, source)| source);
        self.in_use = false;
    }

    /// What the file of tools has of a tool, if there is one.
    fn listed(&self, tool: &ToolChange) -> Option<&ToolData> {
        self.machine.tool_table.as_ref()?.entry(tool.number, tool.register)
    }

    /// The first move with a tool: which length is assumed is kept for the summary; where the axis positions depend on a
    /// length that is not given, there is no program.
    #[cold]
    pub(super) fn take_into_use(&mut self, line: u64) {
        self.in_use = true;
        self.check_tool_speed(line);
        let used = ReportedTool {
            number: self.tool.as_ref().map(|tool| tool.number),
            length_mm: self.length.unwrap_or(0.0),
            source: self.source,
        };
        if let Some(finding) =
            self.lengths.check(self.base, self.machine, (used.number, self.length))
        {
            self.findings.at(line, finding);
        }
        if self.tools.contains(&used) {
            return;
        }
        if self.tools.len() >= MOST_TOOLS {
            let fault =
                Diagnostic::error("tool", format!("more than {MOST_TOOLS} different tools"));
            self.findings.at(line, fault.help("is this the CL file of one program?"));
            return;
        }
        let told_at_the_end = self.base.is_opened();
        if self.is_listed(line) && self.source == LengthSource::Unknown && !told_at_the_end {
            self.findings
                .at(line, unknown_length(used.number, self.machine.words_hold_on_length_alone()));
        }
        self.tools.push(used);
    }

    /// The tool that was called is in the file of tools, or there is none; what is wrong with it is said.
    fn is_listed(&self, line: u64) -> bool {
        // The file is not read where nothing is posted in earnest.
        let file = self.machine.tool_table.as_ref().filter(|file| file.tools.is_some());
        let (Some(called), Some(file)) = (&self.tool, file) else {
            return true;
        };
        let Some(listed) = self.listed(called) else {
            let mut own = self.machine.tools.iter().filter(|_| !file.by_register);
            let known = own.any(|(known, _)| *known == called.number);
            if !known {
                self.findings.at(line, not_listed(called, file));
            }
            return known;
        };
        let name = file.name();
        if let Some(finding) = listed.other_cutter(called.number, called.diameter, &name) {
            self.findings.at(line, finding);
        }
        true
    }

    /// A speed that the tool in use must not turn at.
    pub(super) fn check_tool_speed(&self, line: u64) {
        let (Some(rpm), Some(tool), true) = (self.speed, &self.tool, self.in_use) else {
            return;
        };
        if let (Some(listed), Some(file)) = (self.listed(tool), &self.machine.tool_table)
            && let Some(finding) = listed.refuse_speed(rpm, &file.name())
        {
            self.findings.at(line, finding);
        }
    }
}

/// The tool that is called is not in the file of tools.
fn not_listed(called: &ToolChange, file: &ToolTable) -> Diagnostic {
    let ToolChange { number, name, .. } = called;
    let name = if name.is_empty() { String::new() } else { format!(" ({name})") };
    let tools = file.tools.iter().flatten();
    let known: Vec<String> = tools.clone().take(20).map(|tool| tool.number.to_string()).collect();
    let more = if tools.count() > known.len() { " and more" } else { "" };
    let has = match known.is_empty() {
        true => "it has no tools".to_owned(),
        false => format!("it has {}{more}", known.join(", ")),
    };
    let what = match file.by_register {
        true => format!("register {} of tool {number}{name}", called.register),
        false => format!("tool {number}{name}"),
    };
    let message = format!("{what} is called, and is not in {}", file.name());
    Diagnostic::error("tool-missing", message)
        .help(format!("{has}; measure the tool, or let the CAM system call the one that is there"))
}

/// The length of a tool is not given; `matters` if the axis positions of the program depend on it, else travel alone is
/// checked with it.
fn unknown_length(number: Option<u32>, matters: bool) -> Diagnostic {
    let tool = match number {
        Some(number) => format!("of tool {number}"),
        None => "of the tool".to_owned(),
    };
    let help = "give --tool-length, or [tools] in the machine file";
    if matters {
        let message = format!(
            "no length {tool} is known, and on this machine, whose head turns, the axis positions depend on it"
        );
        Diagnostic::error("tool-length", message)
            .help(format!("{help}; --tool-length 0 says that there is none"))
    } else {
        let message = format!("no length {tool} is known: travel was checked with 0 mm");
        Diagnostic::warning("tool-length", message).help(help)
    }
}
