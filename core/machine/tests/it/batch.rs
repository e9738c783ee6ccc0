//! Many points at once: the bits of one after the other.

use post_machine::kinematics::batch::{AxisBatch, LANES, Traces, set_vector, vector};
use post_machine::kinematics::orientation::LatitudeLanes;
use post_machine::kinematics::{Pose, Solver, Trace};
use post_testkit::{at_least, randomised};
use post_testmachines::{Kind, Random};

/// Linear axes and forward product of a batch are those of its points, bit by bit.
#[test]
fn a_batch_is_placed_and_traced_with_the_bits_of_its_points() {
    let (rounds, mut rng) = randomised(200, 63);
    let (mut at, mut out) = (AxisBatch::default(), Traces::default());
    let (mut placed, mut left) = (0, 0);
    for round in rounds {
        let mut kinds = vec![Kind::Linear; 3 + usize::from(round % 8 == 0)];
        kinds.extend([Kind::Free; 2]);
        kinds.extend(vec![Kind::Held; round as usize % 2]);
        let machine = Random::of(&mut rng, &kinds);
        let chain = machine.reference.chain();
        let Ok(solver) = Solver::new(chain, &machine.free, machine.held) else {
            continue;
        };
        let chain = solver.chain();
        let count = 1 + rng.pick(LANES);
        let tips: Vec<_> = (0..count).map(|_| rng.point(300.0)).collect();
        let mut columns = [[0.0; LANES]; 3];
        for (lane, tip) in tips.iter().enumerate() {
            set_vector(&mut columns, lane, *tip);
        }
        let mut singles: Vec<Trace> = Vec::new();
        for lane in 0..count {
            let mut trace = Trace { joints: machine.values(&mut rng), ..Trace::default() };
            trace.turns = chain.turns(&trace.joints);
            for (index, value) in trace.joints.iter().enumerate() {
                at.joints[index][lane] = *value;
                (at.sines[index][lane], at.cosines[index][lane]) = trace.turns.of(index);
            }
            singles.push(trace);
        }
        if solver.place_all(&columns, count, &mut at) {
            placed += count;
            for (trace, tip) in singles.iter_mut().zip(&tips) {
                let turns = trace.turns;
                solver.place(*tip, &mut trace.joints, &turns).expect("placed");
            }
        } else {
            left += count;
        }
        chain.trace_all(&at, count, &mut out);
        for (lane, trace) in singles.iter_mut().enumerate() {
            chain.trace(trace);
            for (index, joint) in chain.joints().iter().enumerate() {
                assert_eq!(at.joints[index][lane].to_bits(), trace.joints[index].to_bits());
                if joint.rotary {
                    assert_eq!(vector(&out.tip_rates[index], lane), trace.tip_rates[index]);
                    assert_eq!(vector(&out.axes[index], lane), trace.axes[index]);
                }
            }
            assert_eq!(vector(&out.tip, lane), trace.pose.tip);
            assert_eq!(vector(&out.axis, lane), trace.pose.axis);
        }
    }
    println!("{placed} points placed, {left} left to the single point");
    assert!(placed > at_least(1_000) && left > at_least(500));
}

/// The forward products of many points are those of each, bit by bit, with a leading edge as without one, at angles close
/// to the seams of the sine too.
#[test]
fn many_points_are_reached_with_the_bits_of_each() {
    let (rounds, mut rng) = randomised(200, 65);
    let mut edged = 0;
    for round in rounds {
        let mut kinds = vec![Kind::Linear; 3];
        kinds.extend([Kind::Free; 2]);
        kinds.extend(vec![Kind::Held; round as usize % 3]);
        let machine = Random::of(&mut rng, &kinds);
        let edge = (round % 4 == 0).then(|| rng.point(1.0));
        let chain = machine.reference.chain().with_edge(edge);
        edged += usize::from(chain.edge().is_some());
        let points: Vec<_> = (0..rng.pick(3 * LANES))
            .map(|lane| {
                let mut values = machine.values(&mut rng);
                if lane % 5 == 0 {
                    let quarters = rng.pick(9) as f64 - 4.0;
                    values[machine.free[0]] =
                        quarters * std::f64::consts::FRAC_PI_4 + rng.range(-1e-5, 1e-5);
                }
                values
            })
            .collect();
        // What stands there stays.
        let mut poses = vec![Pose::default()];
        chain.forward_all(&points, &mut poses);
        assert_eq!(poses.len(), 1 + points.len());
        assert_eq!(poses[0], Pose::default());
        for (values, pose) in points.iter().zip(&poses[1..]) {
            let bits = |pose: &Pose| {
                [pose.tip, pose.axis, pose.edge].map(|of| [of.x, of.y, of.z].map(f64::to_bits))
            };
            assert_eq!(bits(pose), bits(&chain.forward(values)));
        }
    }
    assert!(edged > at_least(20));
}

/// Rotary angles of a batch are those of its points, bit by bit, wherever the batch says that it has them.
#[test]
fn a_batch_is_turned_with_the_bits_of_its_points() {
    let (rounds, mut rng) = randomised(400, 64);
    let (mut at, mut latitudes) = (AxisBatch::default(), LatitudeLanes::default());
    let (mut turned, mut left) = (0, 0);
    for round in rounds {
        let mut kinds = vec![Kind::Linear; 3];
        kinds.extend([Kind::Free; 2]);
        kinds.extend(vec![Kind::Held; round as usize % 2]);
        let machine = Random::of(&mut rng, &kinds);
        let chain = machine.reference.chain();
        let Ok(solver) = Solver::new(chain, &machine.free, machine.held) else {
            continue;
        };
        let count = 1 + rng.pick(LANES);
        // Directions that the machine reaches, all close together or from all over.
        let near = machine.values(&mut rng);
        let mut axes = [[0.0; LANES]; 3];
        for lane in 0..count {
            let mut values = if round % 4 == 0 { machine.values(&mut rng) } else { near };
            for joint in &machine.free {
                values[*joint] += rng.range(-0.1, 0.1);
            }
            set_vector(&mut axes, lane, solver.chain().forward(&values).axis);
        }
        for branch in 0..2 {
            let columns = [&axes[0], &axes[1], &axes[2]];
            if !solver.angles_all(columns, branch, 1e-6, count, &mut at, &mut latitudes) {
                left += count;
                continue;
            }
            turned += count;
            for lane in 0..count {
                let pose = Pose { axis: vector(&axes, lane), ..Pose::default() };
                let branches = solver.orient(&pose, 0.0).expect("reached");
                assert_eq!(branches.count(), 2);
                let (sine, cosine) = branches.latitude();
                assert_eq!(latitudes.sines[lane].to_bits(), sine.to_bits());
                assert_eq!(latitudes.cosines[lane].to_bits(), cosine.to_bits());
                let set = solver.angles(&branches, branch);
                assert_eq!(set.free, 0);
                for (index, joint) in solver.chain().joints().iter().enumerate() {
                    if joint.rotary {
                        assert_eq!(at.joints[index][lane].to_bits(), set.joints[index].to_bits());
                    }
                }
            }
        }
    }
    println!("{turned} points turned, {left} left to the single point");
    assert!(turned > at_least(1_000));
}

/// The angles of a single axis that points the tool are those of its points, bit by bit; of directions that it may miss
/// by more than the tolerance there are none.
#[test]
fn a_batch_is_turned_by_one_axis_with_the_bits_of_its_points() {
    const TOLERANCE: f64 = 1e-4;
    let (rounds, mut rng) = randomised(400, 65);
    let (mut at, mut latitudes) = (AxisBatch::default(), LatitudeLanes::default());
    let (mut turned, mut left, mut missed) = (0, 0, 0);
    for round in rounds {
        let mut kinds = vec![Kind::Linear; 3];
        kinds.push(Kind::Free);
        kinds.extend(vec![Kind::Held; round as usize % 2]);
        let machine = Random::of(&mut rng, &kinds);
        let chain = machine.reference.chain();
        let Ok(solver) = Solver::new(chain, &machine.free, machine.held) else {
            continue;
        };
        let count = 1 + rng.pick(LANES);
        let off = *rng.choose(&[0.0, 1e-7, 3e-5, 1e-3]);
        let near = machine.values(&mut rng);
        let mut axes = [[0.0; LANES]; 3];
        for lane in 0..count {
            let mut values = near;
            values[machine.free[0]] += rng.range(-2.0, 2.0);
            let axis = solver.chain().forward(&values).axis + rng.direction() * off;
            set_vector(&mut axes, lane, axis.normalize());
        }
        let [i, j, k] = &axes;
        if !solver.angles_all([i, j, k], 0, TOLERANCE, count, &mut at, &mut latitudes) {
            left += count;
            continue;
        }
        turned += count;
        for lane in 0..count {
            let pose = Pose { axis: vector(&axes, lane), ..Pose::default() };
            let branches = solver.orient(&pose, TOLERANCE).expect("reached");
            missed += u32::from(solver.orient(&pose, 1e-9).is_err());
            let (sine, cosine) = branches.latitude();
            assert_eq!(latitudes.sines[lane].to_bits(), sine.to_bits());
            assert_eq!(latitudes.cosines[lane].to_bits(), cosine.to_bits());
            let set = solver.angles(&branches, 0);
            assert_eq!(set.free, 0);
            let joint = machine.free[0];
            assert_eq!(at.joints[joint][lane].to_bits(), set.joints[joint].to_bits());
        }
    }
    println!("{turned} points turned, {missed} of them not quite, {left} left to the single point");
    assert!(turned > at_least(1_000) && missed > 0 && left > at_least(500));
}
