//! A log laid over a prediction.
//!
//! Two things are compared, apart from one another. What the control commands: predicted and logged positions at the same
//! time, the clocks aligned; a cycle time that is wrong by a second shows here and leaves nothing else to be seen. What the
//! servos make of it: they follow the *logged* commands, as the prediction paper has it (Zhang, Chen 2025, section 5), so
//! that actual positions and contour errors are those of the same instant whatever the cycle time.

use std::collections::VecDeque;
use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, MAX_AXES, Solver};
use post_motion::contour::Contour;
use post_motion::measured::{Alignment, Difference, Track, Unaligned, align};
use post_motion::servo::Servos;
use post_motion::{At, SetPoints};

use super::log::{Log, Which};
use super::report::{AxisLaid, ContourLaid, Left, MeasuredFound};
use crate::failure::Failure;
use crate::job::predict::Sample;

/// Set-points of a prediction that a log is laid over: 136 bytes are kept of each.
const MOST_SET_POINTS: usize = 2_000_000;

/// What the servos were doing before the log began is not known; if the axes move there, so long passes before anything is
/// compared, s.
pub const UNKNOWN: f64 = 0.5;

/// An axis that is commanded by more than this from row to row moves, mm or radians.
pub const MOVES: f64 = 1e-6;

/// Rows of a batch.
const BATCH: usize = 256;

/// A prediction that is kept to lay a log over it.
#[derive(Debug)]
pub struct Overlay {
    log: Log,
    commanded: Track,
    actual: Track,
    /// What is carried out from a set-point on.
    runs: Vec<(usize, At)>,
}

/// What was measured at an instant, and what is predicted for it.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredPoint {
    /// When, s of the prediction's clock.
    pub time: f64,
    /// Line of the program.
    pub line: u64,
    /// The tool cuts.
    pub cuts: bool,
    /// Actual minus commanded axis values as measured, and as predicted from the commanded ones of the log; mm, radians; 0
    /// of axes that the log does not have both of.
    pub following: [Joints; 2],
    /// Contour error as measured, and as predicted, mm.
    pub contour: [f64; 2],
}

impl Overlay {
    /// Of a prediction every `period` seconds that is still to come.
    pub fn new(log: Log, period: f64) -> Self {
        let track = || Track {
            begins: 0.0,
            period,
            joints: Vec::new(),
        };
        Self {
            log,
            commanded: track(),
            actual: track(),
            runs: Vec::new(),
        }
    }

    /// Takes the next set-point of the prediction.
    ///
    /// # Errors
    /// Too many.
    pub fn take(&mut self, sample: &Sample) -> Result<(), Failure> {
        let place = self.commanded.joints.len();
        if place == 0 {
            self.commanded.begins = sample.point.time;
            self.actual.begins = sample.point.time;
        }
        if place == MOST_SET_POINTS {
            let message = format!(
                "the prediction has more than {MOST_SET_POINTS} set-points, a log cannot be laid over it"
            );
            let help = "--period: a longer time from one to the next";
            return Err(Diagnostic::error("log", message).help(help).into());
        }
        let at = At {
            task: 0,
            line: sample.at.line,
            cuts: sample.at.cuts,
        };
        if self.runs.last().is_none_or(|(_, last)| *last != at) {
            self.runs.push((place, at));
        }
        self.commanded.joints.push(sample.point.commanded_joints);
        self.actual.joints.push(sample.point.actual_joints);
        Ok(())
    }

    /// Lays the log over it. `chains` are those of the prediction, with the time from which each holds; `listen` is told
    /// of each row of the log that has both positions of an axis.
    ///
    /// # Errors
    /// They are not alike, or the period of the log is none for servos.
    pub fn finish(
        &self,
        machine: &Machine,
        chains: &[(f64, Arc<Solver>)],
        listen: &mut dyn FnMut(&MeasuredPoint),
    ) -> Result<MeasuredFound, Failure> {
        let log = &self.log;
        let alignment = self.aligned()?;
        let mut laid = Laid::new(self, machine, &alignment)?;
        laid.compare(chains, listen);
        Ok(MeasuredFound {
            log: log.name.clone(),
            rows: log.rows,
            period_s: laid.period,
            seconds: laid.count as f64 * laid.period,
            turns: log.turns,
            shift_s: alignment.shift,
            shift_deviation_s: alignment.shift_deviation,
            rival_shift_s: alignment.rival,
            correlation: alignment.correlation,
            overlap_s: alignment.overlap,
            axes: laid.axes(machine),
            contour: laid.contour(),
        })
    }

    /// By what was commanded, if the log has it, else by where the axes were.
    fn aligned(&self) -> Result<Alignment, Failure> {
        let log = &self.log;
        let commanded = log.axes(Which::Commanded);
        let found = match commanded.is_empty() {
            false => align(&self.commanded, &log.commanded, &commanded),
            true => align(&self.actual, &log.actual, &log.axes(Which::Actual)),
        };
        let mut found = found.map_err(|why| {
            let message = match why {
                Unaligned::Short(fewest) => {
                    format!("program and log need {fewest} set-points to be laid over one another")
                }
                Unaligned::Still => {
                    "no axis moves both in the program and in the log, so that it is not known when the program began"
                        .to_owned()
                }
                Unaligned::Unlike(alike) => format!(
                    "the log is not of this program: at best they are alike by {alike:.2}, where 1 is the same"
                ),
            };
            let help = "--columns and --log-units say which column holds which axis in which unit; an axis that the log counts the other way is `reversed` in the machine file";
            Diagnostic::error("log", message).help(help)
        })?;
        // What a control knows of the actual position counts from the same zero as what it commands.
        let mut only_actual = Vec::new();
        for axis in log.axes(Which::Actual) {
            if !commanded.is_empty() && !log.has[Which::Commanded as usize][axis] {
                only_actual.push(axis);
            }
        }
        for axis in only_actual {
            let mut difference = Difference::default();
            for (place, joints) in log.actual.joints.iter().enumerate() {
                let time = log.actual.time(place);
                if let Some(predicted) = self.actual.at(time - found.shift) {
                    difference.take(time, joints[axis] - predicted[axis]);
                }
            }
            found.zeros[axis] = difference.mean();
        }
        Ok(found)
    }

    /// The log.
    pub fn log(&self) -> &Log {
        &self.log
    }

    /// What is carried out at the set-point `place`, looked for from the run `run` on.
    fn at(&self, place: usize, run: &mut usize) -> At {
        while self
            .runs
            .get(*run + 1)
            .is_some_and(|(from, _)| *from <= place)
        {
            *run += 1;
        }
        self.runs.get(*run).map_or_else(At::default, |(_, at)| *at)
    }
}

/// What is compared, and what has come of it so far.
struct Laid<'a> {
    overlay: &'a Overlay,
    alignment: &'a Alignment,
    servos: Servos,
    /// Of the log.
    period: f64,
    count: usize,
    /// Before this time of the log the servos' state is not known, s.
    known_from: f64,
    /// By axis: commanded, actual, following measured, predicted, and their difference.
    sums: [[Difference; 5]; MAX_AXES],
    /// Contour error: measured, predicted, and their difference.
    contours: [Difference; 3],
}

impl<'a> Laid<'a> {
    fn new(
        overlay: &'a Overlay,
        machine: &Machine,
        alignment: &'a Alignment,
    ) -> Result<Self, Failure> {
        let log = &overlay.log;
        let track = match log.commanded.joints.is_empty() {
            false => &log.commanded,
            true => &log.actual,
        };
        let mut servos = Servos::new(machine, track.period).map_err(|fault| *fault)?;
        let mut known_from = track.begins;
        if let [first, second, ..] = log.commanded.joints[..] {
            servos.settle(&first);
            let moves = (0..MAX_AXES).any(|axis| (second[axis] - first[axis]).abs() > MOVES);
            known_from += if moves { UNKNOWN } else { 0.0 };
        }
        Ok(Self {
            overlay,
            alignment,
            servos,
            period: track.period,
            count: track.joints.len(),
            known_from,
            sums: Default::default(),
            contours: Default::default(),
        })
    }

    fn compare(&mut self, chains: &[(f64, Arc<Solver>)], listen: &mut dyn FnMut(&MeasuredPoint)) {
        self.compare_positions();
        let both = self.overlay.log.both();
        if both.is_empty() {
            return;
        }
        let mut path = LoggedPath::new(self.period, chains);
        let mut followed = Vec::new();
        let mut run = 0;
        for from in (0..self.count).step_by(BATCH) {
            let to = (from + BATCH).min(self.count);
            let commanded = &self.overlay.log.commanded.joints[from..to];
            self.servos.follow(commanded, &mut followed);
            for place in from..to {
                let row = [
                    self.overlay.log.commanded.joints[place],
                    self.overlay.log.actual.joints[place],
                    followed[place - from],
                ];
                self.row(place, row, &both, &mut run, &mut path);
            }
            self.errors(&mut path, listen);
        }
        path.finish();
        self.errors(&mut path, listen);
    }

    /// Positions at the same time.
    fn compare_positions(&mut self) {
        let (overlay, shift) = (self.overlay, self.alignment.shift);
        let pairs = [
            (&overlay.log.commanded, &overlay.commanded),
            (&overlay.log.actual, &overlay.actual),
        ];
        for (which, (log, predicted)) in pairs.into_iter().enumerate() {
            for (place, joints) in log.joints.iter().enumerate() {
                let time = log.time(place);
                let Some(predicted) = predicted.at(time - shift) else {
                    continue;
                };
                for axis in 0..MAX_AXES {
                    if overlay.log.has[which][axis] {
                        let left = predicted[axis] - (joints[axis] - self.alignment.zeros[axis]);
                        self.sums[axis][which].take(time, left);
                    }
                }
            }
        }
    }

    /// A row of the log, with where the servos are.
    fn row(
        &mut self,
        place: usize,
        [commanded, actual, followed]: [Joints; 3],
        both: &[usize],
        run: &mut usize,
        path: &mut LoggedPath<'_>,
    ) {
        let time = self.overlay.log.commanded.time(place);
        let predicted_time = time - self.alignment.shift;
        let Some(others) = self.overlay.commanded.at(predicted_time) else {
            path.leaves();
            return;
        };
        let known = time >= self.known_from;
        let mut following = [Joints::default(); 2];
        // Axes that the log does not have are where they are predicted, and follow exactly.
        let mut joints = [others; 3];
        for axis in both {
            let zero = self.alignment.zeros[*axis];
            let row = [commanded[*axis], actual[*axis], followed[*axis]];
            let errors = [row[1] - row[0], row[2] - row[0]];
            for which in 0..3 {
                joints[which][*axis] = row[which] - zero;
            }
            for which in 0..2 {
                following[which][*axis] = errors[which];
            }
            if known {
                let [_, _, measured, predicted, left] = &mut self.sums[*axis];
                measured.take(time, errors[0]);
                predicted.take(time, errors[1]);
                left.take(time, errors[1] - errors[0]);
            }
        }
        let period = self.overlay.commanded.period;
        let set_point = libm::rint((predicted_time - self.overlay.commanded.begins) / period);
        let at = self.overlay.at(set_point.max(0.0) as usize, run);
        path.take(
            predicted_time,
            joints,
            MeasuredPoint {
                time: predicted_time,
                line: at.line,
                cuts: at.cuts && known,
                following,
                contour: [0.0; 2],
            },
        );
    }

    /// Contour errors that are known by now.
    fn errors(&mut self, path: &mut LoggedPath<'_>, listen: &mut dyn FnMut(&MeasuredPoint)) {
        while let Some(point) = path.next() {
            if point.cuts {
                let time = point.time + self.alignment.shift;
                let [measured, predicted] = point.contour;
                let all = [measured, predicted, predicted - measured];
                for (sum, value) in self.contours.iter_mut().zip(all) {
                    sum.take(time, value);
                }
            }
            listen(&point);
        }
    }

    fn axes(&self, machine: &Machine) -> Vec<AxisLaid> {
        let logged = |place: usize| (0..2).any(|which| self.overlay.log.has[which][place]);
        let axes = machine.axes.iter().enumerate();
        axes.filter(|(place, _)| logged(*place))
            .map(|(place, axis)| {
                let [commanded, actual, measured, predicted, following] =
                    self.sums[place].map(|sum| Left::of(&sum, axis.unit()));
                AxisLaid {
                    name: axis.name.clone(),
                    unit: if axis.joint.rotary { "deg" } else { "mm" },
                    zero: self.alignment.zeros[place] / axis.unit(),
                    commanded,
                    actual,
                    following_measured: measured,
                    following_predicted: predicted,
                    following,
                }
            })
            .collect()
    }

    fn contour(&self) -> Option<ContourLaid> {
        let [measured, predicted, difference] = self.contours.map(|sum| Left::of(&sum, 1.0));
        Some(ContourLaid {
            measured: measured?,
            predicted: predicted?,
            difference: difference?,
        })
    }
}

/// The path that was commanded by the log, and how far the tool was off it: as measured, and as predicted.
struct LoggedPath<'a> {
    chains: &'a [(f64, Arc<Solver>)],
    chain: usize,
    points: Option<SetPoints>,
    period: f64,
    /// Actual axis values of `points`.
    actual: [Vec<Joints>; 2],
    contours: [Contour; 2],
    /// Rows whose contour errors are not known yet, and errors whose rows have not been told.
    rows: VecDeque<MeasuredPoint>,
    errors: [VecDeque<f64>; 2],
}

impl<'a> LoggedPath<'a> {
    fn new(period: f64, chains: &'a [(f64, Arc<Solver>)]) -> Self {
        Self {
            chains,
            chain: 0,
            points: None,
            period,
            actual: Default::default(),
            contours: Default::default(),
            rows: VecDeque::new(),
            errors: Default::default(),
        }
    }

    /// Takes a row: axis values commanded, measured and predicted.
    fn take(
        &mut self,
        time: f64,
        [commanded, measured, predicted]: [Joints; 3],
        row: MeasuredPoint,
    ) {
        let mut chain = self.chain;
        while self
            .chains
            .get(chain + 1)
            .is_some_and(|(from, _)| *from <= time)
        {
            chain += 1;
        }
        if chain != self.chain {
            self.flush();
            self.points = None;
            self.chain = chain;
        }
        let Some((_, solver)) = self.chains.get(chain) else {
            return;
        };
        let points = self
            .points
            .get_or_insert_with(|| SetPoints::new(Arc::clone(solver), self.period));
        points.joints.push(commanded);
        points.poses.push(solver.chain().forward(&commanded));
        points.at.push(At {
            task: 0,
            line: row.line,
            cuts: row.cuts,
        });
        self.actual[0].push(measured);
        self.actual[1].push(predicted);
        self.rows.push_back(row);
        if self.rows.len() >= BATCH && points.len() >= BATCH {
            self.flush();
        }
    }

    /// The rows that come are not next to those that came.
    fn leaves(&mut self) {
        self.finish();
        self.points = None;
    }

    fn flush(&mut self) {
        let Some(points) = &mut self.points else {
            return;
        };
        for which in 0..2 {
            let errors = &mut self.errors[which];
            self.contours[which].take(points, &self.actual[which], &mut |point| {
                errors.push_back(point.distance);
            });
            self.actual[which].clear();
        }
        points.clear();
    }

    fn finish(&mut self) {
        self.flush();
        for which in 0..2 {
            let errors = &mut self.errors[which];
            let contour = std::mem::take(&mut self.contours[which]);
            contour.finish(&mut |point| errors.push_back(point.distance));
        }
    }

    /// The next row with its contour errors.
    fn next(&mut self) -> Option<MeasuredPoint> {
        if self.errors.iter().any(VecDeque::is_empty) {
            return None;
        }
        let row = self.rows.pop_front()?;
        let [measured, predicted] = &mut self.errors;
        Some(MeasuredPoint {
            contour: [measured.pop_front()?, predicted.pop_front()?],
            ..row
        })
    }
}
