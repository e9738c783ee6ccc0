//! Four linear axes: one held, a quill with a share, a quill in reserve.

use super::*;

/// Directions of the linear joints at `q`, part frame.
fn ways(machine: &Random, q: &Joints) -> Vec<(usize, Vector3<f64>)> {
    let reference = &machine.reference;
    reference.linear().into_iter().map(|index| (index, reference.direction(q, index))).collect()
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

/// Its two free axes are: no tool axis follows from them.
fn parallel(machine: &Random) -> bool {
    let direction = |axis| machine.reference.direction(&machine.held, axis);
    matches!(*machine.free.as_slice(), [a, b] if direction(a).cross(&direction(b)).norm() < 0.05)
}

/// A machine with four linear axes and up to two rotary ones, and of the linear ones two: the quill, and the axis
/// that it runs beside.
fn four(rng: &mut Rng, round: usize) -> (Random, usize, usize) {
    let mut kinds = vec![Kind::Linear; 4];
    kinds.extend(vec![Kind::Free; round % 3]);
    kinds.extend(vec![Kind::Held; usize::from(round.is_multiple_of(7))]);
    loop {
        let machine = Random::of(rng, &kinds);
        if parallel(&machine) {
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

#[test]
fn a_fourth_linear_axis_that_is_held_stands_still() {
    let (rounds, mut rng) = randomised(3_000, 13);
    let (mut tip, mut poses) = (0.0f64, 0);
    for round in rounds {
        let (machine, quill, beside) = four(&mut rng, round);
        let mut held = machine.held;
        held[quill] = rng.range(-SIZE, SIZE);
        let freedom =
            Freedom { rotary: machine.free.clone(), still: vec![quill], held, seconds: Vec::new() };
        let solver = Solver::with(machine.reference.chain(), &freedom).expect("a closed form");
        for _ in 0..3 {
            let mut q = machine.values(&mut rng);
            q[quill] = held[quill];
            if volume(&ways(&machine, &q), quill, beside, None) < 0.1 {
                continue;
            }
            poses += 1;
            let machine =
                Random { reference: machine.reference.clone(), free: machine.free.clone(), held };
            let (found, worst) = solutions(&solver, &machine, &q);
            tip = tip.max(worst);
            assert!(found.iter().all(|solution| solution[quill] == held[quill]));
        }
    }
    println!("{poses} poses with a held quill: tip {tip:.1e} mm");
    assert!(poses > at_least(4_000) && tip < 1e-9, "{poses} {tip}");
}

#[test]
fn a_quill_takes_its_share() {
    let (rounds, mut rng) = randomised(3_000, 14);
    let (mut tip, mut poses, mut shares) = (0.0f64, 0, 0.0f64);
    for round in rounds {
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
    assert!(poses > at_least(4_000) && tip < 1e-9 && shares < 1e-9, "{poses} {tip} {shares}");
}

#[test]
fn a_quill_in_reserve_moves_where_the_other_ends() {
    let (rounds, mut rng) = randomised(4_000, 15);
    let (mut tip, mut inside, mut beyond) = (0.0f64, 0, 0);
    for round in rounds {
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
                machine.free.iter().all(|joint| turned(solution[*joint], q[*joint]).abs() < 1e-6)
            });
            for solution in &found {
                let end = solution[beside];
                assert!((travel[0]..=travel[1]).contains(&end), "round {round}: {end} {travel:?}");
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
    assert!(inside > at_least(1_000) && beyond > at_least(1_000) && tip < 1e-9, "{tip}");
}

/// Two quills in reserve, both of which may be wanted at once, on linear axes that do not stand square.
#[test]
fn two_quills_in_reserve_take_over_together() {
    let (rounds, mut rng) = randomised(3_000, 16);
    let (mut tip, mut both, mut one) = (0.0f64, 0, 0);
    for round in rounds {
        let mut kinds = vec![Kind::Linear; 5];
        kinds.extend(vec![Kind::Free; round % 3]);
        let mut machine = Random::of(&mut rng, &kinds);
        let linear = machine.reference.linear();
        if parallel(&machine) {
            continue;
        }
        // Each quill goes along its axis but for a lean.
        let pairs = [[linear[0], linear[1]], [linear[3], linear[2]]];
        for [beside, quill] in pairs {
            let lean = rng.point(0.1);
            let joints = &mut machine.reference.joints;
            joints[quill].direction = (joints[beside].direction + lean).normalize();
        }
        let travel = [rng.range(-150.0, -20.0), rng.range(20.0, 150.0)];
        let seconds = pairs.map(|[of, quill]| (quill, Second::Reserve { of }, travel));
        let freedom = Freedom {
            rotary: machine.free.clone(),
            held: machine.held,
            seconds: seconds.to_vec(),
            ..Freedom::default()
        };
        let Ok(solver) = Solver::with(machine.reference.chain(), &freedom) else {
            continue;
        };
        let mut q = machine.values(&mut rng);
        for [beside, quill] in pairs {
            q[beside] = rng.range(-SIZE, SIZE);
            q[quill] = 0.0;
        }
        let ways = ways(&machine, &q);
        let three = |left_out: [usize; 2]| {
            let columns = ways.iter().filter(|(index, _)| !left_out.contains(index));
            let columns: Vec<Vector3<f64>> = columns.map(|(_, way)| *way).collect();
            Matrix3::from_columns(&columns).determinant().abs()
        };
        let flat = |[a, b]: [usize; 2]| three([pairs[0][a], pairs[1][b]]) < 0.15;
        if [[0, 0], [0, 1], [1, 0], [1, 1]].into_iter().any(flat) {
            continue;
        }
        let (found, worst) = solutions(&solver, &machine, &q);
        tip = tip.max(worst);
        for solution in &found {
            let out = pairs.map(|[beside, quill]| {
                let end = solution[beside];
                assert!((travel[0]..=travel[1]).contains(&end), "round {round}: {end} {travel:?}");
                let at_end = end == travel[0] || end == travel[1];
                assert!(solution[quill] == 0.0 || at_end, "round {round}: {solution:?} {travel:?}");
                solution[quill] != 0.0
            });
            both += usize::from(out == [true, true]);
            one += usize::from(out[0] != out[1]);
        }
    }
    println!("two quills: {both} times both, {one} times one, tip {tip:.1e} mm");
    assert!(both > at_least(100) && one > at_least(100) && tip < 1e-9, "{both} {one} {tip}");
}
