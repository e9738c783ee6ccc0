//! Memory must not grow with the file. Linux alone: the peak is read from /proc while the command runs.

use crate::{common, generate, peak};

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// A finishing pass of so many points.
fn wave(folder: &Path, points: u64) -> PathBuf {
    let path = folder.join("wave.cls");
    let mut file = BufWriter::new(File::create(&path).unwrap());
    generate::write_file(&mut file, points).unwrap();
    file.into_inner().unwrap();
    path
}

/// Peak of the resident memory of a run on the machine of the test, kB.
fn peak(arguments: &[&OsStr]) -> u64 {
    peak_on(&["-m", "ac-trunnion", "--tcp", "control"], arguments)
}

/// The same on the machine that `machine` says.
fn peak_on(machine: &[&str], arguments: &[&OsStr]) -> u64 {
    peak::of(common::command().args(arguments).arg("-q").args(machine)).unwrap()
}

#[test]
fn memory_does_not_grow_with_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let [small, large] =
        [100_000, 300_000].map(|points| peak(&[wave(folder.path(), points).as_os_str()]));
    assert!(small > 0, "no look at the running command succeeded");
    assert!(
        large < small + small / 10 + 1024,
        "{small} kB for 100,000 points, {large} kB for 300,000"
    );
    assert!(large < 64 * 1024, "{large} kB");
}

/// Holes of a thousand pecks each, beside one another.
fn deep_holes(folder: &Path, holes: u32) -> PathBuf {
    let path = folder.join("holes.cls");
    let mut text = String::from(
        "PARTNO/HOLES\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,8000,CLW\nRAPID\nGOTO/0,0,40,0,0,1\n\
         CYCLE/DEEP,DEPTH,10,STEP,0.01,CLEAR,2,MMPM,300\n",
    );
    for hole in 0..holes {
        text += &format!("GOTO/{},{},20\n", 5 * (hole % 20), 3 * (hole / 20));
    }
    fs::write(&path, text + "CYCLE/OFF\nRAPID\nGOTO/0,0,60\nFINI\n").unwrap();
    path
}

/// A knife waits for the direction that it will go in: for so many moves, not for so many holes.
#[test]
fn memory_does_not_grow_with_the_holes_of_a_knife() {
    let folder = tempfile::tempdir().unwrap();
    let knife = ["-m", "ultrasonic-knife", "--tool-length", "50"];
    let [small, large] =
        [60, 240].map(|holes| peak_on(&knife, &[deep_holes(folder.path(), holes).as_os_str()]));
    assert!(large < small + small / 10 + 2048, "{small} kB for 60 holes, {large} kB for 240");
    assert!(large < 32 * 1024, "{large} kB");
}

#[test]
fn memory_does_not_grow_with_the_report() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("report.html");
    let flag = OsStr::new("--report");
    let [small, large] = [100_000, 300_000]
        .map(|points| peak(&[wave(folder.path(), points).as_os_str(), flag, page.as_os_str()]));
    assert!(
        large < small + small / 10 + 1024,
        "{small} kB for 100,000 points, {large} kB for 300,000"
    );
    assert!(large < 128 * 1024, "{large} kB");
}

/// Sixteen times the blocks, with pictures, percentiles and the CL path: what is drawn and counted has its size.
#[test]
fn memory_of_a_prediction_does_not_grow_with_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("wave.nc");
    let pictures = folder.path().join("pictures");
    let [small, large] = [10_000, 160_000].map(|points| {
        let path = wave(folder.path(), points);
        peak(&["-o".as_ref(), program.as_ref(), path.as_ref()]);
        peak(&[
            "predict".as_ref(),
            program.as_ref(),
            "--against".as_ref(),
            path.as_ref(),
            "--tool-length=0".as_ref(),
            "--pictures".as_ref(),
            pictures.as_ref(),
        ])
    });
    assert!(small > 0, "no look at the running command succeeded");
    assert!(
        large < small + small / 10 + 1024,
        "{small} kB for 10,000 points, {large} kB for 160,000"
    );
    assert!(large < 64 * 1024, "{large} kB");
}

/// Twelve times the blocks: times of tasks that were told are let go, and are not gone through again.
#[test]
fn memory_of_looking_a_program_over_does_not_grow_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("wave.nc");
    let machine = ["-m", "ac-trunnion"];
    let [small, large] = [20_000, 240_000].map(|points| {
        let path = wave(folder.path(), points);
        peak_on(
            &[&machine[..], &["--tcp", "post"]].concat(),
            &["-o".as_ref(), program.as_ref(), path.as_ref(), "--tool-length=100".as_ref()],
        );
        let mut lint = common::command();
        lint.arg("lint").arg(&program).args(machine).arg("--tool-length=100");
        peak::of(&mut lint).unwrap()
    });
    assert!(small > 0, "no look at the running command succeeded");
    assert!(
        large < small + small / 10 + 1024,
        "{small} kB for 20,000 points, {large} kB for 240,000"
    );
}

/// A parser that finds little stack says that a good file is wrong.
#[test]
fn a_small_stack_of_the_shell_changes_nothing() {
    let words = format!("{} -m ac-trunnion -o - tests/samples/blade.cls", common::BINARY);
    let with = |limit: &str| {
        let line = format!("ulimit -s {limit} && exec {words}");
        common::run(common::command_as("sh").args(["-c", &line]), b"")
    };
    let plain = with("8192");
    assert_eq!(plain.code, 0, "{}", plain.err);
    for limit in ["256", "64"] {
        let small = with(limit);
        assert_eq!((small.code, &small.out), (0, &plain.out), "{limit}: {}", small.err);
    }
}
