//! A prediction, set-point by set-point: the series over time, and the largest of each line of the program.

use post_machine::description::Machine;
use post_machine::kinematics::{Joints, MAX_AXES};
use post_report::table::{Column, TableWriter};

use super::block_rows::decimals;
use super::motion_rows::{Heard, Hears};
use super::parts::{Parts, fault};
use crate::failure::Failure;
use crate::files::Scratch;
use crate::job::predict::Sample;

/// Takes set-points.
pub struct PredictedLines {
    table: TableWriter<Scratch>,
    period: f64,
    /// The line that is carried out, and what was seen of it.
    line: u64,
    heard: Heard,
    /// Commanded axis values and velocities of the set-point before.
    last: Option<(Joints, Option<Joints>)>,
    fault: Option<Failure>,
}

impl PredictedLines {
    /// For set-points of a machine, so many seconds apart.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new(machine: &Machine, period: f64) -> Result<Self, Failure> {
        let error = decimals(machine.accuracy.tolerance);
        let columns = vec![
            Column::new("t", "s", 6),
            Column::new("feed", "mm/min", 1),
            Column::new("contour", "mm", error),
        ];
        Ok(Self {
            table: TableWriter::new("series", columns, Parts::scratch()?),
            period,
            line: 0,
            heard: Heard::default(),
            last: None,
            fault: None,
        })
    }

    /// The next set-point; what is known of the line before goes to `rows`.
    pub fn take(&mut self, sample: &Sample, rows: &mut dyn Hears) {
        let point = &sample.point;
        let time = point.time;
        let cl = sample.cl_line().unwrap_or(0);
        let error = match sample.counts() {
            true => sample.size(),
            false => 0.0,
        };
        if let Err(error) = self.table.row(&[time, sample.feed, error]) {
            self.fault.get_or_insert(fault(error));
        }
        if sample.at.line != self.line {
            self.end(rows);
            self.line = sample.at.line;
            self.heard = Heard { cl, times: Some([time, time]), ..Heard::default() };
        }
        if let Some([_, to]) = &mut self.heard.times {
            *to = time + self.period;
        }
        self.heard.contour = self.heard.contour.max(error);
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
    }

    /// All set-points have come: the series goes to `parts`.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(mut self, rows: &mut dyn Hears, parts: &mut Parts) -> Result<(), Failure> {
        self.end(rows);
        match self.fault {
            Some(fault) => Err(fault),
            None => parts.table(self.table),
        }
    }

    fn end(&mut self, rows: &mut dyn Hears) {
        if self.line > 0 {
            rows.hear(self.line, &self.heard);
        }
    }
}
