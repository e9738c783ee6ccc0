//! A planned motion through the servos: the contour error that they really make, beside the formula of the steady state.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_motion::contour::{Contour, ContourPoint};
use post_motion::servo::Servos;
use post_motion::{ProgramPlace, SetPoints};
use serde::Serialize;

use super::path::CurvePath;
use super::solve::StretchPlan;
use super::walk::Step;

/// Nearer than this to an end of the path is at it, mm.
const AT_END: f64 = 1e-9;

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
    nodes: Vec<TimeNode>,
}

#[derive(Clone, Copy)]
struct TimeNode {
    stretch: usize,
    parameter: f64,
    time: f64,
    way: f64,
    piece: usize,
    share: f64,
    formula: f64,
}

impl Timeline {
    /// Takes the next step.
    pub fn take(&mut self, step: &Step<'_>) {
        self.nodes.push(TimeNode {
            stretch: step.stretch,
            parameter: step.point.parameter,
            time: step.point.time,
            way: step.point.way,
            piece: step.piece,
            share: step.share,
            formula: step.point.contour_error,
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
        limit: f64,
    ) -> Result<Simulated, Box<Diagnostic>> {
        let period = path.machine.motion.period;
        let mut servos = Servos::new(path.machine, period)?;
        if servos.places().next().is_none() {
            let message = format!("{} has no servo to simulate", path.machine.name);
            let help = "servo in the limits of the curve file, or [servo.X] of the machine file, says what a servo does";
            return Err(Diagnostic::error("plan", message).help(help).boxed());
        }
        let mut points = SetPoints::new(Arc::clone(&path.solver), period);
        let commanded = self.commanded(path, plans, &mut points);
        servos.settle(&points.joints[0]);
        let mut actual = Vec::new();
        servos.follow(&points.joints, &mut actual);
        let ends = [&commanded[0], &commanded[commanded.len() - 1]];
        let mut errors = Vec::with_capacity(commanded.len());
        let mut take = |point: &ContourPoint| {
            let beyond = ends.into_iter().find(|end| (end.tip - point.nearest.tip).norm() < AT_END);
            // Who goes on straight before the beginning or beyond the end does not leave the contour.
            errors.push(beyond.map_or(point.distance, |end| point.error.cross(&end.along).norm()));
        };
        let mut contour = Contour::new();
        contour.take(&points, &actual, &mut take);
        contour.finish(&mut take);
        let formula = self.nodes.iter().map(|node| node.formula);
        let mut found = Simulated {
            period_s: period,
            set_points: commanded.len(),
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
        for (point, error) in commanded.iter().zip(errors) {
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
        let count = commanded.len() as f64;
        found.rms = libm::sqrt(found.rms / count);
        found.formula_rms = libm::sqrt(found.formula_rms / count);
        found.share_above_formula = above as f64 / count;
        found.share_above_limit = found.limit.map(|_| beyond as f64 / count);
        Ok(found)
    }

    /// Fills in the set-points, one each period, and tells of each where it is on the path.
    fn commanded(
        &self,
        path: &CurvePath<'_>,
        plans: &[StretchPlan],
        points: &mut SetPoints,
    ) -> Vec<Commanded> {
        let mut commanded = Vec::new();
        let mut node = 0;
        let end = self.nodes.last().map_or(0.0, |last| last.time);
        let count = libm::ceil(end / points.period) as usize;
        for index in 0..=count {
            let time = (index as f64 * points.period).min(end);
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
            let joints = station.course.joints[0];
            points.joints.push(joints);
            points.poses.push(path.solver.chain().forward(&joints));
            points.at.push(ProgramPlace { cuts: true, ..ProgramPlace::default() });
            let [tip, along, ..] = station.tip.map(Vector3::from);
            commanded.push(Commanded {
                tip,
                along: along.try_normalize(0.0).unwrap_or_default(),
                way: from.way + share * (to.way - from.way),
                formula: from.formula.max(to.formula),
            });
        }
        commanded
    }
}

/// Where a set-point is on the path.
struct Commanded {
    tip: Vector3<f64>,
    /// The way that the path goes there.
    along: Vector3<f64>,
    /// mm along the path.
    way: f64,
    /// What the formula says there, mm.
    formula: f64,
}
