//! The angles of tilted planes, turned back into frames by products of rotations that take no line from the code.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use post_machine::tilted_plane::{angles, rotation};
use post_plugin::PlaneAngles;
use post_testkit::randomised;

const CONVENTIONS: [PlaneAngles; 7] = [
    PlaneAngles::Zxz,
    PlaneAngles::Xyz,
    PlaneAngles::Xzy,
    PlaneAngles::Yxz,
    PlaneAngles::Yzx,
    PlaneAngles::Zxy,
    PlaneAngles::Zyx,
];

/// Intrinsic turns: each about an axis of the frame that those before it have made.
fn turned(order: [usize; 3], turns: [f64; 3]) -> Matrix3<f64> {
    let mut frame = Rotation3::identity();
    for (axis, turn) in order.into_iter().zip(turns) {
        let about = frame.matrix().column(axis).into_owned();
        frame = Rotation3::from_axis_angle(&Unit::new_normalize(about), turn) * frame;
    }
    frame.into_inner()
}

/// Wrong angles tilt the part another way than the tool stands: the cutter goes through the wall.
#[test]
fn angles_of_every_convention_turn_back_into_their_frame() {
    let (trials, mut rng) = randomised(2000u32, 22);
    for trial in trials {
        let turns = [0, 1, 2].map(|_| rng.range(-3.2, 3.2));
        // Every fourth at a pole, or so close to it that no control could print the difference.
        let middle = match trial % 8 {
            0 => 0.0,
            4 => std::f64::consts::FRAC_PI_2,
            2 => 1e-9,
            _ => turns[1],
        };
        for convention in CONVENTIONS {
            let order = convention.order().unwrap();
            let frame = turned(order, [turns[0], middle, turns[2]]);
            let found = angles(order, &frame);
            let back = turned(order, found);
            assert!((back - frame).norm() < 1e-7, "{convention:?} {found:?}");
            assert!((rotation(order, found) - back).norm() < 1e-12);
            let range = match order[0] == order[2] {
                true => 0.0..=PI + 1e-9,
                false => -FRAC_PI_2 - 1e-9..=FRAC_PI_2 + 1e-9,
            };
            assert!(range.contains(&found[1]), "{convention:?} {found:?}");
            // The other solution is the same frame: which of the two is printed makes no difference to the plane.
            let half = std::f64::consts::PI;
            let other = match order[0] == order[2] {
                true => [found[0] + half, -found[1], found[2] + half],
                false => [found[0] + half, half - found[1], found[2] + half],
            };
            assert!((turned(order, other) - back).norm() < 1e-12, "{convention:?}");
        }
    }
}

/// Turns about the machine's fixed A, then B, then C are those of Z, Y and X in turn; with B+45 alone the tool leans
/// to +X, and a table with A and C comes there at A+45 C+90 (table in the makers' manual).
#[test]
fn spatial_angles_are_turns_about_fixed_axes() {
    let about = |axis: Vector3<f64>, degrees: f64| {
        Rotation3::from_axis_angle(&Unit::new_normalize(axis), degrees.to_radians())
    };
    let (a, b, c) = (20.0, -35.0, 70.0);
    let fixed = about(Vector3::z(), c) * about(Vector3::y(), b) * about(Vector3::x(), a);
    let order = PlaneAngles::Zyx.order().unwrap();
    let found = angles(order, fixed.matrix()).map(f64::to_degrees);
    for (found, wanted) in found.into_iter().zip([c, b, a]) {
        assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
    }
    let leaning = about(Vector3::y(), 45.0) * Vector3::z();
    // The table turns the part: the tool seen from it turns the other way, C first.
    let table = about(Vector3::z(), 90.0) * about(Vector3::x(), 45.0) * Vector3::z();
    let other = about(Vector3::z(), -90.0) * about(Vector3::x(), -45.0) * Vector3::z();
    assert!((leaning - table).norm() < 1e-12 && (leaning - other).norm() < 1e-12);
}
