//! What became of a program that was made, as a page.

use std::io::Read;
use std::num::NonZeroUsize;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_posting::report::{PostingReport, ReportedDeviation};
use post_readback::verify::Verification;
use post_report::meta::{AxisUsed, Maximum, Names, VerdictMeta};

use super::{BlockRows, ClearanceRows, PartText, Parts, PredictedParts};
use crate::clearance::{ClearanceSummary, StockLeft};
use crate::failure::Failure;
use crate::files::{AtomicFile, ClSource, PathArg};
use crate::predict::Prediction;
use crate::session::Session;

/// What is known of a program that is made.
pub struct PostPage<'a> {
    /// The run.
    pub session: &'a Session,
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// What the CL file is called.
    pub cl: String,
    /// Where the program stands.
    pub program: &'a PathArg,
    /// What making it came to.
    pub report: &'a PostingReport,
    /// What reading it back found.
    pub verification: Option<&'a Verification>,
    /// What was proven of it: nothing hits anything.
    pub clearance: Option<ClearanceSummary>,
    /// What is left of the stocks that it cuts.
    pub left: &'a [StockLeft],
    /// What is predicted of it.
    pub prediction: Option<&'a Prediction>,
    /// What the user should know.
    pub findings: &'a [Diagnostic],
    /// What was done: `post`, `plan`, `convert`.
    pub job: &'static str,
    /// What its summary tells: names and values.
    pub facts: Vec<[String; 2]>,
    /// Threads that work at most.
    pub threads: NonZeroUsize,
}

/// The texts that a page shows beside its rows.
pub struct PageTexts<'t> {
    /// The CL file.
    pub source: &'t mut ClSource,
    /// The program, as messages call it.
    pub name: &'t str,
    /// The program, from its beginning.
    pub text: &'t mut (dyn Read + Send),
}

impl PostPage<'_> {
    /// Writes its report to `page`.
    ///
    /// # Errors
    /// A text cannot be read again, or the report not be written.
    pub fn write(
        &self,
        rows: BlockRows<'_>,
        near: Option<ClearanceRows>,
        predicted: Option<PredictedParts>,
        texts: PageTexts<'_>,
        most: u64,
        page: &mut AtomicFile,
    ) -> Result<(), Failure> {
        let PageTexts { source, name, text } = texts;
        let names = Names {
            nc: Some(super::name_of(self.program)),
            cl: Some(self.cl.clone()),
            nc2: None,
            machine: self.machine.name.clone(),
        };
        let title = format!("{} on {}", super::name_of(self.program), self.machine.name);
        let mut meta = super::about(self.job, self.machine, title, names);
        meta.verdict = self.verdict();
        meta.maxima = self.maxima();
        meta.facts = self.facts.clone();
        meta.axes_used = self.axes_used();
        meta.warnings = super::warnings(self.findings, name);
        meta.excludes = super::excludes(self.clearance.as_ref());
        meta.tool_length = self.report.tools.first().map_or(0.0, |tool| tool.length_mm);
        if let Some(found) = self.prediction {
            meta.maxima.extend(super::predicted_maxima(self.machine, found));
            meta.facts.extend(super::predicted_facts(found));
            meta.excludes.extend(found.assumed.iter().cloned());
            if super::is_exceeded(&meta.maxima) {
                meta.verdict.kind = "warn";
                meta.verdict.word = "Within tolerance, predicted beyond a limit".to_owned();
            }
        }
        let mut parts = Parts::with_left(self.session, self.machine, &mut meta, self.left)?;
        if let (Some(near), Some(proven)) = (near, &self.clearance) {
            near.finish(proven, self.machine.clearance.keep, &mut parts, &mut meta)?;
        }
        if let Some(predicted) = predicted {
            predicted.finish(&mut parts)?;
        }
        rows.finish(&mut parts, &mut meta)?;
        let mut cl = source.open()?;
        let nc = PartText { name: "nc", file: name, text };
        let cl = PartText { name: "cl", file: &cl.name, text: &mut cl.bytes };
        parts.two_texts([nc, cl], self.threads)?;
        parts.write(meta, most, page)
    }

    fn verdict(&self) -> VerdictMeta {
        let found = self.report;
        let mut sentences = vec![format!(
            "Every block of the program is certified to stay within {} mm of the CL path with the tip and within {}° with the tool axis.",
            shown(found.tolerance_mm),
            shown(found.axis_tolerance_deg)
        )];
        if let Some(held) = self.verification {
            sentences.push(format!(
                "It was read back: {} cuts and {} holes are as the CL file asks.",
                held.cuts, held.holes
            ));
        }
        if let Some(proven) = &self.clearance {
            sentences.push(format!("Nothing hits anything: {}.", proven.fact()));
        }
        let warned = self.findings.len();
        let (kind, word) = match warned {
            0 => ("good", "Within tolerance"),
            _ => ("warn", "Within tolerance, with warnings"),
        };
        if warned > 0 {
            let warnings = if warned == 1 { "warning" } else { "warnings" };
            sentences.push(format!("{warned} {warnings}: look at them before it runs."));
        }
        VerdictMeta { kind, word: word.to_owned(), sentences }
    }

    fn maxima(&self) -> Vec<Maximum> {
        let found = self.report;
        let maximum = |name: &str, deviation: ReportedDeviation, unit, limit: f64| Maximum {
            name: name.to_owned(),
            value: deviation.value,
            unit,
            limit: Some(limit),
            row: None,
            nc: (deviation.block > 0).then_some(deviation.block),
            cl: (deviation.line > 0).then_some(deviation.line),
        };
        let rapid = self.machine.accuracy.rapid_tolerance;
        vec![
            maximum("tip deviation", found.tip_deviation_mm, "mm", found.tolerance_mm),
            maximum("axis deviation", found.axis_deviation_deg, "deg", found.axis_tolerance_deg),
            maximum("rapid deviation", found.rapid_deviation_mm, "mm", rapid),
        ]
    }

    fn axes_used(&self) -> Vec<AxisUsed> {
        let used = self.report.axes.iter().filter(|axis| axis.min <= axis.max);
        let told = used.map(|axis| {
            let mut known = self.machine.axes.iter();
            AxisUsed {
                name: axis.name.clone(),
                unit: known
                    .find(|known| known.name == axis.name)
                    .map_or("mm", |known| known.unit_name()),
                min: axis.min,
                max: axis.max,
                travel: axis.travel,
                way: Some(axis.way),
            }
        });
        told.collect()
    }
}

/// A tolerance without the last digits of what was reckoned.
fn shown(tolerance: f64) -> f64 {
    (tolerance * 1e9).round() / 1e9
}
