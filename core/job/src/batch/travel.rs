//! What a program uses of the travel of the axes: columns for each axis, and the least that is left.

use post_machine::description::Machine;
use post_posting::report::PostingReport;

use super::outcome::JobOutcome;

/// Columns of an axis: its least and largest value, and which share of its travel lies between them.
pub fn columns(name: &str, rotary: bool) -> [String; 3] {
    let unit = if rotary { "deg" } else { "mm" };
    [
        format!("{name}_least_{unit}"),
        format!("{name}_largest_{unit}"),
        format!("{name}_travel_share"),
    ]
}

/// What is least left of travel to an end.
pub struct TravelLeft<'a> {
    /// mm or degrees.
    pub least: f64,
    /// The axis that has it.
    pub axis: &'a str,
}

/// Tells of each axis what is used; what is least left of a slide, and of a table.
pub fn tell<'a>(
    machine: &Machine,
    report: &'a PostingReport,
    outcome: &mut JobOutcome,
) -> [Option<TravelLeft<'a>>; 2] {
    let mut nearest: [Option<TravelLeft<'_>>; 2] = [None, None];
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
        if left.is_finite() && nearest.as_ref().is_none_or(|known| left < known.least) {
            *nearest = Some(TravelLeft { least: left, axis: &used.name });
        }
    }
    nearest
}
