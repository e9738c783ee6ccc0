//! Legs of a parallel machine: what a drive does when the axes of the chain move.
//!
//! The chain stays the passive one, which says how the platform can move; a leg ties a point of one of its links to a
//! point of a link nearer the bed. With `P` the platform's joint, seen from the link that carries the other end, every
//! drive follows from `P` in closed form, and so do its rate `g·P'` and a bound on its second derivative: with the speed
//! `V` and the acceleration `A` of `P`, a rod of length `L` and `s = |w·e|` its part along the way `e` of its other end
//!
//! - of a strut: `|d''| <= A + V² / |P - from|`;
//! - of a slide: `|d'| <= L·V / s`, `|d''| <= (L·A + (L·V / s)²) / s`;
//! - of a crank of arm `a`, `s` being taken times the arm: `|d'| <= L·V / s`, `|d''| <= (L·A + (a·L·V / s)² + L·a·d'²) / s`.
//!
//! For the rod keeps its length: its far end goes across it, and what is left of `P'` then is `P'` laid along `e` on the plane
//! across the rod, `L / s` times as long at most. Over a region of the axes `P` keeps to a ball, which is carried along the chain as the derivatives are.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::chain::{Joint, Joints, MAX_AXES, turn};
use super::inverse::Solver;
use super::kept_tip::TcpBlock;
use crate::axis_formula::{AxisFormula, largest};

/// Halvings of a way before the bound on a speed is taken as it is.
const DEEPEST: u32 = 18;

/// Pieces that are looked at for one bound; where they do not suffice the way is halved [`SHALLOW`] times everywhere.
const MOST_PIECES: u32 = 1 << 14;
const SHALLOW: u32 = 13;

/// Pieces of the travel of a drive, in each of which it is looked for whether a rod reaches.
const LOOKS: u32 = 64;

/// What rounding of the words may take a drive beyond its travel, mm at the rod's end.
const SURE: f64 = 0.01;

/// A largest speed that was looked into is known so well.
const CLOSE: f64 = 1.002;

/// What drives a leg.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// The leg grows: its length, mm.
    Strut,
    /// A rod of fixed length, the other end of which slides along a line: the way of that end, mm.
    Slide {
        /// Unit vector along which it slides.
        along: Vector3<f64>,
        /// Length of the rod, mm.
        rod: f64,
        /// Of both places the one farther along.
        ahead: bool,
    },
    /// A rod of fixed length, the other end of which a crank carries: the angle of that, radians.
    Crank {
        /// Unit vector that the crank turns about, right-handed.
        about: Vector3<f64>,
        /// From the shaft to the crank's pin at zero, mm, across `about`.
        arm: Vector3<f64>,
        /// Length of the rod, mm.
        rod: f64,
        /// Of both angles the larger.
        ahead: bool,
    },
    /// What a formula of the machine file makes of axis values; the leg has no ends.
    Formula {
        /// The drive as the control shows it, mm or degrees.
        is: Arc<AxisFormula>,
        /// It is an angle.
        turns: bool,
    },
}

/// A leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// What its drive is called.
    pub name: String,
    /// Place in the chain of the first of its joints.
    pub first: usize,
    /// Joints of the chain between both ends, from the bed on.
    pub joints: Vec<Joint>,
    /// Its end nearer the bed, of a slide or crank where this stands at zero: mm, machine frame, all axes at zero.
    pub from: Vector3<f64>,
    /// Its end on the platform, mm, machine frame, all axes at zero.
    pub to: Vector3<f64>,
    /// What drives it.
    pub drive: Drive,
    /// What the control shows where the drive is at zero, mm or radians.
    pub zero: f64,
    /// Least and largest value, mm or radians.
    pub travel: Option<[f64; 2]>,
    /// Largest feed, mm/min or rad/min; infinite if the file does not say.
    pub max_feed: f64,
}

/// A region of the axes, and how they go through it: all by place in the chain, mm and radians.
#[derive(Clone, Copy, Debug)]
pub struct AxisRegion {
    /// Axis values in its middle.
    pub middle: Joints,
    /// How far each goes from there at most.
    pub half: Joints,
    /// Bounds on the first derivatives by some parameter.
    pub speeds: Joints,
    /// Bounds on the second derivatives.
    pub bends: Joints,
}

impl AxisRegion {
    /// Least and largest axis values.
    fn ends(&self) -> [Joints; 2] {
        [-1.0, 1.0]
            .map(|side| std::array::from_fn(|place| self.middle[place] + side * self.half[place]))
    }
}

/// Where the joint on the platform can be, and how fast it goes.
#[derive(Clone, Copy, Debug)]
struct PlatformJoint {
    centre: Vector3<f64>,
    /// Farthest from the centre, mm.
    radius: f64,
    /// Bound on its speed, mm.
    speed: f64,
    /// Bound on its speed where the squares of the shares of the axes' speeds add up to one, mm.
    together: f64,
    /// Bound on its acceleration, mm.
    acceleration: f64,
    /// Square of the bound on its acceleration where the squares of those shares add up to one, mm².
    bent: f64,
    /// Sum of the squares of the speeds that axes give it each by itself, mm².
    squares: f64,
}

/// Bounds on a drive over a region.
#[derive(Clone, Copy, Debug)]
pub struct DriveBounds {
    /// Of the first derivative; infinite where nothing is proven.
    pub first: f64,
    /// Of the second derivative; infinite where nothing is proven.
    pub second: f64,
    /// Of the second derivative where the squares of the shares of the axes' speeds add up to one, and nothing bends.
    pub(super) together: f64,
    /// How much the drive changes at most for one mm of the platform's joint.
    gain: f64,
    /// Radius of the ball of that joint, mm.
    radius: f64,
}

/// Linear joints that follow one another in the chain: their ways add up part by part.
#[derive(Clone, Copy, Debug, Default)]
struct Slides {
    way: Vector3<f64>,
    speed: Vector3<f64>,
    squares: Matrix3<f64>,
}

impl Slides {
    fn take(&mut self, direction: Vector3<f64>, way: f64, speed: f64) {
        self.way += direction.abs() * way;
        self.speed += direction.abs() * speed;
        self.squares += direction * direction.transpose() * (speed * speed);
    }

    /// They carry `at`.
    fn end(&mut self, at: &mut PlatformJoint) {
        at.radius += self.way.norm();
        at.speed += self.speed.norm();
        at.together =
            (at.together * at.together + self.squares.symmetric_eigenvalues().max()).sqrt();
        *self = Self::default();
    }
}

impl Leg {
    /// Places in the chain of the axes that move it.
    pub fn places(&self) -> impl Iterator<Item = usize> + use<> {
        let moving = match &self.drive {
            Drive::Formula { is, .. } => is.axes(),
            _ => (self.first..self.first + self.joints.len()).fold(0, |bits, at| bits | 1 << at),
        };
        (0..MAX_AXES).filter(move |place| moving >> place & 1 == 1)
    }

    /// Its drive is told by a formula.
    fn formula(&self) -> Option<&AxisFormula> {
        match &self.drive {
            Drive::Formula { is, .. } => Some(is),
            _ => None,
        }
    }

    /// Axis units (mm, radians) in one unit of what the control shows of the axis at a place in the chain.
    pub fn unit_of(&self, place: usize) -> f64 {
        let joint = place.checked_sub(self.first).and_then(|place| self.joints.get(place));
        match self.formula() {
            Some(formula) => formula.unit(place),
            None if joint.is_some_and(|joint| joint.rotary) => 1f64.to_radians(),
            None => 1.0,
        }
    }

    /// The drive turns.
    pub fn turns(&self) -> bool {
        matches!(self.drive, Drive::Crank { .. } | Drive::Formula { turns: true, .. })
    }

    /// Drive units (mm, radians) in one unit of what the control shows (mm, degrees).
    pub fn unit(&self) -> f64 {
        if self.turns() { 1f64.to_radians() } else { 1.0 }
    }

    /// What the control shows at `value`: mm or degrees.
    pub fn reading(&self, value: f64) -> f64 {
        (value + self.zero) / self.unit()
    }

    /// The joint on the platform, as the link sees it that carries the other end: mm.
    fn point(&self, joints: &Joints) -> Vector3<f64> {
        let mut point = self.to;
        for (joint, value) in self.joints.iter().zip(&joints[self.first..]).rev() {
            if joint.rotary {
                let (sine, cosine) = libm::sincos(*value);
                point = joint.point + turn(point - joint.point, joint.direction, sine, cosine);
            } else {
                point += joint.direction * *value;
            }
        }
        point
    }

    /// The drive at `joints`, mm or radians (of a crank on the turn about the middle of its travel); none where the rod does
    /// not reach.
    pub fn value(&self, joints: &Joints) -> Option<f64> {
        match self.formula() {
            Some(formula) => Some(formula.value(joints)? * self.unit()),
            None => self.value_at(self.point(joints)),
        }
    }

    fn value_at(&self, point: Vector3<f64>) -> Option<f64> {
        let arm = point - self.from;
        match self.drive {
            Drive::Formula { .. } => None,
            Drive::Strut => Some(arm.norm()),
            Drive::Slide { along, rod, ahead } => {
                let way = along.dot(&arm);
                let square = rod * rod - (arm - along * way).norm_squared();
                (square >= 0.0).then(|| way + if ahead { square.sqrt() } else { -square.sqrt() })
            }
            Drive::Crank { about, arm: crank, rod, ahead } => {
                let length = crank.norm();
                let [along, across] = [crank / length, about.cross(&crank) / length];
                let [x, y] = [along.dot(&arm), across.dot(&arm)];
                let reach = libm::hypot(x, y);
                let wanted = (arm.norm_squared() + length * length - rod * rod) / (2.0 * length);
                if libm::fabs(wanted) > reach || reach == 0.0 {
                    return None;
                }
                let beside = libm::acos(wanted / reach);
                let angle = libm::atan2(y, x) + if ahead { beside } else { -beside };
                let [least, most] = self.travel.unwrap_or_default();
                let middle = 0.5 * (least + most);
                Some(middle + libm::remainder(angle - middle, std::f64::consts::TAU))
            }
        }
    }

    /// How the drive changes with the joint on the platform, a mm or a radian a mm; none where it has no value, or its rod
    /// stands across its way.
    fn gradient(&self, point: Vector3<f64>) -> Option<Vector3<f64>> {
        let value = self.value_at(point)?;
        let (rod, way) = match self.drive {
            Drive::Formula { .. } => return None,
            Drive::Strut => return (point - self.from).try_normalize(1e-9),
            Drive::Slide { along, .. } => (point - self.from - along * value, along),
            Drive::Crank { about, arm, .. } => {
                let (sine, cosine) = libm::sincos(value);
                let pin = turn(arm, about, sine, cosine);
                (point - self.from - pin, about.cross(&pin))
            }
        };
        let along = rod.dot(&way);
        (libm::fabs(along) > 1e-9).then(|| rod / along)
    }

    /// How the drive changes with each axis, by place in the chain.
    pub fn rates(&self, joints: &Joints) -> Option<Joints> {
        if let Some(formula) = self.formula() {
            let rates = formula.slope([joints; 2]).rates.map(|[rate, _]| rate * self.unit());
            return rates.iter().all(|rate| rate.is_finite()).then_some(rates);
        }
        let mut point = self.to;
        let mut ways = [Vector3::zeros(); MAX_AXES];
        for (place, (joint, value)) in
            self.joints.iter().zip(&joints[self.first..]).enumerate().rev()
        {
            if joint.rotary {
                let (sine, cosine) = libm::sincos(*value);
                let arm = turn(point - joint.point, joint.direction, sine, cosine);
                for way in &mut ways[place + 1..self.joints.len()] {
                    *way = turn(*way, joint.direction, sine, cosine);
                }
                ways[place] = joint.direction.cross(&arm);
                point = joint.point + arm;
            } else {
                ways[place] = joint.direction;
                point += joint.direction * *value;
            }
        }
        let gradient = self.gradient(point)?;
        let mut rates = Joints::default();
        for (rate, way) in rates[self.first..].iter_mut().zip(&ways[..self.joints.len()]) {
            *rate = gradient.dot(way);
        }
        Some(rates)
    }

    /// Where its joint on the platform can be in a region, and how fast it goes.
    fn platform(&self, region: &AxisRegion) -> PlatformJoint {
        let AxisRegion { middle, half, speeds, bends } = region;
        let mut at = PlatformJoint {
            centre: self.to,
            radius: 0.0,
            speed: 0.0,
            together: 0.0,
            acceleration: 0.0,
            bent: 0.0,
            squares: 0.0,
        };
        let mut slides = Slides::default();
        for (place, joint) in self.joints.iter().enumerate().rev() {
            let place = self.first + place;
            if !joint.rotary {
                at.centre += joint.direction * middle[place];
                at.acceleration += bends[place];
                slides.take(joint.direction, half[place], speeds[place]);
                at.squares += speeds[place] * speeds[place];
                continue;
            }
            slides.end(&mut at);
            let arm = at.centre - joint.point;
            let far = joint.direction.cross(&arm).norm() + at.radius;
            let (sine, cosine) = libm::sincos(middle[place]);
            let turning = speeds[place] * far;
            at.centre = joint.point + turn(arm, joint.direction, sine, cosine);
            at.radius += half[place] * far;
            at.acceleration += speeds[place] * (2.0 * at.speed + turning) + bends[place] * far;
            // The matrix of second derivatives, by the sum of the squares of its entries.
            let turn = speeds[place] * speeds[place];
            at.bent += turn * (turning * turning + 2.0 * at.squares);
            at.squares += turning * turning;
            at.speed += turning;
            at.together = libm::hypot(at.together, turning);
        }
        slides.end(&mut at);
        at
    }

    /// Bounds on the derivatives of the drive while the axes stay in a region and go through it as that says.
    ///
    /// Of a formula they are not looked for: its rates are bounded where it is asked.
    pub fn bounds(&self, region: &AxisRegion) -> DriveBounds {
        let at = self.platform(region);
        let arm = at.centre - self.from;
        let root = |square: f64| if square > 0.0 { square.sqrt() } else { 0.0 };
        // What the drive gains on its joint, and by what the acceleration and the square of the speed of that count.
        let [gain, bend, turning] = match self.drive {
            Drive::Formula { .. } => [f64::INFINITY; 3],
            Drive::Strut => {
                let length = arm.norm() - at.radius;
                [1.0, 1.0, if length > 0.0 { 1.0 / length } else { f64::INFINITY }]
            }
            Drive::Slide { along, rod, .. } => {
                let across = (arm - along * along.dot(&arm)).norm() + at.radius;
                let lead = root(rod * rod - across * across);
                let gain = rod / lead;
                [gain, gain, gain * gain / lead]
            }
            Drive::Crank { about, arm: crank, rod, .. } => {
                let length = crank.norm();
                let across = (arm - about * about.dot(&arm)).norm() - at.radius;
                let end = |far: f64| (far * far + length * length - rod * rod) / (2.0 * length);
                let far = arm.norm();
                let [near, far] = [end((far - at.radius).max(0.0)), end(far + at.radius)];
                let wanted = libm::fabs(near).max(libm::fabs(far));
                let lead = match across > 0.0 {
                    true => length * root(across * across - wanted * wanted),
                    false => 0.0,
                };
                let gain = rod / lead;
                [gain, gain, gain * gain * (length * length + rod * length) / lead]
            }
        };
        // Nothing times what is not proven is not proven either.
        let proven = |bound: f64| if bound.is_nan() { f64::INFINITY } else { bound };
        let second = |bent: f64, speed: f64| proven(bend * bent + turning * speed * speed);
        DriveBounds {
            first: proven(gain * at.speed),
            second: second(at.acceleration, at.speed),
            together: second(at.bent.sqrt(), at.together),
            gain: proven(gain),
            radius: at.radius,
        }
    }

    /// Least and largest value while each axis stays between its values in `ends`; none where it is not proven to have one
    /// all over. Radians may pass the end of a turn.
    pub fn range(&self, [least, most]: [&Joints; 2]) -> Option<[f64; 2]> {
        if let Some(formula) = self.formula() {
            return Some(formula.range([least, most])?.map(|end| end * self.unit()));
        }
        let middle: Joints = std::array::from_fn(|place| 0.5 * (least[place] + most[place]));
        let half: Joints =
            std::array::from_fn(|place| 0.5 * libm::fabs(most[place] - least[place]));
        let region = AxisRegion { middle, half, speeds: half, bends: Joints::default() };
        let bounds = self.bounds(&region);
        let value = self.value(&middle)?;
        // Both by the mean value and by Taylor's rule with its rest.
        let by_ball = bounds.gain * bounds.radius;
        let by_rates = self.rates(&middle).map_or(f64::INFINITY, |rates| {
            let ways = rates.iter().zip(&half);
            ways.map(|(rate, half)| libm::fabs(*rate) * half).sum::<f64>() + 0.5 * bounds.second
        });
        let stray = by_ball.min(by_rates);
        stray.is_finite().then_some([value - stray, value + stray])
    }

    /// Nowhere while each axis stays between its values in `ends` does it reach the platform with its drive in its travel.
    pub fn is_out(&self, ends: [&Joints; 2]) -> bool {
        if let Some([least, most]) = self.range(ends) {
            return self.travel.is_some_and(|travel| most < travel[0] || least > travel[1]);
        }
        let [least, most] = ends;
        let at = self.platform(&AxisRegion {
            middle: std::array::from_fn(|place| 0.5 * (least[place] + most[place])),
            half: std::array::from_fn(|place| 0.5 * libm::fabs(most[place] - least[place])),
            speeds: Joints::default(),
            bends: Joints::default(),
        });
        let arm = at.centre - self.from;
        match self.drive {
            Drive::Strut | Drive::Formula { .. } => false,
            Drive::Slide { along, rod, .. } => {
                (arm - along * along.dot(&arm)).norm() - at.radius > rod
                    || self.travel.is_some_and(|travel| {
                        misses(&|way| along * way, travel, 1.0, (arm, at.radius + SURE), rod)
                    })
            }
            Drive::Crank { about, arm: crank, rod, .. } => {
                // The platform's joint is beyond the stretched crank and rod, or nearer than they can fold.
                let length = crank.norm();
                arm.norm() - at.radius > length + rod
                    || arm.norm() + at.radius < libm::fabs(length - rod)
                    || self.travel.is_some_and(|travel| {
                        let pin = |value: f64| {
                            let (sine, cosine) = libm::sincos(value);
                            turn(crank, about, sine, cosine)
                        };
                        misses(&pin, travel, length, (arm, at.radius + SURE), rod)
                    })
            }
        }
    }

    /// How far its rates by the axes may lie from those in the middle of a region, each rate times the speed of its axis there:
    /// the root of the sum of squares. `moving` axes have a part in it.
    pub(super) fn rates_stray(&self, region: &AxisRegion, moving: usize) -> f64 {
        let Some(formula) = self.formula() else {
            return self.bounds(region).together * (moving as f64).sqrt();
        };
        let AxisRegion { middle, speeds, .. } = region;
        let Some(rates) = self.rates(middle) else {
            return f64::INFINITY;
        };
        let slope = formula.slope(region.ends().each_ref());
        let strays = slope.rates.iter().enumerate().map(|(place, bounds)| {
            let stray = largest(bounds.map(|end| end * self.unit() - rates[place])) * speeds[place];
            stray * stray
        });
        strays.sum::<f64>().sqrt()
    }

    /// Bounds on its speed while axes between their values in `ends` go by `ways` with second derivatives `bends`, by a share
    /// from 0 to 1: of a formula, what its rates bring together.
    fn speed_by_rates(&self, ends: [&Joints; 2], ways: &Joints, bends: &Joints) -> Option<f64> {
        let slope = self.formula()?.slope(ends);
        let mut speed = [0.0; 2];
        for (place, rate) in slope.rates.iter().enumerate().filter(|(_, rate)| **rate != [0.0; 2]) {
            let ends = [-0.5, 0.5].map(|side| ways[place] + side * bends[place]);
            let parts = rate.iter().flat_map(|rate| ends.map(|way| rate * way));
            // Where an axis stands it does not matter how the drive would change with it.
            let parts: Vec<f64> =
                parts.map(|part| if part.is_nan() { 0.0 } else { part }).collect();
            speed[0] += parts.iter().copied().fold(f64::INFINITY, f64::min);
            speed[1] += parts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        }
        Some(largest(speed.map(|end| end * self.unit())))
    }

    /// A bound on the speed of the drive along a way, by the share of it, at most 0.2 % too large but where a rod comes to
    /// stand across its way, or the axes bend so that too many pieces of it would be looked at; no closer than `enough`.
    /// `between` gives the axis values at a share, `bends` bounds their second derivatives by it. Infinite where nothing
    /// is proven.
    pub fn fastest(
        &self,
        ends: [&Joints; 2],
        between: &dyn Fn(f64) -> Option<Joints>,
        bends: &Joints,
        enough: f64,
    ) -> f64 {
        let piece = WayPiece { from: 0.0, to: 1.0, ends: ends.map(|end| *end) };
        let mut search = SpeedSearch { certain: 0.0, left: MOST_PIECES };
        let bound = self.fastest_on(&piece, (between, bends), enough, &mut search, DEEPEST);
        if search.left > 0 {
            return bound;
        }
        search.left = u32::MAX;
        self.fastest_on(&piece, (between, bends), enough, &mut search, SHALLOW)
    }

    fn fastest_on(
        &self,
        piece: &WayPiece,
        (between, bends): (&dyn Fn(f64) -> Option<Joints>, &Joints),
        enough: f64,
        search: &mut SpeedSearch,
        halvings: u32,
    ) -> f64 {
        search.left = search.left.saturating_sub(1);
        let length = piece.to - piece.from;
        let [first, last] = &piece.ends;
        let bends_here: Joints = std::array::from_fn(|place| bends[place] * length * length);
        let way = |place: usize| libm::fabs(last[place] - first[place]);
        let region = AxisRegion {
            middle: std::array::from_fn(|place| 0.5 * (first[place] + last[place])),
            half: std::array::from_fn(|place| 0.5 * way(place) + bends_here[place] / 8.0),
            speeds: std::array::from_fn(|place| way(place) + 0.5 * bends_here[place]),
            bends: bends_here,
        };
        let changes = match [first, last].map(|end| self.value(end)) {
            [Some(first), Some(last)] if self.turns() => {
                libm::fabs(libm::remainder(last - first, std::f64::consts::TAU))
            }
            [Some(first), Some(last)] => libm::fabs(last - first),
            _ => return f64::INFINITY,
        };
        search.certain = search.certain.max(changes / length);
        let ways = std::array::from_fn(|place| last[place] - first[place]);
        let bound = match self.speed_by_rates(region.ends().each_ref(), &ways, &bends_here) {
            Some(speed) => speed / length,
            None => {
                let bounds = self.bounds(&region);
                bounds.first.min(changes + 0.5 * bounds.second) / length
            }
        };
        if bound <= enough.max(search.certain * CLOSE) || halvings == 0 || search.left == 0 {
            return bound;
        }
        let share = 0.5 * (piece.from + piece.to);
        let Some(middle) = between(share) else {
            return f64::INFINITY;
        };
        let halves = [
            WayPiece { from: piece.from, to: share, ends: [*first, middle] },
            WayPiece { from: share, to: piece.to, ends: [middle, *last] },
        ];
        let way = (between, bends);
        let of = |half: &WayPiece, search: &mut SpeedSearch| {
            self.fastest_on(half, way, enough, search, halvings - 1)
        };
        let first = of(&halves[0], search);
        // Where nothing is proven of one half the other does not matter.
        if first.is_infinite() {
            return first;
        }
        first.max(of(&halves[1], search))
    }
}

/// Nowhere in its travel does the other end of a rod, `end` (mm, at most `gain` mm a unit of the drive), stand a rod's length
/// from a ball.
fn misses(
    end: &dyn Fn(f64) -> Vector3<f64>,
    [least, most]: [f64; 2],
    gain: f64,
    (centre, radius): (Vector3<f64>, f64),
    rod: f64,
) -> bool {
    let step = (most - least) / f64::from(LOOKS);
    (0..LOOKS).all(|place| {
        let value = least + (f64::from(place) + 0.5) * step;
        let off = libm::fabs((centre - end(value)).norm() - rod);
        off > radius + 0.5 * step * gain
    })
}

/// What a search for the largest speed has found.
#[derive(Clone, Copy, Debug)]
struct SpeedSearch {
    /// A speed that the drive certainly has.
    certain: f64,
    /// Pieces that may still be looked at.
    left: u32,
}

/// A piece of a way between two shares of it, and the axis values there.
struct WayPiece {
    from: f64,
    to: f64,
    ends: [Joints; 2],
}

/// How the axes go from one place to another.
#[derive(Clone, Copy)]
pub enum AxesWay<'a> {
    /// Each in proportion to its way.
    Straight,
    /// The rotary ones in proportion to their ways, and the linear ones so that the tip goes on a straight line, `along` mm
    /// below the point of the solver.
    KeepingTip {
        /// Solves the chain.
        solver: &'a Solver,
        /// mm along the tool axis.
        along: f64,
    },
}

/// The least time in which no drive of `legs` passes its largest feed on a way, minutes, with the place of the leg that
/// asks for it among them; no closer than `enough` minutes. Infinite where nothing is proven.
pub fn least_drive_minutes<'a>(
    legs: impl Iterator<Item = &'a Leg>,
    way: AxesWay<'_>,
    ends: [&Joints; 2],
    enough: f64,
) -> Option<(f64, usize)> {
    let mut slowest: Option<(f64, usize)> = None;
    for (place, leg) in legs.enumerate().filter(|(_, leg)| leg.max_feed.is_finite()) {
        let known = slowest.map_or(enough, |(minutes, _)| minutes.max(enough));
        let minutes = fastest(leg, way, ends, known * leg.max_feed) / leg.max_feed;
        if minutes > slowest.map_or(0.0, |(most, _)| most) {
            slowest = Some((minutes, place));
        }
    }
    slowest
}

/// A bound on the speed of a drive along a way, by the share of it, no closer than `enough`.
fn fastest(leg: &Leg, way: AxesWay<'_>, ends: [&Joints; 2], enough: f64) -> f64 {
    let [from, to] = ends;
    let AxesWay::KeepingTip { solver, along } = way else {
        let between = |share: f64| {
            Some(std::array::from_fn(|place| from[place] + share * (to[place] - from[place])))
        };
        return leg.fastest(ends, &between, &Joints::default(), enough);
    };
    let [first, last] = ends.map(|joints| solver.chain().traced(joints));
    let Some(kept) = TcpBlock::new(solver, along, &first, &last) else {
        return f64::INFINITY;
    };
    let bend = kept.quick();
    let mut bends = Joints::default();
    kept.sliding().into_iter().for_each(|joint| bends[joint] = bend);
    match bend.is_finite() {
        true => leg.fastest(ends, &|share| kept.joints_at(solver, share), &bends, enough),
        false => f64::INFINITY,
    }
}
