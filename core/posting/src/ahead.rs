//! What of a CL file is known before its program is written: a first pass over its records, where it can be read twice.
//!
//! Nothing is posted by it: the interpreter settles what is modal, and its steps are examined, not kept. Memory
//! does not grow with the file beyond [`MOST_STRETCHES`].
//!
//! [`AheadPass`] takes the records and hands every step to the parts of what is to be known; [`Ahead`] is what they
//! found. A part is a struct with a `step` and a `finish` of its own: [`StillAxes`] says where the tool axis stays.

use nalgebra::Vector3;
use post_grammar::Record;
use post_machine::description::Machine;

use crate::program::{Command, Interpreter, Motion, Pace, Reading, Step};

/// Stretches that are remembered; of a file with more, the ones after are not known.
pub const MOST_STRETCHES: usize = 65_536;

/// Tool axes that differ by less are one, as unit vectors.
const SAME: f64 = 1e-9;

/// What is known of a CL file before its program is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ahead {
    /// Where the tool axis stays, in the order of the lines.
    pub still: Vec<Still>,
}

/// Lines of a CL file between two places where the tool leaves the part, on which its axis stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Still {
    /// Line of the first motion.
    pub first: u64,
    /// Line of the last.
    pub last: u64,
    /// The tool axis, unit vector from the tip to the holder, part frame.
    pub axis: Vector3<f64>,
}

/// The first pass.
#[derive(Debug)]
pub struct AheadPass {
    interpreter: Interpreter,
    still: StillAxes,
}

impl AheadPass {
    /// Makes the pass for a file that is to be read so, on this machine.
    pub fn new(machine: &Machine, reading: Reading) -> Self {
        Self { interpreter: Interpreter::new(reading.on(machine)), still: StillAxes::default() }
    }

    /// Takes a record.
    #[inline]
    pub fn record(&mut self, record: &Record<'_>) {
        let still = &mut self.still;
        self.interpreter.record(record, &mut |step| still.step(record.line, &step));
        if self.interpreter.has_findings() {
            // They are reported when the program is made.
            self.interpreter.take_findings();
        }
    }

    /// The file has ended.
    pub fn finish(self) -> Ahead {
        Ahead { still: self.still.finish() }
    }
}

/// Where the tool axis stays.
///
/// A file is taken apart where the tool leaves the part: at tool changes, home positions, index moves, other planes, and
/// where an operation begins or ends. Of such a part of the file all stretches count, from one turn of the tool axis at
/// rapid to the next, or, if the axis turns in one cut of it, none.
#[derive(Debug, Default)]
pub struct StillAxes {
    found: Vec<Still>,
    /// How many of them the part of the file before this one leaves.
    sure: usize,
    /// The stretch in hand, and whether something is cut in it.
    present: Option<(Still, bool)>,
    /// A cut of this part of the file turns the tool axis.
    turns: bool,
}

impl StillAxes {
    /// Takes a step.
    #[inline]
    pub fn step(&mut self, line: u64, step: &Step) {
        match step {
            Step::Move(motion) => self.motion(line, motion, motion.pace != Pace::Rapid),
            Step::Arc(arc) => {
                self.turns |= (arc.start_axis - arc.end.axis).norm() > SAME;
                self.motion(line, &arc.end, true);
            }
            Step::Spline(spline) => self.motion(line, &spline.end, true),
            // The tool comes to a hole at rapid, and turns there if it does.
            Step::Cycle(cycle) => {
                self.motion(line, &cycle.point, false);
                self.motion(line, &cycle.point, true);
            }
            Step::Plane(_) => self.part_ends(),
            Step::Command(Command::Operation(_) | Command::OperationEnd) => self.part_ends(),
            Step::Command(command) if command.leaves() => self.part_ends(),
            Step::Command(_) | Step::EndCycle => {}
        }
    }

    #[inline]
    fn motion(&mut self, line: u64, motion: &Motion, cuts: bool) {
        match &mut self.present {
            Some((still, cut)) if (still.axis - motion.axis).norm() <= SAME => {
                still.last = line;
                *cut |= cuts;
            }
            _ => self.turn(line, motion, cuts),
        }
    }

    /// The tool axis turns on the way to a point, or the part of the file begins with it.
    fn turn(&mut self, line: u64, motion: &Motion, cuts: bool) {
        self.turns |= cuts && self.present.is_some();
        self.stretch_ends();
        let still = Still { first: line, last: line, axis: motion.axis };
        self.present = Some((still, cuts));
    }

    fn stretch_ends(&mut self) {
        if let Some((still, true)) = self.present.take()
            && self.found.len() < MOST_STRETCHES
        {
            self.found.push(still);
        }
    }

    fn part_ends(&mut self) {
        self.stretch_ends();
        if std::mem::take(&mut self.turns) {
            self.found.truncate(self.sure);
        }
        self.sure = self.found.len();
    }

    /// The file has ended.
    pub fn finish(mut self) -> Vec<Still> {
        self.part_ends();
        self.found
    }
}
