//! What is told as JSON of a program that was held against its CL file.

use post_machine::diagnostic::{Diagnostic, Severity};
use post_readback::verify::Verification;
use serde::Serialize;

use crate::clearance::ClearanceSummary;

/// What was found, and whether that is good.
#[derive(Serialize)]
pub struct VerifySummary<'a> {
    /// The program does what the CL file asks for, and all of both could be read.
    pub holds: bool,
    /// Why it does not, or why that is not known: all that is wrong, what of either file cannot be read among it.
    pub refused: Vec<RefusalReason<'a>>,
    /// What was found.
    #[serde(flatten)]
    pub found: &'a Verification,
    /// What was proven besides.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<ClearanceSummary>,
}

/// An error, as it is told.
#[derive(Serialize)]
pub struct RefusalReason<'a> {
    code: &'static str,
    message: &'a str,
    /// Its file and line there, if it has a place.
    file: Option<&'a str>,
    line: Option<u64>,
}

impl<'a> VerifySummary<'a> {
    /// Of what was found, and of all that was said of it.
    pub fn of(found: &'a Verification, findings: &'a [Diagnostic]) -> Self {
        let errors = findings.iter().filter(|finding| finding.severity == Severity::Error);
        let refused: Vec<_> = errors.map(RefusalReason::of).collect();
        Self { holds: refused.is_empty(), refused, found, clearance: None }
    }
}

impl<'a> RefusalReason<'a> {
    fn of(error: &'a Diagnostic) -> Self {
        let place = error.place.as_ref();
        Self {
            code: error.code,
            message: &error.message,
            file: place.map(|place| place.file.as_str()),
            line: place.map(|place| place.line),
        }
    }
}
