//! The chain in words, and what kind of machine it is.

use nalgebra::Vector3;
use serde::Serialize;

use super::probe::named;
use super::{number, settings};
use crate::description::{Axis, Machine, Positions};
use crate::kinematics::Joint;
use crate::kinematics::orientation::angle;

/// Axes within this of a right angle count as standing square: degrees.
const SQUARE: f64 = 1.0;

/// Chain and class of a machine.
#[derive(Clone, Debug, Serialize)]
pub struct MachineClass {
    /// The chain as a sentence.
    pub chain: String,
    /// `five-axis, table-table: C on A, orthogonal`.
    pub name: String,
    /// Axes that turn the tool as seen from the part, in chain order; those of the table turn the part under it.
    pub turn_the_tool: Vec<String>,
    /// Axes that carry the part, from the part to the bed.
    pub carry_the_part: Vec<String>,
    /// Axes that carry the tool, from the bed to the tool.
    pub carry_the_tool: Vec<String>,
    /// Angles between neighbouring rotary axes, and between the last and the tool, degrees from 0 to 90.
    pub angles: Vec<PairMeasure>,
    /// Shortest distances between neighbouring rotary lines, and from the last to the gauge point, mm.
    pub distances: Vec<PairMeasure>,
    /// The axes in chain order.
    pub axes: Vec<AxisLine>,
}

/// A measure between two parts of the machine.
#[derive(Clone, Debug, Serialize)]
pub struct PairMeasure {
    /// The one.
    pub from: String,
    /// The other.
    pub to: String,
    /// mm or degrees.
    pub value: f64,
}

/// One axis, as the file describes it.
#[derive(Clone, Debug, Serialize)]
pub struct AxisLine {
    /// Address of the axis.
    pub name: String,
    /// It turns.
    pub rotary: bool,
    /// It carries the part.
    pub carries_part: bool,
    /// Direction, the way the tool moves seen from the part; `reversed` is in it.
    pub direction: [f64; 3],
    /// The direction in words.
    pub along: String,
    /// Least and largest reading, mm or degrees; none if it turns without end.
    pub travel: Option<[f64; 2]>,
    /// It is set between cuts: its reading at the start.
    pub indexed: Option<f64>,
    /// What of the check holds for an axis that is set between cuts, as a sentence.
    pub set_between_cuts: Option<String>,
    /// mm/min or deg/min; none if the file does not say.
    pub max_feed: Option<f64>,
}

impl MachineClass {
    /// What kind of machine it is.
    pub fn of(machine: &Machine) -> Self {
        let rotary: Vec<usize> =
            (0..machine.axes.len()).filter(|place| machine.axes[*place].joint.rotary).collect();
        let (angles, distances) = between(machine, &rotary);
        Self {
            chain: sentence(&machine.axes),
            name: name(machine, &rotary, &angles),
            turn_the_tool: names(&machine.axes, |axis| axis.joint.rotary),
            carry_the_part: names(&machine.axes, |axis| axis.carries_part),
            carry_the_tool: names(&machine.axes, |axis| !axis.carries_part),
            angles,
            distances,
            axes: (0..machine.axes.len()).map(|place| AxisLine::of(machine, place)).collect(),
        }
    }
}

impl AxisLine {
    fn of(machine: &Machine, place: usize) -> Self {
        let axis = &machine.axes[place];
        Self {
            name: axis.name.clone(),
            rotary: axis.joint.rotary,
            carries_part: axis.carries_part,
            direction: axis.joint.direction.into(),
            along: named(axis.joint.direction),
            travel: axis.travel.map(|travel| travel.map(|value| axis.reading(value))),
            indexed: axis.indexed.as_ref().map(|indexed| axis.reading(indexed.start)),
            set_between_cuts: set_between_cuts(machine, place),
            max_feed: Some(axis.max_feed / axis.unit()).filter(|feed| feed.is_finite()),
        }
    }
}

fn set_between_cuts(machine: &Machine, place: usize) -> Option<String> {
    let axis = &machine.axes[place];
    let indexed = axis.indexed.as_ref().filter(|_| axis.joint.rotary)?;
    let name = &axis.name;
    let at = number(axis.reading(indexed.start), 3);
    let chosen = machine.pointing().contains(&place);
    Some(match (chosen, indexed.positions != Positions::Any) {
        (true, false) => format!("{name} is set to what the tool axis of each cut asks for"),
        (true, true) => format!(
            "{name} is set to what the tool axis of each cut asks for, if that is one of its positions"
        ),
        (false, true) => {
            let positions = settings::positions(machine, place).len();
            let counted = match positions > settings::MOST {
                true => "some positions, spread over all",
                false => "every position",
            };
            format!("reach counts {counted} of {name}; what else follows holds with it at {at}°")
        }
        (false, false) => format!("what follows holds with {name} at {at}°"),
    })
}

fn names(axes: &[Axis], wanted: impl Fn(&Axis) -> bool) -> Vec<String> {
    let wanted = axes.iter().filter(|axis| wanted(axis));
    wanted.map(|axis| axis.name.clone()).collect()
}

/// `the part on C on A on the bed; the bed carries Y, X, Z, then the tool`.
fn sentence(axes: &[Axis]) -> String {
    let mut text = "the part".to_owned();
    for axis in axes.iter().filter(|axis| axis.carries_part) {
        text.push_str(&format!(" on {}", axis.name));
    }
    text.push_str(" on the bed; the bed carries ");
    for axis in axes.iter().filter(|axis| !axis.carries_part) {
        text.push_str(&format!("{}, ", axis.name));
    }
    text.push_str("the tool");
    text
}

fn name(machine: &Machine, rotary: &[usize], angles: &[PairMeasure]) -> String {
    let count = machine.axes.len();
    let number_word = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight"]
        .get(count)
        .copied()
        .unwrap_or("many");
    let axis = |place: &usize| &machine.axes[*place];
    let (free, held): (Vec<usize>, Vec<usize>) =
        rotary.iter().partition(|place| axis(place).indexed.is_none());
    let side = |place: &usize| {
        if axis(place).carries_part { "table" } else { "head" }
    };
    let mut text = format!("{number_word}-axis");
    match *free {
        [] => {}
        [one] => text.push_str(&format!(", rotary {} {}", side(&one), axis(&one).name)),
        [first, second] => {
            // A head is named before a table: head-table.
            let kind = match (side(&first), side(&second)) {
                ("table", "head") => "head-table".to_owned(),
                (one, other) => format!("{one}-{other}"),
            };
            let (a, b) = (&axis(&first).name, &axis(&second).name);
            text.push_str(&match (side(&first), side(&second)) {
                ("table", "table") => format!(", {kind}: {a} on {b}"),
                ("head", "head") => format!(", {kind}: {a} carries {b}"),
                _ => format!(", {kind}: head {b}, table {a}"),
            });
        }
        _ => {
            let each = free.iter().map(|place| format!("{} {}", side(place), axis(place).name));
            text.push_str(&format!(
                ", {} rotary axes {}: {}",
                free.len(),
                match machine.edge {
                    Some(_) => "follow tool axis and leading edge",
                    None => "at once",
                },
                each.collect::<Vec<_>>().join(", ")
            ));
        }
    }
    for place in &held {
        text.push_str(&format!("; {} {} is set between cuts", side(place), axis(place).name));
    }
    let linear = machine.axes.iter().filter(|axis| !axis.joint.rotary).count();
    if linear > 3 {
        let seconds = names(&machine.axes, |axis| axis.second.is_some());
        text.push_str(&format!("; {linear} linear axes"));
        if !seconds.is_empty() {
            text.push_str(&format!(" ({} beside another)", seconds.join(", ")));
        }
    }
    // Of more axes that is nobody's name.
    if (2..=3).contains(&free.len()) {
        let free_names: Vec<&String> = free.iter().map(|place| &axis(place).name).collect();
        let known: Vec<&PairMeasure> = angles
            .iter()
            .filter(|angle| {
                let known = |name: &String| name == "tool" || free_names.contains(&name);
                // A blade axis lies along the tool.
                let blade = machine.edge.is_some() && angle.value.abs() < SQUARE;
                known(&angle.from) && known(&angle.to) && !blade
            })
            .collect();
        let told = |which: &dyn Fn(f64) -> bool, text: &dyn Fn(&PairMeasure) -> String| {
            let angles = known.iter().filter(|angle| which(angle.value));
            angles.map(|angle| text(angle)).collect::<Vec<String>>().join(", ")
        };
        let parallel = |angle: f64| angle.abs() < SQUARE;
        let askew = |angle: f64| !parallel(angle) && (angle - 90.0).abs() > SQUARE;
        let askew = told(&askew, &|angle| {
            format!("{}° between {} and {}", number(angle.value, 3), angle.from, angle.to)
        });
        let parallel = told(&parallel, &|angle| format!("{} and {}", angle.from, angle.to));
        match (askew.as_str(), parallel.as_str()) {
            ("", "") => text.push_str("; orthogonal"),
            ("", parallel) => text.push_str(&format!("; parallel are {parallel}")),
            (askew, _) => text.push_str(&format!("; nutating, {askew}")),
        }
    }
    text
}

/// Angles and distances from each rotary axis to the next, and from the last to the tool.
fn between(machine: &Machine, rotary: &[usize]) -> (Vec<PairMeasure>, Vec<PairMeasure>) {
    let (mut angles, mut distances) = (Vec::new(), Vec::new());
    let acute = |a: Vector3<f64>, b: Vector3<f64>| {
        let degrees = angle(a, b).to_degrees();
        degrees.min(180.0 - degrees)
    };
    for pair in rotary.windows(2) {
        let [from, to] = [pair[0], pair[1]].map(|place| &machine.axes[place]);
        let measure = |value| PairMeasure { from: from.name.clone(), to: to.name.clone(), value };
        angles.push(measure(acute(from.joint.direction, to.joint.direction)));
        distances.push(measure(line_distance(&from.joint, &to.joint)));
    }
    if let Some(last) = rotary.last() {
        let axis = &machine.axes[*last];
        angles.push(PairMeasure {
            from: axis.name.clone(),
            to: "tool".to_owned(),
            value: acute(axis.joint.direction, machine.tool_axis),
        });
        let arm = machine.gauge - axis.joint.point;
        distances.push(PairMeasure {
            from: axis.name.clone(),
            to: "gauge point".to_owned(),
            value: axis.joint.direction.cross(&arm).norm(),
        });
    }
    (angles, distances)
}

/// Shortest distance of two lines, mm.
fn line_distance(a: &Joint, b: &Joint) -> f64 {
    let across = a.direction.cross(&b.direction);
    let arm = b.point - a.point;
    if across.norm() < 1e-9 {
        return a.direction.cross(&arm).norm();
    }
    libm::fabs(arm.dot(&across)) / across.norm()
}
