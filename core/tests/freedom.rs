//! Chains with more freedom than a five-axis machine, or with none to spare, against an independent product of
//! isometries: three rotary axes and a leading edge, four linear axes, chains without a closed form, and machines
//! as they were measured.

mod common;

use std::f64::consts::PI;

use common::{Kind, Random, Rng, SIZE, across, angle, nearest, turned};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use post_core::kinematics::inverse::POLE;
use post_core::kinematics::{Freedom, Joints, Pose, Second, Solver, Unreachable};

/// The largest difference between two sets of values: mm, and radians as an arm of a metre.
fn apart(machine: &Random, a: &Joints, b: &Joints) -> f64 {
    let joints = machine.reference.joints.iter().enumerate();
    joints
        .map(|(index, joint)| {
            if joint.rotary {
                1000.0 * turned(a[index], b[index]).abs()
            } else {
                (a[index] - b[index]).abs()
            }
        })
        .fold(0.0, f64::max)
}

/// How large the values are: rounding errors grow with them, per metre.
fn reach(values: &Joints) -> f64 {
    values.iter().fold(1.0, |reach: f64, value| reach.max(value.abs() / 1000.0))
}

/// A machine with three rotary axes that a tool frame fixes, no two neighbours of which are nearly parallel.
fn three(rng: &mut Rng, held: usize) -> Random {
    let mut kinds = vec![Kind::Linear; 3];
    kinds.extend([Kind::Free; 3]);
    kinds.extend(vec![Kind::Held; held]);
    loop {
        let machine = Random::of(rng, &kinds);
        let reference = &machine.reference;
        let k = |index: usize| reference.direction(&machine.held, machine.free[index]);
        if k(0).cross(&k(1)).norm() > 0.05
            && k(1).cross(&k(2)).norm() > 0.05
            && reference.volume(&machine.held) > 0.2
        {
            return machine;
        }
    }
}

/// Every solution for tip, axis and edge leads back to them, there are two at most, and the values that the pose
/// was made with are one of them.
#[test]
fn three_rotary_axes_follow_a_tool_frame() {
    let mut rng = Rng(11);
    let (mut tip, mut axis, mut edge, mut own): (f64, f64, f64, f64) = (0.0, 0.0, 0.0, 0.0);
    let (mut poses, mut regular, mut counts) = (0, 0, [0; 3]);
    for round in 0..4_000 {
        let machine = three(&mut rng, usize::from(round % 3 == 0));
        let reference = &machine.reference;
        let leading = across(&mut rng, reference.axis);
        let chain = reference.chain().with_edge(Some(leading));
        let solver = Solver::new(chain, &machine.free, machine.held).expect("a closed form");
        assert!(solver.closed_form());
        for _ in 0..4 {
            let q = machine.values(&mut rng);
            if reference.volume(&q) < 0.1 {
                continue;
            }
            let (wanted_tip, wanted_axis) = reference.forward(&q);
            let wanted_edge = reference.taken(&q, leading);
            let pose = solver.chain().forward(&q);
            assert!((pose.tip - wanted_tip).norm() < 1e-9);
            assert!((pose.axis - wanted_axis).norm() < 1e-12);
            assert!((pose.edge - wanted_edge).norm() < 1e-12);
            poses += 1;
            let solutions = solver
                .inverse(&pose, &machine.held, 1e-9)
                .unwrap_or_else(|fault| panic!("round {round}: {fault:?} at {q:?}"));
            counts[solutions.len()] += 1;
            for solution in &solutions {
                let reached = reference.forward(solution);
                let per = reach(solution);
                tip = tip.max((reached.0 - wanted_tip).norm() / per);
                axis = axis.max(angle(reached.1, wanted_axis));
                edge = edge.max(angle(reference.taken(solution, leading), wanted_edge));
                for (index, value) in solution.iter().enumerate().take(reference.joints.len()) {
                    let held = reference.joints[index].rotary && !machine.free.contains(&index);
                    assert!(!held || *value == machine.held[index]);
                }
            }
            let k: Vec<Vector3<f64>> = machine
                .free
                .iter()
                .map(|index| reference.direction(&q, *index))
                .collect();
            if Matrix3::from_columns(&k).determinant().abs() < 0.05 {
                continue;
            }
            regular += 1;
            let nearest = solutions
                .iter()
                .map(|solution| apart(&machine, &q, solution))
                .fold(f64::INFINITY, f64::min);
            own = own.max(nearest);
            assert!(nearest < 1e-7, "round {round}: {nearest} off {q:?}");
        }
    }
    println!(
        "{poses} frames, {regular} regular, with 0, 1, 2 solutions {counts:?}: tip {tip:.1e} mm, axis {axis:.1e} rad, edge {edge:.1e} rad, own values {own:.1e} mm at a metre"
    );
    assert!(poses > 10_000 && regular > 8_000);
    assert!(counts[0] == 0 && counts[2] > poses / 2);
    assert!(tip < 1e-9, "tip off by {tip}");
    assert!(axis < 1e-9 && edge < 1e-9, "axis off by {axis}, edge by {edge}");
}

/// A frame is reached exactly when the first two axes can bring the third one to where the frame wants it, and
/// refused by the angle that they miss it by.
#[test]
fn frames_out_of_reach_are_refused_by_what_the_third_axis_misses() {
    let mut rng = Rng(12);
    let (mut reached, mut refused, mut worst) = (0, 0, 0.0f64);
    for round in 0..400_u32 {
        let machine = three(&mut rng, usize::from(round.is_multiple_of(3)));
        let reference = &machine.reference;
        let leading = across(&mut rng, reference.axis);
        let chain = reference.chain().with_edge(Some(leading));
        let solver = Solver::new(chain, &machine.free, machine.held).expect("a closed form");
        let wanted = Rotation3::from_axis_angle(
            &Unit::new_normalize(rng.direction()),
            rng.range(-PI, PI),
        );
        let pose = Pose {
            axis: wanted * reference.axis,
            edge: wanted * leading,
            ..Pose::default()
        };
        // The third axis turns with the tool, so the tool's frame says where it goes: seen from the tool it lies
        // still. What stands behind it is held.
        let [first, second, third] = [machine.free[0], machine.free[1], machine.free[2]];
        let at_zero = {
            let mut q = machine.held;
            for joint in &machine.free {
                q[*joint] = 0.0;
            }
            reference.rotation(&q).inverse() * reference.direction(&q, third)
        };
        let least = nearest(reference, &machine.held, [first, second], at_zero, wanted * at_zero);
        match solver.orient(&pose, 1e-9) {
            Ok(_) => {
                assert!(least < 1e-6, "round {round}: accepted, but a scan misses by {least}");
                reached += 1;
            }
            Err(Unreachable::Axis { miss }) => {
                assert!(least > 1e-6, "round {round}: refused by {miss}, but a scan reaches it");
                worst = worst.max((miss - least).abs());
                refused += 1;
            }
            Err(other) => panic!("{other:?}"),
        }
    }
    println!("{reached} frames reached, {refused} refused, miss off by {worst:.1e} rad at most");
    assert!(reached > 50 && refused > 50);
    assert!(worst < 1e-6, "{worst}");
}

/// Directions of the linear joints at `q`, part frame.
fn ways(machine: &Random, q: &Joints) -> Vec<(usize, Vector3<f64>)> {
    let reference = &machine.reference;
    reference
        .linear()
        .into_iter()
        .map(|index| (index, reference.direction(q, index)))
        .collect()
}

/// The volume that three of four linear axes span; axis `extra` is left out, and `beside` goes along `along`.
fn volume(
    ways: &[(usize, Vector3<f64>)],
    extra: usize,
    beside: usize,
    along: Option<Vector3<f64>>,
) -> f64 {
    let columns: Vec<Vector3<f64>> = ways
        .iter()
        .filter(|(index, _)| *index != extra)
        .map(|(index, way)| match along {
            Some(along) if *index == beside => along,
            _ => *way,
        })
        .collect();
    Matrix3::from_columns(&columns).determinant().abs()
}

/// A machine with four linear axes and up to two rotary ones, and of the linear ones two: the quill, and the axis
/// that it runs beside.
fn four(rng: &mut Rng, round: usize) -> (Random, usize, usize) {
    let mut kinds = vec![Kind::Linear; 4];
    kinds.extend(vec![Kind::Free; round % 3]);
    kinds.extend(vec![Kind::Held; usize::from(round % 7 == 0)]);
    loop {
        let machine = Random::of(rng, &kinds);
        if let [a, b] = *machine.free.as_slice()
            && machine
                .reference
                .direction(&machine.held, a)
                .cross(&machine.reference.direction(&machine.held, b))
                .norm()
                < 0.05
        {
            continue;
        }
        let linear = machine.reference.linear();
        let quill = linear[rng.pick(4)];
        let beside = loop {
            let beside = linear[rng.pick(4)];
            if beside != quill {
                break beside;
            }
        };
        if volume(&ways(&machine, &machine.held), quill, beside, None) > 0.2 {
            return (machine, quill, beside);
        }
    }
}

/// The inverse of a pose made at `q` with the reference; every solution is put through the isometries.
fn solutions(solver: &Solver, machine: &Random, q: &Joints) -> (Vec<Joints>, f64) {
    let (tip, axis) = machine.reference.forward(q);
    let pose = Pose {
        tip,
        axis,
        ..Pose::default()
    };
    let found = solver
        .inverse(&pose, &machine.held, 1e-9)
        .unwrap_or_else(|fault| panic!("{fault:?} at {q:?}"));
    let mut worst = 0.0f64;
    for solution in &found {
        let reached = machine.reference.forward(solution);
        worst = worst.max((reached.0 - tip).norm() / reach(solution));
        assert!(angle(reached.1, axis) < 2.0 * POLE, "{q:?}");
    }
    (found, worst)
}

#[test]
fn a_fourth_linear_axis_that_is_held_stands_still() {
    let mut rng = Rng(13);
    let (mut tip, mut poses) = (0.0f64, 0);
    for round in 0..3_000 {
        let (machine, quill, beside) = four(&mut rng, round);
        let mut held = machine.held;
        held[quill] = rng.range(-SIZE, SIZE);
        let freedom = Freedom {
            rotary: machine.free.clone(),
            still: vec![quill],
            held,
            seconds: Vec::new(),
        };
        let solver = Solver::with(machine.reference.chain(), &freedom).expect("a closed form");
        for _ in 0..3 {
            let mut q = machine.values(&mut rng);
            q[quill] = held[quill];
            if volume(&ways(&machine, &q), quill, beside, None) < 0.1 {
                continue;
            }
            poses += 1;
            let machine = Random {
                reference: machine.reference.clone(),
                free: machine.free.clone(),
                held,
            };
            let (found, worst) = solutions(&solver, &machine, &q);
            tip = tip.max(worst);
            assert!(found.iter().all(|solution| solution[quill] == held[quill]));
        }
    }
    println!("{poses} poses with a held quill: tip {tip:.1e} mm");
    assert!(poses > 4_000 && tip < 1e-9, "{poses} {tip}");
}

#[test]
fn a_quill_takes_its_share() {
    let mut rng = Rng(14);
    let (mut tip, mut poses, mut shares) = (0.0f64, 0, 0.0f64);
    for round in 0..3_000 {
        let (machine, quill, beside) = four(&mut rng, round);
        // Both ends of the range as well.
        let share = [0.0, 1.0, rng.range(0.0, 1.0), 0.5][rng.pick(4)];
        let freedom = Freedom {
            rotary: machine.free.clone(),
            held: machine.held,
            seconds: vec![(
                quill,
                Second::Share { of: beside, share },
                [f64::NEG_INFINITY, f64::INFINITY],
            )],
            ..Freedom::default()
        };
        let solver = Solver::with(machine.reference.chain(), &freedom).expect("a closed form");
        for _ in 0..3 {
            let mut q = machine.values(&mut rng);
            let way = rng.range(-SIZE, SIZE);
            q[quill] = way * share;
            q[beside] = way * (1.0 - share);
            let ways = ways(&machine, &q);
            let along = |joint: usize| {
                let found = ways.iter().find(|(index, _)| *index == joint);
                found.expect("a linear axis").1
            };
            let both = along(beside) * (1.0 - share) + along(quill) * share;
            if volume(&ways, quill, beside, Some(both)) < 0.1 {
                continue;
            }
            poses += 1;
            let (found, worst) = solutions(&solver, &machine, &q);
            tip = tip.max(worst);
            for solution in &found {
                let whole = solution[quill] + solution[beside];
                shares = shares.max((solution[quill] - whole * share).abs());
            }
        }
    }
    println!("{poses} poses with a shared quill: tip {tip:.1e} mm, share off by {shares:.1e} mm");
    assert!(poses > 4_000 && tip < 1e-9 && shares < 1e-9, "{poses} {tip} {shares}");
}

#[test]
fn a_quill_in_reserve_moves_where_the_other_ends() {
    let mut rng = Rng(15);
    let (mut tip, mut inside, mut beyond) = (0.0f64, 0, 0);
    for round in 0..4_000 {
        let (machine, quill, beside) = four(&mut rng, round);
        let middle = rng.range(-200.0, 200.0);
        let travel = [middle - rng.range(0.0, 300.0), middle + rng.range(0.0, 300.0)];
        let freedom = Freedom {
            rotary: machine.free.clone(),
            held: machine.held,
            seconds: vec![(quill, Second::Reserve { of: beside }, travel)],
            ..Freedom::default()
        };
        let solver = Solver::with(machine.reference.chain(), &freedom).expect("a closed form");
        for _ in 0..3 {
            // The pose is one that the other axis would reach alone.
            let mut q = machine.values(&mut rng);
            q[quill] = 0.0;
            let ways = ways(&machine, &q);
            let found = ways.iter().find(|(index, _)| *index == quill);
            let along = found.expect("a linear axis").1;
            if volume(&ways, quill, beside, None) < 0.1
                || volume(&ways, quill, beside, Some(along)) < 0.1
            {
                continue;
            }
            let (found, worst) = solutions(&solver, &machine, &q);
            tip = tip.max(worst);
            // With the other branch the way of each may be another; that of the values themselves is known.
            let own = found.iter().find(|solution| {
                machine
                    .free
                    .iter()
                    .all(|joint| turned(solution[*joint], q[*joint]).abs() < 1e-6)
            });
            for solution in &found {
                let end = solution[beside];
                assert!(
                    (travel[0]..=travel[1]).contains(&end),
                    "round {round}: {end} {travel:?}"
                );
                assert!(
                    solution[quill] == 0.0 || end == travel[0] || end == travel[1],
                    "round {round}: {solution:?} {travel:?}"
                );
            }
            let Some(own) = own else { continue };
            if (travel[0]..=travel[1]).contains(&q[beside]) {
                inside += 1;
                assert!(own[quill].abs() < 1e-9 || (own[beside] - q[beside]).abs() < 1e-6);
            } else {
                beyond += 1;
                let end = if q[beside] > travel[1] { travel[1] } else { travel[0] };
                assert_eq!(own[beside], end, "round {round}");
                assert!(own[quill] != 0.0);
            }
        }
    }
    println!("quill in reserve: {inside} inside, {beyond} beyond, tip {tip:.1e} mm");
    assert!(inside > 1_000 && beyond > 1_000 && tip < 1e-9, "{tip}");
}
