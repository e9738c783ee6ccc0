//! Many points at once: the bits of one after the other.

use post_machine::kinematics::batch::{AxisBatch, LANES, Traces};
use post_machine::kinematics::{Solver, Trace};
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
        if solver.place_all(&tips, &mut at) {
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
                    assert_eq!(out.tip_rates[index][lane], trace.tip_rates[index]);
                    assert_eq!(out.axes[index][lane], trace.axes[index]);
                }
            }
            assert_eq!(out.tip[lane], trace.pose.tip);
            assert_eq!(out.axis[lane], trace.pose.axis);
        }
    }
    println!("{placed} points placed, {left} left to the single point");
    assert!(placed > at_least(1_000) && left > at_least(500));
}
