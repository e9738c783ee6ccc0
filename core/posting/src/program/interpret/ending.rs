//! Whether a file is whole, as far as its end tells.

use post_grammar::{Record, Statement, WordUsage, parse_record};
use post_machine::diagnostic::Diagnostic;

use super::{ClInterpreter, StepSink};

impl ClInterpreter {
    /// Ends the file; records after it are left out.
    pub(super) fn fini(&mut self, record: &Record<'_>, emit: &mut StepSink<'_>) {
        self.end_spline(record, emit);
        self.finished = true;
        self.count("FINI", record, WordUsage::Used);
    }

    /// Leaves out a record after FINI, and says so once.
    pub(super) fn after_fini(&mut self, record: &Record<'_>) {
        if !matches!(record.statement, Statement::Remark(_) | Statement::Fini) {
            self.count("FINI", record, WordUsage::Used);
            if !std::mem::replace(&mut self.told_after_fini, true) {
                self.warn(record, "after-fini", "what stands behind the end is left out: behind FINI, or in a list of points behind a line that begins with $$".to_owned());
            }
        }
    }

    /// What is wrong with the end of a file whose last record is `last`; `line_end` says whether a line end stands after
    /// it. The finding has no place yet.
    pub(crate) fn cut_off(&self, last: &str, line_end: bool) -> Option<Diagnostic> {
        if self.finished {
            return None;
        }
        let found = if !line_end {
            Some(
                "the file ends within this line, and it is not FINI: what follows may be missing"
                    .to_owned(),
            )
        } else if ends_in_comma(last) {
            Some("the file ends in a comma: what follows it is missing".to_owned())
        } else if let Some(path) = &self.path {
            Some(format!("the file ends within the operation {path}: no END-OF-PATH follows"))
        } else if self.wants_fini {
            Some(
                "the file has no FINI, with which the system that wrote it ends every file"
                    .to_owned(),
            )
        } else {
            None
        };
        match found {
            Some(message) if self.reading.allows("FINI") => {
                Some(Diagnostic::warning("cut-off", message))
            }
            Some(message) => Some(Diagnostic::error("cut-off", message).help(
                "let the CAM system write the file again; --allow FINI takes it to be whole",
            )),
            // NX writes none.
            None if self.paths || self.reading.allows("FINI") => None,
            None => Some(
                Diagnostic::warning("cut-off", "the file has no FINI: is it whole?")
                    .help("--allow FINI says that it is"),
            ),
        }
    }
}

/// More must follow the record; in a free text a comma is text.
fn ends_in_comma(record: &str) -> bool {
    let code = record.split("$$").next().unwrap_or(record);
    let text = matches!(
        parse_record(record),
        Ok(Statement::Remark(_)
            | Statement::Insert(_)
            | Statement::Print(_)
            | Statement::PartName(_)
            | Statement::ToolPath { .. })
    );
    code.trim_end().ends_with(',') && !text
}
