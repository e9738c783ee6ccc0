//! `TOOL.T` of a TNC: columns below a line of heads, as wide as these stand apart.

use std::fmt::Write as _;

use post_machine::description::ToolData;

use super::reading::ToolReading;
use super::written::{TableUnits, plain_name};

/// Columns that are read, by their heads.
const NUMBERS: [&str; 7] = ["L", "R", "R2", "DL", "DR", "DR2", "NMAX"];

pub(super) fn looks(text: &str) -> bool {
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let mut words = first.split_whitespace();
    words.next() == Some("BEGIN") && words.next().is_some_and(|word| word.starts_with("TOOL"))
}

/// A column: its head, and where it stands in a line, in characters.
struct Column<'t> {
    head: &'t str,
    from: usize,
    to: usize,
}

pub(super) fn read(reading: &mut ToolReading<'_>) {
    let mut lines = reading.lines().filter(|(_, text)| !text.trim().is_empty());
    let Some(unit) = lines.next().and_then(|(line, text)| unit(reading, line, text)) else {
        return;
    };
    let Some((head_line, head)) = lines.next() else {
        reading.fault(1, "the table has no heads".to_owned(), "the second line is T NAME L R …");
        return;
    };
    let columns = columns(head);
    for needed in ["T", "L"] {
        if !columns.iter().any(|column| column.head == needed) {
            let message = format!("the table has no column {needed}");
            reading.fault(
                head_line,
                message,
                "the heads of a tool table are T NAME L R R2 DL DR …",
            );
            return;
        }
    }
    let mut last = head_line;
    for (line, text) in lines {
        if text.trim_start().starts_with("[END]") {
            return;
        }
        last = line;
        if let Some(tool) = tool(reading, (line, text), &columns, unit) {
            reading.tool(tool);
        }
    }
    let help = "was it cut off? Copy it from the control again";
    reading.fault(last, "the table ends without [END]".to_owned(), help);
}

/// mm a unit, as the first line says.
fn unit(reading: &mut ToolReading<'_>, line: u64, text: &str) -> Option<f64> {
    let mut words = text.split_whitespace();
    let unit = words.find_map(|word| match word {
        "MM" => Some(1.0),
        "INCH" => Some(25.4),
        _ => None,
    });
    if unit.is_none() || !looks(text) {
        let help = "the first line of a tool table is BEGIN TOOL .T MM, or INCH";
        reading.fault(line, "the table does not begin as one".to_owned(), help);
    }
    unit
}

fn columns(head: &str) -> Vec<Column<'_>> {
    let mut columns: Vec<Column<'_>> = Vec::new();
    let mut place = 0;
    for piece in head.split_inclusive(char::is_whitespace) {
        let word = piece.trim();
        if !word.is_empty() {
            if let Some(before) = columns.last_mut() {
                before.to = place;
            }
            columns.push(Column { head: word, from: place, to: usize::MAX });
        }
        place += piece.chars().count();
    }
    columns
}

/// What stands in a column of a line.
fn cell(text: &str, column: &Column<'_>) -> String {
    let letters = text.chars().skip(column.from).take(column.to - column.from);
    letters.collect::<String>().trim().to_owned()
}

fn tool(
    reading: &mut ToolReading<'_>,
    (line, text): (u64, &str),
    columns: &[Column<'_>],
    unit: f64,
) -> Option<ToolData> {
    let of = |head: &str| {
        let column = columns.iter().find(|column| column.head == head);
        column.map_or_else(String::new, |column| cell(text, column))
    };
    let number = of("T");
    if number.contains('.') {
        let message = format!("tool {number} is left out: a step of a tool");
        reading.warn(line, message, "programs call tools by whole numbers");
        return None;
    }
    let number = reading.tool_number(line, &number)?;
    let mut read = |head: &str| -> Option<f64> {
        match of(head).as_str() {
            "" | "-" => Some(0.0),
            text => reading.number(line, head, text),
        }
    };
    let mut values = [0.0; NUMBERS.len()];
    for (value, head) in values.iter_mut().zip(NUMBERS) {
        *value = read(head)?;
    }
    let [length, radius, corner, longer, wider, _, most] = values;
    Some(ToolData {
        number,
        name: of("NAME"),
        length: Some(length * unit),
        length_wear: longer * unit,
        radius: Some(radius * unit),
        radius_wear: wider * unit,
        corner_radius: Some(corner * unit),
        most_rpm: Some(most),
        line,
        ..ToolData::default()
    })
}

/// Letters of a name.
const NAME: usize = 32;

pub(super) fn write(tools: &[ToolData], units: TableUnits) -> String {
    let unit = if units.inch { "INCH" } else { "MM" };
    let mut text = format!("BEGIN TOOL .T {unit}\n");
    let _ = writeln!(
        text,
        "{:<8}{:<NAME$}  {:<12}{:<12}{:<12}{:<12}{:<12}{:<8}",
        "T", "NAME", "L", "R", "R2", "DL", "DR", "NMAX"
    );
    for tool in tools {
        let name: String = plain_name(&tool.name, "").chars().take(NAME).collect();
        let sizes = [
            tool.length.unwrap_or(0.0),
            tool.radius.unwrap_or(0.0),
            tool.corner_radius.unwrap_or(0.0),
            tool.length_wear,
            tool.radius_wear,
        ];
        let _ = write!(text, "{:<8}{name:<NAME$}  ", tool.number);
        for size in sizes {
            let _ = write!(text, "{:<12}", units.signed(size));
        }
        let most = tool.most_rpm.map_or_else(|| "-".to_owned(), |most| format!("{most:.0}"));
        let _ = writeln!(text, "{most:<8}");
    }
    text.push_str("[END]\n");
    text
}
