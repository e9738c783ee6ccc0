//! `--report`: what was compared, as a page: the new program in the place of the program, the path of the old one in the
//! place of the CL path.

use post_report::meta::{Maximum, Names, TolerancesMeta, VerdictMeta};

use super::{DiffResult, Side};
use crate::failure::Failure;
use crate::files::{AtomicFile, PathArg};
use crate::report::{self, ExtraColumns, MotionRows, OldPath, PartText, Parts};
use crate::session::Session;
use crate::text::{clock, number};

/// What a page is told of two programs.
pub struct DiffPage<'a> {
    /// The run.
    pub session: &'a Session,
    /// What was compared.
    pub compared: &'a DiffResult,
    /// The old program and the new one.
    pub names: [&'a PathArg; 2],
}

impl DiffPage<'_> {
    /// Writes it to `page`, of so many bytes at most.
    ///
    /// # Errors
    /// A program cannot be read again, or the page not be written.
    pub fn write(&self, most: u64, page: &mut AtomicFile) -> Result<(), Failure> {
        let DiffResult { sides, rules, .. } = self.compared;
        let machine = &sides[1].control.machine;
        let [old_name, new_name] = self.names.map(report::name_of);
        let title = format!("{new_name} against {old_name}");
        let names = Names {
            nc: Some(new_name),
            cl: None,
            nc2: Some(old_name),
            machine: machine.name.clone(),
        };
        let mut meta = report::about("diff", machine, title, names);
        meta.tolerances =
            TolerancesMeta { tip: rules.tip, axis: rules.axis.to_degrees(), rapid: rules.tip };
        meta.verdict = self.verdict();
        meta.maxima = self.maxima();
        meta.facts = self.facts();
        let mut parts = Parts::of(self.session, machine, &mut meta)?;
        let besides = ExtraColumns { other: true, ..ExtraColumns::default() };
        let run = |place: usize| -> Result<_, Failure> {
            let Side { control, program } = &sides[place];
            let run = control.run(&program.name, program.text()?);
            Ok(run.map_err(|fault| *fault)?)
        };
        let (old, mut new) = (run(0)?, run(1)?);
        let rows = MotionRows::new(machine, None, besides)?;
        let mut rows = rows.against(OldPath::new(machine, old)?);
        while let Some(done) = new.block() {
            done.iter().for_each(|done| rows.take(done));
        }
        rows.finish(&mut parts, &mut meta)?;
        for (part, Side { program, .. }) in ["nc2", "nc"].into_iter().zip(sides) {
            let (name, file) = (part, program.name.as_str());
            parts.text(PartText { name, file, text: &mut program.text()? })?;
        }
        parts.write(meta, most, page)
    }

    fn verdict(&self) -> VerdictMeta {
        let operations = &self.compared.found.operations;
        let different = operations.iter().filter(|operation| !operation.same);
        let (kind, word, sentence) = match self.compared.found.same {
            true => ("good", "The same", "Both programs make the machine do the same.".to_owned()),
            false => (
                "warn",
                "Different",
                format!("{} of {} operations are different.", different.count(), operations.len()),
            ),
        };
        let mut sentences = vec![sentence];
        if self.compared.rules.cuts {
            let count = self.compared.found.beside_cuts;
            sentences
                .push(format!("Cuts alone are compared; differences of anything else: {count}."));
        }
        VerdictMeta { kind, word: word.to_owned(), sentences }
    }

    fn maxima(&self) -> Vec<Maximum> {
        let mut maxima = Vec::new();
        for (index, operation) in self.compared.found.operations.iter().enumerate() {
            let name = operation.name.clone();
            let name = name.unwrap_or_else(|| format!("operation {}", index + 1));
            for (what, worst, unit, limit) in [
                ("tip", &operation.tip, "mm", self.compared.rules.tip),
                ("tool axis", &operation.axis, "deg", self.compared.rules.axis.to_degrees()),
            ] {
                if worst.value > 0.0 {
                    maxima.push(Maximum {
                        name: format!("{what} apart in {name}"),
                        value: worst.value,
                        unit,
                        limit: Some(limit),
                        row: None,
                        nc: Some(worst.lines[1]),
                        cl: None,
                    });
                }
            }
        }
        maxima
    }

    fn facts(&self) -> Vec<[String; 2]> {
        let sides = ["old", "new"].into_iter().zip(&self.compared.found.sides);
        let mut facts: Vec<[String; 2]> = sides
            .map(|(name, side)| {
                let value = format!(
                    "{} motions, {} mm at feed, {}",
                    side.motions,
                    number(side.cut_mm, 1),
                    clock(side.seconds)
                );
                [name.to_owned(), value]
            })
            .collect();
        let unknown: Vec<String> = self.compared.found.unknown.iter().flatten().cloned().collect();
        if !unknown.is_empty() {
            facts.push(["not compared".to_owned(), unknown.join(", ")]);
        }
        facts
    }
}
