//! Tool offsets of a SINUMERIK as an archive or a program has them: `$TC_DP3[T,D]=value`, a line each.

use std::fmt::Write as _;

use post_machine::description::ToolData;

use super::reading::ToolReading;
use super::written::{TableUnits, plain_name};

pub(super) fn looks(text: &str) -> bool {
    text.contains("$TC_DP") || text.contains("$TC_TP2[")
}

/// `$TC_DP3[12,1]=120.5`, taken apart.
struct Assignment<'t> {
    /// `DP3`.
    name: &'t str,
    /// The tool.
    tool: &'t str,
    /// The cutting edge, D.
    edge: Option<&'t str>,
    value: &'t str,
}

/// The assignment to a tool's data in a line, if there is one; a fault where there is half of one.
fn assignment(text: &str) -> Option<Result<Assignment<'_>, ()>> {
    let (_, behind) = text.split_once("$TC_")?;
    let parts = || {
        let (name, behind) = behind.split_once('[')?;
        let (index, behind) = behind.split_once(']')?;
        let (_, value) = behind.split_once('=')?;
        let (tool, edge) = match index.split_once(',') {
            Some((tool, edge)) => (tool, Some(edge.trim())),
            None => (index, None),
        };
        let value = value.trim();
        // A remark stands behind `;`, which a name in quotes may hold.
        let value = match value.strip_prefix('"') {
            Some(name) => &name[..name.find('"')?],
            None => value.split(';').next()?.trim(),
        };
        Some(Assignment { name, tool: tool.trim(), edge, value })
    };
    Some(parts().ok_or(()))
}

pub(super) fn read(reading: &mut ToolReading<'_>) {
    let mut further: Option<u64> = None;
    for (line, text) in reading.lines() {
        if text.trim_start().starts_with(';') {
            continue;
        }
        let Some(found) = assignment(text) else { continue };
        let Ok(found) = found else {
            let help = "$TC_DP3[1,1]=120.5 is the length of the first edge of tool 1";
            reading.fault(line, "the assignment to a tool's data cannot be read".to_owned(), help);
            continue;
        };
        match found.edge {
            None | Some("1") => take(reading, line, &found),
            Some(_) if found.name.starts_with("DP") => further = further.or(Some(line)),
            Some(_) => {}
        }
    }
    if let Some(line) = further {
        let message = "cutting edges beyond the first are left out".to_owned();
        reading.warn(line, message, "programs call D1 of each tool");
    }
}

fn take(reading: &mut ToolReading<'_>, line: u64, found: &Assignment<'_>) {
    let unit = reading.unit;
    let known = ["TP2", "TP_MAX_VELO", "DP3", "DP4", "DP5", "DP6", "DP7", "DP12", "DP15", "DP21"];
    if !known.contains(&found.name) {
        return;
    }
    let Some(number) = reading.tool_number(line, found.tool) else { return };
    if found.name == "TP2" {
        if let Some(tool) = reading.gathered(number, line) {
            found.value.clone_into(&mut tool.name);
        }
        return;
    }
    let Some(value) = reading.number(line, found.name, found.value) else { return };
    let Some(tool) = reading.gathered(number, line) else {
        return;
    };
    let size = value * unit;
    match found.name {
        // The length is geometry and base, one of which may come first.
        "DP3" | "DP21" => tool.length = Some(tool.length.unwrap_or(0.0) + size),
        "DP12" => tool.length_wear = size,
        "DP6" => tool.radius = Some(size),
        "DP15" => tool.radius_wear = size,
        "DP7" => tool.corner_radius = Some(size),
        "TP_MAX_VELO" => tool.most_rpm = Some(value),
        _ if value != 0.0 => {
            let message = format!("tool {number} has a length 2 or 3, which is left out");
            reading.warn(line, message, "a tool that turns about its own axis has length 1 alone");
        }
        _ => {}
    }
}

/// Type of an end mill: what the control makes the mask of its data of.
const END_MILL: u32 = 120;

pub(super) fn write(tools: &[ToolData], units: TableUnits) -> String {
    let mut text = String::new();
    for tool in tools {
        let number = tool.number;
        if !tool.name.is_empty() {
            let _ = writeln!(text, "$TC_TP2[{number}]=\"{}\"", plain_name(&tool.name, "\""));
        }
        if let Some(most) = tool.most_rpm {
            let _ = writeln!(text, "$TC_TP_MAX_VELO[{number}]={most}");
        }
        let _ = writeln!(text, "$TC_DP1[{number},1]={END_MILL}");
        for (parameter, size) in [
            (3, tool.length.unwrap_or(0.0)),
            (6, tool.radius.unwrap_or(0.0)),
            (7, tool.corner_radius.unwrap_or(0.0)),
            (12, tool.length_wear),
            (15, tool.radius_wear),
        ] {
            let _ = writeln!(text, "$TC_DP{parameter}[{number},1]={}", units.length(size));
        }
    }
    text.push_str("M17\n");
    text
}
