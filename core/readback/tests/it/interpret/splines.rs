//! Splines by control points against the closed forms of Bézier curves, and what is refused of them.

use post_machine::description::Machine;
use post_plugin::{Language, Meaning as M};
use post_readback::{BSpline, Curve, Interpolation, Motion, MotionKind, Offsets};

use super::{LETTERS, Ran, machine, ran, ran_in};

use nalgebra::Vector3;

type V = Vector3<f64>;

/// Four points of a cubic: its knots leave one span, so that it is a rational Bézier curve.
const CUBIC: &str = "G90 G21\nG1 X1 Y2 Z3 F600\n\
    G6.2 P4 K0 X1 Y2 Z3 R1\nK0 X5 Y12 Z5 R2\nK0 X13 R2\nK0 X17 Y2 Z3\nK1\nK1\nK1\nK1\n\
    G1 X20 Y0\nM30\n";

/// Its points and weights.
const POINTS: [([f64; 3], f64); 4] = [
    ([1.0, 2.0, 3.0], 1.0),
    ([5.0, 12.0, 5.0], 2.0),
    ([13.0, 12.0, 5.0], 2.0),
    ([17.0, 2.0, 3.0], 1.0),
];

/// Bernstein's form.
fn bezier(t: f64) -> V {
    let s = 1.0 - t;
    let basis = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    let (mut sum, mut weights) = (V::zeros(), 0.0);
    for ((point, weight), basis) in POINTS.into_iter().zip(basis) {
        sum += V::from(point) * (weight * basis);
        weights += weight * basis;
    }
    sum / weights
}

fn macros(machine: &Machine, text: &str) -> Ran {
    let words = [LETTERS, &[("G6.2", M::Spline), ("G5", M::Smoothing)]].concat();
    ran(machine, &words, &Offsets::default(), text)
}

/// A control of the family of RS-274/NGC.
fn even(text: &str) -> Ran {
    let own = [("G38.2", M::Probe), ("G5.2", M::Spline), ("G5.3", M::Nothing)];
    let words = [LETTERS, &own].concat();
    ran_in(Language::Rs274, &machine("vmc"), &words, &Offsets::default(), text)
}

fn spline(ran: &Ran) -> (&Motion, &BSpline) {
    let mut splines = ran.motions.iter().filter_map(|motion| match &motion.way {
        Interpolation::Tip(Curve::Spline(way)) => Some((motion, &**way)),
        _ => None,
    });
    let found = splines.next().unwrap();
    assert!(splines.next().is_none());
    found
}

#[test]
fn points_with_knots_and_weights_are_a_rational_curve() {
    let ran = macros(&machine("vmc"), CUBIC).whole();
    let (motion, _) = spline(&ran);
    let zero = motion.from.pose.tip - bezier(0.0);
    let mut length = 0.0;
    for place in 0..=1000 {
        let t = f64::from(place) / 1000.0;
        let off = (motion.at(t).tip - zero - bezier(t)).norm();
        assert!(off < 1e-9, "{t}: {off}");
        if place > 0 {
            length += (bezier(t) - bezier(t - 1e-3)).norm();
        }
    }
    assert_eq!((motion.kind, motion.feed), (MotionKind::Feed, 600.0));
    let minutes = length / 600.0;
    assert!((motion.minutes / minutes - 1.0).abs() < 1e-3);
    // What comes behind counts from its end.
    let last = ran.last();
    assert!((last.from.pose.tip - zero - bezier(1.0)).norm() < 1e-9);
    assert!((last.to.pose.tip - zero - V::new(20.0, 0.0, 3.0)).norm() < 1e-9);
}

#[test]
fn positions_of_axes_lie_as_the_axes_do() {
    // The table stands at 90 degrees: each place of the curve is that of the axes there.
    let machine = machine("ac-trunnion");
    let text = CUBIC.replace("G1 X1 Y2 Z3", "G1 X1 Y2 Z3 A30 C90");
    let ran = macros(&machine, &text).whole();
    let (motion, _) = spline(&ran);
    let place = |name: &str| machine.axes.iter().position(|axis| axis.name == name).unwrap();
    let axes = ["X", "Y", "Z"].map(place);
    for place in 0..=20 {
        let t = f64::from(place) / 20.0;
        let mut joints = motion.from.joints;
        for (row, axis) in axes.into_iter().enumerate() {
            joints[axis] += bezier(t)[row] - bezier(0.0)[row];
        }
        let tip = motion.state.solver.chain().forward(&joints).tip;
        assert!((motion.at(t).tip - tip).norm() < 1e-9, "{t}");
    }
}

#[test]
fn even_knots_begin_where_the_tool_stands() {
    // Of order 3 and with weights of 1: between two spans the curve is in the middle of two points.
    let text =
        "G21 G90\nG1 X0 Y0 Z0 F500\nG5.2 X10 Y0 L3 P1\nX20 Y10 P1\nX20 Y30 P1\nG5.3\nG1 X0\nM2\n";
    let ran = even(text).whole();
    let (motion, way) = spline(&ran);
    assert_eq!(way.knots, [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]);
    let zero = motion.from.pose.tip;
    assert!((motion.at(0.5).tip - zero - V::new(15.0, 5.0, 0.0)).norm() < 1e-9);
    assert!((motion.at(1.0).tip - zero - V::new(20.0, 30.0, 0.0)).norm() < 1e-9);
    // P alone is the weight of where it begins.
    let weighted = text.replace("G5.2 X10", "G5.2 P2\nX10").replace(" L3", "");
    let ran = even(&weighted).whole();
    let (_, way) = spline(&ran);
    let weights: Vec<f64> = way.poles.iter().map(|(_, weight)| *weight).collect();
    assert_eq!(weights, [2.0, 1.0, 1.0, 1.0]);
}

#[test]
fn what_is_no_spline_is_refused() {
    let vmc = machine("vmc");
    for (old, new, why) in [
        ("K0 X5 Y12", "X5 Y12", "without its knot"),
        ("G6.2 P4", "G6.2 P9", "order 9"),
        ("K1\nG1", "G1", "no part of it"),
        ("K0 X13", "G4 X1\nK0 X13", "no part of it"),
        ("K1\nK1\nK1\nK1", "K1\nK1\nK1\nK0", "no spline"),
        ("K0 X1 Y2 Z3", "K0 X1 Y3 Z3", "from where the tool stands"),
        ("R2\nK0 X17", "R0\nK0 X17", "weight 0"),
        ("K1\nK1\nK1\nK1", "K1\nK1 R2\nK1\nK1", "without its control point"),
        ("K1\nK1\nK1\nK1", "K1\nK1 X3\nK1\nK1", "behind the first"),
        ("G90 G21", "G93 G21", "inverse time"),
        ("G6.2", "G91 G6.2", "G91"),
        // It does not begin in its first point.
        ("G6.2 P4 K0", "G6.2 P4 K-1", "first and last control point"),
        ("K1\nG1", "K2\nG1", "first and last control point"),
        ("K1\nG1 X20 Y0\nM30\n", "", "never ends"),
    ] {
        assert!(CUBIC.contains(old), "{old}");
        let text = CUBIC.replacen(old, new, 1);
        let text = text.replace("G93 G21\nG1 X1 Y2 Z3 F600", "G93 G21\nG1 X1 Y2 Z3 F6");
        let ran = macros(&vmc, &text);
        let first = ran.refused.first();
        let told = first.map_or("", |finding| &finding.message);
        assert!(told.contains(why), "{new}: {told}");
    }
    // A rotary axis cannot go along.
    let text = CUBIC.replace("K0 X13", "K0 X13 A1");
    let ran = macros(&machine("ac-trunnion"), &text);
    assert!(ran.refused[0].message.contains("besides X, Y and Z"));
}
