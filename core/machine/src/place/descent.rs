//! Mounts tried one after the other: numbers that can be set by hand, and a search by steps along the axes.

use nalgebra::Vector3;

use super::half_space::{HalfSpace, most_room, nearest};
use crate::halton;

/// A decrease that is worth another mount, as a share of the cost.
const WORTH: f64 = 1e-4;

/// `point` with as few decimals as leave `room` to every end, three at most; none if even these do not.
pub fn rounded(bodies: &[HalfSpace], point: &Vector3<f64>, room: f64) -> Option<Vector3<f64>> {
    (0..=3).find_map(|decimals| {
        let unit = libm::exp10(f64::from(decimals));
        let mut corners: Vec<Vector3<f64>> = (0..8)
            .map(|corner| {
                Vector3::from_fn(|axis, _| {
                    let up = f64::from(corner >> axis & 1);
                    (libm::floor(point[axis] * unit) + up) / unit
                })
            })
            // What has no more decimals is one of its own corners.
            .chain([point.map(|value| libm::rint(value * unit) / unit)])
            .collect();
        corners.sort_by(|a, b| (a - point).norm().total_cmp(&(b - point).norm()));
        let holds = |corner: &Vector3<f64>| bodies.iter().all(|body| body.room(corner) >= room);
        corners.into_iter().find(holds)
    })
}

/// How far the ends of the room are looked for, mm.
const FAR: f64 = 1e4;

/// At most `count` points with `room` to every end, whole mm, spread over all there are: first those at its ends and the
/// one with most room, then places all over the box about them.
pub fn spread(
    bodies: &[HalfSpace],
    about: &Vector3<f64>,
    room: f64,
    count: usize,
) -> Vec<Vector3<f64>> {
    let toward = (0..6).filter_map(|way| {
        let mut far = *about;
        far[way / 2] += if way % 2 == 0 { FAR } else { -FAR };
        nearest(bodies, &far, room)
    });
    let ends: Vec<Vector3<f64>> = toward.collect();
    let Some(first) = ends.first() else {
        return Vec::new();
    };
    let (least, most) =
        ends.iter().fold((*first, *first), |(least, most), end| (least.inf(end), most.sup(end)));
    let middle = most_room(bodies, about).map(|tight| tight.point);
    let tries = u32::try_from(count * 16).unwrap_or(u32::MAX);
    let inside = (1..=tries).map(|number| {
        let share = Vector3::from_iterator(halton::place(number));
        least + (most - least).component_mul(&share)
    });
    let holds = |point: &Vector3<f64>| bodies.iter().all(|body| body.room(point) >= room);
    let mut found: Vec<Vector3<f64>> = Vec::new();
    for point in middle.into_iter().chain(ends).chain(inside) {
        if found.len() == count {
            break;
        }
        if let Some(point) = Some(point.map(libm::rint)).filter(holds)
            && !found.contains(&point)
        {
            found.push(point);
        }
    }
    found
}

/// A place of the part, mm, machine frame, and what it costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountCost {
    /// The place.
    pub mount: Vector3<f64>,
    /// Its cost.
    pub cost: f64,
}

/// Goes from `start` by steps along the axes to where none of them costs less; `cost_at` gives none where the part cannot
/// sit. The result is a local optimum within the steps, no more.
pub fn descend(
    start: MountCost,
    steps: &[f64],
    mut cost_at: impl FnMut(Vector3<f64>) -> Option<f64>,
) -> MountCost {
    let MountCost { mount: mut best, cost: mut least } = start;
    for step in steps {
        // The way that helped last is tried again first.
        let mut ways: Vec<(usize, f64)> =
            (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]).collect();
        let mut tried = 0;
        while tried < ways.len() {
            let (axis, sign) = ways[tried];
            let mut next = best;
            next[axis] += sign * step;
            match cost_at(next) {
                Some(cost) if cost < least * (1.0 - WORTH) => {
                    (best, least) = (next, cost);
                    ways.swap(0, tried);
                    tried = 0;
                }
                _ => tried += 1,
            }
        }
    }
    MountCost { mount: best, cost: least }
}
