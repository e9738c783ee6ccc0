//! Ways cut into pieces so short that each may be taken for straight.

use super::place::{PlaceBound, ToolPlace};
use crate::course::{Curve, Piece};
use crate::{Interpolation, Motion};

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
    let chain = motion.state.solver.chain();
    let mut turn: f64 = 0.0;
    for (index, joint) in chain.joints().iter().enumerate() {
        if joint.rotary {
            turn = turn.max((motion.to.joints[index] - motion.from.joints[index]).abs());
        }
    }
    let first = match &motion.way {
        Interpolation::Axes | Interpolation::Tip | Interpolation::TipAndAxis if turn == 0.0 => {
            places.push(ToolPlace::new(&motion.to.pose, along));
            return;
        }
        Interpolation::Axes | Interpolation::Tip | Interpolation::TipAndAxis => pieces_of(turn),
        Interpolation::Arc { sweep, .. } => pieces_of(turn.max(sweep.abs())),
        Interpolation::Spline(way) => 2 * way.poles.len() + pieces_of(turn),
    };
    chop(|t| ToolPlace::new(&motion.at(t), along), first, sag, places);
}

/// The way of a piece of a course after its beginning.
pub(super) fn piece(piece: &Piece, along: f64, sag: &PlaceBound, places: &mut Vec<ToolPlace>) {
    let (from, to) = (ToolPlace::new(&piece.from, along), ToolPlace::new(&piece.to, along));
    let turn = from.apart(&to).axis;
    let first = match &piece.curve {
        Curve::Straight if turn == 0.0 => {
            places.push(to);
            return;
        }
        Curve::Straight => pieces_of(turn),
        Curve::Arc { sweep, .. } => pieces_of(turn.max(sweep.abs())),
        Curve::Spline(way) => 2 * way.poles.len() + pieces_of(turn),
    };
    chop(|t| ToolPlace::new(&piece.at(t, along), along), first, sag, places);
}

fn pieces_of(turn: f64) -> usize {
    // A number of pieces, bounded whatever the program says of turns.
    (libm::ceil(turn / TURN).max(1.0) as usize).min(4096)
}
