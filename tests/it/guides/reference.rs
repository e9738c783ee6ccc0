//! Pages that say what the command says: its help, the keys of machine files, words, dialects and codes of messages.
//! `UPDATE_GUIDE=1` writes them.

use std::fmt::Write as _;
use std::fs;

use serde_json::Value;

use super::help;
use super::page::{is, updating, write};
use crate::common::post;

/// What a run prints; it must end well.
fn printed(arguments: &[&str]) -> String {
    let run = post(arguments);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{arguments:?}");
    run.out
}

/// A text as the cell of a table: what stands between backticks stays as it is, elsewhere nothing is a tag.
fn cell(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let parts = text.split('`').enumerate();
    let parts: Vec<String> = parts
        .map(|(index, part)| match index % 2 {
            0 => part.replace('<', "&lt;"),
            _ => part.to_owned(),
        })
        .collect();
    parts.join("`").replace('|', "\\|")
}

/// A cell in letters of equal width.
fn code(text: &str) -> String {
    let text = text.replace('|', "\\|");
    match text.contains('`') {
        true => format!("`` {text} ``"),
        false => format!("`{text}`"),
    }
}

#[test]
fn the_page_of_commands_is_their_help() {
    let verbs = help::check("commands.md", "Commands and options");
    assert!(verbs > 15, "{verbs}");
}

#[test]
fn the_page_of_words_is_the_table_of_words() {
    let table = printed(&["words"]);
    let mut text = String::from(
        "# Words of CL files\n\nWhat `post words` prints: spellings joined by `=` mean the same. [CL files](../nc-programmer/cl-files.md#words) says what *used*, *passed on*, *ignored*, *refused* and *unknown* come to.\n\n| word | becomes | meaning |\n|---|---|---|\n",
    );
    let rows: Vec<&str> = table.lines().skip(1).collect();
    assert!(rows.len() > 100);
    for row in rows {
        let (spellings, rest) = row.split_at(32);
        let (becomes, meaning) = rest.split_at(11);
        let spellings: Vec<String> = spellings.trim().split(" = ").map(code).collect();
        let _ = writeln!(
            text,
            "| {} | {} | {} |",
            spellings.join(" = "),
            becomes.trim(),
            cell(meaning)
        );
    }
    is("words.md", "`post words`", &text);
}

#[test]
fn the_page_of_dialects_is_what_plugins_declare() {
    let list = printed(&["plugin", "list"]);
    let names = list.lines().filter(|row| row.contains("built in"));
    let names: Vec<&str> = names.filter_map(|row| row.split(' ').next()).collect();
    assert!(names.len() > 10, "{list}");
    let mut text = String::from(
        "# Dialects and error models\n\nWhat is built in, by `post plugin show`: options of a dialect stand in `[control.NAME]` of the machine file, those of an error model in `[accuracy.NAME]`.\n",
    );
    for name in names {
        let shown = printed(&["plugin", "show", name]);
        let mut lines = shown.lines().peekable();
        let title = lines.next().unwrap();
        let _ = write!(text, "\n## {name}\n\n{}.", cell(title));
        let mut in_table = false;
        while let Some(line) = lines.next() {
            let option = line.strip_prefix("  ").and_then(|row| row.split_once(" = "));
            match option {
                Some((key, rest)) if in_table => {
                    let (default, takes) = rest.split_once("    # ").unwrap();
                    let help = lines.next().unwrap();
                    let _ = writeln!(
                        text,
                        "| {} | {} | {} | {} |",
                        code(key),
                        code(default),
                        cell(takes),
                        cell(help)
                    );
                }
                _ if line.starts_with("Options, ") => {
                    in_table = true;
                    let table = line.trim_start_matches("Options, ").trim_end_matches(':');
                    let _ = write!(
                        text,
                        "\n\nOptions, `{table}`:\n\n| option | default | takes | what it does |\n|---|---|---|---|\n"
                    );
                }
                _ if line.starts_with("Beyond straight moves") => {
                    in_table = false;
                    let _ = write!(text, "\n{line}\n\n| | |\n|---|---|\n");
                    for row in lines.by_ref().take_while(|row| !row.is_empty()) {
                        let (name, what) = row.trim().split_once(' ').unwrap();
                        let _ = writeln!(text, "| `{name}` | {} |", cell(what));
                    }
                }
                _ if line.starts_with("Its programs rely on") => {
                    let _ = write!(text, "\n{line}\n\n");
                    for row in lines.by_ref().take_while(|row| !row.is_empty()) {
                        let _ = writeln!(text, "- {}", cell(row.trim()));
                    }
                }
                _ if line.is_empty() => in_table = false,
                _ => {
                    let _ = write!(text, "\n{}\n", cell(line));
                }
            }
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    is("dialects.md", "`post plugin show`", &text);
}

/// `post explain`, of which every code is a heading, so that links lead to it.
#[test]
fn the_page_of_messages_is_what_post_explains() {
    let told = printed(&["explain"]);
    let mut text = String::from(
        "# Messages\n\nA message begins with `error[CODE]` or `warning[CODE]`. An error means that no program was written, and the last line says so; a warning that the user should know. `post explain CODE` prints the same in a terminal. The message itself has file, line, value and limit; here is what its code stands for. A code that two parts of the work say is in both tables.\n",
    );
    let mut codes = 0;
    let mut lines = told.lines().filter(|line| !line.is_empty()).peekable();
    while let Some(line) = lines.next() {
        if let Some((title, verbs)) = line.split_once(" (") {
            let verbs = verbs.trim_end_matches(')');
            let _ = write!(
                text,
                "\n## {title}\n\nSaid by {verbs}.\n\n| code | what it means | what helps |\n|---|---|---|\n"
            );
            continue;
        }
        let meaning = lines.next().unwrap().trim();
        let remedy = lines.next().unwrap().trim();
        let remedy = remedy.strip_prefix("What helps: ").unwrap();
        let _ = writeln!(text, "| `{line}` | {meaning} | {remedy} |");
        codes += 1;
    }
    assert!(codes > 150, "{codes}");
    is("messages.md", "`post explain`", &text);
}

/// What a key takes, in words.
fn takes(schema: &Value, all: &Value) -> String {
    let below = |value: &Value| takes(resolved(value, all), all);
    if let Some(choices) = schema["oneOf"].as_array() {
        return choices.iter().map(below).collect::<Vec<_>>().join(", ");
    }
    if let Some(choices) = schema["anyOf"].as_array() {
        return choices.iter().map(below).collect::<Vec<_>>().join(", or ");
    }
    if let Some(values) = schema["enum"].as_array() {
        let values = values.iter().map(|value| code(&value.to_string()));
        return values.collect::<Vec<_>>().join(", ");
    }
    if !schema["const"].is_null() {
        return code(&schema["const"].to_string());
    }
    let kinds: Vec<&str> = match &schema["type"] {
        Value::String(kind) => vec![kind],
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).collect(),
        _ => Vec::new(),
    };
    let bound = |key: &str| schema[key].as_f64();
    let range = match (bound("minimum"), bound("maximum"), bound("exclusiveMinimum")) {
        (Some(least), Some(most), _) => format!(", {least} to {most}"),
        (Some(least), None, _) => format!(", from {least}"),
        (_, Some(most), Some(above)) => format!(", above {above}, to {most}"),
        (_, None, Some(above)) => format!(", above {above}"),
        (None, Some(most), None) => format!(", up to {most}"),
        (None, None, None) => String::new(),
    };
    let counted = |what: &str| match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
        (Some(least), Some(most)) if least == most => format!("{least} {what}s"),
        _ => format!("a list of {what}s"),
    };
    let told: Vec<String> = kinds
        .iter()
        .map(|kind| match *kind {
            "number" if kinds.contains(&"string") => format!("number or expression{range}"),
            "number" => format!("number{range}"),
            "integer" => format!("whole number{range}"),
            "boolean" => "`true`, `false`".to_owned(),
            "string" if kinds.contains(&"number") => String::new(),
            "string" => "text".to_owned(),
            "array" => match resolved(&schema["items"], all)["type"] {
                Value::Array(_) => counted("number"),
                Value::String(ref kind) if kind == "string" => counted("text"),
                _ => counted("entrie"),
            },
            _ => match &schema["additionalProperties"] {
                Value::Object(_) => "a table by names".to_owned(),
                _ => "a table".to_owned(),
            },
        })
        .filter(|told| !told.is_empty())
        .collect();
    told.join(", or ")
}

/// A schema with what it refers to.
fn resolved<'a>(schema: &'a Value, all: &'a Value) -> &'a Value {
    let schema = schema["allOf"].get(0).unwrap_or(schema);
    match schema["$ref"].as_str() {
        Some(path) => all.pointer(path.trim_start_matches('#')).unwrap(),
        None => schema,
    }
}

/// A table of the machine file, then those in it.
fn table(name: &str, what: &str, schema: &Value, all: &Value, text: &mut String) {
    let keys = schema["properties"].as_object().unwrap();
    let _ = write!(
        text,
        "\n## {}\n\n{}\n\n| key | takes | what it says |\n|---|---|---|\n",
        match name.starts_with('[') {
            true => code(name),
            false => name.to_owned(),
        },
        cell(what)
    );
    let mut below = Vec::new();
    for (key, given) in keys {
        let schema = resolved(given, all);
        let what = [given, schema].map(|from| from["description"].as_str());
        let what = what.into_iter().flatten().next().unwrap_or_default();
        // Those of plugins have a page of their own.
        if what.starts_with("The options of `") {
            continue;
        }
        let inner = |path: String| {
            if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
        };
        let path = name.trim_matches(['[', ']']);
        let path =
            inner(if path == "The top of the file" { String::new() } else { path.to_owned() });
        let mut value = takes(schema, all);
        if schema["properties"].is_object() {
            let name = format!("[{path}]");
            value = format!("the table {}", code(&name));
            below.push((name, what.to_owned(), schema));
        } else if schema["additionalProperties"].is_object() {
            let each = resolved(&schema["additionalProperties"], all);
            let name = format!("[{path}.NAME]");
            if each["properties"].is_object() {
                value = format!("the tables {}", code(&name));
                below.push((name, what.to_owned(), each));
            }
        }
        let mut says = cell(what);
        let choices = schema["oneOf"].as_array();
        for choice in choices.into_iter().flatten() {
            if let (Some(name), Some(what)) =
                (choice["const"].as_str(), choice["description"].as_str())
            {
                let _ = write!(says, " {}: {}", code(name), cell(what));
            }
        }
        let _ = writeln!(text, "| {} | {value} | {says} |", code(key));
    }
    for (name, what, schema) in below {
        // A head has the tables of the machine.
        if name == "[head.NAME]" {
            let keys = schema["properties"].as_object().unwrap();
            let keys: Vec<String> = keys.keys().map(|key| code(key)).collect();
            let _ = write!(
                text,
                "\n## `[head.NAME]`\n\n{} What differs from the machine stands in its tables: {}.\n",
                cell(&what),
                keys.join(", ")
            );
            continue;
        }
        table(&name, &what, schema, all, text);
    }
}

#[test]
fn the_page_of_keys_is_the_schema() {
    let schema: Value = serde_json::from_str(&printed(&["schema"])).unwrap();
    let mut text = String::from(
        "# Keys of the machine file\n\nWhat `post schema` says, table by table; options of dialects and error models are on [their page](dialects.md). [Every key](../machine-builder/keys.md) tells more of how they go together. A number may be an expression of `[parameters]` where it says so.\n",
    );
    table(
        "The top of the file",
        schema["description"].as_str().unwrap(),
        &schema,
        &schema,
        &mut text,
    );
    is("machine-keys.md", "`post schema`", &text);
}

/// The table in the Python package's manual of `Blocks`.
#[test]
fn the_arrays_that_python_names_are_those_of_blocks() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/python/post/made.py");
    let manual = fs::read_to_string(path).unwrap();
    let rule = format!("    {} {}\n", "=".repeat(23), "=".repeat(89));
    let mut table = rule.clone();
    for (name, doc) in post_job::library::block_arrays() {
        assert!(doc.chars().count() <= 89, "{name}: {doc}");
        let _ = writeln!(table, "    {:<23} {doc}", format!("``{name}``"));
    }
    let mut parts = manual.split(rule.as_str());
    let (Some(before), Some(_), Some(after)) = (parts.next(), parts.next(), parts.next()) else {
        panic!("no table in {path}");
    };
    let text = format!("{before}{table}{rule}{after}");
    if updating() {
        write(path.as_ref(), &text);
    }
    let there = fs::read_to_string(path).unwrap();
    assert!(
        there == text,
        "{path} is stale: run UPDATE_GUIDE=1 cargo test -p nc-post --test it guides"
    );
}
