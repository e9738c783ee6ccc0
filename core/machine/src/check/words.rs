//! What words that are no axis values do when an axis moves.

use serde::Serialize;

use super::number;
use super::probe::Probe;
use crate::kinematics::Joints;

/// Way of an axis in the table, mm or degrees.
const WAY: f64 = 10.0;

/// An axis moved by itself, and the words that change with it.
#[derive(Clone, Debug, Serialize)]
pub struct WordReport {
    /// Address of the axis.
    pub axis: String,
    /// Change of its value, mm or degrees.
    pub by: f64,
    /// The words that change, and by how much: `J2 +10, J3 -10`.
    pub words: String,
}

/// The axes of which words are more than their values; none where each word is its axis.
pub(super) fn told(probe: &Probe<'_>) -> Vec<WordReport> {
    let machine = probe.machine();
    let Some(map) = &machine.word_map else {
        return Vec::new();
    };
    let axes = 0..machine.axes.len();
    let moved = axes.filter(|joint| map.moved_by(*joint).any(|place| !map.is_plain(place)));
    let report = |joint: usize| {
        let mut values = Joints::default();
        values[joint] = WAY;
        let words = map.words(&values);
        let told: Vec<String> = (0..machine.axes.len())
            .filter(|place| words[*place] != 0.0)
            .map(|place| {
                let sign = if words[place] > 0.0 { "+" } else { "" };
                format!("{} {sign}{}", machine.axes[place].name, number(words[place], 5))
            })
            .collect();
        WordReport { axis: machine.axes[joint].name.clone(), by: WAY, words: told.join(", ") }
    };
    moved.map(report).collect()
}
