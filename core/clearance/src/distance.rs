//! How far two shapes are apart.
//!
//! A search (GJK) finds the nearest points of two convex pieces; what it says is not taken for granted. The direction from
//! one point to the other is that of two parallel planes which hold each piece on its own side, as far as the farthest
//! points of both along it tell: their distance is a lower bound, however the direction was found.

use nalgebra::{Matrix3, Vector3};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::gjk::{CsoPoint, GJKResult, VoronoiSimplex, closest_points};
use parry3d_f64::shape::SupportMap;

use crate::ALLOWANCE;
use crate::convex::{Convex, Support};
use crate::placement::Placement;
use crate::shape::{Below, Shape};

/// Pieces that are no nearer than this share of the nearest found are not looked at, if that is as much as is wanted.
const CLOSE: f64 = 0.98;

/// Steps to a point of two pieces that overlap, for who looks at it.
const STEPS: usize = 40;

/// Pairs of pieces that one search looks at: of the others counts what their spheres and boxes tell.
const MOST_LOOKS: usize = 1 << 14;

/// What is known of how far two shapes are apart, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// They are no nearer: proven. Zero or less: nothing is.
    pub at_least: f64,
    /// They are no farther: the distance of two points of them; zero where they overlap.
    pub at_most: f64,
    /// Of each the point nearest to the other, in the frame of the first; nothing where they overlap.
    pub points: [Vector3<f64>; 2],
    /// The pieces that are nearest.
    pub nearest: [usize; 2],
    /// Across the planes between them, from the first to the second, frame of the first; zero where there are none.
    pub along: Vector3<f64>,
}

impl Apart {
    /// Nothing is known but that they may touch.
    pub(crate) fn touching(point: Vector3<f64>, nearest: [usize; 2]) -> Self {
        Self { at_least: 0.0, at_most: 0.0, points: [point; 2], nearest, along: Vector3::zeros() }
    }
}

/// A set that the search sees in the frame of another.
struct Seen<'a, S>(&'a S, Option<&'a Placement>);

impl<S: Support> Seen<'_, S> {
    fn centre(&self) -> Vector3<f64> {
        let centre = self.0.centre();
        self.1.map_or(centre, |at| at.point(centre))
    }

    fn farthest(&self, along: Vector3<f64>) -> Vector3<f64> {
        match self.1 {
            Some(at) => at.point(self.0.support(at.rotation.tr_mul(&along))),
            None => self.0.support(along),
        }
    }
}

impl<S: Support> SupportMap for Seen<'_, S> {
    fn local_support_point(&self, along: Vector) -> Vector {
        let [x, y, z] = self.farthest(Vector3::new(along.x, along.y, along.z)).into();
        Vector::new(x, y, z)
    }
}

/// Two convex pieces, in one frame.
pub fn of_convex(one: &Convex, other: &Convex) -> Apart {
    of_hulls(one, other, &Placement::identity(), None)
}

/// A point of both pieces where they overlap, to within rounding; else of each the one that is nearest to the other.
pub fn meeting(one: &Convex, other: &Convex) -> [Vector3<f64>; 2] {
    let rounds = [one.round, other.round];
    meet(&Seen(one, None), &Seen(other, None), rounds)
}

/// The same of the pieces that `apart` says are nearest, in the frame of the first shape.
pub(crate) fn meeting_of(
    one: &Shape,
    other: &Shape,
    at: &Placement,
    apart: &Apart,
) -> [Vector3<f64>; 2] {
    let pieces = (one.pieces.get(apart.nearest[0]), other.pieces.get(apart.nearest[1]));
    match pieces {
        (Some(one), Some(other)) if apart.along == Vector3::zeros() => {
            meet(&Seen(one, None), &Seen(other, Some(at)), [one.round, other.round])
        }
        _ => apart.points,
    }
}

/// The hulls of two sets, the second placed in the frame of the first. The search begins at `start`, the direction from one
/// to the other that is likely.
pub(crate) fn of_hulls<S: Support, T: Support>(
    one: &S,
    other: &T,
    at: &Placement,
    start: Option<Vector3<f64>>,
) -> Apart {
    let rounds = [one.round(), other.round()];
    let round = rounds[0] + rounds[1];
    let (one, other) = (Seen(one, None), Seen(other, Some(at)));
    let (from, to) = (one.centre(), other.centre());
    let start = start.or_else(|| (to - from).try_normalize(1e-12)).unwrap_or_else(Vector3::x);
    let (found, _) = search(&one, &other, start);
    let mut apart = Apart::touching((from + to) * 0.5, [0; 2]);
    let along = match found {
        GJKResult::ClosestPoints(first, last, along) => {
            let (first, last) = (of(first), of(last));
            apart.points = facing([first, last], rounds);
            apart.at_most = ((last - first).norm() - round).max(0.0);
            [last - first, of(along)]
        }
        GJKResult::Intersection => return apart,
        // The search has not come to an end: what a direction proves still holds.
        GJKResult::NoIntersection(along) | GJKResult::Proximity(along) => {
            apart.at_most = ((to - from).norm() - round).max(0.0);
            [to - from, of(along)]
        }
    };
    for along in along {
        let Some(along) = along.try_normalize(1e-300) else { continue };
        let near = along.dot(&other.farthest(-along));
        let far = along.dot(&one.farthest(along));
        if near - far - round > apart.at_least {
            (apart.at_least, apart.along) = (near - far - round, along);
        }
    }
    // Rounding: what is proven is no more than what was found.
    apart.at_least = (apart.at_least.min(apart.at_most) - ALLOWANCE).max(0.0);
    apart
}

fn of(vector: Vector) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, vector.z)
}

/// The search for the nearest points from a direction on, and the simplex that it ends with.
fn search<S: Support, T: Support>(
    one: &Seen<'_, S>,
    other: &Seen<'_, T>,
    start: Vector3<f64>,
) -> (GJKResult, VoronoiSimplex) {
    let mut simplex = VoronoiSimplex::new();
    let start = Vector::new(start.x, start.y, start.z);
    simplex.reset(CsoPoint::from_shapes(&Pose::IDENTITY, one, other, start));
    let found = closest_points(&Pose::IDENTITY, one, other, f64::MAX, true, &mut simplex);
    (found, simplex)
}

/// Where two points of cores face one another all that is within `rounds` of these: on the surface of each, or in both.
fn facing([first, last]: [Vector3<f64>; 2], rounds: [f64; 2]) -> [Vector3<f64>; 2] {
    let off = last - first;
    let (far, round) = (off.norm(), rounds[0] + rounds[1]);
    match far > round {
        true => [first + off * (rounds[0] / far), last - off * (rounds[1] / far)],
        false if round > 0.0 => [first + off * (rounds[0] / round); 2],
        false => [first; 2],
    }
}

/// A point of both sets where they overlap; else of each the one that is nearest to the other.
fn meet(one: &Seen<'_, Convex>, other: &Seen<'_, Convex>, rounds: [f64; 2]) -> [Vector3<f64>; 2] {
    let start = other.centre() - one.centre();
    let start = start.try_normalize(1e-12).unwrap_or_else(Vector3::x);
    let (found, simplex) = search(one, other, start);
    match found {
        GJKResult::ClosestPoints(first, last, _) => facing([of(first), of(last)], rounds),
        GJKResult::Intersection => {
            let [first, last] = in_simplex(&simplex);
            match (first - last).norm() <= ALLOWANCE {
                true => [(first + last) * 0.5; 2],
                false => [between(one, other); 2],
            }
        }
        GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => [between(one, other); 2],
    }
}

/// The points of both sets whose difference is the origin: the corners of the simplex of differences that holds it, weighted
/// as they hold it.
fn in_simplex(simplex: &VoronoiSimplex) -> [Vector3<f64>; 2] {
    let count = simplex.dimension() + 1;
    let corners: Vec<&CsoPoint> = (0..count).map(|place| simplex.point(place)).collect();
    let first = of(corners[0].point);
    let ways = Matrix3::from_fn(|row, column| {
        corners.get(column + 1).map_or(0.0, |corner| (of(corner.point) - first)[row])
    });
    let shares = ways.svd(true, true).solve(&-first, 1e-12).unwrap_or_else(|_| Vector3::zeros());
    let mut shares = [1.0 - shares.sum(), shares.x, shares.y, shares.z].map(|share| share.max(0.0));
    let sum: f64 = shares.iter().take(count).sum();
    shares.iter_mut().for_each(|share| *share /= sum);
    let point = |of_set: fn(&CsoPoint) -> Vector| {
        let parts = corners.iter().zip(shares);
        parts.map(|(corner, share)| of(of_set(corner)) * share).sum()
    };
    [point(|corner| corner.orig1), point(|corner| corner.orig2)]
}

/// A point that is nearly in both of two pieces that overlap: from the middle of each towards the other, by the points of
/// both that are farthest on the way (Frank, Wolfe 1956).
fn between(one: &Seen<'_, Convex>, other: &Seen<'_, Convex>) -> Vector3<f64> {
    let (mut here, mut there) = (one.centre(), other.centre());
    for _ in 0..STEPS {
        let off = there - here;
        let ends = [one.farthest(off), other.farthest(-off)];
        let change = (ends[1] - there) - (ends[0] - here);
        let length = change.norm_squared();
        if length <= 0.0 {
            break;
        }
        let share = (-off.dot(&change) / length).clamp(0.0, 1.0);
        here += (ends[0] - here) * share;
        there += (ends[1] - there) * share;
    }
    (here + there) * 0.5
}

/// Two shapes, the second placed in the frame of the first; `guess` are pieces that may be the nearest. If they are apart by
/// `wanted`, mm, their distance is known less closely. What a mesh encloses is not looked at.
pub fn of_shapes(
    one: &Shape,
    other: &Shape,
    at: &Placement,
    guess: [usize; 2],
    wanted: f64,
) -> Apart {
    let passed = f64::INFINITY;
    let mut search =
        Search { one, other, at, guess, wanted, best: None, looks: 0, passed, planes: None };
    search.pieces(guess);
    search.nodes(0, 0);
    let mut apart = search.best.unwrap_or(Apart::touching(Vector3::zeros(), guess));
    apart.at_least = apart.at_least.min(search.passed).max(0.0);
    apart
}

/// One of the shapes encloses a part of the other.
pub(crate) fn encloses(one: &Shape, other: &Shape, at: &Placement) -> Option<Vector3<f64>> {
    let held = |shape: &Shape, point| shape.shells.iter().any(|shell| shell.holds(point));
    let mut inner = other.points.iter().map(|point| at.point(*point));
    let inner = inner.find(|point| held(one, *point));
    inner.or_else(|| one.points.iter().copied().find(|point| held(other, at.back(*point))))
}

struct Search<'a> {
    one: &'a Shape,
    other: &'a Shape,
    at: &'a Placement,
    guess: [usize; 2],
    wanted: f64,
    best: Option<Apart>,
    looks: usize,
    /// The least that is proven of what was not looked at, mm.
    passed: f64,
    /// Across the planes between the nearest pieces so far: others are likely to be apart along it too.
    planes: Option<Planes>,
}

/// A direction across which two shapes are held apart.
#[derive(Clone, Copy)]
struct Planes {
    /// Unit vector, frame of the first.
    along: Vector3<f64>,
    /// The same in the frame of the second.
    beside: Vector3<f64>,
    /// How far the frame of the second is along it, mm.
    shift: f64,
}

impl Search<'_> {
    fn at_most(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |best| best.at_most)
    }

    fn pieces(&mut self, [first, last]: [usize; 2]) {
        let (Some(one), Some(other)) = (self.one.pieces.get(first), self.other.pieces.get(last))
        else {
            return;
        };
        self.looks += 1;
        let found = of_hulls(one, other, self.at, self.planes.map(|planes| planes.along));
        let found = Apart { nearest: [first, last], ..found };
        if found.at_most < self.at_most() && found.along != Vector3::zeros() {
            let along = found.along;
            let beside = self.at.rotation.tr_mul(&along);
            self.planes = Some(Planes { along, beside, shift: along.dot(&self.at.shift) });
        }
        self.best = Some(match self.best {
            Some(best) => {
                let at_least = best.at_least.min(found.at_least);
                let nearer = if found.at_most < best.at_most { found } else { best };
                Apart { at_least, ..nearer }
            }
            None => found,
        });
    }

    /// Of what is no nearer than `bound` nothing is looked at.
    fn passes(&mut self, bound: f64) -> bool {
        let nearest = self.at_most();
        let far = bound >= CLOSE * nearest && (bound >= self.wanted || bound >= nearest);
        // Nothing is nearer than touching.
        let passes = far || nearest <= 0.0 || self.looks >= MOST_LOOKS;
        if passes {
            self.passed = self.passed.min(bound);
        }
        passes
    }

    /// No part of one node is nearer than this to one of the other, mm.
    fn apart(&self, one: usize, other: usize) -> f64 {
        let (one, other) = (&self.one.nodes[one], &self.other.nodes[other]);
        let spheres = (self.at.point(other.centre) - one.centre).norm() - one.radius - other.radius;
        let boxes = self.planes.map_or(f64::NEG_INFINITY, |planes| {
            let Planes { along, beside, shift } = planes;
            let far = along.dot(&one.centre) + along.abs().dot(&one.half);
            shift + beside.dot(&other.centre) - beside.abs().dot(&other.half) - far
        });
        spheres.max(boxes) - ALLOWANCE
    }

    /// The same by a direction of its own for each piece of a small shape: from the piece to the middle of the node.
    fn apart_of_few(&self, one: usize, other: usize) -> f64 {
        let (first, last) = (&self.one.nodes[one], &self.other.nodes[other]);
        let bound = |piece: &Convex,
                     centre: Vector3<f64>,
                     half: Vector3<f64>,
                     turned: &dyn Fn(Vector3<f64>) -> Vector3<f64>| {
            let way = (centre - piece.core.towards(centre)).try_normalize(0.0);
            let Some(way) = way else { return 0.0 };
            let far = way.dot(&piece.core.support(way)) + piece.round;
            way.dot(&centre) - turned(way).abs().dot(&half) - far
        };
        let least = match (first.below, last.below) {
            (_, Below::Pieces(start, count)) => {
                let centre = self.at.back(first.centre);
                let turned = |way: Vector3<f64>| self.at.rotation * way;
                let pieces = &self.other.pieces[start..start + count];
                pieces
                    .iter()
                    .map(|piece| bound(piece, centre, first.half, &turned))
                    .fold(f64::INFINITY, f64::min)
            }
            (Below::Pieces(start, count), _) => {
                let centre = self.at.point(last.centre);
                let turned = |way: Vector3<f64>| self.at.rotation.tr_mul(&way);
                let pieces = &self.one.pieces[start..start + count];
                pieces
                    .iter()
                    .map(|piece| bound(piece, centre, last.half, &turned))
                    .fold(f64::INFINITY, f64::min)
            }
            _ => f64::NEG_INFINITY,
        };
        least - ALLOWANCE
    }

    fn nodes(&mut self, one: usize, other: usize) {
        let bound = self.apart(one, other);
        if self.passes(bound) {
            return;
        }
        let bound = self.apart_of_few(one, other);
        if self.passes(bound) {
            return;
        }
        let (first, last) = (&self.one.nodes[one], &self.other.nodes[other]);
        let pairs = match (first.below, last.below) {
            (Below::Pieces(first, count), Below::Pieces(last, others)) => {
                for place in first..first + count {
                    for beside in last..last + others {
                        self.pieces_within([place, beside]);
                    }
                }
                return;
            }
            (Below::Nodes(below), Below::Nodes(_)) if first.radius > last.radius => {
                below.map(|below| (below, other))
            }
            (_, Below::Nodes(below)) => below.map(|below| (one, below)),
            (Below::Nodes(below), _) => below.map(|below| (below, other)),
        };
        let [near, far] = pairs;
        let [near, far] = match self.apart(near.0, near.1) > self.apart(far.0, far.1) {
            true => [far, near],
            false => [near, far],
        };
        self.nodes(near.0, near.1);
        self.nodes(far.0, far.1);
    }

    /// Two pieces, unless their spheres are far enough apart.
    fn pieces_within(&mut self, [first, last]: [usize; 2]) {
        if self.guess == [first, last] {
            return;
        }
        let (centre, radius) = self.one.spheres[first];
        let (beside, reach) = self.other.spheres[last];
        let mut bound = (self.at.point(beside) - centre).norm() - radius - reach;
        if let Some(Planes { along, beside, shift }) = self.planes {
            let (one, other) = (&self.one.pieces[first], &self.other.pieces[last]);
            let far = along.dot(&one.core.support(along)) + one.round;
            let near = shift + beside.dot(&other.core.support(-beside)) - other.round;
            bound = bound.max(near - far);
        }
        if self.passes(bound - ALLOWANCE) {
            return;
        }
        let bound = self.between([first, last]);
        if !self.passes(bound - ALLOWANCE) {
            self.pieces([first, last]);
        }
    }

    /// Two pieces are no nearer than this by the direction between points of them that are likely to be near, mm.
    fn between(&self, [first, last]: [usize; 2]) -> f64 {
        let (one, other) = (&self.one.pieces[first], &self.other.pieces[last]);
        let there = other.core.towards(self.at.back(one.core.centre()));
        let there = self.at.point(there);
        let way = (there - one.core.towards(there)).try_normalize(0.0);
        let Some(along) = way else { return 0.0 };
        let beside = self.at.rotation.tr_mul(&along);
        let far = along.dot(&one.core.support(along)) + one.round;
        along.dot(&self.at.shift) + beside.dot(&other.core.support(-beside)) - other.round - far
    }
}
