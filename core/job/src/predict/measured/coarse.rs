//! Rows of a log that are further apart than set-points of the control: what was commanded between them is not recorded.

use post_machine::axis_words;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::MAX_AXES;
use post_motion::measured::DifferenceSum;

use super::log::{Log, LoggedPosition};
use crate::text::number;

/// So many set-points are put between two rows at most.
const MOST_STEPS: f64 = 64.0;

/// What is not known of commands is worth a word from here on, mm and degrees.
const MATTERS: f64 = 1e-3;

/// Set-points of the control from one row of the log to the next, at least 1. Those between rows are taken to lie on a
/// cubic.
pub(super) fn steps(machine: &Machine, log: &Log) -> usize {
    let rows = log.clock.period / machine.motion.period;
    libm::rint(rows).clamp(1.0, MOST_STEPS) as usize
}

/// About how far commanded positions between rows lie beside the cubic, mm and radians, by axis; none if there are no
/// set-points between rows, or no commanded positions.
pub(super) fn between(machine: &Machine, log: &Log) -> Option<[DifferenceSum; MAX_AXES]> {
    let known = steps(machine, log) == 1 || log.commanded.joints.is_empty();
    (!known).then(|| log.commanded.between())
}

/// Says so where it matters; `between` as [`between`] gives it.
pub(super) fn doubt(
    machine: &Machine,
    log: &Log,
    between: &[DifferenceSum; MAX_AXES],
    findings: &mut Vec<Diagnostic>,
) {
    let mut axes = Vec::new();
    for place in axis_words::order(machine) {
        let axis = &machine.axes[place];
        let most = between[place].most.abs() / axis.unit();
        if log.has[LoggedPosition::Commanded as usize][place] && most > MATTERS {
            let most = number(most, 4);
            axes.push(format!("{} {most} {}", axis.name, axis.unit_name()));
        }
    }
    if axes.is_empty() {
        return;
    }
    let milliseconds = |seconds: f64| number(seconds * 1e3, 2);
    let message = format!(
        "rows of {} are {} ms apart, set-points of the control {} ms: commands between rows are taken along a cubic, which is beside them by up to about {}",
        log.name,
        milliseconds(log.clock.period),
        milliseconds(machine.motion.period),
        axes.join(", ")
    );
    let help = "record every set-point; predicted following errors are no better known than that, and standard errors of --fit are too small where that is not little against what is left";
    findings.push(Diagnostic::warning("log", message).help(help));
}
