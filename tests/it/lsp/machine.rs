//! Machine files.

use std::fs;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::client::{Client, labels, place, told, uri};
use crate::common::{assert_contains, root};

/// `machines/ac-trunnion.toml`, in a folder of its own.
fn trunnion() -> (TempDir, String, String) {
    let text = fs::read_to_string(root().join("machines/ac-trunnion.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    fs::write(&path, &text).unwrap();
    let uri = uri(&path);
    (folder, uri, text)
}

fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

#[test]
fn all_independent_faults_are_told_at_once_and_go_as_they_are_put_right() {
    let (_folder, uri, good) = trunnion();
    let mut bad = with(&good, "max_feed  = 5400", "max_fed   = 5400");
    bad = with(&bad, "travel    = [-120, 30]", "travel    = [30, -120]");
    bad = with(&bad, "gauge = [0, 0, 400]", "gauge = [0, 0, \"Zd + 1\"]");
    let mut client = Client::new(&[], &json!({}));
    client.open(&uri, "toml", &bad);
    let found = client.findings(&uri, 1);
    let mut places = told(&found);
    places.sort();
    let (key, _) = place(&bad, "max_fed ", 0);
    let (travel, _) = place(&bad, "[30, -120]", 0);
    let (gauge, _) = place(&bad, "\"Zd + 1\"", 0);
    assert_eq!(
        places,
        [
            format!("machine-expression {gauge}:15-23"),
            format!("machine-key {key}:0-7"),
            format!("machine-travel {travel}:12-22"),
        ],
        "{found:#?}"
    );
    // The click that puts each right, in turn.
    let whole = json!({
        "textDocument": { "uri": uri },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 9999, "character": 0 } },
        "context": { "diagnostics": [] },
    });
    let mut version = 1;
    let mut titles = Vec::new();
    loop {
        let actions = client.ask("textDocument/codeAction", whole.clone());
        let Some(action) = actions["result"].as_array().unwrap().first().cloned() else {
            break;
        };
        titles.push(action["title"].as_str().unwrap().to_owned());
        let edit = &action["edit"]["changes"][&uri][0];
        let at = |end: &str, part: &str| edit["range"][end][part].as_u64().unwrap() as usize;
        version += 1;
        client.edit(
            &uri,
            version,
            [
                at("start", "line"),
                at("start", "character"),
                at("end", "line"),
                at("end", "character"),
            ],
            edit["newText"].as_str().unwrap(),
        );
        assert!(version < 10, "{titles:?}");
    }
    titles.sort();
    assert_eq!(titles, ["Turn it round: [-120, 30]", "Write `Zc`", "Write `max_feed`"]);
    assert_eq!(client.findings(&uri, version), Vec::<Value>::new());
    assert_eq!(client.end().0, 0);
}

#[test]
fn an_axis_that_is_missing_is_put_in() {
    let (_folder, uri, good) = trunnion();
    let bad = with(&good, "Y X Z (S) t]", "Y X Z W (S) t]");
    let mut client = Client::new(&[], &json!({}));
    client.open(&uri, "toml", &bad);
    let found = client.findings(&uri, 1);
    assert_contains(&found[0]["message"].to_string(), &["[axis.W]"]);
    let range = &found[0]["range"];
    let actions = client.ask(
        "textDocument/codeAction",
        json!({ "textDocument": { "uri": uri }, "range": range, "context": { "diagnostics": found } }),
    );
    let edit = &actions["result"][0]["edit"]["changes"][&uri][0];
    let at = |part: &str| edit["range"]["start"][part].as_u64().unwrap() as usize;
    let (line, column) = (at("line"), at("character"));
    let text = edit["newText"].as_str().unwrap();
    client.edit(&uri, 2, [line, column, line, column], text);
    let left = client.findings(&uri, 2);
    // It is described; that it moves along with another axis is the builder's to say.
    let codes = told(&left).join(" ");
    assert!(!codes.contains("machine-syntax"), "{left:#?}");
    assert!(
        left.iter().all(|finding| !finding["message"].to_string().contains("no [axis.W]")),
        "{left:#?}"
    );
}

#[test]
fn keys_axes_dialects_options_and_parameters_are_offered() {
    let (_folder, uri, good) = trunnion();
    let mut client = Client::new(&[], &json!({}));
    let head = with(&good, "[axis.Y]", "[axis.]");
    client.open(&uri, "toml", &head);
    let mut offered = |text: &str, version: i64, part: &str| {
        client.tell(
            "textDocument/didChange",
            json!({
                "textDocument": { "uri": uri, "version": version },
                "contentChanges": [{ "text": text }],
            }),
        );
        let (line, column) = place(text, part, part.len());
        labels(&client.at("completion", &uri, line, column))
    };
    assert_eq!(offered(&head, 2, "[axis."), ["Y"]);
    // Keys that a table has already are not offered again.
    let text = with(&good, "max_feed  = 5400", "maxq");
    let keys = offered(&text, 3, "maxq");
    assert!(keys.contains(&"max_feed".to_owned()), "{keys:?}");
    assert!(!keys.contains(&"max_accel".to_owned()), "{keys:?}");
    let text = with(&good, "dialect = \"", "dialect = \"X\" # \"");
    let dialects = offered(&text, 4, "dialect = \"");
    assert!(dialects.contains(&"heidenhain".to_owned()), "{dialects:?}");
    let text = format!("{good}\n[control.fanuc]\nproq");
    let options = offered(&text, 5, "proq");
    assert!(options.iter().any(|option| option.contains("program")), "{options:?}");
    let text = with(&good, "[0, 0, 400]", "[0, 0, \"\"]");
    let numbers = offered(&text, 6, "[0, 0, \"");
    assert_eq!(numbers[0], "Zc");
    assert!(numbers.contains(&"atan2".to_owned()), "{numbers:?}");
    let text = with(&good, "tcp", "tcp = \"\" #");
    let ways = offered(&text, 7, "tcp = \"");
    assert_eq!(ways, ["control", "post"]);
    let text = format!("extends = \"\"\n{good}");
    let machines = offered(&text, 8, "extends = \"");
    assert!(machines.contains(&"dmu50".to_owned()), "{machines:?}");
    assert!(machines.contains(&"mine".to_owned()), "{machines:?}");
}

#[test]
fn meaning_unit_default_and_value_are_told() {
    let (_folder, uri, good) = trunnion();
    let text = with(&good, "gauge = [0, 0, 400]", "gauge = [0, 0, \"8 * Zc - 32e-3\"]");
    let mut client = Client::new(&[], &json!({}));
    client.open(&uri, "toml", &text);
    let mut hover = |part: &str, behind: usize| {
        let (line, column) = place(&text, part, behind);
        client.hover(&uri, line, column)
    };
    assert_contains(
        &hover("max_jerk  = 12000", 2),
        &["`axis.C.max_jerk`", "degrees/s³", "a rotary axis, so degrees"],
    );
    assert_contains(&hover("[axis.X]", 3), &["`axis.X`", "One axis: its kind and line"]);
    assert_contains(&hover("axis_tolerance", 3), &["degrees; 0.05 if not said"]);
    assert_contains(&hover("tcp ", 1), &["- `control`:", "must be said"]);
    assert_contains(&hover("Zc - 32", 1), &["`Zc` = 50.004", "this file"]);
    assert_contains(&hover("8 * Zc", 0), &["= 400", "gauge point"]);
    let whole = json!({
        "textDocument": { "uri": uri },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": 9999, "character": 0 } },
    });
    let hints = client.ask("textDocument/inlayHint", whole);
    let hints = hints["result"].as_array().unwrap();
    let shown: Vec<&str> = hints.iter().map(|hint| hint["label"].as_str().unwrap()).collect();
    assert_eq!(shown, ["= 400", "= 50.004"]);
}

#[test]
fn a_parameter_is_found_and_renamed_through_extends() {
    let (folder, parent, good) = trunnion();
    let child_text = "extends = \"mine\"\n\n[workpiece]\nmount = [\"Zc/2\", 0, \"-Zc\"]\n";
    let child = folder.path().join("child.toml");
    fs::write(&child, child_text).unwrap();
    let other = folder.path().join("other.toml");
    fs::write(&other, "extends = \"vmc\"\nname = \"Zc\"\n").unwrap();
    let child = uri(&child);
    let mut client = Client::new(&[], &json!({}));
    client.open(&child, "toml", child_text);
    assert_eq!(client.findings(&child, 1), Vec::<Value>::new());
    // From a use in the file that extends to the definition.
    let (line, column) = place(child_text, "-Zc", 2);
    let defined = client.at("definition", &child, line, column);
    let (at, _) = place(&good, "Zc = 50.004", 0);
    assert_eq!(defined.as_array().unwrap().len(), 1, "{defined}");
    assert_eq!(defined[0]["uri"], json!(parent));
    assert_eq!(defined[0]["range"]["start"]["line"], json!(at));
    // And on to the file itself.
    let machine = client.at("definition", &child, 0, 12);
    assert_eq!(machine[0]["uri"], json!(parent));
    // All of them, from the parent too, in which the child is not named.
    let all = client.at("references", &child, line, column);
    assert_eq!(all.as_array().unwrap().len(), 4, "{all}");
    client.open(&parent, "toml", &good);
    let (from, column) = place(&good, "Zc = 50.004", 0);
    let all = client.at("references", &parent, from, column);
    assert_eq!(all.as_array().unwrap().len(), 4, "{all}");
    let rename = |to: &str| {
        json!({
            "textDocument": { "uri": parent },
            "position": { "line": from, "character": column },
            "newName": to,
        })
    };
    let renamed = client.ask("textDocument/rename", rename("height"));
    let changes = &renamed["result"]["changes"];
    assert_eq!(changes[&parent].as_array().unwrap().len(), 2, "{renamed}");
    assert_eq!(changes[&child].as_array().unwrap().len(), 2, "{renamed}");
    for taken in ["sqrt", "pi", "a b", "1a", ""] {
        let refused = client.ask("textDocument/rename", rename(taken));
        assert_contains(&refused["error"]["message"].to_string(), &["no name"]);
    }
    assert_eq!(client.end().0, 0);
}

#[test]
fn a_machine_that_is_built_in_is_not_changed() {
    let folder = tempfile::tempdir().unwrap();
    let text = "extends = \"ac-trunnion\"\n\n[workpiece]\nmount = [0, 0, \"Zc\"]\n";
    let lone = uri(&folder.path().join("lone.toml"));
    let mut client = Client::new_in(folder.path());
    client.open(&lone, "toml", text);
    assert_contains(&client.hover(&lone, 3, 17), &["= 50.004", "(built in)"]);
    let refused = client.ask(
        "textDocument/rename",
        json!({
            "textDocument": { "uri": lone },
            "position": { "line": 3, "character": 17 },
            "newName": "height",
        }),
    );
    let message = refused["error"]["message"].to_string();
    assert_contains(&message, &["ac-trunnion", "cannot be changed"]);
}

#[test]
fn a_fault_in_an_open_parent_is_told_in_the_child() {
    let (folder, parent, good) = trunnion();
    let child_text = "extends = \"mine\"\nname = \"child\"\n";
    let child = uri(&folder.path().join("child.toml"));
    let mut client = Client::new(&[], &json!({}));
    client.open(&child, "toml", child_text);
    assert_eq!(client.findings(&child, 1), Vec::<Value>::new());
    // Not saved: the text that is open counts.
    let bad = with(&good, "travel    = [-120, 30]", "travel    = [30, -120]");
    client.open(&parent, "toml", &bad);
    let found = client.findings_if(&child, 1, |found| !found.is_empty());
    assert_contains(&found[0]["message"].to_string(), &["mine.toml:"]);
}

#[test]
fn a_click_checks_the_file_as_the_command_would() {
    let (_folder, uri, good) = trunnion();
    let mut client = Client::new(&[], &json!({}));
    client.open(&uri, "toml", &good);
    let lenses = client.ask("textDocument/codeLens", json!({ "textDocument": { "uri": uri } }));
    let titles: Vec<&str> = lenses["result"]
        .as_array()
        .unwrap()
        .iter()
        .map(|lens| lens["command"]["title"].as_str().unwrap())
        .collect();
    assert_eq!(titles, ["post check", "post check --commission"]);
    for (lens, holds) in [(0, "table"), (1, "COMMISSION")] {
        let command = &lenses["result"][lens]["command"];
        let done = client.ask(
            "workspace/executeCommand",
            json!({ "command": command["command"], "arguments": command["arguments"] }),
        );
        let done = &done["result"];
        assert_eq!(done["code"], 0, "{done}");
        assert_contains(done["printed"].as_str().unwrap(), &[holds]);
    }
    // What is on the disk is another text.
    client.edit(&uri, 2, [0, 0, 0, 0], "# changed\n");
    let command = &lenses["result"][0]["command"];
    let refused = client.ask(
        "workspace/executeCommand",
        json!({ "command": command["command"], "arguments": command["arguments"] }),
    );
    assert_contains(&refused["error"]["message"].to_string(), &["not saved"]);
}

#[test]
fn other_toml_is_left_alone() {
    // As VS Code's client starts a server.
    let mut client = Client::new(&["--stdio"], &json!({}));
    let uri = "file:///nowhere/Cargo.toml";
    client.open(uri, "toml", "[package]\nname = \"x\"\nchain = 3\n");
    assert_eq!(client.hover(uri, 1, 1), "");
    assert_eq!(client.at("completion", uri, 1, 2), json!([]));
    assert_eq!(client.end().0, 0);
}
