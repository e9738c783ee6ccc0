//! A file of tools as it is read: what is found in it, and what is wrong with it.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use post_grammar::text::{as_remark, excerpt};
use post_machine::description::{ToolData, ToolTable};
use post_machine::diagnostic::{Diagnostic, Short, SourcePlace};

use super::MOST_TOOLS;

/// Faults of one file that are told.
const MOST_FAULTS: usize = 50;

/// Largest size of a tool, mm: more is a slip of the unit.
const MOST_SIZE: f64 = 10_000.0;

/// A tool shorter than this from the gauge point has no holder, mm: a table in inches that is read in millimetres has
/// such.
const SHORTEST: f64 = 15.0;

/// Reads a file that a library names.
pub type ReadNear<'a> = &'a dyn Fn(&Path) -> io::Result<String>;

/// A file of tools that is being read.
pub struct ToolReading<'a> {
    /// What messages call it.
    pub name: &'a str,
    /// Its text.
    pub text: &'a str,
    /// mm a unit of its lengths, where its format does not say it.
    pub unit: f64,
    /// Heads of its columns by what stands in them.
    pub columns: &'a BTreeMap<String, String>,
    /// Reads a file that it names; none: there are no others.
    pub near: Option<ReadNear<'a>>,
    /// Its lines may be shown: the user named it.
    shown: bool,
    tools: Vec<ToolData>,
    /// It has more tools than are taken, and that is told.
    is_full: bool,
    findings: Vec<Diagnostic>,
}

/// The place of a line.
pub(super) fn line(name: &str, line: u64) -> Option<SourcePlace> {
    (line > 0).then(|| SourcePlace::new(name, line, "", 0..0))
}

impl<'a> ToolReading<'a> {
    /// A text of which nothing is read yet, lengths in mm.
    pub fn new(name: &'a str, text: &'a str, table: &'a ToolTable) -> Self {
        Self {
            name,
            text,
            unit: 1.0,
            columns: &table.columns,
            near: None,
            shown: table.place.is_none(),
            tools: Vec::new(),
            is_full: false,
            findings: Vec::new(),
        }
    }

    /// The lines with their numbers, from 1.
    pub fn lines(&self) -> impl Iterator<Item = (u64, &'a str)> + use<'a> {
        (1..).zip(self.text.lines())
    }

    /// Line that a place of the text lies in.
    pub fn line_at(&self, offset: usize) -> u64 {
        let before = self.text.as_bytes().iter().take(offset);
        1 + before.filter(|byte| **byte == b'\n').count() as u64
    }

    /// The line cannot be read.
    pub fn fault(&mut self, at: u64, message: String, help: &str) {
        let found = Diagnostic::error("tools", message).help(help);
        self.say(at, found);
    }

    /// The line can be read, but the tool is not as the program needs it.
    pub fn warn(&mut self, at: u64, message: String, help: &str) {
        let found = Diagnostic::warning("tools", message).help(help);
        self.say(at, found);
    }

    fn say(&mut self, at: u64, found: Diagnostic) {
        if self.findings.len() >= MOST_FAULTS {
            return;
        }
        // A machine file may be a stranger's, and name a file that is none of tools.
        let index = usize::try_from(at.saturating_sub(1)).unwrap_or(usize::MAX);
        let text = self.text.lines().nth(index).filter(|_| self.shown && at > 0);
        let place = match text {
            Some(text) => Some(SourcePlace::new(self.name, at, text, 0..text.len())),
            None => line(self.name, at),
        };
        self.findings.push(found.at(place));
    }

    /// A text of the file as messages show it: of a file that the user did not name nothing is.
    pub fn quoted(&self, text: &str) -> String {
        match self.shown {
            true => format!("`{}`", excerpt(text.trim(), 40)),
            false => "what stands there".to_owned(),
        }
    }

    /// A number; none with a fault, where `what` is none.
    pub fn number(&mut self, at: u64, what: &str, text: &str) -> Option<f64> {
        match text.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => Some(number),
            _ => {
                let message = format!("{what}: {} is no number", self.quoted(text));
                self.fault(at, message, "digits with a decimal point, 120.5");
                None
            }
        }
    }

    /// A tool number; none with a fault.
    pub fn tool_number(&mut self, at: u64, text: &str) -> Option<u32> {
        match text.trim().parse() {
            Ok(number) => Some(number),
            Err(_) => {
                let message = format!("{} is no number of a tool", self.quoted(text));
                self.fault(at, message, "a whole number from 0 up");
                None
            }
        }
    }

    /// Takes a tool.
    pub fn tool(&mut self, tool: ToolData) {
        if self.has_room(tool.line) {
            self.tools.push(tool);
        }
    }

    /// The tool of this number that is being put together of several lines; none with a fault where there are too many.
    pub fn gathered(&mut self, number: u32, at: u64) -> Option<&mut ToolData> {
        // Its lines mostly stand together.
        let known = self.tools.iter().rposition(|tool| tool.number == number);
        let place = known.unwrap_or(self.tools.len());
        if known.is_none() {
            if !self.has_room(at) {
                return None;
            }
            self.tools.push(ToolData { number, line: at, ..ToolData::default() });
        }
        self.tools.get_mut(place)
    }

    /// One more tool is possible; else that is told, once.
    fn has_room(&mut self, at: u64) -> bool {
        if self.tools.len() < MOST_TOOLS {
            return true;
        }
        if !std::mem::replace(&mut self.is_full, true) {
            let message = format!("more than {MOST_TOOLS} tools");
            self.fault(at, message, "is this a file of tools?");
        }
        false
    }

    /// How many tools were taken.
    pub fn taken(&self) -> usize {
        self.tools.len()
    }

    /// The tools by number, their lengths counted from the gauge point: `reference` mm is the tool that they count from;
    /// and what is to be said of the file.
    pub(super) fn finish(mut self, reference: f64) -> (Vec<ToolData>, Vec<Diagnostic>) {
        let mut tools = std::mem::take(&mut self.tools);
        for tool in &mut tools {
            tool.name = as_remark(std::mem::take(&mut tool.name)).trim().to_owned();
            tool.holder = as_remark(std::mem::take(&mut tool.holder)).trim().to_owned();
            // Tables have 0 where nothing was measured.
            tool.length = tool.length.filter(|length| *length != 0.0);
            tool.radius = tool.radius.filter(|radius| *radius != 0.0);
            tool.most_rpm = tool.most_rpm.filter(|rpm| *rpm > 0.0);
            tool.length = tool.length.map(|length| length + reference);
        }
        tools.retain(|tool| tool.number != 0 && !is_empty(tool));
        for tool in &tools {
            self.check(tool);
        }
        tools.sort_by_key(|tool| (tool.number, tool.line));
        self.check_twice(&tools);
        if tools.is_empty() && self.findings.is_empty() {
            let help = "is it the right file, and written to its end?";
            self.fault(0, format!("{} has no tools", self.name), help);
        }
        (tools, self.findings)
    }

    /// Sizes that no tool has.
    fn check(&mut self, tool: &ToolData) {
        let number = tool.number;
        let size =
            [tool.length, tool.radius, tool.corner_radius, tool.stick_out, Some(tool.length_wear)];
        if let Some(size) = size.into_iter().flatten().find(|size| size.abs() > MOST_SIZE) {
            let message = format!("tool {number} has a size of {} mm", Short(size));
            self.fault(tool.line, message, "is a decimal point missing, or are the units others?");
        }
        if let Some(radius) = tool.radius.filter(|radius| *radius < 0.0) {
            let message = format!("tool {number} has the radius {} mm, below zero", Short(radius));
            self.fault(
                tool.line,
                message,
                "a cutter's radius is above zero; wear has its own place",
            );
        }
        let out = tool.stick_out.unwrap_or(0.0).max(SHORTEST);
        if let Some(length) = tool.length.filter(|length| *length > 0.0 && *length < out) {
            let message = format!(
                "tool {number} is {} mm long from the gauge point to the tip, and {} mm are the least that it can be",
                Short(length),
                Short(out)
            );
            self.warn(tool.line, message, "are the units of the file others ([tools] units), or is it an offset that was touched off?");
        }
        if tool.length.is_none() && tool.length_wear != 0.0 {
            let message = format!("tool {number} has wear in its length, and no length");
            self.warn(tool.line, message, "measure it: its length is not known");
        }
    }

    /// Two tools of one number.
    fn check_twice(&mut self, tools: &[ToolData]) {
        for pair in tools.windows(2) {
            let [first, second] = pair else { continue };
            if first.number == second.number {
                let message = format!(
                    "tool {} stands there twice, in lines {} and {}",
                    first.number, first.line, second.line
                );
                let help = "each tool once: which of the two is in the machine is not known";
                let found = Diagnostic::error("tools-twice", message).help(help);
                self.say(second.line, found);
            }
        }
    }
}

/// A place of the magazine without a tool, or a row that nothing was entered in.
fn is_empty(tool: &ToolData) -> bool {
    let ToolData { length, length_wear, radius, radius_wear, name, .. } = tool;
    length.is_none()
        && radius.is_none()
        && *length_wear == 0.0
        && *radius_wear == 0.0
        && name.is_empty()
}
