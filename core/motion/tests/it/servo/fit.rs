//! Numbers of servos from synthetic logs, whose true numbers are known.

use libm::{cos, sin, sqrt};
use post_machine::servo::{Feedback, Servo};
use post_motion::servo::fit::{ServoFit, ServoLog, fit};
use post_motion::servo::{Follower, ServoOutput};
use post_testkit::Rng;

use super::{direct_loops, feedrate_paper, gear_loops, of_loops, screw_loops, with_friction};

const PERIOD: f64 = 1e-3;

/// Names of numbers, and the factors by which they are wrong at the beginning.
type Wrong<'a> = &'a [(&'a str, f64)];

/// Accelerated hard and often.
fn lively() -> Vec<f64> {
    let angle = |k: i32| f64::from(k) * PERIOD;
    let way = |time: f64| 8.0 * (1.0 - cos(9.0 * time)) + 1.5 * sin(47.0 * time) * sin(5.0 * time);
    (0..1500).map(|k| way(angle(k))).collect()
}

/// At one speed from beginning to end.
fn even() -> Vec<f64> {
    (0..1500).map(|k| 0.05 * f64::from(k)).collect()
}

/// What a log of the servo has, with errors of the standard deviation `spread`, each of which keeps the share `kept` of the
/// one before.
fn measured_with(servo: &Servo, commanded: &[f64], spread: f64, kept: f64, seed: u64) -> Vec<f64> {
    let mut noise = Rng::new(seed);
    let mut error = spread * noise.normal();
    let mut follower = Follower::with(servo, PERIOD, ServoOutput::Measured).unwrap();
    follower.settle(commanded[0]);
    let values = commanded.iter().map(|value| follower.next(*value));
    values
        .map(|value| {
            error = kept * error + spread * sqrt(1.0 - kept * kept) * noise.normal();
            value + error
        })
        .collect()
}

/// With errors that are independent.
fn measured(servo: &Servo, commanded: &[f64], spread: f64, seed: u64) -> Vec<f64> {
    measured_with(servo, commanded, spread, 0.0, seed)
}

/// Fits `names`, from values that are wrong by these factors.
fn fitted(
    truth: &Servo,
    wrong: Wrong<'_>,
    commanded: &[f64],
    measured: &[f64],
    lead: usize,
) -> ServoFit {
    let mut start = truth.clone();
    for (name, factor) in wrong {
        *start.parameter(name).unwrap() *= factor;
    }
    let names: Vec<&str> = wrong.iter().map(|(name, _)| *name).collect();
    let log = ServoLog { period: PERIOD, steps: 1, commanded, measured, lead };
    fit(&start, &names, log).unwrap()
}

fn truth_of(servo: &Servo, name: &str) -> f64 {
    *servo.clone().parameter(name).unwrap()
}

/// Without noise the true numbers come back, whatever the kind of servo.
#[test]
fn the_true_numbers_come_back() {
    let screw = of_loops(screw_loops(Feedback::Scale, [0.9, 0.5]));
    let gear = of_loops(gear_loops(Feedback::Motor, [0.8, 0.0]));
    let direct = of_loops(direct_loops([0.7, 0.6]));
    let rubbing = with_friction(screw.clone(), 250.0, 2.0);
    let cases: [(&Servo, Wrong<'_>); 5] = [
        (
            &screw,
            &[
                ("kv", 0.7),
                ("velocity_feed_forward", 0.9),
                ("acceleration_feed_forward", 1.5),
                ("table_mass", 1.3),
            ],
        ),
        (&gear, &[("kv", 1.4), ("velocity_gain", 0.6)]),
        (&direct, &[("load", 2.0), ("velocity_time", 0.7)]),
        (&rubbing, &[("coulomb", 0.4), ("kv", 1.1)]),
        (&feedrate_paper(), &[("kp", 1.2), ("ki", 0.5), ("damping", 2.0)]),
    ];
    let commanded = lively();
    for (servo, wrong) in cases {
        let measured = measured(servo, &commanded, 0.0, 1);
        let fit = fitted(servo, wrong, &commanded, &measured, 0);
        assert!(fit.converged && fit.undetermined.is_empty(), "{fit:?}");
        assert!(fit.after < 1e-4 * fit.before, "{fit:?}");
        for number in &fit.fitted {
            let truth = truth_of(servo, number.name);
            assert!((number.value / truth - 1.0).abs() < 1e-3, "{number:?} {truth}");
            assert!(number.determined && number.before != number.value);
            assert_eq!(*fit.servo.clone().parameter(number.name).unwrap(), number.value);
        }
    }
}

/// With noise the numbers are off by as much as is said: of 40 logs with 3 numbers each, the errors over the deviations that
/// are stated are like those of a normal distribution. So they are where the errors hang together over some 20 samples,
/// and the deviations are larger by the root of that.
#[test]
fn deviations_are_as_stated() {
    let truth = of_loops(screw_loops(Feedback::Scale, [0.9, 0.0]));
    let wrong = [("kv", 0.8), ("velocity_feed_forward", 1.05), ("table_mass", 1.2)];
    let commanded = lively();
    let spread = 2e-3;
    let mut mean_deviations = Vec::new();
    for kept in [0.0, 0.9] {
        let mut scores = Vec::new();
        let mut deviations = 0.0;
        for seed in 1..=40 {
            let measured = measured_with(&truth, &commanded, spread, kept, seed);
            let fit = fitted(&truth, &wrong, &commanded, &measured, 0);
            assert!((fit.after / spread - 1.0).abs() < 0.35, "{}", fit.after);
            for number in &fit.fitted {
                assert!(number.determined, "{number:?}");
                scores.push((number.value - truth_of(&truth, number.name)) / number.deviation);
            }
            deviations += fit.fitted[0].deviation / 40.0;
        }
        let count = scores.len() as f64;
        let mean_square = scores.iter().map(|score| score * score).sum::<f64>() / count;
        let beyond = |limit: f64| scores.iter().filter(|score| score.abs() > limit).count();
        // Of 120, 38 are expected beyond one deviation and 0.3 beyond three.
        assert!((0.5..1.6).contains(&mean_square), "{kept}: {mean_square}");
        assert!(beyond(3.0) <= 3 && beyond(1.0) > 15, "{kept}: {scores:?}");
        mean_deviations.push(deviations);
    }
    // (1 + 0.9)/(1 - 0.9) = 19.
    let wider = mean_deviations[1] / mean_deviations[0];
    assert!((3.0..5.5).contains(&wider), "{wider}");
}

/// At one speed nothing is accelerated: of the mass the log says nothing, and it stays where it was. Of the lag it says one
/// number only, for two that make it: (1 - kv)/Kv.
#[test]
fn what_the_log_does_not_determine_is_said() {
    let truth = of_loops(screw_loops(Feedback::Scale, [0.6, 0.0]));
    let commanded = even();
    let noisy = measured(&truth, &commanded, 1e-3, 7);
    let fit = fitted(&truth, &[("kv", 0.8), ("table_mass", 1.3)], &commanded, &noisy, 800);
    let [kv, mass] = fit.fitted.as_slice() else { panic!("{fit:?}") };
    assert!(kv.determined && (kv.value - 50.0).abs() < 4.0 * kv.deviation, "{kv:?}");
    assert!(!mass.determined && mass.deviation > mass.value, "{mass:?}");
    assert!((mass.value / mass.before - 1.0).abs() < 0.02, "{mass:?}");
    let [direction] = fit.undetermined.as_slice() else { panic!("{fit:?}") };
    assert_eq!(direction.shares.len(), 1);
    assert_eq!(direction.shares[0].0, "table_mass");

    let wrong = [("kv", 0.8), ("velocity_feed_forward", 1.1)];
    let fit = fitted(&truth, &wrong, &commanded, &noisy, 800);
    assert!(fit.fitted.iter().all(|number| !number.determined), "{fit:?}");
    assert!(fit.fitted[0].correlated.unwrap().1.abs() > 0.99, "{fit:?}");
    let [direction] = fit.undetermined.as_slice() else { panic!("{fit:?}") };
    assert_eq!(direction.shares.len(), 2);
    // Kv·e^s with (1 - k - δ)/(Kv·e^s) the same: δ = -(1 - k)·s.
    let share = |name: &str| direction.shares.iter().find(|(own, _)| *own == name).unwrap().1;
    let k = fit.fitted[1].value;
    let ratio = share("velocity_feed_forward") / share("kv");
    assert!((ratio + (1.0 - k)).abs() < 0.01, "{ratio} {k}");
    // What the log does determine is right all the same.
    let lag = (1.0 - k) / fit.fitted[0].value;
    assert!((lag / (0.4 / 50.0) - 1.0).abs() < 0.01, "{lag}");

    // The same numbers in a log with accelerations are determined.
    let commanded = lively();
    let noisy = measured(&truth, &commanded, 1e-3, 7);
    let fit = fitted(&truth, &wrong, &commanded, &noisy, 0);
    assert!(fit.fitted.iter().all(|number| number.determined), "{fit:?}");
}

/// A log that begins in the middle of a move.
#[test]
fn a_log_that_begins_in_motion_needs_a_lead() {
    let truth = of_loops(screw_loops(Feedback::Scale, [0.9, 0.0]));
    let commanded = lively();
    let whole = measured(&truth, &commanded, 0.0, 1);
    let (commanded, measured) = (&commanded[300..], &whole[300..]);
    let error = |lead: usize| {
        let fit = fitted(&truth, &[("kv", 0.9)], commanded, measured, lead);
        (fit.fitted[0].value / 50.0 - 1.0).abs()
    };
    assert!(error(500) < 1e-5, "{}", error(500));
    assert!(error(0) > 1e-3, "{}", error(0));
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let servo = of_loops(screw_loops(Feedback::Scale, [0.9, 0.0]));
    let commanded = lively();
    let log =
        ServoLog { period: PERIOD, steps: 1, commanded: &commanded, measured: &commanded, lead: 0 };
    let said = |names: &[&str], log: ServoLog<'_>| {
        let fault = fit(&servo, names, log).unwrap_err();
        format!("{} | {}", fault.message, fault.help.unwrap_or_default())
    };
    assert!(said(&["kw"], log).contains("did you mean `kv`"));
    assert!(said(&["backlash"], log).contains("backlash is zero"));
    assert!(said(&["kv", "kv"], log).contains("twice"));
    let short = ServoLog { lead: 1495, ..log };
    assert!(said(&["kv"], short).contains("5 of them compared"));
    let uneven = ServoLog { measured: &commanded[1..], ..log };
    assert!(said(&["kv"], uneven).contains("1499 measured"));
    assert!(said(&[], log).contains("nothing to fit"));
    let mut holed = commanded.clone();
    holed[700] = f64::NAN;
    let holed = ServoLog { measured: &holed, ..log };
    assert!(said(&["kv"], holed).contains("no number"));
}
