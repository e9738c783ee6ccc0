//! Which column of a log holds what, and in which units: `--columns` and `--log-units`, else the names in its head.

use std::f64::consts::PI;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

/// How a log is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogUnits {
    /// A unit of time, s; none: as the column's name ends (`_ms`), else seconds.
    pub time: Option<f64>,
    /// A unit of length, mm.
    pub length: f64,
    /// A unit of angle, radians.
    pub angle: f64,
}

impl Default for LogUnits {
    fn default() -> Self {
        Self {
            time: None,
            length: 1.0,
            angle: PI / 180.0,
        }
    }
}

/// What a time column's name may end with.
const TIMES: [(&str, f64); 3] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6)];

/// `ms,um,deg`: any of them, in any order.
pub fn log_units(text: &str) -> Result<LogUnits, String> {
    let mut units = LogUnits::default();
    let mut told = [false; 3];
    for word in text.split(',').map(str::trim) {
        let time = TIMES.iter().find(|(name, _)| *name == word);
        let which = match (time, word) {
            (Some((_, seconds)), _) => {
                units.time = Some(*seconds);
                0
            }
            (None, "mm" | "um" | "m" | "inch") => {
                units.length = match word {
                    "mm" => 1.0,
                    "um" => 1e-3,
                    "m" => 1e3,
                    _ => 25.4,
                };
                1
            }
            (None, "deg" | "rad") => {
                units.angle = if word == "rad" { 1.0 } else { PI / 180.0 };
                2
            }
            _ => {
                return Err(format!(
                    "`{word}` is no unit of a log: s, ms, us; mm, um, m, inch; deg, rad"
                ));
            }
        };
        if std::mem::replace(&mut told[which], true) {
            return Err(format!("`{word}` is a second unit of its kind"));
        }
    }
    Ok(units)
}

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// The time.
    Time,
    /// Where an axis, by its place in the chain, was commanded.
    Commanded(usize),
    /// Where it was.
    Actual(usize),
}

/// `t=time,X=cmd_x,X'=act_x`: contents and the columns that hold them, by name or by number from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnNames(Vec<(String, String)>);

/// Reads `--columns`.
pub fn column_names(text: &str) -> Result<ColumnNames, String> {
    let mut names = Vec::new();
    for part in text.split(',') {
        let Some((content, column)) = part.split_once('=') else {
            return Err(format!(
                "`{}` is not of the form CONTENT=COLUMN",
                part.trim()
            ));
        };
        let [content, column] = [content, column].map(|text| text.trim().to_owned());
        if content.is_empty() || column.is_empty() {
            return Err(format!(
                "`{}` is not of the form CONTENT=COLUMN",
                part.trim()
            ));
        }
        names.push((content, column));
    }
    Ok(ColumnNames(names))
}

/// Which columns are read, and what the time column counts in.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Contents by column, counted from 0.
    pub contents: Vec<(usize, Content)>,
    /// A unit of the time column, s.
    pub time_unit: f64,
}

impl Columns {
    /// Of a log whose columns are called `head`, if it has names, and are `count` many.
    ///
    /// # Errors
    /// A column that is not there or told twice, a content that the machine does not have, and a log without an axis.
    pub fn find(
        machine: &Machine,
        names: Option<&ColumnNames>,
        units: LogUnits,
        head: Option<&[String]>,
        count: usize,
    ) -> Result<Self, Box<Diagnostic>> {
        let contents = match names {
            Some(names) => told(machine, names, head, count)?,
            None => match head {
                Some(head) => known(machine, head),
                None => {
                    let message = "the columns of the log have no names";
                    return Err(asks_for_columns(message.to_owned(), machine, None));
                }
            },
        };
        for (place, (_, content)) in contents.iter().enumerate() {
            if contents[..place].iter().any(|(_, other)| other == content) {
                let message = format!(
                    "two columns of the log hold {}",
                    spoken_content(machine, *content)
                );
                return Err(asks_for_columns(message, machine, head));
            }
        }
        if !contents
            .iter()
            .any(|(_, content)| *content != Content::Time)
        {
            let message = "no column of the log holds an axis of the machine";
            return Err(asks_for_columns(message.to_owned(), machine, head));
        }
        let time = contents
            .iter()
            .find(|(_, content)| *content == Content::Time);
        let by_name = time
            .and_then(|(column, _)| head?.get(*column))
            .and_then(|name| unit_of_time(name));
        Ok(Self {
            contents,
            time_unit: units.time.or(by_name).unwrap_or(1.0),
        })
    }
}

/// As the command line says.
fn told(
    machine: &Machine,
    names: &ColumnNames,
    head: Option<&[String]>,
    count: usize,
) -> Result<Vec<(usize, Content)>, Box<Diagnostic>> {
    let mut contents = Vec::new();
    for (what, column) in &names.0 {
        let Some(content) = content(machine, what) else {
            let message =
                format!("--columns: `{what}` is neither the time nor an axis of the machine");
            return Err(asks_for_columns(message, machine, head));
        };
        let named = head.and_then(|head| {
            head.iter()
                .position(|name| name.trim().eq_ignore_ascii_case(column))
        });
        let numbered = || {
            let number: usize = column.parse().ok()?;
            (1..=count).contains(&number).then(|| number - 1)
        };
        let Some(place) = named.or_else(numbered) else {
            let message = format!("--columns: the log has no column `{column}`");
            return Err(asks_for_columns(message, machine, head));
        };
        contents.push((place, content));
    }
    Ok(contents)
}

/// `t`, `X` for the commanded position of X, `X'` for the actual one.
fn content(machine: &Machine, what: &str) -> Option<Content> {
    if matches!(what, "t" | "time") {
        return Some(Content::Time);
    }
    let place = |name: &str| {
        let mut axes = machine.axes.iter();
        axes.position(|axis| axis.name.eq_ignore_ascii_case(name))
    };
    match what.strip_suffix('\'') {
        Some(name) => place(name).map(Content::Actual),
        None => place(what).map(Content::Commanded),
    }
}

/// Of the names in a log's head those that are known: `time`, `t_ms`, `X`, `x_cmd`, `commanded_X`, `X'`, `X_actual`. A
/// unit in brackets behind them is not read.
fn known(machine: &Machine, head: &[String]) -> Vec<(usize, Content)> {
    const COMMANDED: [&str; 5] = ["cmd", "command", "commanded", "set", "setpoint"];
    const ACTUAL: [&str; 4] = ["act", "actual", "fb", "feedback"];
    let mut contents = Vec::new();
    for (column, name) in head.iter().enumerate() {
        let name = bare(name);
        if unit_of_time(&name).is_some() || matches!(name.as_str(), "t" | "time" | "timestamp") {
            contents.push((column, Content::Time));
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
                Some(Content::Commanded(place)) if COMMANDED.contains(&which) => {
                    contents.push((column, Content::Commanded(place)));
                }
                Some(Content::Commanded(place)) if ACTUAL.contains(&which) => {
                    contents.push((column, Content::Actual(place)));
                }
                _ => {}
            }
        }
    }
    contents
}

/// In small letters, without what stands in brackets.
fn bare(name: &str) -> String {
    let name = name.split(['[', '(']).next().unwrap_or_default();
    name.trim().to_ascii_lowercase()
}

/// Of `t_ms`, `time_s`: what the name says that it counts in, s.
fn unit_of_time(name: &str) -> Option<f64> {
    let name = bare(name);
    let (time, unit) = name.split_once('_')?;
    let unit = TIMES.iter().find(|(known, _)| *known == unit);
    matches!(time, "t" | "time")
        .then(|| unit.map(|(_, seconds)| *seconds))
        .flatten()
}

fn spoken_content(machine: &Machine, content: Content) -> String {
    match content {
        Content::Time => "the time".to_owned(),
        Content::Commanded(place) => format!("where {} is commanded", machine.axes[place].name),
        Content::Actual(place) => format!("where {} is", machine.axes[place].name),
    }
}

fn asks_for_columns(
    message: String,
    machine: &Machine,
    head: Option<&[String]>,
) -> Box<Diagnostic> {
    let axis = machine.axes.first().map_or("X", |axis| axis.name.as_str());
    let mut help = format!(
        "--columns \"t=COLUMN,{axis}=COLUMN,{axis}'=COLUMN\": time, {axis} commanded and {axis} actual, by name or by number from 1"
    );
    if let Some(head) = head {
        help.push_str("; the log has ");
        let names: Vec<&str> = head.iter().map(|name| name.trim()).take(40).collect();
        help.push_str(&names.join(", "));
    }
    Diagnostic::error("log-columns", message).help(help).boxed()
}
