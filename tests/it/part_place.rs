//! A mill without rotary axes whose part sits where nobody says: the program is the same wherever it is clamped, so that
//! travel is a warning, unless the part fits nowhere.

use crate::common;

use std::fs;

use common::{Run, command, run};
use tempfile::TempDir;

/// A slot from X 400 to `to`, at Z 0.
fn slot(to: f64) -> String {
    format!(
        "UNITS/MM\nLOADTL/5\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/400,10,50\nFEDRAT/600,MMPM\nGOTO/400,10,0\nGOTO/{to},10,0\n\
         RAPID\nGOTO/{to},10,50\nEND\nFINI\n"
    )
}

struct Bench(TempDir);

impl Bench {
    fn new(cl: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("part.cls"), cl).unwrap();
        Self(folder)
    }

    fn run(&self, arguments: &[&str]) -> Run {
        run(command().current_dir(self.0.path()).args(arguments), b"")
    }

    fn post(&self, more: &[&str]) -> Run {
        self.run(&[&["part.cls", "-m", "vmc", "-o", "part.nc", "-q"][..], more].concat())
    }

    fn program(&self) -> String {
        fs::read_to_string(self.0.path().join("part.nc")).unwrap()
    }
}

#[test]
fn where_a_part_may_sit_anywhere_its_travel_is_one_warning() {
    let bench = Bench::new(&slot(700.0));
    let long = ["--tool-length", "100"];
    let told = bench.post(&[&long[..], &["--verify"]].concat());
    assert_eq!(told.code, 0, "{}", told.err);
    assert_eq!(told.err.matches("warning[").count(), 1, "{}", told.err);
    assert_eq!(told.err.matches("-->").count(), 0, "{}", told.err);
    // Of -510 to 510.
    let room = "warning[part-place]: nobody says where the part sits; this much travel the program needs: X 400.000 to \
                700.000 mm of -510.000 to 510.000 with the part origin at 0.000, inside with it from -910.000 to -190.000";
    assert!(told.err.contains(room), "{}", told.err);
    let anywhere = bench.program();
    let verify = ["verify", "part.nc", "-m", "vmc", "--against", "part.cls"];
    let read = bench.run(&[&verify[..], &long].concat());
    assert_eq!(read.code, 0, "{}", read.err);
    assert!(read.err.contains(room), "{}", read.err);
    // The ends of that room, and past them.
    for (x, code) in [("-910", 0), ("-190", 0), ("-911", 1), ("-189", 1), ("0", 1)] {
        let mount = format!("{x},0,0");
        let placed = bench.post(&[&long[..], &["--mount", &mount]].concat());
        assert_eq!(placed.code, code, "{x}: {}", placed.err);
        assert_eq!(bench.program(), anywhere, "{x}");
        if code == 1 {
            assert!(placed.err.contains("error[over-travel]: X would be"), "{}", placed.err);
        }
    }
}

#[test]
fn a_part_that_fits_nowhere_is_refused() {
    let bench = Bench::new(&slot(1500.0));
    let done = bench.post(&["--tool-length", "100"]);
    assert_eq!(done.code, 1, "{}", done.err);
    let fits = "error[over-travel]: X goes 1100.000 mm, from 400.000 (line 5) to 1500.000 mm (line 8), and its travel is 1020.000 mm";
    assert!(done.err.contains(fits) && done.err.contains("part.cls:8\n"), "{}", done.err);
    // A program of another hand is refused by its own lines.
    let near = Bench::new(&slot(700.0));
    near.post(&["--tool-length", "100"]);
    let long = near.program().replace("X700.000", "X1500.000");
    fs::write(near.0.path().join("part.nc"), &long).unwrap();
    fs::write(near.0.path().join("part.cls"), slot(1500.0)).unwrap();
    let read =
        near.run(&["verify", "part.nc", "-m", "vmc", "--against", "part.cls", "--tool-length=100"]);
    assert_eq!(read.code, 1, "{}", read.err);
    let told = "error[over-travel]: X goes 1100.000 mm, from 400.000 (line ";
    assert!(read.err.contains(told) && read.err.contains("part.nc:"), "{}", read.err);
}

#[test]
fn lengths_that_nobody_gives_are_one_warning_too() {
    let bench = Bench::new(&slot(420.0).replace(
        "END\n",
        "LOADTL/7\nSPINDL/RPM,900,CLW\nRAPID\nGOTO/410,0,50\nFEDRAT/600,MMPM\nGOTO/410,0,0\nEND\n",
    ));
    let done = bench.post(&[]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(done.err.matches("warning[").count(), 1, "{}", done.err);
    let tools =
        "warning[tool-length]: no length of tool 5, tool 7 is known: travel was checked with 0 mm";
    assert!(done.err.contains(tools), "{}", done.err);
    assert!(!done.err.contains("-->"), "{}", done.err);
}
