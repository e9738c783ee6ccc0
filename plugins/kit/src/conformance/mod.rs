//! The conformance kit: a plugin is run on cases whose answer is known, and what it gets wrong is said.
//!
//! `post plugin test` prints it; an author's own tests can call it on what the export line made:
//!
//! ```no_run
//! # fn check(plugin: post_plugin::Linked) -> Result<(), post_host::PluginFault> {
//! let report = post_kit::conformance::test(&post_host::Plugin::linked(plugin)?, &[])?;
//! assert!(report.is_good(), "{report}");
//! # Ok(())
//! # }
//! ```

mod arcs;
mod commands;
mod cycles;
mod declared;
pub(crate) mod dialect;
mod model;
mod options;
mod pen;
mod pose;
mod print;
mod runs;
mod sessions;
mod shapes;
pub(crate) mod texts;

use std::fmt::{self, Write as _};

use post_host::{GivenValue, Plugin, PluginFault, PluginKind};

/// What the kit found.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// What the plugin is.
    pub kind: PluginKind,
    /// The cases, in the order in which they were run.
    pub cases: Vec<Case>,
}

/// What one case found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Case {
    /// Its name.
    pub name: &'static str,
    /// What an error model answered, if it did.
    pub figures: Option<Figures>,
    /// What is wrong, a sentence each with its numbers. The plugin must not be used.
    pub wrong: Vec<String>,
    /// What an author should know: an approximation, and what comes of it; something that it refuses.
    pub notes: Vec<String>,
    /// What was counted or measured.
    pub facts: Vec<String>,
}

/// An error model's answer beside the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Places that it asked for.
    pub asked: usize,
    /// Tip, mm.
    pub tip: Peaks,
    /// Tool axis, degrees.
    pub axis: Peaks,
}

/// Two peaks, in mm or degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// The largest deviation, found by looking at 2001 places.
    pub actual: f64,
    /// Where, t.
    pub actual_at: f64,
    /// What the model says it is.
    pub said: f64,
    /// Where it says it is.
    pub said_at: f64,
    /// The largest difference between the deviation and the model's curve.
    pub left: f64,
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// As it should.
    Good,
    /// With something to know.
    Approximate,
    /// The plugin breaks its contract.
    Wrong,
}

/// Events of the longest program that [`test()`] has a dialect write.
pub const EVENTS: usize = 8_000;

/// Runs the kit on a plugin that is opened with `options`.
///
/// # Errors
/// If it cannot be opened with them.
pub fn test(plugin: &Plugin, options: &[(String, GivenValue)]) -> Result<Report, PluginFault> {
    test_long(plugin, options, EVENTS)
}

/// As [`test()`], with so many events in a dialect's longest program.
///
/// # Errors
/// If it cannot be opened with the options.
pub fn test_long(
    plugin: &Plugin,
    options: &[(String, GivenValue)],
    events: usize,
) -> Result<Report, PluginFault> {
    let cases = match plugin.kind() {
        PluginKind::ErrorModel => model::test(plugin, options)?,
        PluginKind::Dialect => dialect::test(plugin, options, events)?,
    };
    Ok(Report { kind: plugin.kind(), cases })
}

impl Case {
    fn named(name: &'static str) -> Case {
        Case { name, ..Case::default() }
    }

    /// How it ended.
    pub fn verdict(&self) -> Verdict {
        if !self.wrong.is_empty() {
            Verdict::Wrong
        } else if !self.notes.is_empty() {
            Verdict::Approximate
        } else {
            Verdict::Good
        }
    }

    fn wrong(&mut self, sentence: String) {
        self.wrong.push(sentence);
    }

    /// Something to know, but that a panic is never one.
    fn note(&mut self, sentence: String) {
        match sentence.contains("the plugin panicked") {
            true => self.wrong.push(sentence),
            false => self.notes.push(sentence),
        }
    }
}

impl Report {
    /// Nothing is wrong.
    pub fn is_good(&self) -> bool {
        self.wrong().next().is_none()
    }

    /// Everything that is wrong, with the name of the case.
    pub fn wrong(&self) -> impl Iterator<Item = String> {
        self.cases.iter().flat_map(|case| {
            let sentences = case.wrong.iter();
            sentences.map(move |sentence| format!("{}: {sentence}", case.name))
        })
    }

    /// The cases with their figures and verdicts, and below them what an author should know.
    pub fn table(&self) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail.
        let _ = self.write_table(&mut text);
        text
    }

    fn write_table(&self, text: &mut String) -> fmt::Result {
        let numbers = self.kind == PluginKind::ErrorModel;
        if numbers {
            writeln!(
                text,
                "{:<16} {:>5}  {:>10} {:>10} {:>5} {:>6}  {:>8} {:>8} {:>5} {:>6}",
                "", "asked", "tip, µm", "said", "at t", "left", "axis, °", "said", "at t", "left",
            )?;
        }
        for case in &self.cases {
            write!(text, "{:<16}", case.name)?;
            match &case.figures {
                Some(figures) => {
                    write!(text, " {:>5}", figures.asked)?;
                    figures.tip.write(text, 1e3, 10, 3)?;
                    figures.axis.write(text, 1.0, 8, 4)?;
                }
                None if numbers => write!(text, "{:71}", "")?,
                None => {}
            }
            writeln!(text, "  {}", case.verdict())?;
        }
        if numbers {
            writeln!(
                text,
                "\nleft: the largest difference between the deviation and the model's curve, of the peak."
            )?;
        }
        for case in &self.cases {
            for note in case.notes.iter().chain(&case.facts) {
                writeln!(text, "{}: {note}", case.name)?;
            }
        }
        Ok(())
    }
}

impl Peaks {
    /// In units of 1/`scale`.
    fn write(&self, text: &mut String, scale: f64, width: usize, decimals: usize) -> fmt::Result {
        let number = |value: f64| readable(value * scale, decimals, 1);
        let left = if self.actual > 0.0 {
            format!("{:.1} %", 100.0 * self.left / self.actual)
        } else {
            "-".to_owned()
        };
        write!(
            text,
            "  {:>width$} {:>width$} {:>5.3} {left:>7}",
            number(self.actual),
            number(self.said),
            self.said_at,
        )
    }
}

/// A number with so many decimals; a very large or very small one as a power of ten, with `digits` behind its point.
fn readable(value: f64, decimals: usize, digits: usize) -> String {
    match value == 0.0 || (1e-3..1e5).contains(&value) {
        true => format!("{value:.decimals$}"),
        false => format!("{value:.digits$e}"),
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Good => "good",
            Verdict::Approximate => "good, see below",
            Verdict::Wrong => "WRONG",
        })
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.table())?;
        for sentence in self.wrong() {
            writeln!(f, "wrong: {sentence}")?;
        }
        Ok(())
    }
}
