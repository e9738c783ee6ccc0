//! One move after points were put in.

use nalgebra::Vector3;
use post_plugin::ModelSession;

use super::curve::peak;
use post_posting::accuracy::{
    LinearPiece, LineariseError, Lineariser, NodeMove, NodeRun, PathNode,
};

/// A move after points were put in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placed {
    /// How many points.
    pub points: u32,
    /// The largest certified deviation of a piece, mm.
    pub certified: f64,
    /// The largest deviation of a piece by samples, mm.
    pub peak: f64,
}

/// Cuts one move into pieces and adds the largest deviation of each, mm, to `pieces`.
///
/// # Errors
/// Why it cannot be done.
pub fn place(
    cut: &NodeMove<'_>,
    linearise: &mut Lineariser,
    model: &mut dyn ModelSession,
    pieces: &mut Vec<f64>,
) -> Result<Placed, LineariseError> {
    let nodes = [*cut.from, *cut.to];
    split(cut, &nodes, linearise, model)?;
    let mut placed = Placed::default();
    each(cut, linearise.pieces(), |block, piece| {
        let size = peak(|t| strays(block, t).norm()).size;
        placed.points += u32::from(piece.to.t < 1.0);
        placed.certified = placed.certified.max(piece.bound.tip);
        placed.peak = placed.peak.max(size);
        pieces.push(size);
    });
    Ok(placed)
}

/// Cuts one move between its `nodes` into pieces.
pub(super) fn split(
    cut: &NodeMove<'_>,
    nodes: &[PathNode; 2],
    linearise: &mut Lineariser,
    model: &mut dyn ModelSession,
) -> Result<(), LineariseError> {
    let run = NodeRun {
        placer: cut.placer,
        nodes,
        tolerances: cut.tolerances,
        control_keeps_tip: cut.control_keeps_tip,
        straight: cut.straight,
        balances: true,
    };
    linearise.split(&run, model).map_err(|(_, stuck)| stuck)
}

/// Every piece of a move as a move of its own.
pub(super) fn each<'m>(
    cut: &NodeMove<'m>,
    pieces: &[LinearPiece],
    mut look: impl FnMut(&NodeMove<'_>, &LinearPiece),
) {
    let mut from = PathNode { t: 0.0, ..*cut.from };
    for piece in pieces {
        let block = NodeMove { from: &from, to: &piece.to, ..*cut };
        look(&block, piece);
        from = piece.to;
    }
}

/// Deviation of the control point at the share `t` of a block, mm, part frame.
pub(super) fn strays(block: &NodeMove<'_>, t: f64) -> Vector3<f64> {
    block.deviation(t).tip.into()
}
