//! Set-points as rows.

use std::fmt::Write as _;

use post_machine::axis_words;
use post_machine::description::Machine;
use post_plugin::fixed;

use post_job::files::{AtomicFile, FileFault};
use post_job::predict::Sample;

/// So many bytes of rows are written at once.
const BUFFER: usize = 1 << 16;

/// The table, as it is written.
pub struct SetPointsCsv<'a, 'f> {
    machine: &'a Machine,
    file: &'f mut AtomicFile,
    /// Places of the axes in the chain, in the order of the columns.
    order: Vec<usize>,
    text: String,
}

impl<'a, 'f> SetPointsCsv<'a, 'f> {
    pub fn new(machine: &'a Machine, file: &'f mut AtomicFile) -> Self {
        let order = axis_words::order(machine);
        let mut text = String::with_capacity(2 * BUFFER);
        text.push_str("time,line,cl_line,cuts");
        for which in ["", "_actual"] {
            for place in &order {
                let _ = write!(text, ",{}{which}", machine.axes[*place].name);
            }
        }
        text.push_str(
            ",tip_x,tip_y,tip_z,tip_x_actual,tip_y_actual,tip_z_actual,error_x,error_y,error_z,error,axis_error,feed,feed_programmed\n",
        );
        Self { machine, file, order, text }
    }

    /// Takes the next set-point.
    pub fn take(&mut self, sample: &Sample) -> Result<(), FileFault> {
        let text = &mut self.text;
        let point = &sample.point;
        fixed(text, point.time, 6);
        let cl_line = sample.cl_line().map_or_else(String::new, |line| line.to_string());
        // Writing to a String cannot fail.
        let _ = write!(text, ",{},{cl_line},{}", sample.at.line, u8::from(sample.at.cuts));
        let mut column = |value: f64, decimals: u8| {
            text.push(',');
            fixed(text, value, decimals);
        };
        for joints in [&point.commanded_joints, &point.actual_joints] {
            for place in &self.order {
                column(self.machine.axes[*place].reading(joints[*place]), 6);
            }
        }
        for tip in [&point.commanded.tip, &point.actual.tip] {
            tip.iter().for_each(|value| column(*value, 6));
        }
        sample.error().iter().for_each(|value| column(*value, 7));
        column(sample.size(), 7);
        column(sample.axis().to_degrees(), 7);
        column(sample.feed, 2);
        column(sample.programmed, 2);
        self.text.push('\n');
        if self.text.len() > BUFFER {
            self.file.write_bytes(self.text.as_bytes())?;
            self.text.clear();
        }
        Ok(())
    }

    /// Writes what is left.
    pub fn finish(self) -> Result<(), FileFault> {
        self.file.write_bytes(self.text.as_bytes())
    }
}
