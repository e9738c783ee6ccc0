//! Rapids in which an axis would pass its largest feed, or each axis would go for itself.
//!
//! A control that keeps the tip may limit the axes that the program names, the coordinates of the tip among them, and
//! not the machine's own linear axes, which follow: at full speed these can be too slow.

use nalgebra::Vector3;
use post_machine::axis_words;
use post_machine::description::{Machine, Rapid, Tcp};
use post_machine::kinematics::{Chain, Joints, MAX_AXES};
use post_plugin::Capabilities;

use crate::blocks::{BlockReason, MotionBlock};
use crate::report::FastRapids;

/// What is over its largest feed by this factor is over it.
const OVER: f64 = 1.01;

/// Shares of a direction that are less are none.
const SAME: f64 = 1e-9;

/// Watches rapids.
#[derive(Debug)]
pub(crate) struct Rapids {
    tcp: Tcp,
    mode: Rapid,
    /// The control has no rapids in the mode that it is in: each is a feed move.
    none: bool,
    /// Minutes that each axis needs for one mm or radian at its largest feed.
    slowness: Joints,
    /// Minutes for the axes called X, Y and Z.
    coordinates: [f64; 3],
    rotary: [bool; MAX_AXES],
    names: Vec<String>,
    /// Legs drive the machine, which the control may leave out of account.
    driven: bool,
    /// The machine's, with any tool in it, and the axis that a tool comes down by.
    down: Option<(Chain, usize)>,
    /// The tip, mm, part frame.
    tip: Vector3<f64>,
    found: FastRapids,
}

impl Rapids {
    pub(super) fn new(machine: &Machine, writes: Capabilities) -> Self {
        let mut rapids = Self {
            tcp: machine.control.tcp,
            none: false,
            mode: machine.rapid(writes.has(Capabilities::TCP_RAPIDS_PASS)),
            slowness: Joints::default(),
            coordinates: [0.0; 3],
            rotary: [false; MAX_AXES],
            names: Vec::new(),
            driven: false,
            down: None,
            tip: Vector3::zeros(),
            found: FastRapids::default(),
        };
        rapids.set(machine);
        rapids
    }

    /// Another head is in.
    pub(super) fn set(&mut self, machine: &Machine) {
        self.slowness = machine.slowness();
        self.none = machine.is_in_mode();
        self.down = machine
            .solver(0.0)
            .ok()
            .zip(axis_words::depth(machine))
            .map(|(solver, depth)| (solver.chain().clone(), depth));
        self.names.clear();
        for (index, axis) in machine.axes.iter().enumerate() {
            self.rotary[index] = axis.joint.rotary;
            self.names.push(axis.name.clone());
            if let Some(place) = ["X", "Y", "Z"].iter().position(|name| *name == axis.word()) {
                self.coordinates[place] = self.slowness[index];
            }
        }
        self.driven = machine.legs().next().is_some();
        if self.driven {
            self.names.resize(MAX_AXES, String::new());
            self.names.extend(machine.legs().map(|leg| leg.name.clone()));
        }
    }

    /// The tip stands there.
    #[inline]
    pub(super) fn stand(&mut self, tip: Vector3<f64>) {
        self.tip = tip;
    }

    /// Rapids found so far that are left to the control.
    pub(crate) fn found(&self) -> &FastRapids {
        &self.found
    }

    /// Is this rapid, whose axes need `least` minutes, to be written as a feed move? If it is left to the control and
    /// an axis would be too fast, that is noted.
    pub(super) fn is_fed(&mut self, last: &Joints, block: &MotionBlock, least: f64) -> bool {
        // Without a largest feed there is none to write.
        if least <= 0.0 {
            return false;
        }
        if self.none {
            return true;
        }
        let full_speed = self.full_speed(last, block, least);
        let fast = least > full_speed * OVER;
        if self.mode == Rapid::Linear {
            return fast || self.turns(last, block);
        }
        if fast {
            self.note(last, block, least / full_speed);
        }
        false
    }

    /// A first position is reached from above, by the depth axis alone: the feed, mm/min, if that is to be written as a
    /// feed move. If it is left to the control and the axis would be too fast, that is noted.
    pub(super) fn feed_down(&mut self, block: &MotionBlock) -> Option<f64> {
        if let BlockReason::Above | BlockReason::AtOnce = block.reason {
            return self.feed_across(block);
        }
        let (Tcp::Control, Some((chain, depth))) = (self.tcp, &self.down) else {
            return None;
        };
        let (slow, depth) = (self.slowness[*depth], *depth);
        let way = chain.way_of(depth, &block.joints);
        let programmed = way.iter().zip(self.coordinates);
        let full_speed = programmed.fold(0.0, |most: f64, (way, slow)| most.max(way.abs() * slow));
        if slow <= full_speed * OVER {
            return None;
        }
        if self.mode == Rapid::Linear {
            return Some(1.0 / slow);
        }
        self.found.count += 1;
        let factor = slow / full_speed;
        if factor > self.found.factor {
            self.found.axis = self.names.get(depth).cloned().unwrap_or_default();
            self.found.factor = factor;
            self.found.line = block.line;
        }
        None
    }

    /// Feed to the place above a first position, which is reached from anywhere: whichever way that is, no axis goes
    /// faster than the tip. How fast the axes are then is reported of the way down.
    fn feed_across(&self, block: &MotionBlock) -> Option<f64> {
        let (Rapid::Linear, Some((chain, _))) = (self.mode, &self.down) else {
            return None;
        };
        let linear = (0..chain.joints().len()).filter(|joint| !self.rotary[*joint]);
        let mut slowest: f64 = 0.0;
        let mut fast = false;
        for joint in linear {
            let slow = self.slowness[joint];
            slowest = slowest.max(slow);
            let way = chain.way_of(joint, &block.joints);
            let coordinates = way.iter().zip(self.coordinates);
            let times = coordinates.filter(|(way, _)| libm::fabs(**way) > SAME);
            fast |= times.map(|(way, full)| libm::fabs(*way) * slow / full).sum::<f64>() > OVER;
        }
        fast.then(|| 1.0 / slowest)
    }

    fn turns(&self, last: &Joints, block: &MotionBlock) -> bool {
        (0..MAX_AXES).any(|index| self.rotary[index] && last[index] != block.joints[index])
    }

    /// What the control takes that looks at the axes of the program alone, minutes.
    fn full_speed(&self, last: &Joints, block: &MotionBlock, least: f64) -> f64 {
        let all = |index: usize| (block.joints[index] - last[index]).abs() * self.slowness[index];
        if self.tcp == Tcp::Post {
            return match self.driven {
                true => (0..MAX_AXES).map(all).fold(0.0, f64::max),
                false => least,
            };
        }
        let way = block.tip - self.tip;
        let linear = way.iter().zip(self.coordinates).map(|(way, slow)| way.abs() * slow);
        let rotary = (0..MAX_AXES).filter(|index| self.rotary[*index]).map(all);
        linear.chain(rotary).fold(0.0, f64::max)
    }

    #[cold]
    fn note(&mut self, last: &Joints, block: &MotionBlock, factor: f64) {
        self.found.count += 1;
        if factor <= self.found.factor {
            return;
        }
        let minutes =
            |index: &usize| (block.joints[*index] - last[*index]).abs() * self.slowness[*index];
        let slowest = (0..MAX_AXES)
            .max_by(|a, b| minutes(a).total_cmp(&minutes(b)))
            .filter(|index| minutes(index) > block.follow.minutes)
            .unwrap_or(block.follow.joint);
        self.found.axis = self.names.get(slowest).cloned().unwrap_or_default();
        self.found.factor = factor;
        self.found.line = block.line;
    }
}
