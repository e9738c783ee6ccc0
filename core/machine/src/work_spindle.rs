//! The work spindle of a lathe: the part turns about its line, from which a lathe's CL file counts.

use nalgebra::Vector3;

use crate::axis_words::is_diameter;
use crate::description::{Axis, Machine};
use crate::diagnostic::Diagnostic;

/// A part origin is on the line within so much, mm.
const ON_THE_LINE: f64 = 1e-3;

/// Cosine of the largest angle between lines that count as parallel.
const ALONG: f64 = 1.0 - 1e-3;

/// The work spindle of a lathe: the one axis that carries the part turns it about Z without end, and there are no more than two
/// slides, or the words of X are diameters.
fn of(machine: &Machine) -> Option<&Axis> {
    let mut carriers = machine.axes.iter().filter(|axis| axis.carries_part);
    let (Some(spindle), None) = (carriers.next(), carriers.next()) else {
        return None;
    };
    let joint = &spindle.joint;
    let turns = joint.rotary && spindle.travel.is_none() && spindle.indexed.is_none();
    let along = libm::fabs(joint.direction.z) > ALONG;
    let slides = machine.axes.iter().filter(|axis| !axis.joint.rotary).count();
    let lathe = slides <= 2 || (0..machine.axes.len()).any(|place| is_diameter(machine, place));
    (turns && along && lathe).then_some(spindle)
}

/// The part turns in a work spindle, beside which the machine has another for its tools.
pub fn turns_part(machine: &Machine) -> bool {
    of(machine).is_some()
}

/// A warning that the part origin sits beside the line of the work spindle.
pub fn beside(machine: &Machine) -> Option<Diagnostic> {
    let spindle = of(machine)?;
    let arm = machine.mount - spindle.joint.point;
    let across = arm - spindle.joint.direction * arm.dot(&spindle.joint.direction);
    let by = across.norm();
    if by <= ON_THE_LINE {
        return None;
    }
    let message = format!(
        "the part origin sits {by:.3} mm beside the line of {}, about which the part turns: a lathe's files count from that line",
        spindle.name
    );
    let [x, y, z]: [f64; 3] = Vector3::from(machine.mount - across).into();
    let tidy = |value: f64| libm::rint(value * 1e6) / 1e6 + 0.0;
    let help = format!(
        "--mount {},{},{} puts it there; a part that is clamped beside it is posted as it sits",
        tidy(x),
        tidy(y),
        tidy(z)
    );
    Some(Diagnostic::warning("part-place", message).help(help))
}
