//! What was found of a program, for programs to read.

use post_machine::diagnostic::{Diagnostic, Severity};
use serde::Serialize;

use super::LintedProgram;

/// What was found of a program.
#[derive(Clone, Debug, Serialize)]
pub struct LintSummary {
    /// The program, as it was named.
    pub program: String,
    /// The machine.
    pub machine: String,
    /// Blocks that were run.
    pub blocks: u64,
    /// Time of the motions at the feeds that the program states, rapids at the largest feeds of the axes, and waits, s.
    pub time_s: f64,
    /// How long it takes, s; none where the machine file does not say how fast the axes get up to speed, a block is not
    /// understood, or a finding says why.
    pub predicted_s: Option<f64>,
    /// What is wrong, and what may be.
    pub findings: Vec<FindingSummary>,
    /// How many findings are not told, by their codes.
    pub ignored: Vec<(&'static str, u64)>,
}

/// A finding.
#[derive(Clone, Debug, Serialize)]
pub struct FindingSummary {
    /// `error` or `warning`.
    pub severity: &'static str,
    /// Its code.
    pub code: &'static str,
    /// Line of the program; none where it is about none.
    pub line: Option<u64>,
    /// What is found.
    pub message: String,
    /// What helps.
    pub help: Option<String>,
}

impl LintSummary {
    /// Of the program `name` on `machine`.
    pub fn new(name: &str, machine: &str, linted: &LintedProgram<'_>) -> Self {
        Self {
            program: name.to_owned(),
            machine: machine.to_owned(),
            blocks: linted.report.blocks,
            time_s: linted.seconds(),
            predicted_s: linted.predicted,
            findings: linted
                .findings
                .iter()
                .map(|finding| FindingSummary::new(name, finding))
                .collect(),
            ignored: linted.ignored.clone(),
        }
    }

    /// Of the program `name` for `machine`, which cannot be looked over: why.
    pub fn unread(name: &str, machine: &str, findings: &[Diagnostic]) -> Self {
        Self {
            program: name.to_owned(),
            machine: machine.to_owned(),
            blocks: 0,
            time_s: 0.0,
            predicted_s: None,
            findings: findings.iter().map(|finding| FindingSummary::new(name, finding)).collect(),
            ignored: Vec::new(),
        }
    }
}

impl FindingSummary {
    /// Of a finding of the program `name`.
    pub fn new(name: &str, finding: &Diagnostic) -> Self {
        let place = finding.place.as_ref().filter(|place| place.file == name);
        Self {
            severity: match finding.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
            },
            code: finding.code,
            line: place.map(|place| place.line),
            message: finding.message.clone(),
            help: finding.help.clone(),
        }
    }
}
