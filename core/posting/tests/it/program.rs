//! What CL texts mean: each is read from its characters to the steps and findings that come of it.
//!
//! Texts are written in one line, `;` for the line end; steps as [`Run`] prints them. A row is text, steps, findings.

mod cycles;
mod frames;
mod motion;
mod tools;
mod words;

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;
use post_grammar::{ClReader, Units};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_plugin::{Compensation, Spindle};
use post_posting::StreamItem;
use post_posting::expand::{PathMove, expanded};
use post_posting::program::{
    ClInterpreter, Command, DefaultSpindle, MoveFeed, ReadingOptions, StraightMove,
    UnknownWordPolicy,
};

/// What comes of a text.
struct Run {
    /// Curves and cycles as moves.
    steps: Vec<StreamItem<PathMove>>,
    findings: Vec<Diagnostic>,
}

impl Run {
    fn of(reading: ReadingOptions, text: &str) -> Self {
        let spindle = match reading.spindle {
            // Texts this short do not care for the spindle.
            DefaultSpindle::Unknown => DefaultSpindle::Still,
            told => told,
        };
        let reading = ReadingOptions { chord_tolerance: 0.01, spindle, ..reading };
        let text = text.replace(';', "\n");
        let mut reader = ClReader::new(text.as_bytes());
        let mut interpreter = ClInterpreter::new(reading.clone());
        let mut steps = Vec::new();
        while let Some(record) = reader.next_record().unwrap() {
            interpreter.record(&record, &mut |step| steps.push((record.line, step)));
        }
        interpreter.finish();
        let mut findings = interpreter.take_findings();
        let (steps, faults) = expanded(&steps, reading.chord_tolerance);
        findings.extend(faults);
        Self { steps, findings }
    }

    fn moves(&self) -> Vec<StraightMove> {
        let motion = |step: &StreamItem<PathMove>| match step {
            StreamItem::Point(line) => Some(line.motion),
            _ => None,
        };
        self.steps.iter().filter_map(motion).collect()
    }

    /// `R 1,2,3`, `F100 1,2,3`, `V4 1,2,3` (inverse time), with `@i,j,k` where the axis is not Z; `T5/7` is tool and
    /// register, `G41 7` compensation and register, `# text` a comment.
    /// Index moves apart: the points that follow are turned.
    fn steps(&self) -> String {
        let steps: Vec<String> = self
            .steps
            .iter()
            .filter(|step| {
                !matches!(
                    step,
                    StreamItem::Command {
                        command: Command::Index { .. } | Command::OperationEnd,
                        ..
                    }
                )
            })
            .map(step)
            .collect();
        steps.join("; ")
    }

    /// `error code`, `warning code`.
    fn findings(&self) -> String {
        let found: Vec<String> = self.findings.iter().map(finding).collect();
        found.join("; ")
    }

    #[track_caller]
    fn has_error(&self, code: &str, text: &str) {
        let named = |found: &&Diagnostic| found.code == code;
        assert!(
            self.findings.iter().filter(named).any(|found| found.severity == Severity::Error),
            "no error {code:?} in {text:?}: {} / {}",
            self.steps(),
            self.findings()
        );
    }
}

fn finding(finding: &Diagnostic) -> String {
    let severity = match finding.severity {
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    format!("{severity} {}", finding.code)
}

fn number(value: f64) -> String {
    // Plus zero: no minus before a zero.
    ((value * 1000.0).round() / 1000.0 + 0.0).to_string()
}

fn vector(vector: Vector3<f64>) -> String {
    let [x, y, z] = [vector.x, vector.y, vector.z].map(number);
    format!("{x},{y},{z}")
}

fn placed(tip: Vector3<f64>, axis: Vector3<f64>) -> String {
    if (axis - Vector3::z()).norm() < 1e-9 {
        return vector(tip);
    }
    format!("{} @{}", vector(tip), vector(axis))
}

fn step(step: &StreamItem<PathMove>) -> String {
    let command = match step {
        StreamItem::Point(line) => {
            let motion = &line.motion;
            let pace = match motion.pace {
                MoveFeed::Rapid => "R".to_owned(),
                MoveFeed::PerMinute(feed) => format!("F{}", number(feed)),
                MoveFeed::InverseTime(feed) => format!("V{}", number(feed)),
                MoveFeed::PerRevolution(feed) => format!("R{}", number(feed)),
            };
            return format!("{pace} {}", placed(motion.tip, motion.axis));
        }
        StreamItem::Command { command, .. } => command,
        other => return format!("{other:?}"),
    };
    match command {
        Command::From { tip, axis } => format!("from {}", placed(*tip, *axis)),
        Command::Tool(tool) => format!("T{}/{}", tool.number, tool.register),
        Command::Spindle(Spindle::On { rpm, .. }) => format!("S{}", number(*rpm)),
        Command::Compensate(Compensation::Off) => "G40".to_owned(),
        Command::Compensate(Compensation::Left { register }) => format!("G41 {register}"),
        Command::Compensate(Compensation::Right { register }) => format!("G42 {register}"),
        Command::Operation(text) | Command::Comment(text) => format!("# {text}"),
        Command::Home => "home".to_owned(),
        other => format!("{other:?}"),
    }
}

/// Reads mm at 100 mm/min, unless the text says otherwise.
fn run(text: &str) -> Run {
    Run::of(ReadingOptions::default(), &format!("UNITS/MM;FEDRAT/100;{text}"))
}

/// Rows of text, steps and findings, read as by [`run`].
#[track_caller]
fn table(rows: &[(&str, &str, &str)]) {
    for (text, steps, findings) in rows {
        let run = run(text);
        assert_eq!(run.steps(), *steps, "steps of {text:?}");
        assert_eq!(run.findings(), *findings, "findings of {text:?}");
    }
}
