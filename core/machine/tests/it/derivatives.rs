//! Derivatives of the axes along a path, judged by isometries: axes that go as the derivatives say lead the tip along
//! its path but for the fourth order, on random machines with tables, heads and rotary axes between the linear ones.

use nalgebra::Vector3;
use post_machine::kinematics::{Chain, JointDerivatives, Joints, ORDERS, Solver, direction};
use post_testkit::{Rng, at_least, randomised};
use post_testmachines::Random;

/// A value that has these derivatives, so far on.
fn on<T: Copy + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>>(
    derivatives: [T; ORDERS],
    way: f64,
) -> T {
    let [value, first, second, third] = derivatives;
    value + first * way + second * (way * way / 2.0) + third * (way * way * way / 6.0)
}

fn joints_on(course: &JointDerivatives, way: f64) -> Joints {
    std::array::from_fn(|place| on(course.joints.map(|joints| joints[place]), way))
}

struct Case {
    machine: Random,
    solver: Solver,
    tip: [Vector3<f64>; ORDERS],
    course: JointDerivatives,
}

fn solved(rng: &mut Rng, free: usize, held: usize) -> (Random, Solver) {
    let machine = Random::new(rng, free, held);
    let reference = &machine.reference;
    let chain =
        Chain::new(reference.joints.clone(), reference.mount, reference.tip, reference.axis);
    let solver = Solver::new(chain, &machine.free, machine.held).expect("a closed form");
    (machine, solver)
}

fn case(rng: &mut Rng) -> Case {
    let free = 1 + rng.pick(2);
    let held = rng.pick(2);
    let (machine, solver) = solved(rng, free, held);
    let reference = &machine.reference;
    let mut course = JointDerivatives::default();
    course.joints[0] = machine.values(rng);
    for order in 1..ORDERS {
        for joint in &machine.free {
            course.joints[order][*joint] = rng.range(-0.02, 0.02);
        }
    }
    let start = reference.forward(&course.joints[0]).0;
    let tip = [0, 1, 2, 3].map(|order| match order {
        0 => start,
        _ => rng.direction() * rng.range(0.0, 1.0),
    });
    solver.course(&tip, &mut course).expect("axes that follow");
    Case { machine, solver, tip, course }
}

#[test]
fn axes_that_go_by_their_derivatives_lead_the_tip_along_its_path() {
    let (cases, mut rng) = randomised(400_u32, 71);
    let mut worst: f64 = 0.0;
    for _ in cases {
        let case = case(&mut rng);
        let miss = |way: f64| {
            let joints = joints_on(&case.course, way);
            let tip = case.machine.reference.forward(&joints).0;
            (tip - on(case.tip, way)).norm()
        };
        // What is left out is of the fourth order: half the way, a sixteenth of it. Fourth and fifth order may cancel at
        // one length, not at both.
        let orders = [0.1, 0.025].map(|way| {
            let (whole, half) = (miss(way), miss(0.5 * way));
            if whole > 1e-9 { libm::log2(whole / half) } else { 4.0 }
        });
        assert!(orders.iter().any(|order| *order > 3.5), "{orders:?} of {:?}", case.course.joints);
        // Rotary axes turn by no more than 0.02 in each order, two of them, so that the fourth derivative of the tip is at
        // most 0.6 of what the linear axes do in the orders before: (4 + 6 + 4)·0.04. Where these hardly span the space
        // that is a lot; else it is nothing beside levers of some 1000 mm.
        let linear = case.machine.reference.linear();
        let order = |joints: &Joints| linear.iter().map(|place| joints[*place].abs()).sum::<f64>();
        let size = case.course.joints[1..].iter().map(order).fold(0.0, f64::max);
        let left_out = 1e-12 / 24.0 * size;
        worst = worst.max(miss(1e-3) - left_out);
    }
    assert!(worst < 1e-9, "{worst}");
}

#[test]
fn rates_say_how_the_tip_moves_with_each_axis() {
    let (cases, mut rng) = randomised(200_u32, 72);
    for _ in cases {
        let case = case(&mut rng);
        let stand = case.course.joints[0];
        for place in 0..case.solver.chain().joints().len() {
            let at = |way: f64| {
                let mut joints = stand;
                joints[place] += way;
                case.machine.reference.forward(&joints).0
            };
            let wanted = (at(1e-4) - at(-1e-4)) / 2e-4;
            let found = case.course.rates[place];
            let size = 1.0 + wanted.norm();
            assert!((found - wanted).norm() < 1e-6 * size, "{found} {wanted}");
        }
    }
}

#[test]
fn rotary_axes_that_go_by_their_derivatives_lead_the_tool_axis_along_its_path() {
    let (cases, mut rng) = randomised(400_u32, 73);
    let mut followed = 0;
    for _ in cases {
        let held = rng.pick(2);
        let (machine, solver) = solved(&mut rng, 2, held);
        let reference = &machine.reference;
        let mut course = JointDerivatives::default();
        course.joints[0] = machine.values(&mut rng);
        let start = reference.forward(&course.joints[0]).1;
        let goes = [1, 2, 3].map(|_| rng.direction() * rng.range(0.0, 0.02));
        // A vector that goes so, as a unit vector.
        let vector = |way: f64| on([start, goes[0], goes[1], goes[2]], way).normalize();
        let axis = direction(&[start, goes[0], goes[1], goes[2]]).expect("not null");
        if solver.turn_along(&machine.free, &axis, &mut course).is_err() {
            continue;
        }
        // Close to the pole all orders are large.
        if course.joints[1..].iter().flatten().any(|size| size.abs() > 0.2) {
            continue;
        }
        followed += 1;
        let miss = |way: f64| {
            let joints = joints_on(&course, way);
            (machine.reference.forward(&joints).1 - vector(way)).norm()
        };
        let orders = [0.4, 0.1].map(|way| {
            let (whole, half) = (miss(way), miss(0.5 * way));
            if whole > 1e-10 { libm::log2(whole / half) } else { 4.0 }
        });
        assert!(orders.iter().any(|order| *order > 3.5), "{orders:?}");
        assert!(miss(1e-2) < 1e-9);
    }
    assert!(followed > at_least(200), "{followed}");
}
