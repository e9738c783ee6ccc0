//! Chains without a closed form.

use super::*;

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
    let (rounds, mut rng) = randomised(60, 16);
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
        assert!(far * 100 <= near * 3, "{far} of {near}");
        assert!(found * 100 >= poses * 90, "{found} of {poses}");
    }
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
