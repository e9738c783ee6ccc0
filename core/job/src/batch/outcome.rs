//! What came of one job.

use std::collections::BTreeMap;

use post_machine::diagnostic::{Diagnostic, Severity};
use serde::{Deserialize, Serialize};

use crate::columns::{CellValue, Column};

/// The program is good.
pub const WRITTEN: &str = "written";
/// It is refused, and why.
pub const REFUSED: &str = "refused";
/// Something broke that should not: it is tried again next time.
pub const FAILED: &str = "failed";

/// What came of one job: values by the names of their columns. What has no value is not in it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JobOutcome {
    /// Hash of all that it depends on; none if it was not got that far.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// Values by their columns.
    pub values: BTreeMap<String, CellValue>,
}

impl JobOutcome {
    /// A number that is one.
    pub fn number(&mut self, column: impl Into<String>, value: f64) {
        if value.is_finite() {
            // Adding zero turns -0 into 0.
            self.values.insert(column.into(), CellValue::Number(value + 0.0));
        }
    }

    /// Notes how many there are.
    pub fn count(&mut self, column: &str, value: u64) {
        let value = i64::try_from(value).unwrap_or(i64::MAX);
        self.values.insert(column.to_owned(), CellValue::Count(value));
    }

    /// Notes a text.
    pub fn text(&mut self, column: &str, value: impl Into<String>) {
        self.values.insert(column.to_owned(), CellValue::Text(value.into().into()));
    }

    /// What these columns are of `row`.
    pub fn tell<R>(&mut self, columns: &[Column<R>], row: &R) {
        for column in columns {
            let name = column.name.clone().into_owned();
            match column.of(row, 0) {
                Some(CellValue::Number(number)) => self.number(name, number),
                Some(value) => drop(self.values.insert(name, value)),
                None => {}
            }
        }
    }

    /// Refused, or failed, for these reasons; the first error is told.
    pub fn not_written(state: &str, findings: &[Diagnostic]) -> Self {
        let mut outcome = Self::default();
        outcome.text("state", state);
        let errors = || {
            let findings = findings.iter();
            findings.filter(|finding| finding.severity == Severity::Error)
        };
        outcome.text("codes", codes(errors()));
        if let Some(first) = errors().next() {
            outcome.text("message", first.message.as_str());
            if let Some(place) = &first.place {
                outcome.count("line", place.line);
            }
        }
        outcome.warnings(findings);
        outcome
    }

    /// Refused for these reasons, with what was found of it.
    pub fn refused(mut self, findings: &[Diagnostic]) -> Self {
        let mut refused = Self::not_written(REFUSED, findings);
        refused.values.append(&mut self.values);
        refused
    }

    /// Failed where nobody could say why.
    pub fn lost(code: &str, message: &str) -> Self {
        let mut outcome = Self::default();
        outcome.text("state", FAILED);
        outcome.text("codes", code);
        outcome.text("message", message);
        outcome.text("warnings", "");
        outcome
    }

    /// The codes of what is warned of.
    pub fn warnings(&mut self, findings: &[Diagnostic]) {
        let findings = findings.iter();
        let warnings = findings.filter(|finding| finding.severity == Severity::Warning);
        self.text("warnings", codes(warnings));
    }

    /// `written`, `refused` or `failed`.
    pub fn state(&self) -> &str {
        match self.values.get("state") {
            Some(CellValue::Text(state)) => state,
            _ => FAILED,
        }
    }
}

/// Each code once, in the order told, blanks between them.
fn codes<'a>(findings: impl Iterator<Item = &'a Diagnostic>) -> String {
    let mut codes: Vec<&str> = Vec::new();
    for finding in findings {
        if !codes.contains(&finding.code) {
            codes.push(finding.code);
        }
    }
    codes.join(" ")
}
