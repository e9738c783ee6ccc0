//! The deviation of one block from one straight piece of the CL path, and what is proven of it.
//!
//! What is bounded is the deviation of the tool's control point from its chord at the same share of the block, and
//! that of the tool axis from the great circle between its ends. With a cutting edge of radius R, a circle about
//! the tool axis, every point of it is within the bound on the tip from the circle that is wanted, that about the
//! wanted axis: it strays with the control point, and the turn that takes one axis to the other takes one circle to
//! the other and moves each of its points by no more than R times the difference of the axes.
//!
//! All of this is worked out in floating point. What that rounds off is smaller than [`Placer::margin`], which each
//! bound holds.

use nalgebra::Vector3;
use post_plugin::{Curve, Deviation, ModelSession, Tolerance};

use super::bound::DeviationBound;
use super::certificate::{self, BlockDerivatives, DerivativeBound, chord_angle};
use super::even_turn::EvenTurn;
use super::heading;
use super::node::{PathNode, Placer};
use post_machine::description::{Machine, Moves, Tcp};
use post_machine::kinematics::orientation::angle;
use post_machine::kinematics::{Joints, Pose};

/// What the pieces of a move must stay within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MoveTolerances {
    /// Tip, mm; infinite where the control keeps the tip.
    pub tip: f64,
    /// Tool axis, radians; infinite in a rapid.
    pub axis: f64,
}

/// A block between two nodes, along a straight piece of the path, and what it must keep.
#[derive(Clone, Copy, Debug)]
pub struct NodeMove<'a> {
    /// Solves points put in.
    pub placer: &'a Placer,
    /// Where it begins.
    pub from: &'a PathNode,
    /// Where it ends.
    pub to: &'a PathNode,
    /// What its pieces must stay within.
    pub tolerances: MoveTolerances,
    /// The tip follows the words in a straight line by itself.
    pub control_keeps_tip: bool,
    /// A robot's control leads the tool straight, turned evenly about one direction. Joints that went evenly themselves
    /// would stray by so much at most, mm: so it is known where they go between.
    pub straight: Option<f64>,
}

/// How much room a move has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MoveRoom {
    /// A move on the part: the tolerance of cuts.
    Part,
    /// A rapid on the line of a tool that has cut, which may stand in the hole that it has made: the tolerance of cuts, by
    /// axes that go as they go at rapid.
    ToolLine,
    /// A move off the part: the tolerance of rapids.
    Free,
}

/// What the printed pose of a tool that is led straight misses by, at least four decimals of a mm and five of a degree.
const PRINTED: DeviationBound = DeviationBound { tip: 1e-4, axis: 1e-6 };

/// Between samples the certificate may be blind by this share of the tolerance.
const BLIND: f64 = 0.02;

/// What is over by this factor is over by more than rounding.
const CERTAIN: f64 = 1.0 + 1e-6;

/// A block that needs more samples than this to be certified is split instead.
const MOST_SAMPLES: f64 = 64.0;

impl<'n> NodeMove<'n> {
    /// A motion between two nodes, and what it must keep by its `room`, `chord` mm of that being spent already.
    #[inline]
    pub fn planned(
        machine: &Machine,
        placer: &'n Placer,
        chord: f64,
        room: MoveRoom,
        [from, to]: [&'n PathNode; 2],
    ) -> Self {
        let accuracy = &machine.accuracy;
        let (tip, axis) = match room {
            MoveRoom::Part => (accuracy.tolerance - placer.reserve(), accuracy.axis_tolerance),
            MoveRoom::ToolLine => (accuracy.tolerance, accuracy.axis_tolerance),
            MoveRoom::Free => (accuracy.rapid_tolerance, f64::INFINITY),
        };
        let straight = machine.control.moves == Moves::Straight && room == MoveRoom::Part;
        Self {
            placer,
            from,
            to,
            tolerances: MoveTolerances { tip: tip - chord, axis },
            control_keeps_tip: machine.control.tcp == Tcp::Control || straight,
            straight: straight.then_some(accuracy.rapid_tolerance),
        }
    }
}

impl NodeMove<'_> {
    /// The bound of the whole move, if the cheap certificate clears it: then no point is needed, whatever a
    /// model may think, and none is asked.
    #[inline]
    pub fn whole(&self) -> Option<DeviationBound> {
        let bound = self.bound(self.quick().0);
        self.tolerances.hold(bound).then_some(bound)
    }

    /// The tightest bound that needs no samples.
    pub fn measured(&self) -> DeviationBound {
        self.course(self.quick()).0
    }

    /// The tightest bound: where none at hand clears the move, it is sampled so densely that its bend can hide no
    /// more than a small share of the tolerance between them.
    pub fn certify(&self) -> DeviationBound {
        self.looked_at(self.known())
    }

    /// The bound and bend of [`NodeMove::known`], and where they do not clear the move, samples.
    pub(super) fn looked_at(
        &self,
        (bound, bend): (DeviationBound, DerivativeBound),
    ) -> DeviationBound {
        if self.tolerances.hold(bound) {
            return bound;
        }
        bound.least(self.sampled(bend))
    }

    /// Is the middle of the block so far off that no bound can clear it? Cheaper than any bound that is worth more
    /// than the quick one; what stands within tolerance in the middle may still be over elsewhere.
    ///
    /// A leading edge is not counted.
    pub(super) fn over_halfway(&self) -> bool {
        let (from, to) = (self.from, self.to);
        let pose = match self.even_turn() {
            Some(turn) => Pose { axis: turn.at(0.5), ..Pose::default() },
            None => self.placer.solver().chain().halfway(&from.trace, &to.trace),
        };
        let chord = from.target.tip * 0.5 + to.target.tip * 0.5;
        if (self.reached(&pose, 0.5) - chord).norm() > CERTAIN * self.tolerances.tip {
            return true;
        }
        // An angle is never less than its chord.
        let middle = (from.target.axis + to.target.axis).try_normalize(1e-3);
        middle.is_some_and(|axis| (pose.axis - axis).norm() > CERTAIN * self.tolerances.axis)
    }

    /// A bound that needs no samples and its bend: the cheap one where it clears the move, else the tightest.
    pub(super) fn known(&self) -> (DeviationBound, DerivativeBound) {
        let quick = self.quick();
        let bound = self.bound(quick.0);
        if self.tolerances.hold(bound) {
            return (bound, quick.0);
        }
        self.course(quick)
    }

    /// The bend that norms alone give, and how far the wanted directions turn, radians.
    #[inline]
    pub(super) fn quick(&self) -> (DerivativeBound, f64) {
        // An upper bound on the sweep is enough, and cheaper than the angle.
        let (from, to) = (&self.from.target, &self.to.target);
        let chain = self.placer.solver().chain();
        let sweep = chord_angle((from.axis - to.axis).norm());
        let mut bend = certificate::quick(chain, &self.from.trace, &self.to.trace, sweep);
        if chain.edge().is_some() {
            bend.lead = bend.turn + heading::bend(from, to);
        }
        match self.straight {
            Some(room) => (self.led_straight(bend, sweep, room), sweep),
            None => (bend, sweep),
        }
    }

    /// The bend of a tool that is led straight; without end where joints that went evenly by themselves, which `evenly`
    /// bounds, would stray by more than `room`, mm.
    fn led_straight(&self, evenly: DerivativeBound, sweep: f64, room: f64) -> DerivativeBound {
        let chain = self.placer.solver().chain();
        let strays = |bend: f64| certificate::deviation(0.0, bend) > room;
        let tight = || {
            let course = BlockDerivatives::new(chain, &self.from.trace, &self.to.trace);
            course.bend(self.from.target.axis, self.to.target.axis, sweep).tip
        };
        let tip = if strays(evenly.tip) && strays(tight()) { f64::INFINITY } else { 0.0 };
        let turn = self.even_turn().map_or(f64::INFINITY, |turn| turn.bend());
        DerivativeBound { tip, axis: turn + sweep * sweep, turn, lead: evenly.lead }
    }

    /// How the tool turns where it is led straight.
    fn even_turn(&self) -> Option<EvenTurn> {
        self.straight?;
        let solver = self.placer.solver();
        let [from, to] = [self.from, self.to].map(|node| solver.stand(&node.trace.joints));
        Some(EvenTurn::between(from?, to?))
    }

    /// The bound by the block's second derivatives, and its bend; see [`NodeMove::quick`].
    pub(super) fn course(
        &self,
        (quick, sweep): (DerivativeBound, f64),
    ) -> (DeviationBound, DerivativeBound) {
        if self.straight.is_some() {
            return (self.bound(quick), quick);
        }
        let (from, to) = (self.from, self.to);
        let chain = self.placer.solver().chain();
        let course = BlockDerivatives::new(chain, &from.trace, &to.trace);
        let tight = course.bend(from.target.axis, to.target.axis, sweep);
        let bend = DerivativeBound {
            tip: quick.tip.min(tight.tip),
            axis: quick.axis.min(tight.axis),
            turn: quick.turn.min(tight.turn),
            lead: quick.lead,
        };
        let mut bound = self.bound(bend);
        if !self.control_keeps_tip && bound.tip.is_finite() {
            let followed =
                course.tip([from.off(), to.off()]) + self.edge_bow(bend) + self.margin().tip;
            bound.tip = bound.tip.min(followed);
        }
        (bound, bend)
    }

    /// The bound that a bend proves; none is, where the control would go another way.
    #[inline]
    pub(super) fn bound(&self, bend: DerivativeBound) -> DeviationBound {
        let (from, to) = (self.from, self.to);
        if self.goes_another_way() {
            return DeviationBound::NONE;
        }
        let axis_ends = certificate::larger(from.axis_error, to.axis_error);
        let tip_ends = certificate::larger(from.tip_error, to.tip_error);
        let turns = certificate::larger(bend.axis, bend.lead);
        let margin = self.margin();
        DeviationBound {
            tip: certificate::deviation(tip_ends, self.tip_bend(bend))
                + self.edge_bow(bend)
                + margin.tip,
            axis: chord_angle(certificate::deviation(axis_ends, turns)) + margin.axis,
        }
    }

    /// What the control point bends by. A control that keeps the tip straight swings the points above it.
    #[inline]
    fn tip_bend(&self, bend: DerivativeBound) -> f64 {
        if !self.control_keeps_tip {
            return bend.tip;
        }
        let swing = libm::fabs(self.placer.control_point().along) * bend.turn;
        if self.straight.is_some() { swing + bend.tip } else { swing }
    }

    /// What floating point rounds off at most.
    #[inline]
    fn margin(&self) -> DeviationBound {
        let (from, to) = (&self.from.trace.joints, &self.to.trace.joints);
        let margin = self.placer.margin(from, to);
        match self.straight {
            Some(_) => {
                DeviationBound { tip: margin.tip + PRINTED.tip, axis: margin.axis + PRINTED.axis }
            }
            None => margin,
        }
    }

    /// How far a cutting edge strays beyond the control point at most, mm; no model sees that.
    #[inline]
    pub(super) fn edge_bow(&self, bend: DerivativeBound) -> f64 {
        let radius = self.placer.control_point().radius;
        if radius == 0.0 {
            return 0.0;
        }
        let ends = self.from.axis_error.max(self.to.axis_error);
        radius * certificate::deviation(ends, bend.axis)
    }

    /// The control would turn an axis the other way round.
    #[inline]
    pub(super) fn goes_another_way(&self) -> bool {
        let (from, to) = (&self.from.trace.joints, &self.to.trace.joints);
        self.placer.turns_too_far(from, to) || self.placer.led_elsewhere(from, to)
    }

    fn sampled(&self, bend: DerivativeBound) -> DeviationBound {
        if self.goes_another_way() {
            return DeviationBound::NONE;
        }
        let tolerances = self.tolerances;
        let tip_bend = self.tip_bend(bend);
        let axis_bend = if tolerances.axis.is_infinite() { 0.0 } else { bend.axis.max(bend.lead) };
        let needed = (tip_bend / (8.0 * BLIND * tolerances.tip))
            .max(axis_bend / (8.0 * BLIND * tolerances.axis));
        let count = libm::ceil(libm::sqrt(needed)).clamp(1.0, MOST_SAMPLES);
        let path = self.path();
        let mut tip = self.from.tip_error.max(self.to.tip_error);
        let mut axis = self.from.axis_error.max(self.to.axis_error);
        for step in 1..count as u32 {
            let deviation = path.deviation(f64::from(step) / count);
            tip = tip.max(Vector3::from(deviation.tip).norm());
            axis = axis.max(Vector3::from(deviation.axis).norm().to_radians());
        }
        let blind = 1.0 / (8.0 * count * count);
        DeviationBound {
            tip: tip + tip_bend * blind + self.edge_bow(bend) + self.margin().tip,
            axis: chord_angle(axis + axis_bend * blind) + self.margin().axis,
        }
    }

    /// What the CL file asks for at the share `t` of the way: the control point on the chord, the tool axis on the
    /// great circle, the heading of a leading edge on its own.
    pub fn target(&self, t: f64) -> Pose {
        let (from, to) = (&self.from.target, &self.to.target);
        let edge = if self.placer.solver().chain().edge().is_some() {
            OrientationArc::new(from.edge, to.edge).at(t)
        } else {
            Vector3::zeros()
        };
        Pose {
            tip: from.tip * (1.0 - t) + to.tip * t,
            axis: OrientationArc::new(from.axis, to.axis).at(t),
            edge,
        }
    }

    /// The curve that a model fits to the deviation.
    ///
    /// # Errors
    /// The model's own, if it cannot answer.
    pub fn fit(&self, model: &mut dyn ModelSession) -> Result<Curve, String> {
        let tolerance =
            Tolerance { tip: self.tolerances.tip, axis: self.tolerances.axis.to_degrees() };
        let path = self.path();
        model.fit(&tolerance, &mut |ts, out| {
            for (t, out) in ts.iter().zip(out) {
                *out = path.deviation(*t);
            }
        })
    }

    /// Where the control point is at the share `t` of this block, at which the chain has this pose: there, or above the
    /// tip that the control keeps on its line.
    pub(super) fn reached(&self, pose: &Pose, t: f64) -> Vector3<f64> {
        if !self.control_keeps_tip {
            return pose.tip;
        }
        let along = self.placer.control_point().along;
        let tip = |node: &PathNode| node.tip - node.trace.pose.axis * along;
        tip(self.from) * (1.0 - t) + tip(self.to) * t + pose.axis * along
    }

    /// Pose of the interpolated axes minus the CL path at the share `t` of this block.
    pub fn deviation(&self, t: f64) -> Deviation {
        self.path().deviation(t)
    }

    /// What is the same for every place along this block.
    fn path(&self) -> OrientationPath<'_> {
        let (from, to) = (&self.from.target, &self.to.target);
        let follows = self.placer.solver().chain().edge().is_some();
        OrientationPath {
            block: self,
            axis: OrientationArc::new(from.axis, to.axis),
            even: self.even_turn(),
            heading: follows.then(|| OrientationArc::new(from.edge, to.edge)),
        }
    }
}

/// A block beside the great circles that tool axis and heading are to go along.
struct OrientationPath<'a> {
    block: &'a NodeMove<'a>,
    axis: OrientationArc,
    /// How the tool turns where it is led straight.
    even: Option<EvenTurn>,
    /// Great circle of the heading of a tool with a leading edge.
    heading: Option<OrientationArc>,
}

impl OrientationPath<'_> {
    /// Deviation at the share `t`: see [`NodeMove::deviation`].
    fn deviation(&self, t: f64) -> Deviation {
        let (from, to) = (self.block.from, self.block.to);
        let pose = match &self.even {
            Some(even) => Pose { axis: even.at(t), ..Pose::default() },
            None => {
                let joints = between(&from.trace.joints, &to.trace.joints, t);
                self.block.placer.solver().chain().forward(&joints)
            }
        };
        let chord = from.target.tip * (1.0 - t) + to.target.tip * t;
        let tip = self.block.reached(&pose, t) - chord;
        let axis = self.axis.at(t);
        let mut turn = turned(axis, pose.axis);
        if let Some(heading) = &self.heading {
            let wanted = Pose { axis, edge: heading.at(t), ..Pose::default() };
            let edge = turned(wanted.edge_across(), pose.edge);
            // Whichever of axis and edge is farther off.
            if edge.norm() > turn.norm() {
                turn = edge;
            }
        }
        Deviation { tip: tip.into(), axis: turn.into() }
    }
}

impl MoveTolerances {
    /// Does a bound keep them?
    #[inline]
    pub fn hold(&self, bound: DeviationBound) -> bool {
        bound.tip <= self.tip && bound.axis <= self.axis
    }
}

/// Axis values at the share `t` of the way from one set to another.
#[inline]
pub(super) fn between(from: &Joints, to: &Joints, t: f64) -> Joints {
    std::array::from_fn(|joint| from[joint] * (1.0 - t) + to[joint] * t)
}

/// The turn from `wanted` to `reached`, degrees, along its axis.
fn turned(wanted: Vector3<f64>, reached: Vector3<f64>) -> Vector3<f64> {
    let cross = wanted.cross(&reached);
    let sine = cross.norm();
    if sine > 0.0 {
        cross * (libm::atan2(sine, wanted.dot(&reached)).to_degrees() / sine)
    } else {
        Vector3::zeros()
    }
}

/// The great circle between two unit vectors.
struct OrientationArc {
    from: Vector3<f64>,
    to: Vector3<f64>,
    /// The angle between them, radians, and its sine.
    sweep: f64,
    sine: f64,
}

impl OrientationArc {
    fn new(from: Vector3<f64>, to: Vector3<f64>) -> Self {
        let sweep = angle(from, to);
        Self { from, to, sweep, sine: libm::sin(sweep) }
    }

    /// The unit vector at the share `t` of the way.
    fn at(&self, t: f64) -> Vector3<f64> {
        let Self { from, to, sweep, sine } = *self;
        if sine < 1e-9 {
            return (from * (1.0 - t) + to * t).try_normalize(1e-9).unwrap_or(from);
        }
        (from * libm::sin((1.0 - t) * sweep) + to * libm::sin(t * sweep)) / sine
    }
}
