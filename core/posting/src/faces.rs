//! Operations that are written in polar interpolation of the control (`[mode.face]`): found by a first pass, begun and ended
//! as the second comes to them.
//!
//! A file is taken apart where the tool leaves the part, as for tilted planes. Of such a part all is written in the mode if
//! some cut asks for the part to turn, the tool lies along its axis all the time, and no way comes too near to it.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Short};
use post_machine::face_mode::FaceMode;

use crate::preview::{FilePreview, MOST_STRETCHES};
use crate::program::spline::flatten;
use crate::program::{Command, MoveFeed, ProgramStep};

/// Tool axes that differ by less are one, as unit vectors.
const SAME: f64 = 1e-9;

/// A cut that leads past the axis by less, mm, leads through it.
const THROUGH: f64 = 1e-9;

/// Chords by which a curve is looked at, mm.
const CHORD: f64 = 0.01;

/// Lines of a CL file between two places where the tool leaves the part, whose cuts turn the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceRange {
    /// Line of the first motion.
    pub first: u64,
    /// Line of the last.
    pub last: u64,
    /// How near its ways, rapids among them, come to the line of the turning axis, mm.
    pub nearest: f64,
    /// Its cuts are on the mantle.
    pub mantle: bool,
}

/// A step of the program after which what follows is another part of the file.
fn parts(step: &ProgramStep) -> bool {
    match step {
        ProgramStep::Plane(_)
        | ProgramStep::Command(Command::Operation(_) | Command::OperationEnd) => true,
        ProgramStep::Command(command) => command.leaves(),
        _ => false,
    }
}

/// Finds such lines.
#[derive(Debug)]
pub struct FaceFinder {
    /// Directions of the linear axis that leads to the line, and of the coordinate across it, part frame; none where the
    /// control has no mode for faces.
    plane: Option<[Vector3<f64>; 2]>,
    /// The control has a mode for mantles.
    mantles: bool,
    /// The tool axis, part frame.
    axis: Vector3<f64>,
    /// Where the tool stands, mm; none before the first point.
    at: Option<Vector3<f64>>,
    present: Option<FaceRange>,
    /// A cut of this part of the file turns the part; the tool axis leans somewhere.
    turns: bool,
    leans: bool,
    /// A cut turns the tool axis, and the axis before it.
    swings: bool,
    before: Option<Vector3<f64>>,
    found: Vec<FaceRange>,
}

impl FaceFinder {
    /// For a machine whose control has the mode.
    pub fn new(machine: &Machine) -> Option<Self> {
        let plane = machine.in_face().and_then(|(_, face)| {
            let mode = face.face.as_ref()?;
            let direction = |place: usize| face.axes[place].joint.direction;
            Some([direction(mode.across), direction(mode.turning)])
        });
        machine.has_modes().then(|| Self {
            plane,
            mantles: machine.in_wrap().is_some(),
            axis: machine.tool_axis,
            at: None,
            present: None,
            turns: false,
            leans: false,
            swings: false,
            before: None,
            found: Vec::new(),
        })
    }

    /// Takes a step.
    pub fn step(&mut self, line: u64, step: &ProgramStep) {
        match step {
            ProgramStep::Move(motion) => {
                self.motion(line, motion.tip, motion.axis, motion.pace != MoveFeed::Rapid);
            }
            ProgramStep::Arc(step) => {
                self.motion(line, step.arc.at(0.0), step.start_axis, true);
                let (count, _) = step.arc.chords(CHORD);
                for piece in 1..=count.min(4096) {
                    let tip = step.arc.at(piece as f64 / count.min(4096) as f64);
                    self.motion(line, tip, step.end.axis, true);
                }
            }
            ProgramStep::Spline(step) => {
                let axis = step.end.axis;
                flatten(&step.spline, CHORD, &mut |chord| self.motion(line, chord.end, axis, true));
            }
            ProgramStep::Cycle(step) => {
                self.motion(line, step.point.tip, step.point.axis, false);
            }
            other if parts(other) => self.part_ends(),
            _ => {}
        }
    }

    fn motion(&mut self, line: u64, tip: Vector3<f64>, axis: Vector3<f64>, cuts: bool) {
        let from = self.at.replace(tip);
        self.leans |= (axis - self.axis).norm() > SAME;
        let before = self.before.replace(axis);
        self.swings |= cuts && before.is_some_and(|before| (axis - before).norm() > SAME);
        let range = FaceRange { first: line, last: line, nearest: f64::INFINITY, mantle: false };
        let present = self.present.get_or_insert(range);
        present.last = line;
        let (Some(from), Some(plane)) = (from, self.plane) else {
            return;
        };
        let [from, to] = [from, tip].map(|tip| plane.map(|way| way.dot(&tip)));
        let way = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let moment = libm::fabs(from[0] * to[1] - from[1] * to[0]);
        self.turns |= cuts && moment > THROUGH * way;
        present.nearest = present.nearest.min(FaceMode::nearest(from, to));
    }

    fn part_ends(&mut self) {
        let (turns, leans) = (std::mem::take(&mut self.turns), std::mem::take(&mut self.leans));
        let mantle = std::mem::take(&mut self.swings) && self.mantles;
        (self.at, self.before) = (None, None);
        let face = self.plane.is_some() && turns && !leans;
        if let Some(range) = self.present.take()
            && (face || mantle)
            && self.found.len() < MOST_STRETCHES
        {
            let nearest = if mantle { f64::INFINITY } else { range.nearest };
            self.found.push(FaceRange { mantle, nearest, ..range });
        }
    }

    /// The file has ended.
    pub fn finish(mut self) -> Vec<FaceRange> {
        self.part_ends();
        self.found
    }
}

/// What is to be done about the mode ahead of a step.
pub(crate) enum FaceChange {
    /// The machine of this name from here on; empty: the mode ends.
    Machine(String),
    /// The operation is written without it.
    Without(Diagnostic),
}

/// Begins and ends the mode.
#[derive(Debug)]
pub(crate) struct FaceTracker {
    ahead: Arc<FilePreview>,
    next: usize,
    /// Names of the machine on faces and on mantles.
    names: [String; 2],
    pole: f64,
    on: bool,
}

impl FaceTracker {
    /// For a machine whose control has the mode.
    pub(crate) fn new(machine: &Machine, ahead: Arc<FilePreview>) -> Option<Self> {
        let face = machine.in_face();
        let pole = face.and_then(|(_, face)| face.face.as_ref()).map_or(0.0, |mode| mode.pole);
        let names = [face, machine.in_wrap()];
        let names = names.map(|mode| mode.map_or(String::new(), |(name, _)| name.to_owned()));
        machine.has_modes().then_some(Self { ahead, next: 0, names, pole, on: false })
    }

    /// The mode is on.
    pub(crate) fn is_on(&self) -> bool {
        self.on
    }

    /// What changes ahead of a step from `line`.
    pub(crate) fn change(&mut self, line: u64, step: &ProgramStep) -> Option<FaceChange> {
        if parts(step) {
            return self.end();
        }
        let motion = matches!(
            step,
            ProgramStep::Move(_)
                | ProgramStep::Arc(_)
                | ProgramStep::Spline(_)
                | ProgramStep::Cycle(_)
        );
        if self.on || !motion {
            return None;
        }
        while self.ahead.faces.get(self.next).is_some_and(|range| range.last < line) {
            self.next += 1;
        }
        let range = self.ahead.faces.get(self.next).filter(|range| range.first <= line)?;
        if range.nearest < self.pole {
            self.next += 1;
            return Some(FaceChange::Without(self.too_near(range)));
        }
        self.on = true;
        let name = &self.names[usize::from(range.mantle)];
        Some(FaceChange::Machine(name.clone()))
    }

    /// The mode ends, if it is on.
    pub(crate) fn end(&mut self) -> Option<FaceChange> {
        std::mem::take(&mut self.on).then(|| {
            self.next += 1;
            FaceChange::Machine(String::new())
        })
    }

    /// Nothing begins or ends up to `line`, and moves are those of the machine itself.
    pub(crate) fn stays_until(&self, line: u64) -> bool {
        !self.on && self.ahead.faces.get(self.next).is_none_or(|range| line < range.first)
    }

    fn too_near(&self, range: &FaceRange) -> Diagnostic {
        let message = format!(
            "the ways of this operation, up to line {}, come to {} mm from the line of the turning axis, and [mode.face] goes no \
             nearer than {} mm: it is written in words of the axes",
            range.last,
            Short(range.nearest),
            Short(self.pole)
        );
        Diagnostic::warning("mode", message).help(
            "a smaller pole of [mode.face], where the control holds the turning axis to its feed; else nothing is wrong",
        )
    }
}
