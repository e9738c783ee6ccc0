//! NC programs.

use std::fs;
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};

use super::client::{Client, place, uri};
use crate::common::{assert_contains, post_in, with_file};

const PART: &str = "UNITS/MM
LOADTL/1
SPINDL/RPM,3000,CLW
COOLNT/FLOOD
RAPID
GOTO/0,0,50
FEDRAT/100,MMPM
GOTO/0,0,10
GOTO/20,5,10
FINI
";

#[test]
fn what_holds_at_a_line_and_the_cl_line_it_came_from_are_told() {
    let folder = with_file("part.cls", PART);
    let run = |arguments: &[&str]| {
        let run = post_in(folder.path(), arguments);
        assert_eq!(run.code, 0, "{}", run.err);
    };
    let length = ["--tool-length", "100"];
    run(&[&["--machine", "vmc", "part.cls", "-o", "part.nc"], &length[..]].concat());
    run(&[
        &[
            "verify",
            "part.nc",
            "--machine",
            "vmc",
            "--against",
            "part.cls",
            "--map",
            "part.map.json",
        ],
        &length[..],
    ]
    .concat());
    let path = folder.path().join("part.nc");
    let text = fs::read_to_string(&path).unwrap();
    let program = uri(&path);
    let mut client = Client::new(&["--machine", "vmc"], &json!({ "toolLength": 100 }));
    client.open(&program, "plaintext", &text);
    let (line, column) = place(&text, "X20.", 1);
    let said = hover_when_read(&mut client, &program, line, column);
    assert_contains(
        &said,
        &[
            "X 20.000 Y 5.000",
            "feed 100 mm/min",
            "tool 1",
            "spindle 3000 rpm clockwise",
            "flood",
            "From line 9 of part.cls",
        ],
    );
    let asked = client.at("definition", &program, line, column);
    assert_eq!(asked[0]["uri"], json!(uri(&folder.path().join("part.cls"))));
    assert_eq!(asked[0]["range"]["start"]["line"], 8);
    // What holds at each line, and nothing of the lines behind: the spindle still stands where the tool is changed, turns from
    // its line on, and turns while the last cut is made.
    let (line, column) = place(&text, "M6", 0);
    let changed = client.hover(&program, line, column);
    assert_contains(&changed, &["spindle off"]);
    assert_eq!(changed.matches("tool 1").count(), 1, "{changed}");
    let (line, column) = place(&text, "M3", 0);
    let turning = client.hover(&program, line, column);
    assert_contains(&turning, &["spindle 3000 rpm clockwise"]);
    assert!(!turning.contains("flood"), "{turning}");
    // Words say what they mean, however they are joined.
    let (line, column) = place(&text, "G21", 1);
    assert_contains(&client.hover(&program, line, column), &["`G21`: millimetre"]);
    // Letters of more than a byte stand before a word, and at the end of the file.
    let remark = uri(&folder.path().join("remark.nc"));
    client.open(&remark, "plaintext", "(\u{d8}G21)\n\u{fffd}");
    assert_contains(&hover_when_read(&mut client, &remark, 0, 3), &["`G21`: millimetre"]);
    client.hover(&remark, 9, 0);
}

/// What is said of a place of a program that the server has read.
fn hover_when_read(client: &mut Client, program: &str, line: usize, column: usize) -> String {
    for _ in 0..600 {
        let said = client.hover(program, line, column);
        if !said.contains("not read yet") {
            return said;
        }
        thread::sleep(Duration::from_millis(50));
    }
    panic!("{program} was not read in half a minute");
}

/// Saved programs are proven, edited ones are not until they are saved again.
#[test]
fn what_hits_something_is_told_where_a_program_is_opened_or_saved() {
    let machine = "extends = \"vmc\"\nname = \"mine\"\n[workpiece]\nmount = [0, 0, -300]\n[tools.1]\nlength = 100\n\
                   cutter = [[0, 5], [60, 5]]\n[fixture.clamp]\nblock = [[-20, -20, -330], [20, 20, -300]]\n";
    let folder = with_file("mine.toml", machine);
    let program = |z: &str| {
        format!(
            "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nT1 M6\nS1000 M3\nG54\nG0 X0. Y0.\nG43 H1 Z50.\nG1 Z{z} \
             F500.\nG0 Z50.\nG53 G0 Z0.\nM30\n%\n"
        )
    };
    let path = folder.path().join("part.nc");
    fs::write(&path, program("-5.")).unwrap();
    let uri = uri(&path);
    let machine = folder.path().join("mine.toml");
    let options = json!({ "machine": machine.to_str().unwrap() });
    let mut client = Client::new(&[], &options);
    client.open(&uri, "plaintext", &program("-5."));
    let hits = |found: &[Value]| {
        found.iter().any(|one| one["message"].as_str().unwrap().contains("clamp hits cutter T1"))
    };
    let found = client.findings_if(&uri, 1, |found| hits(found));
    let hit = found.iter().find(|one| one["code"] == "clearance").unwrap();
    assert_eq!(hit["range"]["start"]["line"], 9, "{found:#?}");
    client.edit(&uri, 2, [0, 0, 99, 0], &program("5."));
    let found = client.findings_if(&uri, 2, |found| !hits(found));
    assert!(!hits(&found));
    client.edit(&uri, 3, [0, 0, 99, 0], &program("-6."));
    client.tell("textDocument/didSave", json!({ "textDocument": { "uri": uri } }));
    let found = client.findings_if(&uri, 3, |found| hits(found));
    assert!(hits(&found));
}

#[test]
fn what_is_wrong_with_a_program_is_told_where_it_is_opened() {
    let uri = "file:///nowhere/part.nc";
    let program = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nT1 M6\nS1000\nG54\nG0 X0. Y0.\nG43 H1 Z50.\n\
                   G1 Z2. F500.\nG0 Z50.\nG53 G0 Z0.\nM30\n%\n";
    let mut client = Client::new(&["--machine", "vmc"], &json!({ "toolLength": 100 }));
    client.open(uri, "plaintext", program);
    let stands = |found: &[Value]| {
        found.iter().any(|one| one["code"] == "spindle" && one["range"]["start"]["line"] == 9)
    };
    let found = client.findings_if(uri, 1, |found| stands(found));
    assert!(stands(&found));
}

#[test]
fn a_program_that_cannot_be_read_says_where_and_loops_end() {
    let uri = "file:///nowhere/part.nc";
    let mut client = Client::new(&["--machine", "vmc"], &json!({}));
    client.open(uri, "plaintext", "%\nO1\nG21 G90\nG1 X1. Y[ F100\nM30\n%\n");
    let found = client.findings(uri, 1);
    assert_eq!(found[0]["range"]["start"]["line"], 3, "{found:#?}");
    client.open(uri, "plaintext", "%\nO1\nN1 G21\nGOTO1\nM30\n%\n");
    let found = client.findings_if(uri, 1, |found| !found.is_empty());
    assert!(!found.is_empty());
    assert_eq!(client.end().0, 0);
}
