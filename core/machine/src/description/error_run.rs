//! The file of a measuring run, as its instrument writes it: lines about the run first, then a row of heads with the units of
//! the columns, then a row a place, up or down or both, once or several times.

use super::error_rows::{ErrorRows, RowFault, measured, parts};
use super::limits::MOST_ERROR_ROWS;
use super::{Axis, ErrorUnits};

/// Places that are no farther apart are one, mm or degrees.
const SAME: f64 = 1e-3;

/// A run begins anew at a place to which the axis came so many times as far as it goes on from there the other way.
const ANEW: f64 = 1.5;

/// Readings at one place that are farther apart are none of one machine, mm and mm/m.
const MOST_APART: f64 = 0.1;

/// What is wrong with such a file, and in which line.
pub(super) struct RunFault {
    pub line: u64,
    pub message: String,
    pub help: String,
}

/// A column: its name, and what its numbers are multiplied by where the head has a unit.
struct Column<'t> {
    name: &'t str,
    unit: Option<&'t str>,
}

/// A row, or the mean of several at one place: the place, then the errors.
struct Reading {
    line: u64,
    numbers: Vec<f64>,
}

/// The rows that came to a place from one side.
#[derive(Default)]
struct OneSide {
    sums: Vec<f64>,
    count: f64,
}

/// Lengths in mm of one of a unit, and turns in mm/m; the places of a rotary axis are degrees.
const LENGTHS: [(&str, f64); 5] =
    [("mm", 1.0), ("um", 1e-3), ("nm", 1e-6), ("m", 1e3), ("in", 25.4)];
const TURNS: [(&str, f64); 8] = [
    ("mm/m", 1.0),
    ("um/m", 1e-3),
    ("urad", 1e-3),
    ("mrad", 1.0),
    ("rad", 1e3),
    ("arcsec", ARCSEC),
    ("\"", ARCSEC),
    ("deg", 3600.0 * ARCSEC),
];
const ARCSEC: f64 = 1e3 * std::f64::consts::PI / (180.0 * 3600.0);
const ANGLES: [(&str, f64); 3] =
    [("deg", 1.0), ("rad", 180.0 / std::f64::consts::PI), ("arcsec", 1.0 / 3600.0)];

/// What the text of a run says of the errors of an axis; `units` are those of columns whose heads name none.
pub(super) fn read(text: &str, axis: &Axis, units: ErrorUnits) -> Result<ErrorRows, RunFault> {
    let lines = (1..).zip(text.trim_start_matches('\u{feff}').lines());
    let mut lines = lines
        .map(|(line, text)| (line, text.trim()))
        .filter(|(_, text)| !text.is_empty() && !text.starts_with('#'))
        .peekable();
    let first = lines.peek().copied();
    let is_head = |(_, text): &(u64, &str)| {
        let heads = cells(text, separator(text));
        heads.first().is_some_and(|head| column(head).name == axis.name) && heads.len() > 1
    };
    // Where no line is a row of heads, what is wrong is told of the first.
    let Some((head_line, head)) = lines.find(is_head).or(first) else {
        let fault = parts(&[], axis).err().map_or_else(String::new, |fault| fault.message);
        let message = match fault.is_empty() {
            true => format!("the errors of {} have no rows", axis.name),
            false => fault,
        };
        return Err(RunFault { line: 1, message, help: String::new() });
    };
    let separator = separator(head);
    let heads = cells(head, separator);
    let columns: Vec<Column> = heads.iter().map(|head| column(head)).collect();
    let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
    let of_head =
        |fault: RowFault| RunFault { line: head_line, message: fault.message, help: fault.help };
    let parts = parts(&names, axis).map_err(of_head)?;
    let factors = factors(&columns, &parts, axis, units).map_err(|message| RunFault {
        line: head_line,
        message,
        help: UNITS.to_owned(),
    })?;
    let mut readings = Vec::new();
    for (line, text) in lines.take(MOST_ERROR_ROWS) {
        readings.push(reading(line, text, separator, &factors)?);
    }
    let readings = one_a_place(readings, axis)?;
    let rows = readings.iter().map(|reading| reading.numbers.clone());
    measured(rows, &parts, axis, ErrorUnits::Mm).map_err(|fault| {
        let line = fault.row.and_then(|row| readings.get(row)).map_or(head_line, |row| row.line);
        RunFault { line, message: fault.message, help: fault.help }
    })
}

/// What helps where a unit is none.
const UNITS: &str = "lengths are in mm, µm, nm, m or in, turns in mm/m, µm/m, µrad, mrad, rad, arcsec or deg, behind the name: EXX [µm]";

/// What keeps cells apart: a semicolon or a tab if the heads have one, so that decimals may have commas; else a comma.
fn separator(head: &str) -> char {
    [';', '\t'].into_iter().find(|sign| head.contains(*sign)).unwrap_or(',')
}

fn cells(text: &str, separator: char) -> Vec<&str> {
    let mut cells: Vec<&str> =
        text.split(separator).map(|cell| cell.trim().trim_matches('"').trim()).collect();
    // Spreadsheets end lines so.
    while cells.len() > 1 && cells.last() == Some(&"") {
        cells.pop();
    }
    cells
}

/// Name and unit of a head: `EXX`, `EXX [µm]`, `EXX (arcsec)`, `EXX in um`, `EXX/µm`.
fn column(head: &str) -> Column<'_> {
    let end = head.find(|letter: char| !letter.is_ascii_alphanumeric()).unwrap_or(head.len());
    let (name, unit) = head.split_at(end);
    let unit = unit.trim().trim_start_matches('/').trim_start_matches("in ");
    let unit = unit.trim_matches(|sign: char| "[]() ".contains(sign));
    Column { name, unit: Some(unit).filter(|unit| !unit.is_empty()) }
}

/// The units that a column may have, each with what its numbers are multiplied by, and that of a column that names none.
struct KnownUnits {
    known: &'static [(&'static str, f64)],
    unsaid: f64,
}

/// What numbers of each column are multiplied by to be mm, mm/m, or degrees of a rotary axis.
fn factors(
    columns: &[Column<'_>],
    parts: &[usize],
    axis: &Axis,
    units: ErrorUnits,
) -> Result<Vec<f64>, String> {
    let own = if axis.joint.rotary { &ANGLES[..] } else { &LENGTHS[..] };
    let of_part = |part: &usize| {
        let known = if *part > 2 { &TURNS[..] } else { &LENGTHS[..] };
        KnownUnits { known, unsaid: units.in_mm() }
    };
    let own = KnownUnits { known: own, unsaid: 1.0 };
    let kinds = std::iter::once(own).chain(parts.iter().map(of_part));
    let factor = |(column, KnownUnits { known, unsaid }): (&Column<'_>, KnownUnits)| {
        let Some(unit) = column.unit else {
            return Ok(unsaid);
        };
        // Both letters that are read as micro, and the signs of angles.
        let plain = unit.replace(['µ', 'μ'], "u").replace('°', "deg").replace('″', "arcsec");
        let plain = if plain == "inch" { "in".to_owned() } else { plain };
        let found = known.iter().find(|(name, _)| *name == plain);
        // No text of the file is shown: a machine file may be a stranger's.
        let lack = || format!("what stands behind {} is no unit of it", column.name);
        found.map(|(_, factor)| *factor).ok_or_else(lack)
    };
    columns.iter().zip(kinds).map(factor).collect()
}

/// A row of numbers.
fn reading(line: u64, text: &str, separator: char, factors: &[f64]) -> Result<Reading, RunFault> {
    let fault = |message: String, help: &str| RunFault { line, message, help: help.to_owned() };
    let cells = cells(text, separator);
    let number = |cell: &&str| {
        let point = if separator == ',' { (*cell).to_owned() } else { cell.replace(',', ".") };
        point.parse().ok().filter(|number: &f64| number.is_finite())
    };
    let numbers: Option<Vec<f64>> = cells.iter().map(number).collect();
    let help = "numbers with commas between, or with semicolons or tabs where decimals have commas; a line a place";
    let numbers =
        numbers.ok_or_else(|| fault("this line does not consist of numbers".to_owned(), help))?;
    if numbers.len() != factors.len() {
        let message = format!("{} numbers, and there are {} columns", numbers.len(), factors.len());
        return Err(fault(message, "a number for each column"));
    }
    let numbers = numbers.iter().zip(factors).map(|(number, factor)| number * factor);
    Ok(Reading { line, numbers: numbers.collect() })
}

/// Readings in rising order of their places, one a place: where a run comes to places from both sides the mean of what is
/// found from either (ISO 230-2), and of several runs the mean.
fn one_a_place(readings: Vec<Reading>, axis: &Axis) -> Result<Vec<Reading>, RunFault> {
    let rises = rising(&readings);
    let both = rises.contains(&true) && rises.contains(&false);
    let mut places: Vec<(Reading, [OneSide; 2])> = Vec::new();
    let mut sided: Vec<(Reading, bool)> = readings.into_iter().zip(rises).collect();
    sided.sort_by(|(one, _), (other, _)| one.numbers[0].total_cmp(&other.numbers[0]));
    for (reading, rises) in sided {
        let new = places.last().is_none_or(|(last, _)| reading.numbers[0] - last.numbers[0] > SAME);
        let numbers = reading.numbers.clone();
        let first = places.last().filter(|_| !new).map(|(first, _)| &first.numbers);
        let apart = first.map_or(0.0, |first| {
            let errors = first.iter().zip(&numbers).skip(1);
            errors.map(|(one, other)| libm::fabs(one - other)).fold(0.0, f64::max)
        });
        if apart > MOST_APART {
            let (axis, place, line) = (&axis.name, numbers[0], reading.line);
            let message =
                format!("two readings of {axis} at {place} are {apart:.3} mm or mm/m apart");
            let help = "a place that is misspelt, or another unit".to_owned();
            return Err(RunFault { line, message, help });
        }
        if new {
            places.push((reading, Default::default()));
        }
        if let Some((_, sides)) = places.last_mut() {
            sides[usize::from(rises)].take(&numbers);
        }
    }
    let mean = |(reading, sides): (Reading, [OneSide; 2])| {
        let known = sides.iter().filter(|side| side.count > 0.0);
        let means: Vec<Vec<f64>> = known.map(OneSide::mean).collect();
        if both && means.len() == 1 {
            let message = format!(
                "the run comes to places of {} from both sides, and to {} from one alone",
                axis.name, reading.numbers[0]
            );
            let help = "rows of both sides for each place, or of one side for all: what the axis loses as it turns round would stand in one of them";
            return Err(RunFault { line: reading.line, message, help: help.to_owned() });
        }
        let count = means.len() as f64;
        let columns = 1..reading.numbers.len();
        let errors = columns.map(|at| means.iter().map(|mean| mean[at]).sum::<f64>() / count);
        let numbers = std::iter::once(reading.numbers[0]).chain(errors).collect();
        Ok(Reading { numbers, ..reading })
    };
    places.into_iter().map(mean).collect()
}

/// Whether the axis came up to each place, else down: by where it came from. By where it goes on to where it stands again, for
/// it turned round there, and where it came farther than it goes on the other way: there a run begins anew.
fn rising(readings: &[Reading]) -> Vec<bool> {
    let place = |at: usize| readings[at].numbers[0];
    let mut rises: Vec<bool> = Vec::with_capacity(readings.len());
    for at in 0..readings.len() {
        let mut ways = (at + 1..readings.len()).map(|next| place(next) - place(at));
        let goes_on = ways.find(|way| way.abs() > SAME);
        let came = at.checked_sub(1).map(|before| place(at) - place(before));
        let came = came.filter(|way| way.abs() > SAME);
        let way = match (came, goes_on) {
            (Some(came), Some(on)) if came * on < 0.0 && came.abs() > ANEW * on.abs() => Some(on),
            (came, on) => came.or(on),
        };
        let turned = rises.last().is_none_or(|rose| !rose);
        rises.push(way.map_or(turned, |way| way > 0.0));
    }
    rises
}

impl OneSide {
    fn take(&mut self, numbers: &[f64]) {
        self.sums.resize(numbers.len(), 0.0);
        self.sums.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
        self.count += 1.0;
    }

    fn mean(&self) -> Vec<f64> {
        self.sums.iter().map(|sum| sum / self.count).collect()
    }
}
