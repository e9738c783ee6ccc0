//! The Fréchet distance of two polylines, exact, by the free-space diagram (Alt and Godau 1995): the truth that a
//! certificate is an upper bound of.

use nalgebra::Vector3;

use super::walk::within;

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
        free.map(|[low, high]| [low.max(least), high])
            .filter(|[low, high]| low <= high)
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
        let mut floor = if starts {
            begins(below(piece, 0))
        } else {
            None
        };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rng;

    /// Between fine samples the least of the greatest distances by dynamic programming (Eiter and Mannila 1994) is the
    /// Fréchet distance to within their step.
    fn discrete(a: &[V], b: &[V]) -> f64 {
        let mut row = vec![f64::INFINITY; b.len()];
        for (i, p) in a.iter().enumerate() {
            let mut corner = f64::INFINITY;
            for (j, q) in b.iter().enumerate() {
                let before = if i == 0 && j == 0 {
                    0.0
                } else {
                    let beside = if j > 0 { row[j - 1] } else { f64::INFINITY };
                    row[j].min(beside).min(corner)
                };
                corner = row[j];
                row[j] = before.max((p - q).norm());
            }
        }
        row[b.len() - 1]
    }

    fn fine(path: &[V], count: usize) -> Vec<V> {
        let legs = path.windows(2);
        let places = legs.flat_map(|leg| {
            (0..count).map(|step| leg[0] + (leg[1] - leg[0]) * (step as f64 / count as f64))
        });
        places.chain(path.last().copied()).collect()
    }

    #[test]
    fn the_diagram_agrees_with_brute_force() {
        let (rounds, mut rng): (_, Rng) = crate::randomised(60, 71);
        for round in rounds {
            let count = 2 + rng.pick(5);
            let path: Vec<V> = (0..count).map(|_| rng.point(5.0)).collect();
            let count = 2 + rng.pick(5);
            let curve: Vec<V> = (0..count).map(|_| rng.point(5.0)).collect();
            let exact = frechet(&curve, &path, 40.0);
            let brute = discrete(&fine(&curve, 60), &fine(&path, 60));
            // Neighbouring samples are no farther apart than this.
            let step = 2.0 * 5.0 * 3f64.sqrt() / 60.0;
            assert!(
                exact <= brute + 1e-6 && brute <= exact + step,
                "round {round}: {exact}, by brute force {brute}"
            );
        }
    }

    #[test]
    fn a_line_that_cannot_go_back_is_far_from_one_that_does() {
        let at = |x: f64| V::new(x, 0.0, 0.0);
        let path = [0.0, 5.145, 7.904, 9.67, 7.326, 10.002].map(at);
        let apart = frechet(&[at(0.0), at(10.002)], &path, 10.0);
        assert!((apart - (9.67 - 7.326) / 2.0).abs() < 1e-6, "{apart}");
    }
}
