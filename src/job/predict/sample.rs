//! One set-point, with all that came of it.

use post_machine::kinematics::{Joints, Pose};

/// A set-point, and where the machine is at its time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// When, s from the beginning of the program.
    pub time: f64,
    /// Line of the program that is carried out.
    pub line: u64,
    /// Line of the CL file whose path is nearest, where one is given.
    pub cl_line: Option<u64>,
    /// At feed: the tool cuts.
    pub cuts: bool,
    /// The tool is nearest to a cut: its error counts.
    pub counts: bool,
    /// Axis values commanded, mm and radians, counted from the drawing's zero, in chain order.
    pub commanded: Joints,
    /// Axis values of the same time, as the servos make them.
    pub actual: Joints,
    /// Tip and tool axis commanded, part frame.
    pub pose: Pose,
    /// Those of the actual axis values.
    pub actual_pose: Pose,
    /// Actual tip minus the nearest point of the path that is asked for, mm, part frame.
    pub error: [f64; 3],
    /// Length of `error`, mm.
    pub size: f64,
    /// Angle of the tool axis against the path there, radians.
    pub axis: f64,
    /// Commanded feed of the tip against the part since the set-point before, mm/min; zero where that was no cut.
    pub feed: f64,
    /// Feed that the program states, mm/min; zero for rapids and waits.
    pub programmed: f64,
}
