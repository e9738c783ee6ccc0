//! Three rotary axes follow a tool frame.

use super::*;

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
    let (rounds, mut rng) = randomised(4_000_u32, 11);
    let (mut tip, mut axis, mut edge, mut own): (f64, f64, f64, f64) = (0.0, 0.0, 0.0, 0.0);
    let (mut poses, mut regular, mut counts) = (0, 0, [0; 3]);
    for round in rounds {
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
            let k: Vec<Vector3<f64>> =
                machine.free.iter().map(|index| reference.direction(&q, *index)).collect();
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
    assert!(poses > at_least(10_000) && regular > at_least(8_000));
    assert!(counts[0] == 0 && counts[2] > poses / 2);
    assert!(tip < 1e-9, "tip off by {tip}");
    assert!(axis < 1e-9 && edge < 1e-9, "axis off by {axis}, edge by {edge}");
}

/// A frame is reached exactly when the first two axes can bring the third one to where the frame wants it, and
/// refused by the angle that they miss it by.
#[test]
fn frames_out_of_reach_are_refused_by_what_the_third_axis_misses() {
    let (rounds, mut rng) = randomised(400_u32, 12);
    let (mut reached, mut refused, mut worst) = (0, 0, 0.0f64);
    for round in rounds {
        let machine = three(&mut rng, usize::from(round.is_multiple_of(3)));
        let reference = &machine.reference;
        let leading = across(&mut rng, reference.axis);
        let chain = reference.chain().with_edge(Some(leading));
        let solver = Solver::new(chain, &machine.free, machine.held).expect("a closed form");
        let wanted =
            Rotation3::from_axis_angle(&Unit::new_normalize(rng.direction()), rng.range(-PI, PI));
        let pose =
            Pose { axis: wanted * reference.axis, edge: wanted * leading, ..Pose::default() };
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
    assert!(reached > at_least(50) && refused > at_least(50));
    assert!(worst < 1e-6, "{worst}");
}
