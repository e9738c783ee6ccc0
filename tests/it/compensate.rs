//! `post --compensate-servo`: points are moved by no more than the machine file allows, nothing else is, and what is told
//! of it is what `post predict` says of the program.

use std::fmt::Write as _;
use std::fs;

use nalgebra::Vector3;
use post_testruns::read_back::{Model, angle, blocks, overlay, points, table};
use serde_json::Value;
use tempfile::TempDir;
use toml::Table;

use crate::common::{self, Run, assert_contains, post_in, read_json, root};

/// Servos that follow so softly that a circle of 20 mm at 3 m/min comes out 0.9 mm too small, and 39 µm.
const SOFT: &str = "transfer]\nnumerator = [8]\ndenominator = [1, 8]\n";
const LATE: &str = "transfer]\nnumerator = [40]\ndenominator = [1, 40]\n";

/// Servos of 8 ms, whose error on the same circle is 3 µm.
const STIFF: &str = "transfer]\nnumerator = [140]\ndenominator = [1, 140]\n";

/// The last digit of a linear word, mm.
const DIGIT: f64 = 0.001;

/// A folder with a machine that refines one of the library, and the samples.
fn folder(machine: &str) -> TempDir {
    let folder = common::with_file("mill.toml", machine);
    for sample in ["s-piece.cls", "blade.cls", "flange.ncl", "facets.apt"] {
        fs::copy(root().join("tests/samples").join(sample), folder.path().join(sample)).unwrap();
    }
    folder
}

fn trunnion(bound: f64) -> TempDir {
    folder(&format!("extends = \"ac-trunnion\"\n[accuracy]\nservo_compensation = {bound}\n"))
}

/// A mill of three axes, and a circle of one and a half turns by points, between rapids and holes.
fn mill(dialect: &str, servo: &str, bound: &str) -> TempDir {
    let mut machine = format!("extends = \"vmc\"\n[control]\ndialect = \"{dialect}\"\n{bound}");
    for axis in ["X", "Y", "Z"] {
        let _ = write!(machine, "[servo.{axis}.{servo}");
    }
    let folder = folder(&machine);
    fs::write(folder.path().join("circle.cls"), circle()).unwrap();
    folder
}

fn circle() -> String {
    let mut text = String::from(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/20,0,30,0,0,1\nRAPID\nGOTO/20,0,1\n\
         FEDRAT/MMPM,600\nGOTO/20,0,-2\nFEDRAT/MMPM,3000\n",
    );
    for step in 1..=360 {
        let (sin, cos) = libm::sincos(f64::from(step) * std::f64::consts::PI / 120.0);
        let _ = writeln!(text, "GOTO/{:.4},{:.4},-2", 20.0 * cos, 20.0 * sin);
    }
    text.push_str(
        "RAPID\nGOTO/-20,0,30\nLOADTL/2\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/40,0,30\n\
         CYCLE/DRILL,DEPTH,5,MMPM,200,CLEAR,2\nGOTO/40,0,0\nGOTO/40,10,0\nCYCLE/OFF\nRAPID\nGOTO/40,10,30\nFINI\n",
    );
    text
}

const BOUND: &str = "[accuracy]\nservo_compensation = 0.003\n";

fn run(folder: &TempDir, more: &[&str]) -> Run {
    let job = ["-m", "./mill.toml", "--tool-length", "80"];
    post_in(folder.path(), &[more, &job].concat())
}

/// Posts a file, with compensation too; must succeed. Program without, program with, and what the summary says.
fn both(folder: &TempDir, file: &str, more: &[&str]) -> (String, String, Value) {
    let plain = run(folder, &[&[file, "-q", "-o", "plain.nc"], more].concat());
    assert_eq!(plain.code, 0, "{}", plain.err);
    let arguments = [file, "-q", "-o", "part.nc", "--compensate-servo", "--summary", "found.json"];
    let moved = run(folder, &[&arguments, more].concat());
    assert_eq!(moved.code, 0, "{}", moved.err);
    let text = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let found = read_json(&folder.path().join("found.json"));
    (
        text("plain.nc"),
        text("part.nc").replace("(PART)", "(PLAIN)"),
        found["servo_compensation"].clone(),
    )
}

fn number(found: &Value, path: &str) -> f64 {
    let value = found.pointer(path).unwrap_or_else(|| panic!("{path} of {found}"));
    value.as_f64().unwrap()
}

/// The machine, by the reader that shares no code with the command.
fn model(base: &str, tcp: &str) -> (Model, Vec<String>) {
    let mut machine = table(base);
    let more: Table = format!("[control]\ntcp = \"{tcp}\"").parse().unwrap();
    overlay(&mut machine, more);
    let model = Model::from_table(machine, None);
    let names = model.axes.iter().map(|axis| axis.name.clone()).collect();
    (model, names)
}

/// How far the place of each CL point in a program is from the CL point itself, mm, and its tool axis, degrees; cuts alone.
fn off(program: &str, cl: &str, base: &str, tcp: &str) -> Vec<(f64, f64)> {
    let (model, names) = model(base, tcp);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let printed: Vec<_> = blocks(program, &names, &[])
        .into_iter()
        .filter(|block| !block.rapid)
        .map(|block| model.pose(&block.words, 80.0))
        .collect();
    let mut from = 0;
    let mut all = Vec::new();
    for point in points(cl).iter().filter(|point| !point.rapid) {
        // Points are put in between, and none is left out: in order, the nearest of the next few.
        let ahead = printed.iter().enumerate().skip(from).take(24);
        let nearest = ahead.min_by(|one, other| {
            let [one, other] = [one, other].map(|(_, pose)| (pose.tip - point.tip).norm());
            one.total_cmp(&other)
        });
        let (place, pose) = nearest.unwrap();
        from = place + 1;
        all.push(((pose.tip - point.tip).norm(), angle(pose.axis, point.axis)));
    }
    all
}

fn most(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

/// As printed a point stands no farther from its CL point than the bound and half a last digit of each word, whatever the
/// servos would ask for; and its tool axis is the same.
#[test]
fn no_point_stands_farther_off_than_the_bound_in_the_printed_program() {
    for (sample, tcp, bound) in [
        ("s-piece.cls", "control", 0.0005),
        ("s-piece.cls", "control", 0.003),
        ("s-piece.cls", "post", 0.003),
        ("blade.cls", "post", 0.003),
    ] {
        let folder = trunnion(bound);
        let (plain, moved, found) = both(&folder, sample, &["--tcp", tcp]);
        assert_eq!(found["kept"], true, "{sample} {tcp}: {found}");
        let cl = fs::read_to_string(folder.path().join(sample)).unwrap();
        // The words of rotary axes are rounded too, and turn the tip about the axes.
        let rounding = match tcp {
            "control" => 0.5 * DIGIT * 3.0_f64.sqrt(),
            _ => most(off(&plain, &cl, "ac-trunnion", tcp).iter().map(|off| off.0)) + DIGIT,
        };
        let there = off(&moved, &cl, "ac-trunnion", tcp);
        let farthest = most(there.iter().map(|off| off.0));
        assert!(
            farthest <= bound + rounding + 1e-9,
            "{sample} {tcp}: {farthest} of {bound}, rounding {rounding}"
        );
        assert!(farthest > 0.5 * bound, "{sample} {tcp}: {farthest}");
        let turned = most(there.iter().map(|off| off.1));
        assert!(turned <= 0.001, "{sample} {tcp}: {turned}°");
        assert!(number(&found, "/largest_move_mm") <= bound);
    }
    // Servos that would ask for far more.
    for (servo, bound) in [(SOFT, 0.05), (LATE, 0.003)] {
        let key = format!("[accuracy]\nservo_compensation = {bound}\n");
        let folder = mill("fanuc", servo, &key);
        let (_, moved, found) = both(&folder, "circle.cls", &[]);
        assert!(number(&found, "/before/rms_mm") > 5.0 * bound, "{found}");
        assert_eq!(found["kept"], true, "{found}");
        let there = off(&moved, &circle_points(), "vmc", "post");
        let farthest = most(there.iter().map(|off| off.0));
        let rounding = 0.5 * DIGIT * 3.0_f64.sqrt();
        assert!(farthest <= bound + rounding + 1e-9, "{farthest} of {bound}");
        assert!(farthest > bound - rounding, "{farthest} of {bound}");
    }
}

/// The circle alone: the reader of the testkit takes a hole by its bottom.
fn circle_points() -> String {
    let text = circle();
    text.split("RAPID\nGOTO/-20").next().unwrap().to_owned()
}

/// The tool on a circle runs inside by ρ(1 - |G|); points a little outside bring it back.
#[test]
fn a_circle_that_is_too_small_gets_points_outside_and_comes_out_right() {
    let folder = mill("fanuc", STIFF, BOUND);
    let (_, moved, found) = both(&folder, "circle.cls", &[]);
    // 50 mm/s on 20 mm are 2.5 rad/s: |G| = 1/√(1 + (2.5/140)²).
    let gain = 1.0 / libm::hypot(1.0, 2.5 / 140.0);
    let inside = 20.0 * (1.0 - gain);
    assert!((inside - 0.0032).abs() < 1e-4);
    let (model, names) = model("vmc", "post");
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let radii: Vec<f64> = blocks(&moved, &names, &[])
        .iter()
        .filter(|block| !block.rapid)
        .map(|block| model.pose(&block.words, 80.0).tip)
        .filter(|tip| tip.z < -1.9)
        .map(|tip: Vector3<f64>| tip.xy().norm())
        .collect();
    let middle = &radii[60..300];
    let mean = middle.iter().sum::<f64>() / middle.len() as f64;
    assert!((mean - 20.0 - inside).abs() < 4e-4, "{mean} {inside}");
    // The ends, where the tool comes to the part and leaves it, stay.
    for end in [radii[0], radii[radii.len() - 1]] {
        assert!((end - 20.0).abs() < 0.5 * DIGIT, "{end}");
    }
    let [before, after] = ["/before/rms_mm", "/after/rms_mm"].map(|path| number(&found, path));
    // What is left is mostly where the tool comes and leaves.
    assert!(after < 0.5 * before, "{found}");
}

/// Rapids, holes and everything between them are the same to the letter: only blocks of the cut differ.
#[test]
fn rapids_holes_and_commands_are_what_they_were() {
    for dialect in ["fanuc", "siemens", "heidenhain", "linuxcnc"] {
        let folder = mill(dialect, STIFF, BOUND);
        let (plain, moved, found) = both(&folder, "circle.cls", &[]);
        assert_eq!(found["kept"], true, "{dialect}: {found}");
        assert_eq!(plain.lines().count(), moved.lines().count(), "{dialect}");
        let named =
            |line: &str| ["PLAIN", "PART"].iter().any(|name| line.to_uppercase().contains(name));
        let lines = plain.lines().zip(moved.lines());
        let other: Vec<_> = lines.filter(|(one, two)| one != two && !named(one)).collect();
        for (one, two) in &other {
            for line in [one, two] {
                let others = ["G0 ", "FMAX", "G8", "CYC", "M99", "MCALL", "M3"].iter();
                assert!(
                    !others.clone().any(|word| line.contains(word)),
                    "{dialect}: {one} became {two}"
                );
            }
        }
        // The end of the way down is a point of the cut too.
        assert!(other.len() > 300 && other.len() <= 361, "{dialect}: {}", other.len());
    }
}

/// What the summary says before and after is what `post predict` says of the two programs against the CL file, and the
/// prediction of the same run; and the program is verified within tolerance and bound.
#[test]
fn the_figures_are_those_of_predict_and_verify_takes_the_moves_for_what_they_are() {
    for (sample, tcp) in
        [("s-piece.cls", "control"), ("s-piece.cls", "post"), ("blade.cls", "post")]
    {
        let folder = trunnion(0.003);
        let more = ["--tcp", tcp, "--predict=prediction.json", "--verify"];
        let (_, _, found) = both(&folder, sample, &more);
        for (program, key) in [("plain.nc", "before"), ("part.nc", "after")] {
            let arguments = [
                "predict",
                program,
                "-q",
                "--tcp",
                tcp,
                "--against",
                sample,
                "--summary",
                "p.json",
            ];
            let told = run(&folder, &arguments);
            assert_eq!(told.code, 0, "{}", told.err);
            let told = read_json(&folder.path().join("p.json"));
            let tip = &told["contour"]["tip_mm"];
            for (figure, of) in [("rms", "rms_mm"), ("largest", "largest_mm")] {
                let [one, two] =
                    [number(tip, &format!("/{figure}")), number(&found, &format!("/{key}/{of}"))];
                assert!((one - two).abs() < 1e-9, "{sample} {tcp} {key}: {one} {two}");
            }
            assert_eq!(tip["nc_line"], found[key]["nc_line"]);
            let following = number(&told["contour"], "/parts/0/tip_mm/rms");
            assert!((following - number(&found, &format!("/{key}/following_rms_mm"))).abs() < 1e-9);
        }
        let told = read_json(&folder.path().join("prediction.json"));
        let [rms, after] = [number(&told, "/contour/tip_mm/rms"), number(&found, "/after/rms_mm")];
        assert!((rms - after).abs() < 1e-9, "{rms} {after}");
        assert!(after < number(&found, "/before/rms_mm"));
        // Alone, verify counts a move like any other deviation, and --tolerance says what is meant.
        let verify = ["verify", "part.nc", "-q", "--tcp", tcp, "--against", sample];
        let wide = run(&folder, &[&verify[..], &["--tolerance", "0.008"]].concat());
        assert_eq!(wide.code, 0, "{}", wide.err);
        let tight = run(&folder, &[&verify[..], &["--tolerance", "0.001"]].concat());
        assert_eq!(tight.code, 1);
        assert_contains(&tight.err, &["error[deviation]"]);
    }
}

/// Where nothing is to be had, the program is written as it is without, and that is said.
#[test]
fn where_it_does_not_help_nothing_is_moved() {
    // Arcs that go as moves are no better than arcs; facets are straight between corners.
    for (sample, tcp) in [("flange.ncl", "post"), ("facets.apt", "post")] {
        let folder = trunnion(0.003);
        let job = ["--tcp", tcp, "--set", "control.planes=false"];
        let (plain, moved, found) = both(&folder, sample, &job);
        assert_eq!((&found["kept"], &found["points_moved"]), (&false.into(), &0.into()), "{found}");
        assert_eq!(found["before"], found["after"]);
        assert!(plain == moved, "{sample}");
        let told = [&[sample, "-o", "part.nc", "--compensate-servo"][..], &job].concat();
        let told = run(&folder, &told);
        assert_contains(&told.out, &["no move of points by 0.003000 mm or less makes it better"]);
    }
}

#[test]
fn it_is_refused_with_what_is_missing() {
    let refused = |folder: &TempDir, parts: &[&str]| {
        let run = run(folder, &["circle.cls", "-o", "part.nc", "--compensate-servo"]);
        assert_eq!((run.code, run.out.as_str()), (1, ""));
        assert_contains(&run.err, parts);
        assert!(!folder.path().join("part.nc").exists());
    };
    refused(
        &mill("fanuc", STIFF, ""),
        &["error[compensate-servo]", "[accuracy] servo_compensation = 0.003, in mm"],
    );
    let none = folder(&format!("extends = \"vmc\"\n{BOUND}"));
    fs::write(none.path().join("circle.cls"), circle()).unwrap();
    refused(&none, &["error[compensate-servo]", "describes no servo", "[servo.X] for each axis"]);
    refused(
        &mill("fanuc", STIFF, "[accuracy]\nservo_compensation = -0.003\n"),
        &["servo_compensation", "mill.toml:"],
    );
}

/// What comes from a pipe is read as often as it takes, and the program may go to one.
#[test]
fn a_pipe_gives_what_a_file_does() {
    let folder = mill("fanuc", STIFF, BOUND);
    let (_, moved, _) = both(&folder, "circle.cls", &[]);
    let mut command = common::command();
    command.current_dir(folder.path());
    command.args([
        "-m",
        "./mill.toml",
        "--tool-length",
        "80",
        "-q",
        "-o",
        "-",
        "--compensate-servo",
        "-",
    ]);
    let piped = common::run(&mut command, circle().as_bytes());
    assert_eq!(piped.code, 0, "{}", piped.err);
    let body = |text: &str| -> Vec<String> { text.lines().skip(3).map(str::to_owned).collect() };
    assert_eq!(body(&piped.out), body(&moved));
}

/// Of several programs each is compensated by itself.
#[test]
fn each_of_several_programs_has_its_own_figures() {
    let folder = mill("fanuc", STIFF, BOUND);
    let arguments = [
        "circle.cls",
        "-q",
        "-o",
        "part.nc",
        "--split",
        "tools",
        "--compensate-servo",
        "--predict=p.json",
    ];
    let split = run(&folder, &[&arguments[..], &["--summary", "found.json", "--verify"]].concat());
    assert_eq!(split.code, 0, "{}", split.err);
    let [found, told] = ["found.json", "p.json"].map(|name| read_json(&folder.path().join(name)));
    let kept: Vec<&Value> =
        (0..2).map(|place| &found[place]["servo_compensation"]["kept"]).collect();
    assert_eq!(kept, [&Value::Bool(true), &Value::Bool(false)], "the second has holes alone");
    for place in 0..2 {
        let after = number(&found[place], "/servo_compensation/after/rms_mm");
        let rms = number(&told[place], "/contour/tip_mm/rms");
        assert!((after - rms).abs() < 1e-9, "{place}: {after} {rms}");
    }
    assert!(folder.path().join("part-2.nc").exists());
}
