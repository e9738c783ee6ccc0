//! What a program leaves to the mount of the part: an observer of posting on a machine whose linear travel is opened.

use nalgebra::Vector3;
use post_machine::description::{Machine, Tcp};
use post_machine::kinematics::{Joints, NoClosedForm};
use post_machine::place::{MountConstraint, MountRoom};

use crate::blocks::{BlockKind, BlockReason, MotionBlock};
use crate::curve::CurveBlock;
use crate::observer::Observer;
use crate::program::Command;

/// Gathers the ends of travel that the blocks of a program come near to, by the heads that they are made with.
pub struct MountBounds<'m> {
    machine: &'m Machine,
    /// The machine with the head in use.
    head: &'m Machine,
    /// Room of each machine: that without a swapped head first.
    rooms: Vec<(&'m Machine, MountRoom)>,
    /// Which of them is in use.
    at: usize,
    /// Where the tool stood before: axis values and tip.
    last: Option<(Joints, Vector3<f64>)>,
}

impl<'m> MountBounds<'m> {
    /// Makes the bounds for a machine as its file describes it, its travel not opened.
    ///
    /// # Errors
    /// What its chain lacks.
    pub fn new(machine: &'m Machine) -> Result<Self, NoClosedForm> {
        Ok(Self {
            machine,
            head: machine,
            rooms: vec![(machine, MountRoom::new(machine)?)],
            at: 0,
            last: None,
        })
    }

    /// What was gathered: the name of the axis and the end of its travel.
    pub fn ends(&self) -> impl Iterator<Item = (&'m str, MountConstraint)> {
        self.rooms.iter().flat_map(|(machine, room)| {
            let named = |end: MountConstraint| (machine.axes[end.side.joint].name.as_str(), end);
            room.ends().map(named)
        })
    }

    /// Whether the room bounds the mount: see [`MountRoom::bounds`].
    pub fn bounds(&self) -> bool {
        self.rooms.iter().any(|(_, room)| room.bounds())
    }

    /// Whether the room goes evenly: see [`MountRoom::goes_evenly`].
    pub fn goes_evenly(&self) -> bool {
        self.rooms.iter().all(|(_, room)| room.goes_evenly())
    }

    fn swap(&mut self, name: &str) {
        let Some(head) = self.machine.changed_to(name) else {
            return;
        };
        self.head = head;
        self.last = None;
        let known = self.rooms.iter().position(|(machine, _)| std::ptr::eq(*machine, self.head));
        self.at = known.unwrap_or(self.rooms.len());
        if let (None, Ok(room)) = (known, MountRoom::new(self.head)) {
            self.rooms.push((self.head, room));
        }
    }
}

impl Observer for MountBounds<'_> {
    fn block(&mut self, block: &MotionBlock) {
        let Some((_, room)) = self.rooms.get_mut(self.at) else {
            return;
        };
        // A way off the part, or from above it, is as long as travel lets it be: on a machine whose travel is opened it
        // says nothing.
        if let BlockReason::Leave | BlockReason::Above = block.reason {
            self.last = None;
            return;
        }
        room.take(&block.joints, block.line);
        let moves = matches!(block.kind, BlockKind::Linear | BlockKind::Rapid);
        if let Some((joints, tip)) = &self.last
            && moves
            && self.head.control.tcp == Tcp::Control
        {
            room.take_between([(joints, tip), (&block.joints, &block.tip)], block.line);
        }
        self.last = Some((block.joints, block.tip));
    }

    fn curve(&mut self, curve: &CurveBlock) {
        if let Some((_, room)) = self.rooms.get_mut(self.at) {
            let between = curve.printed.between.iter();
            between.for_each(|joints| room.take(joints, curve.block.line));
        }
        self.block(&curve.block);
    }

    fn command(&mut self, _: u64, command: &Command) {
        if let Command::Head(name) = command {
            self.swap(name);
        }
    }
}
