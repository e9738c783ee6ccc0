//! `--split`: one CL file, several programs, and with `--caller` one that calls them.

use std::path::Path;
use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, FurtherFile};
use post_posting::ProgramPreview;

use post_job::caller::{self, CalledProgram};
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::making::{ProgramMaker, ProgramPart};
use post_job::operations::ProgramLines;
use post_job::settings::Split;

/// The CL files of a job before they are split.
pub struct WholeJob {
    /// Where the files behind the first begin in their common text.
    pub begins: Arc<[FurtherFile]>,
    /// The lines that are chosen; none: all.
    pub chosen: Option<ProgramLines>,
}

/// The lines of the CL files that each program is made of: the first begins with them, the last ends with them.
pub fn lines(
    split: Split,
    ahead: &ProgramPreview,
    whole: &WholeJob,
) -> Result<Vec<ProgramLines>, Failure> {
    let (begins, what) = match split {
        // What stands before the first operation is part of it.
        Split::Operations => (ahead.operations.get(1..), "operation (TOOL PATH)"),
        Split::Tools => (Some(&ahead.parts[..]), "tool"),
    };
    let Some(begins) = begins else {
        let message = format!("--split: the CL file has no {what}");
        return Err(Diagnostic::error("split", message)
            .help("--split tools goes by its tool changes; without it there is one program")
            .into());
    };
    let mut starts = vec![0];
    starts.extend_from_slice(begins);
    if split == Split::Operations {
        for file in whole.begins.iter() {
            // What stands at the head of a file is part of its own first operation.
            if let Some(first) = starts.iter_mut().find(|start| **start >= file.before) {
                *first = file.before;
            }
        }
    }
    starts.dedup();
    let ends = starts[1..].iter().copied().chain([u64::MAX]);
    let parts = starts.iter().zip(ends).map(|(start, end)| match &whole.chosen {
        Some(chosen) => chosen.within(&(*start..end)),
        None => ProgramLines::part(*start..end),
    });
    Ok(parts.filter(|part| !part.ranges.is_empty()).collect())
}

/// The target of program `number` (from 1) of `count`: `part.nc` becomes `part-03.nc`, with this `dash`.
pub fn target(whole: &PathArg, dash: &str, number: usize, count: usize) -> PathArg {
    let digits = count.to_string().len();
    whole.map(|path: &Path| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let mut name = format!("{stem}{dash}{number:0digits$}");
        if let Some(extension) = path.extension() {
            name.push('.');
            name.push_str(&extension.to_string_lossy());
        }
        path.with_file_name(name)
    })
}

/// The targets of `count` programs for what is `named` for all of them; none where it is not asked for.
pub fn each(named: &Option<PathArg>, split: Option<Split>, count: usize) -> Vec<PathArg> {
    match (named, split) {
        (None, _) => Vec::new(),
        (Some(named), None) => vec![named.clone()],
        (Some(named), Some(_)) => {
            let numbers = 1..=count;
            numbers.map(|number| target(named, "-", number, count)).collect()
        }
    }
}

/// The program that calls those of the parts.
pub struct Caller {
    /// Where it goes.
    pub target: PathArg,
    machine: Machine,
    calls: Vec<CalledProgram>,
}

/// The names of the operations that a part of a file has.
fn named(part: &ProgramPart, ahead: &ProgramPreview) -> String {
    let ranges = part.lines.iter().flat_map(|lines| &lines.ranges);
    let names: Vec<&str> = ranges.flat_map(|lines| ahead.named(lines.clone())).collect();
    names.join(", ")
}

impl Caller {
    /// Of these programs; `number` is that of the caller, those after it are theirs.
    pub fn of(
        programs: &[ProgramPart],
        ahead: &ProgramPreview,
        number: Option<i64>,
        target: PathArg,
        machine: Machine,
    ) -> Self {
        let calls = programs.iter().enumerate().map(|(index, part)| {
            let number = number.map(|first| first + index as i64 + 1);
            CalledProgram {
                number: number.and_then(|number| u32::try_from(number).ok()),
                name: part.target.stem().unwrap_or_default(),
                remark: named(part, ahead),
            }
        });
        let calls = calls.collect();
        // Lines of the machine file's own belong to what is called.
        Self { target, machine: machine.without_text(), calls }
    }

    /// Its text.
    ///
    /// # Errors
    /// The dialect has no words for it.
    pub fn text(&self, maker: &ProgramMaker<'_>) -> Result<String, Failure> {
        caller::text(&maker.finder, &self.machine, &maker.job.input, &self.target, &self.calls)
    }
}
