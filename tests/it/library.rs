//! The library: every machine makes a program of its own, which is read back, and refuses one that it must.

use crate::common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use common::{check_numbers, post, read_json, root};
use post_testkit::shared;
use post_testruns::read_back::{Model, Point, V, angle, blocks, points, table, unrolled};

/// A machine with its program, `tests/machines/<machine>.<ending>`, and the one that it must refuse,
/// `tests/machines/<machine>.refused.<ending>`.
pub struct Row {
    pub machine: &'static str,
    pub ending: &'static str,
    /// Length of the tool, mm.
    pub length: f64,
    /// Code of the refusal.
    code: &'static str,
}

const fn row(machine: &'static str, ending: &'static str, length: f64, code: &'static str) -> Row {
    Row { machine, ending, length, code }
}

pub const LIBRARY: &[Row] = &[
    row("ab-trunnion", "apt", 100.0, "over-travel"),
    row("ac-cantilever", "cls", 100.0, "over-travel"),
    row("ac-trunnion", "cls", 100.0, "over-travel"),
    row("ac-trunnion-840d", "cls", 100.0, "over-travel"),
    row("ac-trunnion-sign", "cls", 100.0, "over-travel"),
    row("bc-fork", "apt", 100.0, "over-travel"),
    row("bc-trunnion", "ncl", 100.0, "over-travel"),
    row("boring-mill", "apt", 150.0, "out-of-reach"),
    row("disc-cutter", "ncl", 0.0, "over-travel"),
    row("dmu50", "ncl", 100.0, "over-travel"),
    row("duoblock", "apt", 100.0, "over-travel"),
    row("exechon", "cls", 100.0, "over-travel"),
    row("gantry", "ncl", 150.0, "over-travel"),
    row("grbl-router", "ncl", 60.0, "out-of-reach"),
    row("head-change", "ncl", 100.0, "out-of-reach"),
    row("head-head", "cls", 100.0, "over-travel"),
    row("head-head-360", "cls", 100.0, "over-travel"),
    row("head-table-ba", "ncl", 100.0, "over-travel"),
    row("head-table-bc", "apt", 100.0, "over-travel"),
    row("head-table-sr", "apt", 100.0, "over-travel"),
    row("hexapod", "cls", 100.0, "over-travel"),
    row("hmc-b-pallet", "cls", 120.0, "out-of-reach"),
    row("irb4600-rail", "cls", 100.0, "out-of-reach"),
    row("kr6-pose", "cls", 60.0, "over-travel"),
    row("kr6-r700", "cls", 60.0, "out-of-reach"),
    row("lathe-xz", "cls", 40.0, "out-of-reach"),
    row("lathe-xz-a", "cls", 40.0, "out-of-reach"),
    row("lathe-xz-upper", "cls", 40.0, "out-of-reach"),
    row("lathe-xzc-face", "cls", 60.0, "out-of-reach"),
    row("lathe-xzc-mantle", "cls", 60.0, "out-of-reach"),
    row("lathe-xzc-polar", "cls", 60.0, "out-of-reach"),
    row("lathe-xzc-radial", "cls", 60.0, "out-of-reach"),
    row("linear-delta", "cls", 40.0, "over-travel"),
    row("linuxcnc-5axis", "cls", 100.0, "over-travel"),
    row("m800-trunnion", "cls", 100.0, "over-travel"),
    row("mill-turn", "cls", 100.0, "over-travel"),
    row("nutating-head", "cls", 100.0, "out-of-reach"),
    row("nutating-head-45", "ncl", 100.0, "out-of-reach"),
    row("nutating-head-50", "apt", 100.0, "out-of-reach"),
    row("nutating-table", "apt", 100.0, "out-of-reach"),
    row("osp-mill", "ncl", 100.0, "out-of-reach"),
    row("pocketnc", "apt", 60.0, "over-travel"),
    row("printer-open5x", "ncl", 0.0, "over-travel"),
    row("quill-mill", "cls", 200.0, "out-of-reach"),
    row("ram-fork", "apt", 100.0, "over-travel"),
    row("router", "ncl", 60.0, "out-of-reach"),
    row("rotary-delta", "cls", 40.0, "over-travel"),
    row("tangential-knife", "cls", 0.0, "out-of-reach"),
    row("tripod", "cls", 40.0, "over-travel"),
    row("tricept", "cls", 100.0, "over-travel"),
    row("ultrasonic-knife", "ncl", 50.0, "over-travel"),
    row("umc-750", "ncl", 100.0, "over-travel"),
    row("variaxis", "cls", 100.0, "over-travel"),
    row("vertical-lathe", "apt", 100.0, "over-travel"),
    row("vmc", "ncl", 100.0, "out-of-reach"),
    row("vmc-a", "cls", 100.0, "out-of-reach"),
    row("vmc-a-measured", "cls", 100.0, "out-of-reach"),
    row("vmc-b", "apt", 100.0, "over-travel"),
    row("xyzac-trt", "cls", 40.0, "over-travel"),
    row("xyzbc-trt", "ncl", 40.0, "over-travel"),
    row("z3-head", "cls", 120.0, "over-travel"),
];

/// Words that are rounded move the tip by so much, mm.
const ROUNDING: f64 = 0.003;

/// Posts a file; the program, the messages and the summary.
fn make(row: &Row, file: &str) -> (common::Run, Option<serde_json::Value>) {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("s.json");
    let file = Path::new("tests/machines").join(file);
    let length = row.length.to_string();
    // Nor does it know the tool's vector.
    let vectors = matches!(row.machine, "tricept" | "exechon");
    let angles = ["--set", "control.siemens.tool_vectors=false"];
    let mut arguments = if vectors { angles.to_vec() } else { Vec::new() };
    arguments.extend([
        "-q",
        "-m",
        row.machine,
        "--tool-length",
        &length,
        // The reader of this test knows moves, and no plane but that of the part.
        "--set",
        "control.cycles=moves",
        "--set",
        "control.planes=false",
        "-o",
        "-",
        "--summary",
        json.to_str().unwrap(),
        file.to_str().unwrap(),
    ]);
    let run = post(&arguments);
    let summary = json.is_file().then(|| read_json(&json));
    (run, summary)
}

/// What is wrong with a machine's program.
fn faults(row: &Row) -> Vec<String> {
    let file = format!("{}.{}", row.machine, row.ending);
    let (run, summary) = make(row, &file);
    if run.code != 0 {
        return vec![run.err];
    }
    check_numbers(&run.out);
    let text = fs::read_to_string(root().join("tests/machines").join(&file)).unwrap();
    let mut faults = read_back(row, &points(&text), &run.out);
    let summary = summary.unwrap();
    let model = Model::new(row.machine, None);
    for (key, limit) in
        [("tip_deviation_mm", model.tolerance), ("axis_deviation_deg", model.axis_tolerance)]
    {
        let value = summary[key]["value"].as_f64().unwrap();
        if value > limit {
            faults.push(format!("{key} is {value}"));
        }
    }
    faults
}

/// Every CL point must be met, in order, by a block; and every block must keep to what the axes can do.
fn read_back(row: &Row, points: &[Point], program: &str) -> Vec<String> {
    // The first head is the one without a name, or the first that the program names.
    let mut heads: Vec<Option<String>> = vec![None];
    for point in points {
        if heads.last() != Some(&point.head) {
            heads.push(point.head.clone());
        }
    }
    let models: Vec<Model> =
        heads.iter().map(|head| Model::new(row.machine, head.as_deref())).collect();
    let names: Vec<&str> = models[0].axes.iter().map(|axis| axis.name.as_str()).collect();
    let table = table(row.machine);
    let swap: Vec<String> = heads
        .iter()
        .flatten()
        .filter_map(|head| Some(table["head"][head.as_str()].get("word")?.as_str()?.to_owned()))
        .collect();
    let polar = table.get("mode").is_some_and(|mode| mode.get("face").is_some());
    let polar = polar.then(|| unrolled(program, "C", 1.0));
    let blocks = blocks(polar.as_deref().unwrap_or(program), &names, &swap);
    let mut faults = Vec::new();
    let poses: Vec<_> =
        blocks.iter().map(|block| models[block.swaps].pose(&block.words, row.length)).collect();
    let mut next = 0;
    for point in points {
        let model = &models[heads.iter().position(|head| *head == point.head).unwrap()];
        let near = |place: &usize| {
            let pose = &poses[*place];
            (pose.tip - point.tip).norm() < ROUNDING
                && angle(pose.axis, point.axis) < model.axis_tolerance + 0.003
        };
        match (next..blocks.len()).find(near) {
            Some(place) => next = place,
            None => {
                let miss = poses[next..]
                    .iter()
                    .map(|pose| ((pose.tip - point.tip).norm(), angle(pose.axis, point.axis)));
                let nearest = miss.min_by(|a, b| (a.0 + a.1).total_cmp(&(b.0 + b.1)));
                faults.push(format!(
                    "CL line {}: no block stands there; the nearest behind line {} is off by {nearest:?} (mm, degrees)",
                    point.line, blocks[next].line
                ));
            }
        }
    }
    for block in &blocks {
        let over = models[block.swaps].over_travel(&block.words, row.length);
        faults.extend(over.map(|over| format!("line {}: {over}", block.line)));
    }
    for (place, axis) in models[0].axes.iter().enumerate().filter(|(_, axis)| axis.indexed) {
        for pair in blocks.windows(2) {
            if !pair[1].rapid && pair[0].words[place] != pair[1].words[place] {
                faults.push(format!("line {}: {} moves in a cut", pair[1].line, axis.name));
            }
        }
        for block in &blocks {
            let value = block.words[place];
            let stands = match (&axis.positions, axis.step) {
                (Some(positions), _) => positions.contains(&value),
                (None, Some(step)) => (value / step).fract() == 0.0,
                (None, None) => true,
            };
            if !stands {
                faults.push(format!("line {}: {} cannot stand at {value}", block.line, axis.name));
            }
        }
    }
    for clamp in &models[0].clamps {
        if !program.split_whitespace().any(|word| word == clamp) {
            faults.push(format!("{clamp} is not in the program"));
        }
    }
    if poses[0].edge.norm() > 0.5 {
        faults.extend(edge_faults(points, &poses));
    }
    faults
}

/// The leading edge must point along one of the pieces that meet in a CL point, or between them.
fn edge_faults(points: &[Point], poses: &[post_testruns::read_back::Pose]) -> Vec<String> {
    let mut faults = Vec::new();
    let cuts: Vec<&[Point]> =
        points.chunk_by(|_, point| !point.rapid).filter(|cut| cut.len() > 2).collect();
    for cut in cuts {
        // The first piece is the plunge.
        for three in cut[1..].windows(3) {
            let across = |from: &Point, to: &Point| {
                let way = to.tip - from.tip;
                let axis = three[1].axis;
                (way - axis * axis.dot(&way)).normalize()
            };
            let (come, go) = (across(&three[0], &three[1]), across(&three[1], &three[2]));
            let bend = angle(come, go);
            let there = poses
                .iter()
                .filter(|pose| (pose.tip - three[1].tip).norm() < ROUNDING)
                .map(|pose| angle(pose.edge, come) + angle(pose.edge, go) - bend);
            let off = there.fold(f64::INFINITY, f64::min);
            if off > 1.0 {
                faults.push(format!("CL line {}: the edge is off by {off}°", three[1].line));
            }
        }
    }
    faults
}

#[test]
fn every_machine_makes_its_program() {
    let mut failed = Vec::new();
    for row in LIBRARY.iter() {
        let faults = faults(row);
        if !faults.is_empty() {
            failed.push(format!("{}:\n{}", row.machine, faults.join("\n")));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn every_machine_refuses_what_it_cannot_make() {
    for row in LIBRARY.iter() {
        let file = format!("{}.refused.{}", row.machine, row.ending);
        let (run, summary) = make(row, &file);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", row.machine);
        assert!(summary.is_none(), "{}", row.machine);
        for word in [format!("error[{}]", row.code), format!("{file}:")] {
            assert!(run.err.contains(&word), "{}:\n{}", row.machine, run.err);
        }
    }
}

fn listed(folder: &str) -> BTreeSet<String> {
    fs::read_dir(root().join(folder))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| !name.ends_with(".md"))
        .collect()
}

#[test]
fn every_file_is_in_the_list() {
    let machines = LIBRARY.iter().map(|row| format!("{}.toml", row.machine));
    assert_eq!(machines.collect::<BTreeSet<_>>(), listed("machines"));
    assert!(LIBRARY.len() >= 20);
    let programs = LIBRARY.iter().flat_map(|row| {
        ["", ".refused"].map(|kind| format!("{}{kind}.{}", row.machine, row.ending))
    });
    assert_eq!(programs.collect::<BTreeSet<_>>(), listed("tests/machines"));
}

#[test]
fn the_pages_say_how_many_machines_there_are() {
    for (page, says) in [
        ("README.md", "[{} machines](machines/README"),
        ("docs/src/study.md", "Of the {} machines of the library"),
    ] {
        let text = fs::read_to_string(root().join(page)).unwrap();
        let says = says.replace("{}", &LIBRARY.len().to_string());
        assert!(text.contains(&says), "{page} does not say {says:?}");
    }
}

#[test]
fn every_machine_says_where_its_numbers_come_from() {
    let guide = fs::read_to_string(root().join("machines/README.md")).unwrap();
    for row in LIBRARY {
        let path = root().join(format!("machines/{}.toml", row.machine));
        let text = fs::read_to_string(path).unwrap();
        let head: Vec<&str> = text.lines().take_while(|line| line.starts_with('#')).collect();
        let head = head.join(" ");
        assert!(
            head.contains("example") || head.contains("Where the numbers come from"),
            "{}: {head}",
            row.machine
        );
        assert!(
            guide.contains(&format!("| `{}` |", row.machine)),
            "machines/README.md does not list {}",
            row.machine
        );
    }
}

/// The machines of real makers say of each number where it comes from or that it is not known, and of no other.
#[test]
fn machines_of_real_makers_are_profiled() {
    let makers = LIBRARY.iter().map(|row| {
        let path = root().join(format!("machines/{}.toml", row.machine));
        (row.machine, fs::read_to_string(path).unwrap())
    });
    let mut count = 0;
    for (name, text) in makers.filter(|(_, text)| text.contains("in the style of")) {
        count += 1;
        let run = common::post(&["profile", name]);
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{name}");
        for word in ["maker", "model", "control", "checked", "not known"] {
            assert!(run.out.lines().any(|line| line.starts_with(word)), "{name}: {word}");
        }
        assert!(!run.out.contains("not said"), "{name}:\n{}", run.out);
        assert!(text.contains("[profile.sources]"), "{name}");
    }
    let listed = post(&["profile"]).out.lines().count();
    assert_eq!((count, listed), (8, 9));
}

/// A file that extends one says what was measured, and a slip in it is told.
#[test]
fn what_was_measured_is_known() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ours.toml");
    let text = "extends = \"dmu50\"\n[axis.B]\npoint = [0.01, 0, -50.02]\n[profile.sources]\n\
                \"axis.B.point\" = \"acceptance report\"\n\"axis.Q\" = \"a slip\"\n";
    fs::write(&file, text).unwrap();
    let file = file.to_str().unwrap();
    let run = post(&["profile", file]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.err.contains("warning[machine-profile]") && run.err.contains("`axis.Q`"));
    let line = run.out.lines().find(|line| line.starts_with("axis.B.point")).unwrap();
    assert!(line.contains("[0.01, 0, -50.02]") && line.ends_with("acceptance report"), "{line}");
    for told in [run.out, post(&["check", file]).out] {
        let unknown: Vec<&str> =
            told.lines().filter(|line| line.starts_with("not known")).collect();
        assert_eq!(unknown.len(), 3, "{told}");
        assert!(unknown.iter().all(|line| !line.contains("axis.B.point")), "{told}");
    }
}

/// A table of poses that LinuxCNC computed, the machine of the library that it must be, parameters, and the
/// tool's length.
type Poses = (&'static str, &'static str, &'static [(&'static str, f64)], f64);

const LINUXCNC: &[Poses] = &[
    ("ik_xyzac_plain", "xyzac-trt", &[("y_offset", 0.0), ("z_offset", 0.0)], 0.0),
    ("ik_xyzac_offsets", "xyzac-trt", &[("x_rot", 3.0), ("y_rot", -4.0), ("z_rot", 5.0)], 75.0),
    ("ik_xyzbc_plain", "xyzbc-trt", &[("x_offset", 0.0), ("z_offset", 0.0)], 0.0),
    ("ik_5axiskins_headhead", "linuxcnc-5axis", &[], 0.0),
];

/// The machines that claim the law of a LinuxCNC module stand where it says.
#[test]
fn the_machines_of_linuxcnc_are_its_own() {
    let Some(data) = shared("data/kinematics") else {
        return;
    };
    for (file, machine, parameters, length) in LINUXCNC {
        let mut table = table(machine);
        for (name, value) in *parameters {
            table["parameters"][*name] = toml::Value::Float(*value);
        }
        let model = Model::from_table(table, None);
        let text = fs::read_to_string(data.join(format!("{file}.csv"))).unwrap();
        let order = if machine.starts_with("xyzac") { "XYZAC" } else { "XYZBC" };
        let mut count = 0;
        for line in text.lines() {
            let numbers: Vec<f64> = line.split(',').filter_map(|n| n.parse().ok()).collect();
            if numbers.len() != 18 {
                continue;
            }
            let places = model.axes.iter().map(|axis| order.find(&axis.name).unwrap());
            let values: Vec<f64> = places.map(|place| numbers[9 + place]).collect();
            // The module's pose has the tool's length in its Z.
            let tip = V::new(numbers[0], numbers[1], numbers[2] - length);
            let off = (model.reach(&values, *length).tip - tip).norm();
            assert!(off < 1e-6, "{file}: {line}: off by {off}");
            count += 1;
        }
        assert_eq!(count, 500, "{file}");
    }
}

/// The maker's module says where the axes stand: A and B count against ISO 841 and cross.
#[test]
fn the_pocket_nc_is_its_own() {
    let model = Model::new("pocketnc", None);
    let place = |name| model.axes.iter().position(|axis| axis.name == name).unwrap();
    for (a, b, x, y, z) in [(30.0, -50.0, 10.0, -20.0, 5.0), (120.0, 200.0, -30.0, 15.0, -40.0)] {
        let mut values = vec![0.0; 5];
        for (name, value) in [("A", a), ("B", b), ("X", x), ("Y", y), ("Z", z)] {
            values[place(name)] = value;
        }
        // With a tool as long as the gauge line stands over the crossing, the tip is at (x, y, z) at zero.
        let pose = model.reach(&values, 150.0);
        let (sa, ca) = libm::sincos(f64::to_radians(a));
        let (sb, cb) = libm::sincos(f64::to_radians(b));
        let (across, along) = (y * sa - z * ca, y * ca + z * sa);
        let tip = V::new(x * cb + across * sb, along, x * sb - across * cb);
        assert!((pose.tip - tip).norm() < 1e-9, "{:?} {tip}", pose.tip);
        assert!(angle(pose.axis, V::new(-sb * ca, sa, cb * ca)) < 1e-9);
    }
}
