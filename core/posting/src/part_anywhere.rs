//! Travel of a mill without rotary axes whose part sits where nobody says: any place within the travel will do, so that the
//! way of the whole program is held against it, not each point.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use crate::configuration::{LengthSource, ReportedTool};
use crate::report::AxisRange;

/// Ways that are longer than the travel by less are none, mm.
const ROUNDED: f64 = 1e-6;

/// What is said of the travel at the end of a run, where the part may sit anywhere; nothing if there is nothing to say.
pub(crate) fn judge(
    machine: &Machine,
    axes: &[AxisRange],
    tools: &[ReportedTool],
) -> Option<Diagnostic> {
    if !machine.is_opened() {
        return None;
    }
    if let Some(axis) = axes.iter().find(|axis| is_longer(axis)) {
        return Some(too_long(axis));
    }
    let unknown = tools.iter().filter(|tool| tool.source == LengthSource::Unknown);
    let unknown: Vec<String> = unknown
        .map(|tool| tool.number.map_or("the tool".to_owned(), |number| format!("tool {number}")))
        .collect();
    let outside: Vec<String> = axes.iter().filter_map(|axis| outside(machine, axis)).collect();
    let help = "--mount says where the part sits, --tool-length or a file of tools (--tools) how long tools are: travel is checked by that";
    match (outside.as_slice(), unknown.as_slice()) {
        ([], []) => None,
        ([], unknown) => {
            let tools = unknown.join(", ");
            let message = format!("no length of {tools} is known: travel was checked with 0 mm");
            Some(Diagnostic::warning("tool-length", message).help(help))
        }
        (outside, unknown) => {
            let lengths = match unknown {
                [] => String::new(),
                unknown => format!(", nor how long {} is", unknown.join(", ")),
            };
            let message = format!(
                "nobody says where the part sits{lengths}; this much travel the program needs: {}",
                outside.join("; ")
            );
            Some(Diagnostic::warning("part-place", message).help(help))
        }
    }
}

fn is_longer(axis: &AxisRange) -> bool {
    axis.travel.is_some_and(|[least, most]| axis.max - axis.min > most - least + ROUNDED)
}

/// The program goes farther than the axis, wherever the part sits.
fn too_long(axis: &AxisRange) -> Diagnostic {
    let [least, most] = axis.travel.unwrap_or_default();
    let message = format!(
        "{} goes {:.3} mm, from {:.3} to {:.3} mm, and its travel is {:.3} mm: the part fits nowhere on this machine",
        axis.name,
        axis.max - axis.min,
        axis.min,
        axis.max,
        most - least
    );
    Diagnostic::error("over-travel", message)
        .help("another machine, or two set-ups; --units if the file's units are wrong")
}

/// How far an axis goes past its travel, and where the part origin must sit instead; none if it stays inside.
fn outside(machine: &Machine, axis: &AxisRange) -> Option<String> {
    let [least, most] = axis.travel?;
    if axis.min >= least && axis.max <= most {
        return None;
    }
    let joint = machine.axes.iter().find(|other| other.name == axis.name)?.joint;
    // The way of the axis along which the part origin moves with it.
    let along = (0..3).find(|part| libm::fabs(joint.direction[*part]) > 1.0 - 1e-9)?;
    let [mount, sense] = [machine.mount[along], joint.direction[along]];
    let ends = [least - axis.min, most - axis.max].map(|by| mount + sense * by);
    let [first, last] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    Some(format!(
        "{} {:.3} to {:.3} mm of {least:.3} to {most:.3} with the part origin at {mount:.3}, inside with it from {first:.3} to {last:.3}",
        axis.name, axis.min, axis.max
    ))
}
