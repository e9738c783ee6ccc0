//! The Fréchet distance of two polylines, exact, by the free-space diagram (Alt and Godau 1995): the truth that a
//! certificate is an upper bound of.

use nalgebra::Vector3;

use crate::within;

type V = Vector3<f64>;

/// Shares of an edge that can be reached.
type Reach = Option<[f64; 2]>;

/// Can `curve` and `path` be gone along together, neither ever back, so that they are never farther apart than `apart`
/// says for the piece of `curve` that is gone along? One length a piece; where two pieces meet, both hold.
pub fn keeps_within(curve: &[V], apart: &[f64], path: &[V]) -> bool {
    assert_eq!(curve.len(), apart.len() + 1, "a length a piece");
    let (pieces, legs) = (apart.len(), path.len() - 1);
    let at_vertex = |piece: usize| match piece {
        0 => apart[0],
        piece if piece == pieces => apart[pieces - 1],
        piece => apart[piece - 1].min(apart[piece]),
    };
    // Beside a vertex of the curve: shares of a leg that are near enough.
    let left =
        |piece: usize, leg: usize| within(curve[piece], path[leg], path[leg + 1], at_vertex(piece));
    // Beside a vertex of the path: shares of a piece that are near enough.
    let below =
        |piece: usize, leg: usize| within(path[leg], curve[piece], curve[piece + 1], apart[piece]);
    let behind = |free: Reach, least: f64| {
        free.map(|[low, high]| [low.max(least), high]).filter(|[low, high]| low <= high)
    };
    let begins = |free: Reach| free.filter(|[low, _]| *low == 0.0);
    let ends = |reach: Reach| reach.is_some_and(|[_, high]| high == 1.0);
    // Along the path while the curve stands at its start.
    let mut column: Vec<Reach> = vec![None; legs];
    let mut on = true;
    for (leg, reach) in column.iter_mut().enumerate() {
        *reach = if on { begins(left(0, leg)) } else { None };
        on = ends(*reach);
    }
    let mut starts = true;
    for piece in 0..pieces {
        // Along the curve while the path stands at its start.
        let mut floor = if starts { begins(below(piece, 0)) } else { None };
        starts = ends(floor);
        for (leg, side) in column.iter_mut().enumerate() {
            let (right, top) = (left(piece + 1, leg), below(piece, leg + 1));
            let out = match (floor, *side) {
                (Some(_), _) => right,
                (None, Some([least, _])) => behind(right, least),
                (None, None) => None,
            };
            let up = match (*side, floor) {
                (Some(_), _) => top,
                (None, Some([least, _])) => behind(top, least),
                (None, None) => None,
            };
            (*side, floor) = (out, up);
        }
    }
    ends(column[legs - 1])
}

/// The Fréchet distance of two polylines, to a billionth of `most`, which is more than it.
pub fn frechet(curve: &[V], path: &[V], most: f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..30 {
        let middle = (low + high) / 2.0;
        if keeps_within(curve, &vec![middle; curve.len() - 1], path) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}
