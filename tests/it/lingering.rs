//! Many points of a CL file within the tolerance of one place, and the program held against it.

use std::fmt::Write as _;
use std::fs;

use crate::common::post;

/// A cut to X10, `count` points there, each `apart` mm beside the one before it, and a cut to X20: posted, and held against
/// its own file.
fn verified(count: usize, apart: f64) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (course, program) = (place("linger.cls"), place("linger.h"));
    let mut text = "PARTNO/LINGER\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,5000,CLW\nRAPID\n\
                    GOTO/0,0,50,0,0,1\nFEDRAT/1000,MMPM\nGOTO/0,0,0,0,0,1\n"
        .to_owned();
    for index in 0..count {
        let x = 10.0 + apart * (index % 2) as f64;
        writeln!(text, "GOTO/{x:.6},0,0,0,0,1").unwrap();
    }
    text.push_str("GOTO/20,0,0,0,0,1\nRAPID\nGOTO/0,0,50,0,0,1\nSPINDL/OFF\nEND\nFINI\n");
    fs::write(&course, text).unwrap();
    let made = post(&["-q", "-m", "dmu50", "--tool-length", "100", "-o", &program, &course]);
    assert_eq!(made.code, 0, "{}", made.err);
    let run =
        post(&["verify", &program, "--against", &course, "-m", "dmu50", "--tool-length", "100"]);
    (run.code, run.err)
}

#[test]
fn a_program_is_not_lost_where_its_file_names_one_point_seventy_thousand_times() {
    let (code, told) = verified(70_000, 0.0);
    assert_eq!(code, 0, "{told}");
}

#[test]
fn a_program_whose_place_cannot_be_told_is_said_to_be_lost_and_not_judged() {
    let (code, told) = verified(12_000, 0.002);
    assert_eq!(code, 1, "{told}");
    assert!(told.starts_with("error[lost]"), "{told}");
    assert!(told.contains("more than 10000 pieces"), "{told}");
    assert!(told.contains("1 error"), "{told}");
}

/// One motion is held against more pieces of the path than one place may be.
#[test]
fn a_large_circle_is_no_place_where_a_program_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (course, program) = (place("large.cls"), place("large.nc"));
    let text = "PARTNO/LARGE\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/1500,0,50\nFEDRAT/500,MMPM\n\
                GOTO/1500,0,0\nCIRCLE/0,0,0,0,0,1,1500\nGOTO/1500,0,0\nRAPID\nGOTO/1500,0,50\nFINI\n";
    fs::write(&course, text).unwrap();
    let words =
        ["-q", "-m", "head-head", "--tool-length", "100", "--verify", "-o", &program, &course];
    let run = post(&words);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(fs::read_to_string(&program).unwrap().contains("G3 X1500."));
}
