//! The contour error that the servos of a machine make of a path, as a limit of the planner.

use post_feed::limits::{Collocation, ContourError};
use post_feed::response::{ComplexGain, DriveResponse};
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
    let servos = servo::FrequencyResponse::of_machine(machine);
    let highest = servos
        .iter()
        .flatten()
        .map(servo::FrequencyResponse::natural_frequency)
        .reduce(f64::min)?;
    let answers: Vec<_> = servos
        .iter()
        .map(|servo| move |frequency: f64| answer(servo.as_ref(), frequency))
        .collect();
    let axes: Vec<&dyn DriveResponse> =
        answers.iter().map(|axis| axis as &dyn DriveResponse).collect();
    Some(ContourError::new(&axes, tolerance, highest.min(FASTEST), collocation))
}

fn answer(servo: Option<&servo::FrequencyResponse>, frequency: f64) -> ComplexGain {
    servo.map_or(ComplexGain::EXACT, |servo| {
        let answer = servo.at(frequency);
        ComplexGain { real: answer.re, imaginary: answer.im }
    })
}
