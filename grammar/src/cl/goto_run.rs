//! `GOTO` records of one layout, many at once.

use super::record::{Record, Statement};

/// `GOTO` records that follow one another and are laid out alike: see [`ClReader::next_gotos`](super::ClReader::next_gotos).
#[derive(Clone, Debug)]
pub struct GotoRun {
    pub(super) count: usize,
    pub(super) line: u64,
    pub(super) lines: u64,
    pub(super) values: [[f64; 6]; GotoRun::MOST],
    pub(super) has_axis: bool,
    pub(super) stride: usize,
    pub(super) length: usize,
}

impl Default for GotoRun {
    fn default() -> Self {
        Self {
            count: 0,
            line: 0,
            lines: 1,
            values: [[0.0; 6]; Self::MOST],
            has_axis: false,
            stride: 0,
            length: 0,
        }
    }
}

impl GotoRun {
    /// Most records of a run.
    pub const MOST: usize = 64;

    /// Points, each with the tool axis, or zeros if none is given; in the file's units.
    #[inline]
    pub fn points(&self) -> &[[f64; 6]] {
        &self.values[..self.count]
    }

    /// Every record gives a tool axis; else none does.
    #[inline]
    pub fn has_axis(&self) -> bool {
        self.has_axis
    }

    /// Line of the file on which a record begins, by its place among the points.
    #[inline]
    pub fn line(&self, place: usize) -> u64 {
        self.line + place as u64 * self.lines
    }

    /// Every record takes one line of the file.
    pub fn is_by_lines(&self) -> bool {
        self.lines == 1
    }

    /// Bytes from one record to the next in the text of the run.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// A record of the run, by its place among the points; `text` is that of the run.
    pub fn record<'t>(&self, place: usize, text: &'t [u8]) -> Record<'t> {
        let from = place * self.stride;
        Record {
            line: self.line(place),
            raw: &text[from..from + self.length],
            statement: goto_statement(&self.values[place], self.has_axis),
        }
    }
}

/// What the numbers of a `GOTO` say.
#[inline(always)]
pub(super) fn goto_statement(values: &[f64; 6], has_axis: bool) -> Statement {
    let [x, y, z, i, j, k] = *values;
    Statement::Goto { point: [x, y, z], axis: has_axis.then_some([i, j, k]) }
}
