//! The JSON Schema of machine files, with the options of the plugins that are built in.

use post_machine::description;
use post_plugin::{Linked, OptionKind, OptionSpec, Value as Given};
use serde_json::{Map, Value, json};

/// The schema.
pub fn schema() -> Value {
    let mut schema = description::schema();
    for plugin in post_stock::plugins() {
        let table = match plugin.is_model() {
            true => "AccuracyFile",
            false => "ControlFile",
        };
        schema["definitions"][table]["properties"][plugin.name()] = options(plugin);
    }
    schema
}

/// The table of a plugin's options.
fn options(plugin: &Linked) -> Value {
    let keys = plugin.options().iter();
    let keys: Map<String, Value> = keys.map(|spec| (spec.key.to_owned(), option(spec))).collect();
    json!({
        "description": format!("The options of `{}`.", plugin.name()),
        "type": "object",
        "properties": keys,
        "additionalProperties": false,
    })
}

fn option(spec: &OptionSpec) -> Value {
    let mut option = match spec.kind {
        OptionKind::Flag => json!({ "type": "boolean" }),
        OptionKind::Integer { min, max } => {
            json!({ "type": "integer", "minimum": min, "maximum": max })
        }
        OptionKind::Number { min, max } => {
            json!({ "type": "number", "minimum": min, "maximum": max })
        }
        OptionKind::Text => json!({ "type": "string" }),
        OptionKind::Lines => json!({
            "type": ["string", "array"],
            "items": { "type": "string" },
        }),
        OptionKind::Choice(choices) => json!({ "enum": choices }),
    };
    option["description"] = json!(spec.help);
    option["default"] = match spec.default {
        Given::Flag(flag) => json!(flag),
        Given::Integer(integer) => json!(integer),
        Given::Number(number) => json!(number),
        Given::Text(text) => json!(text),
    };
    option
}
