//! The point of a convex body next to a wished one, by the incremental method of Seidel and Welzl.

use nalgebra::Vector3;

/// The points `p` with `normal · p ≤ most`; what `normal · p` leaves to `most` is the room there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// How far the bounded value goes for one mm of the point along each axis.
    pub normal: Vector3<f64>,
    /// The end of the value, less what it has where the point is the origin: mm.
    pub most: f64,
}

impl HalfSpace {
    /// What is left to the end at `point`, mm; below zero if it is passed.
    #[inline]
    pub fn room(&self, point: &Vector3<f64>) -> f64 {
        self.most - self.normal.dot(point)
    }
}

/// Largest way past an end, mm: what sums of three products round off.
const SLACK: f64 = 1e-7;

/// The sine between planes below which they are parallel.
const PARALLEL: f64 = 1e-7;

/// The farthest that a mount is searched, mm, and the largest room that is told apart.
const FARTHEST: f64 = 1e6;

/// A plane that the point must lie on.
#[derive(Clone, Copy, Debug)]
struct BindingPlane {
    /// Unit normal, square to those of the planes before it.
    normal: Vector3<f64>,
    /// From the origin, mm.
    distance: f64,
}

/// The point with at least `room` to every end that is nearest to `wished`; none if there is no such point.
///
/// The order of `bodies` has no say in the answer, only in the time: an order in which neighbours have nothing to do with
/// one another takes time in proportion to their number.
pub fn nearest(bodies: &[HalfSpace], wished: &Vector3<f64>, room: f64) -> Option<Vector3<f64>> {
    on_planes(bodies, wished, room, &mut Vec::with_capacity(3))
}

/// The same, of the points on all of `planes`.
fn on_planes(
    bodies: &[HalfSpace],
    wished: &Vector3<f64>,
    room: f64,
    planes: &mut Vec<BindingPlane>,
) -> Option<Vector3<f64>> {
    let foot = |planes: &[BindingPlane]| {
        let steps = planes.iter();
        let steps = steps.map(|plane| plane.normal * (plane.distance - plane.normal.dot(wished)));
        wished + steps.sum::<Vector3<f64>>()
    };
    let mut point = foot(planes);
    for (index, body) in bodies.iter().enumerate() {
        if body.room(&point) >= room - SLACK {
            continue;
        }
        // The nearest point lies on the plane that was passed: of all before it the nearest was known, and from there to
        // any point that keeps this one as well the plane is crossed.
        let (mut normal, mut distance) = (body.normal, body.most - room);
        for plane in planes.iter() {
            let share = body.normal.dot(&plane.normal);
            normal -= plane.normal * share;
            distance -= plane.distance * share;
        }
        let length = normal.norm();
        if length < PARALLEL * body.normal.norm().max(PARALLEL) {
            return None;
        }
        planes.push(BindingPlane { normal: normal / length, distance: distance / length });
        let next = on_planes(&bodies[..index], wished, room, planes);
        planes.pop();
        point = next?;
    }
    Some(point)
}

/// Puts a list in an order in which neighbours have nothing to do with one another, the same each time.
pub fn shuffled<T>(mut list: Vec<T>) -> Vec<T> {
    // A linear congruential generator with Knuth's multiplier.
    let mut state: u64 = 1;
    for last in (1..list.len()).rev() {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        list.swap(last, ((state >> 33) % (last as u64 + 1)) as usize);
    }
    list
}

/// Where the least room is largest.
#[derive(Clone, Debug, PartialEq)]
pub struct Tight {
    /// The nearest to the wished point of those that have it.
    pub point: Vector3<f64>,
    /// The least room there, mm; below zero if every point passes some end. No more than a kilometre.
    pub room: f64,
    /// The bodies that leave no more: their places in the list.
    pub between: Vec<usize>,
}

/// The point next to `wished` whose least room is largest, by halving; none only if a half-space has no normal and is
/// passed by a kilometre.
pub fn most_room(bodies: &[HalfSpace], wished: &Vector3<f64>) -> Option<Tight> {
    let (mut least, mut most) = (-FARTHEST, FARTHEST);
    let mut point = nearest(bodies, wished, least)?;
    while most - least > 1e-5 {
        let middle = f64::midpoint(least, most);
        match nearest(bodies, wished, middle) {
            Some(found) => (least, point) = (middle, found),
            None => most = middle,
        }
    }
    let mut between: Vec<usize> =
        (0..bodies.len()).filter(|body| bodies[*body].room(&point) < least + 1e-3).collect();
    between.sort_by(|a, b| {
        let rooms = [*a, *b].map(|body| bodies[body].room(&point));
        rooms[0].total_cmp(&rooms[1])
    });
    Some(Tight { point, room: least, between })
}
