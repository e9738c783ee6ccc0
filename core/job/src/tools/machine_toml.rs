//! `[tools]` of a machine file: lengths by number, mm.

use std::fmt::Write as _;

use post_machine::description::ToolData;

use super::reading::ToolReading;
use super::written::{TableUnits, plain_name};

pub(super) fn looks(text: &str) -> bool {
    text.lines().any(|line| line.trim() == "[tools]")
}

/// The lines between `[tools]` and the next table: expressions and all else are the machine's own business.
pub(super) fn read(reading: &mut ToolReading<'_>) {
    let mut inside = false;
    for (line, text) in reading.lines() {
        let (told, remark) = text.split_once('#').unwrap_or((text, ""));
        let told = told.trim();
        if told.starts_with('[') {
            inside = told == "[tools]";
            continue;
        }
        let Some((number, length)) = told.split_once('=').filter(|_| inside) else { continue };
        let Ok(number) = number.trim().parse::<u32>() else { continue };
        if let Some(length) = reading.number(line, "the length", length) {
            let name = remark.trim().to_owned();
            reading.tool(ToolData {
                number,
                name,
                length: Some(length),
                line,
                ..ToolData::default()
            });
        }
    }
}

/// In mm whatever the units: a machine file has no others.
pub(super) fn write(tools: &[ToolData], _: TableUnits) -> String {
    let mut text = "[tools]\n".to_owned();
    for tool in tools {
        let Some(length) = tool.total_length() else { continue };
        let name = plain_name(&tool.name, "");
        let name = if name.is_empty() { name } else { format!(" # {name}") };
        let _ = writeln!(text, "{} = {}{name}", tool.number, TableUnits::default().length(length));
    }
    text
}
