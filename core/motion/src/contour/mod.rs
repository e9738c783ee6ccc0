//! The contour error: how far the tool is off its path, and what part of that comes from where.
//!
//! Where the axes are goes through the chain to the tip and the tool axis; the commanded set-points become a cubic
//! [spline](self#the-spline); the contour error is the distance of the tip to the nearest point of it (section 4.2 of the
//! prediction paper, Zhang, Chen 2025), and the angle of the tool axis against the one that is commanded there. A tool
//! that lags behind on its path has a following error and no contour error.
//!
//! # The spline
//! Set-points of 15 ms are coarse: on an arc of 10 mm at 5 m/min the chord is 20 µm off. So a cubic spline is laid through
//! them, with derivatives of five set-points each, so that its error falls with the fourth power of the period. At
//! corners, stops and reversals it goes by the chords and overshoots nothing; `spline.rs` states the rule.
//!
//! # The parts
//! From the actual tip to its nearest point on the commanded path (*following*: the servos), from there to the nearest
//! point of the path that the program asks for, straight between its blocks, on its arcs and splines (*interpolation*:
//! axes that go linearly, chords between set-points, corners that are left), and from there to the CL path (*program*:
//! points that are rounded, put in and left out). Each by itself; the whole is no more than their sum.
//!
//! # The nearest point
//! It is carried on from set-point to set-point; `path/nearest.rs` states which one is meant where the path crosses itself, where
//! the tool cuts a corner, and where it stands.

mod axes;
mod course;
mod leg;
mod path;
mod spline;
mod spread;

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, MAX_AXES, Pose, Solver};

use crate::{At, Pace, SetPoints, Task};
use axes::AxesPeaks;
pub use axes::AxisPeaks;
use course::Course;
pub use leg::{Leg, Reference};
use path::{Knot, Path};
use spline::Five;
pub use spread::{Peak, Spread};

/// The commanded path is known so far ahead of the actual position, s: feed forward may lead, but not by more.
const LEAD: f64 = 0.05;

/// The same as set-points, at least and at most.
const LEADS: [f64; 2] = [4.0, 64.0];

/// Where the tool was, and where on the commanded path that is nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourPoint {
    /// When, s from the beginning.
    pub time: f64,
    /// What was being carried out at the nearest point, not what is commanded meanwhile.
    pub at: At,
    /// Axis values that are commanded, mm and radians.
    pub commanded_joints: Joints,
    /// Axis values as they are.
    pub actual_joints: Joints,
    /// Tip and tool axis that are commanded, part frame.
    pub commanded: Pose,
    /// Tip and tool axis as they are.
    pub actual: Pose,
    /// Tip and tool axis at the nearest point of the commanded path.
    pub nearest: Pose,
    /// Actual minus nearest tip, mm, part frame.
    pub error: Vector3<f64>,
    /// Its length: the contour error, mm.
    pub distance: f64,
    /// Angle between the tool axis and the one at the nearest point, radians.
    pub axis: f64,
    /// Distance of that nearest point from the path that the program asks for, mm; zero where no task has been told.
    pub interpolation: f64,
    /// How the tool stands to the CL path; none at rapid, and where there is none.
    pub asked: Option<AskedPoint>,
}

/// How the tool stands to the CL path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AskedPoint {
    /// What asks for the nearest point: the line of the CL file, and the number that the leg was handed out with.
    pub at: At,
    /// Actual tip minus that point, mm, part frame.
    pub error: Vector3<f64>,
    /// Its length, mm.
    pub distance: f64,
    /// Angle between the tool axis and the one that is asked for there, radians.
    pub axis: f64,
    /// Distance of the program's path from the CL path, mm.
    pub program: f64,
}

/// What has been found about a program, or what was so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContourReport {
    /// Contour error in cuts, mm.
    pub cuts: Spread,
    /// Contour error of the tool axis in cuts, radians.
    pub axis: Spread,
    /// Contour error at rapid, mm.
    pub rapids: Spread,
    /// Distance of the commanded path from the path that the program asks for, in cuts, mm.
    pub interpolation: Spread,
    /// Distance of the program's path from the CL path, in cuts, mm; none without one.
    pub program: Spread,
    /// Distance of the tip from the CL path, in cuts, mm; none without one.
    pub asked: Spread,
    /// Angle of the tool axis against that of the CL path, in cuts, radians.
    pub asked_axis: Spread,
    /// Distance of the tip from where it is commanded at the same time, in cuts, mm.
    pub following: Spread,
    /// How far the tool stays off a corner of its path in a cut, mm: it passes from one leg to the other, and so the
    /// contour error says less than this.
    pub missed: Peak,
    /// The largest values of each axis, in chain order, cuts and rapids.
    pub axes: [AxisPeaks; MAX_AXES],
    /// How often a move passes into the next with a jump of the velocity.
    pub jumps: u64,
    /// How many axes there are.
    pub axis_count: usize,
    /// Time of the last set-point, s.
    pub seconds: f64,
}

/// A set-point that waits for what follows it.
#[derive(Clone, Copy, Debug)]
struct Pending {
    number: u64,
    time: f64,
    joints: [Joints; 2],
    commanded: Pose,
    actual: Pose,
}

/// Finds contour errors of one batch of set-points after the other.
#[derive(Default)]
pub struct Contour<'r> {
    /// What the program asks for.
    programmed: Course,
    tasks: u64,
    /// The CL path, and what is known of it.
    reference: Option<Box<dyn Reference + 'r>>,
    asked: Course,
    solver: Option<Arc<Solver>>,
    path: Path,
    /// The last three set-points, of which the first becomes the next knot, and how many of them are real.
    window: [(u64, At, Vector3<f64>, Vector3<f64>); 3],
    /// The differences of tips and tool axes by which the path passes it.
    tips: Five,
    tool_axes: Five,
    filled: usize,
    pending: VecDeque<Pending>,
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
    pub fn against(mut self, reference: Box<dyn Reference + 'r>) -> Self {
        self.reference = Some(reference);
        self
    }

    /// What the program asks for, all of it in order and each before its first set-point is taken: without, nothing is
    /// known of what comes of interpolating.
    pub fn ahead(&mut self, task: &Task) {
        let number = self.tasks;
        self.tasks += 1;
        if let Task::Move(go) = task {
            self.programmed.push(&Leg {
                at: At {
                    task: number,
                    line: go.line,
                    cuts: go.pace != Pace::Rapid,
                },
                way: go.way.clone(),
                from: go.from.pose,
                to: go.to.pose,
                along: 0.0,
            });
        }
    }

    /// Takes set-points and where the axes are at their times, `actual` as many; `listen` is told of each, some batches
    /// behind.
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
        for (place, actual) in actual.iter().enumerate().take(points.len()) {
            let joints = &points.joints[place];
            let (time, at) = (points.time(place), points.at[place]);
            let jumped = jumps.partition_point(|jump| jump.time <= time);
            let (now, later) = jumps.split_at(jumped);
            jumps = later;
            self.axes
                .take(axes, (time, &at), points.period, [joints, actual], now);
            self.report.seconds = time;
            let commanded = points.poses[place];
            let number = points.first + place as u64;
            self.pending.push_back(Pending {
                number,
                time,
                joints: [*joints, *actual],
                commanded,
                actual: chain.forward(actual),
            });
            self.knot((number, at, commanded.tip, commanded.axis));
            self.settled(self.lead, listen);
        }
    }

    /// There is no more.
    pub fn finish(mut self, listen: &mut dyn FnMut(&ContourPoint)) -> ContourReport {
        self.settle(listen);
        self.report.axes = self.axes.peaks;
        self.report
    }

    /// The path ends: the machine stands before and behind it.
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
    fn knot(&mut self, point: (u64, At, Vector3<f64>, Vector3<f64>)) {
        if self.filled == 0 {
            self.window = [point; 3];
            (self.tips, self.tool_axes) = (Five::all_at(&point.2), Five::all_at(&point.3));
        }
        self.window = [self.window[1], self.window[2], point];
        let ways = [self.tips.take(&point.2), self.tool_axes.take(&point.3)];
        self.filled = (self.filled + 1).min(3);
        if self.filled < 3 {
            return;
        }
        let (number, at, tip, axis) = self.window[0];
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
        while self
            .pending
            .front()
            .is_some_and(|first| first.number + behind <= last)
        {
            let Some(point) = self.pending.pop_front() else {
                break;
            };
            self.tell(&point, listen);
        }
    }

    fn tell(&mut self, point: &Pending, listen: &mut dyn FnMut(&ContourPoint)) {
        let actual = point.actual;
        let commanded = (point.number, &point.commanded.tip);
        let nearest = self.path.nearest(&actual, commanded);
        let at = nearest.at;
        let axis = angle(&actual.axis, &nearest.axis);
        let commanded = Pose {
            tip: nearest.tip,
            axis: nearest.axis,
            edge: Vector3::zeros(),
        };
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
    /// What lies between the commanded path and what is asked for.
    fn parts(&mut self, told: &mut ContourPoint, mut way: f64) {
        let asked = self.programmed.follow(&told.nearest, way, &mut || None);
        if let Some(asked) = &asked {
            told.interpolation = asked.distance;
            way = asked.way;
        }
        let Some(reference) = &mut self.reference else {
            return;
        };
        let mut programmed = told.nearest;
        if let Some(asked) = &asked {
            let axis = self.programmed.axis(&told.nearest, asked);
            (programmed.tip, programmed.axis) = (asked.tip, axis);
        }
        let program = self
            .asked
            .follow(&programmed, way, &mut || reference.next());
        let beside = self.asked.beside(&told.actual);
        if let (Some(program), Some(asked)) = (program, beside) {
            let axis = self.asked.axis(&told.actual, &asked);
            told.asked = Some(AskedPoint {
                at: asked.at,
                error: told.actual.tip - asked.tip,
                distance: asked.distance,
                axis: angle(&told.actual.axis, &axis),
                program: program.distance,
            });
        }
    }
}

impl ContourReport {
    fn take(&mut self, point: &ContourPoint, missed: f64) {
        let peak = |value| Peak {
            value,
            time: point.time,
            line: point.at.line,
            cl_line: point.asked.map(|asked| asked.at.line),
            tip: point.nearest.tip,
        };
        if !point.at.cuts {
            self.rapids.take(peak(point.distance));
            return;
        }
        self.cuts.take(peak(point.distance));
        self.axis.take(peak(point.axis));
        self.missed.take(peak(missed));
        self.interpolation.take(peak(point.interpolation));
        if let Some(asked) = &point.asked {
            self.asked.take(peak(asked.distance));
            self.asked_axis.take(peak(asked.axis));
            self.program.take(peak(asked.program));
        }
        let following = (point.commanded.tip - point.actual.tip).norm();
        self.following.take(peak(following));
    }
}

/// The angle between two unit vectors, radians, as exact where it is small as where it is large.
fn angle(one: &Vector3<f64>, other: &Vector3<f64>) -> f64 {
    libm::atan2(one.cross(other).norm(), one.dot(other))
}
