//! The rows of a log as they are read, line by line.

use std::f64::consts::TAU;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::kinematics::{Joints, MAX_AXES};
use post_motion::measured::AxisTrack;

use super::clock::Clock;
use super::columns::{Columns, LogColumn, LogContent, LogHead};
use super::log::{Log, LogForm};
use super::table::{Separator, decimals};
use super::units;

/// Rows of a log: about 136 bytes are kept of each. 1 ms over a quarter of an hour, 15 ms over four hours.
const MOST_ROWS: usize = 1_000_000;

/// Lines before the first row of numbers.
const MOST_HEAD: u64 = 100;

/// Rows that are needed.
const FEWEST_ROWS: usize = 8;

/// A line of the head.
struct HeadLine {
    line: u64,
    text: String,
    names: Vec<String>,
}

/// How the rows look.
struct LogRowForm {
    separator: Separator,
    columns: Columns,
    /// Columns of the first row, and its line.
    count: usize,
    first: u64,
}

/// A log that is being read.
pub(super) struct LogReader<'a> {
    machine: &'a Machine,
    asked: &'a LogForm,
    name: &'a str,
    /// The line that is read.
    pub line: u64,
    /// The last two lines before the first row: names, or names and units.
    head: Vec<HeadLine>,
    form: Option<LogRowForm>,
    times: Vec<f64>,
    /// Most digits behind the decimal sign of a time; none if there is an exponent.
    decimals: Option<i32>,
    /// Lines of the rows.
    lines: Vec<u64>,
    /// Commanded and actual.
    joints: [Vec<Joints>; 2],
    turns: u64,
}

impl<'a> LogReader<'a> {
    pub fn new(machine: &'a Machine, asked: &'a LogForm, name: &'a str) -> Self {
        Self {
            machine,
            asked,
            name,
            line: 0,
            head: Vec::new(),
            form: None,
            times: Vec::new(),
            decimals: Some(0),
            lines: Vec::new(),
            joints: [Vec::new(), Vec::new()],
            turns: 0,
        }
    }

    /// What is wrong with the line that is read.
    pub fn fault(&self, message: impl Into<String>, text: &str) -> Diagnostic {
        self.fault_at(self.line, message, text)
    }

    fn fault_at(&self, line: u64, message: impl Into<String>, text: &str) -> Diagnostic {
        let text = text.trim_end();
        let place = SourcePlace::new(self.name, line, text, 0..text.len());
        Diagnostic::error("log", message).at(Some(place))
    }

    /// The same, with one field of the line underlined.
    fn field_fault(&self, message: String, text: &str, field: &str) -> Diagnostic {
        let text = text.trim_end();
        let start = (field.as_ptr() as usize).wrapping_sub(text.as_ptr() as usize);
        let span = match start.checked_add(field.len()) {
            Some(end) if end <= text.len() => start..end,
            _ => 0..text.len(),
        };
        let place = SourcePlace::new(self.name, self.line, text, span);
        Diagnostic::error("log", message).at(Some(place))
    }

    /// Takes the next line.
    ///
    /// # Errors
    /// It is no row of the log.
    pub fn take(&mut self, text: &str) -> Result<(), Box<Diagnostic>> {
        let text = text.trim_start_matches('\u{feff}');
        if text.trim().is_empty() {
            return Ok(());
        }
        if self.form.is_none() && !self.begins(text)? {
            return Ok(());
        }
        let Some(form) = &self.form else {
            return Ok(());
        };
        let fields = form.separator.fields(text);
        if fields.len() != form.count {
            let message = format!(
                "the row has {} columns, the first row (line {}) has {}",
                fields.len(),
                form.first,
                form.count
            );
            let help = "every row of a log has the same columns; was it written to its end?";
            return Err(self.fault(message, text).help(help).boxed());
        }
        let mut time = None;
        let mut both = [0, 1].map(|which| self.joints[which].last().copied().unwrap_or_default());
        let mut turned = 0;
        let mut behind = self.decimals;
        for column in &form.columns.read {
            let field = fields[column.place];
            let number = self.number(form.separator, column, field, text)?;
            let (which, place) = match column.content {
                LogContent::Time => {
                    time = Some(number);
                    behind = decimals(field).and_then(|digits| Some(digits.max(behind?)));
                    continue;
                }
                LogContent::Commanded(place) => (0, place),
                LogContent::Actual(place) => (1, place),
            };
            let axis = &self.machine.axes[place];
            let mut value = number - axis.zero;
            if axis.joint.rotary && !self.times.is_empty() {
                // No axis turns half round from row to row: its count has started again.
                let turns = libm::rint((both[which][place] - value) / TAU);
                value += turns * TAU;
                turned += u64::from(turns != 0.0);
            }
            both[which][place] = value;
        }
        let period = self.asked.period.unwrap_or_default();
        let time = time.unwrap_or(self.times.len() as f64 * period);
        if let Some(last) = self.times.last()
            && time <= *last
        {
            let message =
                format!("the time does not increase: {time} s behind {last} s in the row before");
            let help = "leave out rows that are told twice, and put a second recording into a file of its own; times that are too coarse can be left out with --log-period";
            return Err(self.fault(message, text).help(help).boxed());
        }
        if self.times.len() == MOST_ROWS {
            let message = format!("the log has more than {MOST_ROWS} rows");
            let help = "take a part of it, or every second row";
            return Err(self.fault(message, text).help(help).boxed());
        }
        if self.times.is_empty() {
            self.first_turns(&mut both);
        }
        self.turns += turned;
        self.decimals = behind;
        self.times.push(time);
        self.lines.push(self.line);
        for (joints, row) in self.joints.iter_mut().zip(both) {
            joints.push(row);
        }
        Ok(())
    }

    /// A number of a column, in s, mm or radians.
    fn number(
        &self,
        separator: Separator,
        column: &LogColumn,
        field: &str,
        text: &str,
    ) -> Result<f64, Box<Diagnostic>> {
        let holds = column.content.spoken(self.machine);
        let place = column.place + 1;
        let message = match separator.number(field) {
            Some(number) if number.is_finite() => return Ok(number * column.unit.size),
            Some(_) => format!("`{field}` in column {place} ({holds}) is no finite number"),
            None if field.is_empty() => format!("column {place} ({holds}) is empty"),
            None => format!("`{field}` in column {place} ({holds}) is no number"),
        };
        let help = "what the log does not know cannot be compared: leave such rows out, or name other columns with --columns";
        Err(self.field_fault(message, text, field).help(help).boxed())
    }

    /// Commanded and actual position of an axis that turns without end begin on the same turn.
    fn first_turns(&self, [commanded, actual]: &mut [Joints; 2]) {
        let has = self.has();
        for (place, axis) in self.machine.axes.iter().enumerate() {
            if axis.joint.rotary && has[0][place] && has[1][place] {
                actual[place] += TAU * libm::rint((commanded[place] - actual[place]) / TAU);
            }
        }
    }

    /// Axes whose commanded position is read, and whose actual one.
    fn has(&self) -> [[bool; MAX_AXES]; 2] {
        let mut has = [[false; MAX_AXES]; 2];
        for column in self.form.iter().flat_map(|form| &form.columns.read) {
            match column.content {
                LogContent::Time => {}
                LogContent::Commanded(place) => has[0][place] = true,
                LogContent::Actual(place) => has[1][place] = true,
            }
        }
        has
    }

    /// Whether the rows begin with this line; else it is of the head.
    fn begins(&mut self, text: &str) -> Result<bool, Box<Diagnostic>> {
        let line = text.trim();
        let comment = line.starts_with('#').then(|| line.trim_start_matches('#').trim());
        let separator = Separator::of(comment.unwrap_or(line));
        let fields = separator.fields(text);
        if comment.is_some() || !separator.is_row(&fields) {
            if self.line > MOST_HEAD {
                let message = format!("there is no row of numbers in the first {MOST_HEAD} lines");
                let help = "a log is a table: a line of names, then rows of numbers";
                return Err(self.fault(message, text).help(help).boxed());
            }
            let names = separator.fields(comment.unwrap_or(line));
            if self.head.len() == 2 {
                self.head.remove(0);
            }
            self.head.push(HeadLine {
                line: self.line,
                text: line.to_owned(),
                names: names.into_iter().map(str::to_owned).collect(),
            });
            return Ok(false);
        }
        let count = fields.len();
        let columns = self.columns(count, text)?;
        self.form = Some(LogRowForm { separator, columns, count, first: self.line });
        Ok(true)
    }

    /// The columns of rows of so many; `text` is the first of them.
    fn columns(&self, count: usize, text: &str) -> Result<Columns, Box<Diagnostic>> {
        let is_unit = |name: &String| {
            matches!(name.trim(), "" | "-") || units::named(name.trim_matches(['[', ']'])).is_some()
        };
        let (names, below) = match &self.head[..] {
            [names, units] if units.names.len() == count && units.names.iter().all(is_unit) => {
                (Some(names), Some(units))
            }
            [.., names] => (Some(names), None),
            [] => (None, None),
        };
        let named = names.filter(|names| names.names.len() == count);
        let bare: Vec<String> = below
            .map(|units| units.names.iter())
            .into_iter()
            .flatten()
            .map(|unit| unit.trim_matches(['[', ']', '-']).to_owned())
            .collect();
        let head = LogHead { names: named.map_or(&[], |names| &names.names), units: &bare, count };
        let asked = self.asked;
        let even = asked.period.is_some();
        let found = Columns::find(self.machine, asked.columns.as_ref(), asked.units, head, even);
        found.map_err(|mut fault| {
            let (line, shown) = match (names, named) {
                (Some(names), None) => {
                    fault.message += &format!(
                        "; line {} names {} columns, the rows have {count}",
                        names.line,
                        names.names.len()
                    );
                    (names.line, names.text.as_str())
                }
                (_, Some(names)) => (names.line, names.text.as_str()),
                (None, None) => (self.line, text.trim_end()),
            };
            let place = SourcePlace::new(self.name, line, shown, 0..shown.len());
            fault.at(Some(place)).boxed()
        })
    }

    /// The log, at even distances in time.
    ///
    /// # Errors
    /// There are too few rows, or a gap.
    pub fn finish(mut self) -> Result<Log, Box<Diagnostic>> {
        let rows = self.times.len();
        let has = self.has();
        let Some(form) = self.form.take().filter(|_| rows >= FEWEST_ROWS) else {
            let message = match rows {
                0 => "the log is empty: there is no row of numbers".to_owned(),
                _ => format!("the log has {rows} rows, at least {FEWEST_ROWS} are needed"),
            };
            let help = "a log is a table: a line of names, then rows of numbers";
            return Err(self.fault(message, "").help(help).boxed());
        };
        let unit = |column: &&LogColumn| column.content == LogContent::Time;
        let time_unit = form.columns.read.iter().find(unit).map_or(1.0, |column| column.unit.size);
        let resolution =
            self.decimals.map_or(0.0, |digits| libm::exp10(-f64::from(digits)) * time_unit);
        let clock = Clock::of(&mut self.times, resolution).map_err(|gap| {
            let [from, to] = [self.times[gap.row - 1], self.times[gap.row]];
            let message = format!(
                "a gap in the log: {to} s behind {from} s in line {}, {:.0} times the usual {} s",
                self.lines[gap.row - 1],
                (to - from) / gap.usual,
                crate::text::number(gap.usual, 6)
            );
            let place = SourcePlace::new(self.name, self.lines[gap.row], "", 0..0);
            let help = "what happened between is not known; take the part before it or behind it";
            let fault = Diagnostic::error("log", message).at(Some(place));
            fault.help(help).boxed()
        })?;
        let [commanded, actual] = [0, 1].map(|which| {
            let joints = std::mem::take(&mut self.joints[which]);
            match has[which].contains(&true) {
                true => AxisTrack::of_samples(&self.times, &joints, clock.period),
                false => AxisTrack::default(),
            }
        });
        Ok(Log {
            name: self.name.to_owned(),
            rows,
            clock,
            columns: form.columns,
            commanded,
            actual,
            has,
            turns: self.turns,
        })
    }
}
