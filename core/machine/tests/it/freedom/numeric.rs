//! Chains without a closed form.

use nalgebra::{SMatrix, SVector};
use post_machine::kinematics::chain::{Chain, MAX_AXES, turn};

use super::*;

/// Chains that have no closed form: linear joints, rotary joints, with a leading edge. With three linear joints those whose
/// rotary ones no formula knows.
const NUMERIC: [(usize, usize, bool); 15] = [
    (2, 3, false),
    (2, 4, false),
    (1, 4, false),
    (1, 5, false),
    (0, 5, false),
    (0, 6, false),
    (2, 6, false),
    (2, 4, true),
    (0, 6, true),
    (1, 6, false),
    (3, 3, false),
    (3, 4, false),
    (3, 1, true),
    (3, 2, true),
    (3, 4, true),
];

/// From a start near by, a search finds a solution that stands up to the isometries; the inverse, which knows
/// nothing, finds one nearly always, and never a wrong one.
#[test]
fn chains_without_a_closed_form_are_solved_and_verified() {
    let (rounds, mut rng) = randomised(60, 16);
    let (mut all_near, mut all_far) = (0, 0);
    for (linear, rotary, edged) in NUMERIC {
        let mut kinds = vec![Kind::Linear; linear];
        kinds.extend(vec![Kind::Free; rotary]);
        let (mut near, mut far, mut found, mut own, mut poses) = (0, 0, 0, 0, 0);
        let mut tip = 0.0f64;
        let mut least = Vec::new();
        for _ in rounds.clone() {
            let machine = Random::of(&mut rng, &kinds);
            let reference = &machine.reference;
            let leading = edged.then(|| across(&mut rng, reference.axis));
            let solver =
                Solver::new(reference.chain().with_edge(leading), &machine.free, machine.held)
                    .expect("a numeric form");
            assert!(!solver.closed_form());
            assert!(solver.orient(&Pose::default(), 1.0).is_err());
            for _ in 0..2 {
                poses += 1;
                let q = machine.values(&mut rng);
                let (wanted_tip, axis) = reference.forward(&q);
                let edge = leading.map_or_else(Vector3::zeros, |edge| reference.taken(&q, edge));
                let pose = Pose { tip: wanted_tip, axis, edge };
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
                        solutions.iter().any(|solution| apart(&machine, &q, solution) < 0.1),
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
        assert!(found * 100 >= poses * 90, "{found} of {poses}");
        all_near += near;
        all_far += far;
    }
    println!("of all: {all_far} far off of {all_near}");
    // Of one kind there are too few in a run.
    assert!(all_far * 100 <= all_near, "{all_far} of {all_near}");
}

/// Along a walk of six rotary axes under a tool frame, the search that begins at the last solution follows the values
/// that the poses were made with: forward and inverse undo each other. What is found is never wrong, and a walk is
/// left only where it passes a singular place.
#[test]
fn a_walk_of_six_rotary_axes_is_followed() {
    let (rounds, mut rng) = randomised(60, 19);
    let (mut steps, mut followed, mut refused) = (0, 0, 0);
    let (walks, mut whole) = (rounds.end, 0);
    let mut tip = 0.0f64;
    for _ in rounds {
        let before = steps - followed;
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
            let pose = Pose { tip: wanted, axis, edge };
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
        whole += usize::from(steps - followed == before);
    }
    println!("of {steps} steps {followed} followed, {refused} refused; tip {tip:.1e} mm");
    // One walk in eight passes a singular place, and some go along one, for a third of their steps: three in four do not by
    // chance in a billion runs.
    assert!(whole * 4 >= walks, "{whole} of {walks} walks, {followed} of {steps} steps");
}

/// What no values reach is refused, and by about as much as it is missed.
#[test]
fn a_numeric_chain_refuses_what_it_cannot_reach() {
    let (rounds, mut rng) = randomised(20, 17);
    for (linear, rotary) in [(0, 5), (0, 6)] {
        let mut kinds = vec![Kind::Linear; linear];
        kinds.extend(vec![Kind::Free; rotary]);
        for _ in rounds.clone() {
            let machine = Random::of(&mut rng, &kinds);
            let solver = Solver::new(machine.reference.chain(), &machine.free, machine.held)
                .expect("a numeric form");
            // No arm of these machines is longer than seven diagonals of the cube that their lines lie in.
            let pose =
                Pose { tip: rng.direction() * 100_000.0, axis: rng.direction(), ..Pose::default() };
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
    let joint = |rotary: bool, direction: Vector3<f64>, point: [f64; 3]| {
        post_machine::kinematics::Joint { rotary, direction, point: Vector3::from(point) }
    };
    let machine = Random {
        reference: post_testmachines::Reference {
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
            let pose =
                Pose { tip: Vector3::new(30.0, 40.0, lowest + above), axis, ..Pose::default() };
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

/// Residual and its change with each free joint, in matrices of the library.
fn linearised(
    chain: &Chain,
    free: &[usize],
    pose: &Pose,
    joints: &Joints,
) -> (SVector<f64, 9>, SMatrix<f64, 9, COLUMNS>) {
    let mut frame = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut origin = -chain.mount();
    let out = |frame: &[Vector3<f64>; 3], v: Vector3<f64>| {
        frame[0] * v.x + frame[1] * v.y + frame[2] * v.z
    };
    let mut lines = [(Vector3::zeros(), Vector3::zeros()); MAX_AXES];
    for ((joint, line), value) in chain.joints().iter().zip(&mut lines).zip(joints) {
        let k = out(&frame, joint.direction);
        if !joint.rotary {
            *line = (origin, k);
            origin += k * *value;
            continue;
        }
        let point = origin + out(&frame, joint.point);
        *line = (point, k);
        let (sine, cosine) = libm::sincos(*value);
        frame = frame.map(|column| turn(column, k, sine, cosine));
        origin = point + turn(origin - point, k, sine, cosine);
    }
    let (tip, axis) = (origin + out(&frame, chain.tip()), out(&frame, chain.axis()));
    let edge = chain.edge().map(|edge| out(&frame, edge));
    let mut residual = SVector::<f64, 9>::zeros();
    let mut jacobian = SMatrix::<f64, 9, COLUMNS>::zeros();
    residual.fixed_rows_mut::<3>(0).copy_from(&(tip - pose.tip));
    residual.fixed_rows_mut::<3>(3).copy_from(&((axis - pose.axis) * 300.0));
    if let Some(edge) = edge {
        residual.fixed_rows_mut::<3>(6).copy_from(&((edge - pose.edge_across()) * 300.0));
    }
    for (column, index) in free.iter().enumerate() {
        let (point, k) = lines[*index];
        if !chain.joints()[*index].rotary {
            jacobian.fixed_view_mut::<3, 1>(0, column).copy_from(&k);
            continue;
        }
        jacobian.fixed_view_mut::<3, 1>(0, column).copy_from(&k.cross(&(tip - point)));
        jacobian.fixed_view_mut::<3, 1>(3, column).copy_from(&(k.cross(&axis) * 300.0));
        if let Some(edge) = edge {
            jacobian.fixed_view_mut::<3, 1>(6, column).copy_from(&(k.cross(&edge) * 300.0));
        }
    }
    (residual, jacobian)
}

/// Columns of whole matrices: as many as the chains here have joints at most. Sums of more than eight are made in another order.
const COLUMNS: usize = 8;

/// Levenberg's steps in matrices of eight columns: where they end, and how many they were.
fn plainly(chain: &Chain, free: &[usize], pose: &Pose, start: &Joints) -> (Joints, usize) {
    let mut joints = *start;
    let (mut residual, mut jacobian) = linearised(chain, free, pose, &joints);
    let mut damping = 1e-6;
    for steps in 0..60 {
        let size = residual.norm();
        if size < 1e-10 {
            return (joints, steps);
        }
        let mut normal = jacobian.transpose() * jacobian;
        let scale = normal.diagonal().max();
        for index in 0..COLUMNS {
            normal[(index, index)] += match index < free.len() {
                true => damping * normal[(index, index)].max(1e-9 * scale),
                false => 1.0,
            };
        }
        let Some(factor) = normal.cholesky() else {
            return (joints, steps + 1);
        };
        let step = factor.solve(&(jacobian.transpose() * residual));
        let mut next = joints;
        for (index, joint) in free.iter().enumerate() {
            next[*joint] -= step[index];
        }
        let there = linearised(chain, free, pose, &next);
        if there.0.norm() < size {
            joints = next;
            (residual, jacobian) = there;
            damping = (damping * 0.1).max(1e-15);
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                return (joints, steps + 1);
            }
        }
    }
    (joints, 60)
}

/// The steps that are cut to the number of the joints end at the same bits, after as many steps.
#[test]
fn steps_are_those_of_whole_matrices() {
    let (rounds, mut rng) = randomised(400, 23);
    let (mut reached, mut tried) = (0, 0);
    for (linear, rotary, edged) in NUMERIC {
        let mut kinds = vec![Kind::Linear; linear];
        kinds.extend(vec![Kind::Free; rotary]);
        for _ in rounds.clone() {
            let machine = Random::of(&mut rng, &kinds);
            let reference = &machine.reference;
            let leading = edged.then(|| across(&mut rng, reference.axis));
            let chain = reference.chain().with_edge(leading);
            let solver = Solver::new(chain.clone(), &machine.free, machine.held).unwrap();
            if !solver.surplus().is_empty() {
                // Some of its joints stand.
                continue;
            }
            let q = machine.values(&mut rng);
            let (tip, axis) = reference.forward(&q);
            let edge = leading.map_or_else(Vector3::zeros, |edge| reference.taken(&q, edge));
            let pose = Pose { tip, axis, edge };
            let free: Vec<usize> = (0..chain.joints().len())
                .filter(|joint| !chain.joints()[*joint].rotary || machine.free.contains(joint))
                .collect();
            let mut start = machine.held;
            for joint in &free {
                let wide = if chain.joints()[*joint].rotary { 3.0 } else { 300.0 };
                start[*joint] = rng.range(-wide, wide);
            }
            let (wanted, steps) = plainly(&chain, &free, &pose, &start);
            let mut left = 60;
            tried += 1;
            if let Ok(found) = solver.search_within(&pose, &start, 1e-9, &mut left) {
                reached += 1;
                assert_eq!(
                    found.map(f64::to_bits),
                    wanted.map(f64::to_bits),
                    "{found:?} {wanted:?}"
                );
            }
            assert_eq!(60 - left, steps);
        }
    }
    println!("of {tried} searches {reached} came to their pose");
    assert!(reached * 4 > tried, "{reached} of {tried}");
}
