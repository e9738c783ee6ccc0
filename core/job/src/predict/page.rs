//! `--report`: what is predicted, as a page.

use std::num::NonZeroUsize;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_report::meta::{Names, VerdictMeta};

use super::Prediction;
use crate::failure::Failure;
use crate::files::{AtomicFile, ClSource, PathArg};
use crate::nc_program::ProgramFile;
use crate::report::{self, MotionRows, PartText, Parts, PredictedLines};
use crate::session::Session;
use crate::text::clock;

/// What a page is told of a program that was predicted.
pub struct PredictPage<'a> {
    /// The run.
    pub session: &'a Session,
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// What was found.
    pub found: &'a Prediction,
    /// What was taken for granted.
    pub findings: &'a [Diagnostic],
    /// The program.
    pub program: &'a PathArg,
    /// The CL file, if there is one.
    pub against: Option<&'a PathArg>,
    /// Threads that work at most.
    pub threads: NonZeroUsize,
}

impl PredictPage<'_> {
    /// Writes it to `page`, of so many bytes at most.
    ///
    /// # Errors
    /// A text cannot be read again, or the report not be written.
    pub fn write(
        &self,
        mut rows: MotionRows<'_>,
        lines: PredictedLines,
        source: Option<&mut ClSource>,
        program: &ProgramFile,
        most: u64,
        page: &mut AtomicFile,
    ) -> Result<(), Failure> {
        let nc = report::name_of(self.program);
        let title = format!("{nc} on {}", self.machine.name);
        let names = Names {
            nc: Some(nc),
            cl: self.against.map(report::name_of),
            nc2: None,
            machine: self.machine.name.clone(),
        };
        let mut meta = report::about("predict", self.machine, title, names);
        meta.verdict = self.verdict();
        meta.maxima = report::predicted_maxima(self.machine, self.found);
        meta.facts = report::predicted_facts(self.found);
        meta.warnings = report::warnings(self.findings, &program.name);
        meta.excludes.clone_from(&self.found.assumed);
        let mut parts = Parts::of(self.session, self.machine, &mut meta)?;
        if let Some((line, heard)) = lines.finish(&mut parts)? {
            rows.hear(line, &heard);
        }
        rows.finish(&mut parts, &mut meta)?;
        let mut text = program.text()?;
        let nc = PartText { name: "nc", file: &program.name, text: &mut text };
        match source {
            None => parts.text(nc)?,
            Some(source) => {
                let mut cl = source.open()?;
                let cl = PartText { name: "cl", file: &cl.name, text: &mut cl.bytes };
                parts.two_texts([nc, cl], self.threads)?;
            }
        }
        parts.write(meta, most, page)
    }

    fn verdict(&self) -> VerdictMeta {
        let found = self.found;
        let tip = &found.contour.tip_mm;
        let path = match &found.against {
            Some(_) => "the path of the CL file",
            None => "the commanded path",
        };
        let far = tip.largest > self.machine.accuracy.tolerance;
        let maxima = report::predicted_maxima(self.machine, found);
        let over = report::is_exceeded(&maxima);
        let (kind, word) = match (far, over || !self.findings.is_empty()) {
            (true, _) => ("warn", "Predicted, beyond the tolerance"),
            (false, true) if over => ("warn", "Predicted, beyond a limit"),
            (false, true) => ("warn", "Predicted, with warnings"),
            (false, false) => ("good", "Predicted, within the tolerance"),
        };
        VerdictMeta {
            kind,
            word: word.to_owned(),
            sentences: vec![format!(
                "The program takes {}; in cuts the tip strays from {path} by {:.4} mm at most, {:.4} mm RMS.",
                clock(found.time.cycle_s),
                tip.largest,
                tip.rms
            )],
        }
    }
}
