//! What is left between a prediction and a log that is laid over it.

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::kinematics::{Joints, MAX_AXES, Solver};
use post_motion::measured::{Alignment, DifferenceSum};
use post_motion::servo::Servos;

use super::coarse;
use super::logged_path::{BATCH, LoggedPath, MeasuredPoint};
use super::overlay::{MOVES, Overlay, UNKNOWN};
use super::report::{AxisLaid, ContourLaid, RemainingDifference};
use crate::failure::Failure;

/// What is compared, and what has come of it so far.
pub(super) struct LogComparison<'a> {
    overlay: &'a Overlay,
    alignment: &'a Alignment,
    servos: Servos,
    /// Set-points from row to row.
    steps: usize,
    /// Of the log.
    pub period: f64,
    pub count: usize,
    /// Before this time of the log the servos' state is not known, s.
    known_from: f64,
    /// Axes whose following error is known. Of a log without commanded positions all that it has: the commanded ones are
    /// those of the prediction.
    axes: Vec<usize>,
    /// By axis: commanded, actual, following measured, predicted, and their difference.
    sums: [[DifferenceSum; 5]; MAX_AXES],
    /// Contour error: measured, predicted, and their difference.
    contours: [DifferenceSum; 3],
}

impl<'a> LogComparison<'a> {
    pub fn new(
        overlay: &'a Overlay,
        machine: &Machine,
        alignment: &'a Alignment,
    ) -> Result<Self, Failure> {
        let log = &overlay.log;
        let (track, axes) = match log.commanded.joints.is_empty() {
            false => (&log.commanded, log.both()),
            true => (&log.actual, log.axes(super::log::LoggedPosition::Actual)),
        };
        let steps = coarse::steps(machine, log);
        let period = track.period / steps as f64;
        let mut servos = Servos::new(machine, period).map_err(|fault| *fault)?;
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
            steps,
            period: track.period,
            count: track.joints.len(),
            known_from,
            axes,
            sums: Default::default(),
            contours: Default::default(),
        })
    }

    /// Goes through the log; `listen` is told of each row in which a following error is known.
    pub fn run(&mut self, chains: &[(f64, Arc<Solver>)], listen: &mut dyn FnMut(&MeasuredPoint)) {
        self.positions();
        if self.axes.is_empty() {
            return;
        }
        let mut path = LoggedPath::new(self.period, chains);
        let (mut set_points, mut followed) = (Vec::new(), Vec::new());
        let mut run = 0;
        for from in (0..self.count).step_by(BATCH) {
            let to = (from + BATCH).min(self.count);
            let commanded = &self.overlay.log.commanded;
            if !commanded.joints.is_empty() {
                set_points.clear();
                set_points.extend((from..to).flat_map(|row| commanded.towards(row, self.steps)));
                self.servos.follow(&set_points, &mut followed);
            }
            for place in from..to {
                let last = (place - from) * self.steps + self.steps - 1;
                let followed = followed.get(last).copied();
                self.row(place, followed, &mut run, &mut path);
            }
            self.errors(&mut path, listen);
        }
        path.finish();
        self.errors(&mut path, listen);
    }

    /// Positions at the same time.
    fn positions(&mut self) {
        let (overlay, shift) = (self.overlay, self.alignment.shift);
        let pairs =
            [(&overlay.log.commanded, &overlay.commanded), (&overlay.log.actual, &overlay.actual)];
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

    /// A row of the log, with where the servos are if they follow its commands.
    fn row(
        &mut self,
        place: usize,
        followed: Option<Joints>,
        run: &mut usize,
        path: &mut LoggedPath<'_>,
    ) {
        let log = &self.overlay.log;
        let time = log.actual.time(place);
        let predicted_time = time - self.alignment.shift;
        let Some(predicted) = self.overlay.commanded.at(predicted_time) else {
            path.leaves();
            return;
        };
        let predicted_actual = self.overlay.actual.at(predicted_time).unwrap_or(predicted);
        let known = time >= self.known_from;
        // Axes that the log does not have are where they are predicted, and follow exactly.
        let mut joints = [predicted; 3];
        let mut following = [[f64::NAN; 2]; MAX_AXES];
        for axis in &self.axes {
            let zero = self.alignment.zeros[*axis];
            let actual = log.actual.joints[place][*axis] - zero;
            let row = match followed {
                Some(followed) => {
                    let commanded = log.commanded.joints[place][*axis] - zero;
                    [commanded, actual, followed[*axis] - zero]
                }
                None => [predicted[*axis], actual, predicted_actual[*axis]],
            };
            for which in 0..3 {
                joints[which][*axis] = row[which];
            }
            if known {
                let errors = [row[0] - row[1], row[0] - row[2]];
                following[*axis] = errors;
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

    /// What is left of each axis of the log; `between` as [`coarse::between`] gives it.
    pub fn axes(
        &self,
        machine: &Machine,
        between: Option<&[DifferenceSum; MAX_AXES]>,
    ) -> Vec<AxisLaid> {
        let logged = |place: &usize| (0..2).any(|which| self.overlay.log.has[which][*place]);
        let axes = post_machine::axis_words::order(machine).into_iter();
        axes.filter(logged)
            .map(|place| {
                let axis = &machine.axes[place];
                let [commanded, actual, measured, predicted, following] =
                    self.sums[place].map(|sum| RemainingDifference::of(&sum, axis.unit()));
                AxisLaid {
                    name: axis.name.clone(),
                    unit: axis.unit_name(),
                    alike: self.alignment.alike[place],
                    zero: self.alignment.zeros[place] / axis.unit(),
                    commanded,
                    actual,
                    following_measured: measured,
                    following_predicted: predicted,
                    following,
                    between_rows: between
                        .and_then(|between| RemainingDifference::of(&between[place], axis.unit())),
                }
            })
            .collect()
    }

    /// What is left of the contour error.
    pub fn contour(&self) -> Option<ContourLaid> {
        let [measured, predicted, difference] =
            self.contours.map(|sum| RemainingDifference::of(&sum, 1.0));
        Some(ContourLaid { measured: measured?, predicted: predicted?, difference: difference? })
    }
}
