//! Plans that keep limits of jerk too, everywhere along the path.
//!
//! **The law.** `q` is a quadratic spline of the parameter, with the samples as knots: acceleration is continuous and
//! linear in the parameter, jerk finite. Off from rest (and to it) no such spline exists; the first interval has
//! constant jerk along the path, `q ~ share^(4/3)`, which joins the spline with value and slope if the spline's
//! coefficient there is 0 and the interval counts as half as long again. So there is one unknown an interval.
//!
//! **The limits.** The jerk of an axis is `sqrt(q) * L(q)` with `L` linear in `q`, `q'`, `q''`: not convex. But
//! `|L| <= j / sqrt(q)` has a convex right side, which lies above each of its tangents: with any `m > 0`,
//! `|L| <= j * (3/2 - q / 2m) / sqrt(m)` is *sufficient*, and linear. Each round solves the convex program with `m`
//! from the round before (a convex-concave procedure), by the interior-point method with five diagonals: whatever
//! round is the last, its plan keeps every limit. Between samples too: both sides are cubics over an interval, and the
//! rows hold their Bernstein coefficients apart (see `forms`), exactly so for an axis that follows a cubic there.
//!
//! Samples are best closer together where the path is at rest: [`graded`].
//!
//! **Long paths** and paths with corners are planned in windows: [`JerkStream`].
//!
//! **The cost** is the time, `Σ weight / sqrt(coefficient)`, which by convexity is never below the true time.

pub(crate) mod forms;
mod law;
mod rounds;
mod rules;
mod spline;
mod stop_plan;
pub mod stream;

pub use law::{IntervalLaw, Law};
pub use stream::{JerkStream, PathBatch, SettledInterval};

use rounds::{NonstopSection, PlanWork, ROOM};
use spline::StartState;

use crate::infeasible::Infeasible;
use crate::limits::{Channel, Limit};
use crate::problem::Problem;
use crate::samples::Samples;
use crate::{profile, reach};

/// How long to go on.
#[derive(Clone, Copy, Debug)]
pub struct JerkSettings {
    /// Largest number of rounds.
    pub rounds: usize,
    /// The rounds end where one shortens the time by no more than this share.
    pub progress: f64,
}

impl Default for JerkSettings {
    fn default() -> Self {
        Self { rounds: 40, progress: 1e-5 }
    }
}

/// A plan with jerk limits.
#[derive(Clone, Debug, PartialEq)]
pub struct JerkPlan {
    /// The feed at every point of the path.
    pub law: Law,
    /// Time of the plan, s.
    pub seconds: f64,
    /// The time of the plan without jerk limits by reachability analysis, which no plan with them is below but for
    /// the difference of the laws between samples.
    pub bound: f64,
    /// Rounds of the convex-concave procedure, and iterations of the interior-point method in all of them.
    pub rounds: usize,
    /// Iterations of the interior-point method in all rounds.
    pub iterations: usize,
}

/// Factor by which a step is longer than the one nearer to rest.
const GROWTH: f64 = 1.03;

/// The step beside rest, as a share of the longest.
const SMALLEST: f64 = 1e-3;

/// Values of a parameter from `first` to `last`, where the path is at rest, in steps of at most about `step` that are
/// shorter and shorter towards both.
///
/// Over an interval `q''` is constant, so the jerk along the path grows with the speed and reaches its limit at one end
/// alone. Near rest, where the speed grows as the 2/3rd power of the way, that counts: a line of 100 mm takes 0.54 %
/// longer than its S-curve with a thousand even samples, and 0.24 % with these.
#[must_use]
pub fn graded(first: f64, last: f64, step: f64) -> Vec<f64> {
    let half = 0.5 * (last - first);
    let mut from_rest = vec![0.0];
    let (mut at, mut length) = (0.0, SMALLEST * step);
    while at < half {
        at += length;
        from_rest.push(at);
        length = (length * GROWTH).min(step);
    }
    let scale = half / at.max(f64::MIN_POSITIVE);
    let up = from_rest.iter().map(|at| first + at * scale);
    let down = from_rest.iter().rev().skip(1).map(|at| last - at * scale);
    up.chain(down).collect()
}

/// Plans a path under `limits`, from rest to rest, or with given speeds at its ends and no acceleration there. Where an
/// upper bound is 0 it stops on the way.
///
/// `problem` is made of the same samples and limits, with [`crate::limits::Collocation::Throughout`].
///
/// # Errors
/// Which limit cannot be kept, and where; [`Infeasible::TooShort`] where there are fewer than four intervals between
/// two stops.
pub fn solve(
    samples: &Samples,
    limits: &[&dyn Limit],
    problem: &Problem,
    settings: JerkSettings,
) -> Result<JerkPlan, Infeasible> {
    let fast = reach::solve(problem)?;
    let last = problem.steps.len();
    let mut law = Law { steps: problem.steps.clone(), pieces: Vec::with_capacity(last) };
    let mut work = PlanWork::default();
    let corners = vec![false; last + 1];
    let mut first = 0;
    while first < last {
        let stop = (first + 1..last).find(|&sample| problem.upper[sample] == 0.0);
        let next = stop.unwrap_or(last);
        let at = |sample: usize, end: f64| {
            let whole = sample == 0 || sample == last;
            if whole { end } else { 0.0 }
        };
        let start = StartState::even(at(first, problem.ends.start));
        let stretch = NonstopSection {
            channels: &|interval, sink| of_limits(samples, limits, first + interval, sink),
            steps: &problem.steps[first..next],
            upper: &problem.upper[first..=next],
            causes: &problem.causes[first..=next],
            fast: &fast[first..=next],
            corners: &corners[first..=next],
            start,
            end: at(next, problem.ends.end),
            room: if start.is_rest() { 0.0 } else { ROOM },
        };
        let planned = stretch.plan(settings, None, &mut work);
        let planned = planned.map_err(|fault| fault.shifted(first))?;
        law.pieces.extend(planned.law.pieces);
        first = next;
    }
    Ok(JerkPlan {
        seconds: law.duration(),
        law,
        bound: profile::duration(&problem.steps, &fast),
        rounds: work.rounds,
        iterations: work.iterations,
    })
}

/// What the limits hand on in an interval, each with its number.
fn of_limits(
    samples: &Samples,
    limits: &[&dyn Limit],
    interval: usize,
    sink: &mut dyn FnMut(u16, Channel),
) {
    for (index, limit) in limits.iter().enumerate() {
        limit.channels(samples, interval, &mut |channel| sink(index as u16, channel));
    }
}
