//! Several files of one program: each begins as a file of its own, with what the spindle holds from the one before.

use std::path::Path;

use post_grammar::Record;
use post_grammar::text::as_remark;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Coolant;

use super::modal::FileTools;
use super::{ClInterpreter, StepSink};
use crate::program::{Command, ProgramStep};

/// What a file left in force that the one behind it must name anew before it moves.
#[derive(Clone, Debug, Default)]
pub(super) struct LeftByFile {
    /// Number, register and length (as written) of the tool in the spindle.
    pub tool: Option<(u32, u32, Option<f64>)>,
    pub offset: Option<u32>,
    pub head: Option<String>,
}

impl ClInterpreter {
    /// The file behind the one that is read begins on this line, or before it.
    #[inline]
    pub(crate) fn file_begins(&self, line: u64) -> bool {
        self.next_file.is_some_and(|before| line >= before)
    }

    /// Files behind the first that are begun.
    pub(crate) fn files_begun(&self) -> usize {
        self.files_begun
    }

    /// A line end stands after the last line of the file that ends here.
    pub(crate) fn ends_in_line_end(&self) -> bool {
        self.told.further.get(self.files_begun).is_none_or(|file| file.behind_line_end)
    }

    /// What is wrong with the file that ends here, beside its last line.
    pub(crate) fn end_file(&mut self) {
        self.left_open();
        if !self.moved {
            let message = "the file has no move";
            let help = "is it a cutter-location file (APT, CLSF, NCL), or a list of points? Leave it out of the program";
            self.findings.push(Diagnostic::error("empty", message).help(help));
        }
    }

    /// Begins the next file: nothing modal of the one before holds, the tool is retracted, spindle and coolant rest.
    pub(crate) fn begin_file(&mut self, emit: &mut StepSink<'_>) {
        if self.frame.turned().is_some() {
            let message = "the file ends with the part turned by an index move (ROTABL), and another file follows";
            let help =
                "let the CAM system turn it back to zero at the end, or post the files one by one";
            self.findings.push(Diagnostic::error("rotabl", message).help(help));
        }
        let begun = self.files_begun + 1;
        let left = LeftByFile {
            tool: self.tools.loaded.or(self.left.tool),
            offset: self.offset.or(self.left.offset),
            head: self.head.take().or(self.left.head.take()),
        };
        emit(ProgramStep::Command(Command::Retract { forgets: true }));
        if let Some(file) = self.told.further.get(self.files_begun) {
            let name = Path::new(&file.name).file_name().unwrap_or_default();
            let name = as_remark(name.to_string_lossy().into_owned());
            emit(ProgramStep::Command(Command::Comment(name)));
        }
        self.smooth(self.told.smoothing.default, emit);
        let next = Self::new(self.told.clone());
        let before = std::mem::replace(self, next);
        self.tools = FileTools { cutters: before.tools.cutters, ..FileTools::default() };
        self.coolant = Coolant::Flood;
        self.census = before.census;
        self.findings = before.findings;
        self.left = left;
        self.files_begun = begun;
        self.next_file = self.told.further.get(begun).map(|file| file.before);
    }

    /// Refuses a move of a further file before what the file before it left in force is named anew.
    #[cold]
    pub(super) fn refuse_what_is_left(&mut self, record: &Record<'_>) {
        let LeftByFile { tool, offset, head } = std::mem::take(&mut self.left);
        if let (Some((number, ..)), None) = (tool, self.tools.loaded) {
            self.fault(
                record,
                "tool",
                format!("this file loads no tool, and tool {number} of the file before it is in the spindle"),
                "let the CAM system write LOADTL (in a list of points: `tool,N`); --tool N names the tool of files that load none",
            );
        }
        if let (Some(number), None) = (offset, self.offset) {
            self.fault(
                record,
                "work-offset",
                format!("this file names no work offset, and offset {number} of the file before it is in force"),
                "let each file name its own (SET/OFSETL), or none",
            );
        }
        if let (Some(name), None) = (head, &self.head) {
            self.fault(
                record,
                "head",
                format!("this file names no head, and {name} of the file before it is in"),
                "let each file name its own (HEAD), or none",
            );
        }
    }
}
