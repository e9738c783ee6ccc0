//! The JSON Schema of machine files, for editors and validators.

use serde_json::{Map, Value, json};

use super::file::MachineFile;
use super::table::KeyType;

/// The schema of a machine file, made from the tables that read it.
///
/// Draft 7, which the editors' TOML extensions know. What spans several keys (a chain whose axes are described,
/// travel in order) is not in it: loading the file tells.
pub fn schema() -> Value {
    let mut definitions = Map::new();
    MachineFile::schema(&mut definitions);
    let mut schema = definitions.remove("MachineFile").unwrap_or_default();
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("Machine file of post");
    schema["definitions"] = Value::Object(definitions);
    for (name, whose) in [
        ("ControlFile", "The options of a dialect"),
        ("AccuracyFile", "The options of an error model"),
    ] {
        schema["definitions"][name]["additionalProperties"] = json!({
            "description": whose,
            "type": "object",
            "additionalProperties": {
                "type": ["boolean", "number", "string", "array"],
                "items": { "type": "string" },
            },
        });
    }
    let needed = take_required(&mut schema);
    add_head(&mut schema);
    schema["properties"]["extends"] = json!({
        "description": "Another machine, by name or file: this file says what differs.",
        "type": "string",
    });
    // A file that extends another may leave out whatever that one has.
    schema["if"] = json!({ "required": ["extends"] });
    schema["else"] = needed;
    schema
}

/// Takes what is required out of the schema: the file's own keys, and those of its tables. Returns it as a
/// schema that files which stand alone must meet.
fn take_required(schema: &mut Value) -> Value {
    let mut tables = Map::new();
    let Value::Object(root) = schema else {
        return json!({});
    };
    let names: Vec<(String, String)> = root["properties"]
        .as_object()
        .into_iter()
        .flatten()
        .filter_map(|(key, property)| Some((key.clone(), referred(property)?)))
        .collect();
    for (key, name) in names {
        let required = root["definitions"][&name]
            .as_object_mut()
            .and_then(|definition| definition.remove("required"));
        if let Some(required) = required {
            tables.insert(key, json!({ "required": required }));
        }
    }
    // Which kind an axis is can only be told where it is described.
    tables.insert(
        "axis".to_owned(),
        json!({
            "additionalProperties": {
                "oneOf": [{ "required": ["linear"] }, { "required": ["rotary"] }],
            },
        }),
    );
    json!({ "required": root.remove("required"), "properties": tables })
}

/// The definition that a property refers to.
fn referred(property: &Value) -> Option<String> {
    let reference = property.get("$ref").or_else(|| property.pointer("/allOf/0/$ref"))?;
    let name = reference.as_str()?.rsplit('/').next()?;
    Some(name.to_owned())
}

/// `[head.NAME]` holds any keys of the file, none of them required, and the word that swaps it in.
fn add_head(schema: &mut Value) {
    let mut properties = schema["properties"].clone();
    properties["word"] = json!({
        "description": "The line of the program that swaps the head in, letter for letter; without it the operator does.",
        "type": "string",
    });
    properties["offset"] = json!({
        "description": "The work offset that is measured with this head, from 1: 1 is G54, 2 is G55. Needed where a program of axis positions (tcp = \"post\") works with several heads.",
        "type": "integer",
        "minimum": 1,
        "maximum": 999,
    });
    schema["definitions"]["HeadFile"] = json!({
        "description": "What differs with another head.",
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    schema["properties"]["head"] = json!({
        "description": "Heads that HEAD/NAME in the CL file swaps in.",
        "type": "object",
        "additionalProperties": { "$ref": "#/definitions/HeadFile" },
    });
}
