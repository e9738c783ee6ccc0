//! What a program uses of the travel of the axes: columns for each axis, and the least that is left.

use post_machine::axis_words;
use post_machine::description::Machine;
use post_posting::report::Report;

use super::outcome::Outcome;

/// Columns of an axis: its least and largest value, and which share of its travel lies between them.
pub fn columns(name: &str, rotary: bool) -> [String; 3] {
    let unit = if rotary { "deg" } else { "mm" };
    [
        format!("{name}_least_{unit}"),
        format!("{name}_largest_{unit}"),
        format!("{name}_travel_share"),
    ]
}

/// The axes of a machine and of its heads: names, and whether they turn.
pub fn axes(machine: &Machine) -> Vec<(String, bool)> {
    let heads = machine.heads.iter().map(|head| &head.machine);
    let mut axes: Vec<(String, bool)> = Vec::new();
    for machine in std::iter::once(machine).chain(heads) {
        for place in axis_words::order(machine) {
            let axis = &machine.axes[place];
            if axes.iter().all(|(known, _)| *known != axis.name) {
                axes.push((axis.name.clone(), axis.joint.rotary));
            }
        }
    }
    axes
}

/// Tells of each axis what is used, and what is least left to an end.
pub fn tell(machine: &Machine, report: &Report, outcome: &mut Outcome) {
    let mut nearest: [Option<(f64, &str)>; 2] = [None, None];
    for used in &report.axes {
        let Some((_, axis)) = machine.with_axis(&used.name) else {
            continue;
        };
        let rotary = axis.joint.rotary;
        let [least, largest, share] = columns(&used.name, rotary);
        outcome.number(least, used.min);
        outcome.number(largest, used.max);
        let Some([from, to]) = used.travel else {
            continue;
        };
        outcome.number(share, (used.max - used.min) / (to - from));
        let left = (used.min - from).min(to - used.max);
        let nearest = &mut nearest[usize::from(rotary)];
        if left.is_finite() && nearest.is_none_or(|(known, _)| left < known) {
            *nearest = Some((left, &used.name));
        }
    }
    for (nearest, unit) in nearest.into_iter().zip(["mm", "deg"]) {
        if let Some((left, axis)) = nearest {
            outcome.number(format!("travel_left_{unit}"), left);
            outcome.text(&format!("travel_left_{unit}_axis"), axis);
        }
    }
}
