//! Ways cut into pieces so short that each may be taken for straight.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, Pose};
use post_motion::path::joints_between;

use super::place::{PlaceBound, ToolPlace};
use crate::course::CoursePiece;
use crate::{Curve, Interpolation, MachineState, Motion};

/// Halvings of a piece at most: what bends more than this says is no way of a machine.
const DEEPEST: u32 = 14;

/// A turn that is first looked at in pieces no larger than this, radians: the middle of a larger one may lie on its
/// chord by chance.
const TURN: f64 = 0.12;

/// Square of a chord between tool axes whose angle is certainly less than [`TURN`].
const NARROW: f64 = 0.01;

/// A bound that rounding alone does not reach, mm.
const ROUNDED: f64 = 1e-9;

/// Puts the places at the ends of the pieces of a way after `places`, without that of its beginning: the way begins at
/// `start`, and ends at `end`.
fn chop(
    at: impl Fn(f64) -> ToolPlace,
    [mut start, end]: [ToolPlace; 2],
    first: usize,
    sag: &PlaceBound,
    places: &mut Vec<ToolPlace>,
) {
    let (mut low, count) = (0.0, first.max(1));
    for piece in 1..=count {
        let high = piece as f64 / count as f64;
        let next = if piece < count { at(high) } else { end };
        halve(&at, (low, &start), (high, &next), sag, DEEPEST, places);
        (low, start) = (high, next);
    }
}

fn halve(
    at: &impl Fn(f64) -> ToolPlace,
    from: (f64, &ToolPlace),
    to: (f64, &ToolPlace),
    sag: &PlaceBound,
    left: u32,
    places: &mut Vec<ToolPlace>,
) {
    let share = 0.5 * (from.0 + to.0);
    let middle = at(share);
    if left == 0 || middle.within(&from.1.between(to.1, 0.5), sag) {
        places.push(*to.1);
        return;
    }
    halve(at, from, (share, &middle), sag, left - 1, places);
    halve(at, (share, &middle), to, sag, left - 1, places);
}

/// Where the way of the last motion ended, so that it is not worked out again as the beginning of the next.
#[derive(Debug, Default)]
pub(super) struct LastEnd {
    /// What held then.
    state: Option<Arc<MachineState>>,
    /// The control led the axes, not the tip.
    axes: bool,
    /// Axis values that the place was worked out for, mm and radians.
    joints: Joints,
    /// Where the tip was led, mm.
    tip: Vector3<f64>,
    place: ToolPlace,
}

impl LastEnd {
    /// The beginning of a way, if it is this end.
    fn begins(&self, motion: &Motion) -> Option<ToolPlace> {
        let state = self.state.as_ref()?;
        let same = Arc::ptr_eq(state, &motion.state)
            && self.axes == (motion.way == Interpolation::Axes)
            && self.joints == motion.from.joints
            && (self.axes || self.tip == motion.from.pose.tip);
        same.then_some(self.place)
    }

    fn keep(&mut self, motion: &Motion, place: ToolPlace) {
        if !self.state.as_ref().is_some_and(|state| Arc::ptr_eq(state, &motion.state)) {
            self.state = Some(Arc::clone(&motion.state));
        }
        self.axes = motion.way == Interpolation::Axes;
        self.joints = joints_between([&motion.from, &motion.to], 1.0);
        let tips = [&motion.from, &motion.to].map(|stance| stance.pose.tip);
        self.tip = Curve::Straight.at(tips, 1.0);
        self.place = place;
    }
}

/// The way of a motion after its beginning. `last` is of the motion before it.
pub(super) fn motion(
    motion: &Motion,
    along: f64,
    sag: &PlaceBound,
    last: &mut LastEnd,
    places: &mut Vec<ToolPlace>,
) {
    let turns = AxisTurns::of(motion);
    if turns.most == 0.0 && !motion.way.is_curved() {
        places.push(ToolPlace::new(&motion.to.pose, along));
        return;
    }
    let at = |t| ToolPlace::new(&motion.at(t), along);
    let first = || first_pieces(motion.way.curve(), turns.most).unwrap_or(1);
    // Neither on a curve nor where the tool is led as a whole or along great circles do the axis values alone say where it points.
    if !matches!(motion.way, Interpolation::Axes | Interpolation::Tip(Curve::Straight)) {
        return chop(at, [at(0.0), at(1.0)], first(), sag, places);
    }
    let end = known_end(motion).map_or_else(|| at(1.0), |end| ToolPlace::new(&end, along));
    debug_assert_eq!(end, at(1.0));
    if turns_little(motion, turns.all, along, sag) {
        return places.push(end);
    }
    let start = last.begins(motion).unwrap_or_else(|| at(0.0));
    debug_assert_eq!(start, at(0.0));
    last.keep(motion, end);
    chop(at, [start, end], first(), sag, places);
}

/// How far the rotary axes turn on a motion, radians.
struct AxisTurns {
    /// That which turns farthest.
    most: f64,
    /// All together.
    all: f64,
}

impl AxisTurns {
    #[inline]
    fn of(motion: &Motion) -> Self {
        let mut turns = Self { most: 0.0, all: 0.0 };
        for (index, joint) in motion.state.solver.chain().joints().iter().enumerate() {
            if joint.rotary {
                let turn = (motion.to.joints[index] - motion.from.joints[index]).abs();
                turns.most = turns.most.max(turn);
                turns.all += turn;
            }
        }
        turns
    }
}

/// The end of a straight way as [`Motion::at`] has it, if that is the pose which the program has led the tool to: the
/// chain has made it of the axis values, or of them and the tip.
fn known_end(motion: &Motion) -> Option<Pose> {
    let (ends, to) = ([&motion.from, &motion.to], &motion.to.pose);
    if joints_between(ends, 1.0) != motion.to.joints {
        return None;
    }
    match motion.way {
        Interpolation::Axes if motion.state.tcp || motion.state.plane.is_some() => None,
        Interpolation::Axes => Some(*to),
        _ => Some(Pose { tip: Curve::Straight.at(ends.map(|end| end.pose.tip), 1.0), ..*to }),
    }
}

/// Whether the tool turns, by `turn` in all, by so little that the way is straight within `sag`: a direction that turns by w in all strays from
/// its chord by w²/8 at most, and a tip that no control keeps by as much of what its arms make of it.
#[inline]
fn turns_little(motion: &Motion, turn: f64, along: f64, sag: &PlaceBound) -> bool {
    if motion.to.pose.edge != Vector3::zeros() {
        return false;
    }
    let bow = turn * turn / 8.0 + ROUNDED;
    let room = sag.point - (bow * along.abs() + ROUNDED);
    if turn >= TURN || bow > sag.axis || room < 0.0 {
        return false;
    }
    let ends = [&motion.from.joints, &motion.to.joints];
    motion.way != Interpolation::Axes
        || motion.state.solver.chain().bend_by_arms(ends) / 8.0 <= room
}

/// The way of a piece of a course after its beginning.
pub(super) fn piece(
    piece: &CoursePiece,
    along: f64,
    sag: &PlaceBound,
    places: &mut Vec<ToolPlace>,
) {
    match straight_piece(piece, along, sag) {
        Some(Straight::Stays) => return places.push(ToolPlace::new(&piece.to, along)),
        Some(Straight::Turns) => {
            return places.push(ToolPlace::new(&piece.at(1.0, along), along));
        }
        None => {}
    }
    let (from, to) = (ToolPlace::new(&piece.from, along), ToolPlace::new(&piece.to, along));
    match first_pieces(&piece.curve, from.apart(&to).axis) {
        None => places.push(to),
        Some(first) => {
            let at = |t| ToolPlace::new(&piece.at(t, along), along);
            chop(at, [at(0.0), at(1.0)], first, sag, places);
        }
    }
}

/// The point at the end of a piece of a course that [`piece`] makes one of within `sag`, if that is known without looking
/// at the way; the tip is what is guided.
pub(super) fn straight_end(piece: &CoursePiece, sag: &PlaceBound) -> Option<Vector3<f64>> {
    let ends = [&piece.from, &piece.to];
    straight_piece(piece, 0.0, sag).map(|straight| straight.end(ends))
}

/// [`straight_end`] of a straight cut between two poses.
pub(super) fn straight_cut_end(ends: [&Pose; 2], sag: &PlaceBound) -> Option<Vector3<f64>> {
    straight(ends, 0.0, sag).map(|straight| straight.end(ends))
}

/// The place at the end of a straight cut between two poses that [`piece`] makes one piece of within `sag`, if that is known
/// without looking at the way; `end` is where the great circle between their tool axes ends.
#[inline]
pub(super) fn straight_cut(
    ends: [&Pose; 2],
    end: Vector3<f64>,
    along: f64,
    sag: &PlaceBound,
) -> Option<ToolPlace> {
    match straight(ends, along, sag)? {
        Straight::Stays => Some(ToolPlace::new(ends[1], along)),
        Straight::Turns => {
            let edge = Vector3::zeros();
            let tip = Curve::Straight.tip(ends, end, along, 1.0);
            Some(ToolPlace::new(&Pose { tip, axis: end, edge }, along))
        }
    }
}

/// A piece of a course that is straight.
enum Straight {
    /// The tool keeps its axis.
    Stays,
    /// The tool turns by little.
    Turns,
}

impl Straight {
    /// The tip at its end.
    fn end(&self, ends: [&Pose; 2]) -> Vector3<f64> {
        match self {
            Self::Stays => ends[1].tip,
            Self::Turns => Curve::Straight.at(ends.map(|pose| pose.tip), 1.0),
        }
    }
}

/// [`straight`] of a piece; none where it is curved.
fn straight_piece(piece: &CoursePiece, along: f64, sag: &PlaceBound) -> Option<Straight> {
    let is_straight = piece.curve == Curve::Straight;
    is_straight.then(|| straight([&piece.from, &piece.to], along, sag)).flatten()
}

/// Whether a piece of a course is straight within `sag`, as far as the chord between its tool axes tells: the middle of the
/// great circle between two unit vectors is farther from that of their chord c by 1 - √(1 - c²/4), and that is less
/// than c²/4.
#[inline]
fn straight([from, to]: [&Pose; 2], along: f64, sag: &PlaceBound) -> Option<Straight> {
    let zero = Vector3::zeros();
    if from.edge != zero || to.edge != zero {
        return None;
    }
    let square = (from.axis - to.axis).norm_squared();
    if square == 0.0 {
        return Some(Straight::Stays);
    }
    let bow = 0.25 * square + f64::EPSILON;
    let within = bow <= sag.axis && bow * along.abs() + ROUNDED <= sag.point;
    (square < NARROW && within).then_some(Straight::Turns)
}

/// In how many pieces a curve is looked at first on which the tool turns by so much, radians; none of what is straight.
fn first_pieces(curve: &Curve, turn: f64) -> Option<usize> {
    let poles = match curve {
        Curve::Straight if turn == 0.0 => return None,
        Curve::Spline(way) => 2 * way.poles.len(),
        _ => 0,
    };
    // A number of pieces, bounded whatever the program says of turns.
    let pieces = (libm::ceil(turn.max(curve.turn()) / TURN).max(1.0) as usize).min(4096);
    Some(poles + pieces)
}
