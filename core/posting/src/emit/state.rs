//! What the last stage knows of the control between events, by what it is about.

use nalgebra::Vector3;
use post_machine::description::Smoothing;
use post_machine::kinematics::AxisBits;
use post_machine::tilted_plane::TiltedPlane;
use post_plugin::{Compensation, Coolant, Event};

use crate::blocks::MotionBlock;

/// The spindle.
#[derive(Default)]
pub(super) struct ProgramSpindle {
    /// It was switched on since the last tool change.
    pub turning: bool,
    /// What the CL file last said of it.
    pub commanded: Option<Event<'static>>,
    /// The tool was changed since.
    pub tool_changed: bool,
    /// The first position that the tool has reached without a speed of its own: the spindle stands until it has one, or
    /// goes in.
    pub waits: Option<FirstPosition>,
}

/// The coolant.
#[derive(Default)]
pub(super) struct CoolantState {
    /// What the CL file last said of it.
    pub commanded: Option<Coolant>,
    /// It was switched off in between, or waits.
    pub due: bool,
    /// It goes on behind the spindle, which stands still.
    pub waits: bool,
}

/// Clamps of the axes, one bit each.
#[derive(Default)]
pub(super) struct ClampState {
    /// Axes that are known to be clamped.
    pub on: AxisBits,
    /// Rotary axes that have turned in a cut since the tool came: they are left free.
    pub free: AxisBits,
}

/// The tilted plane of the words.
#[derive(Default)]
pub(super) struct PlaneState {
    /// The plane.
    pub wanted: Option<Box<TiltedPlane>>,
    /// The control got it.
    pub on: bool,
}

/// Smoothing.
#[derive(Default)]
pub(super) struct SmoothingState {
    /// That which is due.
    pub wanted: Option<Smoothing>,
    /// That which the control has.
    pub on: Option<Smoothing>,
}

/// Cutter compensation.
#[derive(Default)]
pub(super) struct CompensationState {
    /// It begins once the tool is at the part.
    pub waits: Option<Compensation>,
    /// That which the CL file last asked for; off is none.
    pub commanded: Option<Compensation>,
    /// The line on which the tool left the part with it on: not reported yet.
    pub left: Option<u64>,
}

/// Where a tool has arrived, and by which line of the CL file.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstPosition {
    line: u64,
    tip: Vector3<f64>,
    axis: Vector3<f64>,
}

impl FirstPosition {
    pub(super) fn of(block: &MotionBlock) -> Self {
        Self { line: block.line, tip: block.tip, axis: block.axis }
    }

    /// A block of another line leads below it, along the tool: into a slot, it may be, at rapid.
    pub(super) fn goes_in(&self, block: &MotionBlock) -> bool {
        block.line != self.line && (block.tip - self.tip).dot(&self.axis) < -LOWER
    }
}

/// A tool that goes less far along its axis stays where it is, mm.
const LOWER: f64 = 1e-6;
