//! The certificate is a bound, and a close one: over random machines and blocks no sample of the deviation ever
//! exceeds `ends + M/8`, and on small moves `tight` is hardly more than the largest sample. The figures of the
//! harmonic and the parabolic paper come out of it.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;

use nalgebra::Vector3;
use post_machine::description::{Setting, Source, load};
use post_machine::kinematics::{Chain, Joint, Joints, Pose, Solver, Trace};
use post_posting::accuracy::certificate::{
    BlockDerivatives, DerivativeBound, chord_angle, deviation, quick, tight,
};
use post_testkit::{Rng, at_least, randomised, repository};
use post_testmachines::{Random, Reference, angle, between, blade, distance, slerp};

/// The chain at the ends of a block.
fn traces(chain: &Chain, from: &Joints, to: &Joints) -> [Trace; 2] {
    [from, to].map(|joints| {
        let mut trace = Trace { joints: *joints, turns: chain.turns(joints), ..Trace::default() };
        chain.trace(&mut trace);
        trace
    })
}

/// Both bounds of a block between two wanted poses.
fn bounds(chain: &Chain, from: &Joints, to: &Joints, wanted: [&Pose; 2]) -> [DerivativeBound; 2] {
    let [first, last] = traces(chain, from, to);
    let sweep = angle(wanted[0].axis, wanted[1].axis);
    [
        quick(chain, &first, &last, sweep),
        tight(chain, &first, &last, wanted[0].axis, wanted[1].axis, sweep),
    ]
}

/// The largest deviation of tip (mm) and tool axis (as a difference of unit vectors, and as an angle) by sampling.
fn sampled(
    reference: &Reference,
    from: &Joints,
    to: &Joints,
    wanted: [&Pose; 2],
    count: u32,
) -> [f64; 3] {
    let mut worst = [0.0f64; 3];
    for step in 0..=count {
        let t = f64::from(step) / f64::from(count);
        let (tip, axis) = reference.forward(&between(from, to, t));
        let chord = wanted[0].tip * (1.0 - t) + wanted[1].tip * t;
        let circle = slerp(wanted[0].axis, wanted[1].axis, t);
        let deviations = [(tip - chord).norm(), (axis - circle).norm(), angle(axis, circle)];
        for (worst, deviation) in worst.iter_mut().zip(deviations) {
            *worst = worst.max(deviation);
        }
    }
    worst
}

fn pose(reference: &Reference, q: &Joints) -> Pose {
    let (tip, axis) = reference.forward(q);
    Pose { tip, axis, ..Pose::default() }
}

/// A block of a random machine; `turn` in degrees and `slide` in mm are the largest that an axis makes.
fn block(rng: &mut Rng, turn: f64, slide: f64) -> (Random, Joints, Joints) {
    let rotary = 1 + rng.pick(2);
    let machine = Random::new(rng, rotary, 0);
    let from = machine.values(rng);
    let mut to = from;
    for (index, joint) in machine.reference.joints.iter().enumerate() {
        let most = if joint.rotary { turn.to_radians() } else { slide };
        to[index] += rng.range(-most, most);
    }
    (machine, from, to)
}

/// Blocks of every size, half of them with ends that rounding puts beside their targets: no sample exceeds a bound.
#[test]
fn no_sample_exceeds_the_bounds() {
    let (rounds, mut rng) = randomised(4_200, 11);
    let mut least = [f64::INFINITY; 2];
    for round in rounds {
        let count = if round < 200 { 10_000 } else { 500 };
        let (turn, slide) = (rng.order(-2.0, 2.5), rng.order(-2.0, 2.8));
        let (machine, from, to) = block(&mut rng, turn, slide);
        let reference = &machine.reference;
        let (mut first, mut last) = (pose(reference, &from), pose(reference, &to));
        let mut ends = [0.0f64; 3];
        if round % 2 == 1 {
            for (wanted, joints) in [(&mut first, &from), (&mut last, &to)] {
                wanted.tip += rng.direction() * rng.order(-6.0, -1.0);
                wanted.axis = (wanted.axis + rng.direction() * rng.order(-8.0, -3.0)).normalize();
                let reached = pose(reference, joints);
                ends[0] = ends[0].max((reached.tip - wanted.tip).norm());
                ends[1] = ends[1].max((reached.axis - wanted.axis).norm());
                ends[2] = ends[2].max(angle(reached.axis, wanted.axis));
            }
        }
        // Between opposite axes there is no one great circle.
        if angle(first.axis, last.axis) > 3.1 {
            continue;
        }
        let wanted = [&first, &last];
        let [tip, chord, turned] = sampled(reference, &from, &to, wanted, count);
        let bends = bounds(&reference.chain(), &from, &to, wanted);
        for (which, bend) in bends.iter().enumerate() {
            let bound = deviation(ends[0], bend.tip);
            assert!(tip <= bound + 1e-10, "round {round}, bound {which}: tip {tip} over {bound}");
            let bound = deviation(ends[1], bend.axis);
            assert!(
                chord <= bound + 1e-13,
                "round {round}, bound {which}: axis {chord} over {bound}"
            );
            let bound = chord_angle(deviation(ends[2], bend.axis));
            assert!(
                turned <= bound + 1e-13,
                "round {round}, bound {which}: angle {turned} over {bound}"
            );
            if ends[0] == 0.0 && tip > 1e-3 {
                least[which] = least[which].min(bend.tip / 8.0 / tip);
            }
        }
    }
    println!("bound over sampled maximum, least: quick {}, tight {}", least[0], least[1]);
}

/// On small moves `tight` is the sampled maximum to 5 %, wherever second-order terms do not cancel.
#[test]
fn tight_is_tight_on_small_moves() {
    let (rounds, mut rng) = randomised(6_000, 12);
    let mut worst = [0.0f64; 2];
    let mut counted = [0; 2];
    for round in rounds {
        // Both angles together turn by less than two degrees.
        let (turn, slide) = (rng.range(0.05, 0.99), rng.order(-1.0, 1.0));
        let (machine, from, to) = block(&mut rng, turn, slide);
        let reference = &machine.reference;
        let (first, last) = (pose(reference, &from), pose(reference, &to));
        let wanted = [&first, &last];
        let [tip, axis, _] = sampled(reference, &from, &to, wanted, 64);
        let [quick, tight] = bounds(&reference.chain(), &from, &to, wanted);
        // Where the terms of the second derivative cancel to a tenth, the third-order ones are no longer small.
        let measured = [(tight.tip, quick.tip, tip), (tight.axis, quick.axis, axis)];
        for (which, (tight, quick, sampled)) in measured.into_iter().enumerate() {
            if quick / 8.0 < 10.0 * sampled && sampled > 1e-9 {
                let ratio = tight / 8.0 / sampled;
                counted[which] += 1;
                worst[which] = worst[which].max(ratio);
                assert!(
                    ratio <= 1.05,
                    "round {round}: bound {which} is {ratio} of the sampled maximum"
                );
            }
        }
    }
    println!(
        "tight over sampled maximum, worst: tip {} ({}), axis {} ({})",
        worst[0], counted[0], worst[1], counted[1]
    );
    assert!(counted[0] > at_least(3_000) && counted[1] > at_least(1_000), "{counted:?}");
}

/// Ends put off the path on purpose count against the bow: no sample exceeds the bound, whatever they are, and where
/// they balance a small move the bound is hardly more than the largest sample.
#[test]
fn ends_off_the_path_count_against_the_bow() {
    let (rounds, mut rng) = randomised(3_000, 17);
    let mut worst = 0.0f64;
    let mut counted = 0;
    for round in rounds {
        let count = if round < 100 { 10_000 } else { 500 };
        let small = round % 2 == 0;
        let (machine, from, to) = if small {
            let (turn, slide) = (rng.range(0.05, 0.99), rng.order(-1.0, 1.0));
            block(&mut rng, turn, slide)
        } else {
            let (turn, slide) = (rng.order(-2.0, 2.5), rng.order(-2.0, 2.8));
            block(&mut rng, turn, slide)
        };
        let reference = &machine.reference;
        let chain = reference.chain();
        let [first, last] = traces(&chain, &from, &to);
        let course = BlockDerivatives::new(&chain, &first, &last);
        let (start, end) = (pose(reference, &from).tip, pose(reference, &to).tip);
        let bow = (pose(reference, &between(&from, &to, 0.5)).tip - (start + end) / 2.0) / 2.0;
        let off = match round % 4 {
            // As `fewest` puts them, and some way from that.
            0 | 1 => [-bow; 2],
            2 => [-bow * rng.range(-1.0, 2.0), -bow * rng.range(-1.0, 2.0)],
            _ => [rng.point(1.0) * bow.norm(), rng.point(1.0) * bow.norm()],
        };
        let wanted = [start - off[0], end - off[1]];
        let mut sampled = 0.0f64;
        for step in 0..=count {
            let t = f64::from(step) / f64::from(count);
            let reached = reference.forward(&between(&from, &to, t)).0;
            sampled = sampled.max((reached - (wanted[0] * (1.0 - t) + wanted[1] * t)).norm());
        }
        let bound = course.tip(off);
        assert!(sampled <= bound + 1e-10, "round {round}: {sampled} over {bound}");
        let simple = off[0].norm().max(off[1].norm())
            + course.bend(Vector3::z(), Vector3::z(), 0.0).tip / 8.0;
        assert!(
            bound <= simple * (1.0 + 1e-9),
            "round {round}: {bound}, by ends and bend {simple}"
        );
        let across = quick(&chain, &first, &last, 0.0).tip / 8.0;
        if small && round % 4 == 0 && sampled > 1e-9 && across < 20.0 * sampled {
            worst = worst.max(bound / sampled);
            counted += 1;
        }
    }
    println!("balanced ends: at most {worst} of the sampled maximum ({counted})");
    assert!(worst < 1.05 && counted > at_least(500), "{worst} in {counted}");
}

/// A cutting edge of radius R is a circle about the tool axis. From the circle about the wanted axis none of its points
/// strays by more than R times what the axes differ by, and some point by as much.
#[test]
fn the_cutting_edge_is_held_against_the_circle_about_the_wanted_axis() {
    let (rounds, mut rng) = randomised(1_000, 19);
    let mut closest = f64::INFINITY;
    for round in rounds {
        let (turn, slide) = (rng.order(-2.0, 2.2), 1.0);
        let (machine, from, to) = block(&mut rng, turn, slide);
        let reference = &machine.reference;
        let chain = reference.chain();
        let (first, last) = (pose(reference, &from), pose(reference, &to));
        if angle(first.axis, last.axis) > 3.1 {
            continue;
        }
        let side = post_testmachines::across(&mut rng, chain.axis());
        let other = chain.axis().cross(&side);
        let mut sampled = 0.0f64;
        for step in 0..=60 {
            let t = f64::from(step) / 60.0;
            let turned = reference.rotation(&between(&from, &to, t));
            let wanted = slerp(first.axis, last.axis, t);
            for place in 0..48 {
                let (sine, cosine) = libm::sincos(f64::from(place) * PI / 24.0);
                let point = turned * (side * cosine + other * sine);
                // From a circle of radius 1: along its axis, and in its plane.
                let along = point.dot(&wanted);
                let in_plane = (point - wanted * along).norm() - 1.0;
                sampled = sampled.max(libm::hypot(along, in_plane));
            }
        }
        let bends = bounds(&chain, &from, &to, [&first, &last]);
        for bend in &bends {
            assert!(
                sampled <= bend.axis / 8.0 + 1e-12,
                "round {round}: {sampled} over {}",
                bend.axis / 8.0
            );
        }
        if turn < 1.0 && sampled > 1e-7 && bends[0].axis / 8.0 < 10.0 * sampled {
            closest = closest.min(sampled / (bends[1].axis / 8.0));
        }
    }
    println!("cutting edge: the largest sample is at least {closest} of the bound on small moves");
    assert!(closest > 0.9, "{closest}");
}

/// As a block shrinks, `tight` becomes the length of the second derivative, which differences of the independent
/// forward product give too.
#[test]
fn tight_tends_to_the_second_derivative() {
    let (rounds, mut rng) = randomised(3_000, 13);
    let mut worst = [0.0f64; 2];
    for round in rounds {
        let (machine, at, to) = block(&mut rng, 40.0, 200.0);
        let reference = &machine.reference;
        let step: Joints = std::array::from_fn(|index| to[index] - at[index]);
        let shifted =
            |t: f64| -> Joints { std::array::from_fn(|index| at[index] + step[index] * t) };
        let h = 0.01;
        // Five points: exact up to the sixth derivative.
        let values = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| reference.forward(&shifted(k * h)));
        let weights = [-1.0, 16.0, -30.0, 16.0, -1.0].map(|weight| weight / (12.0 * h * h));
        let mut second = (Vector3::zeros(), Vector3::zeros());
        for ((tip, axis), weight) in values.iter().zip(weights) {
            second.0 += tip * weight;
            second.1 += axis * weight;
        }
        let size = 1e-4;
        let (from, to) = (shifted(0.0), shifted(size));
        let (first, last) = (pose(reference, &from), pose(reference, &to));
        let [_, bend] = bounds(&reference.chain(), &from, &to, [&first, &last]);
        let sweep = angle(first.axis, last.axis) / size;
        let expected = [second.0.norm(), (second.1 + first.axis * sweep * sweep).norm()];
        for (which, (bend, expected)) in [bend.tip, bend.axis].into_iter().zip(expected).enumerate()
        {
            let error = (bend / (size * size) - expected).abs();
            // The terms are some hundred mm and some rad² long; the ends of the block differ by a share of its size.
            let scale = [1000.0, 1.0][which];
            worst[which] = worst[which].max(error / scale);
            assert!(error < 2e-3 * scale, "round {round}: {which}: {error} off {expected}");
        }
    }
    println!("second derivative: tip {:.1e} of a metre, axis {:.1e}", worst[0], worst[1]);
}

/// A machine of the workspace.
fn machine_file(name: &str, settings: &[Setting]) -> post_machine::description::Machine {
    let path = repository().join("machines").join(name);
    let source =
        Source { name: name.to_owned(), text: fs::read_to_string(path).expect("a machine file") };
    load(source, settings, &mut |_| Err(String::new())).expect("a machine")
}

/// The swing-head move of Sha et al. 2022 ("Analysis and control of nonlinear error in six-axis five-linkage CNC
/// machining", section 2.3): A -3.3528 to -2.1501 at C 90. Its largest deviation is at the middle and is Lm·Δ²/8.
#[test]
fn the_swing_head_move_of_the_parabolic_paper() {
    for (swing, expected) in
        [(100.0, 5.508), (200.0, 11.016), (300.0, 16.523), (400.0, 22.031), (312.0, 17.184)]
    {
        let machine = machine_file("disc-cutter.toml", &[Setting::Written(format!("Lm={swing}"))]);
        let solver = machine.solver(0.0).unwrap();
        let [from, to] = [([33.3881, 0.0, 8.1205], -3.3528f64), ([36.2549, 0.0, 8.2580], -2.1501)]
            .map(|(tip, a)| {
                let (sine, cosine) = libm::sincos(a.to_radians());
                // u = (sinA·sinC, -sinA·cosC, cosA) at C 90.
                let pose = Pose {
                    tip: Vector3::from(tip),
                    axis: Vector3::new(sine, 0.0, cosine),
                    ..Pose::default()
                };
                let solutions = solver.inverse(&pose, &Joints::default(), 1e-9).unwrap();
                let wanted = |joints: &&Joints| {
                    (joints[4] - FRAC_PI_2).abs() < 1e-9
                        && (joints[5] - a.to_radians()).abs() < 1e-9
                };
                let joints = *solutions.iter().find(wanted).expect("the paper's angles");
                // Eq. 11 with the signs of the Lm terms put right: the pivot is the tip plus Lm·u.
                // With Z at zero the pivot stands 1200 mm over the table.
                let pivot = Vector3::new(joints[1], joints[2], joints[3] + 1200.0);
                assert!((pivot - (pose.tip + pose.axis * swing)).norm() < 1e-9);
                (pose, joints)
            });
        let chain = solver.chain();
        let at = |t: f64| {
            let tip = chain.forward(&between(&from.1, &to.1, t)).tip;
            1000.0 * (tip - (from.0.tip * (1.0 - t) + to.0.tip * t)).norm()
        };
        let places = (0..=1000).map(|step| f64::from(step) / 1000.0);
        let peak = places.max_by(|a, b| at(*a).total_cmp(&at(*b))).unwrap();
        assert!((peak - 0.5).abs() < 2e-3, "the peak is at {peak}");
        assert!((at(0.5) - expected).abs() < 1e-3, "Lm {swing}: {}", at(0.5));
        let [quick, tight] = bounds(chain, &from.1, &to.1, [&from.0, &to.0]);
        assert!(at(0.5) <= 125.0 * tight.tip && 125.0 * tight.tip < 1.001 * at(0.5), "{tight:?}");
        assert!(at(0.5) <= 125.0 * quick.tip && 125.0 * quick.tip < 1.001 * at(0.5), "{quick:?}");
    }
}

/// Worst deviation per move of the blade, µm: at the same t, perpendicular to the chord, and as `tight` bounds it.
fn blade_deviations(points: &[Pose], centre: f64) -> [f64; 3] {
    // Eq. 3.1 with its misprint put right: S = Rx(A)·Rz(C)·(P - m) + m, so the part turns by -C and -A.
    let joint = |rotary, direction: Vector3<f64>| Joint {
        rotary,
        direction,
        point: Vector3::new(0.0, 0.0, centre),
    };
    let reference = Reference {
        joints: vec![
            joint(true, -Vector3::z()),
            joint(true, -Vector3::x()),
            joint(false, Vector3::x()),
            joint(false, Vector3::y()),
            joint(false, Vector3::z()),
        ],
        mount: Vector3::zeros(),
        tip: Vector3::zeros(),
        axis: Vector3::z(),
    };
    let solver = Solver::new(reference.chain(), &[0, 1], Joints::default()).expect("a closed form");
    let joints: Vec<Joints> = points
        .iter()
        .map(|pose| {
            let solutions = solver.inverse(pose, &Joints::default(), 1e-9).expect("in reach");
            // A = acos(uz), the positive one; C = atan2(ux, uy).
            let q = *solutions.iter().find(|q| q[1] > 0.0).expect("A above zero");
            assert!((q[1] - libm::acos(pose.axis.z)).abs() < 1e-9);
            assert!((q[0] - libm::atan2(pose.axis.x, pose.axis.y)).abs() < 1e-9);
            q
        })
        .collect();
    let mut worst = [0.0f64; 3];
    for (pair, wanted) in joints.windows(2).zip(points.windows(2)) {
        for step in 1..200 {
            let t = f64::from(step) / 200.0;
            let tip = reference.forward(&between(&pair[0], &pair[1], t)).0;
            let chord = wanted[0].tip * (1.0 - t) + wanted[1].tip * t;
            worst[0] = worst[0].max(1000.0 * (tip - chord).norm());
            worst[1] = worst[1].max(1000.0 * distance(tip, wanted[0].tip, wanted[1].tip));
        }
        let [_, bend] = bounds(solver.chain(), &pair[0], &pair[1], [&wanted[0], &wanted[1]]);
        worst[2] = worst[2].max(1000.0 * deviation(0.0, bend.tip));
    }
    worst
}

/// With the rotary centre 200 mm below the part origin the worst deviation is the paper's "exceeds 4.5" µm.
#[test]
fn the_blade_of_the_harmonic_paper() {
    let Some(points) = blade() else {
        return;
    };
    let [same_t, across, bound] = blade_deviations(&points, -200.0);
    println!("blade, m = -200: {same_t} µm at the same t, {across} µm across, bound {bound} µm");
    assert!((same_t - 4.62).abs() < 0.005, "{same_t}");
    assert!((across - 4.59).abs() < 0.005, "{across}");
    assert!(same_t <= bound && bound < 1.05 * same_t, "{bound}");
    let [same_t, _, bound] = blade_deviations(&points, 0.0);
    println!("blade, m = 0: {same_t} µm, bound {bound} µm");
    assert!((same_t - 2.30).abs() < 0.005, "{same_t}");
    assert!(same_t <= bound && bound < 1.05 * same_t, "{bound}");
}

/// A block that turns nothing bends nothing.
#[test]
fn straight_blocks_have_no_deviation() {
    let (rounds, mut rng) = randomised(100, 14);
    for _ in rounds {
        let (machine, from, mut to) = block(&mut rng, 1.0, 500.0);
        for (index, joint) in machine.reference.joints.iter().enumerate() {
            if joint.rotary {
                to[index] = from[index];
            }
        }
        let (first, last) = (pose(&machine.reference, &from), pose(&machine.reference, &to));
        for bend in bounds(&machine.reference.chain(), &from, &to, [&first, &last]) {
            assert!(bend.tip == 0.0 && bend.axis < 1e-20, "{bend:?}");
        }
    }
    assert!(chord_angle(3.0) <= PI + 1e-15);
}
