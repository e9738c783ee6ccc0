//! Where the axes stand for a tool change.

use std::fs;

use crate::common::{command, run};

/// Two tools, both of them leaning.
const LEANING: &str = "UNITS/MM
MULTAX/ON
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/ 0, 0, 150, 0.3, 0.4, 0.8660254
FEDRAT/600,MMPM
GOTO/ 0, 0, 115, 0.3, 0.4, 0.8660254
RAPID
GOTO/ 0, 0, 150, 0.3, 0.4, 0.8660254
LOADTL/2
SPINDL/RPM,2000,CLW
RAPID
GOTO/ 20, 0, 150, 0.3, 0.4, 0.8660254
FEDRAT/600,MMPM
GOTO/ 20, 0, 115, 0.3, 0.4, 0.8660254
RAPID
GOTO/ 20, 0, 150, 0.3, 0.4, 0.8660254
END
FINI
";

/// The blocks ahead of `T2 M6`, the last one first, of a program that `verify` finds good.
#[track_caller]
fn ahead_of_the_change(machine: &str, more: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let text = format!("extends = {machine:?}\n{more}\n");
    fs::write(folder.path().join("m.toml"), text).unwrap();
    fs::write(folder.path().join("part.cls"), LEANING).unwrap();
    let job = ["-m", "m.toml", "--tool-length", "100"];
    let mut post = command();
    post.current_dir(folder.path()).args(["-q", "-o", "part.nc", "part.cls"]);
    let made = run(post.args(job), b"");
    assert_eq!(made.code, 0, "{}", made.err);
    let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    let mut verify = command();
    verify.current_dir(folder.path()).args(["verify", "part.nc", "--against", "part.cls"]);
    let verified = run(verify.args(job), b"");
    assert_eq!(verified.code, 0, "{program}\n{}", verified.err);
    let (ahead, _) = program.split_once("T2 M6\n").expect(&program);
    // For which length the words hold is a remark.
    let blocks = ahead.lines().rev().filter(|line| !line.starts_with('('));
    blocks.map(str::to_owned).collect()
}

#[test]
fn a_head_returns_to_zero_and_a_table_stays() {
    let head = |more: &str| ahead_of_the_change("head-head", more);
    let usual = head("");
    assert_eq!(usual[0], "G53 G0 A0.000 C0.000");
    // The tool is retracted by then.
    let up = usual.iter().position(|block| block.starts_with("G53 G0 Z"));
    let down = usual.iter().position(|block| block.starts_with("G0 Z"));
    assert!(up.is_some() && (down.is_none() || up < down), "{usual:#?}");
    // What the file says counts.
    assert_eq!(head("[control]\npark = { A = 30 }")[0], "G53 G0 A30.000 C0.000");
    assert_eq!(head("[control]\nchange = { C = 90 }")[0], "G53 G0 C90.000");
    assert_eq!(head("[control]\nchange = {}")[0], "M5");
    // Where it cannot stand at 0 nothing is known.
    let far = "[axis.A]\ntravel = [-110, -5]";
    assert_eq!(head(far)[0], "G53 G0 C0.000");
    // The zero that the control shows.
    assert_eq!(
        ahead_of_the_change("mill-turn", "[control]\ntcp = \"control\"")[0],
        "G53 G0 B0.000"
    );
    let table = ahead_of_the_change("ac-trunnion", "[control]\ntcp = \"control\"");
    assert_eq!(table[0], "M5");
}
