//! The published five-axis path of two B-splines.

use post_feed::jerk::{self, Law};
use post_feed::limits::{AxisAcceleration, AxisJerk, AxisVelocity, ChordError, Collocation, Limit};
use post_feed::{EndSpeeds, Problem, linear_program, profile, reach};

use crate::support::paths::{Dual, dual, even};

/// The path's limits of velocity and acceleration.
fn drives(path: &Dual, collocation: Collocation) -> (AxisVelocity, AxisAcceleration) {
    let velocity = AxisVelocity { limits: path.velocity.clone(), collocation };
    let acceleration = AxisAcceleration { limits: path.acceleration.clone(), collocation };
    (velocity, acceleration)
}

/// TOPP-RA's 7.13 s at 2,001 points, which is what velocity and acceleration alone allow.
#[test]
fn velocity_and_acceleration_alone_give_the_published_lower_bound() {
    let Some(path) = dual() else { return };
    let samples = path.samples(&even(0.0, 1.0, 2001));
    let length: f64 = (0..samples.intervals())
        .map(|interval| {
            0.5 * samples.step(interval)
                * (samples.stretch(interval) + samples.stretch(interval + 1))
        })
        .sum();
    assert!((length - 98.1682).abs() < 1e-3, "{length}");
    for collocation in [Collocation::Start, Collocation::Ends, Collocation::Throughout] {
        let (velocity, acceleration) = drives(&path, collocation);
        let problem =
            Problem::new(&samples, &[&velocity, &acceleration], EndSpeeds::default()).unwrap();
        let plan = reach::solve(&problem).unwrap();
        let seconds = profile::duration(&problem.steps, &plan);
        let best = linear_program::solve(&problem, &samples.squared_feed_weights()).unwrap();
        let by_program = profile::duration(&problem.steps, &best.q);
        println!(
            "{collocation:?}: {seconds:.4} s, linear program {by_program:.4} s in {} iterations",
            best.iterations
        );
        assert!((seconds / 7.13 - 1.0).abs() < 0.005, "{collocation:?}: {seconds}");
        assert!(problem.worst(&plan).share < 1.0 + 1e-11);
    }
}

/// The largest share of each limit that a plan uses at `each` points of every interval, by the path's own derivatives:
/// velocity, acceleration, jerk of the axes.
fn used(path: &Dual, parameters: &[f64], law: &Law, each: usize) -> [f64; 3] {
    let mut most = [0.0_f64; 3];
    for (interval, piece) in law.pieces.iter().enumerate() {
        for point in 0..=each {
            // Not at rest itself, where the parameter's third derivative is a product of 0 and infinity.
            let share = (point as f64 / each as f64).clamp(1e-6, 1.0 - 1e-6);
            let [q, slope, bend] = piece.at(share, law.steps[interval]);
            let at = parameters[interval] + share * law.steps[interval];
            for (axis, jet) in path.axes(at).into_iter().enumerate() {
                let [_, first, second, third] = jet.derivatives();
                let velocity = first * q.sqrt();
                let acceleration = 0.5 * first * slope + second * q;
                let jerk = q.sqrt() * (0.5 * first * bend + 1.5 * second * slope + third * q);
                most[0] = most[0].max(velocity.abs() / path.velocity[axis]);
                most[1] = most[1].max(acceleration.abs() / path.acceleration[axis]);
                most[2] = most[2].max(jerk.abs() / path.jerk[axis]);
            }
        }
    }
    most
}

/// With the published jerk limits, and with the published chord error, beside the published times.
#[test]
fn with_jerk_limits_no_limit_is_broken_between_samples_and_published_times_are_beaten() {
    let Some(path) = dual() else { return };
    let collocation = Collocation::Throughout;
    let (velocity, acceleration) = drives(&path, collocation);
    let jerk = AxisJerk { limits: path.jerk.clone() };
    let chord = ChordError { tolerance: 0.000_125, period: 0.002, collocation };
    let mut seconds = Vec::new();
    for (count, chord) in [(501, None), (2001, None), (2001, Some(chord))] {
        let parameters = even(0.0, 1.0, count);
        let samples = path.samples(&parameters);
        let mut limits: Vec<&dyn Limit> = vec![&velocity, &acceleration, &jerk];
        limits.extend(chord.as_ref().map(|chord| chord as &dyn Limit));
        let problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
        let begin = std::time::Instant::now();
        let plan = jerk::solve(&samples, &limits, &problem, jerk::JerkSettings::default()).unwrap();
        let used = used(&path, &parameters, &plan.law, 8);
        println!(
            "{count} samples, chord {}: {:.4} s, without jerk {:.4} s; {} rounds, {} iterations, {:?}; used {used:?}",
            chord.is_some(),
            plan.seconds,
            plan.bound,
            plan.rounds,
            plan.iterations,
            begin.elapsed()
        );
        assert!(used.iter().all(|&share| share < 1.0 + 1e-3), "{used:?}");
        assert!(plan.seconds > plan.bound);
        seconds.push(plan.seconds);
    }
}
