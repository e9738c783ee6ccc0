//! `--plan`: whether a planned feed gains anything.
//!
//! A plan keeps accelerations, jerks and errors low, and pays for it with time. What it gains is the control's to say: both
//! programs are made and predicted, and where the one without a plan is faster and the tool no farther off the path of the
//! CL file, it is the one that is written. What cannot be predicted is not compared.

use post_machine::diagnostic::{Diagnostic, Short};
use post_posting::ProgramPreview;

use super::one_program::OneProgram;
use super::rounds::Rounds;
use crate::failure::Failure;
use crate::files::ClSource;

/// Shares of time and error that differ by less are the same.
const SAME: f64 = 1e-3;

/// Errors that differ by less are the same: mm, degrees.
const ROUNDED: f64 = 1e-5;

/// What is predicted of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PredictedFigures {
    /// How long it takes, s.
    cycle: f64,
    /// Off the path of the CL file in cuts, the tip (mm) and the tool axis (degrees): at most, and what 99 % and 95 % of the
    /// time and the root of the mean square are below.
    off: [f64; 8],
}

impl PredictedFigures {
    /// It takes less time, and is nowhere worse.
    fn beats(&self, other: &Self) -> bool {
        let no_larger = |one: f64, other: f64| one <= other * (1.0 + SAME) + ROUNDED;
        let mut off = self.off.iter().zip(&other.off);
        self.cycle < other.cycle * (1.0 - SAME) && off.all(|(one, other)| no_larger(*one, *other))
    }
}

/// That the plan of `program` gains nothing, if it does not.
///
/// # Errors
/// A scratch file or the CL file cannot be read or written.
pub fn gains_nothing(
    program: &OneProgram<'_>,
    ahead: Option<&ProgramPreview>,
    source: &mut ClSource,
) -> Result<Option<Diagnostic>, Failure> {
    let Some(planned) = outcome(program, true, ahead, source)? else {
        return Ok(None);
    };
    let Some(unplanned) = outcome(program, false, ahead, source)? else {
        return Ok(None);
    };
    if !unplanned.beats(&planned) {
        return Ok(None);
    }
    let tenths = |seconds: f64| Short(libm::rint(seconds * 10.0) / 10.0);
    let message = format!(
        "by prediction the program takes {} s with a planned feed and {} s without, and the tool is no farther off its path: it is written without the plan",
        tenths(planned.cycle),
        tenths(unplanned.cycle)
    );
    let help = "`post predict` tells how the control moves; [plan] limits what a plan keeps, [servo.X] and [motion] say what the control does by itself";
    Ok(Some(Diagnostic::warning("plan", message).help(help)))
}

/// What is predicted with a plan or without; none where the program cannot be made, which its making tells, or not be
/// predicted.
fn outcome(
    program: &OneProgram<'_>,
    plans: bool,
    ahead: Option<&ProgramPreview>,
    source: &mut ClSource,
) -> Result<Option<PredictedFigures>, Failure> {
    let mut rounds = Rounds::new(program, ahead, source);
    let text = match rounds.make(OneProgram { plans, ..program.clone() }, None) {
        Ok(text) => text,
        Err(Failure::Refused(_)) => return Ok(None),
        Err(failure) => return Err(failure),
    };
    let Ok(found) = rounds.predict(text, &mut |_| {}) else {
        return Ok(None);
    };
    let (tip, axis) = (&found.contour.tip_mm, &found.contour.axis_deg);
    Ok(Some(PredictedFigures {
        cycle: found.time.cycle_s,
        off: [tip.largest, tip.p99, tip.p95, tip.rms, axis.largest, axis.p99, axis.p95, axis.rms],
    }))
}
