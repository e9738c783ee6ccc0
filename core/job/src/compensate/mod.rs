//! `--compensate-servo`: points of the path are moved so that the tool, the servos in between, comes nearer to the path of
//! the CL file.
//!
//! The program is made, predicted, and held against the path of the CL file; each point of a cut is moved by minus the
//! error beside it, and so again until it helps no more. No point moves by more than `[accuracy]
//! servo_compensation`, towards the ends of cuts by nothing; rapids, holes and cuts that the control offsets by the
//! cutter's radius stay as they are, and so does every tool axis. A corner that the servos round by more than the bound
//! stays rounded.
//!
//! What helps is judged by prediction alone, against the path of the CL file: a run counts if its root mean square is less
//! than the last's and no error beside a moved point is larger than the largest of the program as it was. Where a run makes
//! it worse, points are moved by less, and not at all beside an error that is larger than any was; the others go on. Where
//! no run counts, the program is written as it was.
//!
//! The points of the file are in memory meanwhile, about 150 bytes each; programs that are tried are in scratch files.

mod path;
mod text;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_posting::ProgramPreview;
use serde::Serialize;

use super::one_program::OneProgram;
use super::rounds::Rounds;
use crate::failure::Failure;
use crate::files::{ClSource, Scratch};
use path::{Errors, PathRecorder};
pub use path::{PointShifts, ShiftedPath};
pub use text::text;

/// Runs at most.
const RUNS: u32 = 6;

/// Of a run that lowers the root mean square by less than this share nothing more is to be had.
const ENOUGH: f64 = 0.05;

/// A run that lowers it by less than this share is none that helps.
const WORTH: f64 = 0.01;

/// Where no point is moved, the largest error may come out larger by this share: set-points fall elsewhere, and where the
/// tool leaves the part at rapid it goes so far between two of them.
const ELSEWHERE: f64 = 0.1;

/// How far the tool is off the CL path in cuts, the servos in between.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CutDeviation {
    /// At most, mm.
    pub largest_mm: f64,
    /// Line of the program.
    pub nc_line: u64,
    /// Line of the CL file.
    pub cl_line: Option<u64>,
    /// Root mean square, mm.
    pub rms_mm: f64,
    /// The same of what the servos alone add to it: the tool off the path that is commanded.
    pub following_rms_mm: f64,
}

/// What compensation has done.
#[derive(Clone, Debug, Serialize)]
pub struct CompensationSummary {
    /// By how much a point may be moved, mm.
    pub bound_mm: f64,
    /// The program as it was.
    pub before: CutDeviation,
    /// The program that is written.
    pub after: CutDeviation,
    /// Programs that were tried.
    pub runs: u32,
    /// Points of the path.
    pub points: u64,
    /// Of them those that are moved.
    pub points_moved: u64,
    /// The largest move, mm.
    pub largest_move_mm: f64,
    /// It helps: the program is written with it.
    pub kept: bool,
}

/// How a program is compensated.
pub struct ServoCompensation {
    /// The machine that it is posted for: what takes points out of the path is switched off.
    pub machine: Machine,
    /// By how much its points are moved; none: it is written as it was.
    pub moves: Option<PointShifts>,
    /// What it does.
    pub found: CompensationSummary,
}

/// Finds by how much the points of a program are moved.
///
/// # Errors
/// The machine file does not allow it or describes no servo, or the program cannot be made.
pub fn compensate(
    program: &OneProgram<'_>,
    ahead: Option<&ProgramPreview>,
    source: &mut ClSource,
) -> Result<ServoCompensation, Failure> {
    let bound = allowed(program.machine).map_err(|fault| *fault)?;
    let mut machine = program.machine.clone();
    // Moved points lie on no arc any more, and those that are left out cannot be moved.
    machine.control.arcs.keep = false;
    machine.control.arcs.fit = false;
    machine.accuracy.reduce = false;
    let mut path = PathRecorder::default();
    let mut rounds = Rounds::new(program, ahead, source);
    let plain = OneProgram { machine: &machine, ..program.clone() };
    rounds.make(plain.clone(), Some(&mut path))?;
    let text = rounds.make(program.clone(), None)?;
    let mut errors = Errors::of(&path);
    let before = stray(&mut rounds, text, &path, &mut errors)?;
    let mut moves: PointShifts = vec![[0.0; 3]; path.len()];
    let (mut after, mut last, mut kept) = (before, before, false);
    let mut gains = vec![1.0; path.len()];
    let mut runs = 0;
    while runs < RUNS {
        runs += 1;
        let mut next = moves.clone();
        path.step(&mut next, &errors, &gains, bound);
        let text = rounds.make(plain.clone(), Some(&mut ShiftedPath::new(&next)))?;
        let mut left = Errors::of(&path);
        let found = stray(&mut rounds, text, &path, &mut left)?;
        if found.rms_mm == last.rms_mm {
            // The moves are less than the last digit of a word: the program is the same.
            break;
        }
        last = found;
        let most = before.largest_mm;
        let worse = left.damp(&errors, most, &mut gains);
        let larger = left.largest_at(&next) > most || found.largest_mm > most * (1.0 + ELSEWHERE);
        // Less may be chance, and is no help.
        if larger || found.rms_mm > after.rms_mm * (1.0 - WORTH) {
            if !worse {
                break;
            }
            continue;
        }
        let enough = found.rms_mm > after.rms_mm * (1.0 - ENOUGH);
        (moves, errors, after, kept) = (next, left, found, true);
        if enough {
            break;
        }
    }
    let sizes = moves.iter().map(|by| {
        let [x, y, z] = by.map(f64::from);
        (x * x + y * y + z * z).sqrt()
    });
    let found = CompensationSummary {
        bound_mm: bound,
        before,
        after,
        runs,
        points: path.len() as u64,
        points_moved: sizes.clone().filter(|size| *size > 0.0).count() as u64,
        largest_move_mm: sizes.fold(0.0, f64::max),
        kept,
    };
    Ok(ServoCompensation { machine, moves: kept.then_some(moves), found })
}

/// By how much points may be moved, mm.
fn allowed(machine: &Machine) -> Result<f64, Box<Diagnostic>> {
    let Some(bound) = machine.accuracy.servo_compensation else {
        let message = "the machine file does not say by how much points may be moved";
        return Err(Diagnostic::error("compensate-servo", message)
            .help("[accuracy] servo_compensation = 0.003, in mm, allows it")
            .boxed());
    };
    if machine.axes.iter().all(|axis| axis.servo.is_none()) {
        let message = "the machine file describes no servo: there is nothing to compensate";
        return Err(Diagnostic::error("compensate-servo", message)
            .help("[servo.X] for each axis says how it follows")
            .boxed());
    }
    Ok(bound)
}

/// How far the tool is off its path; beside each point of `path` the errors are added up.
fn stray(
    rounds: &mut Rounds<'_, '_>,
    text: Scratch,
    path: &PathRecorder,
    errors: &mut Errors,
) -> Result<CutDeviation, Failure> {
    let off = 2.0 * rounds.program.machine.accuracy.tolerance;
    let found = rounds.predict(text, &mut |sample| {
        if let Some(asked) = &sample.point.asked {
            let place = sample.point.actual.tip - asked.error;
            errors.take(path, &place, off, &asked.error);
        }
    })?;
    let tip = found.contour.tip_mm;
    let following = found.contour.parts.iter().find(|part| part.part == "following");
    Ok(CutDeviation {
        largest_mm: tip.largest,
        nc_line: tip.nc_line,
        cl_line: tip.cl_line,
        rms_mm: tip.rms,
        following_rms_mm: following.map_or(0.0, |part| part.tip_mm.rms),
    })
}
