//! What a machine file says of the choice between solutions, and of leaving the part when a cut cannot go on.

use std::collections::{BTreeMap, BTreeSet};

use toml::Spanned;

use super::Axis;
use super::build::Builder;
use super::file::{EdgeSource, MachineFile, Pole, RewindFile, Side};
use super::keys::axes_are;
use super::quantity::KeyedNumber;
use crate::kinematics::Joints;
use crate::kinematics::travel::passed;

/// Which of several solutions is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct SolutionRules {
    /// What is to be small over the path.
    pub rule: SolutionCriterion,
    /// Sides of zero on which axes should stand, if they can: place in the chain and side.
    pub prefer: Vec<(usize, Side)>,
    /// Sides of zero that axes must not leave.
    pub require: Vec<(usize, Side)>,
    /// Where the axes stand before the first position, mm or radians.
    pub start: Joints,
    /// Axes of which one at most moves in a block: places in the chain.
    pub exclusive: Vec<Vec<usize>>,
    /// Points that are looked at before the first of them is settled; 1 takes the nearest solution each time.
    pub look_ahead: usize,
    /// What is done close to a singular direction.
    pub pole: Pole,
    /// Where a leading edge points.
    pub edge: EdgeSource,
    /// Where the direction of travel turns by more, the tool is turned on the spot, radians.
    pub corner: f64,
}

/// What is to be small over the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolutionCriterion {
    /// Travel of every axis over its largest feed, summed.
    Time,
    /// The time that the machine takes, as far as feeds and accelerations of its axes tell it beforehand.
    CycleTime,
    /// Root of the sum of squares of the rotary travels.
    Travel,
    /// The largest rotary travel.
    LargestAxis,
    /// The travel of one axis: its place in the chain.
    Axis(usize),
}

/// How the tool leaves the part when a cut cannot go on: back along its axis, turn, and return.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rewind {
    /// How far.
    pub retract: Retract,
    /// Feed of the way out, mm/min; none is rapid.
    pub retract_feed: Option<f64>,
    /// Feed of the turn, degrees a minute; none is rapid.
    pub turn_feed: Option<f64>,
    /// Feed of the way back, mm/min; none is the feed of the cut.
    pub plunge_feed: Option<f64>,
}

/// How far the tool is drawn back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Retract {
    /// A way along the tool axis, mm.
    Distance(f64),
    /// A height of the tip over the part origin to which it goes along the tool axis, mm along Z of the part.
    Plane(f64),
}

/// An endless axis stands no farther from zero, mm or radians: beyond it angles lose the decimals of their words.
pub(super) const FARTHEST: f64 = 1e4 * std::f64::consts::TAU;

/// Points that are looked at where the file does not say.
const LOOK_AHEAD: u32 = 2000;

impl Builder<'_> {
    pub(super) fn solution(&mut self, file: &MachineFile, axes: &[Axis]) -> SolutionRules {
        let said = &file.solution;
        let rule = match &said.rule {
            None => SolutionCriterion::Time,
            Some(rule) => self.rule(rule, axes),
        };
        let prefer = self.sides(&said.prefer, axes);
        let require = self.sides(&said.require, axes);
        let start = self.start(&said.start, axes);
        for group in &said.exclusive {
            let names: BTreeSet<&str> = group.iter().map(|name| name.get_ref().as_str()).collect();
            if names.len() < 2 || names.len() != group.len() {
                let span = group.first().map_or(file.chain.span(), Spanned::span);
                let message = "axes exclude one another: a group has two or more".to_owned();
                let help = "exclusive = [[\"A\", \"C\"]]";
                self.fault("machine-solution", span, message, help);
            }
        }
        let exclusive = said
            .exclusive
            .iter()
            .map(|group| {
                let places = group.iter().filter_map(|name| self.place_of(name, axes));
                places.collect()
            })
            .collect();
        let look_ahead = match &said.look_ahead {
            None => LOOK_AHEAD,
            Some(points) => {
                if *points.get_ref() == 0 || *points.get_ref() > 100_000 {
                    let message = "look_ahead is a number of points, from 1 to 100000".to_owned();
                    let help = "1 takes the nearest solution each time";
                    self.fault("machine-solution", points.span(), message, help);
                }
                *points.get_ref()
            }
        };
        let corner = self.checked(&said.corner).unwrap_or(10.0).min(180.0);
        SolutionRules {
            rule,
            prefer,
            require,
            start,
            exclusive,
            look_ahead: look_ahead as usize,
            pole: said.pole,
            edge: said.edge,
            corner: corner.to_radians(),
        }
    }

    /// Sides of zero by places in the chain.
    fn sides(
        &mut self,
        said: &BTreeMap<Spanned<String>, Side>,
        axes: &[Axis],
    ) -> Vec<(usize, Side)> {
        let mut places = Vec::new();
        for (name, side) in said {
            let Some(place) = self.place_of(name, axes) else {
                continue;
            };
            if !axes[place].joint.rotary {
                let message = format!("{} slides: sides are for rotary axes", axes[place].name);
                let help = "where a linear axis may go is its travel";
                self.fault("machine-solution", name.span(), message, help);
            }
            places.push((place, *side));
        }
        places
    }

    /// Where the axes stand before the first position, mm or radians.
    fn start(&mut self, said: &BTreeMap<Spanned<String>, KeyedNumber>, axes: &[Axis]) -> Joints {
        let mut start: Joints = Default::default();
        for (place, axis) in axes.iter().enumerate() {
            start[place] = match &axis.indexed {
                Some(indexed) => indexed.start,
                // A rotary axis that cannot stand at the drawing's zero stands at the nearest end.
                None => axis
                    .travel
                    .filter(|_| axis.joint.rotary)
                    .map_or(0.0, |[least, most]| 0f64.max(least).min(most)),
            };
        }
        for (name, value) in said {
            let Some(place) = self.place_of(name, axes) else {
                continue;
            };
            let axis = &axes[place];
            let unit = axis.unit();
            let value = self.number(value) * unit - axis.zero;
            if passed(axis.travel, value, 0.0).is_some() || libm::fabs(value) > FARTHEST {
                let message = format!("{} cannot start there: it is outside its travel", axis.name);
                let help = "an endless axis starts within ten thousand turns of zero";
                self.fault("machine-travel", name.span(), message, help);
            }
            let stands = axis
                .indexed
                .as_ref()
                .is_none_or(|indexed| indexed.positions.holds(value, axis.travel.is_none()));
            if !stands {
                let message =
                    format!("{} cannot start there: it is none of its positions", axis.name);
                self.fault("machine-travel", name.span(), message, "");
            }
            start[place] = value;
        }
        start
    }

    fn rule(&mut self, rule: &Spanned<String>, axes: &[Axis]) -> SolutionCriterion {
        let text = rule.get_ref();
        let named = text
            .strip_prefix("axis:")
            .and_then(|name| axes.iter().position(|axis| axis.name == name));
        match (text.as_str(), named) {
            ("time", _) => SolutionCriterion::Time,
            ("cycle-time", _) => {
                self.accelerations(rule, axes);
                SolutionCriterion::CycleTime
            }
            ("travel", _) => SolutionCriterion::Travel,
            ("largest-axis", _) => SolutionCriterion::LargestAxis,
            (_, Some(place)) => SolutionCriterion::Axis(place),
            _ => {
                let message = format!("there is no rule {text}");
                let help = "\"time\", \"cycle-time\", \"travel\", \"largest-axis\", or \"axis:C\" for an axis of the chain";
                self.fault("machine-solution", rule.span(), message, help);
                SolutionCriterion::Time
            }
        }
    }

    /// A cycle time is made of accelerations: every axis has to have one.
    fn accelerations(&mut self, rule: &Spanned<String>, axes: &[Axis]) {
        let lacking = axes.iter().filter(|axis| axis.max_accel.is_infinite());
        let names: Vec<&str> = lacking.map(|axis| axis.name.as_str()).collect();
        if !names.is_empty() {
            let message = format!(
                "cycle-time is made of accelerations, and the file gives no max_accel of {}",
                names.join(", ")
            );
            let help = "max_accel in mm/s² or deg/s² under [axis.…] of each, or rule = \"time\"";
            self.fault("machine-solution", rule.span(), message, help);
        }
    }

    fn place_of(&mut self, name: &Spanned<String>, axes: &[Axis]) -> Option<usize> {
        let place = axes.iter().position(|axis| axis.name == *name.get_ref());
        if place.is_none() {
            let message = format!("the machine has no axis {}", name.get_ref());
            let help = &axes_are(axes);
            self.fault("machine-solution", name.span(), message, help);
        }
        place
    }

    pub(super) fn rewind(&mut self, spanned: &Spanned<RewindFile>) -> Option<Rewind> {
        let said = spanned.get_ref();
        let retract = match (&said.distance, &said.plane) {
            (Some(distance), None) => Retract::Distance(self.within_bounds(distance, "")),
            (None, Some(plane)) => Retract::Plane(self.number(plane)),
            _ => {
                let message = "[rewind] must say how far the tool is drawn back".to_owned();
                let help = "distance = 50 draws it back along its axis by 50 mm, plane = 200 until the tip stands 200 mm over the part origin";
                self.fault("machine-rewind", spanned.span(), message, help);
                return None;
            }
        };
        Some(Rewind {
            retract,
            retract_feed: self.checked(&said.retract_feed),
            turn_feed: self.checked(&said.turn_feed),
            plunge_feed: self.checked(&said.plunge_feed),
        })
    }
}
