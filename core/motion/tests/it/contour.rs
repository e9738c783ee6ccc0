//! Contour errors of paths whose contour errors are known in closed form, and what no path may change.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{Rotation3, Vector3};
use post_machine::kinematics::{Chain, Joint, Joints, Pose, Solver};
use post_motion::contour::{Contour, ContourPoint, ContourReport, Leg, Reference};
use post_motion::path::Way;
use post_motion::{At, SetPoints};

type Point = Vector3<f64>;

/// Three linear axes along these directions; with a rotary one on the tool's side about a line through the tip where
/// `turns`.
fn machine(frame: &Rotation3<f64>, turns: bool) -> Arc<Solver> {
    let linear = |direction: Point| Joint {
        rotary: false,
        direction: frame * direction,
        point: Point::zeros(),
    };
    let mut joints = vec![linear(Point::x()), linear(Point::y()), linear(Point::z())];
    let mut free = Vec::new();
    if turns {
        free.push(joints.len());
        joints.push(Joint {
            rotary: true,
            direction: frame * Point::x(),
            point: Point::zeros(),
        });
    }
    let chain = Chain::new(joints, Point::zeros(), Point::zeros(), frame * Point::z());
    Arc::new(Solver::new(chain, &free, Joints::default()).unwrap())
}

fn joints(point: Point, turn: f64) -> Joints {
    let mut joints = Joints::default();
    joints[..3].copy_from_slice(point.as_slice());
    joints[3] = turn;
    joints
}

/// The contour of tips, commanded and actual, in batches of odd lengths.
fn run(
    period: f64,
    frame: &Rotation3<f64>,
    way: &[(Point, Point)],
) -> (Vec<ContourPoint>, ContourReport) {
    let joints: Vec<_> = way
        .iter()
        .map(|(commanded, actual)| [joints(*commanded, 0.0), joints(*actual, 0.0)])
        .collect();
    run_axes(period, machine(frame, false), &joints)
}

/// Legs of a path that is asked for.
struct Legs(std::vec::IntoIter<Leg>);

impl Reference for Legs {
    fn next(&mut self) -> Option<Leg> {
        self.0.next()
    }
}

fn leg(line: u64, way: Way, from: Point, to: Point) -> Leg {
    let pose = |tip| Pose {
        tip,
        axis: Point::z(),
        ..Pose::default()
    };
    let at = At {
        line,
        cuts: true,
        task: 0,
    };
    Leg {
        at,
        way,
        from: pose(from),
        to: pose(to),
        along: 0.0,
    }
}

fn run_axes(
    period: f64,
    solver: Arc<Solver>,
    way: &[[Joints; 2]],
) -> (Vec<ContourPoint>, ContourReport) {
    run_against(period, solver, way, Vec::new(), &|_| false)
}

fn run_against(
    period: f64,
    solver: Arc<Solver>,
    way: &[[Joints; 2]],
    legs: Vec<Leg>,
    rapid: &dyn Fn(usize) -> bool,
) -> (Vec<ContourPoint>, ContourReport) {
    let mut contour = Contour::new().against(Box::new(Legs(legs.into_iter())));
    let mut told = Vec::new();
    let mut points = SetPoints::new(Arc::clone(&solver), period);
    let mut rest = way;
    let mut batch = 1;
    while !rest.is_empty() {
        let (now, behind) = rest.split_at(batch.min(rest.len()));
        points.clear();
        for [commanded, _] in now {
            let number = points.first as usize + points.len();
            points.joints.push(*commanded);
            points.poses.push(solver.chain().forward(commanded));
            points.at.push(At {
                cuts: !rapid(number),
                ..At::default()
            });
        }
        let actual: Vec<Joints> = now.iter().map(|pair| pair[1]).collect();
        contour.take(&points, &actual, &mut |point| told.push(*point));
        (rest, batch) = (behind, batch * 2 % 61 + 1);
    }
    let report = contour.finish(&mut |point| told.push(*point));
    assert_eq!(told.len(), way.len(), "each set-point is told once");
    for (place, point) in told.iter().enumerate() {
        assert!(
            (point.time - place as f64 * period).abs() < 1e-9,
            "in order"
        );
        let following = (point.commanded.tip - point.actual.tip).norm();
        assert!(
            point.distance <= following + 1e-9,
            "no more than the following error"
        );
        assert!((point.error.norm() - point.distance).abs() < 1e-9);
    }
    (told, report)
}

/// The largest difference from `wanted`, not counting so many set-points at both ends, where the machine starts at speed.
fn off(told: &[ContourPoint], ends: usize, wanted: f64) -> f64 {
    told[ends..told.len() - ends]
        .iter()
        .map(|point| (point.distance - wanted).abs())
        .fold(0.0, f64::max)
}

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
            .map(|n| {
                (
                    curve(step * f64::from(n)),
                    curve(step * (f64::from(n) - 0.5)),
                )
            })
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
            let standing: Vec<_> = told
                .iter()
                .filter(|point| point.commanded.tip == Point::zeros())
                .collect();
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
    assert!(
        (report.missed.value - corner).abs() < 0.02,
        "{}",
        report.missed.value
    );
}

/// A needle: out and back on nearly the same way. The tool is held against the way that it goes.
#[test]
fn out_and_back_are_told_apart() {
    let slope = 0.02;
    let at = |way: f64| {
        Point::new(
            20.0 - way.abs(),
            (20.0 - way.abs()) * if way < 0.0 { 0.0 } else { slope },
            0.0,
        )
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
        assert!(
            point.distance < 1e-3,
            "set-point {number}: {}",
            point.distance
        );
    }
    let last = told[told.len() - 200];
    assert!((last.nearest.tip - last.actual.tip).norm() < 1e-6);
}

/// The tool turns about its tip: it lags, and its axis is on its way all the same.
#[test]
fn a_tool_that_turns_about_its_tip_has_no_contour_error() {
    let turn = |n: i32| 0.001 * f64::from(n.clamp(0, 1000));
    let place = |n: i32| Point::new(0.05 * f64::from(n.min(0) + (n - 1000).max(0)), 0.0, 0.0);
    let way: Vec<_> = (-200..1300)
        .map(|n| {
            let late = n - 40;
            // Rounding of a control: the tip does not quite stand.
            let shake = Point::new(0.0, 1e-7 * libm::sin(f64::from(n)), 0.0);
            [
                joints(place(n) + shake, turn(n)),
                joints(place(late), turn(late)),
            ]
        })
        .collect();
    let (told, report) = run_axes(0.001, machine(&Rotation3::identity(), true), &way);
    for point in &told[50..1450] {
        assert!(point.distance < 2e-6, "{}: {}", point.time, point.distance);
        assert!(point.axis < 2e-5, "{}: {}", point.time, point.axis);
    }
    assert!(report.axes[3].following.value > 0.039);
    assert!((report.axes[3].velocity.value - 1.0).abs() < 1e-9);
}

/// A tool axis that leans off the one that is commanded, in closed form.
#[test]
fn the_tool_axis_is_held_against_the_nearest_point() {
    let way: Vec<_> = (0..500)
        .map(|n| {
            let time = 0.01 * f64::from(n);
            let late = time - 0.05;
            let lean = |time: f64| 0.4 * libm::sin(time);
            [
                joints(Point::new(10.0 * time, 0.0, 0.0), lean(time)),
                joints(Point::new(10.0 * late, 0.0, 0.0), lean(late) + 0.003),
            ]
        })
        .collect();
    let (told, _) = run_axes(0.001, machine(&Rotation3::identity(), true), &way);
    for point in &told[20..480] {
        assert!(point.distance < 1e-9);
        assert!((point.axis - 0.003).abs() < 1e-8, "{}", point.axis);
    }
}

/// Against a CL path: an arc that is gone round twice, a line elsewhere, and a helix; each with its line, the tool beside
/// by what it is, and the program by what it is.
#[test]
fn the_tool_is_held_against_the_path_that_is_asked_for() {
    let on = |angle: f64, radius: f64, rise: f64| {
        let (sine, cosine) = libm::sincos(angle);
        Point::new(radius * cosine, radius * sine, rise * angle)
    };
    let arc = |sweep| Way::Arc {
        centre: Point::zeros(),
        normal: Point::z(),
        sweep,
    };
    let far = Point::new(80.0, 30.0, -5.0);
    let turn = 1.5 * TAU;
    let legs = vec![
        leg(7, arc(TAU), on(0.0, 20.0, 0.0), on(0.0, 20.0, 0.0)),
        leg(8, arc(TAU), on(0.0, 20.0, 0.0), on(0.0, 20.0, 0.0)),
        leg(11, Way::Tip, far, far + Point::x() * 40.0),
        leg(
            12,
            Way::Tip,
            far + Point::x() * 40.0,
            far + Point::new(40.0, 40.0, 0.0),
        ),
        leg(20, arc(turn), on(0.0, 20.0, 2.0), on(turn, 20.0, 2.0)),
    ];
    let (program, off) = (0.004, 0.03);
    let mut way = Vec::new();
    let mut lines = Vec::new();
    let mut push = |line: u64, commanded: Point, actual: Point| {
        if lines
            .last()
            .is_some_and(|last| *last > 0 && *last < line && line != 12 && line != 8)
        {
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
        push(
            line,
            on(angle, 20.0 + program, 0.0),
            on(angle - 0.01, 20.0 - off, 0.0),
        );
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
        push(
            20,
            on(angle, 20.0 + program, 2.0),
            on(angle - 0.01, 20.0 - off, 2.0),
        );
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
        assert!(
            (asked.distance - off).abs() < 1e-6,
            "set-point {number}: {}",
            asked.distance
        );
        assert!(
            (asked.program - program).abs() < 1e-6,
            "set-point {number}: {}",
            asked.program
        );
        let bent = (asked.error + (point.nearest.tip - point.actual.tip)).norm();
        assert!((bent - program).abs() < 1e-4);
        assert!(asked.distance <= asked.program + point.interpolation + point.distance + 1e-9);
    }
    assert!((report.asked.rms() - off).abs() < 0.01);
}

/// Ten million set-points on one circle, the tool late and off it: every turn is like the second one.
#[test]
fn a_circle_many_times_is_off_by_the_same() {
    const TURN: usize = 1000;
    const TURNS: usize = 10_000;
    let solver = machine(&Rotation3::identity(), false);
    let at = |place: usize, late: f64, radius: f64| {
        let angle = TAU * (place as f64 - late) / TURN as f64;
        let tip = Point::new(libm::cos(angle), libm::sin(angle), 0.0) * radius;
        joints(tip, 0.0)
    };
    let commanded: Vec<_> = (0..TURN).map(|place| at(place, 0.0, 16.0)).collect();
    let actual: Vec<_> = (0..TURN)
        .map(|place| at(place, 7.3, 16.0 - 0.003))
        .collect();
    let mut points = SetPoints::new(Arc::clone(&solver), 1e-3);
    let mut contour = Contour::new();
    let (mut told, mut turn, mut apart) = (0_usize, Vec::new(), 0.0_f64);
    let mut listen = |point: &ContourPoint| {
        // The beginning and the end of the path are other places than those on it.
        match told {
            _ if !(TURN..=TURN * TURNS - 100).contains(&told) => {}
            _ if told < 2 * TURN => turn.push(point.distance),
            _ => apart = apart.max((point.distance - turn[told % TURN]).abs()),
        }
        told += 1;
    };
    for _ in 0..TURNS {
        points.joints.clone_from(&commanded);
        points.poses.clear();
        let poses = commanded
            .iter()
            .map(|joints| solver.chain().forward(joints));
        points.poses.extend(poses);
        points.at = vec![
            At {
                task: 0,
                line: 1,
                cuts: true
            };
            TURN
        ];
        contour.take(&points, &actual, &mut listen);
        points.clear();
    }
    let report = contour.finish(&mut listen);
    assert_eq!(told, TURN * TURNS);
    assert!(turn.iter().all(|distance| (distance - 0.003).abs() < 1e-7));
    assert!(apart < 1e-9, "{apart}");
    let half = report.cuts.percentile(0.5) / 0.003;
    assert!(
        (1.0 - 1e-4..1.0 + 1.0 / 16.0 + 1e-4).contains(&half),
        "{half}"
    );
    // Chords of so many set-points, by differences: v = 2·r·sin(π/N)/T at most.
    let speed = 2.0 * 16.0 * libm::sin(TAU / 2.0 / TURN as f64) / 1e-3;
    assert!((report.axes[0].velocity.value / speed - 1.0).abs() < 1e-5);
}
