//! Distances by other means: nearest points of convex pieces by turns, each the nearest to the other.

use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use post_clearance::convex::{Convex, Core};
use post_machine::kinematics::{Joint, Joints};
use post_testkit::Rng;

type V = Vector3<f64>;

/// Turns of [`apart`].
const TURNS: usize = 400;

/// What links `from` to `to` of a chain do together, as a product of isometries.
pub fn product(joints: &[Joint], q: &Joints, from: usize, to: usize) -> Isometry3<f64> {
    let step = |product: Isometry3<f64>, place: usize| {
        let Joint { rotary, direction, point } = joints[place];
        product
            * match rotary {
                true => {
                    let k = Unit::new_normalize(direction);
                    let there = Translation3::from(point);
                    there * UnitQuaternion::from_axis_angle(&k, q[place]) * there.inverse()
                }
                false => Isometry3::from_parts(
                    Translation3::from(direction * q[place]),
                    UnitQuaternion::identity(),
                ),
            }
    };
    (from..to).fold(Isometry3::identity(), step)
}

/// The point of a piece that is nearest to `point`.
pub fn nearest(piece: &Convex, point: V) -> V {
    let core = match &piece.core {
        Core::Frustum { ends, axis, radii } => on_frustum(*ends, *axis, *radii, point),
        Core::Block { centre, half } => half.iter().fold(*centre, |at, half| {
            let length = half.norm_squared();
            let share = if length > 0.0 { half.dot(&(point - centre)) / length } else { 0.0 };
            at + half * share.clamp(-1.0, 1.0)
        }),
        Core::Triangle(corners) => on_triangle(*corners, point),
        Core::Hull(_) | Core::Swept { .. } => unreachable!("held against what they are made of"),
    };
    let out = point - core;
    match out.norm() <= piece.round {
        true => point,
        false => core + out.normalize() * piece.round,
    }
}

/// In the plane of the axis and the point, the nearest of a trapezium, from its four edges.
fn on_frustum(ends: [V; 2], axis: V, radii: [f64; 2], point: V) -> V {
    let arm = point - ends[0];
    let z = axis.dot(&arm);
    let out = arm - axis * z;
    let r = out.norm();
    let across = if r > 0.0 { out / r } else { Vector3::zeros() };
    let height = axis.dot(&(ends[1] - ends[0]));
    let corners = [[0.0, -radii[0]], [0.0, radii[0]], [height, radii[1]], [height, -radii[1]]];
    let share = if height == 0.0 { 0.0 } else { z / height };
    if height != 0.0
        && (0.0..=1.0).contains(&share)
        && r <= radii[0] + (radii[1] - radii[0]) * share
    {
        return point;
    }
    let mut best = (f64::INFINITY, [0.0; 2]);
    for place in 0..4 {
        let (from, to) = (corners[place], corners[(place + 1) % 4]);
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0] * way[0] + way[1] * way[1];
        let t = match length > 0.0 {
            true => ((z - from[0]) * way[0] + (r - from[1]) * way[1]) / length,
            false => 0.0,
        };
        let at = [0, 1].map(|axis| from[axis] + way[axis] * t.clamp(0.0, 1.0));
        let off = libm::hypot(at[0] - z, at[1] - r);
        if off < best.0 {
            best = (off, at);
        }
    }
    ends[0] + axis * best.1[0] + across * best.1[1]
}

fn on_triangle([a, b, c]: [V; 3], point: V) -> V {
    let on_edge = |from: V, to: V| {
        let way = to - from;
        let length = way.norm_squared();
        let t = if length > 0.0 { way.dot(&(point - from)) / length } else { 0.0 };
        from + way * t.clamp(0.0, 1.0)
    };
    let normal = (b - a).cross(&(c - a));
    let inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(from, to)| normal.dot(&(to - from).cross(&(point - from))) >= 0.0);
    if inside && normal.norm() > 0.0 {
        let normal = normal.normalize();
        return point - normal * normal.dot(&(point - a));
    }
    [on_edge(a, b), on_edge(b, c), on_edge(c, a)]
        .into_iter()
        .min_by(|one, other| (one - point).norm().total_cmp(&(other - point).norm()))
        .unwrap()
}

/// The distance of two points of the pieces that are nearest to each other, as far as turns tell: never less than the
/// pieces are apart.
pub fn apart(one: &Convex, other: &Convex) -> f64 {
    let mut at = other.core.centre();
    let mut found = f64::INFINITY;
    for _ in 0..TURNS {
        let here = nearest(one, at);
        at = nearest(other, here);
        let apart = (at - here).norm();
        if found - apart < 1e-13 {
            return apart;
        }
        found = apart;
    }
    found
}

/// A piece moved by an isometry.
pub fn moved(piece: &Convex, by: &Isometry3<f64>) -> Convex {
    let point = |at: &V| (by * Point3::from(*at)).coords;
    let turned = |along: &V| by.rotation * along;
    let core = match &piece.core {
        Core::Frustum { ends, axis, radii } => Core::Frustum {
            ends: [point(&ends[0]), point(&ends[1])],
            axis: turned(axis),
            radii: *radii,
        },
        Core::Block { centre, half } => {
            Core::Block { centre: point(centre), half: half.each_ref().map(turned) }
        }
        Core::Triangle(corners) => Core::Triangle(corners.each_ref().map(point)),
        Core::Hull(_) | Core::Swept { .. } => unreachable!("held against what they are made of"),
    };
    Convex { core, round: piece.round }
}

/// Any piece around `at`, of up to `size` mm.
pub fn any_piece(rng: &mut Rng, at: V, size: f64) -> Convex {
    let core = match rng.pick(4) {
        0 => return Convex::ball(at, rng.range(0.1, size)),
        1 => {
            let axis = rng.direction();
            let half = axis * rng.range(0.0, size);
            let radii = [rng.range(0.0, size), rng.range(0.0, size)];
            Core::Frustum { ends: [at - half, at + half], axis, radii }
        }
        2 => {
            let turn = UnitQuaternion::from_scaled_axis(rng.point(2.0));
            let half = [0, 1, 2].map(|axis| turn * Vector3::ith(axis, rng.range(0.1, size)));
            Core::Block { centre: at, half }
        }
        _ => Core::Triangle([0, 1, 2].map(|_| at + rng.point(size))),
    };
    let round = if rng.pick(3) == 0 { rng.range(0.0, 0.3 * size) } else { 0.0 };
    Convex { core, round }
}
