//! What each operation does with each tool: for whoever sets the machine up.

use nalgebra::Vector3;
use post_plugin::{Compensation, Spindle};

use crate::blocks::MotionBlock;
use crate::program::Command;

/// Operations that are told apart; what comes after them counts with the last.
pub const MOST_OPERATIONS: usize = 1000;

/// Directions of the tool that are told of an operation.
pub const MOST_DIRECTIONS: usize = 8;

/// Texts for the operator that are told of an operation.
pub const MOST_NOTES: usize = 8;

/// Tool axes that differ by less are one, as unit vectors: a millionth of a degree.
const SAME: f64 = 2e-8;

/// What one operation does with one tool.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OperationWork {
    /// Its name in the CAM system; empty if the CL file gives none.
    pub name: String,
    /// Number of the tool; none if the CL file loads no tool.
    pub tool: Option<u32>,
    /// Register of the cutter radius compensation; none where there is none.
    pub radius_register: Option<u32>,
    /// Work offset, from 1; none if the CL file names none.
    pub work_offset: Option<u32>,
    /// Speed of the spindle, 1/min, as it was commanded last; none if nothing commands one.
    pub spindle: Option<f64>,
    /// What the CL file tells the operator: the first [`MOST_NOTES`] that differ.
    pub notes: Vec<String>,
    /// Lowest place of the tip in a cut, mm along Z of the part frame; none without a cut.
    pub lowest: Option<f64>,
    /// Time of its blocks, s.
    pub time_s: f64,
    /// Where the tool points in its cuts, unit vectors from the tip to the holder, part frame: the first
    /// [`MOST_DIRECTIONS`] that differ.
    pub axes: Vec<Vector3<f64>>,
    /// The tool axis turns while the tool cuts, or points in more ways than are told.
    pub turns: bool,
}

/// The operations of a file, as blocks and commands come.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OperationList {
    done: Vec<OperationWork>,
    /// Some block belongs to the last of them.
    moved: bool,
    /// The tool axis at the end of the block before.
    axis: Option<Vector3<f64>>,
}

impl OperationList {
    /// Operations that move something, in their order.
    pub fn iter(&self) -> impl Iterator<Item = &OperationWork> {
        let unmoved = usize::from(!self.moved && !self.done.is_empty());
        self.done[..self.done.len() - unmoved].iter()
    }

    /// Takes a block.
    pub(crate) fn block(&mut self, block: &MotionBlock) {
        self.moved = true;
        let before = self.axis.replace(block.axis);
        let work = self.last();
        work.time_s += 60.0 * block.time.minutes;
        if !block.kind.cuts() {
            return;
        }
        let lowest = work.lowest.get_or_insert(block.tip.z);
        *lowest = lowest.min(block.tip.z);
        let same = |axis: &Vector3<f64>| (axis - block.axis).norm() <= SAME;
        work.turns |= before.is_some_and(|before| !same(&before));
        if !work.turns && !work.axes.iter().any(same) {
            work.turns = work.axes.len() == MOST_DIRECTIONS;
            work.axes.push(block.axis);
        }
    }

    /// Takes a command.
    pub(crate) fn command(&mut self, command: &Command) {
        match command {
            Command::Operation(name) => name.clone_into(&mut self.next().name),
            Command::Tool(tool) => self.next().tool = Some(tool.number),
            Command::WorkOffset(number) => self.next().work_offset = Some(*number),
            Command::Compensate(
                Compensation::Left { register } | Compensation::Right { register },
            ) => self.last().radius_register = Some(*register),
            Command::Spindle(Spindle::On { rpm, .. }) => self.last().spindle = Some(*rpm),
            Command::Comment(text) | Command::Message(text) => self.note(text),
            _ => {}
        }
    }

    fn note(&mut self, text: &str) {
        let notes = &mut self.last().notes;
        if notes.len() < MOST_NOTES && !notes.iter().any(|note| note == text) {
            notes.push(text.to_owned());
        }
    }

    fn last(&mut self) -> &mut OperationWork {
        if self.done.is_empty() {
            self.done.push(OperationWork::default());
        }
        let last = self.done.len() - 1;
        &mut self.done[last]
    }

    /// The one that begins here, with what stays in force.
    fn next(&mut self) -> &mut OperationWork {
        if self.moved && self.done.len() < MOST_OPERATIONS {
            self.moved = false;
            let last = self.last();
            let next = OperationWork {
                name: last.name.clone(),
                tool: last.tool,
                work_offset: last.work_offset,
                spindle: last.spindle,
                ..OperationWork::default()
            };
            self.done.push(next);
        }
        self.last()
    }
}
