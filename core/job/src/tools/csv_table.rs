//! A table with a row of heads, as presetters and spreadsheets write it: cells apart by `,`, `;` or tabs.

use std::fmt::Write as _;

use post_machine::description::ToolData;

use super::reading::ToolReading;
use super::written::TableUnits;
use crate::files::table_cells::{cells, separator};

/// What a column may hold.
const COLUMNS: [&str; 12] = [
    "number",
    "name",
    "length",
    "length_wear",
    "radius",
    "diameter",
    "radius_wear",
    "corner_radius",
    "stick_out",
    "holder",
    "most_rpm",
    "pocket",
];

/// Columns of lengths, in the units of the table.
const LENGTHS: [&str; 7] =
    ["length", "length_wear", "radius", "diameter", "radius_wear", "corner_radius", "stick_out"];

/// A column that is read.
struct Column {
    what: &'static str,
    place: usize,
}

/// The columns of a line of heads; none with a fault where one that is needed is not there.
fn columns(reading: &mut ToolReading<'_>, line: u64, heads: &[String]) -> Option<Vec<Column>> {
    let map = reading.columns;
    if let Some(strange) = map.keys().find(|what| !COLUMNS.contains(&what.as_str())) {
        let message = format!("[tools] columns has {strange}, which no column holds");
        reading.fault(0, message, &format!("columns hold {}", COLUMNS.join(", ")));
        return None;
    }
    let mut columns = Vec::new();
    for what in COLUMNS {
        let told = map.get(what);
        let head = told.map_or(what, String::as_str);
        match heads.iter().position(|own| own.eq_ignore_ascii_case(head)) {
            Some(place) => columns.push(Column { what, place }),
            None if told.is_some() || what == "number" => {
                let message = format!("the table has no column {head}, which holds the {what}");
                let help = match reading.quoted("") == "``" {
                    true => {
                        format!("its heads are {}; [tools] columns names them", heads.join(", "))
                    }
                    false => "[tools] columns names the heads of the table".to_owned(),
                };
                reading.fault(line, message, &help);
                return None;
            }
            None => {}
        }
    }
    Some(columns)
}

pub(super) fn read(reading: &mut ToolReading<'_>) {
    let mut lines = reading.lines().filter(|(_, text)| !text.trim().is_empty());
    let Some((line, head)) = lines.next() else { return };
    let separator = separator(head);
    let heads = cells(head, separator);
    let Some(columns) = columns(reading, line, &heads) else { return };
    for (line, text) in lines {
        let cells = cells(text, separator);
        if cells.len() > heads.len() || text.matches('"').count() % 2 == 1 {
            let message =
                format!("the line has {} cells, the heads are {}", cells.len(), heads.len());
            let help = "a cell that holds what keeps cells apart stands in quotes";
            reading.fault(line, message, help);
            continue;
        }
        if let Some(tool) = tool(reading, line, (&cells, &columns), separator != ',') {
            reading.tool(tool);
        }
    }
}

/// The tool of a line; `comma` says that numbers may have a decimal comma.
fn tool(
    reading: &mut ToolReading<'_>,
    line: u64,
    (cells, columns): (&[String], &[Column]),
    comma: bool,
) -> Option<ToolData> {
    let mut tool = ToolData { line, ..ToolData::default() };
    for Column { what, place } in columns {
        let cell = cells.get(*place).map_or("", String::as_str);
        if cell.is_empty() {
            if *what == "number" {
                return None;
            }
            continue;
        }
        match *what {
            "name" => cell.clone_into(&mut tool.name),
            "holder" => cell.clone_into(&mut tool.holder),
            "number" => {
                let digits = cell.strip_prefix(['T', 't']).unwrap_or(cell);
                tool.number = reading.tool_number(line, digits)?;
            }
            "pocket" => tool.pocket = Some(reading.tool_number(line, cell)?),
            what => {
                let text = if comma { cell.replace(',', ".") } else { cell.to_owned() };
                let unit = if LENGTHS.contains(&what) { reading.unit } else { 1.0 };
                let value = reading.number(line, what, &text)? * unit;
                size(&mut tool, what, value);
            }
        }
    }
    Some(tool)
}

/// Puts a number into a tool.
fn size(tool: &mut ToolData, what: &str, value: f64) {
    match what {
        "length" => tool.length = Some(value),
        "length_wear" => tool.length_wear = value,
        "radius" => tool.radius = Some(value),
        "diameter" => tool.radius = Some(value / 2.0),
        "radius_wear" => tool.radius_wear = value,
        "corner_radius" => tool.corner_radius = Some(value),
        "stick_out" => tool.stick_out = Some(value),
        _ => tool.most_rpm = Some(value),
    }
}

/// A cell as the table has it.
fn cell(text: &str) -> String {
    match text.contains([',', '"', ';', '\t']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

pub(super) fn write(tools: &[ToolData], units: TableUnits) -> String {
    let written = COLUMNS.iter().filter(|what| **what != "diameter").copied();
    let heads: Vec<&str> = written.collect();
    let mut text = format!("{}\n", heads.join(","));
    for tool in tools {
        let size = |size: Option<f64>| size.map_or_else(String::new, |size| units.length(size));
        let most = tool.most_rpm.map_or_else(String::new, |most| most.to_string());
        let pocket = tool.pocket.map_or_else(String::new, |pocket| pocket.to_string());
        let row = [
            tool.number.to_string(),
            cell(&tool.name),
            size(tool.length),
            units.length(tool.length_wear),
            size(tool.radius),
            units.length(tool.radius_wear),
            size(tool.corner_radius),
            size(tool.stick_out),
            cell(&tool.holder),
            most,
            pocket,
        ];
        let _ = writeln!(text, "{}", row.join(","));
    }
    text
}
