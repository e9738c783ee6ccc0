use std::f64::consts::TAU;

use post_machine::kinematics::{Joints, MAX_AXES};
use post_testkit::{Rng, seeded};

use post_motion::measured::{Alignment, AlignmentFault, AxisTrack, DifferenceSum, align};

/// Zeros are found.
const FOUND: [Option<f64>; MAX_AXES] = [None; MAX_AXES];

/// A path that goes to and fro in X, steps on in Y, turns C now and then, and stands still for a while; s, mm, radians.
fn path(time: f64) -> Joints {
    let time = time.clamp(0.0, 20.0);
    // It stands from 9 to 11.
    let time = if time < 9.0 { time } else { f64::max(time - 2.0, 9.0) };
    let mut joints = Joints::default();
    joints[0] = 40.0 * libm::sin(TAU * time / 2.5);
    joints[1] = 3.0 * time + libm::sin(TAU * time / 1.25);
    joints[4] = 0.4 * libm::sin(TAU * time / 7.0) * libm::sin(TAU * time / 2.5);
    joints
}

fn track(begins: f64, period: f64, seconds: f64, of: impl FnMut(f64) -> Joints) -> AxisTrack {
    let count = (seconds / period).round() as usize + 1;
    let times = (0..count).map(|place| begins + place as f64 * period);
    AxisTrack { begins, period, joints: times.map(of).collect() }
}

const AXES: [usize; 5] = [0, 1, 2, 3, 4];

/// A log of `path` whose clock is `shift` ahead, from `from` of the path on.
fn log(shift: f64, from: f64, period: f64, seconds: f64, noise: f64) -> AxisTrack {
    let mut even = Rng::new(7);
    track(from + shift, period, seconds, |time| {
        let mut joints = path(time - shift);
        joints[0] += 250.0 + noise * even.range(-1.0, 1.0);
        joints[1] += -3.5 + noise * even.range(-1.0, 1.0);
        joints[4] += 1.25 * TAU + noise / 50.0 * even.range(-1.0, 1.0);
        joints
    })
}

fn check(found: &Alignment, shift: f64, within: f64, zeros_within: f64) {
    assert!((found.shift - shift).abs() < within, "{} is not {shift}: {found:?}", found.shift);
    let zeros = [(0, 250.0), (1, -3.5), (4, 1.25 * TAU)];
    for (axis, zero) in zeros {
        assert!((found.zeros[axis] - zero).abs() < zeros_within, "axis {axis}: {found:?}");
    }
    assert_eq!(found.zeros[2], 0.0);
}

#[test]
fn a_shift_is_found_between_the_samples() {
    let predicted = track(0.0, 0.001, 20.0, path);
    for (shift, period) in
        [(0.0, 0.001), (12.345_678, 0.001), (-3.210_04, 0.004), (1_000.007_3, 0.015)]
    {
        let log = log(shift, 0.0, period, 20.0, 0.0);
        let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
        check(&found, shift, 1e-7, 1e-6);
        assert!(found.correlation > 0.999_999 && found.rival.is_none(), "{found:?}");
    }
}

#[test]
fn noise_moves_it_as_far_as_is_told() {
    let predicted = track(0.0, 0.001, 20.0, path);
    let log = log(5.004_3, 0.0, 0.015, 20.0, 0.05);
    let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
    check(&found, 5.004_3, 4.0 * found.shift_deviation, 0.005);
    // Half of even noise of ±0.05 is within ±0.025; of 1334 samples that is known to 0.001 (standard deviation).
    assert!((found.left[0] - 1.4826 * 0.05 / 2.0).abs() < 4e-3, "{found:?}");
    // X swings at 100 mm/s, so a sample says when it is to 0.3 ms, and 1300 of them to 10 µs.
    assert!(found.shift_deviation > 1e-6 && found.shift_deviation < 2e-5, "{found:?}");
}

#[test]
fn what_is_early_here_and_late_there_moves_no_zero() {
    let predicted = track(0.0, 0.001, 20.0, path);
    // 0.3 s slower from the 14th second on: the path stands where it would in 5.7 s.
    let log = track(2.0, 0.001, 20.0, |time| {
        let time = time - 2.0;
        path(if time < 14.0 { time } else { 14.0 + (time - 14.0) * 0.95 })
    });
    let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
    assert_eq!(found.zeros, Joints::default(), "{found:?}");
    assert!((found.shift - 2.0).abs() < 0.1, "{found:?}");
}

#[test]
fn a_coarse_prediction_and_a_fine_log() {
    let predicted = track(0.0, 0.015, 20.0, path);
    let log = log(0.4567, 0.0, 0.001, 20.0, 0.0);
    let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
    check(&found, 0.4567, 1e-5, 1e-3);
}

#[test]
fn a_log_that_waits_before_and_behind() {
    let predicted = track(0.0, 0.002, 20.0, path);
    let log = log(30.001, -30.0, 0.002, 100.0, 0.001);
    let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
    check(&found, 30.001, 1e-5, 1e-4);
    let [from, to] = found.overlap;
    assert!((from - 30.001).abs() < 0.003 && (to - 50.001).abs() < 0.003, "{found:?}");
}

#[test]
fn a_log_of_a_part_of_the_program() {
    let predicted = track(0.0, 0.002, 20.0, path);
    let log = log(-7.0, 4.0, 0.002, 6.0, 0.001);
    let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
    check(&found, -7.0, 1e-4, 1e-2);
}

#[test]
fn what_swings_alone_has_rivals() {
    let swing = |time: f64| {
        let mut joints = Joints::default();
        joints[0] = 40.0 * libm::sin(TAU * time);
        joints
    };
    let predicted = track(0.0, 0.001, 30.0, swing);
    let log = track(0.25, 0.001, 30.0, |time| swing(time - 0.25));
    let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
    assert!(found.rival.is_some(), "{found:?}");
}

#[test]
fn what_cannot_be_laid_over_is_refused() {
    let predicted = track(0.0, 0.001, 20.0, path);
    let still = track(0.0, 0.001, 20.0, |_| Joints::default());
    assert_eq!(align(&predicted, &still, &AXES, &FOUND), Err(AlignmentFault::Still));
    let short = track(0.0, 0.001, 0.003, path);
    assert_eq!(align(&predicted, &short, &AXES, &FOUND), Err(AlignmentFault::Short(8)));
    let other = track(0.0, 0.001, 20.0, |time| {
        let mut joints = Joints::default();
        joints[0] = libm::sin(97.0 * time * time);
        joints
    });
    let found = align(&predicted, &other, &AXES, &FOUND);
    assert!(
        matches!(&found, Err(AlignmentFault::Unlike(best)) if best.correlation < 0.5),
        "{found:?}"
    );
}

#[test]
fn samples_that_come_late_are_put_on_a_grid() {
    let mut even = Rng::new(3);
    let times: Vec<f64> = (0..1000)
        .map(|place| 0.1 + 0.015 * f64::from(place) + 0.004 * even.range(-1.0, 1.0))
        .collect();
    let joints: Vec<Joints> = times.iter().map(|time| path(*time)).collect();
    let track = AxisTrack::of_samples(&times, &joints, 0.015);
    for (place, joints) in track.joints.iter().enumerate().take(580) {
        let wanted = path(track.time(place));
        // The fourth derivative of X is 40 (2π/2.5)⁴ mm/s⁴; over steps of 23 ms a cubic is off by some µm at most.
        assert!((joints[0] - wanted[0]).abs() < 0.02, "{place}");
    }
    let exact: Vec<f64> = (0..1000).map(|place| 0.015 * f64::from(place)).collect();
    assert_eq!(AxisTrack::of_samples(&exact, &joints, 0.015).joints[..], joints[..]);
}

#[test]
fn a_track_is_a_cubic_between_its_samples() {
    let cubic = |time: f64| {
        let mut joints = Joints::default();
        joints[0] = 2.0 - time + 3.0 * time * time;
        joints
    };
    let track = track(-1.0, 0.25, 3.0, cubic);
    for step in 0..100 {
        let time = -0.75 + 0.025 * f64::from(step);
        let (values, rates) = track.at_with_rate(time).unwrap();
        assert!((values[0] - cubic(time)[0]).abs() < 1e-12, "{time}");
        assert!((rates[0] - (6.0 * time - 1.0)).abs() < 1e-12, "{time}");
    }
    assert!(track.at(-1.001).is_none() && track.at(2.001).is_none());
    assert!(track.at(2.0).is_some());
}

/// Trapezoids of velocity whose corners lie anywhere between samples: the cubic is about as far off as is told, and closer
/// than straight lines.
#[test]
fn what_lies_between_samples_is_told() {
    let (period, acceleration) = (0.01, 2000.0);
    let trapezoid = |time: f64| {
        let [rises, falls, stands] =
            [0.1003, 0.4007, 0.501].map(|begins: f64| (time - begins).max(0.0));
        let mut joints = Joints::default();
        joints[0] = acceleration / 2.0 * (time.max(0.0) * time.max(0.0) - rises * rises);
        joints[0] -= acceleration / 2.0 * (falls * falls - stands * stands);
        joints
    };
    let track = track(-0.2, period, 1.0, trapezoid);
    let [mut cubic, mut straight] = [0.0_f64; 2];
    for place in 1..track.joints.len() {
        assert_eq!(track.towards(place, 8).count(), 8);
        for (step, joints) in track.towards(place, 8).enumerate() {
            let share = (step + 1) as f64 / 8.0;
            let exact = trapezoid(track.time(place - 1) + share * period)[0];
            cubic = cubic.max((joints[0] - exact).abs());
            let [left, right] = [place - 1, place].map(|place| track.joints[place][0]);
            straight = straight.max((left + share * (right - left) - exact).abs());
        }
    }
    assert!(track.towards(0, 3).all(|joints| joints == track.joints[0]));
    let told = track.between()[0].most.abs();
    let unit = acceleration * period * period;
    assert!((0.124..0.126).contains(&(straight / unit)), "{straight}");
    assert!((0.035..0.042).contains(&(cubic / unit)), "{cubic}");
    assert!((0.8..1.4).contains(&(cubic / told)), "{cubic} {told}");
    assert_eq!(track.between()[1].most, 0.0);
}

#[test]
fn differences_are_summed_up() {
    let mut difference = DifferenceSum::default();
    assert_eq!((difference.mean(), difference.rms()), (0.0, 0.0));
    for (time, value) in [(1.0, 1.0), (2.0, -7.0), (3.0, 3.0)] {
        difference.take(time, value);
    }
    assert_eq!((difference.most, difference.most_at), (-7.0, 2.0));
    assert_eq!(difference.mean(), -1.0);
    assert!((difference.rms() - (59.0_f64 / 3.0).sqrt()).abs() < 1e-15);
}

/// A machine that starts from another place than the prediction, is held for a while, and has noise: only what fits says
/// how they lie over one another.
#[test]
fn rows_that_are_elsewhere_move_nothing() {
    let approach = |time: f64| 300.0 * (1.0 - time / 2.0).max(0.0);
    let predicted = track(0.0, 0.001, 22.0, |time| {
        let mut joints = path((time - 2.0).max(0.0));
        joints[2] = approach(time) + 2.0 * libm::sin(TAU * time / 5.0).max(0.0);
        joints
    });
    let mut even = Rng::new(11);
    // The log begins a second before the cut, Z stands there already, and for a second somebody has the cover open.
    let log = track(4.0, 0.004, 19.0, |time| {
        let time = time - 5.0;
        let mut joints = path(time.max(0.0));
        joints[2] = 70.0 + 2.0 * libm::sin(TAU * (time + 2.0) / 5.0).max(0.0);
        if (12.0..13.0).contains(&time) {
            joints[0] += 8.0;
        }
        for axis in [0, 1, 2] {
            joints[axis] += 0.002 * even.range(-1.0, 1.0);
        }
        joints
    });
    let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
    assert!((found.shift - 3.0).abs() < 2e-4, "{found:?}");
    assert!((found.zeros[2] - 70.0).abs() < 2e-3, "{found:?}");
    assert_eq!(found.zeros[0], 0.0, "{found:?}");
    // A second of the approach, and one of the cover.
    let seconds = found.far_off * (found.overlap[1] - found.overlap[0]);
    assert!((1.5..2.6).contains(&seconds), "{seconds} {found:?}");
}

/// Random motions, some of which come again and again, at random shifts: the shift is found to a fraction of the period, or
/// another one is named, and then one of the two is right.
#[test]
fn random_shifts_are_found_or_said_to_be_one_of_several() {
    let mut even = seeded(2026);
    let mut rivals = 0;
    for round in 0..30 {
        let mut between = |from: f64, to: f64| even.range(from, to);
        let cycles = between(0.3, 12.0);
        let seconds = between(4.0, 16.0);
        // Every third is periodic, but for a part that is small against the noise or not.
        let drift = match round % 3 {
            0 => libm::exp10(between(-4.0, 0.0)),
            _ => between(1.0, 20.0),
        };
        let parts: [[f64; 3]; 4] = std::array::from_fn(|part| {
            [between(2.0, 30.0), (part + 1) as f64 * TAU * cycles / seconds, between(0.0, TAU)]
        });
        let other = [between(1.0, 9.0), between(1.0, 9.0)];
        let motion = |time: f64| {
            let time = time.clamp(0.0, seconds);
            let mut joints = Joints::default();
            for [size, rate, phase] in parts {
                joints[0] += size * libm::sin(rate * time + phase);
                joints[1] += 0.5 * size * libm::cos(rate * time + 2.0 * phase);
            }
            joints[1] += drift * libm::sin(other[0] * time / seconds * TAU);
            joints[2] = drift * libm::cos(other[1] * time / seconds);
            joints
        };
        let periods = [0.001, 0.002, 0.004, 0.008];
        let period = periods[(between(0.0, 3.999)) as usize];
        let shift = between(-1000.0, 1000.0);
        let zeros = [between(-300.0, 300.0), between(-300.0, 300.0)];
        let noise = libm::exp10(between(-4.0, -2.0));
        let lead = between(0.0, 0.2 * seconds);
        let predicted = track(0.0, 0.001, seconds, motion);
        let mut errors = Rng::new(even.next());
        let log = track(shift - lead, period, seconds + lead, |time| {
            let mut joints = motion(time - shift);
            joints[0] += zeros[0];
            joints[1] += zeros[1];
            for joint in &mut joints[..3] {
                *joint += noise * errors.range(-1.0, 1.0);
            }
            joints
        });
        let found = align(&predicted, &log, &AXES, &FOUND).unwrap();
        let right = |told: f64| (told - shift).abs() < 0.25 * period;
        rivals += usize::from(found.rival.is_some());
        assert!(
            right(found.shift) || found.rival.is_some(),
            "{round}: {shift} {noise} {drift} {found:?}"
        );
    }
    assert!(rivals < 12, "{rivals}");
}
