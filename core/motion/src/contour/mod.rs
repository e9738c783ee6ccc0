//! The contour error: how far the tool is off its path, and what part of that comes from where.
//!
//! Where the axes are goes through the chain to the tip and the tool axis; the commanded set-points become a cubic
//! [spline](self#the-spline); the contour error is the distance of the tip to the nearest point of it (section 4.2 of
//! the prediction paper, Zhang, Chen 2025), and the angle of the tool axis against the one that is commanded there. A
//! tool that lags behind on its path has a following error and no contour error.
//!
//! # The spline
//! Set-points of 15 ms are coarse: on an arc of 10 mm at 5 m/min the chord is 20 µm off. So a cubic spline is laid
//! through them, with derivatives of five set-points each, so that its error falls with the fourth power of the period.
//! At corners, stops and reversals it goes by the chords and overshoots nothing; `spline.rs` states the rule.
//!
//! # The parts
//! From the actual tip to its nearest point on the commanded path (*following*: the servos), from there to the nearest
//! point of the path that the program asks for, straight between its blocks, on its arcs and splines (*interpolation*:
//! axes that go linearly, chords between set-points, corners that are left), and from there to the CL path (*program*:
//! points that are rounded, put in and left out). Each by itself; the whole is no more than their sum.
//!
//! # The nearest point
//! It is carried on from set-point to set-point; `path/nearest.rs` states which one is meant where the path crosses
//! itself, where the tool cuts a corner, and where it stands.

mod axes;
mod course;
mod leg;
mod path;
mod report;
mod spline;
mod spread;

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, Pose, Solver};

use crate::{ProgramPlace, SetPoints};
use axes::AxesPeaks;
pub use axes::AxisPeaks;
use course::FollowedPath;
pub use leg::{ContourLeg, ReferencePath};
use path::{CommandedPath, CommandedTip, Knot, PassedSetPoint};
pub use report::{AskedPoint, ContourPoint, ContourReport};
use spline::FivePoints;
pub use spread::{ContourPeak, ValueSpread};

/// Time by which the commanded path is known ahead of the actual position, s: feed forward may lead, but not by more.
const LEAD: f64 = 0.05;

/// Lead in set-points, at least and at most.
const LEADS: [f64; 2] = [4.0, 64.0];

/// A set-point that waits for what follows it.
#[derive(Clone, Copy, Debug)]
struct PendingSetPoint {
    number: u64,
    time: f64,
    joints: [Joints; 2],
    commanded: Pose,
    actual: Pose,
}

/// A set-point of the commanded path: its number, what of the program it belongs to, tip in mm and tool axis, part frame.
#[derive(Clone, Copy, Debug, Default)]
struct PathSetPoint {
    number: u64,
    at: ProgramPlace,
    tip: Vector3<f64>,
    axis: Vector3<f64>,
}

/// Finds contour errors of one batch of set-points after the other.
#[derive(Default)]
pub struct Contour<'r> {
    /// What the program asks for.
    programmed: FollowedPath,
    tasks: u64,
    /// The CL path, and what is known of it.
    reference: Option<Box<dyn ReferencePath + 'r>>,
    asked: FollowedPath,
    solver: Option<Arc<Solver>>,
    path: CommandedPath,
    /// The last three set-points, of which the first becomes the next knot, and how many of them are real.
    window: [PathSetPoint; 3],
    /// The differences of tips and tool axes by which the path passes it.
    tips: FivePoints,
    tool_axes: FivePoints,
    filled: usize,
    pending: VecDeque<PendingSetPoint>,
    /// Where the tool is at the set-points of the batch in work.
    poses: Vec<Pose>,
    /// Set-points that the path is ahead.
    lead: u64,
    axes: AxesPeaks,
    report: ContourReport,
}

impl<'r> Contour<'r> {
    /// Nothing has moved yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Holds the tool against a CL path too.
    pub fn against(mut self, reference: Box<dyn ReferencePath + 'r>) -> Self {
        self.reference = Some(reference);
        self
    }

    /// What the program asks for, all of it in order and each before its first set-point is taken: the [leg](ContourLeg::of)
    /// of the next task. Without, nothing is known of what comes of interpolating.
    pub fn ahead(&mut self, leg: Option<ContourLeg>) {
        let task = self.tasks;
        self.tasks += 1;
        if let Some(leg) = leg {
            self.programmed.push(&ContourLeg { at: ProgramPlace { task, ..leg.at }, ..leg });
        }
    }

    /// Takes set-points and where the axes are at their times, `actual` as many; `listen` is told of each, some batches
    /// after.
    pub fn take(
        &mut self,
        points: &SetPoints,
        actual: &[Joints],
        listen: &mut dyn FnMut(&ContourPoint),
    ) {
        if points.is_empty() {
            return;
        }
        let same = |solver: &Arc<Solver>| {
            Arc::ptr_eq(solver, &points.solver) || solver.chain() == points.solver.chain()
        };
        if !self.solver.as_ref().is_some_and(same) {
            self.settle(listen);
        }
        self.solver = Some(Arc::clone(&points.solver));
        let chain = points.solver.chain();
        let axes = chain.joints().len();
        self.report.axis_count = self.report.axis_count.max(axes);
        self.lead = (LEAD / points.period).clamp(LEADS[0], LEADS[1]) as u64;
        let mut jumps = points.jumps.as_slice();
        self.report.jumps += jumps.len() as u64;
        let mut poses = std::mem::take(&mut self.poses);
        poses.clear();
        chain.forward_all(&actual[..actual.len().min(points.len())], &mut poses);
        for (place, (actual, pose)) in actual.iter().zip(&poses).enumerate() {
            let joints = &points.joints[place];
            let (time, at) = (points.time(place), points.at[place]);
            let jumped = jumps.partition_point(|jump| jump.time <= time);
            let (now, later) = jumps.split_at(jumped);
            jumps = later;
            self.axes.take(axes, time, at.line, points.period, [joints, actual], now);
            self.report.seconds = time;
            let commanded = points.poses[place];
            let number = points.first + place as u64;
            self.pending.push_back(PendingSetPoint {
                number,
                time,
                joints: [*joints, *actual],
                commanded,
                actual: *pose,
            });
            self.knot(PathSetPoint { number, at, tip: commanded.tip, axis: commanded.axis });
            self.settled(self.lead, listen);
        }
        self.poses = poses;
    }

    /// Ends the program, and reports.
    pub fn finish(mut self, listen: &mut dyn FnMut(&ContourPoint)) -> ContourReport {
        self.settle(listen);
        self.report.axes = self.axes.peaks;
        self.report
    }

    /// The path ends: the machine stands before and after it.
    fn settle(&mut self, listen: &mut dyn FnMut(&ContourPoint)) {
        if self.filled > 0 {
            for _ in 0..2 {
                self.knot(self.window[2]);
            }
        }
        self.settled(0, listen);
        self.pending.clear();
        self.path.clear();
        self.filled = 0;
    }

    /// Takes the next set-point of the path: the one two before it becomes a knot.
    fn knot(&mut self, point: PathSetPoint) {
        if self.filled == 0 {
            self.window = [point; 3];
            (self.tips, self.tool_axes) =
                (FivePoints::all_at(&point.tip), FivePoints::all_at(&point.axis));
        }
        self.window = [self.window[1], self.window[2], point];
        let ways = [self.tips.take(&point.tip), self.tool_axes.take(&point.axis)];
        self.filled = (self.filled + 1).min(3);
        if self.filled < 3 {
            return;
        }
        let PathSetPoint { number, at, tip, axis } = self.window[0];
        self.path.push(Knot {
            number,
            at,
            tip,
            axis,
            tip_ways: ways[0],
            axis_ways: ways[1],
            length: 0.0,
            gap: false,
        });
    }

    /// Tells of the set-points that the path is `lead` ahead of.
    fn settled(&mut self, lead: u64, listen: &mut dyn FnMut(&ContourPoint)) {
        let Some(last) = self.pending.back().map(|last| last.number) else {
            return;
        };
        // Two set-points at the end are no knots yet, but where the path ends.
        let behind = lead + if lead == 0 { 0 } else { 2 };
        while self.pending.front().is_some_and(|first| first.number + behind <= last) {
            let Some(point) = self.pending.pop_front() else {
                break;
            };
            self.tell(&point, listen);
        }
    }

    fn tell(&mut self, point: &PendingSetPoint, listen: &mut dyn FnMut(&ContourPoint)) {
        let actual = point.actual;
        let commanded = CommandedTip { number: point.number, tip: point.commanded.tip };
        let nearest = self.path.nearest(&actual, commanded);
        let at = nearest.at;
        let axis = angle(&actual.axis, &nearest.axis);
        let commanded = Pose { tip: nearest.tip, axis: nearest.axis, edge: Vector3::zeros() };
        let mut told = ContourPoint {
            time: point.time,
            at,
            commanded_joints: point.joints[0],
            actual_joints: point.joints[1],
            commanded: point.commanded,
            actual,
            nearest: commanded,
            error: actual.tip - nearest.tip,
            distance: nearest.distance,
            axis,
            interpolation: 0.0,
            asked: None,
        };
        match at.cuts {
            true => self.parts(&mut told, nearest.way),
            false => {
                self.programmed.leave();
                self.asked.leave();
            }
        }
        self.report.take(&told, nearest.missed);
        listen(&told);
    }
}

impl Contour<'_> {
    /// What lies between the commanded path and what is asked for: where the tool is nearest to it, and on the way
    /// there since the last set-point, which a tool that lags cuts off at a corner.
    fn parts(&mut self, told: &mut ContourPoint, way: f64) {
        let mut left = way;
        let mut most = PathDistances::default();
        for place in 0..self.path.passed.len() {
            let PassedSetPoint { tip, axis, way } = self.path.passed[place];
            let pose = Pose { tip, axis, edge: Vector3::zeros() };
            left -= way;
            most = most.or(self.apart(&pose, way));
        }
        most = most.or(self.apart(&told.nearest, left.max(0.0)));
        told.interpolation = most.interpolation;
        if self.reference.is_none() {
            return;
        }
        let beside = self.asked.beside(&told.actual);
        if let (Some(program), Some(asked)) = (most.program, beside) {
            let axis = self.asked.axis(&told.actual, &asked);
            told.asked = Some(AskedPoint {
                at: asked.at,
                error: told.actual.tip - asked.tip,
                distance: asked.distance,
                axis: angle(&told.actual.axis, &axis),
                program,
            });
        }
    }

    /// How far a place of the commanded path, `way` mm along it from the last one, is off what is asked for.
    fn apart(&mut self, commanded: &Pose, mut way: f64) -> PathDistances {
        let mut programmed = *commanded;
        let mut apart = PathDistances::default();
        if let Some(asked) = self.programmed.follow(commanded, way, &mut || None) {
            apart.interpolation = asked.distance;
            way = asked.way;
            let axis = self.programmed.axis(commanded, &asked);
            (programmed.tip, programmed.axis) = (asked.tip, axis);
        }
        if let Some(reference) = &mut self.reference {
            let program = self.asked.follow(&programmed, way, &mut || reference.next());
            apart.program = program.map(|program| program.distance);
        }
        apart
    }
}

/// Distances between paths, mm.
#[derive(Clone, Copy, Debug, Default)]
struct PathDistances {
    /// Distance of the commanded path from that of the program.
    interpolation: f64,
    /// Distance of the program's path from the CL path; none where that is not known.
    program: Option<f64>,
}

impl PathDistances {
    /// The larger ones.
    fn or(self, other: Self) -> Self {
        Self {
            interpolation: self.interpolation.max(other.interpolation),
            program: match (self.program, other.program) {
                (Some(one), Some(other)) => Some(one.max(other)),
                (one, other) => one.or(other),
            },
        }
    }
}

/// The angle between two unit vectors, radians, as exact where it is small as where it is large.
fn angle(one: &Vector3<f64>, other: &Vector3<f64>) -> f64 {
    libm::atan2(one.cross(other).norm(), one.dot(other))
}
