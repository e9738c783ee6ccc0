//! What `post check` says, posting does: the same plugins with the same options, and a tool that stands upright in the
//! one stands upright in the other.

use crate::common;

use std::fs;
use std::path::Path;

use common::{Run, post, root};
use post_testkit::{all_drawn, drawn, rounds};
use serde_json::Value;

const LENGTH: &str = "50";

/// A small job with the tool upright, close around the part origin.
const UPRIGHT: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,300,CLW\nRAPID\nGOTO/0,0,2\nFEDRAT/100,MMPM\nGOTO/0,0,0\nGOTO/2,1,0\nGOTO/0,0,2\nEND\nFINI\n";

fn with<'a>(first: &[&'a str], settings: &'a [String], more: &[&'a str]) -> Run {
    let mut all = first.to_vec();
    for setting in settings {
        all.extend(["--set", setting]);
    }
    all.extend(more);
    post(&all)
}

fn check(machine: &str, settings: &[String], mount: &str) -> Result<Value, Run> {
    let more = ["--tool-length", LENGTH, "--mount", mount, "--json", "-"];
    let run = with(&["check", machine], settings, &more);
    match run.code {
        0 => Ok(serde_json::from_str(&run.out).unwrap()),
        _ => Err(run),
    }
}

fn numbers(value: &Value) -> Option<[f64; 3]> {
    let list = value.as_array()?;
    Some([0, 1, 2].map(|index| list[index].as_f64().unwrap()))
}

fn text([x, y, z]: [f64; 3]) -> String {
    format!("{x},{y},{z}")
}

/// Machines of the library as they are and with one thing changed.
fn variants() -> Vec<(String, Vec<String>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(root().join("machines")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let file: toml::Table = fs::read_to_string(&path).unwrap().parse().unwrap();
        // What drives reach is held where the program is made, and no part of what is upright.
        if file.contains_key("drive") {
            continue;
        }
        let mut changes: Vec<Vec<String>> = vec![vec![]];
        // Within the tolerance of the tool axis, and beyond it, where no control's length lies along it any more.
        changes.push(vec!["tool.axis=[0.0005, 0, 1]".to_owned()]);
        changes.push(
            ["tool.axis=[0.02, 0, 1]", "tool.length_axis=\"none\""].map(str::to_owned).into(),
        );
        // Where an edge leads the cut, its direction asks for more positions of an index axis than the tool upright.
        let led = file.get("tool").and_then(|tool| tool.get("edge")).is_some();
        let axes = file.get("axis").and_then(toml::Value::as_table).filter(|_| !led);
        for (axis, table) in axes.into_iter().flatten() {
            if table.get("rotary").is_none() || table.get("indexed").is_some() {
                continue;
            }
            let key = |key: &str| format!("axis.{axis}.{key}");
            let indexed = key("indexed=0");
            changes.push(vec![indexed.clone()]);
            changes.push(vec![indexed.clone(), key("step=7")]);
            changes.push(vec![indexed.clone(), key("positions=[0, 20]")]);
            changes.push(vec![key("indexed=20"), key("positions=[20, 0]")]);
        }
        all.extend(changes.into_iter().map(|change| (name.clone(), change)));
    }
    all.sort();
    drawn(all, 1)
}

/// The part is put into the middle of the tip's travel; then what the check says of an upright tool and of the part
/// origin is what posting does with a small upright program.
#[test]
fn an_upright_program_is_posted_where_the_check_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let part = folder.path().join("part.cls");
    fs::write(&part, UPRIGHT).unwrap();
    let (mut posted, mut refused, mut unloaded, mut poor) = (0, 0, 0, 0);
    let mut faults = Vec::new();
    // The part is milled, which a printer refuses.
    let mills = variants().into_iter().filter(|(machine, _)| machine != "printer-open5x");
    for (machine, settings) in mills {
        let file: toml::Table = fs::read_to_string(root().join(format!("machines/{machine}.toml")))
            .unwrap()
            .parse()
            .unwrap();
        let mount = file
            .get("workpiece")
            .and_then(|workpiece| workpiece.get("mount"))
            .and_then(toml::Value::as_array)
            .map_or([0.0; 3], |list| {
                [0, 1, 2].map(|index| match &list[index] {
                    toml::Value::Integer(number) => *number as f64,
                    number => number.as_float().unwrap_or(0.0),
                })
            });
        let Ok(first) = check(&machine, &settings, &text(mount)) else {
            unloaded += 1;
            continue;
        };
        let volume = &first["volume"];
        let placed = match (numbers(&volume["least"]), numbers(&volume["most"])) {
            (Some(least), Some(most)) => {
                [0, 1, 2].map(|index| mount[index] + (least[index] + most[index]) / 2.0)
            }
            // Where the table makes up for an axis, its middle is a place that no path goes through.
            _ => [mount[0] + 100.0, mount[1], mount[2]],
        };
        let placed = text(placed);
        // A control that counts from the line of C has the part origin on it.
        let Ok(told) = check(&machine, &settings, &placed) else {
            unloaded += 1;
            continue;
        };
        let warnings = told["warnings"].to_string();
        // A lathe that turns goes over a plane, and is not warned of it.
        let turns = told["class"]["name"] == "two-axis";
        if turns || warnings.contains("while the tool keeps its direction") {
            poor += 1;
            continue;
        }
        let upright = told["reach"]["ways_upright"].as_u64().unwrap() > 0;
        let out = told["volume"]["origin_out"].as_array();
        let inside = out.is_some_and(Vec::is_empty);
        if upright && !inside {
            // A turned table moved the part elsewhere; what the check says of that is tested by other means.
            continue;
        }
        let more =
            ["--tool-length", LENGTH, "--mount", &placed, "-q", "-o", "-", part.to_str().unwrap()];
        let run = with(&["-m", &machine], &settings, &more);
        let named = format!("{machine} {settings:?} at {placed}");
        match (upright, run.code) {
            (true, 0) => posted += 1,
            (false, 1)
                if run.err.contains("[out-of-reach]") || run.err.contains("[over-travel]") =>
            {
                refused += 1;
            }
            _ => faults
                .push(format!("{named}: upright {upright}, posted {}:\n{}", run.code, run.err)),
        }
    }
    println!(
        "{posted} posted, {refused} refused by both, {poor} said to make few programs, {unloaded} no machine"
    );
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(posted > rounds(90) && (refused > 10 || !all_drawn()), "{posted} {refused}");
}

/// What posting refuses before its first record, the check refuses with the same words.
#[test]
fn the_check_refuses_plugins_and_options_as_posting_does() {
    let folder = tempfile::tempdir().unwrap();
    let part = folder.path().join("part.cls");
    fs::write(&part, UPRIGHT).unwrap();
    let broken = folder.path().join("libpost_broken.so");
    fs::write(&broken, "no library").unwrap();
    let folder_text = folder.path().to_str().unwrap();
    let cases: &[(&[&str], &[&str], &str)] = &[
        (&["control.fanuc.nonsense=1"], &[], "option `nonsense`"),
        (&["control.fanuc.program_number=\"often\""], &[], "option `program_number`"),
        (&["control.dialect=\"nosuch\""], &[], "no such plugin"),
        (&["accuracy.model=\"nosuch\""], &[], "no such plugin"),
        (&["accuracy.sampled.nonsense=1"], &[], "option `nonsense`"),
        (&["control.dialect=\"heidenhain\"", "control.feed=\"inverse-time\""], &[], "inverse time"),
        (&["control.dialect=\"broken\""], &["--plugins", folder_text], "broken"),
        (&[], &["--plugins", "no/such/folder"], "no such folder"),
    ];
    for (settings, more, expected) in cases {
        let settings: Vec<String> = settings.iter().map(|text| (*text).to_owned()).collect();
        let checked = with(&["check", "ac-trunnion"], &settings, more);
        let mut all = more.to_vec();
        all.extend(["-o", "-", "--tool-length", LENGTH, part.to_str().unwrap()]);
        let posted = with(&["-m", "ac-trunnion"], &settings, &all);
        assert_eq!((checked.code, posted.code), (1, 1), "{settings:?}");
        assert!(checked.err.contains(expected), "{}", checked.err);
        assert_eq!(checked.err, posted.err, "{settings:?}");
    }
    // Both faults are told at once.
    let both = ["control.fanuc.nonsense=1", "accuracy.model=\"nosuch\""].map(str::to_owned);
    let run = with(&["check", "ac-trunnion"], &both, &[]);
    assert!(run.err.contains("2 errors"), "{}", run.err);
}

/// A fixture: an arm of six rotary axes with a spindle.
const ARM: &str = "tests/chains/six-axis-arm.toml";

/// It is solved numerically by both: the check ends, and a program is certified.
#[test]
fn an_arm_is_checked_and_posted() {
    assert!(Path::new(root()).join(ARM).is_file());
    let checked = post(&["check", ARM, "--tool-length", LENGTH]);
    assert_eq!(checked.code, 0, "{}", checked.err);
    assert!(checked.out.contains("numerically"), "{}", checked.out);
    assert!(checked.out.contains("warnings          none"), "{}", checked.out);
    let folder = tempfile::tempdir().unwrap();
    let part = folder.path().join("part.cls");
    let tilted = UPRIGHT
        .replace("GOTO/2,1,0\n", "GOTO/2,1,0\nGOTO/12,9,-3,0.2,0.1,0.97\nGOTO/30,9,-3,0,0,1\n");
    fs::write(&part, tilted).unwrap();
    let json = folder.path().join("s.json");
    let run = post(&[
        "-m",
        ARM,
        "--tool-length",
        LENGTH,
        "-q",
        "-o",
        "-",
        "--summary",
        json.to_str().unwrap(),
        part.to_str().unwrap(),
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let summary = common::read_json(&json);
    let tip = summary["tip_deviation_mm"]["value"].as_f64().unwrap();
    assert!(tip > 0.0 && tip <= 0.1, "{tip}");
    // Without a place for its axes nothing leads the tool off the part: refused by both, in the same words.
    let text = fs::read_to_string(root().join(ARM)).unwrap();
    let bare: Vec<&str> = text.lines().filter(|line| !line.starts_with("park")).collect();
    let machine = folder.path().join("bare.toml");
    fs::write(&machine, bare.join("\n")).unwrap();
    let machine = machine.to_str().unwrap();
    let checked = post(&["check", machine]);
    let posted = post(&["-m", machine, "-o", "-", part.to_str().unwrap()]);
    assert_eq!((checked.code, posted.code), (1, 1));
    let said = "six-axis arm has no linear axis to lead the tool off the part with";
    assert!(checked.err.contains(said), "{}", checked.err);
    assert_eq!(checked.err, posted.err);
}
