//! Which of several solutions is taken at each point, decided over whole passes.
//!
//! Points come in one by one; a trellis keeps the cheapest way to every way of standing at the newest. What is
//! decided comes out: as soon as one state is left, at the latest when as many points wait as the machine's
//! `look_ahead` says. So the memory is bounded, and the choice is the best that can be known by then.
//!
//! In a cut the axes go on from where they are; another branch or another full turn is taken off the part, in a
//! rapid, or by the machine's `[rewind]` move. Where a cut cannot go on, the fault says what was tried.

use std::rc::Rc;

use post_plugin::Format;

use crate::accuracy::{Lineariser, MoveRoom, NodeMove, Placer};
use crate::program::{MoveFeed, StraightMove};
use post_machine::description::{Machine, Positions};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, Unreachable};

use super::backtrace::Backtrace;
use super::clear::BodyTrial;
use super::solution::SolutionSummary;
use super::trellis::{ArrivalKind, CutChecker, CutEnd, Trellis};

/// A point of the path with the axis values that were chosen for it.
#[derive(Clone, Debug)]
pub(crate) struct ChosenPoint {
    /// Line of the CL file.
    pub line: u64,
    /// The control point's path: see [`super::ConfigurationStage`].
    pub motion: StraightMove,
    /// Which placer solves it: see [`Route::placer`].
    pub setting: usize,
    /// The tool comes here; else it is here already, and is turned.
    pub arrives: bool,
    /// Rotary values; the linear ones follow from their printed values.
    pub joints: Joints,
    /// Values to which the tool is turned at this point, drawn back before and brought back after.
    pub rewind: Option<Box<Joints>>,
    /// Branch or full turn differ from what going on would have given.
    pub changed: bool,
    /// The pole joint does not stand where the CL point alone would put it.
    pub eased: bool,
}

/// Chooses axis values.
#[derive(Debug)]
pub(crate) struct Route<'a> {
    pub(super) machine: &'a Machine,
    format: Format,
    tool_length: f64,
    /// The control is told the tool axis as a vector.
    vectors: bool,
    /// A placer for each set of values that the redundant axes were held at.
    pub(super) settings: Vec<(Joints, Rc<Placer>)>,
    /// Which of them new points get.
    pub(super) setting: usize,
    pub(super) trellis: Trellis,
    /// The first layer is settled and has one state.
    pub(super) anchored: bool,
    /// The layer whose states the roots name.
    pub(super) mark: usize,
    /// Where the axes stand if there is no layer.
    pub(super) near: Joints,
    /// Axis values before a rewind: see `rewind`.
    pub(super) rewound: Vec<Joints>,
    pub(super) judge: CutTrial<'a>,
    /// The tool leaves the part behind the last of the points that are being settled.
    pub(super) departs: bool,
    /// What is to be said of points that were settled, by line.
    pub(super) told: Vec<(u64, Diagnostic)>,
    /// Redundant axes can be put elsewhere as long as the last rapid is not settled.
    pub(super) tries_positions: bool,
    pub(super) chosen: Vec<ChosenPoint>,
    pub(super) way: Backtrace,
}

/// A point that is left out.
#[derive(Debug)]
pub(crate) enum DroppedPoint {
    /// The point cannot be reached; the path goes on from the point before.
    Point(Box<Diagnostic>),
    /// The point can be reached, but the path cannot go on to it; the next point begins a path anew.
    Path(Box<Diagnostic>),
}

/// Settings beyond this are forgotten at the next index move.
const MOST_SETTINGS: usize = 32;

/// The machine has a redundant axis with positions to choose from.
fn tries_positions(machine: &Machine) -> bool {
    machine.redundant().iter().any(|joint| {
        let indexed = &machine.axes[*joint].indexed;
        indexed.as_ref().is_some_and(|indexed| indexed.positions != Positions::Any)
    })
}

/// Tries whether a cut comes through, by cutting it into pieces.
#[derive(Debug)]
pub(super) struct CutTrial<'a> {
    machine: &'a Machine,
    linearise: Lineariser,
    /// The tip counts too, not the tool axis alone.
    pub(super) strict: bool,
    /// What the ways are held against beside that.
    pub(super) bodies: Option<BodyTrial<'a>>,
    /// Ways that hit something cost more.
    pub(super) weighs: bool,
}

impl CutChecker for CutTrial<'_> {
    fn passes(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        from: CutEnd<'_>,
        to: CutEnd<'_>,
    ) -> bool {
        let (Some(from), Some(to)) = (from.node(placer, 0.0), to.node(placer, 1.0)) else {
            return false;
        };
        let room = match motion.pace {
            MoveFeed::Rapid => MoveRoom::Free,
            _ => MoveRoom::Part,
        };
        let mut planned = NodeMove::planned(self.machine, placer, motion.chord, room, [&from, &to]);
        if planned.whole().is_some() {
            return true;
        }
        // What two linear axes miss on the wrong side of the centre line is the tip alone, and so it is with an arm.
        if !self.strict && placer.solver().places_tip() {
            planned.tolerances.tip = f64::INFINITY;
        }
        self.linearise.comes_through(&planned)
    }

    #[inline]
    fn hits(&mut self, placer: &Placer, kind: ArrivalKind, from: &Joints, to: &Joints) -> u32 {
        match &mut self.bodies {
            Some(bodies) if self.weighs => {
                u32::from(bodies.arrives(self.machine, placer, kind, from, to).is_some())
            }
            _ => 0,
        }
    }
}

impl CutTrial<'_> {
    /// Where the axes stand on the way of a cut, the points put in that it needs, and at which share of it: up to its end.
    /// False where it does not come through.
    pub(super) fn pieces(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        from: CutEnd<'_>,
        to: CutEnd<'_>,
        pieces: &mut Vec<(f64, Joints)>,
    ) -> bool {
        pieces.clear();
        let (Some(from), Some(to)) = (from.node(placer, 0.0), to.node(placer, 1.0)) else {
            return false;
        };
        let planned =
            NodeMove::planned(self.machine, placer, motion.chord, MoveRoom::Part, [&from, &to]);
        if planned.whole().is_some() {
            pieces.push((1.0, to.trace.joints));
            return true;
        }
        let through = self.linearise.comes_through(&planned);
        let nodes = self.linearise.pieces().iter().map(|piece| &piece.to);
        pieces.extend(nodes.map(|node| (node.t, node.trace.joints)));
        through
    }
}

impl<'a> Route<'a> {
    /// A route that begins where the machine file says.
    ///
    /// # Errors
    /// What the machine lacks for being solved.
    pub(crate) fn new(
        machine: &'a Machine,
        format: &Format,
        tool_length: f64,
    ) -> Result<Self, Box<Diagnostic>> {
        let near = machine.solution.start;
        let placer = Placer::for_machine(machine, format, tool_length, &near)?;
        Ok(Self {
            machine,
            format: format.clone(),
            tool_length,
            vectors: false,
            trellis: Trellis::new(machine, &placer),
            settings: vec![(near, Rc::new(placer))],
            setting: 0,
            anchored: false,
            mark: 0,
            near,
            rewound: Vec::new(),
            judge: CutTrial {
                machine,
                linearise: Lineariser::default(),
                strict: false,
                bodies: None,
                weighs: false,
            },
            departs: false,
            told: Vec::new(),
            tries_positions: tries_positions(machine),
            chosen: Vec::new(),
            way: Backtrace::default(),
        })
    }

    /// The route of a program whose control is told the tool axis as a vector.
    pub(crate) fn by_vector(mut self) -> Self {
        self.vectors = true;
        for (_, placer) in &mut self.settings {
            *placer = Rc::new(Placer::clone(placer).by_vector(self.machine));
        }
        self
    }

    /// The placer that solves a chosen point.
    pub(crate) fn placer(&self, setting: usize) -> &Rc<Placer> {
        &self.settings[setting].1
    }

    /// The placer that new points get.
    pub(crate) fn present(&self) -> &Placer {
        self.placer(self.setting)
    }

    /// Line of the first point that is not settled.
    pub(crate) fn first_line(&self) -> Option<u64> {
        let first = self.trellis.layers.get(usize::from(self.anchored))?;
        Some(first.line)
    }

    /// The leading edge of the tool as the axes stand, part frame; zero for a tool that turns.
    pub(crate) fn edge_at_rest(&self) -> nalgebra::Vector3<f64> {
        let chain = self.present().solver().chain();
        chain.forward(self.stands_at()).edge
    }

    /// Where the axes stand after the last decided point.
    pub(crate) fn stands_at(&self) -> &Joints {
        match self.trellis.layers.first() {
            Some(_) if self.anchored => &self.trellis.states_of(0)[0].joints,
            _ => &self.near,
        }
    }

    /// The axes stand here, and nothing moves; every point before is settled.
    pub(crate) fn begin_at(&mut self, near: Joints) {
        self.settle_all();
        self.leave();
        self.near = near;
    }

    /// The tool leaves the part (a tool change, home): everything is settled, and the next point is a first one.
    pub(crate) fn leave(&mut self) {
        self.near = *self.stands_at();
        self.trellis.layers.clear();
        self.trellis.states.clear();
        self.trellis.wide = false;
        self.rewound.clear();
        self.anchored = false;
        self.mark = 0;
    }

    /// Another tool, or another head of the machine; [`Route::leave`] comes before it.
    ///
    /// # Errors
    /// What the machine lacks for being solved with it.
    pub(crate) fn equip(
        &mut self,
        machine: &'a Machine,
        tool_length: f64,
    ) -> Result<(), Box<Diagnostic>> {
        let held = self.settings[self.setting].0;
        self.machine = machine;
        self.tool_length = tool_length;
        let placer = self.placer_held(&held)?;
        self.judge.machine = machine;
        self.tries_positions = tries_positions(machine);
        self.trellis = Trellis::new(machine, &placer);
        self.settings = vec![(held, Rc::new(placer))];
        self.setting = 0;
        Ok(())
    }

    /// A redundant axis stands at another value from the next point on; false if it is not redundant.
    ///
    /// # Errors
    /// What the machine lacks for being solved there.
    pub(crate) fn index(
        &mut self,
        joint: usize,
        value: f64,
        possible: bool,
    ) -> Result<bool, Box<Diagnostic>> {
        if !self.machine.redundant().contains(&joint) {
            return Ok(false);
        }
        if !possible {
            return Ok(true);
        }
        let mut held = self.settings[self.setting].0;
        held[joint] = value;
        if self.settings.len() > MOST_SETTINGS {
            // All points are settled: the setting in use is all that is still needed.
            let present = self.settings.swap_remove(self.setting);
            self.settings = vec![present];
            self.setting = 0;
            for layer in &mut self.trellis.layers {
                layer.setting = 0;
            }
        }
        self.setting = self.setting_for(&held)?;
        Ok(true)
    }

    /// What solves points with these values of the redundant axes.
    fn placer_held(&self, held: &Joints) -> Result<Placer, Box<Diagnostic>> {
        let placer = Placer::for_machine(self.machine, &self.format, self.tool_length, held)?;
        Ok(if self.vectors { placer.by_vector(self.machine) } else { placer })
    }

    /// The setting with these values of the redundant axes.
    pub(super) fn setting_for(&mut self, held: &Joints) -> Result<usize, Box<Diagnostic>> {
        let known = self.settings.iter().position(|(known, _)| known == held);
        if let Some(known) = known {
            return Ok(known);
        }
        let placer = self.placer_held(held)?;
        self.settings.push((*held, Rc::new(placer)));
        Ok(self.settings.len() - 1)
    }

    /// Takes the next point where one state lives and goes on as it is: decided at once. None, and nothing taken, on
    /// any doubt; [`Route::add`] knows what to do then.
    #[inline]
    pub(crate) fn step(&mut self, line: u64, motion: &StraightMove) -> Option<ChosenPoint> {
        if !self.anchored || self.tries_positions {
            return None;
        }
        let placer = &self.settings[self.setting].1;
        let joints = self.trellis.step(line, motion, self.setting, placer)?;
        Some(ChosenPoint {
            line,
            motion: *motion,
            setting: self.setting,
            arrives: true,
            joints,
            rewind: None,
            changed: false,
            eased: false,
        })
    }

    /// Takes the next point. What is decided by it waits in [`Route::take_chosen`].
    ///
    /// # Errors
    /// Why the point cannot be reached, or the path not go on to it; it is left out.
    #[inline]
    pub(crate) fn add(&mut self, line: u64, motion: &StraightMove) -> Result<(), DroppedPoint> {
        // The next pass is begun with the usual search.
        self.trellis.wide &= motion.pace != MoveFeed::Rapid;
        let pushed = self.push(line, motion);
        if pushed.is_err() || !self.alive() {
            self.find_way(line, motion, pushed)?;
        }
        self.advance();
        Ok(())
    }

    /// Pushes a point in the present setting.
    #[inline]
    pub(super) fn push(
        &mut self,
        line: u64,
        motion: &StraightMove,
    ) -> Result<SolutionSummary, Unreachable> {
        self.trellis.push(
            line,
            motion,
            self.setting,
            &self.settings[self.setting].1,
            &self.near,
            &mut self.judge,
        )
    }

    /// Whether there is a way to stand at the newest point.
    #[inline]
    pub(super) fn alive(&self) -> bool {
        let newest = self.trellis.layers.last();
        newest.is_some_and(|layer| layer.count > 0)
    }

    /// Points that were decided since the last call, in the place of those in `chosen`.
    pub(crate) fn take_chosen(&mut self, chosen: &mut Vec<ChosenPoint>) {
        chosen.clear();
        std::mem::swap(&mut self.chosen, chosen);
    }

    /// Whether there are such points.
    #[inline]
    pub(crate) fn has_chosen(&self) -> bool {
        !self.chosen.is_empty()
    }
}
