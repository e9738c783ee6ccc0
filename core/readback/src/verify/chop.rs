//! Ways cut into pieces so short that each may be taken for straight.

use super::place::{PlaceBound, ToolPlace};
use crate::course::CoursePiece;
use crate::{Curve, Motion};

/// Halvings of a piece at most: what bends more than this says is no way of a machine.
const DEEPEST: u32 = 14;

/// A turn that is first looked at in pieces no larger than this, radians: the middle of a larger one may lie on its
/// chord by chance.
const TURN: f64 = 0.12;

/// Puts the places at the ends of the pieces of a way after `places`, without that of its beginning.
fn chop(
    at: impl Fn(f64) -> ToolPlace,
    first: usize,
    sag: &PlaceBound,
    places: &mut Vec<ToolPlace>,
) {
    let mut start = at(0.0);
    let (mut low, count) = (0.0, first.max(1));
    for piece in 1..=count {
        let high = piece as f64 / count as f64;
        let end = at(high);
        halve(&at, (low, &start), (high, &end), sag, DEEPEST, places);
        (low, start) = (high, end);
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

/// The way of a motion after its beginning.
pub(super) fn motion(motion: &Motion, along: f64, sag: &PlaceBound, places: &mut Vec<ToolPlace>) {
    let joints = motion.state.solver.chain().joints().iter().enumerate();
    let turns = joints.filter(|(_, joint)| joint.rotary).map(|(index, _)| {
        let [from, to] = [&motion.from, &motion.to].map(|end| end.joints[index]);
        (to - from).abs()
    });
    match first_pieces(motion.way.curve(), turns.fold(0.0, f64::max)) {
        None => places.push(ToolPlace::new(&motion.to.pose, along)),
        Some(first) => chop(|t| ToolPlace::new(&motion.at(t), along), first, sag, places),
    }
}

/// The way of a piece of a course after its beginning.
pub(super) fn piece(
    piece: &CoursePiece,
    along: f64,
    sag: &PlaceBound,
    places: &mut Vec<ToolPlace>,
) {
    let (from, to) = (ToolPlace::new(&piece.from, along), ToolPlace::new(&piece.to, along));
    match first_pieces(&piece.curve, from.apart(&to).axis) {
        None => places.push(to),
        Some(first) => chop(|t| ToolPlace::new(&piece.at(t, along), along), first, sag, places),
    }
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
