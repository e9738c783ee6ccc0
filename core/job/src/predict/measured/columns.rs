//! Which column of a log holds what, and in which unit: `--columns` and `--log-units`, else the names in its head.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use super::units::{self, LogUnits, QuantityKind, Unit};

/// So many columns are told by name.
const MOST_TOLD: usize = 40;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogContent {
    /// The time.
    Time,
    /// Where an axis, by its place in the chain, was commanded.
    Commanded(usize),
    /// Where it was.
    Actual(usize),
}

impl LogContent {
    /// What its unit is of.
    fn kind(self, machine: &Machine) -> QuantityKind {
        match self {
            Self::Time => QuantityKind::Time,
            Self::Commanded(place) | Self::Actual(place) => {
                match machine.axes[place].joint.rotary {
                    true => QuantityKind::Angle,
                    false => QuantityKind::Length,
                }
            }
        }
    }

    /// As messages name it.
    pub fn spoken(self, machine: &Machine) -> String {
        match self {
            Self::Time => "time".to_owned(),
            Self::Commanded(place) => format!("{} commanded", machine.axes[place].name),
            Self::Actual(place) => format!("{} actual", machine.axes[place].name),
        }
    }
}

/// `t=time,X=cmd_x,X'=act_x`: contents and the columns that hold them, by name or by number from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnNames(Vec<(String, String)>);

/// Reads `--columns`.
pub fn column_names(text: &str) -> Result<ColumnNames, String> {
    let mut names = Vec::new();
    for part in text.split(',') {
        let told = part.split_once('=');
        let told = told.map(|(content, column)| (content.trim(), column.trim()));
        match told {
            Some((content, column)) if !content.is_empty() && !column.is_empty() => {
                names.push((content.to_owned(), column.to_owned()));
            }
            _ => {
                return Err(format!("`{}` is not of the form CONTENT=COLUMN", part.trim()));
            }
        }
    }
    Ok(ColumnNames(names))
}

/// A column that is read.
#[derive(Clone, Debug, PartialEq)]
pub struct LogColumn {
    /// Its place, counted from 0.
    pub place: usize,
    /// Its name in the head, else its number from 1.
    pub name: String,
    /// What it holds.
    pub content: LogContent,
    /// What it counts in.
    pub unit: Unit,
}

/// The columns of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Those that are read.
    pub read: Vec<LogColumn>,
    /// Names of those that are not, where they have names.
    pub unread: Vec<String>,
}

/// What is known of a log's columns.
#[derive(Clone, Copy, Debug)]
pub struct LogHead<'a> {
    /// Their names, as many as there are columns; empty if they have none.
    pub names: &'a [String],
    /// A row of units below the names; empty if there is none.
    pub units: &'a [String],
    /// How many there are.
    pub count: usize,
}

impl LogHead<'_> {
    fn name(&self, place: usize) -> String {
        let number = || (place + 1).to_string();
        self.names.get(place).cloned().unwrap_or_else(number)
    }
}

impl Columns {
    /// Of a log with such a head. With `even` rows have no times.
    ///
    /// # Errors
    /// A column that is not there or told twice, a content that the machine does not have, a unit that is none of its
    /// content, and a log without an axis or without a time.
    pub fn find(
        machine: &Machine,
        names: Option<&ColumnNames>,
        units: LogUnits,
        head: LogHead<'_>,
        even: bool,
    ) -> Result<Self, Box<Diagnostic>> {
        let asks = |message: String| asks_for_columns(message, machine, head);
        let mut contents = match names {
            Some(names) => told(machine, names, head)?,
            None if head.names.is_empty() => {
                return Err(asks("the columns of the log have no names".to_owned()));
            }
            None => known(machine, head.names),
        };
        if even {
            if names.is_some() && contents.iter().any(|(_, content)| *content == LogContent::Time) {
                let message = "--columns names the time, and --log-period says that rows lie at even distances in time";
                let help = "keep one of both";
                return Err(Diagnostic::error("log-columns", message).help(help).boxed());
            }
            contents.retain(|(_, content)| *content != LogContent::Time);
        }
        for (index, (place, content)) in contents.iter().enumerate() {
            let mut others = contents[..index].iter();
            if let Some((other, _)) = others.find(|(_, other)| other == content) {
                return Err(asks(format!(
                    "two columns of the log, {} and {}, hold {}",
                    head.name(*other),
                    head.name(*place),
                    content.spoken(machine)
                )));
            }
        }
        let is_time = |(_, content): &(usize, LogContent)| *content == LogContent::Time;
        if contents.iter().all(is_time) {
            return Err(asks(
                "no column of the log is known to hold an axis of the machine".to_owned(),
            ));
        }
        if !even && !contents.iter().any(is_time) {
            let message = "no column of the log is known to hold the time";
            let mut asks = asks(message.to_owned());
            let help = asks.help.unwrap_or_default();
            asks.help = Some(format!(
                "--log-period SECONDS where rows lie at even distances in time, or {help}"
            ));
            return Err(asks);
        }
        let read = contents.iter().map(|(place, content)| {
            Ok(LogColumn {
                place: *place,
                name: head.name(*place),
                content: *content,
                unit: unit(machine, *content, *place, units, head)?,
            })
        });
        let read: Vec<LogColumn> = read.collect::<Result<_, Box<Diagnostic>>>()?;
        let names = head.names.iter().enumerate();
        let unread = names.filter(|(place, _)| read.iter().all(|column| column.place != *place));
        Ok(Self { unread: unread.map(|(_, name)| name.clone()).collect(), read })
    }
}

/// As the command line says.
fn told(
    machine: &Machine,
    names: &ColumnNames,
    head: LogHead<'_>,
) -> Result<Vec<(usize, LogContent)>, Box<Diagnostic>> {
    let mut contents = Vec::new();
    for (what, column) in &names.0 {
        let Some(content) = content(machine, what) else {
            let axes: Vec<&str> = machine.axes.iter().map(|axis| axis.name.as_str()).collect();
            let message = format!(
                "--columns: `{what}` is neither the time nor an axis of the machine, which has {}",
                axes.join(", ")
            );
            return Err(asks_for_columns(message, machine, head));
        };
        let called = |name: &String| {
            let names = [name.trim(), split_unit(name).0];
            names.iter().any(|name| name.eq_ignore_ascii_case(column))
        };
        let named = head.names.iter().position(called);
        let last = head.names.iter().rposition(called);
        if let (Some(first), Some(last)) = (named, last)
            && first != last
        {
            let message = format!(
                "--columns: columns {} and {} are both called {column}; name it by its number",
                first + 1,
                last + 1
            );
            return Err(asks_for_columns(message, machine, head));
        }
        let numbered = || {
            let number: usize = column.parse().ok()?;
            (1..=head.count).contains(&number).then(|| number - 1)
        };
        let Some(place) = named.or_else(numbered) else {
            let message =
                format!("--columns: the log has no column `{column}`; it has {}", head.count);
            return Err(asks_for_columns(message, machine, head));
        };
        contents.push((place, content));
    }
    Ok(contents)
}

/// `t`, `X` for the commanded position of X, `X'` for the actual one.
fn content(machine: &Machine, what: &str) -> Option<LogContent> {
    if matches!(what, "t" | "time") {
        return Some(LogContent::Time);
    }
    let place = |name: &str| {
        let mut axes = machine.axes.iter();
        axes.position(|axis| axis.name.eq_ignore_ascii_case(name))
    };
    match what.strip_suffix('\'') {
        Some(name) => place(name).map(LogContent::Actual),
        None => place(what).map(LogContent::Commanded),
    }
}

/// Of the names in a log's head those that are known: `time`, `t_ms`, `X`, `x_cmd`, `commanded_X`, `X'`, `X_actual`, with
/// or without a unit in brackets behind them.
fn known(machine: &Machine, names: &[String]) -> Vec<(usize, LogContent)> {
    const COMMANDED: [&str; 5] = ["cmd", "command", "commanded", "set", "setpoint"];
    const ACTUAL: [&str; 4] = ["act", "actual", "fb", "feedback"];
    let mut contents = Vec::new();
    for (column, name) in names.iter().enumerate() {
        let (name, _) = split_unit(name);
        let name = name.to_ascii_lowercase();
        if matches!(name.as_str(), "t" | "time" | "timestamp") || unit_of_time(&name).is_some() {
            contents.push((column, LogContent::Time));
            continue;
        }
        if let Some(content) = content(machine, &name) {
            contents.push((column, content));
            continue;
        }
        let parts: Vec<&str> = name.split(['_', ' ', '.']).collect();
        let [one, other] = parts[..] else {
            continue;
        };
        for (axis, which) in [(one, other), (other, one)] {
            match content(machine, axis) {
                Some(LogContent::Commanded(place)) if COMMANDED.contains(&which) => {
                    contents.push((column, LogContent::Commanded(place)));
                }
                Some(LogContent::Commanded(place)) if ACTUAL.contains(&which) => {
                    contents.push((column, LogContent::Actual(place)));
                }
                _ => {}
            }
        }
    }
    contents
}

/// A name, and what stands in brackets behind it.
fn split_unit(name: &str) -> (&str, Option<&str>) {
    match name.split_once(['[', '(']) {
        Some((name, unit)) => (name.trim(), Some(unit.trim_end_matches([']', ')', ' ']))),
        None => (name.trim(), None),
    }
}

/// Of `t_ms`, `time_s`: what the name says that it counts in.
fn unit_of_time(name: &str) -> Option<Unit> {
    let (time, unit) = name.split_once('_')?;
    let unit = units::named(unit).filter(|unit| unit.kind == QuantityKind::Time);
    unit.filter(|_| matches!(time, "t" | "time"))
}

/// What a column counts in: as the command line says, else as the head does.
fn unit(
    machine: &Machine,
    content: LogContent,
    place: usize,
    units: LogUnits,
    head: LogHead<'_>,
) -> Result<Unit, Box<Diagnostic>> {
    let kind = content.kind(machine);
    if let Some(unit) = units.of(kind) {
        return Ok(unit);
    }
    let name = head.names.get(place).map_or("", String::as_str);
    let (bare, bracketed) = split_unit(name);
    let below = head.units.get(place).map(String::as_str);
    let said = bracketed.or(below).filter(|unit| !unit.is_empty());
    let Some(said) = said else {
        let of_name = unit_of_time(&bare.to_ascii_lowercase()).filter(|unit| unit.kind == kind);
        return Ok(of_name.unwrap_or(kind.usual()));
    };
    let known = units::named(said).filter(|unit| unit.kind == kind);
    known.ok_or_else(|| {
        let message = format!(
            "column {name} holds {}, and `{said}` is not {}",
            content.spoken(machine),
            kind.spoken()
        );
        let help = "--log-units says what the log counts in, such as --log-units ms,um,rad";
        Diagnostic::error("log-columns", message).help(help).boxed()
    })
}

fn asks_for_columns(message: String, machine: &Machine, head: LogHead<'_>) -> Box<Diagnostic> {
    let axis = machine.axes.first().map_or("X", |axis| axis.name.as_str());
    let mut help = format!(
        "--columns \"t=COLUMN,{axis}=COLUMN,{axis}'=COLUMN\": time, {axis} commanded and {axis} actual, by name or by number from 1"
    );
    if !head.names.is_empty() {
        help.push_str("; the log has ");
        let names: Vec<&str> = head.names.iter().map(|name| name.trim()).collect();
        help.push_str(&names[..names.len().min(MOST_TOLD)].join(", "));
        if names.len() > MOST_TOLD {
            help.push_str(", …");
        }
    }
    Diagnostic::error("log-columns", message).help(help).boxed()
}
