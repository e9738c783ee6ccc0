//! A recorded log: a table with the time and where the axes were commanded and were.

use std::io::{BufRead, BufReader, Read};

use post_machine::description::Machine;
use post_machine::kinematics::MAX_AXES;
use post_motion::measured::AxisTrack;

use super::clock::Clock;
use super::columns::{ColumnNames, Columns};
use super::rows::LogReader;
use super::units::LogUnits;
use crate::failure::Failure;
use crate::files::FileFault;

/// A longer line is no row of a log, bytes.
const LONGEST_LINE: u64 = 64 * 1024;

/// How a log is to be read.
#[derive(Clone, Debug, Default)]
pub struct LogForm {
    /// Which column holds what; none: as the names in its head say.
    pub columns: Option<ColumnNames>,
    /// Its units, over those of its head.
    pub units: LogUnits,
    /// Time from row to row, s, of a log whose times are not read.
    pub period: Option<f64>,
}

/// A recorded log, at equal distances in time.
#[derive(Clone, Debug)]
pub struct Log {
    /// Its file.
    pub name: String,
    /// Rows that it has.
    pub rows: usize,
    /// What its times say.
    pub clock: Clock,
    /// Its columns.
    pub columns: Columns,
    /// Where the axes were commanded, and where they were, mm and radians, counted as the machine file counts.
    pub commanded: AxisTrack,
    /// Likewise.
    pub actual: AxisTrack,
    /// Axes that are in [`Log::commanded`], and in [`Log::actual`].
    pub has: [[bool; MAX_AXES]; 2],
    /// Jumps of a rotary axis by about a full turn, which are taken for its count starting again.
    pub turns: u64,
}

impl Log {
    /// Reads `input`, which messages call `name`.
    ///
    /// # Errors
    /// What is no log: by line columns that are missing, what is no number, times that do not increase, gaps, too many rows.
    pub fn read(
        machine: &Machine,
        form: &LogForm,
        name: &str,
        input: impl Read,
    ) -> Result<Self, Failure> {
        let mut rows = LogReader::new(machine, form, name);
        let mut input = BufReader::new(input);
        let mut bytes = Vec::new();
        loop {
            bytes.clear();
            let mut line = (&mut input).take(LONGEST_LINE);
            let read = line.read_until(b'\n', &mut bytes);
            let read = read.map_err(|error| FileFault::Read { name: name.to_owned(), error })?;
            if read == 0 {
                return Ok(rows.finish()?);
            }
            rows.line += 1;
            if read as u64 == LONGEST_LINE {
                let fault = rows.fault("the line is too long for a row of a log", "");
                let help = "a log is a table of text; compressed files must be unpacked first";
                return Err(fault.help(help).into());
            }
            if bytes.contains(&0) || bytes.starts_with(&[0x1f, 0x8b]) {
                let fault = rows.fault("this is no text", "");
                let help =
                    "a log is a table of text in UTF-8; compressed files must be unpacked first";
                return Err(fault.help(help).into());
            }
            rows.take(&String::from_utf8_lossy(&bytes))?;
        }
    }

    /// Places of the axes whose commanded position it has, or the actual one.
    pub fn axes(&self, which: LoggedPosition) -> Vec<usize> {
        let has = &self.has[which as usize];
        (0..MAX_AXES).filter(|place| has[*place]).collect()
    }

    /// Places of the axes of which it has both.
    pub fn both(&self) -> Vec<usize> {
        let both = |place: &usize| self.has[0][*place] && self.has[1][*place];
        (0..MAX_AXES).filter(both).collect()
    }
}

/// One of the two positions of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoggedPosition {
    /// Where it was commanded.
    Commanded,
    /// Where it was.
    Actual,
}
