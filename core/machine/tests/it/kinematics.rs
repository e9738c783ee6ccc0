//! Forward and inverse kinematics against an independent product of isometries, over random machines:
//! any directions, any lines, any order of the joints, zero to two free rotary axes and a held one,
//! linear axes in front of, between and behind the rotary ones. Reach is settled by scanning the angles.

use std::f64::consts::PI;

use nalgebra::{UnitQuaternion, Vector3};
use post_machine::kinematics::POLE;
use post_machine::kinematics::orientation::RotarySet;
use post_machine::kinematics::{Joints, Pose, Solver, Unreachable};
use post_testkit::{Rng, at_least, randomised};
use post_testmachines::{Random, angle, turned};

/// A pose of which the tool axis alone matters.
fn towards(axis: Vector3<f64>) -> Pose {
    Pose { axis, ..Pose::default() }
}

fn solver(machine: &Random) -> Solver {
    Solver::new(machine.reference.chain(), &machine.free, machine.held)
        .expect("a random machine has a closed form")
}

/// All sets of rotary angles for a wanted axis.
fn sets(
    solver: &Solver,
    wanted: Vector3<f64>,
    tolerance: f64,
) -> Result<Vec<RotarySet>, Unreachable> {
    let branches = solver.orient(&towards(wanted), tolerance)?;
    let sets: Vec<RotarySet> =
        (0..branches.count()).map(|index| solver.angles(&branches, index)).collect();
    if let [first, second] = *sets.as_slice() {
        // What lets the chooser skip the farther branch.
        let joint = solver.last_rotary();
        let apart = turned(first.joints[joint], second.joints[joint]).abs();
        assert!(apart >= branches.apart() - 1e-12, "{apart} {branches:?}");
    }
    Ok(sets)
}

/// Forward agrees with the isometries, the inverse finds every pose, each of its solutions leads back to the
/// pose, and where the axes are not near singular the values that the pose was made with are among them.
#[test]
fn every_solution_leads_back_to_the_pose() {
    let (rounds, mut rng) = randomised(12_000, 1);
    let (mut forward, mut tip, mut axis, mut own): (f64, f64, f64, f64) = (0.0, 0.0, 0.0, 0.0);
    let (mut poses, mut regular) = (0, 0);
    for round in rounds {
        let machine = Random::new(&mut rng, round % 3, usize::from(round % 7 < 2));
        let reference = &machine.reference;
        let solver = solver(&machine);
        for _ in 0..4 {
            let q = machine.values(&mut rng);
            let (wanted_tip, wanted_axis) = reference.forward(&q);
            let pose = solver.chain().forward(&q);
            forward =
                forward.max((pose.tip - wanted_tip).norm()).max((pose.axis - wanted_axis).norm());
            // Linear axes that rotary ones between them have laid flat cannot be solved well by anyone.
            if reference.volume(&q) < 0.1 {
                continue;
            }
            poses += 1;
            let solutions = solver
                .inverse(&pose, &Joints::default(), 1e-9)
                .unwrap_or_else(|fault| panic!("round {round}: {fault:?} at {q:?}"));
            for solution in &solutions {
                let (reached_tip, reached_axis) = reference.forward(solution);
                // Per metre: angles are exact to some 1e-16 rad, and the arms of these machines are metres long.
                let reach =
                    1.0_f64.max(solution.iter().map(|q| q.abs()).fold(0.0, f64::max) / 1000.0);
                tip = tip.max((reached_tip - wanted_tip).norm() / reach);
                axis = axis.max(angle(reached_axis, wanted_axis));
            }
            let slopes: Vec<Vector3<f64>> =
                machine.free.iter().map(|index| reference.axis_slope(&q, *index)).collect();
            let singular = match *slopes.as_slice() {
                [] => 1.0,
                [slope] => slope.norm(),
                [first, second] => first.cross(&second).norm(),
                _ => unreachable!(),
            };
            if singular < 0.05 {
                continue;
            }
            regular += 1;
            let nearest = solutions
                .iter()
                .map(|solution| {
                    (0..8)
                        .map(|index| match reference.joints.get(index) {
                            Some(joint) if joint.rotary => {
                                1000.0 * turned(q[index], solution[index]).abs()
                            }
                            _ => (q[index] - solution[index]).abs(),
                        })
                        .fold(0.0, f64::max)
                })
                .fold(f64::INFINITY, f64::min);
            own = own.max(nearest);
            assert!(nearest < 1e-7, "round {round}: {nearest} off {q:?}");
        }
    }
    println!(
        "{poses} poses, {regular} regular: forward {forward:.1e} mm, tip {tip:.1e} mm, axis {axis:.1e} rad, own values {own:.1e} mm at a metre"
    );
    assert!(poses > at_least(40_000) && regular > at_least(30_000));
    assert!(forward < 1e-10, "forward differs by {forward}");
    assert!(tip < 1e-9, "tip off by {tip}");
    assert!(axis < 1e-9, "axis off by {axis}");
}

/// The least angle between `wanted` and what two axes can point at, by scanning both angles and closing in.
fn scan(machine: &Random, wanted: Vector3<f64>) -> f64 {
    let reference = &machine.reference;
    let [first, second] = [machine.free[0], machine.free[1]];
    let k1 = nalgebra::Unit::new_normalize(reference.direction(&machine.held, first));
    // Both turned by their own angles about the directions they have at zero, the held axes where they stand.
    let k2 = nalgebra::Unit::new_normalize(reference.direction(&machine.held, second));
    let zero = reference.forward(&machine.held).1;
    let miss = |q1: f64, q2: f64| {
        let turn =
            UnitQuaternion::from_axis_angle(&k1, q1) * UnitQuaternion::from_axis_angle(&k2, q2);
        -wanted.dot(&(turn * zero))
    };
    let mut best = (f64::INFINITY, 0.0, 0.0);
    let look = |best: &mut (f64, f64, f64), step: f64, count: i32| {
        let (q1, q2) = (best.1, best.2);
        for i in -count..=count {
            for j in -count..=count {
                let (a, b) = (q1 + step * f64::from(i), q2 + step * f64::from(j));
                let value = miss(a, b);
                if value < best.0 {
                    *best = (value, a, b);
                }
            }
        }
    };
    look(&mut best, PI / 90.0, 90);
    let mut step = PI / 360.0;
    while step > 1e-9 {
        let before = best.0;
        look(&mut best, step, 4);
        if best.0 == before {
            step /= 2.0;
        }
    }
    let turn =
        UnitQuaternion::from_axis_angle(&k1, best.1) * UnitQuaternion::from_axis_angle(&k2, best.2);
    angle(turn * zero, wanted)
}

/// A wanted axis is refused exactly when no angles of the scan reach it, and the miss is the scan's.
#[test]
fn axes_out_of_reach_are_refused_by_the_angle_that_a_scan_finds() {
    let (rounds, mut rng) = randomised(240_u32, 2);
    let (mut refused, mut reached, mut worst): (u32, u32, f64) = (0, 0, 0.0);
    for round in rounds {
        let machine = Random::new(&mut rng, 2, usize::from(round.is_multiple_of(3)));
        let wanted = rng.direction();
        let least = scan(&machine, wanted);
        match sets(&solver(&machine), wanted, 1e-9) {
            Ok(_) => {
                assert!(least < 1e-6, "round {round}: accepted, but the scan misses by {least}");
                reached += 1;
            }
            Err(Unreachable::Axis { miss }) => {
                assert!(least > 1e-6, "round {round}: refused by {miss}, but the scan reaches it");
                worst = worst.max((miss - least).abs());
                refused += 1;
            }
            Err(other) => panic!("{other:?}"),
        }
    }
    println!("{reached} reached, {refused} refused, miss off by {worst:.1e} rad at most");
    assert!(reached > at_least(50) && refused > at_least(50));
    assert!(worst < 1e-6, "the miss differs from the scan's by {worst}");
}

/// One axis or none: the nearest orientation is taken within the tolerance, and refused beyond it.
#[test]
fn one_axis_or_none_takes_the_nearest_orientation() {
    let (rounds, mut rng) = randomised(2_000, 3);
    for round in rounds {
        let machine = Random::new(&mut rng, round % 2, 1);
        let reference = &machine.reference;
        let solver = solver(&machine);
        // Wanted axes from far off to hardly off.
        let q = machine.values(&mut rng);
        let wanted = (reference.forward(&q).1 + rng.direction() * rng.order(-6.0, 0.3)).normalize();
        let least = match *machine.free.as_slice() {
            [] => angle(reference.forward(&machine.held).1, wanted),
            [free] => {
                let at = |value: f64| {
                    let mut q = machine.held;
                    q[free] = value;
                    angle(reference.forward(&q).1, wanted)
                };
                let grid = (0..360).map(|step| f64::from(step) * PI / 180.0);
                let mut best = grid.min_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap();
                let mut step = PI / 180.0;
                while step > 1e-12 {
                    for other in [best - step, best + step] {
                        if at(other) < at(best) {
                            best = other;
                        }
                    }
                    step /= 1.5;
                }
                at(best)
            }
            _ => unreachable!(),
        };
        let found = sets(&solver, wanted, least * 1.0001 + 1e-7).unwrap();
        for set in &found {
            let reached = angle(reference.forward(&set.joints).1, wanted);
            assert!((reached - least).abs() < 1e-7, "round {round}: {reached} {least}");
        }
        if least > 1e-5 {
            let Err(Unreachable::Axis { miss }) = solver.orient(&towards(wanted), least * 0.999)
            else {
                panic!("round {round}: {least} was not refused");
            };
            assert!((miss - least).abs() < 1e-7, "round {round}: {miss} {least}");
        }
    }
}

/// A machine with two free axes that can point its tool along the first one, either way, and the axis itself.
fn pole(rng: &mut Rng, round: usize) -> (Random, Joints, Vector3<f64>) {
    let mut machine = Random::new(rng, 2, usize::from(round.is_multiple_of(3)));
    let q = machine.values(rng);
    let sign = if round.is_multiple_of(2) { 1.0 } else { -1.0 };
    let wanted = machine.reference.direction(&q, machine.free[0]) * sign;
    machine.reference.axis = machine.reference.rotation(&q).inverse() * wanted;
    (machine, q, wanted)
}

/// On the pole the first axis is free: any value of it gives the wanted axis, the last one is kept, and the
/// linear axes put the tip on its place all the same.
#[test]
fn on_the_pole_the_first_axis_is_free() {
    let (rounds, mut rng) = randomised(2_000, 4);
    let (mut axis_error, mut tip_error): (f64, f64) = (0.0, 0.0);
    for round in rounds {
        let (machine, q, wanted) = pole(&mut rng, round);
        let reference = &machine.reference;
        let solver = solver(&machine);
        for set in &sets(&solver, wanted, 1e-9).unwrap() {
            assert_eq!(set.free, 1 << machine.free[0], "round {round}");
            let mut joints = set.joints;
            joints[machine.free[0]] = rng.range(-PI, PI);
            axis_error = axis_error.max(angle(reference.forward(&joints).1, wanted));
        }
        if reference.volume(&q) < 0.1 {
            continue;
        }
        let tip = reference.forward(&q).0;
        let pose = Pose { tip, axis: wanted, ..Pose::default() };
        let solutions = solver.inverse(&pose, &q, 1e-9).unwrap();
        for solution in &solutions {
            assert_eq!(solution[machine.free[0]], q[machine.free[0]]);
            tip_error = tip_error.max((reference.forward(solution).0 - tip).norm());
        }
        let second = machine.free[1];
        let nearest = solutions
            .iter()
            .map(|solution| turned(q[second], solution[second]).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 2e-6 / 0.05, "round {round}: {nearest}");
    }
    println!("on the pole: axis {axis_error:.1e} rad, tip {tip_error:.1e} mm");
    assert!(axis_error <= 2.0 * POLE, "axis off by {axis_error}");
    assert!(tip_error < 1e-9, "tip off by {tip_error}");
}

/// Beside the pole, at every distance from it, the angles point the tool where it is wanted, to a rounding error
/// over the distance from the pole (and over the tilt between the two axes); nearer than `POLE` the first is free.
#[test]
fn beside_the_pole_the_tool_points_where_it_is_wanted() {
    let (rounds, mut rng) = randomised(4_000, 5);
    let (mut outside, mut inside): (f64, f64) = (0.0, 0.0);
    for round in rounds {
        let (machine, mut q, on_pole) = pole(&mut rng, round);
        q[machine.free[1]] += rng.order(-9.0, -1.0);
        let wanted = machine.reference.forward(&q).1;
        for set in &sets(&solver(&machine), wanted, 1e-9).unwrap() {
            let error = angle(machine.reference.forward(&set.joints).1, wanted);
            if set.free != 0 {
                assert!(angle(on_pole, wanted) < 1.01 * POLE);
                inside = inside.max(error);
            } else {
                outside = outside.max(error);
            }
        }
    }
    println!("beside the pole: {outside:.1e} rad, {inside:.1e} rad in the free zone");
    assert!(inside <= 2.0 * POLE, "{inside}");
    assert!(outside < 2e-8, "{outside}");
}

/// A pose beside the pole is reachable, so the inverse must find it, however near.
#[test]
fn the_inverse_finds_every_pose_beside_the_pole() {
    let (rounds, mut rng) = randomised(4_000, 7);
    let mut refused = Vec::new();
    for round in rounds {
        let (machine, mut q, on_pole) = pole(&mut rng, round);
        q[machine.free[1]] += rng.order(-7.0, -3.0);
        if machine.reference.volume(&q) < 0.1 {
            continue;
        }
        let (tip, axis) = machine.reference.forward(&q);
        if let Err(fault) =
            solver(&machine).inverse(&Pose { tip, axis, ..Pose::default() }, &q, 0.0)
        {
            refused.push((angle(axis, on_pole), fault));
        }
    }
    assert!(refused.is_empty(), "{} refused: {:?}", refused.len(), refused);
}

/// An axis that turns the tool about itself is free: its last value is kept, as `RotarySet::free` promises.
#[test]
fn an_axis_along_the_tool_keeps_its_value() {
    let (rounds, mut rng) = randomised(200, 6);
    for round in rounds {
        let mut machine = Random::new(&mut rng, 2, 0);
        let second = machine.free[1];
        machine.reference.axis = machine.reference.joints[second].direction;
        let q = machine.values(&mut rng);
        if machine.reference.volume(&q) < 0.1 {
            continue;
        }
        let (tip, axis) = machine.reference.forward(&q);
        let solutions =
            solver(&machine).inverse(&Pose { tip, axis, ..Pose::default() }, &q, 1e-9).unwrap();
        let kept =
            solutions.iter().any(|solution| turned(q[second], solution[second]).abs() < 1e-6);
        assert!(kept, "round {round}: {} became {}", q[second], solutions[0][second]);
    }
}
