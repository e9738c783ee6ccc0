//! Splines that a dialect writes are read back: by every dialect that has them, on machines of each kind, whoever keeps
//! the tip; and a wrong control point, weight or knot is found.

use std::fs;
use std::path::Path;

use crate::common::{command, post, run};
use crate::dialects;

/// Two cuts along splines, the second from a place beside the origin and with knots of its own.
const SPLINES: &str = "UNITS/MM
LOADTL/1
SPINDL/1000,CLW
RAPID
GOTO/10,0,30
FEDRAT/400,MMPM
GOTO/10,0,0
NURBS
KNOT/1
CNTRL/10,5,0
CNTRL/5,10,0
CNTRL/0,10,0
GOTO/-20,10,0
NURBS
KNOT/0.5,1
CNTRL/-20,20,0
CNTRL/-30,25,0
CNTRL/-25,35,0
CNTRL/-20,40,0
RAPID
GOTO/-20,40,50
FINI
";

/// Words of splines.
const WORDS: &[&str] = &["G6.2", "G5.2"];

fn written(folder: &Path, dialect: &str, machine: &str, tcp: &str) -> Option<String> {
    let option = format!("control.{dialect}.splines=true");
    let run = run(
        command()
            .current_dir(folder)
            .args(["-q", "-m", machine, "--dialect", dialect, "--tcp", tcp])
            .args(["--set", &option, "--tool-length", "100"])
            .args(["part.cls", "-o", "-"]),
        b"",
    );
    let lines = run.out.lines();
    let splines = lines.filter(|line| WORDS.iter().any(|word| line.contains(word)));
    (run.code == 0 && splines.count() == 2).then_some(run.out)
}

fn verified(folder: &Path, dialect: &str, machine: &str, tcp: &str, text: &str) -> (i32, String) {
    fs::write(folder.join("part.nc"), text).unwrap();
    let run = run(
        command()
            .current_dir(folder)
            .args(["verify", "part.nc", "-m", machine, "--dialect", dialect])
            .args(["--tcp", tcp, "--tool-length", "100"])
            .args(["--against", "part.cls"]),
        b"",
    );
    (run.code, run.err)
}

#[test]
fn each_dialect_that_writes_splines_reads_them_back() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("part.cls"), SPLINES).unwrap();
    let mut found = Vec::new();
    for dialect in dialects::DIALECTS.iter() {
        let shown = post(&["plugin", "show", dialect]);
        if !shown.out.contains("splines") {
            continue;
        }
        for machine in ["vmc", "ac-trunnion", "head-head", "head-table-bc"] {
            for tcp in ["post", "control"] {
                let Some(text) = written(folder, dialect, machine, tcp) else {
                    continue;
                };
                let (code, told) = verified(folder, dialect, machine, tcp, &text);
                assert_eq!(code, 0, "{dialect} {machine} {tcp}\n{told}\n{text}");
                found.push(format!("{dialect} {machine} {tcp}"));
                for (line, wrong) in wrong(&text) {
                    let (code, told) = verified(folder, dialect, machine, tcp, &wrong);
                    assert_ne!(code, 0, "{dialect} {machine} {tcp}: {line}\n{told}");
                }
            }
        }
    }
    for dialect in ["fanuc", "linuxcnc"] {
        for machine in ["vmc", "ac-trunnion", "head-head"] {
            let row = format!("{dialect} {machine} post");
            assert!(found.contains(&row), "{row} is none of {found:#?}");
        }
    }
}

/// The program with another digit in one word of a spline, and without one of its blocks: the line that it is about.
fn wrong(text: &str) -> Vec<(String, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut wrong = Vec::new();
    let mut within = false;
    for (place, line) in lines.iter().enumerate() {
        within |= WORDS.iter().any(|word| line.contains(word));
        within &= !(line.starts_with("G1 ") || line.starts_with("G0 ") || line.contains("G5 P0"));
        if !within || line.starts_with("G5.3") {
            continue;
        }
        let mut put = |new: Option<String>| {
            let mut changed: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
            match &new {
                Some(new) => changed[place].clone_from(new),
                None => drop(changed.remove(place)),
            }
            let told = format!("{line} becomes {new:?}");
            wrong.push((told, changed.join("\n") + "\n"));
        };
        for word in line.split(' ').filter(|word| word.starts_with(['X', 'Y', 'K', 'R'])) {
            let number: f64 = word[1..].parse().unwrap();
            // Knots count from 0 to 1000.
            let by = if word.starts_with('K') { 200.0 } else { 1.0 };
            let new = format!("{}{:.3}", &word[..1], number + by);
            put(Some(line.replacen(word, &new, 1)));
        }
        put(None);
    }
    assert!(wrong.len() > 10, "{text}");
    wrong
}
