//! Waits, stops and tool changes of both programs: which of them have no counterpart.

use serde::Serialize;

use super::steps::StepEvent;
use crate::ProgramEvent;

/// A wait, a stop or a tool change.
#[derive(Clone, Debug, Serialize)]
pub struct EventDifference {
    /// In the old program, and in the new one.
    pub events: [Option<String>; 2],
    /// Their lines, 0 for none.
    pub lines: [u64; 2],
}

/// Events without a counterpart: the longest run of pairs in order is taken out. Which tool comes in a change counts if
/// `numbered` says so.
pub(super) fn events(
    old: &[StepEvent],
    new: &[StepEvent],
    slack: f64,
    numbered: bool,
) -> Vec<EventDifference> {
    let alike = |one: &StepEvent, other: &StepEvent| {
        let [tools, changes] =
            [one, other].map(|one| matches!(one.event, ProgramEvent::ToolChange { .. }));
        let same = named(one) == named(other) || (!numbered && tools && changes);
        same && (tools || (one.at - other.at).norm() <= slack)
    };
    // Few stand in one operation; of more than this the first are looked at.
    let (old, new) = (&old[..old.len().min(1000)], &new[..new.len().min(1000)]);
    let columns = new.len() + 1;
    let mut common = vec![0_u32; (old.len() + 1) * columns];
    for row in (0..old.len()).rev() {
        for column in (0..new.len()).rev() {
            common[row * columns + column] = match alike(&old[row], &new[column]) {
                true => common[(row + 1) * columns + column + 1] + 1,
                false => {
                    common[(row + 1) * columns + column].max(common[row * columns + column + 1])
                }
            };
        }
    }
    let (mut row, mut column) = (0, 0);
    let mut found: Vec<EventDifference> = Vec::new();
    // Those without a counterpart since the last pair: what takes the place of one another stands side by side.
    let mut open: [Vec<&StepEvent>; 2] = [Vec::new(), Vec::new()];
    loop {
        let both = row < old.len() && column < new.len();
        let pair = both && alike(&old[row], &new[column]);
        let over = row == old.len() && column == new.len();
        if pair || over {
            let [left_out, added] = std::mem::take(&mut open);
            for place in 0..left_out.len().max(added.len()) {
                let events = [left_out.get(place), added.get(place)];
                found.push(EventDifference {
                    events: events.map(|event| event.map(|event| named(event))),
                    lines: events.map(|event| event.map_or(0, |event| event.line)),
                });
            }
            if over {
                return found;
            }
            (row, column) = (row + 1, column + 1);
            continue;
        }
        let [below, beside] = [(row + 1) * columns + column, row * columns + column + 1];
        if column == new.len() || row < old.len() && common[below] >= common[beside] {
            open[0].push(&old[row]);
            row += 1;
        } else {
            open[1].push(&new[column]);
            column += 1;
        }
    }
}

/// An event in words.
fn named(event: &StepEvent) -> String {
    match &event.event {
        ProgramEvent::Dwell { time, revolutions: true } => format!("a wait of {time} turns"),
        ProgramEvent::Dwell { time, .. } => format!("a wait of {time} s"),
        ProgramEvent::Stop => "a stop".to_owned(),
        ProgramEvent::OptionalStop => "an optional stop".to_owned(),
        ProgramEvent::Sync(mark) => format!("a wait for other channels at {mark}"),
        ProgramEvent::ToolChange { number, name } => {
            let number = number.map(|number| number.to_string());
            let tool = number.or_else(|| name.clone()).unwrap_or_default();
            format!("tool {tool}")
        }
        _ => String::new(),
    }
}
