//! How far the tool was off the path that a log commands: as measured, and as predicted.

use std::collections::VecDeque;
use std::sync::Arc;

use post_machine::kinematics::{Joints, MAX_AXES, Solver};
use post_motion::contour::Contour;
use post_motion::{ProgramPlace, SetPoints};

/// Rows of a batch.
pub(super) const BATCH: usize = 256;

/// What was measured at an instant, and what is predicted for it.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredPoint {
    /// When, s of the prediction's clock.
    pub time: f64,
    /// Line of the program.
    pub line: u64,
    /// The tool cuts, and what the servos did before is known.
    pub cuts: bool,
    /// Following error of each axis, commanded minus actual, as measured and as predicted, mm or radians; NaN where it is
    /// not known.
    pub following: [[f64; 2]; MAX_AXES],
    /// Contour error as measured, and as predicted, mm.
    pub contour: [f64; 2],
}

/// The path that was commanded by the log, and how far the tool was off it: as measured, and as predicted.
pub(super) struct LoggedPath<'a> {
    chains: &'a [(f64, Arc<Solver>)],
    chain: usize,
    points: Option<SetPoints>,
    period: f64,
    /// Actual axis values of `points`.
    actual: [Vec<Joints>; 2],
    contours: [Contour<'static>; 2],
    /// Rows whose contour errors are not known yet, and errors whose rows have not been told.
    rows: VecDeque<MeasuredPoint>,
    errors: [VecDeque<f64>; 2],
}

impl<'a> LoggedPath<'a> {
    pub fn new(period: f64, chains: &'a [(f64, Arc<Solver>)]) -> Self {
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
    pub fn take(
        &mut self,
        time: f64,
        [commanded, measured, predicted]: [Joints; 3],
        row: MeasuredPoint,
    ) {
        let mut chain = self.chain;
        while self.chains.get(chain + 1).is_some_and(|(from, _)| *from <= time) {
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
        let points =
            self.points.get_or_insert_with(|| SetPoints::new(Arc::clone(solver), self.period));
        points.joints.push(commanded);
        points.poses.push(solver.chain().forward(&commanded));
        points.at.push(ProgramPlace { task: 0, line: row.line, cuts: row.cuts });
        self.actual[0].push(measured);
        self.actual[1].push(predicted);
        self.rows.push_back(row);
        if self.rows.len() >= BATCH && points.len() >= BATCH {
            self.flush();
        }
    }

    /// The rows that come are not next to those that came.
    pub fn leaves(&mut self) {
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

    pub fn finish(&mut self) {
        self.flush();
        for which in 0..2 {
            let errors = &mut self.errors[which];
            let contour = std::mem::take(&mut self.contours[which]);
            contour.finish(&mut |point| errors.push_back(point.distance));
        }
    }

    /// The next row with its contour errors.
    pub fn next(&mut self) -> Option<MeasuredPoint> {
        if self.errors.iter().any(VecDeque::is_empty) {
            return None;
        }
        let row = self.rows.pop_front()?;
        let [measured, predicted] = &mut self.errors;
        Some(MeasuredPoint { contour: [measured.pop_front()?, predicted.pop_front()?], ..row })
    }
}
