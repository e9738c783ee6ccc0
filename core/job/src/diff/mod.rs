//! What two NC programs make the machine do differently.

mod along;
mod page;

use post_machine::diagnostic::Diagnostic;
use post_readback::diff::{self, DiffRules, Difference, UnreadBlocks};

use super::nc_program::{self, NcControl, ProgramFile};
use crate::failure::Failure;
use crate::files::{AtomicFile, PathArg};
use crate::session::Session;
use crate::settings::ProgramSettings;
use page::DiffPage;

pub use along::{Bin, Path, PathComparison};

/// Differences that count for none.
#[derive(Clone, Copy, Debug)]
pub struct DiffTolerances {
    /// Of positions, mm.
    pub tip: f64,
    /// Of tool axes and rotary axes, radians.
    pub axis: f64,
    /// Of feeds, as a share.
    pub feed: f64,
}

/// Two programs that are compared, the old one first.
#[derive(Clone, Debug)]
pub struct DiffRequest {
    /// The programs.
    pub programs: [PathArg; 2],
    /// How each is read, and its machine.
    pub settings: [ProgramSettings; 2],
    /// The new program is one of another machine.
    pub other_machine: bool,
    /// Differences that count for none.
    pub tolerances: DiffTolerances,
    /// Which coolant flows makes no difference.
    pub any_coolant: bool,
    /// Numbers, names and registers of tools make none.
    pub any_tool: bool,
    /// Differences of cuts alone are told.
    pub cuts: bool,
}

/// One of the programs.
pub struct Side {
    /// The program.
    pub program: ProgramFile,
    /// The control that runs it.
    pub control: NcControl,
}

/// What came of it.
pub struct DiffResult {
    /// The old program and the new one.
    pub sides: [Side; 2],
    /// What counts as a difference.
    pub rules: DiffRules,
    /// What is different.
    pub found: Difference,
    /// Both paths, and how they differ along the way.
    pub along: PathComparison,
    /// What the user should know.
    pub findings: Vec<Diagnostic>,
}

/// Compares what two programs make their machines do.
///
/// # Errors
/// A block that is refused, or a file or a machine that cannot be used.
pub fn compare(session: &Session, request: &DiffRequest) -> Result<DiffResult, Failure> {
    let [first, second] = &request.programs;
    nc_program::not_both_standard("the two programs", first, Some(second))?;
    let [old, new] = &request.settings;
    let [old, new] = [NcControl::new(session, old)?, NcControl::new(session, new)?];
    let sides = [
        Side { program: ProgramFile::open(session, first)?, control: old },
        Side { program: ProgramFile::open(session, second)?, control: new },
    ];
    let rules = rules(request, sides.each_ref().map(|side| &side.control));
    let mut along = PathComparison::new(rules.tip);
    let opened = |new: bool| {
        let side = &sides[usize::from(new)];
        let program = &side.program;
        side.control.program_with_rapids(&program.name, Box::new(program.text()?))
    };
    let (found, unread) = diff::compare(&rules, opened, &mut |sample| along.take(sample))?;
    let UnreadBlocks { old: mut refused, new: more } = unread;
    refused.extend(more);
    if !refused.is_empty() {
        // What stands behind a block that is not run counts from elsewhere.
        return Err(refused.into());
    }
    let findings = unknown(&found.unknown).into_iter().collect();
    Ok(DiffResult { sides, rules, found, along, findings })
}

impl DiffResult {
    /// Writes what was compared to `file` as a page, of so many bytes at most.
    ///
    /// # Errors
    /// A program cannot be read again, or the page not be written.
    pub fn write_page(
        &self,
        session: &Session,
        names: [&PathArg; 2],
        most: u64,
        file: &mut AtomicFile,
    ) -> Result<(), Failure> {
        DiffPage { session, compared: self, names }.write(most, file)
    }
}

fn rules(request: &DiffRequest, [old, new]: [&NcControl; 2]) -> DiffRules {
    let axes = |control: &NcControl| -> Vec<(String, bool)> {
        let axes = control.machine.axes.iter();
        axes.map(|axis| (axis.name.clone(), axis.joint.rotary)).collect()
    };
    let one_machine = !request.other_machine && axes(old) == axes(new);
    let (axes, rotary) = axes(old).into_iter().unzip();
    let DiffTolerances { tip, axis, feed } = request.tolerances;
    DiffRules {
        tip,
        axis,
        feed,
        apart: diff::APART.max(4.0 * tip),
        one_machine,
        one_control: one_machine && old.machine.control.dialect == new.machine.control.dialect,
        coolants: !request.any_coolant,
        tools: !request.any_tool,
        cuts: request.cuts,
        axes,
        rotary,
    }
}

/// Words that are not understood may make a difference that is not seen.
fn unknown(unknown: &[Vec<String>; 2]) -> Option<Diagnostic> {
    let mut words: Vec<&str> = unknown.iter().flatten().map(String::as_str).collect();
    words.sort_unstable();
    words.dedup();
    if words.is_empty() {
        return None;
    }
    let message = format!("what {} does is not known, and not compared", words.join(", "));
    Some(Diagnostic::warning("nc-unknown", message))
}
