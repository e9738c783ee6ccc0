//! A table of axis values at which a ball was found.

use std::ops::Range;

use nalgebra::Vector3;
use post_machine::calibrate::BallReading;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace, meant};
use post_machine::kinematics::{Joints, MAX_AXES};

use crate::files::table_cells::{cells, separator};

/// Readings that a table may have.
const MOST: usize = 100_000;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// The reading of an axis, by its place in the chain.
    Axis(usize),
    /// Which ball.
    Ball,
    /// Tool length, mm.
    Length,
    /// From the tip to the ball along X, Y or Z of the machine, mm.
    Off(usize),
}

/// Readings with the lines that they stand in.
#[derive(Clone, Debug, Default)]
pub struct BallTable {
    /// The readings.
    pub readings: Vec<BallReading>,
    /// Line of each.
    pub lines: Vec<u64>,
}

/// Reads a table with a row of heads; tools are `length` mm long where it has no column of lengths.
///
/// # Errors
/// By line: columns that nobody knows or that are not there, what is no number.
pub fn read(
    machine: &Machine,
    length: f64,
    name: &str,
    text: &str,
) -> Result<BallTable, Vec<Diagnostic>> {
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    });
    let Some((head_line, head)) = lines.next() else {
        let message = format!("{name} has no row");
        let help = "a row of heads (X, Y, Z, A, C as the axes are called), and a row a reading";
        return Err(vec![Diagnostic::error("calibrate", message).help(help)]);
    };
    let head = head.trim_start_matches('\u{feff}');
    let separator = separator(head);
    let at = |line: u64, text: &str, part: Range<usize>| SourcePlace::new(name, line, text, part);
    let columns = columns(machine, &cells(head, separator))
        .map_err(|fault| vec![fault.at(Some(at(head_line, head, 0..head.len())))])?;
    let mut table = BallTable::default();
    let mut balls: Vec<String> = Vec::new();
    let mut faults = Vec::new();
    for (line, text) in lines {
        match reading(machine, &columns, &cells(text, separator), &mut balls, length, separator) {
            Ok(reading) => {
                table.readings.push(reading);
                table.lines.push(line);
            }
            Err(message) => faults.push(Diagnostic::error("calibrate", message).at(Some(at(
                line,
                text,
                0..text.len(),
            )))),
        }
        if faults.len() == 10 || table.lines.len() > MOST {
            break;
        }
    }
    if table.lines.len() > MOST {
        faults
            .push(Diagnostic::error("calibrate", format!("{name} has more than {MOST} readings")));
    }
    if faults.is_empty() { Ok(table) } else { Err(faults) }
}

/// What the columns hold.
fn columns(machine: &Machine, heads: &[String]) -> Result<Vec<Column>, Box<Diagnostic>> {
    let fault =
        |message: String, help: String| Diagnostic::error("calibrate", message).help(help).boxed();
    let names = machine.axes.iter().map(|axis| axis.name.as_str());
    let known: Vec<&str> = names.clone().chain(["ball", "length", "dX", "dY", "dZ"]).collect();
    let mut columns = Vec::new();
    for head in heads {
        let column = match head.as_str() {
            "ball" => Column::Ball,
            "length" => Column::Length,
            "dX" => Column::Off(0),
            "dY" => Column::Off(1),
            "dZ" => Column::Off(2),
            head => match machine.axes.iter().position(|axis| axis.name == head) {
                Some(place) => Column::Axis(place),
                None => {
                    let help = meant(head, "columns are", &known);
                    return Err(fault(format!("no column is called {head:?}"), help));
                }
            },
        };
        if columns.contains(&column) {
            return Err(fault(format!("{head} stands there twice"), String::new()));
        }
        columns.push(column);
    }
    for (place, name) in names.enumerate() {
        if !columns.contains(&Column::Axis(place)) {
            let help = "every axis of the machine has a column: where it stood at each reading";
            return Err(fault(format!("there is no column {name}"), help.to_owned()));
        }
    }
    Ok(columns)
}

/// One row.
fn reading(
    machine: &Machine,
    columns: &[Column],
    cells: &[String],
    balls: &mut Vec<String>,
    length: f64,
    separator: char,
) -> Result<BallReading, String> {
    if cells.len() != columns.len() {
        return Err(format!("{} cells, and {} columns", cells.len(), columns.len()));
    }
    let mut joints: Joints = [0.0; MAX_AXES];
    let mut found = BallReading { ball: 0, joints, length, off: Vector3::zeros() };
    for (column, cell) in columns.iter().zip(cells) {
        if *column == Column::Ball {
            found.ball = balls.iter().position(|ball| ball == cell).unwrap_or_else(|| {
                balls.push(cell.clone());
                balls.len() - 1
            });
            continue;
        }
        let point = if separator == ',' { cell.clone() } else { cell.replace(',', ".") };
        let value = point.parse().ok().filter(|value: &f64| libm::fabs(*value) < 1e6);
        let value = value.ok_or_else(|| format!("{cell:?} is no number below a million"))?;
        match column {
            Column::Axis(place) => {
                let axis = &machine.axes[*place];
                joints[*place] = value * axis.unit() - axis.zero;
            }
            Column::Length => found.length = value,
            Column::Off(coordinate) => found.off[*coordinate] = value,
            Column::Ball => {}
        }
    }
    Ok(BallReading { joints, ..found })
}
