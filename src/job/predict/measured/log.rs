//! A recorded log, read from a table: comma, semicolon, tab or blanks between its columns.

use std::f64::consts::TAU;
use std::io::{BufRead, BufReader, Read};

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Place};
use post_machine::kinematics::{Joints, MAX_AXES};
use post_motion::measured::Track;

use super::columns::{ColumnNames, Columns, Content, LogUnits};
use crate::failure::Failure;
use crate::files::FileFault;

/// Rows of a log: about 136 bytes are kept of each. 1 ms over a quarter of an hour, 15 ms over four hours.
pub const MOST_ROWS: usize = 1_000_000;

/// Lines before the first row of numbers.
const MOST_HEAD: u64 = 100;

/// A longer line is no row of a log, bytes.
const LONGEST_LINE: u64 = 64 * 1024;

/// Rows that are needed.
const FEWEST_ROWS: usize = 8;

/// So many times the period without a row are a gap.
const GAP: f64 = 4.0;

/// How a log is to be read.
#[derive(Clone, Debug, Default)]
pub struct LogForm {
    /// Which column holds what; none: as the names in its head say.
    pub columns: Option<ColumnNames>,
    /// Its units.
    pub units: LogUnits,
    /// Time from row to row, s, of a log without times.
    pub period: Option<f64>,
}

/// A recorded log, at equal distances in time.
#[derive(Clone, Debug)]
pub struct Log {
    /// Its file.
    pub name: String,
    /// Rows that it has.
    pub rows: usize,
    /// Where the axes were commanded, and where they were, mm and radians, counted as the machine file counts.
    pub commanded: Track,
    /// Likewise.
    pub actual: Track,
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
        let mut rows = Rows::new(machine, form, name);
        let mut input = BufReader::new(input);
        let mut bytes = Vec::new();
        loop {
            bytes.clear();
            let mut line = (&mut input).take(LONGEST_LINE);
            let read = line.read_until(b'\n', &mut bytes);
            let read = read.map_err(|error| FileFault::Read {
                name: name.to_owned(),
                error,
            })?;
            if read == 0 {
                return Ok(rows.finish()?);
            }
            rows.line += 1;
            if read as u64 == LONGEST_LINE {
                return Err(rows
                    .fault("the line is too long for a row of a log", "")
                    .into());
            }
            rows.take(&String::from_utf8_lossy(&bytes))?;
        }
    }

    /// Places of the axes whose commanded position it has, or the actual one.
    pub fn axes(&self, which: Which) -> Vec<usize> {
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
pub enum Which {
    /// Where it was commanded.
    Commanded,
    /// Where it was.
    Actual,
}

/// A log that is being read.
struct Rows<'a> {
    machine: &'a Machine,
    form: &'a LogForm,
    name: &'a str,
    line: u64,
    /// The last line before the first row.
    head: Option<String>,
    columns: Option<(Separator, Columns)>,
    times: Vec<f64>,
    /// Lines of the rows.
    lines: Vec<u64>,
    /// Commanded and actual.
    joints: [Vec<Joints>; 2],
    turns: u64,
}

/// What stands between the columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    /// `;`: a comma in a number is its decimal sign.
    Semicolon,
    Tab,
    Comma,
    Blanks,
}

impl Separator {
    fn of(line: &str) -> Self {
        if line.contains(';') {
            Self::Semicolon
        } else if line.trim_end().contains('\t') {
            Self::Tab
        } else if line.contains(',') {
            Self::Comma
        } else {
            Self::Blanks
        }
    }

    fn fields(self, line: &str) -> Vec<&str> {
        let letter = match self {
            Self::Blanks => return line.split_whitespace().collect(),
            Self::Semicolon => ';',
            Self::Tab => '\t',
            Self::Comma => ',',
        };
        line.trim_end().split(letter).map(str::trim).collect()
    }

    fn number(self, field: &str) -> Option<f64> {
        let field = field.trim_matches('"');
        let number = match self {
            Self::Semicolon | Self::Tab if field.contains(',') => {
                field.replacen(',', ".", 1).parse::<f64>()
            }
            _ => field.parse::<f64>(),
        };
        number.ok().filter(|number| number.is_finite())
    }
}

impl<'a> Rows<'a> {
    fn new(machine: &'a Machine, form: &'a LogForm, name: &'a str) -> Self {
        Self {
            machine,
            form,
            name,
            line: 0,
            head: None,
            columns: None,
            times: Vec::new(),
            lines: Vec::new(),
            joints: [Vec::new(), Vec::new()],
            turns: 0,
        }
    }

    fn fault(&self, message: impl Into<String>, text: &str) -> Diagnostic {
        self.fault_at(self.line, message, text)
    }

    fn fault_at(&self, line: u64, message: impl Into<String>, text: &str) -> Diagnostic {
        let text = text.trim_end();
        let place = Place::new(self.name, line, text, 0..text.len());
        Diagnostic::error("log", message).at(Some(place))
    }

    fn take(&mut self, text: &str) -> Result<(), Box<Diagnostic>> {
        let text = text.trim_start_matches('\u{feff}');
        if text.trim().is_empty() {
            return Ok(());
        }
        if self.columns.is_none() && !self.begins(text)? {
            return Ok(());
        }
        let Some((separator, columns)) = &self.columns else {
            return Ok(());
        };
        let fields = separator.fields(text);
        let mut time = None;
        let mut both = [0, 1].map(|which| self.joints[which].last().copied().unwrap_or_default());
        let mut turned = 0;
        for (column, content) in &columns.contents {
            let Some(field) = fields.get(*column) else {
                let message = format!(
                    "the row has {} columns, {} are needed",
                    fields.len(),
                    column + 1
                );
                return Err(self.fault(message, text).boxed());
            };
            let Some(number) = separator.number(field) else {
                let message = format!("`{field}` in column {} is no number", column + 1);
                return Err(self.fault(message, text).boxed());
            };
            let (which, place) = match content {
                Content::Time => {
                    time = Some(number * columns.time_unit);
                    continue;
                }
                Content::Commanded(place) => (0, *place),
                Content::Actual(place) => (1, *place),
            };
            let axis = &self.machine.axes[place];
            let unit = match axis.joint.rotary {
                true => self.form.units.angle,
                false => self.form.units.length,
            };
            let mut value = number * unit - axis.zero;
            if axis.joint.rotary && !self.times.is_empty() {
                // No axis turns half round from row to row: its count has started again.
                let turns = libm::rint((both[which][place] - value) / TAU);
                value += turns * TAU;
                turned += u64::from(turns != 0.0);
            }
            both[which][place] = value;
        }
        let time = match (time, self.form.period) {
            (Some(time), _) => time,
            (None, Some(period)) => self.times.len() as f64 * period,
            (None, None) => {
                let message = "no column of the log holds the time";
                let help = "--columns with t=COLUMN, or --log-period SECONDS where rows lie at equal distances in time";
                return Err(Diagnostic::error("log-columns", message).help(help).boxed());
            }
        };
        if let Some(last) = self.times.last()
            && time <= *last
        {
            let message =
                format!("the time does not increase: {time} s behind {last} s in the row before");
            let help = "leave out rows that are told twice; a second recording is a log of its own";
            return Err(self.fault(message, text).help(help).boxed());
        }
        if self.times.len() == MOST_ROWS {
            let message = format!("the log has more than {MOST_ROWS} rows");
            let help = "take a part of it, or every second row";
            return Err(self.fault(message, text).help(help).boxed());
        }
        self.turns += turned;
        self.times.push(time);
        self.lines.push(self.line);
        for (joints, row) in self.joints.iter_mut().zip(both) {
            joints.push(row);
        }
        Ok(())
    }

    /// Whether the rows begin with this line; else it is of the head.
    fn begins(&mut self, text: &str) -> Result<bool, Box<Diagnostic>> {
        let comment = text.trim_start();
        let comment = comment
            .starts_with('#')
            .then(|| comment.trim_start_matches('#'));
        let separator = Separator::of(comment.unwrap_or(text));
        let fields = separator.fields(text);
        let numbers = fields
            .iter()
            .filter(|field| separator.number(field).is_some())
            .count();
        // Names may be numbers here and there, and rows may have remarks: most of a row are numbers.
        if comment.is_some() || 2 * numbers <= fields.len() {
            if self.line > MOST_HEAD {
                let message = format!("there is no row of numbers in the first {MOST_HEAD} lines");
                return Err(self.fault(message, text).boxed());
            }
            self.head = Some(comment.unwrap_or(text).to_owned());
            return Ok(false);
        }
        let names = self.head.as_deref().map(|head| {
            let names = Separator::of(head).fields(head);
            let names = names
                .into_iter()
                .map(|name| name.trim_matches('"').to_owned());
            names.collect::<Vec<String>>()
        });
        let columns = Columns::find(
            self.machine,
            self.form.columns.as_ref(),
            self.form.units,
            names.as_deref(),
            fields.len(),
        )
        .map_err(|fault| match fault.place {
            None => {
                let text = text.trim_end();
                fault
                    .at(Some(Place::new(self.name, self.line, text, 0..text.len())))
                    .boxed()
            }
            Some(_) => fault,
        })?;
        self.columns = Some((separator, columns));
        Ok(true)
    }

    fn finish(mut self) -> Result<Log, Box<Diagnostic>> {
        let rows = self.times.len();
        if rows < FEWEST_ROWS {
            let message = format!("the log has {rows} rows, at least {FEWEST_ROWS} are needed");
            return Err(self.fault(message, "").boxed());
        }
        let mut steps: Vec<f64> = self
            .times
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .collect();
        let (_, median, _) = steps.select_nth_unstable_by(rows / 2 - 1, f64::total_cmp);
        let median = *median;
        let gap = |pair: &[f64]| pair[1] - pair[0] > GAP * median;
        if let Some(place) = self.times.windows(2).position(gap) {
            let [from, to] = [self.times[place], self.times[place + 1]];
            let message = format!(
                "a gap in the log: {to} s behind {from} s in line {}, {:.0} times the usual {median} s",
                self.lines[place],
                (to - from) / median
            );
            let help = "what happened between is not known; take the part before it or behind it";
            return Err(self
                .fault_at(self.lines[place + 1], message, "")
                .help(help)
                .boxed());
        }
        // Rounded times make the median coarse; the mean of all is not.
        let whole = (self.times[rows - 1] - self.times[0]) / (rows - 1) as f64;
        let period = match (whole - median).abs() < 0.1 * median {
            true => whole,
            false => median,
        };
        let mut has = [[false; MAX_AXES]; 2];
        for (_, content) in self
            .columns
            .iter()
            .flat_map(|(_, columns)| &columns.contents)
        {
            match content {
                Content::Time => {}
                Content::Commanded(place) => has[0][*place] = true,
                Content::Actual(place) => has[1][*place] = true,
            }
        }
        let [commanded, actual] = [0, 1].map(|which| {
            let joints = std::mem::take(&mut self.joints[which]);
            if has[which].contains(&true) {
                Track::of_samples(&self.times, &joints, period)
            } else {
                Track::default()
            }
        });
        Ok(Log {
            name: self.name.to_owned(),
            rows,
            commanded,
            actual,
            has,
            turns: self.turns,
        })
    }
}
