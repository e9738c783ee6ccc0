//! Ways between passes that are as bodies leave them: proven clear, verified, and lower or shorter where they can be.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{post_in, root, sample};

/// What every machine here has: a table, a vise, a head, a stock and two tools.
const BODIES: &str = "[fixture.vise]
block = [[-50, -40, 0], [50, 40, 60]]
[fixture.head]
cylinder = [[0, 0, 502], [0, 0, 620]]
radius = 60
on = \"t\"
[stock]
block = [[-30, -30, 0], [30, 30, 40]]
[tools.2]
length = 120
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 6], [50, 6]]
[tools.6]
length = 120
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 2.5], [55, 2.5]]
[clearance]
keep = 1
";

/// The sample with four facets and a drill, on a machine with `more` bodies.
fn folder(machine: &str, more: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let head = format!(
        "extends = \"{machine}\"\nname = \"with bodies\"\n[workpiece]\nmount = [0, 0, 60]\n"
    );
    fs::write(folder.path().join("m.toml"), format!("{head}{BODIES}{more}")).unwrap();
    folder
}

const LOW: [&str; 2] = ["--set", "clearance.low_retracts=true"];

/// The program that is posted so, and its summary; it is proven and held against its CL file once more.
fn made(folder: &TempDir, more: &[&str]) -> (String, Value) {
    let facets = root().join(sample("facets.apt"));
    let facets = facets.to_str().unwrap();
    let words = ["-m", "m.toml", facets, "-o", "f.nc", "-q", "--summary", "s.json"];
    let run = post_in(folder.path(), &[&words, more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let proof = post_in(folder.path(), &["clearance", "f.nc", "-m", "m.toml", "--cl", facets]);
    assert_eq!(proof.code, 0, "{}{}", proof.out, proof.err);
    let words = ["verify", "f.nc", "-m", "m.toml", "--against", facets, "--posted"];
    let held = post_in(folder.path(), &[&words, more].concat());
    assert_eq!(held.code, 0, "{}", held.err);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    (read("f.nc"), serde_json::from_str(&read("s.json")).unwrap())
}

/// Where the depth axis is retracted to, in the order of the program.
fn retracts(program: &str) -> Vec<f64> {
    let lines = program
        .lines()
        .filter(|line| ["M91", "G53 G0 Z", "SUPA"].iter().any(|word| line.contains(word)));
    let words = lines.filter_map(|line| {
        let mut words = line.split_whitespace();
        words.find_map(|word| word.strip_prefix('Z')?.trim_start_matches('=').parse().ok())
    });
    words.collect()
}

#[test]
fn the_tool_is_retracted_as_high_as_bodies_ask_for() {
    for machine in ["dmu50", "ac-trunnion", "ac-trunnion-840d"] {
        let folder = folder(machine, "");
        let (ever, _) = made(&folder, &[]);
        let (low, summary) = made(&folder, &LOW);
        let [ever, low] = [retracts(&ever), retracts(&low)];
        assert_eq!(ever.len(), low.len(), "{machine}");
        let lower = ever.iter().zip(&low).filter(|(ever, low)| low < ever).count();
        let ways = &summary["ways_across"];
        assert_eq!(ways["low"], lower as u64, "{machine}: {summary}");
        assert!(lower >= 3 && ways["saved_s"].as_f64().unwrap() > 0.5, "{machine}: {summary}");
        assert!(ever.iter().zip(&low).all(|(ever, low)| low <= ever), "{machine}");
    }
}
