//! Rapids that a program makes at feed.
//!
//! Where the machine file has it so ([`Machine::rapid`]), a rapid stands in a program as a feed move at the highest feed
//! that its axes hold. Nothing in such a block says what it is: a cut that an axis holds up is as fast. So it is a rapid
//! where the spindle stands, in a program that turns it elsewhere, and where the word that goes with the way of the tip in
//! cuts stands still; any other stays a cut for who knows this program alone, and may be a rapid for who holds it against
//! another that has one there.

use std::io::{Read, Seek};

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use crate::interpret::Interpreter;
use crate::verify::AxisLimitCheck;
use crate::{BlockEffect, BlockRunner, Interpolation, Motion, MotionKind, SpindleState};

/// A rapid at feed may take so much longer than its axes need: feeds are rounded down.
const SLOW: f64 = 0.1;

/// Where the control keeps the tip and rotary axes turn: a rapid that stands in several blocks has in each the feed at which
/// its fastest place is as fast as the axes go, so that a block without that place takes longer than it needs, as a share.
const IN_PIECES: f64 = 0.5;

/// And so much besides, minutes.
const MOMENT: f64 = 1e-4;

/// A motion at feed may be as fast as the axes of the machine go.
pub(crate) fn is_as_fast_as_rapids(
    axes: &AxisLimitCheck,
    machine: &Machine,
    motion: &Motion,
) -> bool {
    is_so_fast(axes, machine, motion, MOMENT)
}

/// It takes longer than its axes need, between the words too, by no more than a share and a moment, minutes.
fn is_so_fast(axes: &AxisLimitCheck, machine: &Machine, motion: &Motion, moment: f64) -> bool {
    let slack = match motion.turns() && motion.way != Interpolation::Axes {
        true => IN_PIECES,
        false => SLOW,
    };
    let wanted = (motion.minutes - moment) / (1.0 + slack);
    // Times that are too short anyhow need not be known.
    let least = || axes.least_minutes(machine, motion, 0.9 * wanted);
    motion.kind == MotionKind::Feed && least().is_some_and(|(minutes, _)| minutes >= wanted)
}

/// By linear axes alone, at what the slowest of them goes: the way was not known when the feed was written.
pub(crate) fn comes_from_anywhere(machine: &Machine, motion: &Motion) -> bool {
    let joints = motion.from.joints.iter().zip(&motion.to.joints);
    let mut axes = machine.axes.iter().zip(joints);
    let stands = axes.all(|(axis, (from, to))| !axis.joint.rotary || from == to);
    let linear = machine.axes.iter().filter(|axis| !axis.joint.rotary);
    let slowest = linear.map(|axis| axis.max_feed).fold(f64::INFINITY, f64::min);
    stands && motion.feed >= slowest * (1.0 - SLOW)
}

/// A program that is run block by block, its rapids at feed told from cuts.
#[derive(Debug)]
pub struct FedRapids<P> {
    program: P,
    machine: Option<(Machine, AxisLimitCheck)>,
    /// They stand at feed where the control keeps the tip alone.
    kept: bool,
    /// The program turns the spindle somewhere.
    turns: bool,
    /// Of motions at feed that are as fast as rapids and were left cuts: how many, and the line of the first.
    left: Option<(u64, u64)>,
}

impl<P> FedRapids<P> {
    /// A program all of whose rapids are written as such.
    pub fn none(program: P) -> Self {
        Self { program, machine: None, kept: false, turns: false, left: None }
    }

    /// A program of a machine whose rapids may stand at feed, with `kept` where its control keeps the tip alone; `turns`
    /// says that the program turns the spindle somewhere.
    pub fn new(program: P, machine: &Machine, kept: bool, turns: bool) -> Self {
        Self {
            program,
            machine: Some((machine.clone(), AxisLimitCheck::new(machine))),
            kept,
            turns,
            left: None,
        }
    }

    /// The program itself.
    pub fn program(&self) -> &P {
        &self.program
    }

    /// How many motions at feed are as fast as rapids and were left cuts, and the line of the first.
    pub fn left(&self) -> Option<(u64, u64)> {
        self.left
    }

    fn look(&mut self, done: &mut [BlockEffect]) {
        let Some((machine, axes)) = &self.machine else {
            return;
        };
        for done in done {
            let BlockEffect::Motion(motion) = done else {
                continue;
            };
            let plain = motion.kind == MotionKind::Feed && !motion.hole && !motion.machine;
            // What has no feed goes nowhere.
            if !plain
                || motion.minutes <= 0.0
                || motion.way.is_curved()
                || self.kept && !motion.state.tcp
                || motion.along == Some(true)
                || !is_so_fast(axes, machine, motion, 0.0) && !comes_from_anywhere(machine, motion)
            {
                continue;
            }
            let stands = self.turns && motion.state.spindle == SpindleState::Off;
            if stands || motion.along == Some(false) {
                motion.kind = MotionKind::Rapid;
                motion.feed = 0.0;
                continue;
            }
            motion.fast = true;
            if !is_so_fast(axes, machine, motion, 0.0) {
                continue;
            }
            let (count, _) = self.left.get_or_insert((0, motion.line));
            *count += 1;
        }
    }
}

/// Whether a program turns the spindle anywhere, as far as it can be read.
pub fn turns_the_spindle<R: Read + Seek>(program: &mut Interpreter<R>) -> bool {
    let mut done = Vec::new();
    loop {
        done.clear();
        let more = program.next(&mut done);
        let turns = |done: &BlockEffect| match done {
            BlockEffect::Motion(motion) => motion.state.spindle != SpindleState::Off,
            BlockEffect::State(state) => state.spindle != SpindleState::Off,
            BlockEffect::Event { .. } => false,
        };
        if done.iter().any(turns) {
            return true;
        }
        if !matches!(more, Ok(true)) {
            return false;
        }
    }
}

impl<R: Read + Seek> BlockRunner for FedRapids<Interpreter<R>> {
    fn next(&mut self, done: &mut Vec<BlockEffect>) -> Result<bool, Box<Diagnostic>> {
        let known = done.len();
        let more = Interpreter::next(&mut self.program, done);
        self.look(&mut done[known..]);
        more
    }
}
