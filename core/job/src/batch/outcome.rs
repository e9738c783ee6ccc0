//! What came of one job.

use std::collections::BTreeMap;

use post_machine::diagnostic::{Diagnostic, Severity};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::value::RawValue;

/// The program is good.
pub const WRITTEN: &str = "written";
/// It is refused, and why.
pub const REFUSED: &str = "refused";
/// Something broke that should not: it is tried again next time.
pub const FAILED: &str = "failed";

/// A value of a row.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    Number(f64),
    Count(i64),
    Text(String),
}

impl<'de> Deserialize<'de> for Value {
    /// Numbers are read by the standard library, to the last bit.
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let raw = Box::<RawValue>::deserialize(from)?;
        let raw = raw.get();
        if raw.starts_with('"') {
            let text = serde_json::from_str(raw).map(Self::Text);
            return text.map_err(serde::de::Error::custom);
        }
        match raw.parse::<i64>() {
            Ok(count) => Ok(Self::Count(count)),
            Err(_) => raw.parse::<f64>().map(Self::Number).map_err(serde::de::Error::custom),
        }
    }
}

/// What came of one job: values by the names of their columns. What has no value is not in it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Hash of all that it depends on; none if it was not got that far.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// Values by their columns.
    pub values: BTreeMap<String, Value>,
}

impl Outcome {
    /// A number that is one.
    pub fn number(&mut self, column: impl Into<String>, value: f64) {
        if value.is_finite() {
            // Adding zero turns -0 into 0.
            self.values.insert(column.into(), Value::Number(value + 0.0));
        }
    }

    /// Notes how many there are.
    pub fn count(&mut self, column: &str, value: u64) {
        let value = i64::try_from(value).unwrap_or(i64::MAX);
        self.values.insert(column.to_owned(), Value::Count(value));
    }

    /// Notes a text.
    pub fn text(&mut self, column: &str, value: impl Into<String>) {
        self.values.insert(column.to_owned(), Value::Text(value.into()));
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
            Some(Value::Text(state)) => state,
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
