//! Arms of six rotary axes, against a product of matrices that moves bodies and against the formulas of others.

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use post_machine::kinematics::{Chain, Joint};
use rs_opw_kinematics::kinematic_traits::{self, Kinematics};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;

use super::*;

/// The chain of an arm as the published parameters have it: shoulder, elbow and wrist in the plane Y = 0, upright; senses
/// of the joints and what they count at that place besides.
fn opw_chain(of: &Parameters, tip: Vector3<f64>, edge: Option<Vector3<f64>>) -> Chain {
    let turning =
        |direction: Vector3<f64>, point: Vector3<f64>| Joint { rotary: true, direction, point };
    let wrist = Vector3::new(of.a1 + of.a2, of.b, of.c1 + of.c2 + of.c3);
    let joints = vec![
        turning(Vector3::z(), Vector3::zeros()),
        turning(Vector3::y(), Vector3::new(of.a1, 0.0, of.c1)),
        turning(Vector3::y(), Vector3::new(of.a1, 0.0, of.c1 + of.c2)),
        turning(Vector3::z(), wrist),
        turning(Vector3::y(), wrist),
        turning(Vector3::z(), wrist),
    ];
    Chain::new(joints, Vector3::zeros(), tip, Vector3::z()).with_edge(edge)
}

/// Where a body behind all joints stands.
fn moved(chain: &Chain, values: &Joints) -> Isometry3<f64> {
    let joints = chain.joints().iter().zip(values);
    joints.fold(Isometry3::identity(), |before, (joint, value)| {
        let turn = UnitQuaternion::from_axis_angle(&Unit::new_normalize(joint.direction), *value);
        let there = Translation3::from(joint.point);
        before * (there * turn * there.inverse())
    })
}

/// The pose of the tool there.
fn pose_at(chain: &Chain, values: &Joints) -> Pose {
    let body = moved(chain, values);
    Pose {
        tip: body * nalgebra::Point3::from(chain.tip()) - nalgebra::Point3::origin(),
        axis: body * chain.axis(),
        edge: chain.edge().map_or_else(Vector3::zeros, |edge| body * edge),
    }
}

fn isometry(of: &kinematic_traits::Pose) -> Isometry3<f64> {
    let [x, y, z] = of.translation.to_array();
    let [i, j, k, w] = of.rotation.to_array();
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
    Isometry3::from_parts(Translation3::new(x, y, z), turn)
}

/// Published parameters (mm): ABB IRB 2400/10, KUKA KR 6 R700 sixx, Fanuc R-2000iB/200R, Stäubli TX40.
fn published() -> [Parameters; 4] {
    let of = |lengths: [f64; 7]| {
        let [a1, a2, b, c1, c2, c3, c4] = lengths;
        Parameters {
            a1,
            a2,
            b,
            c1,
            c2,
            c3,
            c4,
            offsets: [0.0; 6],
            sign_corrections: [1; 6],
            dof: 6,
        }
    };
    [
        of([100.0, -135.0, 0.0, 615.0, 705.0, 755.0, 85.0]),
        of([25.0, 35.0, 0.0, 400.0, 315.0, 365.0, 80.0]),
        of([720.0, -225.0, 0.0, 600.0, 1075.0, 1280.0, 235.0]),
        of([0.0, 0.0, 35.0, 320.0, 225.0, 225.0, 65.0]),
    ]
}

fn same(a: &Joints, b: &Joints) -> bool {
    a.iter().zip(b).all(|(a, b)| turned(*a, *b).abs() < 1e-6)
}

/// Solver and the published formulas give the same solutions of a whole frame, and both stand up to the matrices.
#[test]
fn arms_with_a_spherical_wrist_have_the_published_solutions() {
    let (rounds, mut rng) = randomised(400, 61);
    let (mut poses, mut found, mut eight) = (0, 0, 0);
    for _ in rounds {
        for parameters in published() {
            let flange = Vector3::new(
                parameters.a1 + parameters.a2,
                parameters.b,
                parameters.c1 + parameters.c2 + parameters.c3 + parameters.c4,
            );
            let chain = opw_chain(&parameters, flange, Some(Vector3::x()));
            let solver =
                Solver::new(chain.clone(), &[0, 1, 2, 3, 4, 5], Joints::default()).expect("an arm");
            let values: Joints = std::array::from_fn(|joint| match joint {
                0..6 => rng.range(-3.0, 3.0),
                _ => 0.0,
            });
            // Beside the places where two solutions meet.
            if libm::sin(values[4]).abs() < 0.05 {
                continue;
            }
            let pose = pose_at(&chain, &values);
            let reached = chain.forward(&values);
            assert!(
                (reached.tip - pose.tip).norm() < 1e-9 && angle(reached.edge, pose.edge) < 1e-9
            );
            let Ok(solutions) = solver.inverse(&pose, &Joints::default(), 1e-9) else {
                panic!("no solution at {values:?}");
            };
            for solution in &solutions {
                let back = pose_at(&chain, solution);
                assert!((back.tip - pose.tip).norm() < 1e-6, "{values:?}");
                assert!(angle(back.axis, pose.axis) < 1e-8 && angle(back.edge, pose.edge) < 1e-8);
            }
            let arm = OPWKinematics::new(parameters);
            let theirs = arm.forward(&std::array::from_fn(|joint| values[joint]));
            let ours = moved(&chain, &values) * isometry(&arm.forward(&[0.0; 6]));
            let apart = isometry(&theirs).inverse() * ours;
            assert!(apart.translation.vector.norm() < 1e-6 && apart.rotation.angle() < 1e-7);
            let theirs: Vec<Joints> = arm
                .inverse(&theirs)
                .iter()
                .map(|six| std::array::from_fn(|joint| six.get(joint).copied().unwrap_or(0.0)))
                .collect();
            poses += 1;
            found += theirs.len();
            eight += usize::from(solutions.len() == 8);
            assert!(solutions.iter().any(|solution| same(solution, &values)), "{values:?}");
            for solution in &theirs {
                assert!(
                    solutions.iter().any(|own| same(own, solution)),
                    "{solution:?} is missing at {values:?}: {solutions:?}"
                );
            }
            assert!(solutions.len() >= theirs.len(), "{values:?}");
        }
    }
    println!("of {poses} poses: {found} solutions by others, all eight in {eight} of them");
    assert!(eight * 20 >= poses && found >= 2 * poses);
}

/// The arm of Universal Robots, whose second to fourth axes are parallel: as published (UR5e), and its solutions stand up to
/// the matrices. A tool that turns is solved all around, and turns about itself in each.
#[test]
fn arms_with_three_parallel_axes_are_solved() {
    let (rounds, mut rng) = randomised(400, 62);
    let (mut poses, mut eight) = (0, 0);
    let turning =
        |direction: Vector3<f64>, point: Vector3<f64>| Joint { rotary: true, direction, point };
    let arm = |edge| {
        let joints = vec![
            turning(Vector3::z(), Vector3::zeros()),
            turning(-Vector3::y(), Vector3::new(0.0, 0.0, 162.5)),
            turning(-Vector3::y(), Vector3::new(-425.0, 0.0, 162.5)),
            turning(-Vector3::y(), Vector3::new(-817.2, 0.0, 162.5)),
            turning(-Vector3::z(), Vector3::new(-817.2, -133.3, 0.0)),
            turning(-Vector3::y(), Vector3::new(-817.2, 0.0, 62.8)),
        ];
        let tip = Vector3::new(-817.2, -232.9, 62.8);
        Chain::new(joints, Vector3::zeros(), tip, Vector3::y()).with_edge(edge)
    };
    for _ in rounds {
        let chain = arm(Some(Vector3::x()));
        let solver =
            Solver::new(chain.clone(), &[0, 1, 2, 3, 4, 5], Joints::default()).expect("an arm");
        let values: Joints = std::array::from_fn(|joint| match joint {
            0..6 => rng.range(-3.0, 3.0),
            _ => 0.0,
        });
        if libm::sin(values[4]).abs() < 0.05 || libm::sin(values[2]).abs() < 0.05 {
            continue;
        }
        poses += 1;
        let pose = pose_at(&chain, &values);
        let solutions = solver.inverse(&pose, &Joints::default(), 1e-9).expect("solutions");
        eight += usize::from(solutions.len() == 8);
        assert!(solutions.iter().any(|solution| same(solution, &values)), "{values:?}");
        for solution in &solutions {
            let back = pose_at(&chain, solution);
            assert!((back.tip - pose.tip).norm() < 1e-6, "{values:?}");
            assert!(angle(back.axis, pose.axis) < 1e-8 && angle(back.edge, pose.edge) < 1e-8);
        }
        let turned = arm(None);
        let solver =
            Solver::new(turned.clone(), &[0, 1, 2, 3, 4, 5], Joints::default()).expect("an arm");
        assert_eq!(solver.surplus(), [5]);
        let pose = Pose { edge: Vector3::zeros(), ..pose };
        let solutions = solver.inverse(&pose, &Joints::default(), 1e-9).expect("solutions");
        assert!(solutions.len() >= 16);
        for solution in &solutions {
            let back = pose_at(&turned, solution);
            assert!((back.tip - pose.tip).norm() < 1e-6 && angle(back.axis, pose.axis) < 1e-8);
        }
    }
    println!("of {poses} poses {eight} have eight solutions");
    assert!(eight * 20 >= poses);
}
