//! A prediction, set-point by set-point: the series over time, and the largest of each line of the program.

use post_machine::description::Machine;
use post_machine::kinematics::{Joints, MAX_AXES};

use super::block_rows::decimals;
use super::motion_rows::LineFacts;
use super::page_table::PageTable;
use super::parts::Parts;
use crate::columns::Column;
use crate::failure::Failure;
use crate::predict::Sample;

/// The contour error where it counts, mm.
fn contour(sample: &Sample) -> f64 {
    match sample.counts() {
        true => sample.size(),
        false => 0.0,
    }
}

/// Takes set-points.
pub struct PredictedLines {
    table: PageTable<Sample>,
    period: f64,
    /// The line that is carried out, and what was seen of it.
    line: u64,
    heard: LineFacts,
    /// Commanded axis values and velocities of the set-point before.
    last: Option<(Joints, Option<Joints>)>,
}

impl PredictedLines {
    /// For set-points of a machine, so many seconds apart.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new(machine: &Machine, period: f64) -> Result<Self, Failure> {
        let error = decimals(machine.accuracy.tolerance);
        let columns = vec![
            Column::new("t", "s", 6, |sample: &Sample| sample.point.time),
            Column::new("feed", "mm/min", 1, |sample: &Sample| sample.feed),
            Column::new("contour", "mm", error, contour),
        ];
        Ok(Self {
            table: PageTable::new("series", columns)?,
            period,
            line: 0,
            heard: LineFacts::default(),
            last: None,
        })
    }

    /// The next set-point; where it is the first of a line, what is known of the line before.
    pub fn take(&mut self, sample: &Sample) -> Option<(u64, LineFacts)> {
        let point = &sample.point;
        let time = point.time;
        let cl = sample.cl_line().unwrap_or(0);
        self.table.row(sample);
        let mut before = None;
        if sample.at.line != self.line {
            let heard = LineFacts { cl, times: Some([time, time]), ..LineFacts::default() };
            before = self.line(sample.at.line, heard);
        }
        if let Some([_, to]) = &mut self.heard.times {
            *to = time + self.period;
        }
        self.heard.contour = self.heard.contour.max(contour(sample));
        let joints = point.commanded_joints;
        let mut velocity = None;
        if let Some((last, before)) = &self.last {
            let now: Joints = std::array::from_fn(|axis| (joints[axis] - last[axis]) / self.period);
            for axis in 0..MAX_AXES {
                let [velocities, accelerations] = &mut self.heard.peaks;
                velocities[axis] = velocities[axis].max(libm::fabs(now[axis]));
                if let Some(before) = before {
                    let change = libm::fabs(now[axis] - before[axis]) / self.period;
                    accelerations[axis] = accelerations[axis].max(change);
                }
            }
            velocity = Some(now);
        }
        self.last = Some((joints, velocity));
        before
    }

    /// All set-points have come: the series goes to `parts`; what is known of the last line.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(mut self, parts: &mut Parts) -> Result<Option<(u64, LineFacts)>, Failure> {
        let last = self.line(0, LineFacts::default());
        self.table.finish(parts)?;
        Ok(last)
    }

    /// Another line is carried out: what is known of the one before.
    fn line(&mut self, line: u64, heard: LineFacts) -> Option<(u64, LineFacts)> {
        let before = std::mem::replace(&mut self.line, line);
        let known = std::mem::replace(&mut self.heard, heard);
        (before > 0).then_some((before, known))
    }
}
