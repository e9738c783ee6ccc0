//! Tilted planes of the control: what the dialect is asked to write is turned back into the part by the convention of
//! its angles, and held against the CL file.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use post_machine::description::Machine;
use post_plugin::{Capabilities, PlaneAngles};
use post_posting::PostingRequest;
use post_posting::program::{DefaultSpindle, ReadingOptions};
use post_testkit::{Rng, randomised};
use post_testruns::posted::{AskedPlane, Recorder, Run, Samples, framed, watched};

use crate::holes::{TABLE, machine};

const HEAD: &str = "
[axis.B]
rotary = [0, 1, 0]
point = [0, 0, 560]
travel = [-120, 120]
max_feed = 9000
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
travel = [-400, 400]
max_feed = 9000
";

fn machines(tcp: &str) -> [(&'static str, Machine); 3] {
    let control = format!("tcp = \"{tcp}\"\nplanes = true");
    [
        ("table", machine("[w C' A' b Y X Z t]", TABLE, &control)),
        ("head", machine("[w b X Y Z C B t]", HEAD, &control)),
        ("both", machine("[w C' b X Y Z B t]", HEAD, &control)),
    ]
}

fn job() -> PostingRequest {
    PostingRequest {
        reading: ReadingOptions { spindle: DefaultSpindle::On(500.0), ..ReadingOptions::default() },
        tool_length: Some(150.0),
        ..PostingRequest::default()
    }
}

fn run(machine: &Machine, recorder: Recorder, cl: &str) -> Run {
    watched(machine, recorder, cl, job(), &mut Samples, &mut [])
}

/// Operations with a tool axis each, and the tip and the axis of every line.
struct Sides {
    cl: String,
    points: Vec<(u64, Vector3<f64>, Vector3<f64>)>,
}

fn sides(rng: &mut Rng, axes: &[Vector3<f64>]) -> Sides {
    let mut sides =
        Sides { cl: "UNITS/MM\nMULTAX/ON\nFEDRAT/500,MMPM\n".to_owned(), points: Vec::new() };
    for (tool, axis) in axes.iter().enumerate() {
        sides.cl += &format!("LOADTL/{}\n", tool + 1);
        let base = Vector3::from_fn(|_, _| rng.range(-40.0, 40.0)) + axis * 20.0;
        for place in 0..6 {
            let step = Vector3::from_fn(|_, _| rng.range(-10.0, 10.0));
            // Off the part before and behind.
            let lift = if place == 0 || place == 5 { 60.0 } else { 0.0 };
            let tip = (base + step + axis * lift).map(|value| (value * 1e4).round() / 1e4);
            if lift > 0.0 {
                sides.cl += "RAPID\n";
            }
            sides.cl += &format!(
                "GOTO/{},{},{},{:.9},{:.9},{:.9}\n",
                tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
            );
            let line = sides.cl.lines().count() as u64;
            sides.points.push((line, tip, *axis));
        }
    }
    sides
}

fn frame(convention: PlaneAngles, plane: &AskedPlane) -> Matrix3<f64> {
    let Some(order) = convention.order() else {
        return Matrix3::from_columns(&[plane.x, plane.z.cross(&plane.x), plane.z]);
    };
    let mut frame = Rotation3::identity();
    for (axis, turn) in order.into_iter().zip(plane.angles) {
        let about = frame.matrix().column(axis).into_owned();
        frame = Rotation3::from_axis_angle(&Unit::new_normalize(about), turn.to_radians()) * frame;
    }
    frame.into_inner()
}

/// Words of a plane that is not the one that the control has turned to would cut another part.
#[test]
fn words_and_angles_of_planes_lead_back_to_the_path() {
    let conventions = [
        PlaneAngles::Rotary,
        PlaneAngles::Zxz,
        PlaneAngles::Xyz,
        PlaneAngles::Zyx,
        PlaneAngles::Yxz,
    ];
    let (trials, mut rng) = randomised(30u32, 23);
    let (mut planes, mut farthest) = (0, 0.0_f64);
    for trial in trials {
        let convention = conventions[trial as usize % conventions.len()];
        let axes = [0, 1, 2].map(|side| {
            let lean: f64 = rng.range(0.01, 1.3);
            let about: f64 = rng.range(-3.1, 3.1);
            match side {
                // The pole: the first axis upright, where nothing need be told.
                0 => Vector3::z(),
                _ => Vector3::new(
                    libm::sin(lean) * libm::cos(about),
                    libm::sin(lean) * libm::sin(about),
                    libm::cos(lean),
                ),
            }
        });
        let sides = sides(&mut rng, &axes);
        for tcp in ["post", "control"] {
            for (name, machine) in machines(tcp) {
                let what = format!("{name} {tcp} {convention:?}\n{}", sides.cl);
                let recorder = Recorder::new(&machine, 3).with_planes(convention, 4);
                let run = run(&machine, recorder, &sides.cl).good(&what);
                let mut plane = None;
                for asked in &run.asked {
                    match asked.kind {
                        "Plane" => {
                            assert!(plane.is_none(), "{what}");
                            plane = asked.plane.clone();
                            planes += 1;
                        }
                        "PlaneOff" => {
                            assert!(plane.take().is_some(), "{what}");
                        }
                        // Off before the tool is changed, and before the program ends.
                        "ToolChange" | "End" => assert!(plane.is_none(), "{what}"),
                        _ => {}
                    }
                    let (Some(plane), "Position" | "Rapid" | "Linear") = (&plane, asked.kind)
                    else {
                        continue;
                    };
                    let told = frame(convention, plane);
                    let columns = [told.column(0).into_owned(), told.column(2).into_owned()];
                    assert!((columns[0] - plane.x).norm() < 1e-9, "{what}");
                    assert!((columns[1] - plane.z).norm() < 1e-9, "{what}");
                    let (_, tip, axis) = sides
                        .points
                        .iter()
                        .find(|(line, ..)| *line == asked.line)
                        .expect("the point of a line");
                    // Half a decimal of the rotary words, twice, and of the angles.
                    let lean = (plane.z - axis).norm();
                    assert!(lean < 3e-5, "{lean} {what}");
                    let words = Vector3::new(asked.words[0], asked.words[1], asked.words[2]);
                    let off = (plane.origin + told * words - tip).norm();
                    assert!(off < 0.001, "{off} {what}");
                    farthest = farthest.max(off);
                    assert_eq!(plane.words[3..5], asked.words[3..5], "{what}");
                }
                assert!(plane.is_none(), "{what}");
                let told = run.asked.iter().filter(|asked| asked.kind == "Plane");
                // Upright there is nothing to tell, unless the control would keep the tip.
                let wanted = if tcp == "control" { 3 } else { 2 };
                assert_eq!(told.count(), wanted, "{what}");
            }
        }
    }
    println!("{planes} planes, {:.2} µm off at most", farthest * 1e3);
}

/// The order in which a plane is told: the tool clear, the axes turned, the plane, then the way down in it; and back.
#[test]
fn a_plane_begins_and_ends_with_the_tool_clear_of_the_part() {
    let (_, mut rng) = randomised(1u32, 24);
    let leaning = Vector3::new(0.0, -0.6, 0.8);
    let side = sides(&mut rng, &[leaning]);
    for (name, machine) in machines("control") {
        let recorder = Recorder::new(&machine, 3).with_planes(PlaneAngles::Zxz, 3);
        let run = framed(&machine, recorder, &side.cl, job(), &mut Samples, &mut []).good(name);
        let kinds: Vec<_> = run.asked.iter().map(|asked| asked.kind).collect();
        // It returns to 0 for the tool change.
        let park = if name == "table" { &[][..] } else { &["Park"][..] };
        // Under a head that leans it comes to a place on the line of the tool first, the plane's Z, and leaves along it.
        let along = if name == "table" { &[][..] } else { &["Rapid"][..] };
        let expected = [
            &["Start", "Retract"][..],
            park,
            &["ToolChange", "Spindle", "Turn"],
            &["Plane", "Position"],
            along,
            &["Linear", "Linear", "Linear", "Linear", "Rapid"],
            along,
            &["Retract", "PlaneOff", "Spindle", "End"],
        ]
        .concat();
        let kinds: Vec<_> = kinds.into_iter().filter(|kind| *kind != "Comment").collect();
        assert_eq!(kinds, expected, "{name}");
        if name == "table" {
            continue;
        }
        let first = run.asked.iter().position(|asked| asked.kind == "Position");
        let [above, below] = [0, 1].map(|next| &run.asked[first.unwrap() + next].words);
        assert_eq!(above[..2], below[..2], "{name}");
        assert!(above[2] > below[2] + 1000.0, "{name}: {above:?} {below:?}");
    }
}

/// They are where the chain has two rotary axes, unless the machine file says otherwise; where the tool turns in a cut there
/// is none.
#[test]
fn planes_are_told_where_they_are_wanted_and_possible() {
    let (_, mut rng) = randomised(1u32, 25);
    let leaning = Vector3::new(0.0, -0.6, 0.8);
    let job = sides(&mut rng, &[leaning]);
    let turning = format!("{}GOTO/0,0,0,0.1,-0.6,0.79\n", job.cl);
    let upright = sides(&mut rng, &[Vector3::z()]).cl;
    let [(_, table), ..] = machines("post");
    let plain = machine("[w C' A' b Y X Z t]", TABLE, "tcp = \"post\"");
    let off = machine("[w C' A' b Y X Z t]", TABLE, "tcp = \"post\"\nplanes = false");
    // The control has not been told of an index table besides.
    let index = format!(
        "{HEAD}[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0, 0]\nindexed = 0\ncyclic = true\n"
    );
    let index = machine("[w A' b X Y Z C B t]", &index, "tcp = \"post\"");
    let can = |machine: &Machine| Recorder::new(machine, 3).with_planes(PlaneAngles::Zxz, 3);
    // The control has cycles, arcs and compensation in them.
    let whole = |machine: &Machine| {
        let mut recorder = can(machine);
        recorder.capabilities |= Capabilities::CYCLE_IN_PLANE;
        recorder
    };
    for (name, machine, recorder, cl, planes) in [
        ("wanted", &table, can(&table), &job.cl, 1),
        ("nothing said", &plain, whole(&plain), &job.cl, 1),
        ("nothing said, and cycles would be lost", &plain, can(&plain), &job.cl, 0),
        ("nothing said, and an index table", &index, whole(&index), &job.cl, 0),
        ("not wanted", &off, whole(&off), &job.cl, 0),
        ("not there", &table, Recorder::new(&table, 3), &job.cl, 0),
        ("turned in a cut", &table, can(&table), &turning, 0),
        ("upright", &table, can(&table), &upright, 0),
    ] {
        let run = run(machine, recorder, cl).good(name);
        let told = run.asked.iter().filter(|asked| asked.kind == "Plane").count();
        assert_eq!(told, planes, "{name}");
    }
}

/// In a plane a hole lies along its Z, whoever keeps the tip outside.
#[test]
fn holes_in_a_plane_are_cycles_along_its_normal() {
    const HOLES: &str = "UNITS/MM\nMULTAX/ON\nRAPID\nGOTO/0,0,100,0,-0.6,0.8\nCYCLE/DRILL,FEDTO,-10,RAPTO,2,RTRCTO,30,MMPM,250\n\
                         GOTO/1,8,6\nGOTO/9,8,6\nCYCLE/OFF\n";
    for tcp in ["post", "control"] {
        for (name, machine) in machines(tcp) {
            for in_plane in [false, true] {
                let mut recorder = Recorder::new(&machine, 3).with_planes(PlaneAngles::Zxz, 3);
                recorder.capabilities |= Capabilities::CYCLE_DRILL;
                if in_plane {
                    recorder.capabilities |= Capabilities::CYCLE_IN_PLANE;
                }
                let run = run(&machine, recorder, HOLES).good(name);
                let points: Vec<_> =
                    run.asked.iter().filter(|asked| asked.kind == "CyclePoint").collect();
                assert_eq!(points.len(), if in_plane { 2 } else { 0 }, "{name} {tcp}");
                let Some(cycle) = run.asked.iter().find_map(|asked| asked.cycle) else {
                    continue;
                };
                assert!((cycle.depth - 10.0).abs() < 0.0011, "{cycle:?}");
                let plane = run.asked.iter().find_map(|asked| asked.plane.clone()).unwrap();
                let told = frame(PlaneAngles::Zxz, &plane);
                for (point, tip) in points.iter().zip([[1.0, 8.0, 6.0], [9.0, 8.0, 6.0]]) {
                    let words = Vector3::new(point.words[0], point.words[1], point.words[2]);
                    let off = (plane.origin + told * words - Vector3::from(tip)).norm();
                    assert!(off < 0.001, "{name} {tcp} {off}");
                }
            }
        }
    }
}

/// In a plane an arc about its normal is an arc in X and Y, whoever keeps the tip outside.
#[test]
fn arcs_in_a_plane_are_laid_in_its_x_and_y() {
    const ARC: &str = "UNITS/MM\nMULTAX/ON\nFEDRAT/500,MMPM\nRAPID\nGOTO/10,-60,80,0,-0.6,0.8\nGOTO/10,0,0,0,-0.6,0.8\n\
                       CIRCLE/0,0,0,0,-0.6,0.8,10\nGOTO/0,8,6,0,-0.6,0.8\nRAPID\nGOTO/0,-60,80,0,-0.6,0.8\n";
    for tcp in ["post", "control"] {
        for (name, machine) in machines(tcp) {
            for in_plane in [false, true] {
                let mut recorder = Recorder::new(&machine, 3).with_planes(PlaneAngles::Zyx, 3);
                recorder.capabilities |= Capabilities::ARC_XY | Capabilities::HELIX;
                if in_plane {
                    recorder.capabilities |= Capabilities::CYCLE_IN_PLANE;
                }
                let run = run(&machine, recorder, ARC).good(name);
                let arcs: Vec<_> = run.asked.iter().filter(|asked| asked.arc.is_some()).collect();
                assert_eq!(arcs.len(), usize::from(in_plane), "{name} {tcp}");
                let (Some(asked), Some(plane)) =
                    (arcs.first(), run.asked.iter().find_map(|asked| asked.plane.clone()))
                else {
                    continue;
                };
                let arc = asked.arc.unwrap();
                let told = frame(PlaneAngles::Zyx, &plane);
                let centre = plane.origin + told * Vector3::from(arc.centre);
                assert!(centre.norm() < 0.002, "{name} {tcp} {centre}");
                let end = Vector3::new(asked.words[0], asked.words[1], asked.words[2]);
                let off = (plane.origin + told * end - Vector3::new(0.0, 8.0, 6.0)).norm();
                assert!(off < 0.001, "{name} {tcp} {off}");
                assert!((arc.turn - 90.0).abs() < 0.05, "{arc:?}");
                assert_eq!(arc.normal, [0.0, 0.0, 1.0]);
            }
        }
    }
}

/// A coordinate that is constant in the plane comes back from five decimals of the CL file with their noise: its word does
/// not jitter by a last digit, and what that costs is certified.
#[test]
fn constant_coordinates_of_a_plane_do_not_jitter() {
    let mut jitters = 0;
    for (name, machine) in machines("control") {
        let lean = Rotation3::from_euler_angles(0.3, 0.5, 0.2);
        let (x, y, z) = (lean * Vector3::x(), lean * Vector3::y(), lean * Vector3::z());
        let mut cl = "UNITS/MM\nMULTAX/ON\nLOADTL/1\nFEDRAT/500,MMPM\n".to_owned();
        let mut heights = Vec::new();
        for level in 0..40 {
            let height = 12.1625 + f64::from(level - 20) * 1e-6;
            for step in 0..25 {
                let tip = x * (f64::from(step) * 1.037) + y * f64::from(level) + z * height;
                cl += &format!(
                    "GOTO/{:.5},{:.5},{:.5},{:.9},{:.9},{:.9}\n",
                    tip.x, tip.y, tip.z, z.x, z.y, z.z
                );
                heights.push((cl.lines().count() as u64, level));
            }
        }
        let mut recorder = Recorder::new(&machine, 3);
        recorder.capabilities = Capabilities::PLANE;
        let done = run(&machine, recorder, &cl).good(name);
        assert!(done.asked.iter().any(|asked| asked.plane.is_some()), "{name}");
        let words: Vec<(i32, f64)> = done
            .motions()
            .iter()
            .filter_map(|asked| {
                let (_, level) = heights.iter().find(|(line, _)| *line == asked.line)?;
                Some((*level, asked.words[2]))
            })
            .collect();
        jitters += words
            .windows(2)
            .filter(|pair| pair[0].0 == pair[1].0 && pair[0].1 != pair[1].1)
            .count();
        let report = done.report.as_ref().unwrap();
        assert!(report.tip_deviation_mm.value < 0.0011, "{name} {:?}", report.tip_deviation_mm);
    }
    assert_eq!(jitters, 0);
}
