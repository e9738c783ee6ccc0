//! CL files that CAM systems wrote, on the machines that can make them, and refused where none can.
//!
//! Some of the programs are read back here by a reader and a kinematics of this test's own, which share no
//! code with the command: the machine's numbers are written out again, as matrices.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use crate::common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use common::{Run, check_numbers, command, read_json, root, run, sample};
use nalgebra::{Rotation3, Unit, Vector3};
use post_testkit::shared;
use serde_json::Value;

type V = Vector3<f64>;

fn post(file: &Path, machine: &str, with: &str) -> (Run, Option<Value>) {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("s.json");
    let done = run(
        command()
            .args(["-q", "-m", machine, "-o", "-", "--summary"])
            .arg(&json)
            .args(with.split_whitespace())
            .arg(file),
        b"",
    );
    let summary = json.is_file().then(|| read_json(&json));
    (done, summary)
}

/// File, machine, further arguments: these are posted.
const GOOD: &[(&str, &str, &str)] = &[
    ("creo3x_MichaHofft_bohren_1.ncl", "vmc", ""),
    ("creo3x_MichaHofft_bohren_1.ncl", "dmu50", "--mount 0,0,20"),
    ("creo3x_MichaHofft_profilfraesen_2.ncl", "vmc", ""),
    ("creo3x_MichaHofft_profilfraesen_2.ncl", "ac-trunnion", ""),
    ("creo3x_MichaHofft_schruppen_1.ncl", "vmc", ""),
    ("creo3x_MichaHofft_schruppen_1.ncl", "nutating-head", ""),
    // In inches, as it says, the blade is 5 m long.
    ("creo5x_4r19415_finition.ncl", "head-head", "--tcp post"),
    (
        "creo5x_4r19415_finition.ncl",
        "ac-trunnion",
        "--tcp post --units mm --mount -140,21,-40",
    ),
    (
        "creo5x_4r19415_finition.ncl",
        "ac-trunnion",
        "--tcp control --units mm",
    ),
    (
        "creo5x_4r19415_finition.ncl",
        "dmu50",
        "--tcp post --units mm --mount -140,21,0 --tool-length 120",
    ),
    ("nx_HumMan_ust_a2.cls", "head-head-360", "--tcp post"),
    (
        "nx_HumMan_ust_a2.cls",
        "head-head",
        "--tcp post --msys apply",
    ),
    ("nx_HumMan_ust_a.cls", "head-head-360", ""),
    (
        "nx_HumMan_ust_a.cls",
        "head-head",
        "--msys apply --tool-length 150",
    ),
    ("nx_HumMan_cutcom.clsf", "vmc", ""),
    // Cutter compensation on an indexed table: the tool stands upright in the machine.
    (
        "camworks_neMoguta_UniSource.clt",
        "ac-trunnion",
        "--tool 1 --tool-length 150",
    ),
    (
        "swcam_aamorim_Interface-glue.clt",
        "ac-trunnion",
        "--tool 1 --tool-length 150",
    ),
    (
        "swcam_aamorim_Teste-Metrologia.apt",
        "ac-trunnion",
        "--tool-length 80",
    ),
    ("nx_HumMan_nurbs.clsf", "head-head", "--tool 1"),
    ("nx_HumMan_nurbs.clsf", "disc-cutter", "--tool 1"),
    ("nx_HumMan_deep_drill.clsf", "vmc", "--tool 1"),
    ("nx_HumMan_standart_drill.clsf", "vmc", "--tool 1"),
    ("nx_HumMan__3_PAZ_125_N2.cls", "head-head", "--tool 1"),
    (
        "nx_HumMan__10_KONTUR_125_N2_162.cls",
        "head-head",
        "--tool 1",
    ),
    ("nx_HumMan__8_SVERL_63_N2.cls", "head-head", "--tool 1"),
    ("nx_HumMan__8_SVERL_63_N2.cls", "disc-cutter", "--tool 1"),
    ("swcam_aamorim_basemach.apt", "vmc", "--mount -170,-75,0"),
    ("swcam_aamorim_basemach.apt", "nutating-head", ""),
    // It has no word for its units; it is in inches.
    ("own_ncl_form.as", "ac-trunnion", "--units inch"),
    ("own_ncl_form.as", "dmu50", "--units inch"),
    (
        "own_ncl_form.as",
        "nutating-head",
        "--units inch --tcp post --tool-length 100",
    ),
];

/// File, machine, further arguments, code of the fault: these are refused.
const REFUSED: &[(&str, &str, &str, &str)] = &[
    ("creo5x_4r19415_finition.ncl", "vmc", "", "out-of-reach"),
    (
        "creo5x_4r19415_finition.ncl",
        "ac-trunnion",
        "",
        "over-travel",
    ),
    ("nx_HumMan_ust_a2.cls", "vmc", "", "out-of-reach"),
    // It works from below, and these heads do not swing so far.
    ("nx_HumMan_ust_a2.cls", "head-head", "", "over-travel"),
    ("nx_HumMan_ust_a2.cls", "ac-trunnion", "", "over-travel"),
    ("nx_HumMan_ust_a.cls", "dmu50", "", "over-travel"),
    ("nx_HumMan_ust_a.cls", "nutating-head", "", "out-of-reach"),
    (
        "nx_HumMan__3_PAZ_125_N2.cls",
        "vmc",
        "--tool 1",
        "over-travel",
    ),
    (
        "nx_HumMan__10_KONTUR_125_N2_162.cls",
        "ac-trunnion",
        "--tool 1",
        "over-travel",
    ),
    // A dialect with G43 H must know the tool.
    ("nx_HumMan_deep_drill.clsf", "vmc", "", "dialect"),
    ("own_ncl_form.as", "vmc", "", "out-of-reach"),
    (
        "camworks_neMoguta_UniSource.clt",
        "vmc",
        "--tool 1",
        "out-of-reach",
    ),
    (
        "swcam_aamorim_Interface-glue.clt",
        "vmc",
        "--tool 1",
        "out-of-reach",
    ),
    (
        "swcam_aamorim_Teste-Metrologia.apt",
        "vmc",
        "",
        "out-of-reach",
    ),
    // Radius compensation on a tilted plane: a head or TCP would offset in the wrong plane.
    (
        "camworks_neMoguta_UniSource.clt",
        "head-head",
        "--tool 1",
        "compensation",
    ),
    (
        "swcam_aamorim_Interface-glue.clt",
        "head-head-360",
        "--tool 1",
        "compensation",
    ),
    (
        "swcam_aamorim_Teste-Metrologia.apt",
        "head-head",
        "",
        "compensation",
    ),
];

#[test]
fn files_are_posted_within_tolerance() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    let mut failed = Vec::new();
    for (file, machine, with) in GOOD {
        let (done, summary) = post(&data.join(file), machine, with);
        let name = format!("{file} on {machine} {with}");
        if done.code != 0 {
            failed.push(format!("{name}:\n{}", done.err));
            continue;
        }
        let summary = summary.unwrap();
        check_numbers(&done.out);
        let tolerance = if *machine == "nutating-head" {
            0.010
        } else {
            0.005
        };
        assert_eq!(summary["tolerance_mm"], tolerance, "{name}");
        for (key, limit) in [
            ("tip_deviation_mm", tolerance),
            ("axis_deviation_deg", 0.05),
        ] {
            let value = summary[key]["value"].as_f64().unwrap();
            assert!(value <= limit, "{name}: {key} {value}");
        }
        assert!(summary["nc_lines"] == done.out.lines().count(), "{name}");
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn files_are_refused_for_a_reason() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    for (file, machine, with, code) in REFUSED {
        let (done, summary) = post(&data.join(file), machine, with);
        let name = format!("{file} on {machine} {with}");
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{name}");
        assert!(summary.is_none(), "{name}");
        let code = format!("error[{code}]");
        assert!(done.err.contains(&code), "{name}:\n{}", done.err);
        // The file and the line are told.
        assert!(
            done.err.contains(&format!("{file}:")),
            "{name}:\n{}",
            done.err
        );
    }
}

#[test]
fn every_file_is_among_them() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    let listed: BTreeSet<String> = GOOD
        .iter()
        .map(|row| row.0)
        .chain(REFUSED.iter().map(|row| row.0))
        .map(str::to_owned)
        .collect();
    let there: BTreeSet<String> = fs::read_dir(data)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(listed, there);
}

#[test]
fn the_words_of_every_file_are_listed() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    for entry in fs::read_dir(data).unwrap() {
        let path = entry.unwrap().path();
        let done = run(command().arg("words").arg(&path), b"");
        assert_eq!(
            (done.code, done.err.as_str()),
            (0, ""),
            "{}",
            path.display()
        );
        let row = done.out.lines().find(|line| line.starts_with("GOTO "));
        assert!(row.unwrap().contains("used"), "{}", path.display());
        assert!(
            !done.out.contains("refused"),
            "{}\n{}",
            path.display(),
            done.out
        );
    }
}

// Reading back.

/// A pose of the tool in the part frame: tip in mm, unit axis.
#[derive(Clone, Copy, Debug)]
struct Pose {
    tip: V,
    axis: V,
}

/// The points of a CL file in which every move is a GOTO: modal axes, `$`, MSYS if asked for.
fn cl_points(text: &str, scale: f64, apply_msys: bool) -> Vec<Pose> {
    let mut joined = String::new();
    for line in text.lines().map(str::trim_end) {
        match line.strip_suffix('$') {
            Some(part) if !line.starts_with("$$") => joined.push_str(part),
            _ => {
                joined.push_str(line);
                joined.push('\n');
            }
        }
    }
    let mut axis = V::z();
    let mut frame: Option<(V, V, V)> = None;
    let mut points = Vec::new();
    for line in joined.lines() {
        let Some((word, numbers)) = line.split_once('/') else {
            continue;
        };
        let numbers: Vec<f64> = numbers
            .split(',')
            .filter_map(|number| number.trim().parse().ok())
            .collect();
        let at = |from: usize| V::new(numbers[from], numbers[from + 1], numbers[from + 2]);
        match word.trim() {
            "TOOL PATH" => axis = V::z(),
            "MSYS" if apply_msys => frame = Some((at(0) * scale, at(3), at(6))),
            "GOTO" => {
                if numbers.len() == 6 {
                    axis = at(3).normalize();
                }
                let (mut tip, mut turned) = (at(0) * scale, axis);
                if let Some((origin, x, y)) = frame {
                    let z = x.cross(&y);
                    let into = |v: V| V::new(x.dot(&v), y.dot(&v), z.dot(&v));
                    tip = into(tip - origin);
                    turned = into(turned);
                }
                points.push(Pose { tip, axis: turned });
            }
            word => assert_ne!(word, "CIRCLE", "this reader knows points alone"),
        }
    }
    points
}

/// Where a block ends: X Y Z A B C as programmed, and whether it is a rapid.
#[derive(Clone, Copy, Debug)]
struct Block {
    words: [f64; 6],
    rapid: bool,
}

/// The motion blocks of a program, ISO or conversational, once all of `letters` have been programmed.
fn nc_blocks(program: &str, letters: &str) -> Vec<Block> {
    let mut words = [0.0; 6];
    let mut known = BTreeSet::new();
    let mut rapid = true;
    let mut blocks = Vec::new();
    for line in program.lines() {
        let code = line.split(['(', ';']).next().unwrap();
        // Retracts are in machine coordinates or steps; cycles and tools have words of their own.
        if ["G28", "G53", "M91", "M140", "CYCL", "TOOL", "BLK"]
            .iter()
            .any(|word| code.contains(word))
        {
            continue;
        }
        if code
            .trim_start_matches(|c: char| c.is_ascii_digit())
            .starts_with(" L ")
        {
            rapid = code.contains("FMAX");
        }
        let mut moved = false;
        for word in code.split_whitespace() {
            match word {
                "G0" => rapid = true,
                "G1" => rapid = false,
                _ => {
                    let letter = word.chars().next().unwrap();
                    if let (Some(place), Ok(value)) = ("XYZABC".find(letter), word[1..].parse()) {
                        words[place] = value;
                        known.insert(letter);
                        moved = true;
                    }
                }
            }
        }
        if moved && letters.chars().all(|letter| known.contains(&letter)) {
            blocks.push(Block { words, rapid });
        }
    }
    blocks
}

fn turn(direction: [f64; 3], degrees: f64) -> Rotation3<f64> {
    let direction = Unit::new_normalize(V::from(direction));
    Rotation3::from_axis_angle(&direction, degrees.to_radians())
}

/// `v` turned about a line through `point`.
fn about(point: V, rotation: Rotation3<f64>, v: V) -> V {
    rotation * (v - point) + point
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Forward kinematics from the words of a program without TCP. With the rotary axes at zero the words are the
/// tip in the part frame; the part frame stands at `mount`.
type Forward = fn(words: [f64; 6], mount: V, tool: f64) -> Pose;

fn ac_trunnion([x, y, z, a, _, c]: [f64; 6], mount: V, _: f64) -> Pose {
    let (a, c) = (turn(X, a), turn(Z, c));
    let pivot = V::new(0.0, 0.012, 50.004);
    Pose {
        tip: c * about(pivot, a, V::new(x, y, z) + mount) - mount,
        axis: c * a * V::z(),
    }
}

fn dmu50([x, y, z, _, b, c]: [f64; 6], mount: V, _: f64) -> Pose {
    let (b, c) = (turn(Y, b), turn(Z, c));
    let pivot = V::new(0.0, 0.0, -50.0);
    Pose {
        tip: c * about(pivot, b, V::new(x, y, z) + mount) - mount,
        axis: c * b * V::z(),
    }
}

fn head_head([x, y, z, a, _, c]: [f64; 6], _: V, tool: f64) -> Pose {
    let (a, c) = (turn(X, a), turn(Z, c));
    let swing = V::new(0.0, 0.0, 250.0 + tool);
    Pose {
        tip: V::new(x, y, z) + swing - c * a * swing,
        axis: c * a * V::z(),
    }
}

fn nutating_head([x, y, z, _, b, c]: [f64; 6], mount: V, tool: f64) -> Pose {
    let (b, c) = (turn([0.0, 1.0, 1.0], b), turn(Z, c));
    // From the point where the B axis meets the spindle axis down to the tip.
    let swing = V::new(0.0, 0.0, 680.0 - 500.0 + tool);
    Pose {
        tip: c * (V::new(x, y, z) + mount + swing - b * swing) - mount,
        axis: c * b * V::z(),
    }
}

fn disc_cutter([x, y, z, a, b, c]: [f64; 6], mount: V, tool: f64) -> Pose {
    let (a, b, c) = (turn(X, a), turn(Y, b), turn(Z, c));
    let swing = V::new(0.0, 0.0, 312.0 + tool);
    let tip = V::new(x, y, z) + mount + swing - c * a * swing;
    Pose {
        tip: about(V::new(0.0, 0.0, -500.0), b, tip) - mount,
        axis: b * c * a * V::z(),
    }
}

/// Degrees between two unit vectors.
fn angle(a: V, b: V) -> f64 {
    libm::atan2(a.cross(&b).norm(), a.dot(&b)).to_degrees()
}

/// The least value of a function with one valley between `low` and `high`.
fn least(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..30 {
        let third = (high - low) / 3.0;
        if of(low + third) < of(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    of((low + high) / 2.0)
}

/// What a program does to its CL points.
#[derive(Debug, Default)]
struct Found {
    /// Largest distance from the CL path in cuts and rapids, mm.
    cut: f64,
    rapid: f64,
    /// Largest angle to the CL axis in cuts, degrees.
    axis: f64,
}

/// Looks at 20 places of every block: how far each lies from the CL path's present piece; and every CL point
/// must be passed, to rounding, in order.
fn follow(points: &[Pose], blocks: &[Block], forward: impl Fn([f64; 6]) -> Pose) -> Found {
    const SAMPLES: u32 = 20;
    const TOLERANCE: f64 = 0.005;
    // Three words of three decimals, and rotary words that turn the tool axis a little.
    let reached = |pose: &Pose, point: &Pose| {
        (pose.tip - point.tip).norm() < 0.0012 && angle(pose.axis, point.axis) < 0.002
    };
    let mut found = Found::default();
    let mut at: Option<usize> = None;
    let mut last = blocks[0];
    for block in blocks {
        let end = forward(block.words);
        if let Some(index) = at
            && let Some(next) = points.get(index + 1)
        {
            let from = &points[index];
            let normal = from.axis.cross(&next.axis);
            let about_axis = normal.try_normalize(1e-12).unwrap_or_else(V::z);
            let whole = angle(from.axis, next.axis).to_radians();
            for sample in 1..=SAMPLES {
                let t = f64::from(sample) / f64::from(SAMPLES);
                let words = std::array::from_fn(|word| {
                    last.words[word] + (block.words[word] - last.words[word]) * t
                });
                let pose = forward(words);
                let chord = next.tip - from.tip;
                let along = if chord.norm() > 1e-6 {
                    (chord.dot(&(pose.tip - from.tip)) / chord.norm_squared()).clamp(0.0, 1.0)
                } else {
                    t
                };
                let off = (pose.tip - from.tip - chord * along).norm();
                if block.rapid {
                    found.rapid = found.rapid.max(off);
                    continue;
                }
                found.cut = found.cut.max(off);
                // A tip that is off by the tolerance says no better than this how far along the block is.
                let slack = TOLERANCE / chord.norm().max(TOLERANCE);
                let apart = |along: f64| {
                    // The tool axis turns evenly from one point to the next.
                    let axis = about_axis * (whole * along);
                    angle(pose.axis, Rotation3::new(axis) * from.axis)
                };
                let mut off = apart(along);
                if off > found.axis {
                    off = least(apart, along - slack, along + slack);
                }
                found.axis = found.axis.max(off);
            }
        }
        let mut next = at.map_or(0, |index| index + 1);
        // A point that prints like the one before has no block of its own.
        while next < points.len() && reached(&end, &points[next]) {
            at = Some(next);
            next += 1;
        }
        last = *block;
    }
    assert_eq!(
        at,
        Some(points.len() - 1),
        "the points after this one are not reached"
    );
    found
}

#[derive(Clone, Copy)]
struct Check {
    name: &'static str,
    machine: &'static str,
    with: &'static str,
    scale: f64,
    letters: &'static str,
    forward: Forward,
    mount: [f64; 3],
    tool: f64,
}

const fn check(
    name: &'static str,
    machine: &'static str,
    with: &'static str,
    letters: &'static str,
    forward: Forward,
) -> Check {
    Check {
        name,
        machine,
        with,
        scale: 1.0,
        letters,
        forward,
        mount: [0.0; 3],
        tool: 0.0,
    }
}

fn read_back(file: &Path, check: &Check) {
    let (done, summary) = post(file, check.machine, check.with);
    assert_eq!(
        done.code, 0,
        "{} on {}:\n{}",
        check.name, check.machine, done.err
    );
    let summary = summary.unwrap();
    let text = fs::read_to_string(file).unwrap();
    let points = cl_points(&text, check.scale, check.with.contains("--msys apply"));
    assert_eq!(points.len() as u64, summary["moves"].as_u64().unwrap());
    let blocks = nc_blocks(&done.out, check.letters);
    let (forward, mount, tool) = (check.forward, V::from(check.mount), check.tool);
    let found = follow(&points, &blocks, |words| forward(words, mount, tool));
    let value = |key: &str| summary[key]["value"].as_f64().unwrap();
    let name = format!("{} on {}: {found:?}", check.name, check.machine);
    eprintln!("{name}");
    // What is certified is a bound of what is found; the words are printed numbers on both sides.
    assert!(found.cut <= value("tip_deviation_mm") + 1e-6, "{name}");
    assert!(
        found.cut <= summary["tolerance_mm"].as_f64().unwrap(),
        "{name}"
    );
    assert!(found.rapid <= 0.5, "{name}");
    assert!(found.axis <= 0.05 + 1e-6, "{name}");
    // The check can see: a program of points alone would not do.
    if summary["points_added"].as_u64().unwrap() > 50 {
        assert!(found.cut > 0.001, "{name}");
    }
}

#[test]
fn samples_are_read_back_on_every_arrangement() {
    for case in [
        check(
            "blade.cls",
            "ac-trunnion",
            "--mount 3,-4,5",
            "XYZAC",
            ac_trunnion,
        ),
        check(
            "blade.cls",
            "dmu50",
            "--mount 3,-4,5 --tcp post",
            "XYZBC",
            dmu50,
        ),
        check(
            "blade.cls",
            "head-head",
            "--mount 3,-4,5 --tool-length 90",
            "XYZAC",
            head_head,
        ),
        check(
            "blade.cls",
            "nutating-head",
            "--mount 3,-4,5 --tcp post --tool-length 90",
            "XYZBC",
            nutating_head,
        ),
        check(
            "blade.cls",
            "disc-cutter",
            "--mount 3,-4,5 --tool-length 90",
            "XYZABC",
            disc_cutter,
        ),
        check(
            "knife.ncl",
            "disc-cutter",
            "--mount 3,-4,5 --tool-length 90",
            "XYZABC",
            disc_cutter,
        ),
        check(
            "knife.ncl",
            "head-head",
            "--mount 3,-4,5 --tool-length 90",
            "XYZAC",
            head_head,
        ),
    ] {
        let tool = if case.with.contains("length") {
            90.0
        } else {
            0.0
        };
        let case = Check {
            mount: [3.0, -4.0, 5.0],
            tool,
            ..case
        };
        read_back(&root().join(sample(case.name)), &case);
    }
}

#[test]
fn real_files_are_read_back() {
    let Some(data) = shared("data/cl") else {
        return;
    };
    const CREO: &str = "creo5x_4r19415_finition.ncl";
    for case in [
        Check {
            scale: 25.4,
            ..check(CREO, "head-head", "", "XYZAC", head_head)
        },
        Check {
            mount: [-140.0, 21.0, -40.0],
            ..check(
                CREO,
                "ac-trunnion",
                "--units mm --mount -140,21,-40",
                "XYZAC",
                ac_trunnion,
            )
        },
        Check {
            mount: [-140.0, 21.0, 0.0],
            tool: 120.0,
            ..check(
                CREO,
                "dmu50",
                "--tcp post --units mm --mount -140,21,0 --tool-length 120",
                "XYZBC",
                dmu50,
            )
        },
        check(
            "nx_HumMan_ust_a2.cls",
            "head-head-360",
            "",
            "XYZAC",
            head_head,
        ),
        check(
            "nx_HumMan_ust_a2.cls",
            "head-head",
            "--msys apply",
            "XYZAC",
            head_head,
        ),
        Check {
            scale: 25.4,
            tool: 100.0,
            ..check(
                "own_ncl_form.as",
                "nutating-head",
                "--units inch --tcp post --tool-length 100",
                "XYZBC",
                nutating_head,
            )
        },
    ] {
        read_back(&data.join(case.name), &case);
    }
}

/// The distance of a point from a piece of a straight line.
fn beside(point: V, from: V, to: V) -> f64 {
    let along = to - from;
    let square = along.norm_squared();
    let t = if square > 0.0 {
        ((point - from).dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - from - along * t).norm()
}

/// Where on a leg of the CL path, not before the share `least`, a pose is first within `bound` mm and `turn` degrees.
fn first_within(pose: &Pose, from: &Pose, to: &Pose, least: f64, bound: [f64; 2]) -> Option<f64> {
    let (chord, off) = (to.tip - from.tip, pose.tip - from.tip);
    let square = chord.norm_squared();
    let (low, high) = if square > 1e-12 {
        let middle = off.dot(&chord) / square;
        let across = (off - chord * middle).norm_squared();
        let half = (bound[0] * bound[0] - across) / square;
        if half < 0.0 {
            return None;
        }
        let half = libm::sqrt(half);
        ((middle - half).max(least), (middle + half).min(1.0))
    } else if off.norm() <= bound[0] {
        (least, 1.0)
    } else {
        return None;
    };
    if low > high {
        return None;
    }
    let normal = from.axis.cross(&to.axis);
    let normal = normal.try_normalize(1e-12).unwrap_or_else(V::z);
    let whole = angle(from.axis, to.axis).to_radians();
    let apart = |t: f64| angle(pose.axis, Rotation3::new(normal * (whole * t)) * from.axis);
    const LOOKS: u32 = 40;
    (0..=LOOKS)
        .map(|look| low + (high - low) * f64::from(look) / f64::from(LOOKS))
        .find(|t| apart(*t) <= bound[1])
}

/// A program that leaves CL points out, walked along the CL path: every place of it is within what is certified of a
/// place of the path that is not before the last, every CL point is near the program, and corners are met.
fn read_loosely(file: &Path, check: &Check) {
    const SAMPLES: u32 = 20;
    let name = format!("{} on {} {}", check.name, check.machine, check.with);
    let (done, summary) = post(file, check.machine, check.with);
    assert_eq!(done.code, 0, "{name}:\n{}", done.err);
    let summary = summary.unwrap();
    let text = fs::read_to_string(file).unwrap();
    let points = cl_points(&text, check.scale, check.with.contains("--msys apply"));
    let blocks = nc_blocks(&done.out, check.letters);
    let (mount, tool) = (V::from(check.mount), check.tool);
    let value = |key: &str| summary[key]["value"].as_f64().unwrap();
    let (tip, turn) = (value("tip_deviation_mm"), value("axis_deviation_deg"));
    assert!(tip <= summary["tolerance_mm"].as_f64().unwrap(), "{name}");
    let rapid = [value("rapid_deviation_mm") + 1e-6, f64::INFINITY];
    // The words' last decimal, and what is taken for the axis between two looks.
    let cut = [tip + 1e-6, turn + 1e-3];
    let mut tips = Vec::new();
    let mut ends = Vec::new();
    let (mut leg, mut least) = (0, 0.0);
    let mut last = blocks[0];
    let mut worst: f64 = 0.0;
    let nearby = |point: V, tips: &[V], window: usize| {
        let first = tips.len().saturating_sub(window);
        tips[first..]
            .windows(2)
            .map(|pair| beside(point, pair[0], pair[1]))
            .fold(f64::INFINITY, f64::min)
    };
    let mut passed = Vec::new();
    for (number, block) in blocks.iter().enumerate() {
        for sample in 0..=SAMPLES {
            let t = f64::from(sample) / f64::from(SAMPLES);
            let words = std::array::from_fn(|word| {
                last.words[word] + (block.words[word] - last.words[word]) * t
            });
            let pose = (check.forward)(words, mount, tool);
            tips.push(pose.tip);
            let bound = if block.rapid { rapid } else { cut };
            let found = (leg..(leg + 400).min(points.len() - 1)).find_map(|at| {
                let least = if at == leg { least } else { 0.0 };
                let t = first_within(&pose, &points[at], &points[at + 1], least, bound)?;
                Some((at, t))
            });
            let Some((at, t)) = found else {
                panic!("{name}: block {number} at {t} is off the path behind point {leg}");
            };
            passed.extend((leg..at).map(|index| (index + 1, tips.len())));
            (leg, least) = (at, t);
        }
        ends.push((block.words, tips.len()));
        last = *block;
    }
    assert!(leg + 2 >= points.len(), "{name}: {leg} of {}", points.len());
    // The chords of the samples stray from the blocks by a four hundredth of what those bow.
    for (index, at) in passed {
        let until = (at + 4).min(tips.len());
        let off = nearby(points[index].tip, &tips[..until], 40 * SAMPLES as usize);
        worst = worst.max(off);
        // A rapid ends beside its point by the words' rounding, which is not in what is certified of cuts.
        assert!(
            off <= (tip * 1.02).max(0.0009) + 1e-4,
            "{name}: point {index} is missed by {off}"
        );
        let Some(next) = points.get(index + 1) else {
            continue;
        };
        let ways = [
            points[index].tip - points[index - 1].tip,
            next.tip - points[index].tip,
        ];
        if ways.iter().any(|way| way.norm() < 0.01) || angle(ways[0], ways[1]) < 10.5 {
            continue;
        }
        let met = ends
            .iter()
            .skip(ends.partition_point(|(_, end)| end + 40 * (SAMPLES as usize) < at))
            .take_while(|(_, end)| *end <= at + 3 * SAMPLES as usize)
            .map(|(words, _)| ((check.forward)(*words, mount, tool).tip - points[index].tip).norm())
            .fold(f64::INFINITY, f64::min);
        assert!(met < 0.0012, "{name}: corner {index} is missed by {met}");
    }
    eprintln!(
        "{name}: {} points, {} blocks, certified {tip}, CL points within {worst}",
        points.len(),
        blocks.len()
    );
}

#[test]
fn reduced_programs_are_read_back() {
    let mut files = vec![(
        root().join(sample("blade.cls")),
        Check {
            mount: [3.0, -4.0, 5.0],
            ..check(
                "blade.cls",
                "ac-trunnion",
                "--tcp post --mount 3,-4,5",
                "XYZAC",
                ac_trunnion,
            )
        },
    )];
    if let Some(data) = shared("data/cl") {
        const CREO: &str = "creo5x_4r19415_finition.ncl";
        files.push((
            data.join(CREO),
            Check {
                mount: [-140.0, 21.0, -40.0],
                ..check(
                    CREO,
                    "ac-trunnion",
                    "--tcp post --units mm --mount -140,21,-40",
                    "XYZAC",
                    ac_trunnion,
                )
            },
        ));
        files.push((
            data.join(CREO),
            Check {
                mount: [-140.0, 21.0, 0.0],
                tool: 120.0,
                ..check(
                    CREO,
                    "dmu50",
                    "--tcp post --units mm --mount -140,21,0 --tool-length 120",
                    "XYZBC",
                    dmu50,
                )
            },
        ));
        files.push((
            data.join("own_ncl_form.as"),
            Check {
                scale: 25.4,
                tool: 100.0,
                ..check(
                    "own_ncl_form.as",
                    "nutating-head",
                    "--units inch --tcp post --tool-length 100",
                    "XYZBC",
                    nutating_head,
                )
            },
        ));
        files.push((
            data.join("nx_HumMan_ust_a2.cls"),
            check(
                "nx_HumMan_ust_a2.cls",
                "head-head-360",
                "--tcp post",
                "XYZAC",
                head_head,
            ),
        ));
    }
    for (file, case) in files {
        for placement in ["placement=bisect", "placement=fewest", "method=compensate"] {
            let with: &'static str = format!(
                "{} --set accuracy.reduce=true --set accuracy.{placement}",
                case.with
            )
            .leak();
            read_loosely(&file, &Check { with, ..case });
        }
    }
}

/// Arcs of NX go clockwise about their axis. Made the other way round they would be the outer three quarters of
/// their circles, and the axes would travel beyond the points of the file by up to a diameter.
#[test]
fn arcs_of_nx_stay_among_the_points_of_the_file() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    for (file, machine, arguments) in [
        ("nx_HumMan_cutcom.clsf", "vmc", ""),
        ("nx_HumMan__3_PAZ_125_N2.cls", "head-head", "--tool 1"),
    ] {
        let text = fs::read_to_string(folder.join(file)).unwrap();
        let points: Vec<Vec<f64>> = text
            .lines()
            .filter_map(|line| line.trim().strip_prefix("GOTO/"))
            .map(|rest| {
                rest.split(',')
                    .take(2)
                    .map(|number| number.trim().parse().unwrap())
                    .collect()
            })
            .collect();
        let (done, summary) = post(&folder.join(file), machine, arguments);
        let summary = summary.unwrap_or_else(|| panic!("{file}: {}", done.err));
        for (coordinate, name) in ["X", "Y"].into_iter().enumerate() {
            let axis = summary["axes"]
                .as_array()
                .unwrap()
                .iter()
                .find(|axis| axis["name"] == name)
                .unwrap();
            let span = axis["max"].as_f64().unwrap() - axis["min"].as_f64().unwrap();
            let values = points.iter().map(|point| point[coordinate]);
            let least = values.clone().fold(f64::INFINITY, f64::min);
            let most = values.fold(f64::NEG_INFINITY, f64::max);
            // A quarter of an arc may bulge beyond the points by a little.
            assert!(
                span < (most - least) * 1.02 + 1.0,
                "{file} {name}: {span} for {}",
                most - least
            );
        }
    }
}

/// Files whose tool axis moves.
const FIVE_AXES: [&str; 4] = [
    "creo5x_4r19415_finition.ncl",
    "nx_HumMan_ust_a.cls",
    "own_ncl_form.as",
    "swcam_aamorim_Teste-Metrologia.apt",
];

/// Rotary travel and changes of solution against the greedy choice (the nearest solution at each point, every
/// point met exactly): never more travel, whatever machine of the library reaches the file. Prints the table.
#[test]
fn the_choice_travels_no_farther_than_the_greedy_one() {
    let Some(folder) = shared("data/cl") else {
        return;
    };
    const GREEDY: &str = " --set solution.look_ahead=1 --set solution.pole=exact";
    let machines: Vec<String> = fs::read_dir(root().join("machines"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    let mut compared = 0;
    println!("file, machine: rotary travel in degrees (changes, rewinds), greedy: the same");
    for file in FIVE_AXES {
        let with = match file {
            "creo5x_4r19415_finition.ncl" => "--units mm --mount -140,21,-40",
            "nx_HumMan_ust_a.cls" => "--msys apply",
            "own_ncl_form.as" => "--units inch",
            _ => "",
        };
        for machine in &machines {
            let with = format!("--tool-length 150 --tcp post {with}");
            let travel = |more: &str| {
                let (run, summary) = post(&folder.join(file), machine, &format!("{with}{more}"));
                let told = |key: &str, summary: &Value| summary[key].as_u64().unwrap();
                summary.filter(|_| run.code == 0).map(|summary| {
                    let axes = summary["axes"].as_array().unwrap().iter();
                    let rotary = axes.filter(|axis| "ABC".contains(axis["name"].as_str().unwrap()));
                    (
                        rotary
                            .map(|axis| axis["way"].as_f64().unwrap())
                            .sum::<f64>(),
                        told("branch_changes", &summary),
                        told("rewinds", &summary),
                    )
                })
            };
            let (chosen, greedy) = (travel(""), travel(GREEDY));
            if let Some((way, changes, rewinds)) = chosen {
                let greedy_told = match greedy {
                    Some((way, changes, rewinds)) => format!("{way:.1} ({changes}, {rewinds})"),
                    None => "refused".to_owned(),
                };
                println!("{file}, {machine}: {way:.1} ({changes}, {rewinds}), {greedy_told}");
                compared += 1;
            }
            match (chosen, greedy) {
                (Some((way, ..)), Some((greedy, ..))) => {
                    assert!(way <= greedy + 0.1, "{file} on {machine}: {way} {greedy}");
                }
                (None, Some(_)) => panic!("{file} on {machine}: the greedy choice finds a way"),
                _ => {}
            }
        }
    }
    assert!(compared > 25, "{compared}");
}
