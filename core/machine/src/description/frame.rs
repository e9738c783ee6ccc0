//! Where the axes go between the passes: out of the part, to a tool change, at the end.

use std::collections::BTreeMap;

use toml::Spanned;

use super::build::Builder;
use super::choice::FARTHEST;
use super::file::{AxisPositions as Said, ControlFile, LeaveAlong, LeaveFile};
use super::keys::axes_are;
use super::quantity::{KeyedNumber, Number};
use super::{Axis, Machine};
use crate::axis_words::is_depth;
use crate::diagnostic::Short;
use crate::kinematics::travel::passed;

/// More rotary axes between bed and tool are those of an arm.
const MOST_SWIVELS: usize = 3;

/// Distance that linear axes keep from the ends of their travel over a first position, if the file does not say, mm.
const ROOM: f64 = 50.0;

/// The positions of a machine around a program's moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Where the depth axes stand when the tool is retracted: place in the chain and value, mm.
    pub retract: Vec<(usize, f64)>,
    /// Where other axes go then, once it is: mm or radians.
    pub aside: Vec<(usize, f64)>,
    /// How far the tool goes back along its own axis before that, whenever it leaves the part, mm; then `retract` and `aside`
    /// go one after the other, whichever axes they are. None: what leads away is the depth axis.
    pub leave: Option<f64>,
    /// The machine file says so, and answers for it; else it is the end of travel away from the part.
    pub retract_said: bool,
    /// Distance that linear axes keep from the ends of their travel over a first position, mm.
    pub room: f64,
    /// Where axes stand before a tool change, the tool retracted: mm or radians.
    pub change: Vec<(usize, f64)>,
    /// Where axes stand at the program's end and where the CL file sends the tool home: mm or radians.
    pub park: Vec<(usize, f64)>,
}

impl Default for Frame {
    fn default() -> Self {
        Self {
            retract: Vec::new(),
            aside: Vec::new(),
            leave: None,
            retract_said: false,
            room: ROOM,
            change: Vec::new(),
            park: Vec::new(),
        }
    }
}

impl Machine {
    /// A head is retracted and parked by the axes of the machine that carries it, as far as they go with it.
    pub(super) fn keep_frame_of(&mut self, carrier: &Machine) {
        self.frame = carrier.frame.clone();
        let frame = &mut self.frame;
        for (place, value) in frame.retract.iter_mut().chain(&mut frame.aside) {
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
        let said_retract = said.retract.iter().flatten();
        let retract: Vec<(usize, f64)> = said_retract
            .filter_map(|(name, value)| self.position(name, value, false, machine))
            .collect();
        for (place, _) in &retract {
            if machine.axes[*place].joint.rotary {
                let name = &machine.axes[*place].name;
                let mut keys = said.retract.iter().flat_map(BTreeMap::keys);
                let span = keys.find(|key| key.get_ref() == name);
                let message =
                    format!("retract turns {name}: the tool leaves the part by its linear axes");
                let help = "rotary axes stand where park or change says";
                self.fault("machine-frame", span.map_or(0..0, Spanned::span), message, help);
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
        let nothing = said.retract.is_some() && retract.is_empty();
        let ends = if nothing { Vec::new() } else { machine.depth_ends() }.into_iter();
        let depth = ends.map(|end| said_of(end.0).unwrap_or(end)).collect();
        let aside = retract.iter().copied();
        let aside = aside.filter(|(place, _)| !is_depth(machine, *place));
        machine.frame = Frame {
            leave: None,
            room: self.checked(&said.approach_room).unwrap_or(ROOM),
            retract_said: said.retract.is_some(),
            aside: aside.collect(),
            retract: depth,
            change,
            park,
        };
        if let Some(leave) = &said.leave {
            self.leave(leave, said, machine);
        }
    }

    /// Takes the way that `leave` says, which replaces that of the depth axis.
    fn leave(&mut self, spanned: &Spanned<LeaveFile>, said: &ControlFile, machine: &mut Machine) {
        let leave = spanned.get_ref();
        let LeaveAlong::Tool = leave.along;
        let distance = self.number(&leave.distance);
        if distance <= 0.0 {
            let message = format!("leave draws the tool back by {} mm", Short(distance));
            let help = "distance is above zero, mm";
            self.fault("machine-frame", leave.distance.span(), message, help);
        }
        if let Some(name) = said.retract.iter().flat_map(BTreeMap::keys).next() {
            let message = "retract and leave both say how the tool leaves the part".to_owned();
            let help = "what retract says stands behind then = … of leave";
            self.fault("machine-frame", name.span(), message, help);
        }
        let mut names: Vec<&Spanned<String>> = leave.then.keys().collect();
        names.sort_by_key(|name| name.span().start);
        let mut then = Vec::new();
        for name in names {
            let value = &leave.then[name];
            then.extend(self.position(name, value, true, machine));
        }
        let moves = |(place, _): &(usize, f64)| !machine.axes[*place].joint.rotary;
        let slides = machine.axes.iter().any(|axis| !axis.joint.rotary);
        // A rail under an arm leads the tool no farther off the part.
        let arm = || machine.solver(0.0).is_ok_and(|solver| solver.has_arm());
        if slides && !arm() && then.first().is_some_and(|first| !moves(first)) {
            let message =
                "the first of then is a rotary axis: the tool is still at the part".to_owned();
            let help =
                "linear axes first; or leave it out: rotary axes stand where change and park say";
            self.fault("machine-frame", spanned.span(), message, help);
        }
        let aside = then.split_off(then.len().min(1));
        machine.frame = Frame {
            retract: then,
            aside,
            leave: Some(distance),
            retract_said: true,
            ..std::mem::take(&mut machine.frame)
        };
    }

    fn positions(&mut self, said: &Said, machine: &Machine) -> Vec<(usize, f64)> {
        let said = said.iter();
        said.filter_map(|(name, value)| self.position(name, value, false, machine)).collect()
    }

    /// A position of an axis; `ends`: it may be that of an end of travel, by its name.
    fn position(
        &mut self,
        name: &Spanned<String>,
        value: &KeyedNumber,
        ends: bool,
        machine: &Machine,
    ) -> Option<(usize, f64)> {
        let known = machine.axes.iter().position(|axis| axis.name == *name.get_ref());
        let Some(place) = known else {
            let message = format!("the machine has no axis {}", name.get_ref());
            let help = &axes_are(&machine.axes);
            self.fault("machine-frame", name.span(), message, help);
            return None;
        };
        let axis = &machine.axes[place];
        if let (true, Some(end)) = (ends, TravelEndName::of(value)) {
            let Some([least, most]) = axis.travel else {
                let message = format!("{} has no end of travel", axis.name);
                let help = "a position, as the control shows it";
                self.fault("machine-frame", value.span(), message, help);
                return None;
            };
            return Some((
                place,
                match end {
                    TravelEndName::Max => most,
                    TravelEndName::Min => least,
                },
            ));
        }
        let shown = self.number(value);
        let position = shown * axis.unit() - axis.zero;
        if let (Some([least, most]), true) =
            (axis.travel, passed(axis.travel, position, 0.0).is_some())
        {
            let message = format!(
                "{} cannot stand at {}: its travel is {} to {}",
                axis.name,
                Short(shown),
                Short(axis.reading(least)),
                Short(axis.reading(most))
            );
            let help =
                "positions of [control] are in machine coordinates, as the control shows them";
            self.fault("machine-travel", value.span(), message, help);
        }
        if axis.travel.is_none() && libm::fabs(position) > FARTHEST {
            let message = format!("{} cannot stand at {}", axis.name, Short(shown));
            let help = "an endless axis stands within ten thousand turns of zero";
            self.fault("machine-travel", value.span(), message, help);
        }
        if !stands(axis, position) {
            let message = format!(
                "{} cannot stand at {}: it is none of its positions",
                axis.name,
                Short(shown)
            );
            self.fault("machine-travel", value.span(), message, "");
        }
        Some((place, position))
    }
}

/// An end of travel, by its name.
#[derive(Clone, Copy)]
enum TravelEndName {
    Max,
    Min,
}

impl TravelEndName {
    fn of(value: &KeyedNumber) -> Option<Self> {
        match value.get_ref() {
            Number::Expression(name) if name.trim() == "max" => Some(Self::Max),
            Number::Expression(name) if name.trim() == "min" => Some(Self::Min),
            _ => None,
        }
    }
}

/// An indexed axis stands at its positions alone.
fn stands(axis: &Axis, position: f64) -> bool {
    let indexed = axis.indexed.as_ref();
    indexed.is_none_or(|indexed| indexed.positions.holds(position, axis.travel.is_none()))
}
