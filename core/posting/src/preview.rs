//! What of a CL file is known before its program is written: a first pass over its records, where it can be read twice.
//!
//! Nothing is posted by it: the interpreter settles what is modal, and its steps are examined, not kept. Memory
//! does not grow with the file beyond [`MOST_STRETCHES`].
//!
//! [`PreviewPass`] takes the records and hands every step to the parts of what is to be known; [`FilePreview`] is what they
//! found. A part is a struct with a `step` and a `finish` of its own: [`FixedAxisFinder`] says where the tool axis stays.

use nalgebra::Vector3;
use post_grammar::{GotoRun, Record};
use post_machine::description::Machine;
use post_plugin::Capabilities;

use crate::faces::{FaceFinder, FaceRange};
use crate::program::{ClInterpreter, Command, MoveFeed, ProgramStep, ReadingOptions, StraightMove};

/// Stretches that are remembered; of a file with more, the ones after are not known.
pub const MOST_STRETCHES: usize = 65_536;

/// Tool axes that differ by less are one, as unit vectors.
const SAME: f64 = 1e-9;

/// What is known of a CL file before its program is written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilePreview {
    /// Where the tool axis stays, in the order of the lines.
    pub still: Vec<FixedAxisRange>,
    /// What is milled on faces, the part turning, in the order of the lines.
    pub faces: Vec<FaceRange>,
}

/// Lines of a CL file between two places where the tool leaves the part, on which its axis stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedAxisRange {
    /// Line of the first motion.
    pub first: u64,
    /// Line of the last.
    pub last: u64,
    /// The tool axis, unit vector from the tip to the holder, part frame.
    pub axis: Vector3<f64>,
}

/// The control is to get tilted planes: its dialect `writes` them, and they are wanted.
pub fn wants_planes(machine: &Machine, writes: Capabilities) -> bool {
    writes.has(Capabilities::PLANE)
        && machine.wants_planes(writes.has(Capabilities::CYCLE_IN_PLANE))
}

/// A first pass is to be made: for planes, or for a mode of the control.
pub fn is_wanted(machine: &Machine, writes: Capabilities) -> bool {
    wants_planes(machine, writes) || machine.has_modes()
}

/// The first pass.
#[derive(Debug)]
pub struct PreviewPass {
    interpreter: ClInterpreter,
    still: FixedAxisFinder,
    /// What is milled on faces; none where no mode of the control asks for it.
    faces: Option<FaceFinder>,
}

impl PreviewPass {
    /// Makes the pass for a file that is to be read so, on this machine.
    pub fn new(machine: &Machine, reading: ReadingOptions) -> Self {
        Self {
            interpreter: ClInterpreter::new(reading.on(machine)),
            still: FixedAxisFinder::default(),
            faces: FaceFinder::new(machine),
        }
    }

    /// Takes a record.
    #[inline]
    pub fn record(&mut self, record: &Record<'_>) {
        let (still, faces) = (&mut self.still, &mut self.faces);
        let mut take = |step: ProgramStep| {
            still.step(record.line, &step);
            if let Some(faces) = faces {
                faces.step(record.line, &step);
            }
        };
        if self.interpreter.file_begins(record.line) {
            self.interpreter.begin_file(&mut take);
        }
        self.interpreter.record(record, &mut take);
        if self.interpreter.has_findings() {
            // They are reported when the program is made.
            self.interpreter.take_findings();
        }
    }

    /// Takes the records of a run, whose text this is: [`Self::record`] of each.
    pub fn gotos(&mut self, run: &GotoRun, text: &[u8]) {
        let mut place = 0;
        while place < run.count() {
            if self.faces.is_none() {
                place = self.plain_gotos(run, place);
            }
            if place < run.count() {
                self.record(&run.record(place, text));
                place += 1;
            }
        }
    }

    /// Takes the records of a run from a place on, as far as they are plain cuts; gives the place after them. Those that
    /// tell nothing new are passed over.
    fn plain_gotos(&mut self, run: &GotoRun, from: usize) -> usize {
        let mut place = from;
        let Some(pace) = self.interpreter.plain_pace() else {
            return place;
        };
        while place < run.count() {
            let point = run.point(place);
            let Some(motion) = self.interpreter.plain_move(&point, run.has_axis(), pace) else {
                break;
            };
            self.still.motion(run.line(place), &motion, pace != MoveFeed::Rapid);
            place += 1;
            let alike = if self.still.turns { run.count() } else { same_axis(run, place) };
            // The last of them says where the interpreter stands.
            place = place.max(alike.saturating_sub(1));
        }
        place
    }

    /// Plain `GOTO`s tell nothing from here on, up to the next other record, but where the last of them leads.
    pub fn passes_gotos(&self) -> bool {
        self.still.turns && self.faces.is_none() && self.interpreter.plain_pace().is_some()
    }

    /// The file has ended.
    pub fn finish(self) -> FilePreview {
        let faces = self.faces.map(FaceFinder::finish).unwrap_or_default();
        FilePreview { still: self.still.finish(), faces }
    }
}

/// The place behind the points, from one place on, that have the tool axis of the one before it.
fn same_axis(run: &GotoRun, from: usize) -> usize {
    let [.., i, j, k] = run.columns();
    let axis = |place: usize| [i[place], j[place], k[place]];
    let alike = (from..run.count()).take_while(|place| axis(*place) == axis(from - 1));
    from + alike.count()
}

/// Where the tool axis stays.
///
/// A file is taken apart where the tool leaves the part: at tool changes, home positions, index moves, other planes, and
/// where an operation begins or ends. Of such a part of the file all stretches count, from one turn of the tool axis at
/// rapid to the next, or, if the axis turns in one cut of it, none.
#[derive(Debug, Default)]
pub struct FixedAxisFinder {
    found: Vec<FixedAxisRange>,
    /// How many of them the part of the file before this one leaves.
    sure: usize,
    /// The stretch in hand, and whether something is cut in it.
    present: Option<(FixedAxisRange, bool)>,
    /// A cut of this part of the file turns the tool axis.
    turns: bool,
}

impl FixedAxisFinder {
    /// Takes a step.
    #[inline]
    pub fn step(&mut self, line: u64, step: &ProgramStep) {
        match step {
            ProgramStep::Move(motion) => self.motion(line, motion, motion.pace != MoveFeed::Rapid),
            ProgramStep::Arc(arc) => {
                self.turns |= (arc.start_axis - arc.end.axis).norm() > SAME;
                self.motion(line, &arc.end, true);
            }
            ProgramStep::Spline(spline) => self.motion(line, &spline.end, true),
            // The tool comes to a hole at rapid, and turns there if it does.
            ProgramStep::Cycle(cycle) => {
                self.motion(line, &cycle.point, false);
                self.motion(line, &cycle.point, true);
            }
            ProgramStep::Plane(_) => self.part_ends(),
            ProgramStep::Command(Command::Operation(_) | Command::OperationEnd) => self.part_ends(),
            ProgramStep::Command(command) if command.leaves() => self.part_ends(),
            ProgramStep::Command(_) | ProgramStep::EndCycle => {}
        }
    }

    #[inline]
    fn motion(&mut self, line: u64, motion: &StraightMove, cuts: bool) {
        match &mut self.present {
            Some((still, cut)) if (still.axis - motion.axis).norm() <= SAME => {
                still.last = line;
                *cut |= cuts;
            }
            _ => self.turn(line, motion, cuts),
        }
    }

    /// The tool axis turns on the way to a point, or the part of the file begins with it.
    fn turn(&mut self, line: u64, motion: &StraightMove, cuts: bool) {
        self.turns |= cuts && self.present.is_some();
        self.stretch_ends();
        let still = FixedAxisRange { first: line, last: line, axis: motion.axis };
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
    pub fn finish(mut self) -> Vec<FixedAxisRange> {
        self.part_ends();
        self.found
    }
}
