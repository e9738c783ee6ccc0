//! What words that are no axis values do when an axis moves.

use serde::Serialize;

use super::number;
use super::probe::Probe;
use crate::description::Axis;
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

/// An axis goes across the line of the work spindle of a lathe if its way beyond that line is less than this share of the
/// way up to it.
const BEYOND: f64 = 0.3;

/// Cosine of the largest angle between lines that count as parallel.
const ALONG: f64 = 1.0 - 1e-3;

/// That the word of X is a radius, on a machine that has the looks of a lathe: a rotary axis along Z alone carries the part, and
/// X goes from its line to one side, or stands on the slide of Z.
pub(super) fn radius(probe: &Probe<'_>) -> Option<String> {
    let machine = probe.machine();
    let mut carriers = machine.axes.iter().filter(|axis| axis.carries_part);
    let (Some(spindle), None) = (carriers.next(), carriers.next()) else {
        return None;
    };
    let place = machine.axes.iter().position(|axis| axis.name == "X" && !axis.joint.rotary)?;
    let axis: &Axis = &machine.axes[place];
    let line = spindle.joint.direction;
    let turns_the_part = spindle.joint.rotary && libm::fabs(line.z) > ALONG;
    let across = libm::fabs(line.dot(&axis.joint.direction)) < 1.0 - ALONG;
    let plain = machine.word_map.as_ref().is_none_or(|map| map.is_plain(place));
    if !(turns_the_part && across && plain) {
        return None;
    }
    let arm = probe.chain().forward(probe.home()).tip + probe.chain().mount() - spindle.joint.point;
    let at_line = probe.home()[place] - arm.dot(&axis.joint.direction);
    let [least, most] = axis.travel?;
    let (short, long) =
        ((at_line - least).min(most - at_line), (at_line - least).max(most - at_line));
    // Mills have X under Z.
    let z = machine.axes.iter().position(|axis| axis.name == "Z" && !axis.joint.rotary);
    (short < BEYOND * long || z.is_some_and(|z| z < place)).then(|| {
        let name = &spindle.name;
        format!("words are radii, from the line of {name}; for a control that reads diameters say [word.X] is = \"2 * X\"")
    })
}
