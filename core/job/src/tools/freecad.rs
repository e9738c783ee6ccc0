//! Tool libraries of FreeCAD: `.fctl` gives numbers to bits, each of which is a `.fctb` file beside it or in `Bit`.

use std::path::{Component, Path};

use post_machine::description::ToolData;
use serde_json::Value;

use super::reading::ToolReading;

pub(super) fn looks(text: &str) -> bool {
    text.trim_start().starts_with('{')
        && (text.contains("\"nr\"") && text.contains("\"tools\"")
            || text.contains("\"parameter\"") && text.contains("\"shape\""))
}

pub(super) fn read(reading: &mut ToolReading<'_>) {
    let library: Value = match serde_json::from_str(reading.text) {
        Ok(library) => library,
        Err(error) => {
            let message = format!("the library cannot be read: {error}");
            reading.fault(error.line() as u64, message, "a library of FreeCAD is JSON");
            return;
        }
    };
    let Some(tools) = library["tools"].as_array() else {
        let message = "a bit by itself has no number".to_owned();
        reading.fault(0, message, "name the library, which gives numbers to bits: NAME.fctl");
        return;
    };
    for (place, tool) in tools.iter().enumerate() {
        if let Some(tool) = listed(reading, place + 1, tool) {
            reading.tool(tool);
        }
    }
    if reading.taken() > 0 {
        let message = "the library has no lengths from the gauge point to the tip".to_owned();
        let help = "lengths are those of [tools], of --tool-length or of the CL file; `Length` there is that of the bit";
        reading.warn(0, message, help);
    }
}

/// A tool that the library lists as its `place`-th.
fn listed(reading: &mut ToolReading<'_>, place: usize, tool: &Value) -> Option<ToolData> {
    let number = tool["nr"].as_u64().and_then(|number| u32::try_from(number).ok());
    let (Some(number), Some(path)) = (number, tool["path"].as_str()) else {
        let message = format!("entry {place} of the library has no number or no path");
        reading.fault(0, message, "an entry is {\"nr\": 1, \"path\": \"5mm_Endmill.fctb\"}");
        return None;
    };
    let line = reading.text.find(path).map_or(0, |at| reading.line_at(at));
    let within = Path::new(path);
    let plain = within.components().all(|part| matches!(part, Component::Normal(_)));
    if !plain || within.extension().is_none_or(|ending| ending != "fctb") {
        let message = format!("tool {number}: {} is no bit of the library", reading.quoted(path));
        reading.fault(
            line,
            message,
            "a bit is a .fctb file in the folder of the library or in Bit",
        );
        return None;
    }
    let text = match reading.near.map(|near| near(within)) {
        Some(Ok(text)) => text,
        Some(Err(error)) => {
            let message =
                format!("tool {number}: {} cannot be read: {error}", reading.quoted(path));
            reading.fault(
                line,
                message,
                "the bits stand beside the library, or in the folder Bit beside its own",
            );
            return None;
        }
        None => return None,
    };
    let Ok(bit) = serde_json::from_str::<Value>(&text) else {
        let message = format!("tool {number}: {} is no bit", reading.quoted(path));
        reading.fault(line, message, "let FreeCAD write it again");
        return None;
    };
    let diameter = match &bit["parameter"]["Diameter"] {
        Value::Null => None,
        given => match quantity(given) {
            Some(diameter) => Some(diameter),
            None => {
                let message = format!("tool {number}: its diameter is no length");
                reading.fault(line, message, "a length of FreeCAD is \"5.0000 mm\"");
                return None;
            }
        },
    };
    Some(ToolData {
        number,
        name: bit["name"].as_str().unwrap_or_default().to_owned(),
        radius: diameter.map(|diameter| diameter / 2.0),
        line,
        ..ToolData::default()
    })
}

/// A length with its unit, mm; a bare number is in mm.
fn quantity(value: &Value) -> Option<f64> {
    let Some(text) = value.as_str() else { return value.as_f64() };
    let text = text.trim();
    let end = text.find(|sign: char| !"0123456789.,+-eE".contains(sign)).unwrap_or(text.len());
    let number: f64 = text[..end].trim().replace(',', ".").parse().ok()?;
    let unit = match text[end..].trim() {
        "" | "mm" => 1.0,
        "in" | "\"" => 25.4,
        "cm" => 10.0,
        "m" => 1000.0,
        _ => return None,
    };
    Some(number * unit)
}
