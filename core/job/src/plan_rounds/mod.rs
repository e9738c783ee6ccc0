//! `--plan-rounds`: the feed is planned again, more gently where the servos are predicted to stray too far.
//!
//! The limit `[plan] contour_error` is kept by a formula of the steady state. The program is made, predicted, and where the
//! tool is farther off the commanded path than the limit allows, the limit there is multiplied with limit over error, less
//! a margin, as far around as the servos take to settle; then the program is made again. It ends where nothing exceeds the
//! limit, or when the rounds are used up: then the program that exceeds it for the least time is kept. What rapids leave at
//! the ends of cuts is told and not counted: no feed changes it.
//!
//! What stands in the memory meanwhile are the cells of the path that are tightened, 32 bytes each, four a mm or more;
//! programs that are tried are in scratch files.

mod excess;
mod text;

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::servo::FrequencyResponse;
use post_posting::{ProgramPreview, Tightening};
use serde::Serialize;

use super::one_program::OneProgram;
use super::rounds::Rounds;
use crate::failure::Failure;
use crate::files::ClSource;
use excess::{ContourExcess, Excess, Settling};
pub use text::text;

/// A servo has settled after so many times the inverse of its bandwidth, all but what its slowest pole remembers, and that
/// after so many times the inverse of that.
const SETTLED: f64 = 5.0;

/// No settling time is taken for longer, s.
const LONGEST: f64 = 0.25;

/// What is predicted of a program.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Round {
    /// How long it takes, s.
    pub cycle_s: f64,
    /// Of it moves at feed, s.
    pub cutting_s: f64,
    /// How far the servos leave the tool off the commanded path in cuts at most, mm; what rapids do to the ends
    /// of cuts is told apart, for no feed changes it.
    pub contour_mm: f64,
    /// Line of the program in which they do.
    pub nc_line: u64,
    /// Line of the CL file.
    pub cl_line: u64,
    /// The same until the servos have settled from a rapid or a standstill before the cut, and where the next one has begun
    /// already, mm.
    pub beside_rapid_mm: f64,
    /// The tip off the path of the CL file in cuts at most, mm: chords and corners of the program counted in.
    pub tip_mm: f64,
    /// Time in cuts during which [`Round::contour_mm`] exceeds the limit, s.
    pub over_s: f64,
    /// Cells of the path at which less than the limit is allowed.
    pub tightened: usize,
}

/// What planning in rounds has done.
#[derive(Clone, Debug, Serialize)]
pub struct PlanRoundsSummary {
    /// The limit of the contour error, mm.
    pub limit_mm: f64,
    /// The program at the feeds of the CL file.
    pub unplanned: Round,
    /// The programs that were planned, one after the other.
    pub rounds: Vec<Round>,
    /// Which of them is written, from 0.
    pub chosen: usize,
    /// It keeps the limit.
    pub kept: bool,
}

impl PlanRoundsSummary {
    /// That of the program that is written.
    pub fn written(&self) -> &Round {
        &self.rounds[self.chosen]
    }
}

/// Plans a program until its predicted contour error keeps the limit, `most` times at most.
///
/// # Errors
/// The machine file has no limit or describes no servo, or the program cannot be made.
pub fn plan(
    program: &OneProgram<'_>,
    most: u32,
    ahead: Option<&ProgramPreview>,
    source: &mut ClSource,
) -> Result<(Option<Arc<Tightening>>, PlanRoundsSummary), Failure> {
    let allowed = allowed(program.machine).map_err(|fault| *fault)?;
    let mut tried = Rounds::new(program, ahead, source);
    let (unplanned, _) = self::round(&mut tried, allowed, None)?;
    let mut tightening = Arc::new(Tightening::default());
    let mut found = PlanRoundsSummary {
        limit_mm: allowed.limit,
        unplanned,
        rounds: Vec::new(),
        chosen: 0,
        kept: false,
    };
    let mut best = None;
    for round in 0..most.max(1) as usize {
        let (outcome, excess) = self::round(&mut tried, allowed, Some(Arc::clone(&tightening)))?;
        found.rounds.push(outcome);
        let better = |one: &Round, other: &Round| {
            let by = [one, other].map(|round| (round.over_s, round.contour_mm));
            by[0] < by[1]
        };
        if round == 0 || better(&outcome, found.written()) {
            found.chosen = round;
            best = Some(Arc::clone(&tightening));
        }
        let places = excess.finish();
        found.kept = outcome.contour_mm <= allowed.limit;
        if found.kept || places.is_empty() {
            // Either good, or as gentle as it gets where it is not.
            break;
        }
        Arc::make_mut(&mut tightening).push(places);
    }
    Ok((best, found))
}

/// Says so if the program that is written does not keep the limit.
pub fn warning(found: &PlanRoundsSummary) -> Option<Diagnostic> {
    if found.kept {
        return None;
    }
    let written = found.written();
    let rounds = match found.rounds.len() {
        1 => "1 round".to_owned(),
        count => format!("{count} rounds"),
    };
    let message = format!(
        "after {} the servos still leave the tool {:.4} mm off its path in line {} of the program; [plan] \
         contour_error is {} mm",
        rounds, written.contour_mm, written.nc_line, found.limit_mm
    );
    let help = "more --plan-rounds, a lower feed there, or corners that the control rounds (`post predict` shows where)";
    Some(Diagnostic::warning("plan-rounds", message).help(help))
}

/// The contour error that is allowed, and the servos that have to keep it.
#[derive(Clone, Copy)]
struct ContourAllowance {
    /// mm.
    limit: f64,
    /// How fast the servos settle.
    settling: Settling,
}

/// What the machine file allows.
fn allowed(machine: &Machine) -> Result<ContourAllowance, Box<Diagnostic>> {
    let Some(limit) = machine.plan.contour_error else {
        let message = "the machine file does not say which contour error is to be kept";
        return Err(Diagnostic::error("plan-rounds", message)
            .help("[plan] contour_error = 0.01, in mm, or --set plan.contour_error=0.01")
            .boxed());
    };
    let servos = FrequencyResponse::of_machine(machine);
    let slowest =
        |of: fn(&FrequencyResponse) -> f64| servos.iter().flatten().map(of).reduce(f64::min);
    let pole =
        |servo: &FrequencyResponse| servo.poles().first().map_or(f64::INFINITY, |pole| -pole.real);
    let (Some(band), Some(pole)) = (slowest(FrequencyResponse::bandwidth), slowest(pole)) else {
        let message = "the machine file describes no servo: there is no contour error to keep";
        return Err(Diagnostic::error("plan-rounds", message)
            .help("[servo.X] for each axis says how it follows")
            .boxed());
    };
    let settling =
        Settling { stretch: (SETTLED / band).min(LONGEST), memory: (SETTLED / pole).min(LONGEST) };
    Ok(ContourAllowance { limit, settling })
}

/// One round with a plan that is so tightened; none: without a plan.
fn round(
    rounds: &mut Rounds<'_, '_>,
    allowed: ContourAllowance,
    tightening: Option<Arc<Tightening>>,
) -> Result<(Round, Excess), Failure> {
    let known = tightening.clone().unwrap_or_default();
    let tightened = tightening.as_ref().map_or(0, |it| it.places());
    let program = OneProgram { plans: tightening.is_some(), tightening, ..rounds.program.clone() };
    let text = rounds.make(program, None)?;
    let mut excess = Excess::new(allowed.limit, allowed.settling, known);
    let found = rounds.predict(text, &mut |sample| {
        let point = &sample.point;
        match &point.asked {
            _ if !sample.counts() => excess.rests(point.time),
            Some(asked) => {
                let tip = point.actual.tip - asked.error;
                let off = ContourExcess {
                    error: point.distance,
                    nc_line: point.at.line,
                    cl_line: asked.at.line,
                };
                match sample.at.cuts {
                    true => excess.take(point.time, &tip, off),
                    false => excess.take_beside_rapid(off),
                }
            }
            None => {}
        }
    })?;
    let largest = excess.largest;
    let round = Round {
        cycle_s: found.time.cycle_s,
        cutting_s: found.time.cutting_s,
        contour_mm: largest.error,
        nc_line: largest.nc_line,
        cl_line: largest.cl_line,
        beside_rapid_mm: excess.beside_rapid.error,
        tip_mm: found.contour.tip_mm.largest,
        over_s: excess.over as f64 * found.period_s,
        tightened,
    };
    Ok((round, excess))
}
