//! How a log lies over a prediction, and what is said where it does not, or hardly.

use std::borrow::Cow;

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, MAX_AXES};
use post_motion::measured::{Alignment, AlignmentFault, AxisTrack, align};

use super::columns::{Columns, LogContent};
use super::log::LoggedPosition;
use super::overlay::{MOVES, Overlay};
use super::units::UNITS;
use crate::failure::Failure;
use crate::text::number;

/// An axis of a log is doubtful if it is less alike.
const DOUBTFUL: f64 = 0.9;

/// Rows that are far off are worth a word if there are more, as a share.
const MANY: f64 = 0.02;

/// A ratio is that of two units if it is this close, as a share.
const SAME_RATIO: f64 = 0.03;

/// By what was commanded, where the log has it, else by where an axis was.
pub(super) fn aligned(overlay: &Overlay, machine: &Machine) -> Result<Alignment, Failure> {
    let log = &overlay.log;
    let commanded = log.axes(LoggedPosition::Commanded);
    let actual = log.axes(LoggedPosition::Actual).into_iter();
    let only_actual: Vec<usize> = actual.filter(|axis| !commanded.contains(axis)).collect();
    let axes = [&commanded[..], &only_actual].concat();
    let predicted = match commanded.is_empty() {
        false => mixed(&overlay.commanded, &overlay.actual, &only_actual),
        true => Cow::Borrowed(&overlay.actual),
    };
    let logged = mixed(&log.commanded, &log.actual, &only_actual);
    let zeros = overlay.zeros();
    align(&predicted, &logged, &axes, zeros).map_err(|why| {
        let message = match &why {
            AlignmentFault::Short(fewest) => {
                format!("program and log need {fewest} set-points to be laid over one another")
            }
            AlignmentFault::Still => {
                "no axis moves both in the program and in the log, so that it is not known when the program began"
                    .to_owned()
            }
            AlignmentFault::Unlike(best) => format!(
                "the log does not look like this program: at best they are alike by {} (1 is the same), {}; {} % of the rows are elsewhere",
                number(best.correlation, 2),
                by_axis(best, machine, 1.1),
                number(100.0 * best.far_off, 0),
            ),
        };
        let help = match &why {
            AlignmentFault::Unlike(best) => {
                let ranges = [&predicted, &logged].map(|track| ranges(track));
                units(machine, &log.columns, ranges)
                    .or_else(|| reversed(best, machine))
                    .unwrap_or_else(|| HELP.to_owned())
            }
            _ => HELP.to_owned(),
        };
        Diagnostic::error("log", message).help(help).into()
    })
}

const HELP: &str = "is it of this program, with these --tool-length, --mount and --offsets? --columns and --log-units say which column holds which axis in which unit";

/// What makes an alignment doubtful.
pub(super) fn doubts(alignment: &Alignment, machine: &Machine, findings: &mut Vec<Diagnostic>) {
    let mut doubt = |message: String, help: &str| {
        findings.push(Diagnostic::warning("log", message).help(help));
    };
    if let Some(rival) = alignment.rival {
        let message = format!(
            "the log fits at two times: its clock is {} s ahead of the program's, or {} s, which leaves hardly more",
            number(alignment.shift, 3),
            number(rival, 3)
        );
        let help = "the path is much the same there; record it from the beginning of the program to its end";
        doubt(message, help);
    }
    let unlike = alignment.alike.iter().flatten();
    if unlike.clone().any(|alike| *alike < DOUBTFUL) {
        let message = format!(
            "log and prediction hardly look alike in some axes: {} (1 is the same)",
            by_axis(alignment, machine, DOUBTFUL)
        );
        let help = reversed(alignment, machine).unwrap_or_else(|| {
            "was tool centre point control on, and are --tool-length, --mount and --offsets as they were on the machine?".to_owned()
        });
        doubt(message, &help);
    }
    if alignment.far_off > MANY {
        let message = format!(
            "in {} % of the rows an axis is far from where it is predicted; they say nothing of clock and zeros, but are compared",
            number(100.0 * alignment.far_off, 1)
        );
        let help = "an approach from another place, a stop by the operator or another override do this; the picture measured.svg shows where";
        doubt(message, help);
    }
}

/// `X 0.99, C -0.98`: the axes that are less alike than `below`.
fn by_axis(alignment: &Alignment, machine: &Machine, below: f64) -> String {
    let axes = machine.axes.iter().zip(&alignment.alike);
    let axes = axes.filter_map(|(axis, alike)| {
        let alike = (*alike)?;
        (alike < below).then(|| format!("{} {}", axis.name, number(alike, 2)))
    });
    axes.collect::<Vec<String>>().join(", ")
}

/// An axis that counts the other way.
fn reversed(alignment: &Alignment, machine: &Machine) -> Option<String> {
    let mut axes = machine.axes.iter().zip(&alignment.alike);
    let (axis, _) = axes.find(|(_, alike)| alike.is_some_and(|alike| alike < -DOUBTFUL))?;
    Some(format!(
        "the log counts {0} the other way: `reversed` of [axis.{0}] in the machine file",
        axis.name
    ))
}

/// The ranges in which the axes move.
fn ranges(track: &AxisTrack) -> Joints {
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; MAX_AXES];
    for joints in &track.joints {
        for (ends, value) in ends.iter_mut().zip(joints) {
            *ends = [ends[0].min(*value), ends[1].max(*value)];
        }
    }
    ends.map(|[low, high]| high - low)
}

/// The unit by which the ranges of an axis would be the same.
fn units(machine: &Machine, columns: &Columns, [wanted, logged]: [Joints; 2]) -> Option<String> {
    columns.read.iter().find_map(|column| {
        let (LogContent::Commanded(place) | LogContent::Actual(place)) = column.content else {
            return None;
        };
        let ratio = wanted[place] / logged[place];
        let unit = UNITS.iter().find(|unit| {
            unit.kind == column.unit.kind
                && unit.name != column.unit.name
                && (ratio / (unit.size / column.unit.size) - 1.0).abs() < SAME_RATIO
        })?;
        let axis = &machine.axes[place];
        Some(format!(
            "{0} goes over {1} {3} in the log and over {2} in the program, as if the log counted in {4}: --log-units {4}",
            axis.name,
            number(logged[place] / axis.unit(), 4),
            number(wanted[place] / axis.unit(), 4),
            axis.unit_name(),
            unit.name
        ))
    })
}

/// The commanded positions, and of some axes the actual ones.
fn mixed<'t>(
    commanded: &'t AxisTrack,
    actual: &'t AxisTrack,
    only_actual: &[usize],
) -> Cow<'t, AxisTrack> {
    if only_actual.is_empty() {
        return Cow::Borrowed(commanded);
    }
    if commanded.joints.is_empty() {
        return Cow::Borrowed(actual);
    }
    let mut mixed = commanded.clone();
    for (joints, actual) in mixed.joints.iter_mut().zip(&actual.joints) {
        for axis in only_actual {
            joints[*axis] = actual[*axis];
        }
    }
    Cow::Owned(mixed)
}

/// From the first motion of these axes to the last, s; none if they never move, or if a track that is not known to be
/// `whole` has no rest at its beginning and at its end.
pub(super) fn moving(track: &AxisTrack, axes: &[usize], whole: bool) -> Option<f64> {
    let moves = |pair: &[Joints]| {
        let mut axes = axes.iter();
        axes.any(|axis| (pair[1][*axis] - pair[0][*axis]).abs() > MOVES)
    };
    let first = track.joints.windows(2).position(moves)?;
    let last = track.joints.windows(2).rposition(moves)? + 1;
    let rests = first > 0 && last + 1 < track.joints.len();
    (whole || rests).then(|| (last - first) as f64 * track.period)
}
