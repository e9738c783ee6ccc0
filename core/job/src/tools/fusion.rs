//! Tool libraries of Fusion and HSM as JSON: `data` has the tools, each in the units that it names.

use post_machine::description::ToolData;
use serde::Deserialize;
use serde_json::Value;
use serde_json::value::RawValue;

use super::reading::ToolReading;

/// The library; its tools as they stand in the text, so that they have lines.
#[derive(Deserialize)]
struct Library<'t> {
    #[serde(borrow)]
    data: Vec<&'t RawValue>,
}

pub(super) fn looks(text: &str) -> bool {
    text.trim_start().starts_with('{') && text.contains("\"data\"") && text.contains("\"geometry\"")
}

pub(super) fn read(reading: &mut ToolReading<'_>) {
    let text = reading.text;
    let library: Library<'_> = match serde_json::from_str(text) {
        Ok(library) => library,
        Err(error) => {
            let message = format!("the library cannot be read: {error}");
            let help = "export it from the tool library of Fusion or HSM as JSON";
            reading.fault(error.line() as u64, message, help);
            return;
        }
    };
    let (mut line, mut counted) = (1, 0);
    for tool in library.data {
        // They stand in the text in their order: lines are counted once.
        let place = tool.get().as_ptr().addr() - text.as_ptr().addr();
        line +=
            text.as_bytes()[counted..place].iter().filter(|byte| **byte == b'\n').count() as u64;
        counted = place;
        let Ok(value) = serde_json::from_str::<Value>(tool.get()) else { continue };
        if value["type"] == "holder" || !value["geometry"].is_object() {
            continue;
        }
        if let Some(tool) = tool_of(reading, line, &value) {
            reading.tool(tool);
        }
    }
}

/// mm a unit of what says its `unit`.
fn unit(value: &Value) -> Option<f64> {
    match value["unit"].as_str()? {
        "millimeters" => Some(1.0),
        "inches" => Some(25.4),
        _ => None,
    }
}

fn tool_of(reading: &mut ToolReading<'_>, line: u64, value: &Value) -> Option<ToolData> {
    let Some(unit) = unit(value) else {
        let message = "the tool does not say whether it is in millimeters or inches".to_owned();
        reading.fault(line, message, "export the library again: each tool has its \"unit\"");
        return None;
    };
    let number =
        value["post-process"]["number"].as_u64().and_then(|number| u32::try_from(number).ok());
    let Some(number) = number else {
        let message = "the tool has no number".to_owned();
        reading.fault(line, message, "give it one in the tool library (post processor, number)");
        return None;
    };
    let size = |key: &str| value["geometry"][key].as_f64().map(|size| size * unit);
    let text = |of: &Value| of.as_str().unwrap_or_default().to_owned();
    let radius = size("DC").map(|diameter| diameter / 2.0);
    let is_ball = value["type"].as_str().is_some_and(|kind| kind.contains("ball"));
    let holder = &value["holder"];
    Some(ToolData {
        number,
        name: text(&value["description"]),
        length: gauge_length(holder, &size, unit),
        radius,
        corner_radius: if is_ball { radius } else { size("RE") },
        stick_out: size("LB"),
        holder: text(&holder["description"]),
        line,
        ..ToolData::default()
    })
}

/// From the gauge line to the tip. Without a holder the library has another length in its place.
fn gauge_length(holder: &Value, size: &impl Fn(&str) -> Option<f64>, of_tool: f64) -> Option<f64> {
    if !holder.is_object() {
        return None;
    }
    let of_holder = || {
        let length = holder["gaugeLength"].as_f64()?;
        Some(length * unit(holder).unwrap_or(of_tool) + size("LB")?)
    };
    size("assemblyGaugeLength").or_else(of_holder)
}
