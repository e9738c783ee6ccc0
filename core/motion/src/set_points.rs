//! Set-points: where a control commands the axes, period by period.

use std::sync::Arc;

use post_machine::kinematics::{Joints, Pose, Solver};

/// A batch of set-points, one a period, of one chain.
#[derive(Clone, Debug)]
pub struct SetPoints {
    /// The chain, with the tool in use.
    pub solver: Arc<Solver>,
    /// Time from one to the next, s.
    pub period: f64,
    /// How many stand before the first of these: it is commanded at `first * period` from the beginning, s.
    pub first: u64,
    /// Axis values, mm and radians, counted from the drawing's zero, in chain order.
    pub joints: Vec<Joints>,
    /// Tip and tool axis that they make, part frame.
    pub poses: Vec<Pose>,
    /// What is being carried out.
    pub at: Vec<ProgramPlace>,
    /// Jumps of velocity between the set-point before the first of these and the last one.
    pub jumps: Vec<VelocityJump>,
}

/// The velocities jump: one move passes into the next in another direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityJump {
    /// When, s from the beginning.
    pub time: f64,
    /// Velocities after it less those before, by place in the chain, mm/s or rad/s.
    pub change: Joints,
    /// Accelerations after it less those before, mm/s² or rad/s².
    pub bend: Joints,
}

/// Where a set-point stands in the program.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProgramPlace {
    /// Number of the task, from 0; while two overlap, the one that is left.
    pub task: u64,
    /// Line of the program.
    pub line: u64,
    /// Whether the move is at feed: the tool cuts.
    pub cuts: bool,
}

impl SetPoints {
    /// A batch without set-points yet.
    pub fn new(solver: Arc<Solver>, period: f64) -> Self {
        Self {
            solver,
            period,
            first: 0,
            joints: Vec::new(),
            poses: Vec::new(),
            at: Vec::new(),
            jumps: Vec::new(),
        }
    }

    /// Number of set-points.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether there is no set-point.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// Forgets all; `first` goes on after them.
    pub fn clear(&mut self) {
        self.first += self.len() as u64;
        self.joints.clear();
        self.poses.clear();
        self.at.clear();
        self.jumps.clear();
    }

    /// Gives what there is, and goes on after it, in `room` if there is some.
    pub fn hand_over(&mut self, room: Option<Self>) -> Self {
        let new = || Self::new(Arc::clone(&self.solver), self.period);
        let mut next = room.unwrap_or_else(new);
        next.clear();
        next.solver.clone_from(&self.solver);
        next.period = self.period;
        next.first = self.first + self.len() as u64;
        std::mem::replace(self, next)
    }

    /// Time of the set-point at `place` of this batch, s.
    pub fn time(&self, place: usize) -> f64 {
        (self.first + place as u64) as f64 * self.period
    }
}
