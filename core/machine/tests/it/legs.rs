//! Legs of parallel machines: the library's against the formulas of LinuxCNC's kinematics modules, written anew; bounds on
//! ranges and speeds against many places; Newton's way back; and what is proven of assemblies against determinants.

use std::fs;

use nalgebra::{Rotation3, SMatrix, Vector3};
use post_machine::description::{Machine, load};
use post_machine::kinematics::{
    Assembly, AssemblyProof, AxesWay, Joints, Leg, least_drive_minutes,
};
use post_testkit::{Rng, randomised, repository};

use crate::source;

type V = Vector3<f64>;

fn library(name: &str) -> Machine {
    let file = repository().join("machines").join(format!("{name}.toml"));
    let text = fs::read_to_string(file).unwrap();
    load(source(name, &text), &[], &mut |_| Err(String::new())).unwrap()
}

/// Axis values in the travel, by their names' places in the chain.
fn stance(rng: &mut Rng, machine: &Machine) -> Joints {
    let mut joints = Joints::default();
    for (place, axis) in machine.axes.iter().enumerate() {
        let [least, most] = axis.travel.unwrap();
        joints[place] = rng.range(least, most);
    }
    joints
}

/// lineardeltakins: carriage heights over the tip, R = 130.25 and L = 269.
fn linear_delta([x, y, z]: [f64; 3]) -> Vec<f64> {
    let (far, rod, half) = (130.25, 269.0_f64, 3f64.sqrt() / 2.0);
    let towers = [(0.0, far), (-half * far, -far / 2.0), (half * far, -far / 2.0)];
    towers.map(|(a, b)| z + (rod * rod - (a - x) * (a - x) - (b - y) * (b - y)).sqrt()).to_vec()
}

/// Where three spheres meet, the lower place: rotarydeltakins forward, from its hips' angles in degrees.
fn rotary_delta_forward(degrees: &[f64]) -> V {
    let (hip, thigh, shin, foot) = (254.0, 254.0, 355.6_f64, 152.4);
    let half = 3f64.sqrt() / 2.0;
    let out = [V::new(0.0, -1.0, 0.0), V::new(-half, 0.5, 0.0), V::new(half, 0.5, 0.0)];
    let [a, b, c] = [0, 1, 2].map(|leg| {
        let angle = degrees[leg].to_radians();
        out[leg] * (hip - foot + thigh * libm::cos(angle)) - V::z() * (thigh * libm::sin(angle))
    });
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(&ac);
    let centre = a
        + (normal.cross(&ab) * ac.norm_squared() + ac.cross(&normal) * ab.norm_squared())
            / (2.0 * normal.norm_squared());
    let height = (shin * shin - (centre - a).norm_squared()).sqrt();
    let up = normal.normalize() * normal.z.signum();
    centre - up * height
}

/// genhexkins: lengths of struts, from the tip of the platform and its roll, pitch and yaw.
fn hexapod(at: V, [roll, pitch, yaw]: [f64; 3]) -> Vec<f64> {
    const BASE: [[f64; 2]; 6] = [
        [-22.95, 13.25],
        [22.95, 13.25],
        [22.95, 13.25],
        [0.0, -26.5],
        [0.0, -26.5],
        [-22.95, 13.25],
    ];
    const PLATFORM: [[f64; 2]; 6] = [
        [-1.0, 11.5],
        [1.0, 11.5],
        [10.459, -4.884],
        [9.459, -6.616],
        [-9.459, -6.616],
        [-10.459, -4.884],
    ];
    let turn = Rotation3::from_euler_angles(roll, pitch, yaw);
    let end = |[x, y]: [f64; 2]| V::new(x, y, 0.0) * 25.4;
    let ends = BASE.iter().zip(PLATFORM);
    ends.map(|(base, platform)| (at + turn * end(platform) - end(*base)).norm()).collect()
}

/// tripodkins, which counts from its first joint.
fn tripod([x, y, z]: [f64; 3]) -> Vec<f64> {
    let (x, y) = (x + 500.0, y + 866.025 / 3.0);
    let ends = [V::zeros(), V::new(1000.0, 0.0, 0.0), V::new(500.0, 866.025, 0.0)];
    ends.map(|end| (V::new(x, y, z) - end).norm()).to_vec()
}

fn readings(machine: &Machine, joints: &Joints) -> Option<Vec<f64>> {
    machine.legs().map(|leg| Some(leg.reading(leg.value(joints)?))).collect()
}

#[test]
fn drives_are_those_of_linuxcnc() {
    for name in ["linear-delta", "rotary-delta", "tripod", "hexapod"] {
        let machine = library(name);
        let (rounds, mut rng) = randomised(2000, 0x1e65);
        let assembly = Assembly::new(machine.legs());
        let mut seen = 0;
        for _ in rounds {
            let joints = stance(&mut rng, &machine);
            let at = |name: &str| {
                let place = machine.axes.iter().position(|axis| axis.name == name);
                place.map_or(0.0, |place| joints[place])
            };
            let point = ["X", "Y", "Z"].map(at);
            let Some(shown) = readings(&machine, &joints) else {
                continue;
            };
            if name == "rotary-delta" {
                let inside = machine.limits.iter().all(|limit| limit.holds(&joints));
                if !inside {
                    continue;
                }
                let reached = rotary_delta_forward(&shown);
                assert!((reached - V::from(point)).norm() < 1e-8, "{name}: {reached} {point:?}");
            } else {
                let expected = match name {
                    "linear-delta" => linear_delta(point),
                    "tripod" => tripod(point),
                    _ => hexapod(point.into(), ["A", "B", "C"].map(at)),
                };
                for (shown, expected) in shown.iter().zip(&expected) {
                    assert!((shown - expected).abs() < 1e-9, "{name}: {shown} {expected}");
                }
            }
            seen += 1;
            // And back, from another place some way off.
            let mut near = joints;
            for (place, axis) in machine.axes.iter().enumerate() {
                near[place] += rng.range(-1.0, 1.0) * if axis.joint.rotary { 0.02 } else { 8.0 };
            }
            let drives = assembly.drives(&joints).unwrap();
            if assembly.drives(&near).is_some() {
                let found = assembly.forward(&drives, &near).unwrap();
                let miss = found.iter().zip(&joints).map(|(a, b)| (a - b).abs());
                assert!(miss.fold(0.0, f64::max) < 1e-7, "{name}: {found:?} {joints:?}");
            }
        }
        assert!(seen > 100, "{name}: {seen}");
    }
}

/// A leg of any kind on a chain of slides and turns, and a place at which it reaches with room to spare.
fn any_leg(rng: &mut Rng) -> (Machine, Joints) {
    let kind = rng.pick(3);
    let rod = rng.range(250.0, 400.0);
    let side = ["ahead", "behind"][rng.pick(2)];
    let point = |rng: &mut Rng, size: f64| {
        let point = rng.point(size);
        format!("[{}, {}, {}]", point.x, point.y, point.z)
    };
    let drive = match kind {
        0 => String::new(),
        1 => {
            let along = rng.direction();
            format!("slide = [{}, {}, {}]\nrod = {rod}\nside = {side:?}", along.x, along.y, along.z)
        }
        _ => {
            let about = rng.direction();
            let arm = about.cross(&rng.direction()).normalize() * rng.range(100.0, 200.0);
            format!(
                "shaft = [{}, {}, {}]\narm = [{}, {}, {}]\nrod = {rod}\nside = {side:?}",
                about.x, about.y, about.z, arm.x, arm.y, arm.z
            )
        }
    };
    let linear = |axis: &str| {
        format!(
            "[axis.{axis}]\nlinear = [{}, {}, {}]\ntravel = [-900, 900]\n",
            u8::from(axis == "X"),
            u8::from(axis == "Y"),
            u8::from(axis == "Z")
        )
    };
    let chain = ["[w b X Y Z B A (S) t]", "[w b B X Y Z A (S) t]"][rng.pick(2)];
    let text = format!(
        "name = \"leg\"\nchain = {chain:?}\ntool.gauge = [0, 0, -100]\n{}{}{}[axis.B]\nrotary = [0, 1, 0]\npoint = {}\ntravel = [-90, 90]\n[axis.A]\nrotary = [1, 0, 0]\npoint = {}\ntravel = [-90, 90]\n[control]\ndialect = \"fanuc\"\ntcp = \"post\"\n[[leg]]\nname = \"Q\"\nfrom = {}\nat = \"A\"\nto = {}\nmax_feed = 1000\n{drive}\n",
        linear("X"),
        linear("Y"),
        linear("Z"),
        point(rng, 60.0),
        point(rng, 60.0),
        point(rng, 150.0),
        point(rng, 150.0),
    );
    let machine = load(source("leg.toml", &text), &[], &mut |_| Err(String::new())).unwrap();
    let leg = machine.legs().next().unwrap().clone();
    loop {
        let joints: Joints = std::array::from_fn(|place| match machine.axes.get(place) {
            Some(axis) if axis.joint.rotary => rng.range(-0.8, 0.8),
            Some(_) => rng.range(-300.0, 300.0),
            None => 0.0,
        });
        // Where the drive is not steep: beside that nothing is proven.
        let rates = leg.rates(&joints);
        // Near its dead centres a crank turns by far more than a hundredth of a radian a mm.
        let size = if leg.turns() { 0.01 } else { 1.0 };
        let steep = |(place, rate): (usize, f64)| {
            let turns = machine.axes.get(place).is_some_and(|axis| axis.joint.rotary);
            rate.abs() > size * if turns { 400.0 } else { 2.0 }
        };
        if rates.is_some_and(|rates| !rates.into_iter().enumerate().any(steep)) {
            return (machine, joints);
        }
    }
}

fn only(machine: &Machine) -> &Leg {
    machine.legs().next().unwrap()
}

#[test]
fn what_is_told_of_a_region_holds_all_over_it() {
    let (rounds, mut rng) = randomised(600, 0x5eed);
    let mut told = 0;
    for _ in rounds {
        let (machine, from) = any_leg(&mut rng);
        let leg = only(&machine);
        let size = [0.3, 3.0, 30.0][rng.pick(3)];
        let mut to = from;
        for (place, axis) in machine.axes.iter().enumerate() {
            to[place] += rng.range(-1.0, 1.0) * size * if axis.joint.rotary { 0.01 } else { 1.0 };
        }
        let range = leg.range([&from, &to]);
        let fastest = least_drive_minutes(machine.legs(), AxesWay::Straight, [&from, &to], 0.0);
        let (mut least, mut most, mut speed) = (f64::INFINITY, f64::NEG_INFINITY, 0f64);
        let mut whole = true;
        let at = |share: f64| {
            leg.value(&std::array::from_fn(|place| from[place] + share * (to[place] - from[place])))
        };
        let seen = |share: f64| match (at(share), at(share + 1e-5)) {
            // Cranks count by turns.
            (Some(a), Some(b)) if leg.turns() => {
                libm::remainder(b - a, std::f64::consts::TAU).abs() / 1e-5
            }
            (Some(a), Some(b)) => (b - a).abs() / 1e-5,
            _ => 0.0,
        };
        let mut fast = 0.0;
        let mut way = 0.0;
        for step in 0..400 {
            let share = f64::from(step) / 400.0;
            way += seen(share) / 400.0;
            if seen(share) > speed {
                (speed, fast) = (seen(share), share);
            }
        }
        for step in 0..400 {
            let share = fast + (f64::from(step) / 200.0 - 1.0) / 400.0;
            speed = speed.max(seen(share.clamp(0.0, 1.0 - 1e-5)));
        }
        for _ in 0..200 {
            let corner: Joints = std::array::from_fn(|place| {
                rng.range(0.0, 1.0) * (to[place] - from[place]) + from[place]
            });
            match leg.value(&corner) {
                Some(value) => (least, most) = (least.min(value), most.max(value)),
                None => whole = false,
            }
        }
        // Cranks count by turns.
        if let Some([first, last]) = range.filter(|_| !leg.turns() || most - least < 3.0) {
            let turns = match leg.turns() {
                true => ((first + last - least - most) / 2.0 / std::f64::consts::TAU).round(),
                false => 0.0,
            };
            let [least, most] = [least, most].map(|end| end + turns * std::f64::consts::TAU);
            assert!(whole, "a value was told where there is none");
            assert!(first <= least + 1e-9 && most <= last + 1e-9, "{first} {least} {most} {last}");
            told += 1;
        }
        if let Some([first, last]) = range.filter(|_| size < 1.0 && most - least < 3.0) {
            let slack = (last - first) / (most - least).max(1e-9);
            assert!(slack < 4.0, "{slack} times too wide");
        }
        let Some((minutes, _)) = fastest.filter(|(minutes, _)| minutes.is_finite()) else {
            continue;
        };
        let bound = minutes * leg.max_feed;
        assert!(bound >= speed * (1.0 - 1e-6) - 1e-6, "{bound} is proven, {speed} is seen");
        // Where a rod comes to stand across its way the speed has a peak, which looks miss and halvings end in.
        if speed < 3.0 * way {
            assert!(bound <= speed * 1.03 + 1e-3, "{bound} is told, {speed} is seen");
        }
    }
    assert!(told > 50, "{told}");
}

#[test]
fn rates_are_those_of_small_steps() {
    let (rounds, mut rng) = randomised(600, 0x7a7e);
    for _ in rounds {
        let (machine, joints) = any_leg(&mut rng);
        let leg = only(&machine);
        let rates = leg.rates(&joints).unwrap();
        for place in leg.places() {
            let step = 1e-5;
            let at = |by: f64| {
                let mut there = joints;
                there[place] += by;
                leg.value(&there)
            };
            let (Some(before), Some(after)) = (at(-step), at(step)) else {
                continue;
            };
            let slope = (after - before) / (2.0 * step);
            assert!((slope - rates[place]).abs() < 1e-4 * (1.0 + slope.abs()), "{slope} {rates:?}");
        }
    }
}

#[test]
fn one_assembly_is_proven_where_determinants_keep_their_sign() {
    for (name, proven) in [("linear-delta", true), ("rotary-delta", true), ("tripod", true)] {
        let machine = library(name);
        let assembly = Assembly::new(machine.legs());
        let ends = [0, 1].map(|end| {
            std::array::from_fn(|place| {
                machine
                    .axes
                    .get(place)
                    .and_then(|axis| axis.travel)
                    .map_or(0.0, |travel| travel[end])
            })
        });
        let proof = assembly.prove([&ends[0], &ends[1]]);
        assert_eq!(matches!(proof, AssemblyProof::One { .. }), proven, "{name}: {proof:?}");
        let (rounds, mut rng) = randomised(500, 0xde7);
        let mut signs = [0; 2];
        for _ in rounds {
            let joints = stance(&mut rng, &machine);
            if machine.limits.iter().any(|limit| !limit.holds(&joints)) {
                continue;
            }
            let mut rates = SMatrix::<f64, 3, 3>::zeros();
            for (row, leg) in machine.legs().enumerate() {
                let of_leg = leg.rates(&joints).unwrap();
                (0..3).for_each(|column| rates[(row, column)] = of_leg[column]);
            }
            signs[usize::from(rates.determinant() > 0.0)] += 1;
        }
        assert!(signs.contains(&0), "{name}: {signs:?}");
    }
    // Through the plane of its three joints a tripod can be turned inside out.
    let text = fs::read_to_string(repository().join("machines/tripod.toml")).unwrap();
    let text = text.replace("travel   = [-900, -500]", "travel   = [-900, 100]");
    let text = text.replace("travel   = [650, 1150]", "travel   = [100, 1150]");
    let machine = load(source("tripod", &text), &[], &mut |_| Err(String::new())).unwrap();
    let assembly = Assembly::new(machine.legs());
    let ends: [Joints; 2] = [0, 1].map(|end| {
        std::array::from_fn(|place| {
            machine.axes.get(place).and_then(|axis| axis.travel).map_or(0.0, |travel| travel[end])
        })
    });
    let AssemblyProof::Open { beside } = assembly.prove([&ends[0], &ends[1]]) else {
        panic!("inside out is not told");
    };
    assert!(beside[2].abs() < 20.0, "{beside:?}");
}

/// Three struts around a tube that swings in a universal joint and slides through it, a wrist behind (Tricept).
#[test]
fn legs_of_a_tube_are_those_of_its_joints() {
    let ends: [V; 3] = [0.0, 120.0, 240.0].map(|degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        V::new(cosine, sine, 0.0)
    });
    let leg = |place: usize| {
        let [from, to] = [ends[place] * 500.0, ends[place] * 150.0];
        format!(
            "[[leg]]\nname = \"Q{place}\"\nfrom = [{}, {}, 0]\nat = \"W\"\nto = [{}, {}, -600]\ntravel = [400, 1300]\n",
            from.x, from.y, to.x, to.y
        )
    };
    let text = format!(
        "name = \"tube\"\nchain = \"[w b U V W C A (S) t]\"\nworkpiece.mount = [0, 0, -1100]\ntool.gauge = [0, 0, -700]\n[axis.U]\nrotary = [1, 0, 0]\npoint = [0, 0, 0]\ntravel = [-25, 25]\n[axis.V]\nrotary = [0, 1, 0]\npoint = [0, 0, 0]\ntravel = [-25, 25]\n[axis.W]\nlinear = [0, 0, 1]\ntravel = [-400, 150]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ntravel = [-200, 200]\n[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0, -650]\ntravel = [-100, 100]\n[control]\ndialect = \"siemens\"\ntcp = \"post\"\n{}{}{}",
        leg(0),
        leg(1),
        leg(2)
    );
    let machine = load(source("tube.toml", &text), &[], &mut |_| Err(String::new())).unwrap();
    let assembly = Assembly::new(machine.legs());
    let (rounds, mut rng) = randomised(2000, 0x70be);
    for _ in rounds {
        let joints = stance(&mut rng, &machine);
        let turn = Rotation3::from_axis_angle(&V::x_axis(), joints[0])
            * Rotation3::from_axis_angle(&V::y_axis(), joints[1]);
        let drives = assembly.drives(&joints).unwrap();
        for (end, drive) in ends.iter().zip(&drives) {
            let platform = turn * (end * 150.0 + V::z() * (joints[2] - 600.0));
            assert!(((platform - end * 500.0).norm() - drive).abs() < 1e-9);
        }
        let mut near = joints;
        (near[0], near[1], near[2]) = (near[0] + 0.03, near[1] - 0.02, near[2] + 20.0);
        let found = assembly.forward(&drives, &near).unwrap();
        let miss = found.iter().zip(&joints).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(miss < 1e-7, "{miss}");
    }
    let ends: [Joints; 2] = [0, 1].map(|end| {
        std::array::from_fn(|place| {
            machine.axes.get(place).and_then(|axis| axis.travel).map_or(0.0, |travel| travel[end])
        })
    });
    let proof = assembly.prove([&ends[0], &ends[1]]);
    assert!(matches!(proof, AssemblyProof::One { .. }), "{proof:?}");
}
