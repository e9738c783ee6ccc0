//! Corners, reversals and pecks: which leg the tool is held against.

use std::f64::consts::TAU;

use nalgebra::Rotation3;

use super::{Point, off, run};

/// Along X, a stop, along Y, in set-points of `period` with constant acceleration.
fn corner(period: f64, acceleration: f64, speed: f64) -> Vec<Point> {
    let ramp = speed / acceleration;
    let leg = |time: f64| match time < ramp {
        true => 0.5 * acceleration * time * time,
        false => 0.5 * speed * ramp + speed * (time - ramp),
    };
    let stop = 0.15;
    let mut points = Vec::new();
    let mut time = 0.0;
    while time < 0.4 {
        points.push(match time < stop {
            true => Point::new(-leg(stop - time), 0.0, 0.0),
            false => Point::new(0.0, leg((time - stop - 0.05).max(0.0)), 0.0),
        });
        time += period;
    }
    points
}

/// A stop in a corner is not overshot by the spline: what overshoots it counts in full.
#[test]
fn what_overshoots_a_corner_is_off_by_that() {
    for period in [0.001, 0.0037, 0.015] {
        let path = corner(period, 4000.0, 83.0);
        for over in [0.002, 0.02] {
            let past = |point: &Point| match point.y > 0.0 || point.x > -over {
                true => Point::new(over, point.y, 0.0),
                false => point + Point::x() * over,
            };
            let way: Vec<_> = path.iter().map(|point| (*point, past(point))).collect();
            let (told, report) = run(period, &Rotation3::identity(), &way);
            assert!(report.cuts.peak.value < over + 1e-9);
            let standing: Vec<_> =
                told.iter().filter(|point| point.commanded.tip == Point::zeros()).collect();
            assert!(standing.len() > 2);
            for point in standing {
                assert!((point.distance - over).abs() < 1e-9, "period {period}");
            }
        }
    }
}

/// A corner between two set-points at full speed is passed on its chords, whatever the angle.
#[test]
fn straight_ways_stay_straight_at_a_sharp_corner() {
    for degrees in [10.0_f64, 60.0, 90.0, 150.0, 180.0] {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        let at = |way: f64| match way < 0.0 {
            true => Point::new(way, 0.0, 0.0),
            false => Point::new(way * cosine, way * sine, 0.0),
        };
        let way: Vec<_> = (-40..40)
            .map(|n| {
                let way = 1.25 * f64::from(n);
                (at(way), at(way - 0.3))
            })
            .collect();
        let (told, _) = run(0.015, &Rotation3::identity(), &way);
        assert!(off(&told, 3, 0.0) < 1e-9, "{degrees} degrees");
    }
}

/// A cut corner: the nearest point passes from leg to leg, and how far off the corner it stays is told apart.
#[test]
fn a_tool_that_cuts_a_corner_passes_from_leg_to_leg() {
    let (round, step) = (1.0, 0.02);
    let way: Vec<_> = (-300..300)
        .map(|n| {
            let way = step * f64::from(n);
            let commanded = match way < 0.0 {
                true => Point::new(way, 0.0, 0.0),
                false => Point::new(0.0, way, 0.0),
            };
            // A quarter of a circle of 1 mm, at the same time at its ends.
            let actual = match way.abs() < round {
                true => {
                    let (sine, cosine) = libm::sincos(0.25 * TAU * 0.5 * (way / round + 1.0));
                    Point::new(-round + round * sine, round - round * cosine, 0.0)
                }
                false => commanded,
            };
            (commanded, actual)
        })
        .collect();
    let (_, report) = run(0.001, &Rotation3::identity(), &way);
    // On the bisector the arc is r(√2 - 1) off the corner, and r(1 - 1/√2) off each leg.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert!((report.cuts.peak.value - round * (1.0 - half)).abs() < 0.002);
    let corner = round * (2.0 * half - 1.0);
    assert!((report.missed.value - corner).abs() < 0.02, "{}", report.missed.value);
}

/// A needle: out and back on nearly the same way. The tool is held against the way that it goes.
#[test]
fn out_and_back_are_told_apart() {
    let slope = 0.02;
    let at = |way: f64| {
        Point::new(20.0 - way.abs(), (20.0 - way.abs()) * if way < 0.0 { 0.0 } else { slope }, 0.0)
    };
    let shifted = |way: f64| {
        let point = at(way);
        match way < 0.0 {
            true => point,
            false => Point::new(point.x, point.x * slope, 0.0),
        }
    };
    let way: Vec<_> = (-400..400)
        .map(|n| {
            let way = 0.05 * f64::from(n);
            (shifted(way), shifted(way - 2.0))
        })
        .collect();
    let (told, _) = run(0.001, &Rotation3::identity(), &way);
    assert!(off(&told, 45, 0.0) < 0.03);
}

/// Pecks: down a hole and up and down again, each deeper, the tool far behind. It is on its path all the time, and at each
/// end it turns early by its lag, which is no error beside the path.
#[test]
fn pecks_are_gone_along_in_order() {
    let mut depths = Vec::new();
    for peck in 1..=5 {
        let deep = 6 * peck;
        depths.extend((0..100 * deep).map(|n| -0.01 * f64::from(n)));
        depths.extend((0..25 * deep).map(|n| -0.01 * f64::from(4 * (25 * deep - n))));
    }
    depths.extend((0..4000).map(|n| -0.01 * f64::from(n)));
    let mut late = 0.0;
    let way: Vec<_> = depths
        .iter()
        .map(|depth| {
            late += 0.02 * (depth - late);
            (Point::new(3.0, 4.0, *depth), Point::new(3.0, 4.0, late))
        })
        .collect();
    let (told, _) = run(0.001, &Rotation3::identity(), &way);
    for (number, point) in told.iter().enumerate().skip(5) {
        assert!(point.distance < 1e-3, "set-point {number}: {}", point.distance);
    }
    let last = told[told.len() - 200];
    assert!((last.nearest.tip - last.actual.tip).norm() < 1e-6);
}
