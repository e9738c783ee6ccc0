//! What of a program is more than plain words, read back by the command: cycles of our own programs against the CL file,
//! planes and conversational blocks against arithmetic on paper.

use std::fs;
use std::path::Path;

use nalgebra::Vector3;

use crate::common::{Run, command, run, sample};
use crate::dialects::{dialects, named};

/// A row of the table of motions.
#[derive(Clone, Debug)]
struct Row {
    feed: bool,
    tip: Vector3<f64>,
    /// Words of the rotary axes, degrees, by name.
    fields: Vec<(String, String)>,
}

impl Row {
    fn number(&self, name: &str) -> f64 {
        let field = self.fields.iter().find(|(known, _)| known == name);
        field.unwrap().1.parse().unwrap()
    }
}

fn read(machine: &str, dialect: &str, with: &[&str], program: &Path) -> Run {
    run(
        command()
            .args(["read", "-m", machine, "--dialect", dialect, "--csv", "-"])
            .args(with)
            .arg(program),
        b"",
    )
}

fn rows(done: &Run) -> Vec<Row> {
    let mut lines = done.out.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let rows = lines.map(|line| {
        let fields: Vec<(String, String)> = header
            .iter()
            .map(|name| (*name).to_owned())
            .zip(line.split(',').map(str::to_owned))
            .collect();
        let mut row = Row { feed: false, tip: Vector3::zeros(), fields };
        row.tip = Vector3::from(["tip_x", "tip_y", "tip_z"].map(|name| row.number(name)));
        row.feed = row.fields.iter().any(|(name, kind)| name == "kind" && kind != "rapid");
        row
    });
    rows.collect()
}

/// The bottoms of the holes of a CL file: each point of a cycle, and the depth along the axis below it.
fn bottoms(text: &str) -> Vec<Vector3<f64>> {
    let mut depth = None;
    let mut found = Vec::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split(['/', ',']).map(str::trim).collect();
        match words[0] {
            "CYCLE" => {
                let place = words.iter().position(|word| *word == "DEPTH");
                depth = place.map(|place| words[place + 1].parse::<f64>().unwrap());
            }
            "GOTO" => {
                let numbers: Vec<f64> =
                    words[1..].iter().filter_map(|word| word.parse().ok()).collect();
                let axis = match numbers[..] {
                    [_, _, _, i, j, k] => Vector3::new(i, j, k),
                    _ => Vector3::z(),
                };
                if let Some(depth) = depth {
                    found.push(Vector3::new(numbers[0], numbers[1], numbers[2]) - axis * depth);
                }
            }
            _ => {}
        }
    }
    found
}

#[test]
fn holes_of_our_programs_end_where_the_cl_file_says() {
    let folder = tempfile::tempdir().unwrap();
    let mut seen = 0;
    for (machine, file, with) in [
        ("vmc", "flange.ncl", &[][..]),
        ("ac-trunnion", "wedge.ncl", &["--set", "control.planes=true"]),
        ("ac-trunnion", "wedge.ncl", &["--set", "control.planes=false"]),
    ] {
        let expected = bottoms(&fs::read_to_string(sample(file)).unwrap());
        assert!(expected.len() >= 5);
        for dialect in dialects() {
            let program = folder.path().join(format!("{dialect}.nc"));
            let with: Vec<&str> = ["--tool-length", "100"]
                .iter()
                .chain(named(&dialect))
                .chain(with)
                .copied()
                .collect();
            let written = run(
                command()
                    .args(["-q", "-m", machine, "--dialect", &dialect, "-o"])
                    .arg(&program)
                    .args(&with)
                    .arg(sample(file)),
                b"",
            );
            if written.code != 0 {
                // What this dialect refuses is under review elsewhere.
                continue;
            }
            let done = read(machine, &dialect, &with, &program);
            assert_eq!(done.code, 0, "{dialect} {file}: {}", done.err);
            let cuts: Vec<Row> = rows(&done).into_iter().filter(|row| row.feed).collect();
            let mut at = 0;
            for bottom in &expected {
                let met = cuts[at..].iter().position(|cut| (cut.tip - bottom).norm() < 2e-3);
                let Some(met) = met else {
                    panic!("{dialect} {file}: no hole ends at {bottom:?}");
                };
                at += met + 1;
                seen += 1;
            }
        }
    }
    assert!(seen > 100, "{seen}");
}

fn conversational(machine: &str, with: &[&str], body: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("program.h");
    let mut program = String::from("0 BEGIN PGM TEST MM\n");
    for (number, line) in (1..).zip(body.lines()) {
        program.push_str(&format!("{number} {line}\n"));
    }
    program.push_str("999 END PGM TEST MM\n");
    fs::write(&file, program).unwrap();
    read(machine, "heidenhain", with, &file)
}

/// The table of the iTNC 530 for a machine whose table turns about A and C, and the spatial angle B+45.
#[test]
fn planes_are_turned_to_as_the_table_of_the_control_has_it() {
    let body = |pick: &str| {
        format!(
            "TOOL CALL 1 Z S100\nL A+0 C+0 R0 FMAX\nPLANE SPATIAL SPA+0 SPB+45 SPC+0 TURN FMAX {pick}\nL X+0 Y+0 Z+50 R0 FMAX"
        )
    };
    for (travel, pick, expected) in [
        ("[-120, 120]", "", Some([45.0, 90.0])),
        ("[-120, 120]", "SEQ+", Some([45.0, 90.0])),
        ("[-120, 120]", "SEQ-", Some([-45.0, -90.0])),
        ("[-90, 10]", "", Some([-45.0, -90.0])),
        ("[-90, 10]", "SEQ-", Some([-45.0, -90.0])),
        ("[-90, 10]", "SEQ+", None),
    ] {
        let travel = format!("axis.A.travel={travel}");
        let done =
            conversational("ac-trunnion", &["--tool-length", "100", "--set", &travel], &body(pick));
        let Some(expected) = expected else {
            assert_eq!(done.code, 1, "{travel} {pick}: {}", done.out);
            assert!(done.err.contains("travel"), "{}", done.err);
            continue;
        };
        assert_eq!(done.code, 0, "{travel} {pick}: {}", done.err);
        let rows = rows(&done);
        let last = rows.last().unwrap();
        let stands = ["A", "C"].map(|name| last.number(name));
        assert!(
            stands.iter().zip(expected).all(|(at, to)| (at - to).abs() < 1e-6),
            "{travel} {pick}: {stands:?}"
        );
        // 50 mm along the normal, which lies between X and Z.
        let normal = Vector3::new(0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt());
        assert!((last.tip - normal * 50.0).norm() < 1e-6, "{:?}", last.tip);
    }
}

#[test]
fn words_of_a_plane_that_the_tool_does_not_stand_on_are_refused() {
    let done = conversational(
        "ac-trunnion",
        &["--tool-length", "100"],
        "TOOL CALL 1 Z S100\nPLANE SPATIAL SPA-30 SPB+0 SPC+0 STAY\nL X+0 Y+0 FMAX",
    );
    assert_eq!(done.code, 1);
    assert!(done.err.contains("upright"), "{}", done.err);
    let done = conversational(
        "ac-trunnion",
        &["--tool-length", "100"],
        "TOOL CALL 1 Z S100\nPLANE SPATIAL SPA-30 SPB+0 SPC+0 STAY\nL A+Q120 C+Q122 R0 FMAX\nL X+0 Y+0 Z+10 FMAX",
    );
    assert_eq!(done.code, 0, "{}", done.err);
    let half = 30.0_f64.to_radians();
    let tip = rows(&done).last().unwrap().tip;
    assert!(
        (tip - Vector3::new(0.0, libm::sin(half), libm::cos(half)) * 10.0).norm() < 1e-6,
        "{tip:?}"
    );
}

/// Length of the way of the last motion, mm, from its feed and its time.
fn way(rows: &[Row]) -> f64 {
    let last = rows.last().unwrap();
    last.number("feed") * last.number("minutes")
}

#[test]
fn conversational_curves_are_as_long_as_they_are_on_paper() {
    use std::f64::consts::PI;
    let head = "TOOL CALL 1 Z S100\nL X+10 Y+0 Z+5 R0 FMAX\n";
    for (block, end, length) in [
        ("CC X+0 Y+0\nC X+0 Y+10 DR+ F100", [0.0, 10.0, 5.0], 5.0 * PI),
        ("CC X+0 Y+0\nC X+0 Y+10 DR- F100", [0.0, 10.0, 5.0], 15.0 * PI),
        ("CC X+0 Y+0\nC X+10 Y+0 DR- F100", [10.0, 0.0, 5.0], 20.0 * PI),
        ("CR X+0 Y+10 R+10 DR+ F100", [0.0, 10.0, 5.0], 5.0 * PI),
        ("CR X+0 Y+10 R-10 DR- F100", [0.0, 10.0, 5.0], 15.0 * PI),
        ("CC X+0 Y+0\nCP PA+90 DR+ F100", [0.0, 10.0, 5.0], 5.0 * PI),
        ("CC X+0 Y+0\nCP IPA+720 IZ-4 DR+ F100", [10.0, 0.0, 1.0], libm::hypot(40.0 * PI, 4.0)),
        ("CC IX-10 IY+0\nLP PR+20 PA+90 F100", [0.0, 20.0, 5.0], 500.0_f64.sqrt()),
        // Straight up in Y, then on without a corner: half a turn of radius 5.
        ("L Y+20 F100\nCT X+20 Y+20", [20.0, 20.0, 5.0], 5.0 * PI),
        ("L IY+20 F100", [10.0, 20.0, 5.0], 20.0),
    ] {
        let done = conversational("vmc", &[], &format!("{head}{block}"));
        assert_eq!(done.code, 0, "{block}: {}", done.err);
        let rows = rows(&done);
        let tip = rows.last().unwrap().tip;
        assert!((tip - Vector3::from(end)).norm() < 1e-6, "{block}: {tip:?}");
        assert!((way(&rows) - length).abs() < 1e-3, "{block}: {} instead of {length}", way(&rows));
    }
}

#[test]
fn conversational_programs_call_jump_and_drill() {
    let body = "TOOL CALL 1 Z S100\n\
                L X+0 Y+0 Z+20 R0 FMAX M3\n\
                CYCL DEF 200 DRILLING Q200=+2 Q201=-5 Q206=+100 Q202=+5 Q210=+0 Q203=+0 Q204=+10 Q211=+0\n\
                L X+1 FMAX M99\n\
                L X+2 FMAX\n\
                Q1 = +3\n\
                LBL 5\n\
                L X+Q1 FMAX M99\n\
                FN 1: Q1 = +Q1 + +1\n\
                FN 12: IF +Q1 LT +5 GOTO LBL 5\n\
                CALL LBL 9\n\
                L X+8 FMAX M89\n\
                L X+9 FMAX\n\
                L X+10 FMAX M99\n\
                L X+11 FMAX M30\n\
                LBL 9\n\
                L X+6 FMAX M99\n\
                LBL 0";
    let done = conversational("vmc", &[], body);
    assert_eq!(done.code, 0, "{}", done.err);
    let rows = rows(&done);
    let drilled: Vec<f64> = rows.iter().filter(|row| row.feed).map(|row| row.tip.x).collect();
    assert_eq!(drilled, [1.0, 3.0, 4.0, 6.0, 8.0, 9.0, 10.0]);
    assert!(rows.iter().filter(|row| row.feed).all(|row| row.tip.z == -5.0));
    assert_eq!(rows.last().unwrap().tip, Vector3::new(11.0, 0.0, 10.0));
}

#[test]
fn what_is_not_known_is_refused_by_its_line() {
    for (machine, dialect, program, wanted) in [
        ("vmc", "fanuc", "O1\nG0 X#5021\nM30\n", "#5021"),
        ("vmc", "fanuc", "O1\nM98 P8000\nM30\n", "O8000"),
        ("vmc", "fanuc", "O1\nN1 G0 X0\nGOTO 1\nM30\n", "blocks were read"),
        ("vmc", "fanuc", "O1\nG10 L2 P1 X0 Y0 Z0\nM30\n", "G10"),
        ("vmc", "siemens", "L100\nM30\n", "L100"),
        ("vmc", "siemens", "MYSUB\nM30\n", "MYSUB"),
        ("vmc", "siemens", "R1=$AA_IM[X]\nM30\n", "$AA_IM"),
        ("vmc", "siemens", "POCKET3(1,2,3)\nM30\n", "POCKET3"),
        ("vmc", "heidenhain", "0 BEGIN PGM A MM\n1 CALL PGM OTHER.H\n2 END PGM A MM\n", "OTHER"),
        ("vmc", "heidenhain", "0 BEGIN PGM A MM\n1 FC DR- R10\n2 END PGM A MM\n", "FC"),
        (
            "vmc",
            "heidenhain",
            "0 BEGIN PGM A MM\n1 CYCL DEF 8.0 MIRROR IMAGE\n2 CYCL DEF 8.1 X\n3 END PGM A MM\n",
            "mirror",
        ),
        ("vmc", "heidenhain", "0 BEGIN PGM A MM\n1 L X+Q108 FMAX\n2 END PGM A MM\n", "Q108"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("program.nc");
        fs::write(&file, program).unwrap();
        let done = read(machine, dialect, &["--most-blocks", "2000"], &file);
        assert_eq!(done.code, 1, "{program}: {}", done.out);
        assert!(done.err.contains(wanted), "{program}: {}", done.err);
    }
}
