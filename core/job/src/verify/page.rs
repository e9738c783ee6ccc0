//! `--report`: what was found, as a page.

use std::num::NonZeroUsize;

use post_machine::description::Machine;
use post_readback::verify::{BlockReport, WorstDeviation};
use post_report::meta::{Maximum, Names, VerdictMeta};

use crate::clearance::ClearanceFound;
use crate::failure::Failure;
use crate::files::{AtomicFile, ClSource, PathArg};
use crate::nc_program::ProgramFile;
use crate::read_back::VerifiedProgram;
use crate::report::{self, ClearanceRows, LineFacts, MotionRows, PartText, Parts};
use crate::session::Session;
use crate::text::clock;

/// What was found of a line.
pub fn heard(row: &BlockReport) -> LineFacts {
    LineFacts {
        cl: row.cl_line.unwrap_or(0),
        deviation: [row.tip_deviation_mm, row.axis_deviation_deg],
        limit: row.limited_by.as_deref().map(str::to_owned),
        ..LineFacts::default()
    }
}

/// What a page is told of a program that was held against its CL file.
pub struct VerifyPage<'a> {
    /// The run.
    pub session: &'a Session,
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// What was found.
    pub held: &'a VerifiedProgram,
    /// What was proven of clearance, or was not.
    pub clearance: Option<&'a ClearanceFound>,
    /// The program and the CL file.
    pub names: [&'a PathArg; 2],
    /// Over the machine's: mm, radians.
    pub tolerances: [Option<f64>; 2],
    /// Threads that work at most.
    pub threads: NonZeroUsize,
}

impl VerifyPage<'_> {
    /// Writes it to `page`, of so many bytes at most.
    ///
    /// # Errors
    /// A text cannot be read again, or the report not be written.
    pub fn write(
        &self,
        rows: MotionRows<'_>,
        near: Option<ClearanceRows>,
        source: &mut ClSource,
        program: &ProgramFile,
        most: u64,
        page: &mut AtomicFile,
    ) -> Result<(), Failure> {
        let [nc, cl] = self.names.map(report::name_of);
        let title = format!("{nc} against {cl}");
        let names =
            Names { nc: Some(nc), cl: Some(cl), nc2: None, machine: self.machine.name.clone() };
        let mut meta = report::about("verify", self.machine, title, names);
        let [tip, axis] = self.tolerances;
        if let Some(tip) = tip {
            meta.tolerances.tip = tip;
        }
        if let Some(axis) = axis {
            meta.tolerances.axis = axis.to_degrees();
        }
        let found = &self.held.found;
        let maximum = |name: &str, worst: &WorstDeviation, unit, limit| Maximum {
            name: name.to_owned(),
            value: worst.value,
            unit,
            limit: Some(limit),
            row: None,
            nc: (worst.nc_line > 0).then_some(worst.nc_line),
            cl: (worst.cl_line > 0).then_some(worst.cl_line),
        };
        meta.maxima = vec![
            maximum("tip deviation", &found.tip, "mm", meta.tolerances.tip),
            maximum("axis deviation", &found.axis, "deg", meta.tolerances.axis),
        ];
        meta.verdict = self.verdict();
        let fact = |name: &str, value: String| [name.to_owned(), value];
        meta.facts = vec![
            fact("machine", self.machine.name.clone()),
            fact("motions", found.motions.to_string()),
            fact("cuts", found.cuts.to_string()),
            fact("rapids", found.rapids.to_string()),
            fact("holes", found.holes.to_string()),
            fact("times a cut is left and gone on with", found.excursions.to_string()),
            fact("rapids made at feed", found.rapids_at_feed.to_string()),
            fact("time", clock(found.time_s)),
        ];
        meta.warnings = report::warnings(&self.held.findings, &program.name);
        // The same job gives the same page wherever its files lie.
        for warning in &mut meta.warnings {
            for file in self.names {
                warning.text = report::without_folder(&warning.text, file.path());
            }
        }
        let proven = self.clearance.map(ClearanceFound::summary);
        if let Some(proven) = &proven {
            let stock = proven.stock_rows();
            meta.facts.push(fact("clearance", proven.fact()));
            meta.facts.extend(stock.into_iter().map(|[name, value]| fact(&name, value)));
        }
        meta.excludes = report::excludes(proven.as_ref());
        let left = self.clearance.map_or(&[][..], |proven| &proven.left);
        let mut parts = Parts::with_left(self.session, self.machine, &mut meta, left)?;
        if let (Some(near), Some(proven)) = (near, &proven) {
            near.finish(proven, self.machine.clearance.keep, &mut parts, &mut meta)?;
        }
        rows.finish(&mut parts, &mut meta)?;
        let (mut text, mut cl) = (program.text()?, source.open()?);
        let nc = PartText { name: "nc", file: &program.name, text: &mut text };
        let cl = PartText { name: "cl", file: &cl.name, text: &mut cl.bytes };
        parts.two_texts([nc, cl], self.threads)?;
        parts.write(meta, most, page)
    }

    fn verdict(&self) -> VerdictMeta {
        let found = &self.held.found;
        let faults = found.faults.len();
        let not_clear = self.clearance.is_some_and(ClearanceFound::is_wrong);
        let (kind, word) = match (self.held.is_wrong(), self.held.findings.is_empty()) {
            (true, _) if not_clear && faults == 0 => ("bad", "Something is hit, or may be"),
            (true, _) => ("bad", "Not what the CL file asks for"),
            (false, false) => ("warn", "As the CL file asks, with warnings"),
            (false, true) => ("good", "As the CL file asks"),
        };
        let mut sentences = vec![format!(
            "{} cuts and {} holes were run as the control runs them and held against the CL file.",
            found.cuts, found.holes
        )];
        if faults > 0 {
            let more = if found.gave_up { " and more" } else { "" };
            sentences.push(format!("{faults}{more} faults were found: they are listed below."));
        }
        if not_clear {
            sentences.push(
                "That nothing hits anything is not proven: what is not clear is listed below."
                    .to_owned(),
            );
        }
        VerdictMeta { kind, word: word.to_owned(), sentences }
    }
}
