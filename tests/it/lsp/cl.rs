//! CL files.

use std::fs;

use serde_json::{Value, json};

use super::client::{Client, labels, told, uri};
use crate::common::{assert_contains, root};

const SHOWN: &str = "UNITS/MM
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/100,MMPM
GOTO/0,0,10
GOTO/20,0,10,$
 0,0.1736482,0.9848078
FINI
";

#[test]
fn what_cannot_be_read_is_told_in_utf_16_columns() {
    let mut client = Client::new(&[], &json!({}));
    let uri = "file:///nowhere/part.cls";
    client.open(uri, "plaintext", "PPRINT 𝄞\nGOTO/1,2\nFEDRATE/5,MMPM\nGOTO/1,2,x\n");
    let found = client.findings(uri, 1);
    let places = told(&found);
    assert_eq!(places.len(), 3, "{found:#?}");
    assert!(places.contains(&"unknown-word 2:0-7".to_owned()), "{places:?}");
    let word = found.iter().find(|finding| finding["code"] == "unknown-word").unwrap();
    assert_contains(&word["message"].to_string(), &["did you mean `FEDRAT`?"]);
    // What stands behind a letter of two units.
    let text = "GOTO/1,2,\u{1D11E}x\n";
    client.tell(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": [{ "text": text }] }),
    );
    let found = client.findings(uri, 2);
    assert_eq!(told(&found), ["syntax 0:9-12"], "{found:#?}");
}

#[test]
fn operations_and_tools_are_found_and_folded() {
    let mut client = Client::new(&[], &json!({}));
    let path = root().join("tests/samples/blade.cls");
    let text = fs::read_to_string(&path).unwrap();
    let uri = uri(&path);
    client.open(&uri, "plaintext", &text);
    let of = json!({ "textDocument": { "uri": uri } });
    let symbols = client.ask("textDocument/documentSymbol", of.clone());
    let names: Vec<&str> = symbols["result"]
        .as_array()
        .unwrap()
        .iter()
        .map(|symbol| symbol["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["BLADE_FINISH", "tool 3"]);
    let folds = client.ask("textDocument/foldingRange", of);
    let end = text.lines().position(|line| line.starts_with("END-OF-PATH"));
    assert_eq!(
        folds["result"],
        json!([{ "startLine": 0, "endLine": end.unwrap(), "kind": "region" }])
    );
}

#[test]
fn axis_values_and_deviation_are_those_of_the_chosen_machine() {
    let uri = "file:///nowhere/part.cls";
    let mut client = Client::new(&[], &json!({}));
    client.open(uri, "plaintext", SHOWN);
    assert_contains(&client.hover(uri, 7, 2), &["**GOTO**", "`post.machine`"]);
    client.tell(
        "workspace/didChangeConfiguration",
        json!({ "settings": { "post": { "machine": "ac-trunnion", "toolLength": 100 } } }),
    );
    let mut said = String::new();
    for _ in 0..600 {
        said = client.hover(uri, 8, 2);
        if said.contains("On AC trunnion: `") {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    // The tool leans by 10 degrees away from -Y, whichever of the two solutions is taken.
    assert_contains(&said, &["X ", " C ", "certified: tip ", "block"]);
    assert!(said.contains("A -10.000°") || said.contains("A 10.000°"), "{said}");
    // The first line of a record that goes over two tells the same.
    assert_eq!(client.hover(uri, 7, 0), said);
    // An edit takes it back: the axes stand elsewhere now.
    client.edit(uri, 2, [6, 0, 6, 11], "GOTO/1,0,10");
    assert_contains(&client.hover(uri, 6, 2), &["not posted yet"]);
}

#[test]
fn what_posting_refuses_is_told_where_it_stands() {
    let uri = "file:///nowhere/part.cls";
    let mut client = Client::new(&["--machine", "vmc", "--tool-length", "100"], &json!({}));
    client.open(uri, "plaintext", SHOWN);
    let found = client.findings_if(uri, 1, |found| !found.is_empty());
    let lines: Vec<&Value> =
        found.iter().map(|finding| &finding["range"]["start"]["line"]).collect();
    // The leaning tool axis, which three axes cannot reach.
    assert!(lines.contains(&&json!(7)), "{found:#?}");
    client.edit(uri, 2, [7, 0, 8, 22], "GOTO/20,0,10");
    assert_eq!(client.findings(uri, 2), Vec::<Value>::new());
    assert_eq!(client.findings(uri, 2), Vec::<Value>::new());
    // A machine that is not there is said so.
    client.tell(
        "workspace/didChangeConfiguration",
        json!({ "settings": { "post": { "machine": "vmcc" } } }),
    );
    let found = client.findings_if(uri, 2, |found| !found.is_empty());
    assert_contains(&found[0]["message"].to_string(), &["no machine vmcc", "vmc"]);
}

/// A list of points is one by what it says; of other tables and other JSON nothing is told.
#[test]
fn lists_of_points_are_told_of() {
    let mut client = Client::new(&["--machine", "xyzac-trt", "--tool-length", "50"], &json!({}));
    let uri = "file:///nowhere/path.csv";
    let text =
        "tool,1\nspindle,6000\nfeed,800\nx,y,z,i,j,k\n0,0,20,0,0,1\n10,0,0,0,0.1,1\n20,0,0,0,0,\n";
    client.open(uri, "csv", text);
    let found = client.findings(uri, 1);
    assert_eq!(told(&found), ["syntax 6:11-11"], "{found:#?}");
    client.edit(uri, 2, [6, 0, 6, 11], "20,0,0,0,0,1");
    let mut said = String::new();
    for _ in 0..600 {
        said = client.hover(uri, 5, 2);
        if said.contains("certified: tip ") {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    assert_contains(&said, &["On ", "X ", " A ", "block"]);
    assert!(!said.contains("GOTO"), "{said}");
    // No words of CL files.
    assert!(labels(&client.at("completion", uri, 5, 0)).is_empty());
    for (uri, language, text) in [
        ("file:///nowhere/prices.csv", "csv", "id,name,price\n1,a,2\n"),
        ("file:///nowhere/package.json", "json", "{\"name\": \"x\"}"),
    ] {
        client.open(uri, language, text);
        assert_eq!(client.hover(uri, 0, 1), "", "{uri}");
    }
}

#[test]
fn words_are_offered_and_misspelt_ones_put_right() {
    let mut client = Client::new(&[], &json!({}));
    let uri = "file:///nowhere/part.cls";
    let text = "UNITS/MM\nFEDRAT/100,MMPN\nSPINDLE/RPM,3000,CLW\n\nGOTO/0,0,1 $$ FED\nFINI\n";
    client.open(uri, "plaintext", text);
    let mut offered = |line, column| labels(&client.at("completion", uri, line, column));
    let majors = offered(3, 0);
    assert!(["FEDRAT", "CYCLE", "GOTO"].iter().all(|word| majors.iter().any(|one| one == word)));
    // What is refused or says nothing is no help.
    assert!(!majors.iter().any(|word| word == "TRACUT" || word == "PAINT"), "{majors:?}");
    assert_eq!(offered(1, 7)[..3], ["MMPM", "IPM", "PERMIN"]);
    assert!(offered(2, 8).is_empty(), "no word is SPINDLE");
    assert!(offered(4, 17).is_empty(), "a remark");

    let found = client.findings(uri, 1);
    assert_eq!(told(&found), ["syntax 1:11-15", "unknown-word 2:0-7"], "{found:#?}");
    let whole =
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 5, "character": 0 } });
    let actions = client.ask(
        "textDocument/codeAction",
        json!({ "textDocument": { "uri": uri }, "range": whole, "context": { "diagnostics": found } }),
    );
    let actions = actions["result"].as_array().unwrap().clone();
    let titles: Vec<&str> = actions.iter().map(|one| one["title"].as_str().unwrap()).collect();
    assert_eq!(titles, ["Write `MMPM`", "Write `SPINDL`"]);
    for (version, action) in (2..).zip(&actions) {
        let edit = &action["edit"]["changes"][uri][0];
        let at = |end: &str, part: &str| edit["range"][end][part].as_u64().unwrap() as usize;
        let part = [
            at("start", "line"),
            at("start", "character"),
            at("end", "line"),
            at("end", "character"),
        ];
        client.edit(uri, version, part, edit["newText"].as_str().unwrap());
    }
    assert_eq!(client.findings(uri, 3), Vec::<Value>::new());
    assert_eq!(client.end().0, 0);
}
