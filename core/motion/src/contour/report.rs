//! What is reported of contour errors: at a set-point, and of all.

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, MAX_AXES, Pose};

use super::axes::AxisPeaks;
use super::spread::{ContourPeak, ValueSpread};
use crate::ProgramPlace;

/// Where the tool was, and where on the commanded path that is nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourPoint {
    /// When, s from the beginning.
    pub time: f64,
    /// What was being carried out at the nearest point, not what is commanded meanwhile.
    pub at: ProgramPlace,
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
    /// Length of the deviation: the contour error, mm.
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
    pub at: ProgramPlace,
    /// Actual tip minus that point, mm, part frame.
    pub error: Vector3<f64>,
    /// Length of the deviation, mm.
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
    pub cuts: ValueSpread,
    /// Contour error of the tool axis in cuts, radians.
    pub axis: ValueSpread,
    /// Contour error at rapid, mm.
    pub rapids: ValueSpread,
    /// Distance of the commanded path from the path that the program asks for, in cuts, mm.
    pub interpolation: ValueSpread,
    /// Distance of the program's path from the CL path, in cuts, mm; none without one.
    pub program: ValueSpread,
    /// Distance of the tip from the CL path, in cuts, mm; none without one.
    pub asked: ValueSpread,
    /// Angle of the tool axis against that of the CL path, in cuts, radians.
    pub asked_axis: ValueSpread,
    /// Distance of the tip from where it is commanded at the same time, in cuts, mm.
    pub following: ValueSpread,
    /// How far the tool stays off a corner of its path in a cut, mm: it passes from one leg to the other, and so the
    /// contour error says less than this.
    pub missed: ContourPeak,
    /// The largest values of each axis, in chain order, cuts and rapids.
    pub axes: [AxisPeaks; MAX_AXES],
    /// How often a move passes into the next with a jump of the velocity.
    pub jumps: u64,
    /// How many axes there are.
    pub axis_count: usize,
    /// Time of the last set-point, s.
    pub seconds: f64,
}

impl ContourReport {
    pub(super) fn take(&mut self, point: &ContourPoint, missed: f64) {
        let peak = |value| ContourPeak {
            value,
            time: point.time,
            line: point.at.line,
            cl_line: point.asked.map(|asked| asked.at.line),
            tip: point.nearest.tip,
        };
        if !point.at.cuts {
            self.rapids.take(point.distance, peak);
            return;
        }
        self.cuts.take(point.distance, peak);
        self.axis.take(point.axis, peak);
        self.missed.raise(missed, peak);
        self.interpolation.take(point.interpolation, peak);
        if let Some(asked) = &point.asked {
            self.asked.take(asked.distance, peak);
            self.asked_axis.take(asked.axis, peak);
            self.program.take(asked.program, peak);
        }
        let following = (point.commanded.tip - point.actual.tip).norm();
        self.following.take(following, peak);
    }
}
