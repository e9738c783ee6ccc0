//! Chains with more freedom than a five-axis machine, or with none to spare, against an independent product of
//! isometries: three rotary axes and a leading edge, four linear axes, chains without a closed form, and machines
//! as they were measured.

mod frames;
mod linear;
mod measured;
mod numeric;
mod planar;
mod robots;

use std::f64::consts::PI;

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use post_machine::kinematics::POLE;
use post_machine::kinematics::{Freedom, Joints, Pose, Second, Solver, Unreachable};
use post_testkit::{Rng, at_least, randomised, rounds};
use post_testmachines::{Kind, Random, SIZE, across, angle, nearest, turned};

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

/// The inverse of a pose made at `q` with the reference; every solution is put through the isometries.
fn solutions(solver: &Solver, machine: &Random, q: &Joints) -> (Vec<Joints>, f64) {
    let (tip, axis) = machine.reference.forward(q);
    let pose = Pose { tip, axis, ..Pose::default() };
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
