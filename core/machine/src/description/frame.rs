//! Where the axes go between the passes: out of the part, to a tool change, at the end.

use toml::Spanned;

use super::build::Builder;
use super::choice::FARTHEST;
use super::file::{ControlFile, Positions as Said};
use super::keys::axes_are;
use super::{Axis, Machine};
use crate::axis_words::is_depth;
use crate::diagnostic::Short;
use crate::kinematics::travel::passed;

/// More rotary axes between bed and tool are those of an arm.
const MOST_SWIVELS: usize = 3;

/// The positions of a machine around a program's moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Where the depth axes stand when the tool is retracted: place in the chain and value, mm.
    pub retract: Vec<(usize, f64)>,
    /// Where other linear axes go then, once it is: mm.
    pub aside: Vec<(usize, f64)>,
    /// The machine file says so, and answers for it; else it is the end of travel away from the part.
    pub retract_said: bool,
    /// Where axes stand before a tool change, the tool retracted: mm or radians.
    pub change: Vec<(usize, f64)>,
    /// Where axes stand at the program's end and where the CL file sends the tool home: mm or radians.
    pub park: Vec<(usize, f64)>,
}

impl Machine {
    /// A head is retracted and parked by the axes of the machine that carries it, as far as they go with it.
    pub(super) fn keep_frame_of(&mut self, carrier: &Machine) {
        self.frame = carrier.frame.clone();
        for (place, value) in &mut self.frame.retract {
            let axis = self.axes.get(*place);
            if let Some([least, most]) = axis.and_then(|axis| axis.travel) {
                *value = value.clamp(least, most);
            }
        }
    }

    /// Where the rotary axes stand for a tool change: as they do at the end (`park`), and those that swivel the tool at 0
    /// where they can, as the changer finds the spindle.
    fn usual_change(&self, park: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let rotary = park.iter().filter(|(at, _)| self.axes[*at].joint.rotary);
        let mut change: Vec<(usize, f64)> = rotary.copied().collect();
        let swivels = |axis: &Axis| axis.joint.rotary && !axis.carries_part;
        // The joints of an arm stand where the machine file says.
        if self.axes.iter().filter(|axis| swivels(axis)).count() > MOST_SWIVELS {
            return change;
        }
        for (place, axis) in self.axes.iter().enumerate() {
            let zero = -axis.zero;
            let there = passed(axis.travel, zero, 0.0).is_none() && stands(axis, zero);
            if swivels(axis) && there && !change.iter().any(|(at, _)| *at == place) {
                change.push((place, zero));
            }
        }
        change
    }

    /// The end of travel of each depth axis on the side of the holder: there the tool is as far from the part as these
    /// axes bring it. A quill that stands between cuts stays, unless there is no other.
    fn depth_ends(&self) -> Vec<(usize, f64)> {
        let ends = |stands: bool| -> Vec<(usize, f64)> {
            let axes = self.axes.iter().enumerate();
            axes.filter(|(place, axis)| is_depth(self, *place) && axis.indexed.is_some() == stands)
                .filter_map(|(place, axis)| {
                    let [least, most] = axis.travel?;
                    let away = axis.joint.direction.dot(&self.tool_axis) > 0.0;
                    Some((place, if away { most } else { least }))
                })
                .collect()
        };
        let free = ends(false);
        if free.is_empty() { ends(true) } else { free }
    }
}

impl Builder<'_> {
    /// Takes the positions of `[control]` into a machine whose axes are known.
    pub(super) fn frame(&mut self, said: &ControlFile, machine: &mut Machine) {
        let retract = self.positions(&said.retract, machine);
        for (place, _) in &retract {
            if machine.axes[*place].joint.rotary {
                let name = &machine.axes[*place].name;
                let span = said.retract.keys().find(|key| key.get_ref() == name);
                self.fault(
                    "machine-frame",
                    span.map_or(0..0, Spanned::span),
                    format!("retract turns {name}: the tool leaves the part by its linear axes"),
                    "rotary axes stand where park or change says",
                );
            }
        }
        let park = self.positions(&said.park, machine);
        let change = match &said.change {
            None => machine.usual_change(&park),
            Some(change) => self.positions(change, machine),
        };
        // The depth comes first, all of it: what the file does not say of it goes to the end of travel.
        let said_of = |place: usize| {
            let mut said = retract.iter();
            said.find(|(joint, _)| *joint == place).copied()
        };
        let ends = machine.depth_ends().into_iter();
        let depth = ends.map(|end| said_of(end.0).unwrap_or(end)).collect();
        let aside = retract.iter().copied();
        let aside = aside.filter(|(place, _)| !is_depth(machine, *place));
        machine.frame = Frame {
            retract_said: !retract.is_empty(),
            aside: aside.collect(),
            retract: depth,
            change,
            park,
        };
    }

    fn positions(&mut self, said: &Said, machine: &Machine) -> Vec<(usize, f64)> {
        let mut positions = Vec::new();
        for (name, value) in said {
            let known = machine
                .axes
                .iter()
                .position(|axis| axis.name == *name.get_ref());
            let Some(place) = known else {
                self.fault(
                    "machine-frame",
                    name.span(),
                    format!("the machine has no axis {}", name.get_ref()),
                    &axes_are(&machine.axes),
                );
                continue;
            };
            let axis = &machine.axes[place];
            let shown = self.number(value);
            let position = shown * axis.unit() - axis.zero;
            if let (Some([least, most]), true) =
                (axis.travel, passed(axis.travel, position, 0.0).is_some())
            {
                self.fault(
                    "machine-travel",
                    value.span(),
                    format!(
                        "{} cannot stand at {}: its travel is {} to {}",
                        axis.name,
                        Short(shown),
                        Short(axis.reading(least)),
                        Short(axis.reading(most))
                    ),
                    "positions of [control] are in machine coordinates, as the control shows them",
                );
            }
            if axis.travel.is_none() && libm::fabs(position) > FARTHEST {
                self.fault(
                    "machine-travel",
                    value.span(),
                    format!("{} cannot stand at {}", axis.name, Short(shown)),
                    "an endless axis stands within ten thousand turns of zero",
                );
            }
            if !stands(axis, position) {
                self.fault(
                    "machine-travel",
                    value.span(),
                    format!(
                        "{} cannot stand at {}: it is none of its positions",
                        axis.name,
                        Short(shown)
                    ),
                    "",
                );
            }
            positions.push((place, position));
        }
        positions
    }
}

/// An indexed axis stands at its positions alone.
fn stands(axis: &Axis, position: f64) -> bool {
    let indexed = axis.indexed.as_ref();
    indexed.is_none_or(|indexed| indexed.positions.holds(position, axis.travel.is_none()))
}
