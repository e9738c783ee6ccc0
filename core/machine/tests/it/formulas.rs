//! Drives that formulas tell: those of the library's parallel machines against their joints, which are moved here; bounds on
//! ranges and speeds against many places; what cannot be said.

use std::fs;

use nalgebra::{Rotation3, Vector3};
use post_machine::description::{Machine, load};
use post_machine::kinematics::{Assembly, AxesWay, Joints, least_drive_minutes};
use post_testkit::{Rng, randomised, repository};

use crate::source;

type V = Vector3<f64>;

fn library(name: &str) -> Machine {
    let file = repository().join("machines").join(format!("{name}.toml"));
    let text = fs::read_to_string(file).unwrap();
    load(source(name, &text), &[], &mut |_| Err(String::new())).unwrap()
}

/// Axis values of a machine by the names of the axes, mm and radians.
fn named(machine: &Machine, values: &[(&str, f64)]) -> Joints {
    let mut joints = Joints::default();
    for (name, value) in values {
        joints[machine.axes.iter().position(|axis| axis.name == *name).unwrap()] = *value;
    }
    joints
}

/// A pose of a parallel head: the words, its drives, and the cosine between the tool and the platform's own up.
struct Pose {
    words: Vec<(&'static str, f64)>,
    drives: Vec<f64>,
    upright: f64,
}

/// Draws a pose.
type AnyPose = fn(&mut Rng) -> Pose;

/// The tool with the words C and A.
fn tool_ca(c: f64, a: f64) -> V {
    Rotation3::from_axis_angle(&V::z_axis(), c)
        * Rotation3::from_axis_angle(&V::x_axis(), a)
        * V::z()
}

/// A tube that swings by two angles in a universal joint, and slides.
fn tricept(rng: &mut Rng) -> Pose {
    let turn = Rotation3::from_axis_angle(&V::x_axis(), rng.range(-0.55, 0.55))
        * Rotation3::from_axis_angle(&V::y_axis(), rng.range(-0.55, 0.55));
    let (q, c, a) = (rng.range(750.0, 1150.0), rng.range(-3.0, 3.0), rng.range(-1.6, 1.6));
    let wrist = turn * (V::z() * -q);
    let drives = [90.0, 210.0, 330.0].map(|degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        let out = V::new(cosine, sine, 0.0);
        (turn * (out * 110.0 - V::z() * (q - 150.0)) - out * 400.0).norm()
    });
    Pose {
        words: vec![("X", wrist.x), ("Y", wrist.y), ("Z", wrist.z), ("C", c), ("A", a)],
        drives: drives.to_vec(),
        upright: (turn * V::z()).dot(&tool_ca(c, a)),
    }
}

/// Legs A and C turn about Y in one plane, on which the platform's own X stands upright; leg B stays across its own Y. Here Z
/// points downwards, and Y the other way.
fn exechon(rng: &mut Rng) -> Pose {
    let plane = Rotation3::from_axis_angle(&V::y_axis(), rng.range(-0.5, 0.5));
    let (out, along) = (rng.range(850.0, 1250.0), rng.range(-450.0, 450.0));
    let place = |out: f64, along: f64| plane * V::new(0.0, along, out);
    let origin = place(out, along);
    let b = V::new(345.5, 0.0, 0.0);
    // Of all turns in the plane the one with leg B across the platform's Y, found by halving.
    let turned = |beta: f64| plane * Rotation3::from_axis_angle(&V::x_axis(), beta);
    let lack = |beta: f64| (b - origin).dot(&(turned(beta) * V::y()));
    let [mut least, mut most] = [-1.5, 1.5];
    assert!(lack(least) * lack(most) < 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (least + most);
        let same = lack(middle) * lack(least) > 0.0;
        if same { least = middle } else { most = middle }
    }
    let turn = turned(0.5 * (least + most));
    let at = |own: V| origin + turn * own;
    let (c, a) = (rng.range(-3.0, 3.0), rng.range(-1.6, 1.6));
    let wrist = at(V::new(282.8, 0.0, -200.0));
    let up = turn * -V::z();
    Pose {
        words: vec![("X", wrist.x), ("Y", -wrist.y), ("Z", -wrist.z), ("C", c), ("A", a)],
        drives: vec![
            (at(V::new(0.0, -152.3, 40.0)) - place(102.3, -443.4)).norm(),
            (at(V::new(132.4, 0.0, 0.0)) - b).norm(),
            (at(V::new(0.0, 252.3, 23.0)) - place(152.3, 779.8)).norm(),
        ],
        upright: V::new(up.x, -up.y, -up.z).dot(&tool_ca(c, a)),
    }
}

/// A platform that leans without twist, each of its joints in a plane through the axis of the head; carriages above it.
fn z3(rng: &mut Rng) -> Pose {
    let (lean, towards) = (rng.range(0.01, 0.69), rng.range(-3.1, 3.1));
    let about = V::new(-libm::sin(towards), libm::cos(towards), 0.0);
    let turn = Rotation3::new(about * lean);
    let ways = [0.0, 120.0, 240.0].map(|degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        V::new(cosine, sine, 0.0)
    });
    let across = |way: V| V::new(-way.y, way.x, 0.0);
    // How far it goes aside: two of three planes say so, and the third agrees.
    let lacks = ways.map(|way| -(turn * (way * 250.0)).dot(&across(way)));
    let y = lacks[0];
    let x = (lacks[1] - across(ways[1]).y * y) / across(ways[1]).x;
    let aside = V::new(x, y, 0.0);
    assert!((across(ways[2]).dot(&aside) - lacks[2]).abs() < 1e-9);
    let portal = [rng.range(-900.0, 900.0), rng.range(-800.0, 800.0)];
    let z = rng.range(-600.0, 0.0);
    let carriage = |way: &V| {
        let joint = turn * (way * 250.0) + aside;
        let inwards = 350.0 - joint.dot(way);
        z + joint.z + (550.0 * 550.0 - inwards * inwards).sqrt()
    };
    let tool = turn * V::z();
    let mut drives: Vec<f64> = ways.iter().map(carriage).collect();
    drives.extend(portal);
    Pose {
        words: vec![
            ("X", portal[0] + x),
            ("Y", portal[1] + y),
            ("Z", z),
            ("B", libm::atan2(tool.x, tool.z)),
            ("A", -libm::asin(tool.y)),
        ],
        drives,
        upright: 1.0,
    }
}

/// An arm of six joints, their lines as of `kr6-r700`, whose wrist is bent down; its drives are angles.
fn kr6(rng: &mut Rng) -> Pose {
    let lines = [
        (V::new(0.0, 0.0, -1.0), V::zeros()),
        (V::y(), V::new(25.0, 0.0, 400.0)),
        (V::y(), V::new(340.0, 0.0, 400.0)),
        (-V::x(), V::new(0.0, 0.0, 435.0)),
        (V::y(), V::new(705.0, 0.0, 435.0)),
        (-V::x(), V::new(0.0, 0.0, 435.0)),
    ];
    loop {
        let ends = [(-1.0, 1.0), (-2.0, -0.4), (0.7, 2.3), (-1.0, 1.0), (-1.4, -0.35), (-1.0, 1.0)];
        let joints = ends.map(|(least, most)| rng.range(least, most));
        let moved = |point: V| {
            lines.iter().zip(joints).rev().fold(point, |point, ((about, through), angle)| {
                through + Rotation3::new(about * angle) * (point - through)
            })
        };
        let gauge = V::new(825.0, 0.0, 375.0);
        let [x, y, z] = [V::x(), V::y(), V::z()].map(|way| moved(gauge + way) - moved(gauge));
        let wrist = moved(V::new(705.0, 0.0, 435.0));
        // In front, with room to its line and to the ends of angles.
        let front = wrist.x * libm::cos(joints[0]) - wrist.y * libm::sin(joints[0]);
        if front < 200.0 || x.z.abs() > 0.9 {
            continue;
        }
        let words = [
            ("X", wrist.x),
            ("Y", wrist.y),
            ("Z", wrist.z),
            ("C", libm::atan2(x.y, x.x)),
            ("B", -libm::asin(x.z)),
            ("A", libm::atan2(y.z, z.z)),
        ];
        return Pose { words: words.to_vec(), drives: joints.to_vec(), upright: 1.0 };
    }
}

#[test]
fn formulas_of_the_library_are_those_of_joints_that_move() {
    let machines: [(&str, AnyPose); 4] =
        [("tricept", tricept), ("exechon", exechon), ("z3-head", z3), ("kr6-pose", kr6)];
    for (name, pose) in machines {
        let machine = library(name);
        let assembly = Assembly::new(machine.legs());
        let (rounds, mut rng) = randomised(2000, 0xf0a);
        for _ in rounds {
            let pose = pose(&mut rng);
            let joints = named(&machine, &pose.words);
            let drives = assembly.drives(&joints).unwrap();
            assert_eq!(drives.len(), pose.drives.len());
            for (is, expected) in drives.iter().zip(&pose.drives) {
                assert!((is - expected).abs() < 1e-7, "{name}: {drives:?} {:?}", pose.drives);
            }
            // The wrist's limit is passed where the tool leans against the platform by more than that.
            let most: f64 = if name == "tricept" { 100.0 } else { 95.0 };
            let lean = libm::acos(pose.upright.clamp(-1.0, 1.0)).to_degrees();
            let wrist = machine.limits.iter().rfind(|limit| limit.leg().is_none()).unwrap();
            if matches!(name, "tricept" | "exechon") && (lean - most).abs() > 0.2 {
                assert_eq!(wrist.holds(&joints), lean < most, "{name}: {lean}");
            }
            // And back, from another place near by.
            let near = std::array::from_fn(|place| {
                let turns = machine.axes.get(place).is_some_and(|axis| axis.joint.rotary);
                joints[place] + rng.range(-1.0, 1.0) * if turns { 0.01 } else { 3.0 }
            });
            let found = assembly.forward(&drives, &near).unwrap();
            for place in assembly.places() {
                assert!((found[*place] - joints[*place]).abs() < 1e-6, "{name}: {found:?}");
            }
        }
    }
    // The example of the paper, in mm.
    let machine = library("exechon");
    let joints = named(&machine, &[("X", 20.0), ("Y", -700.0), ("Z", -1020.0)]);
    let drives = Assembly::new(machine.legs()).drives(&joints).unwrap();
    for (is, published) in drives.iter().zip([1633.12, 1491.84, 912.24]) {
        assert!((is - published).abs() < 0.006, "{drives:?}");
    }
}

#[test]
fn what_is_told_of_a_formula_over_a_region_holds_all_over_it() {
    let machines: [(&str, AnyPose); 3] =
        [("tricept", tricept), ("exechon", exechon), ("z3-head", z3)];
    for (name, pose) in machines {
        let machine = library(name);
        let (rounds, mut rng) = randomised(150, 0xb0c5);
        for _ in rounds {
            let from = named(&machine, &pose(&mut rng).words);
            let size = [0.3, 3.0, 20.0][rng.pick(3)];
            let to = std::array::from_fn(|place| {
                let turns = machine.axes.get(place).is_some_and(|axis| axis.joint.rotary);
                from[place] + rng.range(-1.0, 1.0) * size * if turns { 0.01 } else { 1.0 }
            });
            let at = |share: f64| std::array::from_fn(|i| from[i] + share * (to[i] - from[i]));
            for leg in machine.legs() {
                let least = std::array::from_fn(|place| from[place].min(to[place]));
                let most = std::array::from_fn(|place| from[place].max(to[place]));
                let [first, last] = leg.range([&least, &most]).unwrap();
                for _ in 0..40 {
                    let inside =
                        std::array::from_fn(|i| from[i] + rng.range(0.0, 1.0) * (to[i] - from[i]));
                    let value = leg.value(&inside).unwrap();
                    assert!(first - 1e-9 <= value && value <= last + 1e-9, "{name}: {value}");
                }
                let one = std::iter::once(leg);
                let (minutes, _) =
                    least_drive_minutes(one, AxesWay::Straight, [&from, &to], 0.0).unwrap();
                let bound = minutes * leg.max_feed;
                let ends = (0..1000).map(|step| [f64::from(step), f64::from(step + 1)]);
                let ways = ends.map(|ends| ends.map(|end| leg.value(&at(end / 1000.0)).unwrap()));
                let speed = ways.map(|[a, b]| 1000.0 * (b - a).abs()).fold(0.0, f64::max);
                assert!(bound >= speed * (1.0 - 1e-9) - 1e-7, "{name}: {bound} {speed}");
                assert!(bound <= speed * 1.01 + 1e-3, "{name}: {bound} is told, {speed} is seen");
            }
        }
    }
}

#[test]
fn what_no_formula_can_be_is_refused() {
    let head =
        "name = \"m\"\nchain = \"[w b X Y Z t]\"\ntool.gauge = [0, 0, 0]\nparameters.far = 100\n";
    let axes = "[axis.X]\nlinear = [1, 0, 0]\ntravel = [-1, 1]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-1, 1]\n[axis.Z]\nlinear = [0, 0, 1]\ntravel = [-1, 1]\n[control]\ndialect = \"fanuc\"\n";
    for (text, code, said) in [
        ("[formulas]\nfar = \"2 * X\"\n", "machine-formula", "far is the name of something else"),
        ("[formulas]\nX = \"2 * Y\"\n", "machine-formula", "X is the name of something else"),
        ("[formulas]\nq = \"2 * W\"\n", "machine-formula", "W is neither"),
        ("[formulas]\nq = \"2 *\"\n", "machine-formula", "is missing at the end"),
        (
            "[formulas]\np = \"q + X\"\nq = \"p\"\n[[drive]]\nname = \"D\"\nis = \"p\"\n",
            "machine-formula",
            "in a circle",
        ),
        ("[[drive]]\nname = \"X\"\nis = \"Y\"\n", "machine-leg", "the name of another axis"),
        ("[[drive]]\nname = \"D\"\nis = \"far\"\n", "machine-drive", "names no axis"),
        ("[[drive]]\nname = \"D\"\nis = \"X\"\ntravel = [5, 4]\n", "machine-travel", "from 5 to 4"),
    ] {
        let text = format!("{head}{axes}{text}");
        let faults = load(source("m.toml", &text), &[], &mut |_| Err(String::new())).unwrap_err();
        let told = faults.iter().any(|fault| fault.code == code && fault.message.contains(said));
        assert!(told, "{text}: {faults:?}");
    }
}
