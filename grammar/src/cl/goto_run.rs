//! `GOTO` records of one layout, many at once.

use super::record::{Record, Statement};

/// `GOTO` records that follow one another and are laid out alike: see [`ClReader::next_gotos`](super::ClReader::next_gotos).
#[derive(Clone, Debug)]
pub struct GotoRun {
    pub(super) form: RunForm,
    /// Numbers of the points, column by column.
    pub(super) values: [[f64; GotoRun::MOST]; 6],
}

/// All of a run but its numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct RunForm {
    /// Number of records.
    pub(super) count: usize,
    /// Line of the file on which the first begins.
    pub(super) line: u64,
    /// Lines of the file that each takes.
    pub(super) lines: u64,
    /// Each gives a tool axis; else none does.
    pub(super) has_axis: bool,
    /// Bytes from one to the next.
    pub(super) stride: usize,
    /// Bytes of each.
    pub(super) length: usize,
}

impl RunForm {
    /// Columns of numbers that the records give.
    pub(super) fn columns(&self) -> usize {
        if self.has_axis { 6 } else { 3 }
    }
}

impl Default for GotoRun {
    fn default() -> Self {
        let form = RunForm { count: 0, line: 0, lines: 1, has_axis: false, stride: 0, length: 0 };
        Self { form, values: [[0.0; Self::MOST]; 6] }
    }
}

impl GotoRun {
    /// Most records of a run.
    pub const MOST: usize = 64;

    /// Number of records.
    #[inline]
    pub fn count(&self) -> usize {
        self.form.count
    }

    /// Coordinates and tool axes of the points (zeros if none is given), a column each, in the file's units. What stands after
    /// the last record is of no meaning.
    #[inline]
    pub fn columns(&self) -> &[[f64; Self::MOST]; 6] {
        &self.values
    }

    /// A point with its tool axis, or zeros if none is given, by its place; in the file's units.
    #[inline]
    pub fn point(&self, place: usize) -> [f64; 6] {
        self.values.map(|column| column[place])
    }

    /// Every record gives a tool axis; else none does.
    #[inline]
    pub fn has_axis(&self) -> bool {
        self.form.has_axis
    }

    /// Line of the file on which a record begins, by its place among the points.
    #[inline]
    pub fn line(&self, place: usize) -> u64 {
        self.form.line + place as u64 * self.form.lines
    }

    /// Line of the file on which the last record begins.
    #[inline]
    pub fn last_line(&self) -> u64 {
        self.line(self.form.count.saturating_sub(1))
    }

    /// Lines of the file that every record takes.
    pub fn lines(&self) -> u64 {
        self.form.lines
    }

    /// Bytes of every record in the text of the run.
    pub fn length(&self) -> usize {
        self.form.length
    }

    /// Bytes from one record to the next in the text of the run.
    pub fn stride(&self) -> usize {
        self.form.stride
    }

    /// A record of the run, by its place among the points; `text` is that of the run.
    pub fn record<'t>(&self, place: usize, text: &'t [u8]) -> Record<'t> {
        let from = place * self.form.stride;
        Record {
            line: self.line(place),
            raw: &text[from..from + self.form.length],
            statement: goto_statement(&self.point(place), self.form.has_axis),
        }
    }
}

/// What the numbers of a `GOTO` say.
#[inline(always)]
pub(super) fn goto_statement(values: &[f64; 6], has_axis: bool) -> Statement {
    let [x, y, z, i, j, k] = *values;
    Statement::Goto { point: [x, y, z], axis: has_axis.then_some([i, j, k]) }
}
