//! `post check` of chains of every kind: an arm, a SCARA, chains with too many axes or too few, and random ones. It ends
//! by design: what is counted is what was asked of the inverse, never the time.

use std::fmt::Write as _;

use nalgebra::Vector3;
use post_machine::check::{Check, InverseWork, compare};
use post_machine::description::{Machine, Source, load};
use post_machine::diagnostic::Diagnostic;
use post_testkit::{Rng, randomised};
use post_testmachines::{Reference, angle};

/// What any check may ask of the inverse: poses, and steps of searches.
const MOST: InverseWork = InverseWork { poses: 450_000, steps: 260_000 };

/// One axis: its name, the line that says how it moves, and where it may go.
struct Line<'a>(&'a str, &'a str, &'a str);

fn read(chain: &str, tool: &str, axes: &[Line<'_>]) -> Result<Machine, Vec<Diagnostic>> {
    let mut text = format!(
        "name = \"x\"\nchain = \"{chain}\"\n[control]\ndialect = \"fanuc\"\ntcp = \"post\"\n{tool}\n"
    );
    for Line(name, kind, travel) in axes {
        let _ = writeln!(text, "[axis.{name}]\n{kind}\n{travel}\nmax_feed = 9000");
    }
    let source = Source { name: "x.toml".to_owned(), text };
    load(source, &[], &mut |name| Err(name.to_owned()))
}

fn checked(machine: &Machine) -> Check {
    let check = Check::of(machine, 50.0).unwrap();
    let work = check.work;
    assert!(work.poses <= MOST.poses && work.steps <= MOST.steps, "{work:?}");
    check
}

const X: &str = "rotary = [1, 0, 0]";
const Y: &str = "rotary = [0, 1, 0]";
const Z: &str = "rotary = [0, 0, 1]";

/// A six-axis arm with the geometry of a common 20 kg robot, its spindle across the flange.
fn arm() -> Machine {
    let at = |direction: &str, point: &str| format!("{direction}\npoint = {point}");
    let lines = [
        at(Z, "[0, 0, 0]"),
        at(Y, "[300, 0, 500]"),
        at(Y, "[300, 0, 1400]"),
        at(X, "[0, 0, 1500]"),
        at(Y, "[1300, 0, 1500]"),
        at(X, "[0, 0, 1500]"),
    ];
    let travels =
        ["[-170, 170]", "[-90, 140]", "[-120, 155]", "[-350, 350]", "[-120, 120]", "[-350, 350]"]
            .map(|travel| format!("travel = {travel}"));
    let names = ["A", "B", "C", "U", "V", "W"];
    let axes: Vec<Line<'_>> =
        (0..6).map(|place| Line(names[place], &lines[place], &travels[place])).collect();
    read(
        "[w b A B C U V W (S) t]",
        "[workpiece]\nmount = [1200, 0, 500]\n[tool]\ngauge = [1500, 0, 1300]\naxis = [0, 0, 1]",
        &axes,
    )
    .unwrap()
}

fn scara(fourth: bool) -> Machine {
    let a = format!("{Z}\npoint = [0, 0, 0]");
    let b = format!("{Z}\npoint = [400, 0, 0]");
    let c = format!("{Z}\npoint = [700, 0, 0]");
    let mut axes = vec![
        Line("A", &a, "travel = [-150, 150]"),
        Line("B", &b, "travel = [-150, 150]"),
        Line("Z", "linear = [0, 0, 1]", "travel = [-200, 0]"),
    ];
    if fourth {
        axes.push(Line("C", &c, "travel = [-360, 360]"));
    }
    read(
        if fourth { "[w b A B Z C (S) t]" } else { "[w b A B Z (S) t]" },
        "[workpiece]\nmount = [500, 0, 0]\n[tool]\ngauge = [700, 0, 200]",
        &axes,
    )
    .unwrap()
}

fn reference(machine: &Machine) -> Reference {
    Reference {
        joints: machine.axes.iter().map(|axis| axis.joint).collect(),
        mount: machine.mount,
        tip: machine.gauge - machine.tool_axis * 50.0,
        axis: machine.tool_axis,
    }
}

/// It ran for nine minutes. An arm with a spindle has an axis to spare, so that nearly every direction can be made over
/// the bench; that the poses are true is the business of an independent product.
#[test]
fn an_arm_is_checked() {
    let machine = arm();
    let check = checked(&machine);
    assert!(check.solved.starts_with("closed form of a robot's arm"), "{}", check.solved);
    assert_eq!(check.warnings, Vec::<String>::new());
    assert!(check.reach.share_of_sphere > 0.99, "{:?}", check.reach);
    assert!(check.reach.ways_upright > 0);
    let typical = check.typical.unwrap();
    assert!(typical.at_least && typical.inside > 0);
    let reference = reference(&machine);
    for way in &typical.ways {
        let values: Vec<f64> = way.readings.iter().map(|r| r.value.to_radians()).collect();
        let (tip, axis) = reference.forward(&values);
        assert!(tip.norm() < 1e-8, "{tip}");
        assert!(angle(axis, Vector3::from(typical.axis)) < 1e-9);
    }
    assert_eq!(check.round_trip.not_found, 0);
    assert!(check.round_trip.tip_mm < 1e-8 && check.round_trip.axis_rad < 1e-8);
    // The drawing of an arm against itself, with one line a tenth of a millimetre off.
    let mut measured = machine.clone();
    measured.axes[2].joint.point.z += 0.1;
    let compared = compare(&measured, &machine, 50.0).unwrap();
    assert!((0.05..0.4).contains(&compared.tip_mm), "{}", compared.tip_mm);
}

/// Arms whose elbow reaches the origin both ways: two solutions, and the law of cosines gives them.
#[test]
fn a_scara_is_checked() {
    let check = checked(&scara(false));
    assert_eq!(check.reach.ways_upright, 2);
    assert_eq!(check.warnings, Vec::<String>::new());
    let volume = check.volume.unwrap();
    // Shoulder to origin 500 mm, upper arm 400, forearm 300: a right angle at the elbow.
    let elbow = volume.rotary.iter().find(|r| r.axis == "B").unwrap().value;
    assert!((elbow.abs() - 90.0).abs() < 1e-6, "{elbow}");
    let shoulder = volume.rotary.iter().find(|r| r.axis == "A").unwrap().value;
    let expected = 36.869_897_645_844;
    assert!((shoulder.abs() - expected).abs() < 1e-6, "{shoulder}");
    assert!(volume.least.is_none() && volume.most.is_none());
    let check = checked(&scara(true));
    assert!(check.reach.ways_upright >= 2);
    assert_eq!(check.warnings, Vec::<String>::new());
}

/// The reach of two arms on a portal without Z, worked out by hand: shoulder at 100 mm over the origin, 60 mm and then
/// 50 mm (the tool) down to it. The tip meets the origin where the upper arm makes up for the tool's height.
#[test]
fn borders_of_a_searched_reach_are_narrowed_down() {
    let c = format!("{Z}\npoint = [0, 0, 0]");
    let b = format!("{Y}\npoint = [0, 0, 100]");
    let v = format!("{Y}\npoint = [0, 0, 40]");
    let machine = read(
        "[w C' b X Y B V (S) t]",
        "[tool]\ngauge = [0, 0, 40]",
        &[
            Line("C", &c, "cyclic = true"),
            Line("X", "linear = [1, 0, 0]", "travel = [-300, 300]"),
            Line("Y", "linear = [0, 1, 0]", "travel = [-300, 300]"),
            Line("B", &b, "travel = [-170, 170]"),
            Line("V", &v, "travel = [-170, 170]"),
        ],
    )
    .unwrap();
    let check = checked(&machine);
    // Height of the wrist over the origin is 50·cos(tilt), that of the shoulder 100: 60·cos(B) makes up for the
    // rest where 100 - 50·cos(tilt) <= 60, so up to acos(0.8); farther ones are out of its arm.
    let most = libm::acos(0.8).to_degrees();
    let all = check.reach.tilt_in_all_azimuths_deg.unwrap();
    assert!((all - most).abs() < 0.01, "{all} for {most}");
    let some = check.reach.tilt_in_some_azimuth_deg.unwrap();
    assert!((some - most).abs() < 0.01, "{some} for {most}");
    let share = (1.0 - 0.8) / 2.0;
    assert!((check.reach.share_of_sphere - share).abs() < 0.02);
}

/// What cannot be solved says so in words of the field, with a remedy, and nothing of the code in it.
#[test]
fn chains_without_an_answer_are_refused_with_the_reason() {
    let a = format!("{X}\npoint = [0, 0, 0]");
    let b = format!("{Y}\npoint = [0, 0, 0]");
    let c = format!("{Z}\npoint = [0, 0, 0]");
    let c1 = format!("{Z}\npoint = [100, 0, 0]");
    let c2 = format!("{Z}\npoint = [0, 200, 0]");
    let turn = "travel = [-90, 90]";
    let slide = "travel = [-300, 300]";
    let [x, y, z] = ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"].map(|d| format!("linear = {d}"));
    let linear = || [Line("X", &x, slide), Line("Y", &y, slide), Line("Z", &z, slide)];
    let beside = |more: Vec<_>| linear().into_iter().chain(more).collect();
    let cases: Vec<(&str, Vec<Line<'_>>, &str)> = vec![
        (
            "[w b X Y Z W t]",
            beside(vec![Line("W", &z, slide)]),
            "4 linear axes move at once (X, Y, Z, W); the tip is placed by three",
        ),
        (
            "[w b A t]",
            vec![Line("A", &a, turn)],
            "0 linear and 1 rotary axes move by themselves: they cannot place the tip",
        ),
        (
            "[w b X U t]",
            vec![Line("X", &x, slide), Line("U", &x, slide)],
            "2 linear and 0 rotary axes move by themselves: they cannot place the tip",
        ),
        (
            // A planar arm: its tip never leaves its plane.
            "[w b A B C t]",
            vec![Line("A", &c, turn), Line("B", &c1, turn), Line("C", &c2, turn)],
            "all axes together move the tip over a surface alone: they do not span the space",
        ),
        (
            "[w A' b X Y Z B t]",
            beside(vec![Line("A", &a, turn), Line("B", &a, turn)]),
            "A and B turn about parallel axes: they cannot point the tool",
        ),
        (
            "[w A' B' C' b X Y Z U V W P Q R A1 t]",
            beside(vec![
                Line("A", &a, turn),
                Line("B", &b, turn),
                Line("C", &c, turn),
                Line("U", &a, turn),
                Line("V", &b, turn),
                Line("W", &c, turn),
                Line("P", &a, turn),
                Line("Q", &b, turn),
                Line("R", &c, turn),
                Line("A1", &a, turn),
            ]),
            "13 axes; at most 12 are possible",
        ),
    ];
    for (chain, axes, expected) in cases {
        let faults = read(chain, "[tool]\ngauge = [0, 0, 300]", &axes).unwrap_err();
        assert_eq!(faults[0].message, expected, "{chain}");
        plain(&faults);
        assert!(faults.iter().all(|fault| fault.help.is_some()), "{chain}");
    }
}

/// No type of the code stands in a message.
fn plain(faults: &[Diagnostic]) {
    for fault in faults {
        for odd in ["::", " {", "NoClosedForm", "Some(", "None"] {
            assert!(!fault.message.contains(odd), "{}", fault.message);
        }
    }
}

/// Three joints place a tip, and then nothing is left to choose where the tool points: solved, with a warning.
#[test]
fn a_chain_that_can_make_few_programs_says_so() {
    let a = format!("{Z}\npoint = [0, 0, 0]");
    let b = format!("{Y}\npoint = [300, 0, 500]");
    let c = format!("{Y}\npoint = [300, 0, 1400]");
    let turn = "travel = [-150, 150]";
    let machine = read(
        "[w b A B C (S) t]",
        "[workpiece]\nmount = [1200, 0, 300]\n[tool]\ngauge = [1300, 0, 1100]",
        &[Line("A", &a, turn), Line("B", &b, turn), Line("C", &c, turn)],
    )
    .unwrap();
    let check = checked(&machine);
    assert!(check.reach.tied_to_the_tip);
    let warnings = check.warnings.join("\n");
    assert!(
        warnings.contains("while the tool keeps its direction the tip can go over a surface alone"),
        "{warnings}"
    );
}

/// An index axis that is not solved for is put by posting where a path asks for it, so that what can be reached is what
/// one of its positions reaches. Against a count of directions by the product of isometries.
#[test]
fn positions_of_an_index_axis_add_to_the_reach() {
    let a = format!("{Y}\npoint = [0, 0, 60]");
    let c = format!("{Z}\npoint = [0, 0, 0]");
    let b = |more: &str| format!("{Y}\npoint = [0, 0, 400]\nindexed = 0{more}");
    let made = |b: &str| {
        let machine = read(
            "[w C' A' b X Y Z B (S) t]",
            "[tool]\ngauge = [0, 0, 300]",
            &[
                Line("C", &c, "cyclic = true"),
                Line("A", &a, "travel = [-30, 30]"),
                Line("X", "linear = [1, 0, 0]", "travel = [-900, 900]"),
                Line("Y", "linear = [0, 1, 0]", "travel = [-900, 900]"),
                Line("Z", "linear = [0, 0, 1]", "travel = [-900, 900]"),
                Line("B", b, "travel = [-10, 100]"),
            ],
        )
        .unwrap();
        let check = checked(&machine);
        (machine, check)
    };
    let (_, alone) = made(&b(""));
    // A cap of 30° is (1 - cos 30°)/2 of the sphere.
    assert!((alone.reach.share_of_sphere - 0.066_987).abs() < 0.002);
    let (machine, check) = made(&b("\npositions = [0, 90]"));
    // With B at 90° the tool lies, and A tilts it by 30° to both sides: half of the sphere more. By the isometries:
    let reference = reference(&machine);
    let (mut cells, bands) = (vec![false; 600 * 24], 600);
    for position in [0.0, 90.0] {
        for tilt in 0..=1200 {
            for turn in 0..72 {
                let tilted = -30.0 + f64::from(tilt) * 0.05;
                let values: Vec<f64> = machine
                    .axes
                    .iter()
                    .map(|axis| match axis.name.as_str() {
                        "A" => f64::to_radians(tilted),
                        "B" => f64::to_radians(position),
                        "C" => f64::to_radians(f64::from(turn) * 5.0),
                        _ => 0.0,
                    })
                    .collect();
                let (_, axis) = reference.forward(&values);
                // Bands of equal height have equal area.
                let band = (((axis.z + 1.0) / 2.0 * f64::from(bands)) as usize).min(599);
                let azimuth = libm::atan2(axis.y, axis.x) / std::f64::consts::TAU + 0.5;
                cells[band * 24 + ((azimuth * 24.0) as usize).min(23)] = true;
            }
        }
    }
    let share = cells.iter().filter(|made| **made).count() as f64 / cells.len() as f64;
    let told = check.reach.share_of_sphere;
    assert!((told - share).abs() < 0.02, "{told} for {share}");
    assert!((told - 0.566_987).abs() < 0.005, "{told}");
}

/// Upright at another position than the first, or within the tolerance of the tool axis, is upright.
#[test]
fn an_upright_tool_is_not_called_impossible_where_it_is_posted() {
    let a = format!("{X}\npoint = [0, 0, 60]");
    let c = format!("{Z}\npoint = [0, 0, 0]");
    let b = format!("{Y}\npoint = [0, 0, 400]\nindexed = 90\npositions = [0, 90]");
    let linear = |more: Vec<Line<'static>>| {
        let mut axes = vec![
            Line("X", "linear = [1, 0, 0]", "travel = [-900, 900]"),
            Line("Y", "linear = [0, 1, 0]", "travel = [-900, 900]"),
            Line("Z", "linear = [0, 0, 1]", "travel = [-900, 900]"),
        ];
        axes.extend(more);
        axes
    };
    let mut axes = linear(Vec::new());
    axes.extend([
        Line("C", &c, "cyclic = true"),
        Line("A", &a, "travel = [-30, 30]"),
        Line("B", &b, "travel = [-10, 100]"),
    ]);
    let machine = read("[w C' A' b X Y Z B (S) t]", "[tool]\ngauge = [0, 0, 300]", &axes).unwrap();
    assert!(checked(&machine).reach.ways_upright > 0);
    // 0.03° off, 0.05° are allowed; 0.06° are not.
    for (lean, ways) in [(5.2e-4, 1), (1.05e-3, 0)] {
        let machine = read(
            "[w b X Y Z (S) t]",
            &format!("[tool]\ngauge = [0, 0, 300]\naxis = [{lean}, 0, 1]"),
            &linear(Vec::new()),
        )
        .unwrap();
        assert_eq!(checked(&machine).reach.ways_upright, ways, "{lean}");
    }
}

/// Any chain of one to nine axes, sensible or not: the loader says why not, or the check comes to an end.
#[test]
fn random_chains_come_to_an_end() {
    let (rounds, mut rng) = randomised(250u16, 41);
    let (mut refused, mut closed, mut searched) = (0, 0, 0);
    let (mut poses, mut steps) = (0, 0);
    let mut round = 0;
    // One in twelve has a closed form: rounds go on until there are some.
    while round < rounds.end || closed.min(searched).min(refused) < 5 && round < 20 * rounds.end {
        round += 1;
        match random(&mut rng) {
            Err(faults) => {
                assert!(!faults.is_empty());
                plain(&faults);
                refused += 1;
            }
            Ok(machine) => {
                let check = match Check::of(&machine, rng.range(0.0, 200.0)) {
                    Ok(check) => check,
                    Err(lack) => {
                        plain(&[machine.unsolvable(&lack)]);
                        refused += 1;
                        continue;
                    }
                };
                let work = check.work;
                assert!(work.poses <= MOST.poses && work.steps <= MOST.steps, "{work:?}");
                poses = poses.max(work.poses);
                steps = steps.max(work.steps);
                assert!((0.0..=1.0 + 1e-9).contains(&check.reach.share_of_sphere));
                if check.solved == "closed form" {
                    closed += 1;
                } else {
                    searched += 1;
                }
            }
        }
    }
    println!(
        "{refused} refused, {closed} in closed form, {searched} searched; at most {poses} poses and {steps} steps"
    );
    assert!(refused >= 5 && closed >= 5 && searched >= 5);
}

fn random(rng: &mut Rng) -> Result<Machine, Vec<Diagnostic>> {
    const NAMES: [&str; 9] = ["X", "Y", "Z", "U", "V", "W", "A", "B", "C"];
    let count = 1 + rng.pick(9);
    let linear = [3, 3, 3, 3, 3, 2, 1, 0, 4][rng.pick(9)];
    let bed = rng.pick(count + 1);
    let (mut chain, mut axes) = ("[w".to_owned(), String::new());
    let mut kinds: Vec<bool> = (0..count).map(|place| place >= linear).collect();
    for place in (1..count).rev() {
        kinds.swap(place, rng.pick(place + 1));
    }
    for (place, rotary) in kinds.into_iter().enumerate() {
        if place == bed {
            chain.push_str(" b");
        }
        let prime = if place < bed { "'" } else { "" };
        let _ = write!(chain, " {}{prime}", NAMES[place]);
        let d = match rng.pick(3) {
            0 => rng.direction(),
            _ => [Vector3::x(), Vector3::y(), Vector3::z()][rng.pick(3)],
        };
        let kind = if rotary { "rotary" } else { "linear" };
        let _ =
            writeln!(axes, "[axis.{}]\n{kind} = [{:?}, {:?}, {:?}]", NAMES[place], d.x, d.y, d.z);
        if rotary {
            let p = rng.point(500.0);
            let _ = writeln!(axes, "point = [{:?}, {:?}, {:?}]", p.x, p.y, p.z);
        }
        axes.push_str(match (rotary, rng.pick(5)) {
            (true, 0) => "cyclic = true\n",
            (true, 1) => "travel = [-3599, 3599]\n",
            (true, 2) => "travel = [-0.001, 0.002]\n",
            (true, _) => "travel = [-120, 30]\n",
            (false, 0) => "travel = [-1e-3, 1e-3]\n",
            (false, _) => "travel = [-300, 300]\n",
        });
        axes.push_str(match rng.pick(24) {
            0 => "indexed = 0\n",
            1 => "indexed = 0\npositions = [0]\n",
            2 => "indexed = 0\nstep = 0.0005\n",
            3 => "indexed = 0\nstep = 7\n",
            4 if !rotary => "reserve = true\n",
            5 if !rotary => "share = 0.4\n",
            _ => "",
        });
    }
    if bed == count {
        chain.push_str(" b");
    }
    chain.push_str(" (S) t]");
    let (gauge, axis) = (rng.point(500.0), rng.direction());
    let across = axis.cross(&rng.direction());
    let edge = match rng.pick(4) {
        0 => format!("edge = [{:?}, {:?}, {:?}]\n", across.x, across.y, across.z),
        _ => String::new(),
    };
    let text = format!(
        "name = \"x\"\nchain = \"{chain}\"\n[tool]\ngauge = [{:?}, {:?}, {:?}]\naxis = [{:?}, {:?}, {:?}]\n{edge}[control]\ndialect = \"fanuc\"\ntcp = \"post\"\n{axes}",
        gauge.x, gauge.y, gauge.z, axis.x, axis.y, axis.z
    );
    let source = Source { name: "x.toml".to_owned(), text };
    load(source, &[], &mut |name| Err(name.to_owned()))
}
