//! What was found, as the page tells it.

use post_machine::diagnostic::{Diagnostic, Severity};
use post_report::meta::Warning;

/// Findings of a run: those of lines of the CL file, and of the program named `program`.
pub fn warnings(findings: &[Diagnostic], program: &str) -> Vec<Warning> {
    let told = findings.iter().map(|finding| {
        let place = finding.place.as_ref();
        let of_program = place.is_some_and(|place| place.file == program);
        let line = |wanted: bool| place.filter(|_| of_program == wanted).map(|at| at.line);
        Warning {
            severity: match finding.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
            },
            code: finding.code.to_owned(),
            text: finding.message.clone(),
            help: finding.help.clone(),
            nc: line(true),
            cl: line(false),
        }
    });
    told.collect()
}
