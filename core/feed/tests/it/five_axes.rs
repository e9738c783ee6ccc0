//! The published five-axis path of two B-splines.

use post_feed::limits::{AxisAcceleration, AxisVelocity, Collocation};
use post_feed::{Ends, Problem, linear_program, profile, reach};

use crate::support::paths::{dual, even};

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
    for collocation in [
        Collocation::Start,
        Collocation::Ends,
        Collocation::Throughout,
    ] {
        let velocity = AxisVelocity {
            limits: path.velocity.clone(),
            collocation,
        };
        let acceleration = AxisAcceleration {
            limits: path.acceleration.clone(),
            collocation,
        };
        let problem = Problem::new(&samples, &[&velocity, &acceleration], Ends::default()).unwrap();
        let plan = reach::solve(&problem).unwrap();
        let seconds = profile::duration(&problem.steps, &plan);
        let best = linear_program::solve(&problem, &samples.squared_feed_weights()).unwrap();
        let by_program = profile::duration(&problem.steps, &best.q);
        println!(
            "{collocation:?}: {seconds:.4} s, linear program {by_program:.4} s in {} iterations",
            best.iterations
        );
        assert!(
            (seconds / 7.13 - 1.0).abs() < 0.005,
            "{collocation:?}: {seconds}"
        );
        assert!(problem.worst(&plan).share < 1.0 + 1e-11);
    }
}
