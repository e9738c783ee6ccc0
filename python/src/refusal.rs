//! What is refused, as an exception of the Python half.

use post_machine::diagnostic::{Diagnostic, Severity};
use pyo3::prelude::*;

/// Of a finding its severity, code, message and help, and of its place file, line and text: what `post.Diagnostic` is made
/// of.
pub type DiagnosticFields = (
    &'static str,
    &'static str,
    String,
    Option<String>,
    Option<String>,
    Option<u64>,
    Option<String>,
);

/// Findings for Python.
pub fn told(findings: &[Diagnostic]) -> Vec<DiagnosticFields> {
    let tell = |finding: &Diagnostic| {
        let severity = match finding.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        let place = finding.place.as_ref();
        (
            severity,
            finding.code,
            finding.message.clone(),
            finding.help.clone(),
            place.map(|place| place.file.clone()),
            place.map(|place| place.line),
            place.map(|place| place.text.clone()),
        )
    };
    findings.iter().map(tell).collect()
}

/// `post.PostError` of these findings.
pub fn raised(py: Python<'_>, findings: &[Diagnostic]) -> PyErr {
    let made = py.import("post.refusal").and_then(|module| {
        let class = module.getattr("PostError")?;
        class.call_method1("of", (told(findings),))
    });
    match made {
        Ok(error) => PyErr::from_value(error),
        Err(fault) => fault,
    }
}
