//! Rows of lines of a program, one each however often it is run: on the disk, so that memory does not grow with the program.

use std::io::{self, BufReader, Seek as _, SeekFrom, Write as _};

use super::line_row::LineRow;
use crate::files::{FileFault, Temporary};

/// Bytes of a row.
const ROW: usize = 8 * LineRow::NUMBERS;

/// Lines that are told at most: a larger number is no line of a text.
const MOST_LINES: u64 = 1 << 32;

/// The rows.
pub(super) struct LineTable {
    rows: Temporary,
    /// The line behind the last that has a row.
    end: u64,
    fault: Option<io::Error>,
}

impl LineTable {
    /// A table without rows.
    ///
    /// # Errors
    /// There is no place for it.
    pub fn new() -> Result<Self, FileFault> {
        let rows = Temporary::private(&std::env::temp_dir()).map_err(no_place)?;
        Ok(Self { rows, end: 0, fault: None })
    }

    /// Takes a pass of a line, besides those that were taken before.
    pub fn take(&mut self, row: &LineRow) {
        if self.fault.is_none() && row.line() < MOST_LINES {
            self.fault = self.put(row).err();
        }
    }

    fn put(&mut self, row: &LineRow) -> io::Result<()> {
        let line = row.line();
        let row = match line < self.end {
            true => self.at(line)?.map_or(*row, |known| known.and(row)),
            false => *row,
        };
        let mut bytes = [0; ROW];
        for (place, number) in bytes.chunks_exact_mut(8).zip(row.numbers()) {
            place.copy_from_slice(&number.to_le_bytes());
        }
        self.rows.seek(SeekFrom::Start(line * ROW as u64))?;
        self.rows.write_all(&bytes)?;
        self.end = self.end.max(line + 1);
        Ok(())
    }

    /// The row of a line; none where nothing was told of it.
    fn at(&mut self, line: u64) -> io::Result<Option<LineRow>> {
        self.rows.seek(SeekFrom::Start(line * ROW as u64))?;
        next(&mut self.rows, line)
    }

    /// Hands on all rows in the order of their lines.
    ///
    /// # Errors
    /// They could not be kept.
    pub fn hand_on(mut self, take: &mut dyn FnMut(&LineRow)) -> Result<(), FileFault> {
        if let Some(fault) = self.fault.take() {
            return Err(no_place(fault));
        }
        self.rows.rewind().map_err(no_place)?;
        let mut rows = BufReader::new(self.rows);
        for line in 0..self.end {
            if let Some(row) = next(&mut rows, line).map_err(no_place)? {
                take(&row);
            }
        }
        Ok(())
    }
}

/// The next row, that of a line.
fn next(rows: &mut impl io::Read, line: u64) -> io::Result<Option<LineRow>> {
    let mut bytes = [0; ROW];
    rows.read_exact(&mut bytes)?;
    let mut numbers = [0.0; LineRow::NUMBERS];
    for (number, place) in numbers.iter_mut().zip(bytes.chunks_exact(8)) {
        *number = f64::from_le_bytes(place.try_into().unwrap_or_default());
    }
    Ok(LineRow::of(line, numbers))
}

fn no_place(error: io::Error) -> FileFault {
    let folder = std::env::temp_dir();
    FileFault::NoWaiting { name: "table of lines".to_owned(), folder, error: error.kind().into() }
}
