//! Arcs of programs on a chain whose axes do not stand exactly across one another: the control interpolates in its words,
//! and the tip goes where the axes take it.

use std::fs;

use tempfile::TempDir;

use crate::common::post_in;

/// A full circle of 20 mm about the origin at Z0, and half a turn of a helix out of it.
const CIRCLE: &str = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z20.\nT1 M6\nS3000 M3\nG54\nG0 X20. Y0.\nG43 H1 Z5.\n\
    G1 Z0. F500.\nG3 X20. Y0. I-20. J0.\nG3 X-20. Y0. Z4. I-20. J0.\nG0 Z5.\nG53 G0 Z20.\nM30\n%\n";

/// A mill whose X leans towards Y by so much, with an end mill of 5 mm, and a rail from `y` on.
fn folder(lean: f64, y: f64) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let machine = format!(
        "extends = \"vmc\"\nname = \"leans\"\n[axis.X]\nlinear = [1, {lean}, 0]\n\
         [tools.1]\nlength = 100\ncutter = [[0, 5], [40, 5]]\n\
         [fixture.rail]\nblock = [[-60, {y}, -310], [60, {}, -290]]\n",
        y + 10.0
    );
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.nc"), CIRCLE).unwrap();
    folder
}

const WORDS: [&str; 6] = ["part.nc", "-m", "mine.toml", "--mount", "0,0,-300", "--set"];

/// How far the tip comes in Y with X along (1, lean): the largest of lean·x + y on the circle.
fn reach(lean: f64) -> f64 {
    let length = libm::hypot(1.0, lean);
    20.0 * libm::hypot(lean / length, 1.0)
}

#[test]
fn a_circle_becomes_what_the_axes_make_of_it() {
    for lean in [0.00002, 0.001, 0.1] {
        for (off, clear) in [(0.03, true), (-0.03, false)] {
            let folder = folder(lean, reach(lean) + 5.0 + off);
            let words = [&["clearance"], &WORDS[..5]].concat();
            let run = post_in(folder.path(), &words);
            assert!(!run.err.contains("nc-arc"), "{}", run.err);
            assert_eq!(run.code == 0, clear, "{lean} {off}: {}{}", run.out, run.err);
        }
    }
    // Where the axes stand across one another the rail is met as late: the circle reaches 20 mm.
    assert!((reach(0.0) - 20.0).abs() < 1e-12 && reach(0.1) > 20.09);
}

#[test]
fn other_posts_arcs_are_read_and_held_against_the_cl_file() {
    let cl = "PARTNO/A\nUNITS/MM\nCUTTER/10\nLOADTL/1\nSPINDL/3000,CLW\nRAPID\nGOTO/20,0,5\nFEDRAT/500,MMPM\nGOTO/20,0,0\n\
              CIRCLE/0,0,0,0,0,1,20\nGOTO/20,0,0\nRAPID\nGOTO/20,0,5\nFINI\n";
    let program = CIRCLE.replace("G3 X-20. Y0. Z4. I-20. J0.\n", "");
    for (lean, holds) in [(0.00002, true), (0.002, false)] {
        let folder = folder(lean, 100.0);
        fs::write(folder.path().join("part.nc"), &program).unwrap();
        fs::write(folder.path().join("part.cls"), cl).unwrap();
        let words =
            ["verify", "part.nc", "-m", "mine.toml", "--mount", "0,0,0", "--against", "part.cls"];
        let run = post_in(folder.path(), &words);
        let said = format!("{}{}", run.out, run.err);
        assert!(!said.contains("nc-arc"), "{said}");
        // 20 mm times two thousandths: 40 µm, beyond the tolerance of 5.
        assert_eq!(said.contains("error[deviation]"), !holds, "{lean}: {said}");
    }
    let folder = folder(0.001, 100.0);
    let words = ["read", "part.nc", "-m", "mine.toml", "--mount", "0,0,0", "--cl", "back.cls"];
    let run = post_in(folder.path(), &words);
    assert_eq!(run.code, 0, "{}", run.err);
    let back = fs::read_to_string(folder.path().join("back.cls")).unwrap();
    // The words of all points are on the circle.
    let points = back.lines().filter_map(|line| line.strip_prefix("GOTO/")?.strip_suffix(",0"));
    let radii = points.map(|point| {
        let [x, y] =
            [0, 1].map(|place| point.split(',').nth(place).unwrap().parse::<f64>().unwrap());
        libm::hypot(x * libm::hypot(1.0, 0.001), y - 0.001 * x)
    });
    let radii: Vec<f64> = radii.collect();
    assert!(
        radii.len() > 20 && radii.iter().all(|radius| (radius - 20.0).abs() < 1e-4),
        "{radii:?}"
    );
}

/// Ahead of the block in which the control begins to keep the tip X and Y would be words of slides, and those lean.
#[test]
fn the_tip_comes_to_its_first_point_where_a_slide_leans_and_the_control_keeps_it() {
    let folder = tempfile::tempdir().unwrap();
    let machine = "name = \"leans\"\nchain = \"[w b X Z Y B (S) t]\"\ntool.gauge = [0, 0, 400]\n\
                   control = { dialect = \"mazak\", tcp = \"control\" }\n\
                   [axis.X]\nlinear = [1, 0, 0]\ntravel = [-1000, 1000]\n\
                   [axis.Y]\nlinear = [-0.009, 1, 0]\ntravel = [-1000, 1000]\n\
                   [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-1000, 1000]\n\
                   [axis.B]\nrotary = [0, 1, 0]\npoint = [0, 0, 550]\ntravel = [-90, 90]\n";
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/16,-30,50,0,0,1\nFEDRAT/500,MMPM\n\
              GOTO/16,-30,40,0,0,1\nGOTO/30,-20,40,0,0,1\nRAPID\nGOTO/30,-20,60,0,0,1\nFINI\n";
    fs::write(folder.path().join("mine.toml"), machine).unwrap();
    fs::write(folder.path().join("part.cls"), cl).unwrap();
    let words =
        ["-m", "mine.toml", "part.cls", "-o", "part.nc", "--tool-length", "100", "--verify"];
    let run = post_in(folder.path(), &words);
    assert_eq!(run.code, 0, "{}", run.err);
    let program = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert!(program.contains("G43.4 H1 X16.000 Y-30.000 Z"), "{program}");
}
