//! How long the tools are, by whoever says it, and which were used.

use post_machine::description::Tcp;
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
    /// `LOADTL/…,LENGTH`, or with `tool_length = "cl"` the cutter.
    ClFile,
    /// Not given: 0 was taken.
    Unknown,
}

impl ConfigurationStage<'_> {
    /// Finds the length of a tool.
    pub(super) fn measure(&mut self, tool: &ToolChange) {
        let table = || {
            let tools = &self.machine.tools;
            tools.iter().find(|(number, _)| *number == tool.number).map(|(_, length)| *length)
        };
        let given = [
            (self.told_length, LengthSource::Option),
            (table(), LengthSource::MachineFile),
            (tool.length, LengthSource::ClFile),
        ];
        let mut given = given.into_iter().filter_map(|(length, source)| Some((length?, source)));
        let known = given.next();
        self.length = known.map(|(length, _)| length);
        self.source = known.map_or(LengthSource::Unknown, |(_, source)| source);
        self.in_use = false;
    }

    /// The first move with a tool: which length is assumed is kept for the summary; where the axis positions depend on a
    /// length that is not given, there is no program.
    #[cold]
    pub(super) fn take_into_use(&mut self, line: u64) {
        self.in_use = true;
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
        if self.source == LengthSource::Unknown {
            self.findings.at(line, unknown_length(used.number, self.length_matters()));
        }
        self.tools.push(used);
    }

    /// Does the program depend on the tool length? On a machine whose head turns, if the control does not keep the tip.
    fn length_matters(&self) -> bool {
        let machine = self.machine;
        if machine.control.tcp == Tcp::Control {
            return false;
        }
        let first_linear = machine.axes.iter().position(|axis| !axis.joint.rotary);
        machine.axes.iter().skip(first_linear.unwrap_or(0)).any(|axis| axis.joint.rotary)
    }
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
