//! Bodies of the machine in the choice among solutions.
//!
//! The cheapest way through the trellis is held against the bodies when it is settled. Only where it hits something every way
//! through the trellis is, each step of it that hits counts before all else that it costs, and the cheapest is looked for
//! again. So a path that hits nothing is chosen as if there were no bodies, and where nothing helps the fewest hits are taken.
//!
//! What is looked at is the way between CL points; where the tool comes from the retract, how the axes turn there and the way
//! straight down; and the way straight up. Nothing is proven by it: the program is, as it is written.

use std::f64::consts::TAU;
use std::fmt::Debug;

use post_machine::axis_words;
use post_machine::check::number;
use post_machine::description::{Machine, Pole};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::travel::OverTravel;
use post_machine::kinematics::{Joints, Solver};

use super::backtrace::Backtrace;
use super::route::Route;
use super::solution::both;
use super::trellis::{ArrivalKind, Trellis, TrellisLayer, pose};
use crate::accuracy::Placer;
use crate::program::StraightMove;

/// Points that wait at most to be decided: a pass is one choice.
const LONGEST_PASS: usize = 20_000;

/// Solutions whose axes differ by less are the same, mm and radians.
const SAME: f64 = 1e-6;

/// A tool whose axis is off the depth axis by no more leans not, as a cosine less than 1.
const UPRIGHT: f64 = 1e-6;

/// How the axes go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrialWayKind {
    /// At feed, the tip straight.
    Cut,
    /// At rapid, the tip straight.
    Rapid,
    /// At rapid, as far as each axis goes, off the part: the rotary ones while the tool is retracted.
    Turn,
    /// The same where it might as well go elsewhere: it keeps off the part too, and half a millimetre more than has to be.
    Across,
}

/// A way of the axes.
#[derive(Clone, Copy, Debug)]
pub struct TrialWay<'a> {
    /// The machine with its tool.
    pub solver: &'a Solver,
    /// Axis values where it begins and ends, mm and radians.
    pub ends: [&'a Joints; 2],
    /// How they go.
    pub kind: TrialWayKind,
}

/// Two bodies that are not clear of one another.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Their names.
    pub bodies: [String; 2],
    /// Axis values at the end of the way that leads there, mm and radians.
    pub joints: Joints,
}

/// A tool as a body.
#[derive(Clone, Debug, PartialEq)]
pub struct ClearTool {
    /// Its number.
    pub number: u32,
    /// From the gauge point to the tip, mm, if it is known.
    pub length: Option<f64>,
    /// Diameter of its cutter as the CL file has it, mm.
    pub diameter: Option<f64>,
}

/// Says on which ways bodies of a machine stay clear of one another.
pub trait BodyClearance: Debug {
    /// Another tool is in the spindle; none: it is not known.
    fn equip(&mut self, tool: Option<&ClearTool>);

    /// Bodies that are not clear of one another on a way; none: all are.
    fn contact(&mut self, way: &TrialWay<'_>) -> Option<Contact>;
}

/// Holds ways of the route against bodies.
#[derive(Debug)]
pub(crate) struct BodyTrial<'a> {
    bodies: &'a mut dyn BodyClearance,
}

/// Where a way hits something: line of the CL file, and what.
#[derive(Debug)]
pub(super) struct Hit {
    line: u64,
    contact: Contact,
    layer: usize,
}

/// Why no other solution is taken where a way hits something.
enum NoOther {
    /// None stays clear.
    Clear,
    /// Another one is beyond the travel of an axis.
    Travel(OverTravel),
    /// Another one that stays clear there, and with which something is hit elsewhere.
    Hits(Joints, u64, [String; 2]),
    /// Another one that stays clear there, and with which the path does not come through.
    Through(Joints),
}

impl BodyTrial<'_> {
    pub(super) fn equip(&mut self, tool: Option<&ClearTool>) {
        self.bodies.equip(tool);
    }

    /// What the way from `from` to `to` hits.
    pub(super) fn arrives(
        &mut self,
        machine: &Machine,
        placer: &Placer,
        kind: ArrivalKind,
        from: &Joints,
        to: &Joints,
    ) -> Option<Contact> {
        let solver = placer.solver();
        let kind = match kind {
            ArrivalKind::First => {
                let turns = self.turns(machine, solver, from, to);
                return turns.or_else(|| self.comes_down(machine, solver, to));
            }
            ArrivalKind::Rapid => TrialWayKind::Rapid,
            ArrivalKind::Cut => TrialWayKind::Cut,
        };
        self.bodies.contact(&TrialWay { solver, ends: [from, to], kind })
    }

    /// What is hit where the axes stand on `joints`.
    fn stands(&mut self, placer: &Placer, joints: &Joints) -> Option<Contact> {
        let (solver, kind) = (placer.solver(), TrialWayKind::Cut);
        self.bodies.contact(&TrialWay { solver, ends: [joints, joints], kind })
    }

    /// What is hit on the way down to a first position from where the tool is retracted.
    fn comes_down(&mut self, machine: &Machine, solver: &Solver, to: &Joints) -> Option<Contact> {
        let above = retracted(machine, solver, to);
        self.bodies.contact(&TrialWay { solver, ends: [&above, to], kind: TrialWayKind::Rapid })
    }

    /// What is hit while the axes turn where the tool is retracted, from how they stand at `from` to how they do at `to`.
    fn turns(
        &mut self,
        machine: &Machine,
        solver: &Solver,
        from: &Joints,
        to: &Joints,
    ) -> Option<Contact> {
        let mut stands = *from;
        for (joint, value) in &machine.frame.retract {
            stands[*joint] = *value;
        }
        let mut turned = stands;
        for (place, axis) in machine.axes.iter().enumerate() {
            if axis.joint.rotary {
                turned[place] = to[place];
            }
        }
        let turn = TrialWay { solver, ends: [&stands, &turned], kind: TrialWayKind::Turn };
        self.bodies.contact(&turn)
    }

    /// What is hit while the tool is drawn back at a point, turned from one end to the other, and brought back.
    fn rewinds(
        &mut self,
        machine: &Machine,
        placer: &Placer,
        motion: &StraightMove,
        ends: [&Joints; 2],
    ) -> Vec<Contact> {
        let along = machine.control_point.along;
        let back = machine.rewind.and_then(|rewind| motion.drawn_back(&rewind, along));
        let Some(back) = back.map(|back| pose(&back)) else {
            return Vec::new();
        };
        let away = ends.map(|joints| placer.settled(back, 1.0, joints).map(|at| at.trace.joints));
        let [Ok(away), Ok(turned)] = away else {
            return Vec::new();
        };
        let (solver, kind) = (placer.solver(), TrialWayKind::Rapid);
        let ways = [[ends[0], &away], [&away, &turned], [&turned, ends[1]]];
        let contact = |ends| self.bodies.contact(&TrialWay { solver, ends, kind });
        ways.into_iter().filter_map(contact).collect()
    }

    /// What the way from `from` to the retract hits.
    fn departs(&mut self, machine: &Machine, solver: &Solver, from: &Joints) -> Option<Contact> {
        let above = retracted(machine, solver, from);
        self.bodies.contact(&TrialWay { solver, ends: [from, &above], kind: TrialWayKind::Rapid })
    }
}

/// Where the axes stand when the tool is drawn up from `joints` to the retract: there, where it leans or leaves along its own
/// axis, for it goes another way then.
fn retracted(machine: &Machine, solver: &Solver, joints: &Joints) -> Joints {
    let mut above = *joints;
    let Some(depth) = axis_words::depth(machine) else {
        return above;
    };
    let chain = solver.chain();
    let along = chain.way_of(depth, joints).dot(&chain.forward(joints).axis);
    if machine.frame.leave.is_none() && libm::fabs(along) > 1.0 - UPRIGHT {
        for (joint, value) in &machine.frame.retract {
            above[*joint] = *value;
        }
    }
    above
}

impl<'a> Route<'a> {
    /// Ways are held against bodies from here on.
    pub(super) fn keep_clear_of(&mut self, bodies: &'a mut dyn BodyClearance) {
        self.judge.bodies = Some(BodyTrial { bodies });
    }

    /// Points that wait at most before some are settled.
    #[inline]
    pub(super) fn look_ahead(&self) -> usize {
        let look_ahead = self.machine.solution.look_ahead;
        match self.judge.bodies {
            None => look_ahead,
            Some(_) => look_ahead.max(LONGEST_PASS),
        }
    }

    /// The first hit of the way that is to be settled.
    pub(super) fn first_hit(&mut self, way: &Backtrace) -> Option<Hit> {
        // Where each point has one solution nothing is to be chosen.
        let chooses = self.trellis.states.len() > self.trellis.layers.len();
        chooses.then(|| self.hit_of(way, true)).flatten()
    }

    /// The first hit of a way, from its beginning as far as its states are known; where the axes turn over the retract if
    /// `turns` says so.
    fn hit_of(&mut self, way: &Backtrace, turns: bool) -> Option<Hit> {
        let Self { trellis, settings, machine, judge, rewound, anchored, departs, near, .. } = self;
        let bodies = judge.bodies.as_mut()?;
        let count = way.states.len();
        for layer in usize::from(*anchored)..count {
            let at = &trellis.layers[layer];
            let from = layer.checked_sub(1).map_or(*near, |before| way.joints(trellis, before));
            let stands = way.joints(trellis, layer);
            let rewind = trellis.states[way.states[layer]].rewind.map(|before| &rewound[before]);
            let to = rewind.unwrap_or(&stands);
            let placer = &settings[at.setting].1;
            let turned = |bodies: &mut BodyTrial<'_>| {
                let ends = [rewind?, &stands];
                bodies.rewinds(machine, placer, &at.motion, ends).into_iter().next()
            };
            let arrives = match at.kind {
                ArrivalKind::First if !turns => bodies.comes_down(machine, placer.solver(), to),
                kind => bodies.arrives(machine, placer, kind, &from, to),
            };
            let found = arrives.or_else(|| turned(bodies));
            if let Some(contact) = found {
                return Some(Hit { line: at.line, contact, layer });
            }
        }
        let ends = *departs && count == trellis.layers.len();
        let last = trellis.layers.last().filter(|_| ends)?;
        let joints = way.joints(trellis, count - 1);
        let contact = bodies.departs(machine, settings[last.setting].1.solver(), &joints)?;
        Some(Hit { line: last.line, contact, layer: count - 1 })
    }

    /// The way by a state of a layer that is followed farthest: up to where a cheaper one comes to the same place, or nothing
    /// goes on.
    fn through(&self, layer: usize, state: usize) -> Backtrace {
        let trellis = &self.trellis;
        let (mut ends, mut last) = (vec![state], layer);
        for (place, at) in trellis.layers.iter().enumerate().skip(layer + 1) {
            let mut behind: Vec<usize> = (at.first..at.first + at.count).collect();
            behind.retain(|place| {
                let state = &trellis.states[*place];
                state.cost.is_way() && ends.contains(&state.from)
            });
            if behind.is_empty() {
                break;
            }
            (ends, last) = (behind, place);
        }
        let mut states = vec![ends[0]; last + 1];
        for layer in (1..states.len()).rev() {
            states[layer - 1] = trellis.states[states[layer]].from;
        }
        Backtrace { states, eased: Vec::new() }
    }

    /// Why no other solution is taken where `way` has a hit.
    fn no_other(&mut self, way: &Backtrace, hit: &Hit) -> NoOther {
        let layer = self.trellis.layers[hit.layer].clone();
        let placer = self.settings[layer.setting].1.clone();
        let taken = way.joints(&self.trellis, hit.layer);
        let mut stands = Vec::new();
        let axes = &self.trellis.axes;
        let target = pose(&layer.motion);
        let found = axes.stands(placer.solver(), &target, &taken, &both, &mut stands);
        let machine = self.machine;
        let alike = |one: &Joints, other: &Joints| {
            let mut all = machine.axes.iter().zip(one.iter().zip(other));
            all.all(|(axis, (one, other))| {
                let apart = one - other;
                let turns = if axis.joint.rotary { TAU * libm::rint(apart / TAU) } else { 0.0 };
                libm::fabs(apart - turns) < SAME
            })
        };
        stands.retain(|stand| !alike(&stand.joints, &taken));
        let beyond = found.ok().and_then(|found| found.over).filter(|_| stands.is_empty());
        for stand in &stands {
            let bodies = self.judge.bodies.as_mut();
            if bodies.is_none_or(|bodies| bodies.stands(&placer, &stand.joints).is_some()) {
                continue;
            }
            let mut states = layer.first..layer.first + layer.count;
            let goes = states.find(|place| {
                let state = &self.trellis.states[*place];
                state.cost.is_way() && alike(&state.joints, &stand.joints)
            });
            let Some(state) = goes else {
                return NoOther::Through(stand.joints);
            };
            let other = self.through(hit.layer, state);
            match self.hit_of(&other, true) {
                Some(Hit { line, contact, layer }) if layer != hit.layer => {
                    return NoOther::Hits(stand.joints, line, contact.bodies);
                }
                Some(_) => {}
                None => return NoOther::Through(stand.joints),
            }
        }
        beyond.map_or(NoOther::Clear, NoOther::Travel)
    }

    /// Looks for the way with the fewest hits in the place of one that has `hit`; gives the state that it ends in, which was
    /// `best` before.
    pub(super) fn keep_clear(&mut self, way: &mut Backtrace, best: usize, hit: Hit) -> usize {
        let poles = [self.machine.solution.pole, Pole::Exact];
        let mut ends = best;
        for pole in poles {
            self.judge.weighs = true;
            let rebuilt = self.rebuild(pole);
            self.judge.weighs = false;
            if !rebuilt {
                // What is eased does not come through.
                ends = self.walk_back(way).unwrap_or(ends);
                break;
            }
            self.weigh_departures();
            ends = self.walk_back(way).unwrap_or(ends);
            if pole == Pole::Exact {
                break;
            }
            self.ease(way);
            if self.comes_through(way, 1..self.trellis.layers.len()) {
                break;
            }
        }
        // Between passes the tool goes another way than over the retract, which is looked for when it is known where it ends.
        let turns = !self.machine.clearance.link;
        match self.hit_of(way, turns) {
            Some(left) => {
                let why = self.no_other(way, &left);
                self.told.push((left.line, hits_however(self.machine, &left.contact, &why)));
            }
            None if turns || self.hit_of(way, true).is_none() => {
                self.told.push((hit.line, chosen_clear(self.machine, &hit.contact)));
            }
            None => {}
        }
        ends
    }

    /// Takes the next point of a trellis that is made anew; false where no way leads there. Where every way of a cut begins to
    /// hit something there (`hitting` from then on) the tool may be drawn back before, and turned.
    pub(super) fn goes_through(&mut self, at: &TrellisLayer, hitting: &mut bool) -> bool {
        let before = self.trellis.fewest_hits();
        if !self.goes_on(at.line, &at.motion) {
            return false;
        }
        let hits = self.trellis.fewest_hits() > before && at.kind == ArrivalKind::Cut;
        let began = std::mem::replace(hitting, hits);
        if !hits || began || !self.judge.weighs {
            return true;
        }
        self.trellis.pop();
        self.try_rewind(at.line, &at.motion) || self.goes_on(at.line, &at.motion)
    }

    /// What a rewind at a point adds to the ways that hit something.
    pub(super) fn rewind_hits(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        ends: [&Joints; 2],
    ) -> u32 {
        match &mut self.judge.bodies {
            Some(bodies) if self.judge.weighs => {
                bodies.rewinds(self.machine, placer, motion, ends).len() as u32
            }
            _ => 0,
        }
    }

    /// Adds what the ways from the last point to the retract hit.
    fn weigh_departures(&mut self) {
        let trellis = &mut self.trellis;
        let (Some(bodies), Some(last)) = (&mut self.judge.bodies, trellis.layers.last()) else {
            return;
        };
        if !self.departs {
            return;
        }
        let solver = self.settings[last.setting].1.solver();
        for state in &mut trellis.states[last.first..last.first + last.count] {
            let hits = bodies.departs(self.machine, solver, &state.joints).is_some();
            state.cost = state.cost.and_hits(u32::from(hits));
        }
    }
}

impl Trellis {
    /// The fewest ways that hit something to come to the newest layer.
    fn fewest_hits(&self) -> u32 {
        let layer = self.layers.last().map(|layer| layer.first..layer.first + layer.count);
        let states = layer.map(|states| &self.states[states]).unwrap_or_default();
        let ways = states.iter().filter(|state| state.cost.is_way());
        ways.map(|state| state.cost.hits()).min().unwrap_or_default()
    }
}

/// The cheapest solutions would hit something, and others were found.
fn chosen_clear(machine: &Machine, contact: &Contact) -> Diagnostic {
    let [one, other] = &contact.bodies;
    let message = format!(
        "with the cheapest solutions {one} would not stay clear of {other} (at {}): others are taken",
        machine.shown(&contact.joints)
    );
    Diagnostic::warning("clearance", message)
        .help("[clearance] choose has it so; another fixture or mount may be quicker")
}

/// Whatever solutions are taken, something hits.
fn hits_however(machine: &Machine, contact: &Contact, why: &NoOther) -> Diagnostic {
    let [one, other] = &contact.bodies;
    let at = machine.shown(&contact.joints);
    let hits = format!("{one} does not stay clear of {other} (at {at})");
    let (message, help) = match why {
        NoOther::Clear => (
            format!("no solution was found with which {one} stays clear of {other} (at {at})"),
            "another mount, fixture, tool or path; `post clearance` proves the program",
        ),
        NoOther::Travel(over) => {
            let axis = &machine.axes[over.joint];
            let [value, limit] =
                [over.value, over.limit].map(|value| number(axis.reading(value), 3));
            let name = &axis.name;
            (
                format!(
                    "{hits}, and the other solution is beyond travel: {name} {value}, and it ends at {limit}"
                ),
                "another mount or tool length brings it inside travel; else another fixture, tool or path",
            )
        }
        NoOther::Hits(joints, line, [one, other]) => (
            format!(
                "{hits}; with another solution it does ({}), but {one} does not stay clear of {other} in line {line}",
                machine.shown(joints)
            ),
            "another mount, fixture, tool or path; a path that is divided, with a retract between the parts, may take both solutions",
        ),
        NoOther::Through(joints) => (
            format!(
                "{hits}; with another solution it does ({}), but the path does not come through with it",
                machine.shown(joints)
            ),
            "a path that is divided, with a retract between the parts, or [rewind] in the machine file lets the axes turn; else another mount",
        ),
    };
    Diagnostic::warning("clearance", message).help(help)
}
