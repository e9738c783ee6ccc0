//! Smooth curves: what the servo makes of them, and what the spline is worth.

use std::f64::consts::TAU;

use nalgebra::Rotation3;

use super::{Point, off, run};

/// ε = ρ|1 - |G|| (feedrate paper, section 3): a servo makes a circle of the radius ρ|G| of a circle, late by its phase.
#[test]
fn a_circle_becomes_smaller_by_the_gain_of_the_servo() {
    let (period, speed, radius) = (0.001, 100.0, 10.0);
    for (gain, phase) in [(0.998, 0.3), (1.0049, 0.05), (0.9, 1.2)] {
        let at = |angle: f64, radius: f64| {
            let (sine, cosine) = libm::sincos(angle);
            Point::new(radius * cosine, radius * sine, 2.0)
        };
        let way: Vec<_> = (0..3000)
            .map(|n| {
                let angle = speed * period * f64::from(n) / radius;
                (at(angle, radius), at(angle - phase, radius * gain))
            })
            .collect();
        let (told, report) = run(period, &Rotation3::identity(), &way);
        let wanted = radius * (1.0 - gain).abs();
        assert!(off(&told, 200, wanted) < 1e-8, "gain {gain}");
        let lag = libm::hypot(gain - libm::cos(phase), libm::sin(phase)) * radius;
        assert!((report.following.peak.value - lag).abs() < 1e-9);
    }
}

/// What is offset from a helix or an ellipse along its normal is so far from it.
#[test]
fn what_runs_beside_a_curve_is_off_by_its_offset() {
    let period = 0.001;
    let helix = |angle: f64, off: f64| {
        let (sine, cosine) = libm::sincos(angle);
        Point::new((8.0 + off) * cosine, (8.0 + off) * sine, 3.0 * angle)
    };
    let ellipse = |angle: f64, off: f64| {
        let (sine, cosine) = libm::sincos(angle);
        let normal = Point::new(12.0 * cosine, 30.0 * sine, 0.0).normalize();
        Point::new(30.0 * cosine, 12.0 * sine, 0.0) + normal * off
    };
    let curves: [&dyn Fn(f64, f64) -> Point; 2] = [&helix, &ellipse];
    for curve in curves {
        for offset in [0.02, -0.013, 0.4] {
            let way: Vec<_> = (0..2500)
                .map(|n| {
                    let angle = 0.005 * f64::from(n);
                    (curve(angle, 0.0), curve(angle - 0.1, offset))
                })
                .collect();
            let (told, _) = run(period, &Rotation3::identity(), &way);
            let off = off(&told, 100, offset.abs());
            assert!(off < 2e-8, "offset {offset}: {off}");
        }
    }
}

/// However far it lags behind, and although the path crosses itself meanwhile.
#[test]
fn a_tool_that_lags_on_its_path_has_no_contour_error() {
    let line = |n: i32| Point::new(0.05 * f64::from(n), 0.02 * f64::from(n), 0.0);
    // An eight: its loops are shorter than the largest lag.
    let eight = |n: i32| {
        let angle = TAU * f64::from(n) / 900.0;
        Point::new(20.0 * libm::sin(angle), 8.0 * libm::sin(2.0 * angle), 0.0)
    };
    let curves: [(&dyn Fn(i32) -> Point, f64); 2] = [(&line, 1e-12), (&eight, 2e-8)];
    for (curve, bound) in curves {
        for lag in [3, 40, 250, 1000, 3000] {
            // It starts on its path and falls back: at half its speed until it lags.
            let place = |n: i32| n.min(n / 2 + 400).max(n - lag).min(n);
            let way: Vec<_> = (0..9000).map(|n| (curve(n), curve(place(n)))).collect();
            let (told, report) = run(0.001, &Rotation3::identity(), &way);
            let off = off(&told, 3, 0.0);
            assert!(off < bound, "lag {lag}: {off}");
            assert!(report.following.peak.value > 0.1);
            assert!(report.axes[0].following.value > 0.1);
        }
    }
}

/// Twice as many set-points, a sixteenth of the error: the fourth order.
#[test]
fn the_spline_is_of_the_fourth_order() {
    let curve = |time: f64| {
        Point::new(
            30.0 * libm::sin(time),
            20.0 * libm::cos(1.7 * time),
            9.0 * libm::sin(2.3 * time + 0.4),
        )
    };
    let largest = |count: i32| {
        let step = 8.0 / f64::from(count);
        let way: Vec<_> = (0..count)
            .map(|n| (curve(step * f64::from(n)), curve(step * (f64::from(n) - 0.5))))
            .collect();
        let (told, _) = run(0.001, &Rotation3::identity(), &way);
        off(&told, count as usize / 20, 0.0)
    };
    let errors: Vec<f64> = [100, 200, 400].map(largest).into();
    for pair in errors.windows(2) {
        let order = libm::log2(pair[0] / pair[1]);
        assert!(order > 3.6 && order < 4.6, "{errors:?}: order {order}");
    }
}

/// The same in any frame.
#[test]
fn turning_the_machine_changes_nothing() {
    let way: Vec<_> = (0..600)
        .map(|n| {
            let time = 0.01 * f64::from(n);
            let commanded = Point::new(10.0 * libm::sin(time), 6.0 * libm::sin(2.0 * time), time);
            let late = time - 0.03;
            let off = Point::new(libm::sin(9.0 * time), libm::cos(7.0 * time), 0.3) * 0.01;
            let actual = Point::new(10.0 * libm::sin(late), 6.0 * libm::sin(2.0 * late), late);
            (commanded, actual + off)
        })
        .collect();
    let plain = run(0.002, &Rotation3::identity(), &way);
    let frame = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
    let turned = run(0.002, &frame, &way);
    for (one, other) in plain.0.iter().zip(&turned.0) {
        assert!((one.distance - other.distance).abs() < 1e-9);
        assert!((frame * one.error - other.error).norm() < 1e-8);
    }
    assert!((plain.1.cuts.rms() - turned.1.cuts.rms()).abs() < 1e-9);
}
