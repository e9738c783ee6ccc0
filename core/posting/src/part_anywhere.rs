//! Travel of a mill without rotary axes whose part sits where nobody says: any place within the travel will do, so that the
//! way of the whole program is held against it, not each point.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::part_anywhere::{AxisWay, HELP, needed};

use crate::configuration::{LengthSource, ReportedTool};
use crate::report::AxisRange;

/// What is said of the travel at the end of a run, where the part may sit anywhere; nothing if there is nothing to say.
/// `too_long` says that it fits nowhere.
pub(crate) fn judge(
    machine: &Machine,
    axes: &[AxisRange],
    tools: &[ReportedTool],
    too_long: impl FnOnce(&AxisWay<'_>) -> Diagnostic,
) -> Option<Diagnostic> {
    if !machine.is_opened() {
        return None;
    }
    let ways = axes.iter().map(|axis| AxisWay {
        name: &axis.name,
        ends: [axis.min, axis.max],
        travel: axis.travel,
    });
    if let Some(way) = ways.clone().find(AxisWay::is_too_long) {
        return Some(too_long(&way));
    }
    let unknown = tools.iter().filter(|tool| tool.source == LengthSource::Unknown);
    let unknown: Vec<String> = unknown
        .map(|tool| tool.number.map_or("the tool".to_owned(), |number| format!("tool {number}")))
        .collect();
    let outside: Vec<String> = ways.filter_map(|way| way.outside(machine)).collect();
    match (outside.as_slice(), unknown.as_slice()) {
        ([], []) => None,
        ([], unknown) => {
            let tools = unknown.join(", ");
            let message = format!("no length of {tools} is known: travel was checked with 0 mm");
            Some(Diagnostic::warning("tool-length", message).help(HELP))
        }
        (outside, unknown) => {
            let lengths = match unknown {
                [] => String::new(),
                unknown => format!(", nor how long {} is", unknown.join(", ")),
            };
            Some(needed(outside, &lengths))
        }
    }
}
