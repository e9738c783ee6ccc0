//! The tool against the path that is asked for.

use std::f64::consts::TAU;

use nalgebra::Rotation3;
use post_machine::kinematics::Joints;
use post_motion::path::Curve;

use super::{Point, joints, leg, machine, run_against};

/// Against a CL path: an arc that is gone round twice, a line elsewhere, and a helix; each with its line, the tool beside
/// by what it is, and the program by what it is.
#[test]
fn the_tool_is_held_against_the_path_that_is_asked_for() {
    let on = |angle: f64, radius: f64, rise: f64| {
        let (sine, cosine) = libm::sincos(angle);
        Point::new(radius * cosine, radius * sine, rise * angle)
    };
    let arc = |sweep| Curve::Arc { centre: Point::zeros(), normal: Point::z(), sweep };
    let far = Point::new(80.0, 30.0, -5.0);
    let turn = 1.5 * TAU;
    let legs = vec![
        leg(7, arc(TAU), on(0.0, 20.0, 0.0), on(0.0, 20.0, 0.0)),
        leg(8, arc(TAU), on(0.0, 20.0, 0.0), on(0.0, 20.0, 0.0)),
        leg(11, Curve::Straight, far, far + Point::x() * 40.0),
        leg(12, Curve::Straight, far + Point::x() * 40.0, far + Point::new(40.0, 40.0, 0.0)),
        leg(20, arc(turn), on(0.0, 20.0, 2.0), on(turn, 20.0, 2.0)),
    ];
    let (program, off) = (0.004, 0.03);
    let mut way = Vec::new();
    let mut lines = Vec::new();
    let mut push = |line: u64, commanded: Point, actual: Point| {
        if lines.last().is_some_and(|last| *last > 0 && *last < line && line != 12 && line != 8) {
            // At rapid to the next cut.
            let [last, _]: [Joints; 2] = way[way.len() - 1];
            let last = Point::new(last[0], last[1], last[2]);
            for n in 1..=100 {
                let at = joints(last + (actual - last) * (f64::from(n) / 100.0), 0.0);
                lines.push(0);
                way.push([at, at]);
            }
        }
        lines.push(line);
        way.push([joints(commanded, 0.0), joints(actual, 0.0)]);
    };
    for n in 0..1600 {
        let angle = 2.0 * TAU * f64::from(n) / 1600.0;
        let line = if angle < TAU { 7 } else { 8 };
        push(line, on(angle, 20.0 + program, 0.0), on(angle - 0.01, 20.0 - off, 0.0));
    }
    for n in 0..400 {
        let at = far + Point::new(0.1 * f64::from(n), program, 0.0);
        push(11, at, at + Point::new(-0.5, -off - program, 0.0));
    }
    for n in 0..400 {
        let at = far + Point::new(40.0 - program, 0.1 * f64::from(n), 0.0);
        push(12, at, at + Point::new(off + program, -0.5, 0.0));
    }
    for n in 0..1600 {
        let angle = turn * f64::from(n) / 1600.0;
        push(20, on(angle, 20.0 + program, 2.0), on(angle - 0.01, 20.0 - off, 2.0));
    }
    let solver = machine(&Rotation3::identity(), false);
    let (told, report) = run_against(0.001, solver, &way, legs, &|number| lines[number] == 0);
    for (number, point) in told.iter().enumerate() {
        // Where one piece ends and the next begins, the tool belongs to either.
        let near = |step: usize| {
            lines[number.saturating_sub(step)] == lines[(number + 12).min(lines.len() - 1)]
        };
        if number < 12 || !near(12) {
            continue;
        }
        let Some(asked) = point.asked else {
            assert_eq!(lines[number], 0, "set-point {number}");
            continue;
        };
        assert_eq!(asked.at.line, lines[number], "set-point {number}");
        assert!((asked.distance - off).abs() < 1e-6, "set-point {number}: {}", asked.distance);
        assert!((asked.program - program).abs() < 1e-6, "set-point {number}: {}", asked.program);
        let bent = (asked.error + (point.nearest.tip - point.actual.tip)).norm();
        assert!((bent - program).abs() < 1e-4);
        assert!(asked.distance <= asked.program + point.interpolation + point.distance + 1e-9);
    }
    assert!((report.asked.rms() - off).abs() < 0.01);
}
