//! Where a part can sit: the nearest point of a body against all its faces, edges and corners, and what a program leaves
//! to the mount against isometries that put the part elsewhere.

use nalgebra::{Matrix3, Vector3};
use post_machine::description::{Machine, Source, load};
use post_machine::kinematics::Joints;
use post_machine::place::{
    HalfSpace, MountCost, MountRoom, descend, most_room, nearest, rounded, shuffled,
};
use post_testkit::{Rng, at_least, randomised};
use post_testmachines::Reference;

/// The nearest point by trying all: the wished point itself, its feet on planes and on the lines that two of them have in
/// common, and the points that three of them do.
fn nearest_of_all(bodies: &[HalfSpace], wished: &Vector3<f64>, room: f64) -> Option<Vector3<f64>> {
    let mut found = vec![*wished];
    for (i, a) in bodies.iter().enumerate() {
        let depth = |body: &HalfSpace| body.most - room;
        let square = a.normal.norm_squared();
        found.push(wished + a.normal * ((depth(a) - a.normal.dot(wished)) / square));
        for (j, b) in bodies.iter().enumerate().skip(i + 1) {
            // On the line of two planes, the point where the plane across it through the wished one meets it.
            let along = a.normal.cross(&b.normal);
            let rows = Matrix3::from_rows(&[
                a.normal.transpose(),
                b.normal.transpose(),
                along.transpose(),
            ]);
            if let Some(inverse) = rows.try_inverse() {
                found.push(inverse * Vector3::new(depth(a), depth(b), along.dot(wished)));
            }
            for c in &bodies[j + 1..] {
                let rows = [a, b, c].map(|body| body.normal.transpose());
                if let Some(inverse) = Matrix3::from_rows(&rows).try_inverse() {
                    found.push(inverse * Vector3::new(depth(a), depth(b), depth(c)));
                }
            }
        }
    }
    found.retain(|point| bodies.iter().all(|body| body.room(point) >= room - 1e-6));
    let distance = |point: &Vector3<f64>| (point - wished).norm();
    found.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn bodies(rng: &mut Rng) -> Vec<HalfSpace> {
    let middle = rng.point(200.0);
    (0..1 + rng.pick(14))
        .map(|_| {
            let normal = rng.direction() * rng.order(-0.5, 0.3);
            HalfSpace { normal, most: normal.dot(&middle) + rng.range(-20.0, 30.0) }
        })
        .collect()
}

#[test]
fn the_nearest_point_is_the_nearest_of_all() {
    let (rounds, mut rng) = randomised(4_000, 811);
    let (mut inside, mut none) = (0, 0);
    for round in rounds {
        let bodies = bodies(&mut rng);
        let (wished, room) = (rng.point(300.0), rng.range(-5.0, 8.0));
        let found = nearest(&bodies, &wished, room);
        let wanted = nearest_of_all(&bodies, &wished, room);
        match (found, wanted) {
            (Some(found), Some(wanted)) => {
                let apart = (found - wished).norm() - (wanted - wished).norm();
                assert!(apart.abs() < 1e-4, "round {round}: {found} {wanted}");
                assert!(bodies.iter().all(|body| body.room(&found) > room - 1e-5));
                inside += 1;
            }
            (None, None) => none += 1,
            // A body that is a point, to rounding.
            (found, wanted) => {
                let nudged = nearest_of_all(&bodies, &wished, room - 1e-4).is_some()
                    != nearest_of_all(&bodies, &wished, room + 1e-4).is_some();
                assert!(nudged, "round {round}: {found:?} {wanted:?}");
            }
        }
        // The order has no say.
        let again = nearest(&shuffled(bodies.clone()), &wished, room);
        match (found, again) {
            (Some(found), Some(again)) => assert!((found - again).norm() < 1e-3, "round {round}"),
            (None, None) => {}
            other => panic!("round {round}: {other:?}"),
        }
    }
    assert!(inside > at_least(500) && none > at_least(500), "{inside} {none}");
}

#[test]
fn the_most_room_is_what_no_grid_beats() {
    let (rounds, mut rng) = randomised(60, 812);
    for round in rounds {
        // Three pairs of ends, so that the room has an end: the least is that of the narrowest pair.
        let mut bodies = bodies(&mut rng);
        let middle = rng.point(50.0);
        for direction in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for normal in [direction, -direction] {
                let most = normal.dot(&middle) + rng.range(-20.0, 50.0);
                bodies.push(HalfSpace { normal, most });
            }
        }
        let tight = most_room(&bodies, &Vector3::zeros()).expect("a room");
        let room = |point: &Vector3<f64>| {
            let rooms = bodies.iter().map(|body| body.room(point));
            rooms.fold(f64::INFINITY, f64::min)
        };
        assert!((room(&tight.point) - tight.room).abs() < 1e-4, "round {round}");
        assert!(!tight.between.is_empty());
        assert!(nearest_of_all(&bodies, &Vector3::zeros(), tight.room + 1e-3).is_none());
        for cell in 0..21 * 21 * 21 {
            let at = [cell % 21, cell / 21 % 21, cell / 441];
            let step = Vector3::from(at.map(|at| f64::from(at) * 20.0 - 200.0));
            assert!(room(&(tight.point + step)) <= tight.room + 1e-4, "round {round}");
        }
    }
}

#[test]
fn few_decimals_and_a_way_down() {
    let below = |normal: Vector3<f64>, most: f64| HalfSpace { normal, most };
    let bodies = [below(Vector3::x(), 10.25), below(-Vector3::x(), -10.2)];
    let point = Vector3::new(10.2345, 7.7, 0.0);
    let rounded = rounded(&bodies, &point, 0.0).expect("a point between");
    assert_eq!(rounded, Vector3::new(10.2, 7.7, 0.0));
    // A bowl: the steps lead to its bottom as near as the last of them.
    let bottom = Vector3::new(33.0, -41.0, 5.0);
    let cost = |point: Vector3<f64>| (point.x < 50.0).then(|| 1.0 + (point - bottom).norm());
    let start = MountCost { mount: Vector3::zeros(), cost: 1.0 + bottom.norm() };
    let least = descend(start, &[100.0, 30.0, 10.0, 1.0], cost);
    assert_eq!(least, MountCost { mount: bottom, cost: 1.0 });
}

fn machine(name: &str, mount: Vector3<f64>) -> Machine {
    let path = post_testkit::repository().join(format!("machines/{name}.toml"));
    let text = std::fs::read_to_string(path).unwrap();
    let source = Source { name: name.to_owned(), text };
    let [x, y, z] = mount.into();
    let mount = post_machine::description::Setting::Mount([x, y, z]);
    load(source, &[mount], &mut |name| Err(name.to_owned())).unwrap()
}

fn reference(machine: &Machine, length: f64) -> Reference {
    Reference {
        joints: machine.axes.iter().map(|axis| axis.joint).collect(),
        mount: machine.mount,
        tip: machine.gauge - machine.tool_axis * length,
        axis: machine.tool_axis,
    }
}

/// What is left to each end of each linear axis.
fn rooms(machine: &Machine, joints: &Joints) -> Vec<(usize, bool, f64)> {
    let axes = machine.axes.iter().enumerate();
    axes.filter(|(_, axis)| !axis.joint.rotary)
        .filter_map(|(joint, axis)| Some((joint, joints[joint], axis.travel?)))
        .flat_map(|(joint, value, [least, most])| {
            [(joint, false, value - least), (joint, true, most - value)]
        })
        .collect()
}

#[test]
fn a_point_leaves_to_the_mount_what_isometries_say() {
    let (rounds, mut rng) = randomised(40, 813);
    for round in rounds {
        for name in [
            "ac-trunnion",
            "dmu50",
            "head-head",
            "nutating-head",
            "nutating-table",
            "head-table-ba",
            "disc-cutter",
            "hmc-b-pallet",
            "mill-turn",
        ] {
            let here = machine(name, rng.point(40.0));
            let length = rng.range(0.0, 150.0);
            let stands = reference(&here, length);
            let mut joints = Joints::default();
            for (value, axis) in joints.iter_mut().zip(&here.axes) {
                if axis.joint.rotary {
                    *value = rng.range(-2.0, 2.0);
                }
            }
            let tip = rng.point(150.0);
            let placed = stands.put(tip, joints);
            let mut room = MountRoom::new(&here).unwrap();
            assert!(room.bounds(), "{name}");
            room.take(&placed, 7);
            // The part elsewhere, the same point of it, the rotary axes as they were.
            let there = machine(name, rng.point(300.0));
            let moved = reference(&there, length).put(tip, placed);
            let wanted = rooms(&there, &moved);
            assert_eq!(room.ends().count(), wanted.len(), "{name}");
            for end in room.ends() {
                assert_eq!(end.line, 7);
                let same = |known: &&(usize, bool, f64)| {
                    (known.0, known.1) == (end.side.joint, end.side.largest)
                };
                let (.., wanted) = wanted.iter().find(same).unwrap();
                let said = end.body.room(&there.mount);
                assert!((said - wanted).abs() < 1e-8, "round {round}, {name}: {said} {wanted}");
            }
        }
    }
}

#[test]
fn the_way_between_two_points_is_looked_at_where_the_tip_goes_straight() {
    // B turns by 80° while the tip goes 1 mm: in the middle X and Z are far from both ends.
    let here = machine("dmu50", Vector3::zeros());
    let stands = reference(&here, 100.0);
    let turn = here.axes.iter().position(|axis| axis.name == "B").unwrap();
    let tips = [Vector3::new(80.0, 10.0, 30.0), Vector3::new(81.0, 10.0, 30.0)];
    let at = |t: f64| {
        let mut joints = Joints::default();
        joints[turn] = 0.2 + 1.4 * t;
        stands.put(tips[0] * (1.0 - t) + tips[1] * t, joints)
    };
    let mut room = MountRoom::new(&here).unwrap();
    room.take(&at(0.0), 1);
    room.take(&at(1.0), 2);
    room.take_between([(&at(0.0), &tips[0]), (&at(1.0), &tips[1])], 2);
    for step in 0..=100u32 {
        let joints = at(f64::from(step) / 100.0);
        for (joint, largest, left) in rooms(&here, &joints) {
            let ends =
                room.ends().filter(|end| (end.side.joint, end.side.largest) == (joint, largest));
            let least = ends.map(|end| end.body.room(&here.mount)).fold(f64::INFINITY, f64::min);
            assert!(least < left + 0.05, "axis {joint} at step {step}: {least} {left}");
        }
    }
}
