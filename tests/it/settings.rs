//! What the options of a job change in its program.

use crate::common;

use common::{GOOD, assert_contains, post, post_text, read_json};
use serde_json::Value;

const BLADE: &str = "tests/samples/blade.cls";
const PLATE: &str = "tests/samples/plate.ncl";
const KNIFE: &str = "tests/samples/knife.ncl";

/// Blocks of a job and its summary.
fn posted(arguments: &[&str]) -> (String, Value) {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("s.json");
    let mut all = vec!["-q", "-o", "-", "--summary", json.to_str().unwrap()];
    all.extend(arguments);
    let done = post(&all);
    assert_eq!(done.code, 0, "{arguments:?}\n{}", done.err);
    (done.out, read_json(&json))
}

#[test]
fn a_parameter_of_the_machine_is_set_for_one_job() {
    let as_filed = posted(&["-m", "disc-cutter", KNIFE]);
    assert_eq!(posted(&["-m", "disc-cutter", KNIFE, "--set", "Lm=312"]), as_filed);
    let shorter = posted(&["-m", "disc-cutter", KNIFE, "--set", "Lm=250"]);
    assert_ne!(shorter.0, as_filed.0);
    // The shorter swing strays less and needs fewer points.
    let added = |job: &(String, Value)| job.1["points_added"].as_u64().unwrap();
    assert!(added(&shorter) < added(&as_filed));
    // An expression of parameters follows: a head of 250 mm with a tool of 62 mm is the head of 312 mm.
    let tool = posted(&["-m", "disc-cutter", KNIFE, "--set", "Lm=250", "--tool-length", "62"]);
    let blocks = |program: &str| -> Vec<String> {
        // All but the remark for which length the words hold.
        let lines = program.lines().filter(|line| !line.starts_with("(FOR TOOL"));
        lines.map(str::to_owned).collect()
    };
    assert!(tool.0.contains("(FOR TOOL 1 OF 62.000 MM ALONE)"), "{}", tool.0);
    assert_eq!(blocks(&tool.0), blocks(&as_filed.0));
    let refused = post(&["-m", "disc-cutter", KNIFE, "-o", "-", "--set", "Ln=250"]);
    assert_eq!(refused.code, 1);
    assert_contains(&refused.err, &["Ln", "Lm"]);
}

#[test]
fn the_tolerance_is_kept_whatever_it_is() {
    let mut before = u64::MAX;
    for (tolerance, most) in [("0.002", 0.002), ("0.005", 0.005), ("0.05", 0.05)] {
        let (_, summary) = posted(&["-m", "disc-cutter", KNIFE, "--tolerance", tolerance]);
        let deviation = summary["tip_deviation_mm"]["value"].as_f64().unwrap();
        assert!(deviation <= most && deviation > most / 10.0, "{deviation}");
        assert_eq!(summary["tolerance_mm"], most);
        let blocks = summary["blocks"].as_u64().unwrap();
        assert!(blocks < before);
        before = blocks;
        let set = format!("accuracy.tolerance={tolerance}");
        let (_, same) = posted(&["-m", "disc-cutter", KNIFE, "--set", &set]);
        assert_eq!(same, summary);
    }
}

#[test]
fn flags_are_short_for_the_keys_that_they_set() {
    for (flag, key, sample) in [
        ("--reduce", "accuracy.reduce=true", BLADE),
        ("--fit-arcs", "control.arcs.fit=true", PLATE),
    ] {
        let job = ["-m", "ac-trunnion", "--tool-length", "100", "--tolerance", "0.1", sample];
        let [short, long] =
            [vec![flag], vec!["--set", key]].map(|more| posted(&[&job[..], &more].concat()));
        assert_eq!(short, long, "{flag}");
    }
    let plain = posted(&["-m", "ac-trunnion", "--tool-length", "100", "--tolerance", "0.1", BLADE]);
    let reduced = posted(&[
        "-m",
        "ac-trunnion",
        "--tool-length",
        "100",
        "--tolerance",
        "0.1",
        BLADE,
        "--reduce",
    ]);
    assert!(reduced.1["blocks"].as_u64() < plain.1["blocks"].as_u64(), "{}", reduced.1["blocks"]);
}

#[test]
fn the_model_is_trusted_only_on_demand() {
    let distrusted = posted(&["-m", "disc-cutter", KNIFE]).1;
    let trusted = posted(&["-m", "disc-cutter", KNIFE, "--trust-model"]).1;
    assert!(trusted["blocks"].as_u64() <= distrusted["blocks"].as_u64());
    let deviation = trusted["tip_deviation_mm"]["value"].as_f64().unwrap();
    // The stock model is good to a hundredth of its peak.
    assert!(deviation < 0.005 * 1.05, "{deviation}");
}

#[test]
fn the_mount_moves_the_axes_and_not_the_words_of_a_work_offset() {
    let here = posted(&["-m", "vmc", PLATE]);
    let there = posted(&["-m", "vmc", PLATE, "--mount", "-100,50,20"]);
    assert_eq!(there.0, here.0, "three axes without a table to turn");
    let low = |job: &(String, Value)| job.1["axes"][0]["min"].as_f64().unwrap();
    assert!((low(&here) - low(&there) - 100.0).abs() < 1e-9);
    // On a table that turns the words depend on it.
    let here = posted(&["-m", "ac-trunnion", BLADE]);
    let there = posted(&["-m", "ac-trunnion", BLADE, "--mount", "0,0,30"]);
    assert_ne!(there.0, here.0);
}

#[test]
fn units_are_what_the_user_says() {
    let text = "LOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/1,0,2\nFEDRAT/10\nGOTO/1,0,1\nFINI\n";
    let on_vmc = ["-q", "-m", "vmc", "--tool-length", "0"];
    let inch = post_text(&[&on_vmc[..], &["--units", "inch"]].concat(), text);
    assert_contains(&inch.out, &["X25.400", "G1 Z25.400 F254."]);
    assert_eq!(inch.err, "");
    let millimetres = post_text(&[&on_vmc[..], &["--units", "mm"]].concat(), text);
    assert_contains(&millimetres.out, &["X1.000", "G1 Z1.000 F10."]);
    // Without a word from anybody they are mm, and that is said.
    let unsaid = post_text(&["-q", "-m", "vmc"], text);
    assert_eq!(unsaid.out, millimetres.out);
    assert_contains(&unsaid.err, &["warning[units]", "--units"]);
    // The file's own word is overruled.
    let declared = format!("UNITS/INCHES\n{text}");
    let told = post_text(&["-q", "-m", "vmc", "--units", "mm"], &declared);
    assert_eq!(told.out, millimetres.out);
}

#[test]
fn the_tool_length_matters_where_the_head_turns_and_nowhere_else() {
    let words =
        |machine: &str, length: &str| posted(&["-m", machine, BLADE, "--tool-length", length]).0;
    assert_eq!(words("ac-trunnion", "50"), words("ac-trunnion", "80"));
    assert_ne!(words("head-head", "50"), words("head-head", "80"));
    // A length in the CL file serves; the command line overrules it.
    let text = GOOD.replace("LOADTL/1", "LOADTL/1,LENGTH,80");
    let from_file = post_text(&["-q", "-m", "head-head"], &text);
    assert_eq!((from_file.code, from_file.err.as_str()), (0, ""));
    let told = post_text(&["-q", "-m", "head-head", "--tool-length", "80"], GOOD);
    assert_eq!(told, from_file);
    let other = post_text(&["-q", "-m", "head-head", "--tool-length", "81"], &text);
    assert_ne!(other.out, from_file.out);
}

#[test]
fn a_file_that_loads_no_tool_is_told_which_it_is() {
    let text = GOOD.replace("LOADTL/1\n", "");
    let refused = post_text(&["-m", "ac-trunnion"], &text);
    assert_eq!(refused.code, 1);
    assert_contains(&refused.err, &["no tool was loaded", "--tool N"]);
    let told = post_text(&["-m", "ac-trunnion", "--tool", "12"], &text);
    assert_eq!(told.code, 0, "{}", told.err);
    assert_contains(&told.out, &["T12 M6", "G43 H12"]);
}

#[test]
fn the_control_or_the_post_keeps_the_tip() {
    let (control, summary) = posted(&["-m", "ac-trunnion", BLADE, "--tcp", "control"]);
    assert_eq!(summary["tcp"], "control");
    assert_contains(&control, &["G43.4 H3", "X-32.211 Y-8.132 Z30.155"]);
    assert!(!control.contains("G93"));
    let (post, summary) = posted(&["-m", "ac-trunnion", BLADE, "--tcp", "post"]);
    assert_eq!(summary["tcp"], "post");
    assert!(!post.contains("G43.4") && post.contains("G93"));
}
