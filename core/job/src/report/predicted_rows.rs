//! What is predicted of the blocks of a program that was posted: a row for each of theirs.

use std::collections::VecDeque;
use std::io::{self, Read};

use post_machine::description::Machine;

use super::block_rows::{decimals, packed};
use super::motion_rows::LineFacts;
use super::page_table::PageTable;
use super::parts::{Parts, fault};
use crate::columns::Column;
use crate::failure::Failure;

/// A line that somebody tells of is looked for so many rows ahead.
const AHEAD: usize = 4096;

/// The largest contour error of a row, and the largest velocity and acceleration of each axis; `heard` is what is known of
/// the row.
pub fn columns<R: 'static>(machine: &Machine, heard: fn(&R) -> &LineFacts) -> Vec<Column<R>> {
    let error = decimals(machine.accuracy.tolerance);
    let mut columns = vec![Column::new("contour", "mm", error, move |row| heard(row).contour)];
    let letters = [("v", ["mm/s", "deg/s"]), ("a", ["mm/s²", "deg/s²"])];
    for (which, (letter, units)) in letters.into_iter().enumerate() {
        for (place, axis) in machine.axes.iter().enumerate() {
            let (name, counted) = (format!("{letter}.{}", axis.name), axis.unit());
            let value = move |row: &R| heard(row).peaks[which][place] / counted;
            columns.push(Column::new(name, units[usize::from(axis.joint.rotary)], 3, value));
        }
    }
    columns
}

/// A row of the page.
struct PredictedRow {
    /// When it begins and ends, as they are packed, s.
    times: [f64; 2],
    heard: LineFacts,
}

/// Takes what is heard of lines, and packs it for the rows that stand on them.
pub struct PredictedRows {
    table: PageTable<PredictedRow>,
    /// Lines of the rows, 32 bits each, least byte first.
    lines: Box<dyn Read>,
    /// Those that were read and wait.
    waiting: VecDeque<u64>,
    ended: bool,
    /// End of the row before, s.
    end: f64,
    fault: Option<Failure>,
}

impl PredictedRows {
    /// For rows that stand on these lines.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new(machine: &Machine, lines: Box<dyn Read>) -> Result<Self, Failure> {
        let mut all = vec![
            Column::new("t0", "s", 4, |row: &PredictedRow| row.times[0]).from("t1"),
            Column::new("t1", "s", 4, |row: &PredictedRow| row.times[1]),
        ];
        all.extend(columns(machine, |row: &PredictedRow| &row.heard));
        Ok(Self {
            table: PageTable::new("predicted", all)?,
            lines,
            waiting: VecDeque::new(),
            ended: false,
            end: 0.0,
            fault: None,
        })
    }

    /// All was heard: the table goes to `parts`.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(mut self, parts: &mut Parts) -> Result<(), Failure> {
        while self.read() || !self.waiting.is_empty() {
            self.write(&LineFacts::default());
        }
        match self.fault {
            Some(fault) => Err(fault),
            None => self.table.finish(parts),
        }
    }

    /// One line more waits; false where there is none.
    fn read(&mut self) -> bool {
        let mut line = [0; 4];
        match self.lines.read_exact(&mut line) {
            _ if self.ended => {}
            Ok(()) => self.waiting.push_back(u64::from(u32::from_le_bytes(line))),
            Err(error) => {
                self.ended = true;
                if error.kind() != io::ErrorKind::UnexpectedEof {
                    self.fault.get_or_insert(fault(error));
                }
            }
        }
        !self.ended
    }

    /// Packs the first row that waits.
    fn write(&mut self, heard: &LineFacts) {
        self.waiting.pop_front();
        let [from, to] = heard.times.unwrap_or([self.end; 2]);
        let times = [packed(from) - packed(self.end), to];
        self.end = to;
        self.table.row(&PredictedRow { times, heard: heard.clone() });
    }

    /// All rows of `line` get what was heard of it; those before it that nobody told of stay as they are.
    pub fn hear(&mut self, line: u64, mut heard: LineFacts) {
        let place = loop {
            let place = self.waiting.iter().position(|row| *row == line);
            if place.is_some() || self.waiting.len() >= AHEAD || !self.read() {
                break place;
            }
        };
        for _ in 0..place.unwrap_or(0) {
            self.write(&LineFacts::default());
        }
        while place.is_some() {
            if self.waiting.is_empty() && !self.read() {
                return;
            }
            if self.waiting.front() != Some(&line) {
                return;
            }
            self.write(&heard);
            // Of several blocks on a line the first is given its time.
            heard.times = heard.times.map(|[_, to]| [to, to]);
        }
    }
}
