//! The JSON Schema of job files, from the table of settings.

use serde_json::{Map, Value, json};

use super::JobKeys;
use super::job_keys::BESIDE;
use crate::settings::{About, SettingForm};

/// The keys that are lists of tables.
const TABLES: [&str; 2] = ["program", "channel"];

/// The schema.
pub fn schema() -> Value {
    let mut keys: Map<String, Value> = JobKeys::about()
        .filter(|about| !["plugins", "then"].contains(&about.name))
        .map(|about| (about.name.to_owned(), setting(about)))
        .collect();
    for (name, doc) in BESIDE {
        keys.insert(name.to_owned(), json!({ "description": doc, "type": "string" }));
    }
    keys.insert("cl".to_owned(), several(&keys["cl"]));
    keys.retain(|name, _| !TABLES.contains(&name.as_str()));
    let program = json!({
        "type": "object",
        "properties": keys.clone(),
        "additionalProperties": false,
    });
    for (name, doc) in BESIDE.iter().filter(|(name, _)| TABLES.contains(name)) {
        let programs =
            json!({ "description": doc, "type": "array", "items": program, "minItems": 1 });
        keys.insert((*name).to_owned(), programs);
    }
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Job file of post",
        "type": "object",
        "properties": keys,
        "additionalProperties": false,
    })
}

/// One of a kind, or a list of them.
fn several(kind: &Value) -> Value {
    let mut kind = kind.clone();
    let doc = kind.as_object_mut().and_then(|kind| kind.remove("description"));
    let mut schema = json!({ "anyOf": [kind, { "type": "array", "items": kind }] });
    if let Some(doc) = doc {
        schema["description"] = doc;
    }
    schema
}

fn setting(about: &About) -> Value {
    let kind = match about.form {
        SettingForm::Flag => json!({ "type": "boolean" }),
        SettingForm::Words(words) => json!({ "enum": words() }),
        SettingForm::Whole { least, most } => {
            json!({ "type": "integer", "minimum": least, "maximum": most })
        }
        SettingForm::Path => json!({ "type": "string" }),
        SettingForm::PathIfAny => json!({ "type": ["boolean", "string"] }),
        SettingForm::Text if about.name == "set" => json!({ "type": "object" }),
        SettingForm::Text => json!({ "type": ["number", "string", "array"] }),
    };
    let mut schema = match about.many && about.name != "set" {
        true => several(&kind),
        false => kind,
    };
    schema["description"] = json!(about.text());
    schema
}
