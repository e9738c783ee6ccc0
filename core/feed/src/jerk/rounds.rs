//! The convex-concave procedure over one stretch between two stops.

use super::forms::{self, LinearForm};
use super::rules::{Channels, IntervalRules, ROUNDING};
use super::spline::{Spline, StartState};
use super::{JerkSettings, Law};
use crate::infeasible::Infeasible;
use crate::interior::{ConvexProgram, Cost, Inequality};
use crate::limits::Order;
use crate::problem::LimitSource;

/// Gap to which each round goes.
const TOLERANCE: f64 = 1e-7;

/// A coefficient may be this often what reachability analysis has there: above the bounds of every plan, and small
/// enough that the unknowns are of the order of 1.
const ABOVE: f64 = 2.0;

/// Share of a limit by which rows are drawn in where a stretch begins in motion, or another goes on from within it.
/// What the iteration's tolerance leaves can then not break a limit, and what goes on has this much room: with a
/// hundredth of it, windows along a straight line found no plan from where they were left.
pub(super) const ROOM: f64 = 1e-4;

/// A part of a path without a stop on the way.
pub(super) struct NonstopSection<'a> {
    pub(super) channels: &'a Channels<'a>,
    pub(super) steps: &'a [f64],
    /// Bounds of `q` at the samples, and where they come from.
    pub(super) upper: &'a [f64],
    pub(super) causes: &'a [LimitSource],
    /// The plan without jerk limits.
    pub(super) fast: &'a [f64],
    pub(super) corners: &'a [bool],
    pub(super) start: StartState,
    /// `q` at its end.
    pub(super) end: f64,
    /// Share of a limit by which rows are drawn in.
    pub(super) room: f64,
}

/// The plan of a stretch.
pub(super) struct SectionPlan {
    pub(super) law: Law,
    pub(super) seconds: f64,
    /// The middle coefficient of each interval.
    pub(super) middles: Vec<f64>,
    /// The tangents with which its rows are kept, one an interval.
    pub(super) tangents: Vec<f64>,
}

/// How much work it was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PlanWork {
    pub(super) rounds: usize,
    pub(super) iterations: usize,
}

impl NonstopSection<'_> {
    /// The stretch's feed. The first tangents are `tangents`, one an interval, or the plan without jerk limits. Faults
    /// count samples from the beginning of the stretch.
    pub(super) fn plan(
        &self,
        settings: JerkSettings,
        tangents: Option<&[f64]>,
        work: &mut PlanWork,
    ) -> Result<SectionPlan, Infeasible> {
        let spline = Spline::new(self.steps, self.corners, self.start, self.end)?;
        let rules = IntervalRules::new(&spline, self.steps, self.channels);
        let fast = self.middles();
        let scale = self.scale(&spline, &fast);
        let mut bounds = self.bounds(&spline, &scale)?;
        self.cap_ends(&spline, &mut bounds);
        let mut tangents = tangents.unwrap_or(&fast).to_vec();
        let mut best: Option<SectionPlan> = None;
        let mut broken = None;
        for _ in 0..settings.rounds {
            let program = self.program(&spline, &scale, &bounds, &rules, &tangents);
            let solution =
                program.minimise(&start(&spline, &program, &tangents, &scale), TOLERANCE);
            work.iterations += solution.iterations;
            work.rounds += 1;
            let mut x = solution.x;
            if !x.iter().all(|x| x.is_finite()) {
                // No plan; braking at once shows what forbids it.
                x.clone_from(&program.lower);
            }
            keep(&program, &mut x);
            let unknowns: Vec<f64> = x.iter().zip(&scale).map(|(x, scale)| x * scale).collect();
            if let Some(fault) = rules.broken(&spline, &tangents, &unknowns) {
                broken = Some(fault);
                break;
            }
            let law = spline.law(self.steps, &unknowns);
            let seconds = law.duration();
            // What is not a number is no progress.
            let better = best.as_ref().is_none_or(|best| seconds < best.seconds);
            if !better || !seconds.is_finite() {
                break;
            }
            let own = &spline.unknowns[1..=self.steps.len()];
            let middles: Vec<f64> = own.iter().map(|&unknown| unknowns[unknown]).collect();
            let next = middles.clone();
            let before = best.replace(SectionPlan {
                law,
                seconds,
                middles,
                tangents: std::mem::replace(&mut tangents, next),
            });
            let least = |before: SectionPlan| before.seconds * (1.0 - settings.progress);
            if before.is_some_and(|before| seconds > least(before)) {
                break;
            }
        }
        best.ok_or_else(|| broken.unwrap_or(Infeasible::NoProgress { sample: 0 }))
    }

    /// What reachability analysis has in the middle of each interval.
    pub(super) fn middles(&self) -> Vec<f64> {
        let most = self.most();
        let pairs = self.fast.windows(2);
        let each = pairs.map(|pair| (0.5 * (pair[0] + pair[1])).max(1e-9 * most));
        each.collect()
    }

    fn most(&self) -> f64 {
        self.fast.iter().copied().fold(f64::MIN_POSITIVE, f64::max)
    }

    /// Scale of each unknown: what reachability analysis has there.
    fn scale(&self, spline: &Spline, middles: &[f64]) -> Vec<f64> {
        let mut scale = vec![self.most(); spline.count()];
        for (middle, &unknown) in middles.iter().zip(&spline.unknowns[1..]) {
            scale[unknown] = scale[unknown].min(*middle);
        }
        scale
    }

    /// Least and largest value of each unknown. Below the bounds of both its samples a coefficient keeps the spline
    /// below the line from bound to bound, between samples too.
    fn bounds(&self, spline: &Spline, scale: &[f64]) -> Result<Vec<[f64; 2]>, Infeasible> {
        let mut bounds: Vec<[f64; 2]> = scale.iter().map(|scale| [0.0, ABOVE * scale]).collect();
        for (interval, pair) in self.upper.windows(2).enumerate() {
            let most = &mut bounds[spline.unknowns[interval + 1]][1];
            *most = most.min(pair[0].min(pair[1]));
        }
        for (coefficient, &unknown) in spline.unknowns.iter().enumerate() {
            let Some(value) = spline.fixed(coefficient) else {
                continue;
            };
            // A coefficient between two samples is below both bounds, that of an end below the one there.
            let around = [coefficient.max(1) - 1, coefficient.min(self.steps.len())];
            let above = |at: &usize| value > self.upper[*at] * (1.0 + ROUNDING);
            let low = around.into_iter().find(above);
            if let Some(sample) = low {
                let source = self.causes[sample];
                return Err(Infeasible::Contradiction { sample, source });
            }
            bounds[unknown] = [value; 2];
        }
        Ok(bounds)
    }

    /// Bounds `q` after the first interval and before the last, where they are at rest.
    fn cap_ends(&self, spline: &Spline, bounds: &mut [[f64; 2]]) {
        let last = spline.intervals() - 1;
        for (interval, neighbour) in [(0, 2), (last, last)] {
            if spline.is_spline(interval) {
                continue;
            }
            let step = self.steps[interval];
            let mut most = f64::INFINITY;
            (self.channels)(interval, &mut |_, channel| {
                let channel = if interval == 0 { channel } else { forms::reversed(&channel) };
                most = most.min(match channel.order {
                    Order::Acceleration => {
                        channel.limit / forms::leaving_acceleration(&channel, step)
                    }
                    Order::Jerk => {
                        let root = libm::cbrt(channel.limit / forms::leaving_jerk(&channel, step));
                        root * root
                    }
                });
            });
            // `q` there is this part of the one coefficient beside it.
            let [here, next] = [spline.widths[interval + 1], spline.widths[neighbour]];
            let bound = &mut bounds[spline.unknowns[neighbour]][1];
            *bound = bound.min(most * (here + next) / here);
        }
    }

    /// The program of one round.
    fn program(
        &self,
        spline: &Spline,
        scale: &[f64],
        bounds: &[[f64; 2]],
        rules: &IntervalRules,
        tangents: &[f64],
    ) -> ConvexProgram<3> {
        let side = |k: usize| bounds.iter().zip(scale).map(move |(bound, scale)| bound[k] / scale);
        let mut program = ConvexProgram {
            cost: Cost::Time,
            weights: spline.weights(scale),
            lower: side(0).collect(),
            upper: side(1).collect(),
            offsets: vec![0],
            rows: Vec::with_capacity(2 * rules.len()),
        };
        for (interval, &tangent) in tangents.iter().enumerate() {
            let first = spline.first(interval);
            // The rows of an interval that begins with the same unknown go together.
            while program.offsets.len() <= first {
                program.offsets.push(program.rows.len());
            }
            // What is given keeps the row itself alone.
            let room = if spline.rest[0] || interval > 1 { self.room } else { 0.0 };
            for rule in rules.of(interval) {
                for side in [1.0, -1.0] {
                    let (form, most) = rule.linear(side, tangent);
                    let a = spline.in_unknowns(interval, form);
                    push(&mut program, first, a, most * (1.0 - room), scale);
                }
            }
        }
        while program.offsets.len() <= spline.count() {
            program.offsets.push(program.rows.len());
        }
        program
    }
}

/// Half of what the tangents are made at, between the bounds.
fn start(spline: &Spline, program: &ConvexProgram<3>, tangents: &[f64], scale: &[f64]) -> Vec<f64> {
    let mut start: Vec<f64> = program.lower.clone();
    for (tangent, &unknown) in tangents.iter().zip(&spline.unknowns[1..]) {
        start[unknown] = 0.5 * tangent / scale[unknown];
    }
    for (x, (low, high)) in start.iter_mut().zip(program.lower.iter().zip(&program.upper)) {
        *x = x.clamp(low + 1e-3 * (high - low), high - 1e-3 * (high - low));
    }
    start
}

/// Scales a row, takes what is fixed out of it, and leaves it away if nothing is left.
fn push(
    program: &mut ConvexProgram<3>,
    first: usize,
    mut a: LinearForm,
    mut most: f64,
    scale: &[f64],
) {
    for (k, a) in a.iter_mut().enumerate() {
        let Some(scale) = scale.get(first + k) else {
            continue;
        };
        *a *= scale;
        if program.upper[first + k] <= program.lower[first + k] {
            most -= *a * program.lower[first + k];
            *a = 0.0;
        }
    }
    if a.iter().any(|&value| value != 0.0) {
        program.rows.push(Inequality { a, most });
    }
}

/// Makes everything slower by so much as an iteration's tolerance may have left a row broken.
fn keep(program: &ConvexProgram<3>, x: &mut [f64]) {
    let mut share: f64 = 1.0;
    for (first, range) in program.offsets.windows(2).enumerate() {
        for row in &program.rows[range[0]..range[1]] {
            let value: f64 = row.a.iter().zip(&x[first..]).map(|(a, x)| a * x).sum();
            if value > row.most && row.most > 0.0 {
                share = share.min(row.most / value);
            }
        }
    }
    if share < 1.0 {
        for (unknown, x) in x.iter_mut().enumerate() {
            if program.upper[unknown] > program.lower[unknown] {
                *x *= share * (1.0 - 1e-15);
            }
        }
    }
}
