//! What the report of a program that is made says of its prediction: the series over time, and the rows of its blocks.

use post_machine::description::Machine;

use super::block_rows::BlockRows;
use super::parts::Parts;
use super::predicted_lines::PredictedLines;
use super::predicted_rows::PredictedRows;
use crate::failure::Failure;
use crate::predict::Sample;

/// Takes set-points.
pub struct PredictedParts {
    series: PredictedLines,
    rows: PredictedRows,
}

impl PredictedParts {
    /// For the set-points of a program whose blocks are these; none where nothing was to be predicted of them.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn of(machine: &Machine, blocks: &mut BlockRows<'_>) -> Result<Option<Self>, Failure> {
        let Some(lines) = blocks.lines()? else {
            return Ok(None);
        };
        Ok(Some(Self {
            series: PredictedLines::new(machine, machine.motion.period)?,
            rows: PredictedRows::new(machine, lines)?,
        }))
    }

    /// The next set-point.
    pub fn take(&mut self, sample: &Sample) {
        if let Some((line, heard)) = self.series.take(sample) {
            self.rows.hear(line, heard);
        }
    }

    /// All set-points have come: they go to `parts`.
    ///
    /// # Errors
    /// They could not be kept.
    pub fn finish(mut self, parts: &mut Parts) -> Result<(), Failure> {
        if let Some((line, heard)) = self.series.finish(parts)? {
            self.rows.hear(line, heard);
        }
        self.rows.finish(parts)
    }
}
