//! `post convert` and `post read --cl`: programs moved to another machine make the tool go the same way.

use std::fs;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use post_testkit::shared;
use tempfile::TempDir;

use crate::common::{Run, command, run, sample};

/// Where the tool was at the end of a motion at feed, part frame, as `post read --csv` tells it.
#[derive(Clone, Copy, Debug)]
struct Cut {
    tip: Vector3<f64>,
    axis: Vector3<f64>,
}

fn done(arguments: &[&str]) -> Run {
    let run = run(command().args(arguments), b"");
    assert_eq!(run.code, 0, "post {}\n{}", arguments.join(" "), run.err);
    run
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn cuts(program: &Path, machine: &str) -> Vec<Cut> {
    let run = done(&["read", text(program), "--machine", machine, "--csv", "-"]);
    let mut rows = run.out.lines();
    let names: Vec<&str> = rows.next().unwrap().split(',').collect();
    let place = |name: &str| names.iter().position(|known| *known == name).unwrap();
    let (kind, tip, axis) = (place("kind"), place("tip_x"), place("axis_i"));
    let mut cuts = Vec::new();
    for row in rows {
        let fields: Vec<&str> = row.split(',').collect();
        let at =
            |place: usize| Vector3::from_fn(|row, _| fields[place + row].parse::<f64>().unwrap());
        if fields[kind] == "feed" {
            cuts.push(Cut { tip: at(tip), axis: at(axis) });
        }
    }
    cuts
}

/// Every cut of `first` ends where one of `second` does, in the same order; by how much they are apart at most: mm and
/// radians.
fn apart(first: &[Cut], second: &[Cut]) -> (f64, f64) {
    let (mut tip, mut axis): (f64, f64) = (0.0, 0.0);
    let mut others = second.iter();
    for cut in first {
        let found = others.find(|other| {
            (other.tip - cut.tip).norm() < 0.0011 && (other.axis - cut.axis).norm() < 3e-5
        });
        let Some(other) = found else {
            panic!("no cut ends at {cut:?} in its turn");
        };
        tip = tip.max((other.tip - cut.tip).norm());
        axis = axis.max((other.axis - cut.axis).norm());
    }
    (tip, axis)
}

#[test]
fn the_boat_goes_to_another_trunnion_and_comes_back_as_itself() {
    let Some(boat) = shared("data/nc/linuxcnc_boat-xyzac.ngc") else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let there = folder.path().join("there.ngc");
    let back = folder.path().join("back.ngc");
    for (program, from, to, target) in
        [(&boat, "xyzac-trt", "xyzbc-trt", &there), (&there, "xyzbc-trt", "xyzac-trt", &back)]
    {
        done(&["convert", text(program), "--from", from, "--to", to, "-o", text(target)]);
    }
    let own = cuts(&boat, "xyzac-trt");
    assert_eq!(own.len(), 1739);
    for (program, machine) in [(&there, "xyzbc-trt"), (&back, "xyzac-trt")] {
        let (tip, axis) = apart(&own, &cuts(program, machine));
        // The words of the boat have three decimals, and so have those of the new programs or more.
        assert!(tip <= 0.0005, "{tip} mm");
        assert!(axis <= 2e-5, "{axis}");
    }
}

/// A program of a sample on a machine, its tip kept by `tcp`.
fn posted(folder: &TempDir, machine: &str, tcp: &str, file: &str) -> PathBuf {
    let target = folder.path().join(format!("{machine}-{tcp}-{file}.nc"));
    done(&[
        "-q",
        "-m",
        machine,
        "--tcp",
        tcp,
        "--tool-length",
        "100",
        text(&sample(file)),
        "-o",
        text(&target),
    ]);
    target
}

#[test]
fn five_axis_programs_go_from_machine_to_machine_with_and_without_tool_centre_point_control() {
    let folder = tempfile::tempdir().unwrap();
    let machines = ["ac-trunnion", "dmu50", "head-head", "head-table-ba", "bc-trunnion"];
    for from in machines {
        for tcp in ["control", "post"] {
            let program = posted(&folder, from, tcp, "blade.cls");
            for to in machines {
                for keeps in ["control", "post"] {
                    let target = folder.path().join("target.nc");
                    let set = format!("control.tcp={tcp}");
                    // It is held against the first program, or has no name.
                    done(&[
                        "convert",
                        text(&program),
                        "--from",
                        from,
                        "--from-set",
                        &set,
                        "--tool-length",
                        "100",
                        "--to",
                        to,
                        "--tcp",
                        keeps,
                        "-o",
                        text(&target),
                    ]);
                    fs::remove_file(target).unwrap();
                }
            }
        }
    }
}

#[test]
fn holes_arcs_and_compensation_come_over_as_such() {
    let folder = tempfile::tempdir().unwrap();
    let program = posted(&folder, "vmc", "post", "plate.ncl");
    let cl = folder.path().join("plate.cls");
    let target = folder.path().join("target.nc");
    done(&[
        "convert",
        text(&program),
        "--from",
        "vmc",
        "--tool-length",
        "100",
        "--to",
        "ac-trunnion",
        "--cl",
        text(&cl),
        "-o",
        text(&target),
    ]);
    let cl = fs::read_to_string(cl).unwrap();
    for record in
        ["LOADTL/", "LENGTH,100", "CYCLE/", "SPINDL/RPM,", "COOLNT/", "FEDRAT/MMPM,", "FINI"]
    {
        assert!(cl.contains(record), "{record} is missing in\n{cl}");
    }
    // The CL file of a program is that which `read` writes.
    let read =
        done(&["read", text(&program), "--machine", "vmc", "--tool-length", "100", "--cl", "-"]);
    let points = |cl: &str| cl.lines().filter(|line| line.starts_with("GOTO/")).count();
    assert_eq!(points(&read.out), points(&cl));
}

#[test]
fn what_no_cl_file_has_a_word_for_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("smooth.mpf");
    let words = "G71 G90 G17 G94\nT1 M6\nS1000 M3\nG0 X0 Y0 Z50 D1\nCYCLE832(0.02,1,1)\nG1 X10 F100\n\
                 X20 Y5\nCYCLE832()\nG0 Z50\nM30\n";
    fs::write(&program, words).unwrap();
    let target = folder.path().join("target.nc");
    let run = done(&[
        "convert",
        text(&program),
        "--from",
        "vmc",
        "--from-set",
        "control.dialect=siemens",
        "--to",
        "vmc",
        "--tool-length",
        "80",
        "-o",
        text(&target),
    ]);
    assert!(run.err.contains("warning[convert]"), "{}", run.err);
    assert!(run.err.contains("CYCLE832"), "{}", run.err);
}

#[test]
fn a_program_that_leaves_the_travel_is_not_read_as_good() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("far.nc");
    let words = "G21 G17 G90 G94\nT1 M6\nS1000 M3\nG0 G43 H1 X900. Y0. Z50.\nG1 X10. F100.\nM30\n";
    fs::write(&program, words).unwrap();
    let seat = ["--mount", "0,0,0"];
    let arguments = ["read", text(&program), "-m", "vmc", "--tool-length", "80"];
    let placed = run(command().args(arguments).args(seat), b"");
    assert_eq!(placed.code, 1, "{}", placed.out);
    let said = "error[over-travel]: X would be at 900.000 mm";
    assert!(placed.err.contains(said), "{}", placed.err);
    // Where nobody says where the part sits, the way is short enough for some place.
    let anywhere = run(command().args(arguments), b"");
    assert_eq!(anywhere.code, 0, "{}", anywhere.err);
}

#[test]
fn a_program_that_the_other_machine_cannot_make_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let program = posted(&folder, "ac-trunnion", "control", "blade.cls");
    let target = folder.path().join("target.nc");
    let run = run(
        command().args([
            "convert",
            text(&program),
            "--from",
            "ac-trunnion",
            "--to",
            "vmc",
            "-o",
            text(&target),
        ]),
        b"",
    );
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(!target.exists());
    // Nor is a block that is not understood passed over.
    let odd = folder.path().join("odd.nc");
    let text_of = fs::read_to_string(&program).unwrap();
    fs::write(&odd, text_of.replacen("G1", "G999 G1", 1)).unwrap();
    let run = crate::common::run(
        command().args([
            "convert",
            text(&odd),
            "--from",
            "ac-trunnion",
            "--to",
            "dmu50",
            "-o",
            text(&target),
        ]),
        b"",
    );
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.err.contains("G999"), "{}", run.err);
    assert!(!target.exists());
}

/// D1 of a control whose tools have edges is no register of another: each tool has its own H.
#[test]
fn an_edge_becomes_no_register() {
    let folder = TempDir::new().unwrap();
    let at = |name: &str| folder.path().join(name);
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100\nGOTO/0,0,0\nGOTO/10,0,0\nRAPID\n\
              GOTO/10,0,50\nLOADTL/2\nSPINDL/1000,CLW\nRAPID\nGOTO/20,0,50\nFEDRAT/100\nGOTO/20,0,0\nGOTO/30,0,0\nRAPID\n\
              GOTO/30,0,50\nFINI\n";
    fs::write(at("two.cls"), cl).unwrap();
    let (cl, siemens, fanuc) = (at("two.cls"), at("two.mpf"), at("two.nc"));
    let length = ["--tool-length", "80"];
    let posted = ["-m", "ac-trunnion-840d", text(&cl), "-o", text(&siemens)];
    done(&[&posted[..], &length].concat());
    let from = ["--from", "ac-trunnion-840d", "--to", "ac-trunnion"];
    let converted = ["convert", text(&siemens), "-o", text(&fanuc)];
    done(&[&converted[..], &from, &length].concat());
    let program = fs::read_to_string(&fanuc).unwrap();
    assert!(program.contains("H1") && program.contains("H2"), "{program}");
}
