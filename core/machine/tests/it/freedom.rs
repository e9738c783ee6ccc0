//! Chains with more freedom than a five-axis machine, or with none to spare, against an independent product of
//! isometries: three rotary axes and a leading edge, four linear axes, chains without a closed form, and machines
//! as they were measured.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use post_machine::kinematics::POLE;
use post_machine::kinematics::{Freedom, Joints, Pose, Second, Solver, Unreachable};
use post_testkit::{Kind, Random, Rng, SIZE, across, angle, nearest, turned};

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
    values
        .iter()
        .fold(1.0, |reach: f64, value| reach.max(value.abs() / 1000.0))
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
    for round in 0..4_000_u32 {
        let machine = three(&mut rng, usize::from(round.is_multiple_of(3)));
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
    assert!(
        axis < 1e-9 && edge < 1e-9,
        "axis off by {axis}, edge by {edge}"
    );
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
        let wanted =
            Rotation3::from_axis_angle(&Unit::new_normalize(rng.direction()), rng.range(-PI, PI));
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
        let least = nearest(
            reference,
            &machine.held,
            [first, second],
            at_zero,
            wanted * at_zero,
        );
        match solver.orient(&pose, 1e-9) {
            Ok(_) => {
                assert!(
                    least < 1e-6,
                    "round {round}: accepted, but a scan misses by {least}"
                );
                reached += 1;
            }
            Err(Unreachable::Axis { miss }) => {
                assert!(
                    least > 1e-6,
                    "round {round}: refused by {miss}, but a scan reaches it"
                );
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
    kinds.extend(vec![Kind::Held; usize::from(round.is_multiple_of(7))]);
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
    assert!(
        poses > 4_000 && tip < 1e-9 && shares < 1e-9,
        "{poses} {tip} {shares}"
    );
}

#[test]
fn a_quill_in_reserve_moves_where_the_other_ends() {
    let mut rng = Rng(15);
    let (mut tip, mut inside, mut beyond) = (0.0f64, 0, 0);
    for round in 0..4_000 {
        let (machine, quill, beside) = four(&mut rng, round);
        let middle = rng.range(-200.0, 200.0);
        let travel = [
            middle - rng.range(0.0, 300.0),
            middle + rng.range(0.0, 300.0),
        ];
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
                let end = if q[beside] > travel[1] {
                    travel[1]
                } else {
                    travel[0]
                };
                assert_eq!(own[beside], end, "round {round}");
                assert!(own[quill] != 0.0);
            }
        }
    }
    println!("quill in reserve: {inside} inside, {beyond} beyond, tip {tip:.1e} mm");
    assert!(inside > 1_000 && beyond > 1_000 && tip < 1e-9, "{tip}");
}

/// Chains that have no closed form: linear joints, rotary joints, with a leading edge.
const NUMERIC: [(usize, usize, bool); 9] = [
    (2, 3, false),
    (2, 4, false),
    (1, 4, false),
    (1, 5, false),
    (0, 5, false),
    (0, 6, false),
    (2, 6, false),
    (2, 4, true),
    (0, 6, true),
];

/// From a start near by, a search finds a solution that stands up to the isometries; the inverse, which knows
/// nothing, finds one nearly always, and never a wrong one.
#[test]
fn chains_without_a_closed_form_are_solved_and_verified() {
    let mut rng = Rng(16);
    for (linear, rotary, edged) in NUMERIC {
        let mut kinds = vec![Kind::Linear; linear];
        kinds.extend(vec![Kind::Free; rotary]);
        let (mut near, mut far, mut found, mut own, mut poses) = (0, 0, 0, 0, 0);
        let mut tip = 0.0f64;
        let mut least = Vec::new();
        for _ in 0..60 {
            let machine = Random::of(&mut rng, &kinds);
            let reference = &machine.reference;
            let leading = edged.then(|| across(&mut rng, reference.axis));
            let solver = Solver::new(
                reference.chain().with_edge(leading),
                &machine.free,
                machine.held,
            )
            .expect("a numeric form");
            assert!(!solver.closed_form());
            assert!(solver.orient(&Pose::default(), 1.0).is_err());
            for _ in 0..2 {
                poses += 1;
                let q = machine.values(&mut rng);
                let (wanted_tip, axis) = reference.forward(&q);
                let edge = leading.map_or_else(Vector3::zeros, |edge| reference.taken(&q, edge));
                let pose = Pose {
                    tip: wanted_tip,
                    axis,
                    edge,
                };
                let mut holds = |solution: &Joints| {
                    let reached = reference.forward(solution);
                    tip = tip.max((reached.0 - wanted_tip).norm() / reach(solution));
                    assert!(angle(reached.1, axis) < 2e-9, "{solution:?}");
                    if let Some(edge_at_zero) = leading {
                        assert!(angle(reference.taken(solution, edge_at_zero), edge) < 2e-9);
                    }
                };
                let start: Joints = std::array::from_fn(|index| {
                    let joint = reference.joints.get(index);
                    q[index]
                        + match joint {
                            Some(joint) if joint.rotary => rng.range(-0.01, 0.01),
                            Some(_) => rng.range(-1.0, 1.0),
                            None => 0.0,
                        }
                });
                if let Ok(solution) = solver.search(&pose, &start, 1e-9) {
                    holds(&solution);
                    near += 1;
                    far += usize::from(apart(&machine, &solution, &start) > 200.0);
                }
                let back = solver.inverse(&pose, &machine.held, 1e-9);
                if let Err(Unreachable::Numeric { miss }) = back {
                    least.push(miss);
                }
                if let Ok(solutions) = back {
                    solutions.iter().for_each(&mut holds);
                    found += 1;
                    own += usize::from(
                        solutions
                            .iter()
                            .any(|solution| apart(&machine, &q, solution) < 0.1),
                    );
                }
            }
        }
        let edged = if edged { " and an edge" } else { "" };
        println!(
            "{linear} linear, {rotary} rotary{edged}: of {poses} poses {near} searched from near by ({far} came out far off), {found} found from nothing, {own} with the values they were made with; tip {tip:.1e} mm; refused by {least:?} mm"
        );
        assert!(tip < 5e-9, "{tip}");
        assert!(near * 100 >= poses * 97, "{near} of {poses}");
        assert!(far * 100 <= near * 3, "{far} of {near}");
        assert!(found * 100 >= poses * 90, "{found} of {poses}");
    }
}

/// Along a walk of six rotary axes under a tool frame, the search that begins at the last solution follows the values
/// that the poses were made with: forward and inverse undo each other. What is found is never wrong, and a walk is
/// left only where it passes a singular place.
#[test]
fn a_walk_of_six_rotary_axes_is_followed() {
    let mut rng = Rng(19);
    let (mut steps, mut followed, mut refused) = (0, 0, 0);
    let mut tip = 0.0f64;
    for _ in 0..60 {
        let machine = Random::of(&mut rng, &[Kind::Free; 6]);
        let reference = &machine.reference;
        let edge_at_zero = across(&mut rng, reference.axis);
        let solver = Solver::new(
            reference.chain().with_edge(Some(edge_at_zero)),
            &machine.free,
            machine.held,
        )
        .expect("a numeric form");
        let mut q = machine.values(&mut rng);
        let rates: Joints = std::array::from_fn(|_| rng.range(-0.01, 0.01));
        let mut last = q;
        for _ in 0..100 {
            for (value, rate) in q.iter_mut().zip(&rates).take(reference.joints.len()) {
                *value += rate;
            }
            let (wanted, axis) = reference.forward(&q);
            let edge = reference.taken(&q, edge_at_zero);
            let pose = Pose {
                tip: wanted,
                axis,
                edge,
            };
            steps += 1;
            let Ok(solution) = solver.search(&pose, &last, 1e-9) else {
                refused += 1;
                last = q;
                continue;
            };
            let reached = reference.forward(&solution);
            tip = tip.max((reached.0 - wanted).norm());
            assert!(angle(reached.1, axis) < 2e-9 && (reached.0 - wanted).norm() < 5e-9);
            assert!(angle(reference.taken(&solution, edge_at_zero), edge) < 2e-9);
            if apart(&machine, &solution, &q) < 1e-3 {
                followed += 1;
                last = solution;
            } else {
                last = q;
            }
        }
    }
    println!("of {steps} steps {followed} followed, {refused} refused; tip {tip:.1e} mm");
    assert!(followed * 1000 >= steps * 995, "{followed} of {steps}");
}

/// What no values reach is refused, and by about as much as it is missed.
#[test]
fn a_numeric_chain_refuses_what_it_cannot_reach() {
    let mut rng = Rng(17);
    for (linear, rotary) in [(0, 5), (0, 6)] {
        let mut kinds = vec![Kind::Linear; linear];
        kinds.extend(vec![Kind::Free; rotary]);
        for _ in 0..20 {
            let machine = Random::of(&mut rng, &kinds);
            let solver = Solver::new(machine.reference.chain(), &machine.free, machine.held)
                .expect("a numeric form");
            // No arm of these machines is longer than seven diagonals of the cube that their lines lie in.
            let pose = Pose {
                tip: rng.direction() * 100_000.0,
                axis: rng.direction(),
                ..Pose::default()
            };
            match solver.inverse(&pose, &machine.held, 1e-9) {
                Err(Unreachable::Numeric { miss }) => {
                    assert!((85_000.0..101_000.0).contains(&miss), "{miss}");
                }
                other => panic!("{other:?}"),
            }
        }
    }
    // A knife on a portal without Z: two linear axes along X and Y, three rotary ones whose lines meet the tip's
    // plane. Poses a hair above what the arms reach are refused, a hair below they are not.
    let joint =
        |rotary: bool, direction: Vector3<f64>, point: [f64; 3]| post_machine::kinematics::Joint {
            rotary,
            direction,
            point: Vector3::from(point),
        };
    let machine = Random {
        reference: post_testkit::Reference {
            joints: vec![
                joint(false, Vector3::x(), [0.0; 3]),
                joint(false, Vector3::y(), [0.0; 3]),
                joint(true, Vector3::z(), [0.0; 3]),
                joint(true, Vector3::y(), [0.0, 0.0, 100.0]),
                joint(true, Vector3::y(), [0.0, 0.0, 0.0]),
            ],
            mount: Vector3::zeros(),
            tip: Vector3::new(0.0, 0.0, -50.0),
            axis: Vector3::z(),
        },
        free: vec![2, 3, 4],
        held: Joints::default(),
    };
    let solver =
        Solver::new(machine.reference.chain(), &machine.free, machine.held).expect("a form");
    for tilt in [0.1f64, 0.5, 1.0] {
        let axis = Vector3::new(libm::sin(tilt), 0.0, libm::cos(tilt));
        // The upper arm, 100 mm, hangs from Z 100 at any angle; the tool, 50 mm, has the angle that is wanted.
        let lowest = -50.0 * libm::cos(tilt);
        for (above, reached) in [(0.5, true), (20.0, true), (-0.01, false), (-5.0, false)] {
            let pose = Pose {
                tip: Vector3::new(30.0, 40.0, lowest + above),
                axis,
                ..Pose::default()
            };
            match solver.inverse(&pose, &machine.held, 1e-9) {
                Ok(found) => {
                    assert!(reached, "{tilt} {above}: {found:?}");
                    for solution in &found {
                        let (tip, to) = machine.reference.forward(solution);
                        assert!((tip - pose.tip).norm() < 1e-8 && angle(to, axis) < 2e-9);
                    }
                }
                Err(Unreachable::Numeric { miss }) => {
                    assert!(!reached && miss > 0.0, "{tilt} {above}: misses by {miss}");
                    // It may tilt the tool a little to come nearer, never farther.
                    assert!(miss <= -above + 1e-6, "{tilt} {above}: {miss}");
                }
                Err(other) => panic!("{other:?}"),
            }
        }
    }
}

/// A turn of a direction by so many radians, any way round.
fn inclined(rng: &mut Rng, direction: Vector3<f64>, by: f64) -> Vector3<f64> {
    let about = Unit::new_normalize(across(rng, direction));
    Rotation3::from_axis_angle(&about, by) * direction
}

/// A machine of a class that shops have, its first rotary axis inclined by `incline`, the second by `second`
/// radians, both lines off by some hundredths.
fn measured(rng: &mut Rng, class: usize, incline: f64, second: f64) -> Random {
    use post_machine::kinematics::Joint;
    let slide = |direction: Vector3<f64>| Joint {
        rotary: false,
        direction,
        point: Vector3::zeros(),
    };
    let xyz = [Vector3::x(), Vector3::y(), Vector3::z()].map(slide);
    let tilted = [
        Vector3::x(),
        Vector3::x(),
        Vector3::y(),
        Vector3::new(0.0, 1.0, 1.0).normalize(),
    ][class];
    let mut turn = |direction: Vector3<f64>, by: f64, height: f64| Joint {
        rotary: true,
        direction: inclined(rng, direction, by),
        point: Vector3::new(0.0, 0.0, height) + rng.point(0.02),
    };
    let (c, a) = (
        turn(Vector3::z(), incline, 0.0),
        turn(tilted, second, 250.0),
    );
    // Table-table AC, head-head CA, head-table B over C, a nutating head over a C table.
    let (joints, free) = match class {
        0 => (vec![c, a, xyz[0], xyz[1], xyz[2]], [0, 1]),
        1 => (vec![xyz[0], xyz[1], xyz[2], c, a], [3, 4]),
        _ => (vec![c, xyz[0], xyz[1], xyz[2], a], [0, 4]),
    };
    Random {
        reference: post_testkit::Reference {
            joints,
            mount: Vector3::new(10.0, -20.0, 30.0),
            tip: Vector3::new(0.0, 0.0, 100.0),
            // The spindle, out of square as well.
            axis: inclined(rng, Vector3::z(), incline / 2.0),
        },
        free: free.to_vec(),
        held: Joints::default(),
    }
}

/// What a tolerance lets through: by how much the solutions miss, against the nearest that there is.
fn let_through(machine: &Random, wanted: Vector3<f64>, tolerance: f64, what: &str) -> (f64, f64) {
    let reference = &machine.reference;
    let [first, second] = [machine.free[0], machine.free[1]];
    let least = nearest(
        reference,
        &machine.held,
        [first, second],
        reference.axis,
        wanted,
    );
    let solver = Solver::new(reference.chain(), &machine.free, machine.held).expect("a form");
    let pose = Pose {
        tip: Vector3::new(5.0, 6.0, 7.0),
        axis: wanted,
        ..Pose::default()
    };
    let mut over = 0.0f64;
    match solver.inverse(&pose, &machine.held, tolerance) {
        Ok(found) => {
            assert!(
                least <= tolerance.max(POLE) + 1e-9,
                "{what}: {least} let through"
            );
            for solution in &found {
                let (tip, axis) = reference.forward(solution);
                assert!((tip - pose.tip).norm() < 1e-9, "{what}: the tip is off");
                over = over.max(angle(axis, wanted) - least);
            }
        }
        Err(fault) => {
            assert!(
                least > tolerance - 1e-9,
                "{what}: {least} refused: {fault:?}"
            );
            let Unreachable::Axis { miss } = fault else {
                panic!("{what}: {fault:?}");
            };
            assert!((miss - least).abs() < 1e-7, "{what}: {miss} for {least}");
        }
    }
    (least, over)
}

/// The upright tool of a machine entered as measured lies on the nominal pole and out of reach by some
/// microradians: it is let through within the tolerance, missed by no more than it must be, and refused beyond.
#[test]
fn as_measured_the_upright_tool_is_let_through() {
    let mut rng = Rng(18);
    let (mut worst, mut out, mut most) = (0.0f64, 0, 0.0f64);
    for round in 0..1_200 {
        let class = round % 4;
        let incline = rng.range(1e-5, 1e-4);
        let second = if round % 8 < 4 {
            0.0
        } else {
            rng.range(1e-5, 1e-4)
        };
        let machine = measured(&mut rng, class, incline, second);
        // Exactly upright, and a hair beside it.
        let wanted = if round % 3 == 0 {
            let by = rng.range(0.0, 2e-4);
            inclined(&mut rng, Vector3::z(), by)
        } else {
            Vector3::z()
        };
        let what = format!("round {round}, class {class}, {incline:.1e}, {second:.1e}");
        let (least, over) = let_through(&machine, wanted, 0.05f64.to_radians(), &what);
        worst = worst.max(over);
        most = most.max(least);
        if least > 2.0 * POLE {
            out += 1;
            let (_, over) = let_through(&machine, wanted, least * 1.01, &what);
            worst = worst.max(over);
            let_through(&machine, wanted, least * 0.99, &what);
        }
    }
    println!(
        "as measured: {out} upright tools out of reach, by {most:.1e} rad at most; missed by {worst:.1e} rad more than they must be"
    );
    assert!(out > 200, "{out}");
    assert!(worst <= 2.0 * POLE, "{worst}");
}

/// The edge of reach of a nutating head, from inside to outside: as far as the tolerance goes, no farther.
#[test]
fn the_edge_of_reach_is_let_through_by_the_tolerance() {
    let mut rng = Rng(19);
    let (mut worst, mut passed, mut refused) = (0.0f64, 0, 0);
    for round in 0..1_200 {
        let (incline, second) = (rng.range(0.0, 1e-4), rng.range(0.0, 1e-4));
        let machine = measured(&mut rng, 3, incline, second);
        // The tool lies flat at B 180: beyond that no angles point it.
        let by = rng.range(-1.0, 1.0) * rng.order(-7.0, -2.0);
        let (sine, cosine) = libm::sincos(PI / 2.0 + by);
        let (y, x) = libm::sincos(rng.range(-PI, PI));
        let wanted = Vector3::new(sine * x, sine * y, cosine);
        let tolerance = rng.order(-6.0, -2.5);
        let what = format!("round {round}: {by:.1e} beyond, tolerance {tolerance:.1e}");
        let (least, over) = let_through(&machine, wanted, tolerance, &what);
        if least > tolerance {
            refused += 1;
        } else if least > 2.0 * POLE {
            passed += 1;
        }
        worst = worst.max(over);
    }
    println!(
        "edge of reach: {passed} let through, {refused} refused; missed by {worst:.1e} rad more than they must be"
    );
    assert!(passed > 50 && refused > 50, "{passed} {refused}");
    assert!(worst <= 2.0 * POLE, "{worst}");
}

/// Three rotary axes as measured: a frame a little out of reach is let through within the tolerance, axis and edge
/// within it too.
#[test]
fn a_tool_frame_at_the_edge_of_reach_is_let_through() {
    let mut rng = Rng(20);
    let (mut passed, mut refused) = (0, 0);
    for round in 0..2_000 {
        // An AC table under a knife that turns about its own axis; the knife stands upright over a C inclined by
        // some microradians, so that its own axis cannot be brought upright.
        let incline = rng.range(1e-5, 1e-4);
        let mut machine = measured(&mut rng, round % 2, incline, 0.0);
        let behind = machine.reference.joints.len();
        machine
            .reference
            .joints
            .push(post_machine::kinematics::Joint {
                rotary: true,
                direction: inclined(&mut rng, Vector3::z(), incline),
                point: Vector3::zeros(),
            });
        machine.free.push(behind);
        let reference = &machine.reference;
        let leading = Vector3::y().cross(&reference.axis).normalize();
        let chain = reference.chain().with_edge(Some(leading));
        let solver = Solver::new(chain, &machine.free, machine.held).expect("a form");
        let turn = rng.range(-PI, PI);
        let pose = Pose {
            tip: Vector3::new(1.0, 2.0, 3.0),
            axis: Vector3::z(),
            edge: Vector3::new(libm::cos(turn), libm::sin(turn), 0.0),
        };
        let free = [machine.free[0], machine.free[1]];
        // Where the knife's own axis must come to lie: seen from the tool it stands still.
        let wanted = Matrix3::from_columns(&[pose.axis, pose.edge, pose.axis.cross(&pose.edge)]);
        let zero =
            Matrix3::from_columns(&[reference.axis, leading, reference.axis.cross(&leading)]);
        let knife = reference.joints[behind].direction;
        let least = nearest(
            reference,
            &machine.held,
            free,
            knife,
            wanted * zero.transpose() * knife,
        );
        if least < 3.0 * POLE {
            continue;
        }
        // Both directions of a frame that is off by an angle are off by that angle at most.
        match solver.inverse(&pose, &machine.held, 2.0 * least) {
            Ok(found) => {
                passed += 1;
                for solution in &found {
                    let reached = reference.forward(solution);
                    assert!((reached.0 - pose.tip).norm() < 1e-9);
                    assert!(
                        angle(reached.1, pose.axis) < 1.01 * least + POLE,
                        "round {round}"
                    );
                    let edge = reference.taken(solution, leading);
                    assert!(
                        angle(edge, pose.edge) < 1.01 * least + POLE,
                        "round {round}"
                    );
                }
            }
            Err(fault) => panic!("round {round}: {least} refused: {fault:?}"),
        }
        if solver.inverse(&pose, &machine.held, 0.9 * least).is_err() {
            refused += 1;
        }
    }
    println!(
        "tool frames at the edge of reach: {passed} let through, {refused} refused by a smaller tolerance"
    );
    assert!(passed > 100 && refused == passed, "{passed} {refused}");
}
