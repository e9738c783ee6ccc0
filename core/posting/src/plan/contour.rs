//! The contour error that the servos of a machine make of a path, as a limit of the planner.

use post_feed::limits::{Collocation, ContourError};
use post_feed::response::{Answer, Response};
use post_machine::description::Machine;
use post_machine::servo;

/// No formula of the steady state is asked beyond this, rad/s: a machine whose servos follow faster has no such limit.
const FASTEST: f64 = 1e4;

/// A contour error of `tolerance` mm by the servos of `machine`, its axes by place in the chain; one without a servo is
/// where it is commanded. None where the machine describes no servo.
pub(super) fn contour_error(
    machine: &Machine,
    tolerance: f64,
    collocation: Collocation,
) -> Option<ContourError> {
    let servos = servo::Response::of_machine(machine);
    let highest =
        servos.iter().flatten().map(servo::Response::natural_frequency).reduce(f64::min)?;
    let answers: Vec<_> = servos
        .iter()
        .map(|servo| move |frequency: f64| answer(servo.as_ref(), frequency))
        .collect();
    let axes: Vec<&dyn Response> = answers.iter().map(|axis| axis as &dyn Response).collect();
    Some(ContourError::new(&axes, tolerance, highest.min(FASTEST), collocation))
}

fn answer(servo: Option<&servo::Response>, frequency: f64) -> Answer {
    servo.map_or(Answer::EXACT, |servo| {
        let answer = servo.at(frequency);
        Answer { real: answer.re, imaginary: answer.im }
    })
}
