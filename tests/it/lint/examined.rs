//! What an examiner of `post lint`, `read` and `predict` found, each on the program that he found it with.

use std::fs;

use post_testkit::assert_contains;

use crate::common::post_in;

/// A folder with programs.
fn folder(programs: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in programs {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Positions of the machine are where they are, wherever the part sits.
#[test]
fn machine_positions_beyond_travel_are_told_where_nobody_says_where_the_part_sits() {
    let fanuc = |z: f64, x: f64| {
        format!("%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z{z:.1}\nG53 G0 X{x:.1}\nM30\n%\n")
    };
    let siemens = |z: f64, x: f64| {
        format!("G90 G71 G17 G40 G94\nG500\n\nG0 SUPA Z{z:.1} D0\nG0 SUPA X{x:.1} D0\nM30\n")
    };
    for (machine, dialect) in
        [("vmc", "fanuc"), ("router", "fanuc"), ("grbl-router", "fanuc"), ("vmc", "siemens")]
    {
        let text = |z, x| if dialect == "fanuc" { fanuc(z, x) } else { siemens(z, x) };
        let folder = folder(&[("far.nc", &text(500.0, 5000.0)), ("near.nc", &text(-5.0, 50.0))]);
        let dialect = format!("control.dialect=\"{dialect}\"");
        let verb = |verb: &str, file: &str| {
            post_in(folder.path(), &[verb, file, "-m", machine, "--set", &dialect])
        };
        for what in ["lint", "read"] {
            let far = verb(what, "far.nc");
            assert_eq!(far.code, 1, "{what} {machine} {dialect}: {}{}", far.out, far.err);
            assert_contains(
                &far.err,
                &[
                    "error[over-travel]: Z would be at 500.000",
                    "X would be at 5000.000",
                    "2 errors",
                ],
            );
            assert_contains(&far.err, &["far.nc:4", "far.nc:5"]);
            let near = verb(what, "near.nc");
            assert_eq!(near.code, 0, "{what} {machine} {dialect}: {}{}", near.out, near.err);
            assert!(!near.err.contains("over-travel"), "{}", near.err);
        }
    }
}
