//! The axes of a machine file, checked one by one and against the chain.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::Vector3;
use post_grammar::{LinkKind, parse_chain};
use toml::Spanned;

use super::build::Builder;
use super::file::{AxisFile, MachineFile, RotaryWay};
use super::limits::MOST_ENTRIES;
use super::quantity::KeyedNumber;
use super::{Axis, Clamp, Indexed, Positions};
use crate::kinematics::travel::{AT_END, passed};
use crate::kinematics::{Joint, MAX_AXES, Second};

/// The largest value of a rotary axis, degrees.
const MOST_TRAVEL: f64 = 36_000.0;

/// What a letter means in the programs of all controls, whatever the axes are called, if it is no axis there.
fn meaning_elsewhere(name: &str) -> Option<&'static str> {
    Some(match name.chars().next()? {
        'D' => "D is the register of a tool's radius, or its edge",
        'F' => "F is the feed",
        'G' => "G prepares a function",
        'H' => "H is the register of a tool's length, or an auxiliary function",
        'M' => "M switches the machine",
        'N' => "N numbers a block",
        'O' => "O numbers the program",
        'S' => "S is the speed of the spindle",
        'T' => "T is the tool",
        _ => return None,
    })
}

impl Builder<'_> {
    /// The axes in the order of the chain, each checked against its side of the bed.
    pub(super) fn axes(&mut self, file: &MachineFile) -> Option<Vec<Axis>> {
        let chain_span = file.chain.span();
        let links = match parse_chain(file.chain.get_ref()) {
            Ok(links) => links,
            Err(fault) => {
                // One byte for the opening quote.
                let start = chain_span.start + 1;
                let span = start + fault.span.start..start + fault.span.end;
                let message = fault.message;
                let help = fault.help.as_deref().unwrap_or_default();
                self.fault("machine-chain", span, message, help);
                return None;
            }
        };
        let mut axes = Vec::new();
        let mut named = BTreeSet::new();
        let mut carries_part = true;
        let mut sound = true;
        for link in links {
            let span = chain_span.start + 1 + link.span.start..chain_span.start + 1 + link.span.end;
            match link.kind {
                LinkKind::Workpiece | LinkKind::Tool | LinkKind::Spindle { .. } => {}
                LinkKind::Bed => carries_part = false,
                LinkKind::Axis { name, primed } => {
                    sound &= self.is_on_its_side(&name, primed, carries_part, span.clone());
                    let first = named.insert(name.clone());
                    if !self.has_a_name_of_its_own(&name, first, span.clone()) {
                        sound = false;
                        continue;
                    }
                    match file.axis.get_ref().get(&name) {
                        Some(axis) => match self.axis(&name, axis, carries_part) {
                            Some(axis) => axes.push(axis),
                            None => sound = false,
                        },
                        None => {
                            sound = false;
                            let message =
                                format!("the chain has {name}, but there is no [axis.{name}]");
                            let help = "describe the axis, or take it out of the chain";
                            self.fault("machine-axis", span, message, help);
                        }
                    }
                }
            }
        }
        for (name, axis) in file.axis.get_ref() {
            if !named.contains(name) {
                sound = false;
                let message = format!("[axis.{name}] does not stand in the chain");
                let help = "put it where it belongs between w and t";
                self.fault("machine-axis", axis.span(), message, help);
            }
        }
        if axes.len() > MAX_AXES {
            sound = false;
            let message = format!("{} axes; at most {MAX_AXES} are possible", axes.len());
            let help = "leave out of chain and [axis] what no program moves";
            self.fault("machine-chain", chain_span, message, help);
        }
        sound.then_some(axes)
    }

    /// An axis of the chain is primed if it carries the part, and not else.
    fn is_on_its_side(
        &mut self,
        name: &str,
        primed: bool,
        carries_part: bool,
        span: Range<usize>,
    ) -> bool {
        if primed != carries_part {
            let message = if carries_part {
                format!(
                    "{name} stands between the workpiece and the bed, so it carries the part: write {name}'"
                )
            } else {
                format!("{name}' is primed, but it stands between the bed and the tool")
            };
            let help = "a prime marks an axis that carries the workpiece (ISO 841); b is the bed";
            self.fault("machine-chain", span, message, help);
        }
        primed == carries_part
    }

    /// The name of an axis stands in the chain once (`first`), and is no word of every control.
    fn has_a_name_of_its_own(&mut self, name: &str, first: bool, span: Range<usize>) -> bool {
        if !first {
            let message = format!("{name} stands twice in the chain");
            self.fault("machine-chain", span, message, "");
            return false;
        }
        if let Some(meaning) = meaning_elsewhere(name) {
            let message = format!(
                "an axis cannot be called {name}: in the program of every control {meaning}"
            );
            let help = "rename it, here and in [axis]: X Y Z, U V W and P Q R slide, A B C turn (ISO 841); robots' dialects have A1 to A6 for the arm and E1 to E6 beside it";
            self.fault("machine-axis", span, message, help);
            return false;
        }
        true
    }

    fn axis(
        &mut self,
        name: &str,
        spanned: &Spanned<AxisFile>,
        carries_part: bool,
    ) -> Option<Axis> {
        let axis: &AxisFile = spanned.get_ref();
        let joint = self.joint(name, spanned)?;
        let rotary = joint.rotary;
        let unit = if rotary { 1f64.to_radians() } else { 1.0 };
        if axis.cyclic && !rotary {
            let message = format!("{name} slides: it cannot be cyclic");
            let help = "give its travel";
            self.fault("machine-axis", spanned.span(), message, help);
        }
        let zero = axis.zero.as_ref().map_or(0.0, |zero| self.number(zero));
        let travel = self.travel(name, spanned, zero, unit);
        let of = format!(" of {name}");
        let mut rate = |given: &Option<KeyedNumber>| {
            given.as_ref().map(|given| self.within_bounds(given, &of) * unit)
        };
        let max_feed = rate(&axis.max_feed).unwrap_or(f64::INFINITY);
        // A length, not a rate of the axis.
        let feed_diameter = rate(&axis.feed_diameter).map(|diameter| diameter / unit);
        if let (Some(given), false) = (&axis.feed_diameter, rotary) {
            let message =
                format!("feed_diameter of {name}: it is for rotary axes, whose ways are angles");
            self.fault("machine-axis", given.span(), message, "");
        }
        let mut rate = |given: &Option<KeyedNumber>| {
            given.as_ref().map(|given| self.within_bounds(given, &of) * unit)
        };
        let max_accel = rate(&axis.max_accel).unwrap_or(f64::INFINITY);
        let max_jerk = rate(&axis.max_jerk).unwrap_or(f64::INFINITY);
        let max_jump = rate(&axis.max_jump);
        let indexed = self.indexed(name, spanned, zero, unit, travel);
        let clamp = self.clamp(name, spanned);
        let range = self.range(name, spanned, unit);
        let way = self.way(name, axis, zero, range);
        Some(Axis {
            name: name.to_owned(),
            tip_word: None,
            place: self.sources.place(spanned.span()),
            carries_part,
            joint,
            reversed: axis.reversed,
            zero: zero * unit,
            travel,
            range: (way == RotaryWay::Shorter).then(|| range.unwrap_or([0.0, TAU])),
            signed: way == RotaryWay::Sign,
            indexed,
            second: None,
            clamp,
            max_feed,
            feed_diameter,
            max_accel,
            max_jerk,
            max_jump,
            servo: None,
        })
    }

    /// Whether an axis slides or turns, in which direction, and about which line.
    fn joint(&mut self, name: &str, spanned: &Spanned<AxisFile>) -> Option<Joint> {
        let axis: &AxisFile = spanned.get_ref();
        let (rotary, direction) = match (&axis.linear, &axis.rotary) {
            (Some(direction), None) => (false, direction),
            (None, Some(direction)) => (true, direction),
            _ => {
                let message = format!("{name} must be linear or rotary, one of the two");
                let help = "linear = [1, 0, 0] slides along X, rotary = [0, 0, 1] turns about Z";
                self.fault("machine-axis", spanned.span(), message, help);
                return None;
            }
        };
        let mut direction = self.direction(&format!("the direction of {name}"), direction)?;
        if axis.reversed {
            direction = -direction;
        }
        let point = match (&axis.point, rotary) {
            (Some(point), true) => self.vector(point),
            (None, true) => {
                let message =
                    format!("{name} turns, but the file does not say where its axis line runs");
                let help = "point = [x, y, z], any point on the line, in the machine frame with all axes at zero";
                self.fault("machine-axis", spanned.span(), message, help);
                return None;
            }
            (Some(point), false) => {
                let message = format!("{name} slides: a point means nothing to it");
                let help = "take the point out";
                self.fault("machine-axis", point[0].span(), message, help);
                return None;
            }
            (None, false) => Vector3::zeros(),
        };
        Some(Joint { rotary, direction, point })
    }

    /// Least and largest value, mm or radians, counted from the drawing's zero; none if it turns without end.
    fn travel(
        &mut self,
        name: &str,
        spanned: &Spanned<AxisFile>,
        zero: f64,
        unit: f64,
    ) -> Option<[f64; 2]> {
        let axis = spanned.get_ref();
        let rotary = axis.rotary.is_some();
        match (&axis.travel, axis.cyclic) {
            (Some(travel), false) => {
                let [least, most] = [&travel.get_ref()[0], &travel.get_ref()[1]]
                    .map(|quantity| self.number(quantity));
                if least >= most {
                    let message = format!(
                        "the travel of {name} goes from {least} to {most}: the first must be the smaller"
                    );
                    let help = "travel = [least, most]";
                    self.fault("machine-travel", travel.span(), message, help);
                }
                if rotary && least.abs().max(most.abs()) > MOST_TRAVEL {
                    let message = format!("{name} turns by more than a hundred turns");
                    let help = "an axis that turns without end says cyclic = true";
                    self.fault("machine-travel", travel.span(), message, help);
                }
                Some([(least - zero) * unit, (most - zero) * unit])
            }
            (None, true) => None,
            (Some(travel), true) => {
                let message =
                    format!("{name} is cyclic (endless) and has travel: which of the two?");
                let help = "keep one of them";
                self.fault("machine-travel", travel.span(), message, help);
                None
            }
            (None, false) => {
                let message = format!("{name} has no travel");
                let help = if rotary {
                    "travel = [-120, 30] in degrees, or cyclic = true if it turns without end"
                } else {
                    "travel = [-300, 300] in mm, in positions of the axis"
                };
                self.fault("machine-travel", spanned.span(), message, help);
                None
            }
        }
    }

    /// `indexed`, `positions` and `step`: values as the control shows them, counted from the drawing's zero here.
    fn indexed(
        &mut self,
        name: &str,
        spanned: &Spanned<AxisFile>,
        zero: f64,
        unit: f64,
        travel: Option<[f64; 2]>,
    ) -> Option<Indexed> {
        let axis = spanned.get_ref();
        let Some(start) = &axis.indexed else {
            let stray = axis
                .positions
                .as_ref()
                .map(|positions| (positions.span(), "positions"))
                .or_else(|| axis.step.as_ref().map(|step| (step.span(), "step")));
            if let Some((span, key)) = stray {
                let message = format!("{name} has {key}, but is not indexed");
                let help = "indexed = 0 keeps it at 0 during cuts";
                self.fault("machine-axis", span, message, help);
            }
            return None;
        };
        let value = (self.number(start) - zero) * unit;
        if passed(travel, value, AT_END).is_some() {
            let message =
                format!("{name} is indexed at {}, outside its travel", value / unit + zero);
            self.fault("machine-travel", start.span(), message, "");
        }
        let positions = self.index_positions(name, axis, zero, unit, travel);
        if !positions.holds(value, travel.is_none()) {
            let message = format!(
                "{name} is indexed at {}, which is none of its positions",
                value / unit + zero
            );
            self.fault("machine-axis", start.span(), message, "");
        }
        Some(Indexed { start: value, positions })
    }

    /// Where an indexed axis can stand, counted from the drawing's zero.
    fn index_positions(
        &mut self,
        name: &str,
        axis: &AxisFile,
        zero: f64,
        unit: f64,
        travel: Option<[f64; 2]>,
    ) -> Positions {
        match (&axis.positions, &axis.step) {
            (None, None) => Positions::Any,
            (Some(list), None) if list.get_ref().len() > MOST_ENTRIES => {
                let message = format!(
                    "{name} has {} positions; at most {MOST_ENTRIES} are possible",
                    list.get_ref().len()
                );
                let help = "step = 0.1 lets it stand at 0, 0.1, 0.2 …";
                self.fault("machine-size", list.span(), message, help);
                Positions::Any
            }
            (Some(list), None) => {
                let values: Vec<f64> = list
                    .get_ref()
                    .iter()
                    .map(|quantity| (self.number(quantity) - zero) * unit)
                    .collect();
                if let Some(place) =
                    values.iter().position(|value| passed(travel, *value, AT_END).is_some())
                {
                    let message = format!("this position of {name} lies outside its travel");
                    self.fault("machine-travel", list.get_ref()[place].span(), message, "");
                }
                if values.is_empty() {
                    let message = format!("{name} has no position");
                    let help = "positions = [0, 90, 180, 270]";
                    self.fault("machine-axis", list.span(), message, help);
                }
                Positions::List(values)
            }
            (None, Some(step)) => {
                let width = self.number(step) * unit;
                if width <= 0.0 {
                    let message = format!("the step of {name} must be above zero");
                    let help = "step = 5 lets it stand at 0, 5, 10 …";
                    self.fault("machine-axis", step.span(), message, help);
                }
                Positions::Step { first: -zero * unit, step: width.max(1e-6) }
            }
            (Some(list), Some(_)) => {
                let message = format!("{name} has both positions and step: which of the two?");
                let help = "keep one of them";
                self.fault("machine-axis", list.span(), message, help);
                Positions::Any
            }
        }
    }

    fn clamp(&mut self, name: &str, spanned: &Spanned<AxisFile>) -> Option<Clamp> {
        let axis = spanned.get_ref();
        let (span, help) = match (&axis.clamp, &axis.unclamp) {
            (None, None) => return None,
            (Some(on), Some(off)) if axis.indexed.is_some() || axis.rotary.is_some() => {
                return Some(Clamp { on: on.get_ref().clone(), off: off.get_ref().clone() });
            }
            (Some(on), Some(_)) => {
                (on.span(), "a linear axis is clamped if it stands still in cuts: indexed = 0")
            }
            (Some(word), None) | (None, Some(word)) => {
                (word.span(), "clamp and unclamp go together: clamp = \"M10\", unclamp = \"M11\"")
            }
        };
        self.fault("machine-axis", span, format!("{name} cannot be clamped like this"), help);
        None
    }

    /// What the control shows of a cyclic axis, radians.
    fn range(&mut self, name: &str, spanned: &Spanned<AxisFile>, unit: f64) -> Option<[f64; 2]> {
        let axis = spanned.get_ref();
        let range = axis.range.as_ref()?;
        let [least, most] =
            [&range.get_ref()[0], &range.get_ref()[1]].map(|quantity| self.number(quantity));
        if !axis.cyclic || (most - least - 360.0).abs() > 1e-9 {
            let message = format!("the control cannot show {name} from {least} to {most}");
            let help = "a cyclic axis can be shown over one turn: range = [0, 360] or [-180, 180]; its travel is said with travel";
            self.fault("machine-axis", range.span(), message, help);
            return None;
        }
        Some([least * unit, most * unit])
    }

    /// What the control makes of the words of the axis, which shows `zero` (degrees) in the drawing and the turn `range`.
    fn way(
        &mut self,
        name: &str,
        axis: &AxisFile,
        zero: f64,
        range: Option<[f64; 2]>,
    ) -> RotaryWay {
        let usual = if axis.range.is_some() { RotaryWay::Shorter } else { RotaryWay::Counted };
        let Some(said) = &axis.way else {
            return usual;
        };
        let way = *said.get_ref();
        let lack = if !axis.cyclic {
            "it is for a cyclic axis"
        } else if way == RotaryWay::Counted && range.is_some() {
            "an axis with a range shows no whole turns"
        } else if way == RotaryWay::Sign && range.is_some_and(|[least, _]| least != 0.0) {
            "with a sign as the way the place goes from 0 to 360"
        } else if way == RotaryWay::Sign && zero != 0.0 {
            "with a sign as the way the axis shows zero in the drawing"
        } else {
            return way;
        };
        let message = format!("way of {name}: {lack}");
        let help = "way = \"shorter\", \"sign\" or \"counted\", of a cyclic axis";
        self.fault("machine-axis", said.span(), message, help);
        usual
    }

    /// Finds the axes that quills move along with.
    pub(super) fn seconds(&mut self, file: &MachineFile, axes: &mut [Axis]) {
        let main: Vec<(usize, Vector3<f64>)> = axes
            .iter()
            .enumerate()
            .filter(|(_, axis)| !axis.joint.rotary && axis.indexed.is_none())
            .filter(|(_, axis)| {
                let spanned = &file.axis.get_ref()[&axis.name];
                let axis = spanned.get_ref();
                axis.share.is_none() && !reserves(axis)
            })
            .map(|(place, axis)| (place, axis.joint.direction))
            .collect();
        for axis in axes {
            let spanned = &file.axis.get_ref()[&axis.name];
            let said = spanned.get_ref();
            let reserve = said.reserve.as_ref().filter(|_| reserves(said));
            let (span, share) = match (&said.share, reserve) {
                (None, None) => continue,
                (Some(share), None) => (share.span(), Some(self.number(share))),
                (None, Some(reserve)) => (reserve.span(), None),
                (Some(share), Some(_)) => {
                    let message =
                        format!("{} has both share and reserve: which of the two?", axis.name);
                    let help = "keep one of them";
                    self.fault("machine-axis", share.span(), message, help);
                    continue;
                }
            };
            let along = main
                .iter()
                .find(|(_, direction)| direction.dot(&axis.joint.direction).abs() > 1.0 - 1e-6);
            let Some((of, _)) = along.filter(|_| !axis.joint.rotary && axis.indexed.is_none())
            else {
                let message = format!("{} can share the way of no other axis", axis.name);
                let help = "share and reserve are for a linear axis (a quill) that is parallel to another and not indexed";
                self.fault("machine-axis", span, message, help);
                continue;
            };
            if share.is_some_and(|share| !(0.0..=1.0).contains(&share)) {
                let message = format!("the share of {} must be from 0 to 1", axis.name);
                self.fault("machine-axis", span, message, "");
            }
            axis.second = Some(match share {
                Some(share) => Second::Share { of: *of, share },
                None => Second::Reserve { of: *of },
            });
        }
    }
}

/// It is a quill that moves where another axis ends.
fn reserves(axis: &AxisFile) -> bool {
    axis.reserve.as_ref().is_some_and(|reserve| *reserve.get_ref())
}
