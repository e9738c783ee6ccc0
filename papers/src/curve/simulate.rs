//! A planned motion through the servos: the contour error that they really make, beside the formula of the steady state.

use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_motion::servo::Servos;
use serde::Serialize;

use super::path::CurvePath;
use super::solve::StretchPlan;
use super::walk::Step;
use post_command::shared::plan::gauges::PlanPoint;

/// The path within so many mm of where the axes are commanded is looked at for the nearest point, and within so many
/// times their lag.
const AROUND: f64 = 1.0;
const LAGS: f64 = 3.0;

/// What came of it, mm.
#[derive(Clone, Debug, Serialize)]
pub struct Simulated {
    /// Time from one set-point to the next, s.
    pub period_s: f64,
    pub set_points: usize,
    /// The largest contour error of the simulation.
    pub largest: f64,
    /// There, mm along the path.
    pub at_mm: f64,
    /// What the formula says there, at the commanded point.
    pub formula_there: f64,
    /// The largest that the formula says anywhere on the path.
    pub formula_largest: f64,
    /// Root of the mean square over the set-points, of both.
    pub rms: f64,
    pub formula_rms: f64,
    /// By how much the simulation is above the formula at most, at one set-point.
    pub most_above_formula: f64,
    /// There, mm along the path.
    pub most_above_at_mm: f64,
    /// Share of the set-points at which the simulation is above the formula.
    pub share_above_formula: f64,
    /// The largest contour error that was asked for, and the share of the set-points above it; none where it is not
    /// limited.
    pub limit: Option<f64>,
    pub share_above_limit: Option<f64>,
}

/// The walk, kept for the simulation.
#[derive(Default)]
pub struct Timeline {
    nodes: Vec<Node>,
}

#[derive(Clone, Copy)]
struct Node {
    stretch: usize,
    parameter: f64,
    time: f64,
    way: f64,
    piece: usize,
    share: f64,
    tip: [f64; 3],
    formula: f64,
}

impl Timeline {
    /// Takes the next step.
    pub fn take(&mut self, step: &Step<'_>) {
        let PlanPoint { parameter, time, way, tip, contour_error, .. } = *step.point;
        self.nodes.push(Node {
            stretch: step.stretch,
            parameter,
            time,
            way,
            piece: step.piece,
            share: step.share,
            tip,
            formula: contour_error,
        });
    }

    /// Puts the motion through the servos of the machine.
    ///
    /// # Errors
    /// It has none, or the period is out of all proportion.
    pub fn simulate(
        &self,
        path: &CurvePath<'_>,
        plans: &[StretchPlan],
        period: f64,
        limit: f64,
    ) -> Result<Simulated, Box<Diagnostic>> {
        let mut servos = Servos::new(path.machine, period)?;
        if servos.places().next().is_none() {
            let message = format!("{} has no servo to simulate", path.machine.name);
            let help = "servo in the limits of the curve file, or [servo.X] of the machine file, says what a servo does";
            return Err(Diagnostic::error("plan", message).help(help).boxed());
        }
        let commanded = self.commanded(path, plans, period);
        let joints: Vec<Joints> = commanded.iter().map(|point| point.joints).collect();
        servos.settle(&joints[0]);
        let mut actual = Vec::new();
        servos.follow(&joints, &mut actual);
        let formula = self.nodes.iter().map(|node| node.formula);
        let mut found = Simulated {
            period_s: period,
            set_points: joints.len(),
            largest: 0.0,
            at_mm: 0.0,
            formula_there: 0.0,
            formula_largest: formula.fold(0.0, f64::max),
            rms: 0.0,
            formula_rms: 0.0,
            most_above_formula: 0.0,
            most_above_at_mm: 0.0,
            share_above_formula: 0.0,
            limit: limit.is_finite().then_some(limit),
            share_above_limit: None,
        };
        let (mut above, mut beyond) = (0usize, 0usize);
        for (point, joints) in commanded.iter().zip(&actual) {
            let error = self.off(path, point, path.tip_at(joints).into());
            if error > found.largest {
                (found.largest, found.at_mm) = (error, point.way);
                found.formula_there = point.formula;
            }
            let excess = error - point.formula;
            if excess > found.most_above_formula {
                (found.most_above_formula, found.most_above_at_mm) = (excess, point.way);
            }
            above += usize::from(excess > 0.0);
            beyond += usize::from(error > limit);
            found.rms += error * error;
            found.formula_rms += point.formula * point.formula;
        }
        let count = joints.len() as f64;
        found.rms = libm::sqrt(found.rms / count);
        found.formula_rms = libm::sqrt(found.formula_rms / count);
        found.share_above_formula = above as f64 / count;
        found.share_above_limit = found.limit.map(|_| beyond as f64 / count);
        Ok(found)
    }

    /// Set-points, one each period.
    fn commanded(
        &self,
        path: &CurvePath<'_>,
        plans: &[StretchPlan],
        period: f64,
    ) -> Vec<Commanded> {
        let mut points = Vec::new();
        let mut node = 0;
        let end = self.nodes.last().map_or(0.0, |last| last.time);
        let count = libm::ceil(end / period) as usize;
        for index in 0..=count {
            let time = (index as f64 * period).min(end);
            while node + 2 < self.nodes.len() && self.nodes[node + 1].time <= time {
                node += 1;
            }
            let [from, to] = [self.nodes[node], self.nodes[node + 1]];
            // Two nodes at one time stand where one stretch ends and the next begins.
            let (parameter, share) = if to.stretch == from.stretch {
                let spline = &plans[to.stretch].spline;
                let begin = if to.piece == from.piece { from.share } else { 0.0 };
                let found = spline.share_after(to.piece, begin, time - from.time);
                let share = ((found - begin) / (to.share - begin)).clamp(0.0, 1.0);
                let step = to.parameter - from.parameter;
                (from.parameter + share * step, share)
            } else {
                (from.parameter, 0.0)
            };
            let Ok(station) = path.at(from.stretch, parameter) else {
                // The walk has been there.
                continue;
            };
            points.push(Commanded {
                node,
                joints: station.course.joints[0],
                tip: station.tip[0],
                way: from.way + share * (to.way - from.way),
                formula: from.formula.max(to.formula),
            });
        }
        points
    }

    /// How far `tip` is from the path around where it is commanded, mm.
    fn off(&self, path: &CurvePath<'_>, point: &Commanded, tip: [f64; 3]) -> f64 {
        let room = AROUND + LAGS * distance(point.tip, tip);
        let near = |node: &Node| (node.way - point.way).abs() <= room;
        let first = self.nodes[..=point.node].iter().rev().take_while(|node| near(node));
        let behind = self.nodes[point.node + 1..].iter().take_while(|node| near(node));
        let around = first.chain(behind);
        let nearest = around.min_by(|a, b| distance(a.tip, tip).total_cmp(&distance(b.tip, tip)));
        let Some(node) = nearest else {
            return distance(point.tip, tip);
        };
        let mut least = distance(node.tip, tip);
        let track = &path.stretches[node.stretch].tip;
        let [begin, end] = track.range();
        let mut parameter = node.parameter;
        // Where the path goes across the way to it: Newton's method for the root of (P - tip)·P'.
        for _ in 0..4 {
            let [at, first, second, _] = track.derivatives(parameter);
            let away: [f64; 3] = std::array::from_fn(|axis| at[axis] - tip[axis]);
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let (along, square) = (dot(away, first), dot(away, away));
            let beyond =
                (along < 0.0 && parameter >= end && node.stretch + 1 == path.stretches.len())
                    || (along > 0.0 && parameter <= begin && node.stretch == 0);
            if beyond {
                // Who goes on straight before the beginning or beyond the end does not leave the contour.
                let across = square - along * along / dot(first, first).max(f64::MIN_POSITIVE);
                return libm::sqrt(across.max(0.0));
            }
            least = least.min(libm::sqrt(square));
            let slope = dot(first, first) + dot(away, second);
            if slope <= 0.0 {
                break;
            }
            parameter = (parameter - along / slope).clamp(begin, end);
        }
        least
    }
}

struct Commanded {
    /// The last one of the walk before it.
    node: usize,
    joints: Joints,
    tip: [f64; 3],
    way: f64,
    formula: f64,
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b));
    libm::sqrt(squares.sum())
}
