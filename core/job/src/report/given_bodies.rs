//! Fixtures and the stock of a machine file, as the page draws them.

use nalgebra::Vector3;
use post_report::solid::{DrawnSolid, Vertex};

/// Flat sides of a cylinder as it is drawn.
const SIDES: usize = 24;

/// A box between two corners.
pub(super) fn block([low, high]: [Vector3<f64>; 2]) -> DrawnSolid {
    let corner = |bits: usize| -> Vertex {
        [0, 1, 2].map(|at| if bits >> at & 1 == 0 { low[at] } else { high[at] })
    };
    let mut solid = DrawnSolid::default();
    for axis in 0..3 {
        let [next, last] = [1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3)];
        for side in [0, 1 << axis] {
            let [a, b, c, d] = [side, side | next, side | next | last, side | last].map(corner);
            // Seen from outside they go round left-handed or right-handed.
            let faces = if side == 0 { [[a, c, b], [a, d, c]] } else { [[a, b, c], [a, c, d]] };
            solid.triangles.extend(faces);
        }
        let along = |bits: usize| [corner(bits), corner(bits | 1 << axis)];
        solid.edges.extend([0, next, last, next | last].map(along));
    }
    solid
}

/// Places of a circle about `middle`, the first again as the last.
fn ring(middle: Vector3<f64>, axis: Vector3<f64>, radius: f64) -> Vec<Vertex> {
    let aside = if libm::fabs(axis.z) < 0.9 { Vector3::z() } else { Vector3::x() };
    let across = axis.cross(&aside).normalize();
    let place = |side: usize| {
        let angle = std::f64::consts::TAU * (side % SIDES) as f64 / SIDES as f64;
        let out = across * libm::cos(angle) + axis.cross(&across) * libm::sin(angle);
        (middle + out * radius).into()
    };
    (0..=SIDES).map(place).collect()
}

/// A cylinder between the middles of its ends.
pub(super) fn cylinder([one, other]: [Vector3<f64>; 2], radius: f64) -> DrawnSolid {
    let axis = (other - one).try_normalize(1e-9).unwrap_or_else(Vector3::z);
    let [low, high] = [one, other].map(|end| ring(end, axis, radius));
    let mut solid = DrawnSolid::default();
    for (from, to) in low.windows(2).zip(high.windows(2)) {
        let ([a, b], [c, d]) = ([from[0], from[1]], [to[0], to[1]]);
        solid.triangles.extend([[a, b, d], [a, d, c], [one.into(), b, a], [other.into(), c, d]]);
        solid.edges.extend([[a, b], [c, d]]);
    }
    // How far it reaches is seen from the side.
    let sides = (0..SIDES).step_by(SIDES / 4);
    solid.edges.extend(sides.map(|side| [low[side], high[side]]));
    solid
}

/// The edges of a profile of revolution: points [z, r], mm, z from `from` along `way`. Circles, and lines between them.
pub(super) fn turned(
    points: &[[f64; 2]],
    from: Vector3<f64>,
    way: Vector3<f64>,
) -> Vec<[Vertex; 2]> {
    let rings = points.iter().map(|[z, r]| ring(from + way * *z, way, *r));
    let rings: Vec<Vec<Vertex>> = rings.collect();
    let circles = rings.iter().flat_map(|ring| ring.windows(2).map(|ends| [ends[0], ends[1]]));
    let between = rings
        .windows(2)
        .flat_map(|pair| (0..SIDES).step_by(SIDES / 4).map(|side| [pair[0][side], pair[1][side]]));
    circles.chain(between).collect()
}
