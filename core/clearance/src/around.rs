//! A box of axis values about a pose, of axes that go for themselves: how far anything in it is from where it is there.
//!
//! From the middle of the box to any place in it the axes may be led linearly. A point of the body goes then as its first
//! derivative at the middle has it, less than half of a bound on its second one beside that. The derivative is linear in
//! the axes, so that it is largest in a corner of the box; along one direction it is linear in the point too, so that the
//! farthest point of the body tells it of all of them: axes that lead the body along a plane bring it no nearer to it.

use nalgebra::Vector3;
use post_machine::kinematics::chain::turn;
use post_machine::kinematics::{Joints, MAX_AXES};

use crate::ALLOWANCE;
use crate::convex::Support;
use crate::pair::View;
use crate::piece::Piece;
use crate::placement::Placement;
use crate::shape::Shape;

/// Rotary axes whose corners are looked at one by one; what others take is that of a sphere around the body.
const MOST_TURNS: usize = 3;

/// A direction, and how far the body that stands reaches along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    /// Unit vector towards the body that moves, frame of the other.
    pub along: Vector3<f64>,
    /// mm.
    pub far: f64,
}

/// Vectors, each with either sign.
#[derive(Default)]
struct Signed {
    vectors: [Vector3<f64>; MAX_AXES],
    count: usize,
}

impl Signed {
    fn push(&mut self, vector: Vector3<f64>) {
        self.vectors[self.count] = vector;
        self.count += 1;
    }

    /// The largest length of their sum.
    fn longest(&self) -> f64 {
        let Some((first, rest)) = self.vectors[..self.count].split_first() else { return 0.0 };
        let sum = |signs: u32| {
            let all = rest.iter().enumerate();
            all.fold(*first, |sum, (bit, vector)| match signs >> bit & 1 {
                0 => sum + vector,
                _ => sum - vector,
            })
        };
        (0..1_u32 << rest.len()).map(|signs| sum(signs).norm()).fold(0.0, f64::max)
    }
}

/// The box, seen by a body.
pub(crate) struct Around<'v> {
    view: &'v View,
    at: Placement,
    /// The middle of the body at the middle of the box, mm, frame of the other's link.
    centre: Vector3<f64>,
    /// Of each axis of the view its direction there, and a point of its line, mm.
    lines: [(Vector3<f64>, Vector3<f64>); MAX_AXES],
    /// How far each axis goes to either side, mm and radians.
    half: Joints,
    /// The same of the values where the middle is: what the second derivative is bounded by.
    own: Joints,
    stray: f64,
}

impl View {
    /// The box of `piece` about `middle`, which need not be its own middle.
    pub(crate) fn around(&self, middle: &Joints, piece: &Piece) -> Around<'_> {
        let own = self.of(middle);
        let ends = piece.ends.each_ref().map(|joints| self.of(joints));
        let turns = self.chain.turns(&own);
        let joints = self.chain.joints();
        let mut half = Joints::default();
        let mut lines = [(Vector3::zeros(), Vector3::zeros()); MAX_AXES];
        for place in (0..joints.len()).rev() {
            let [from, to] = ends.each_ref().map(|ends| libm::fabs(ends[place] - own[place]));
            half[place] = from.max(to);
            let joint = &joints[place];
            let (sine, cosine) = turns.of(place);
            for (way, point) in &mut lines[place + 1..joints.len()] {
                if !joint.rotary {
                    *point += joint.direction * own[place];
                    continue;
                }
                *way = turn(*way, joint.direction, sine, cosine);
                *point = joint.point + turn(*point - joint.point, joint.direction, sine, cosine);
            }
            lines[place] = (joint.direction, joint.point);
        }
        let centre = self.centre(middle);
        Around {
            view: self,
            at: self.placement(middle),
            centre,
            lines,
            half,
            own,
            stray: piece.stray,
        }
    }
}

impl Around<'_> {
    fn moving(&self, rotary: bool) -> impl Iterator<Item = usize> {
        let axes = 0..self.view.axes().count();
        axes.filter(move |place| self.half[*place] != 0.0 && self.view.is_rotary(*place) == rotary)
    }

    /// No point is farther from where its first derivative takes it, mm, where each axis goes no farther than `half`.
    fn bend(&self, half: &Joints) -> f64 {
        let mut far = self.own;
        far.iter_mut().zip(half).for_each(|(far, half)| *far += half);
        0.5 * self.view.bend_between(&self.own, &far)
    }

    /// No point of the body is farther from where it is at the middle, mm.
    pub(crate) fn reach(&self) -> f64 {
        let (mut ways, mut turns) = (Signed::default(), Signed::default());
        for place in self.moving(false) {
            ways.push(self.lines[place].0 * self.half[place]);
        }
        for place in self.moving(true) {
            let (way, point) = self.lines[place];
            let turned = way * self.half[place];
            ways.push(turned.cross(&(self.centre - point)));
            turns.push(turned);
        }
        let turned = turns.longest() * self.view.radius();
        ways.longest() + turned + self.bend(&self.half) + self.stray
    }

    /// How far the body and the one that stands are apart along a direction everywhere in the box, mm. None if it is less
    /// than `enough`, or not known.
    pub(crate) fn gap(&self, face: &Face, moves: &Shape, enough: f64) -> Option<f64> {
        let Face { along, far } = *face;
        let turns = || self.moving(true).take(MOST_TURNS);
        let other = self.moving(false).chain(self.moving(true).skip(MOST_TURNS));
        let other: f64 = other.map(|place| self.taken(place, along)).sum();
        let spent = other + self.bend(&self.half) + self.stray + far + ALLOWANCE;
        let mut least = f64::INFINITY;
        for corner in 0..1_u32 << turns().count() {
            let (mut direction, mut offset) = (along, 0.0);
            for (bit, place) in turns().enumerate() {
                let (way, point) = self.lines[place];
                let sign =
                    if corner >> bit & 1 == 0 { self.half[place] } else { -self.half[place] };
                let tilt = along.cross(&way) * sign;
                direction += tilt;
                offset -= tilt.dot(&point);
            }
            let beside = self.at.rotation.tr_mul(&direction);
            let near = direction.dot(&self.at.shift) + beside.dot(&moves.support(-beside)) + offset;
            least = least.min(near - spent);
            // What is no number proves nothing.
            if least.is_nan() || least < enough {
                return None;
            }
        }
        Some(least)
    }

    /// How far an axis takes any point of the body along a direction, to the first derivative, mm.
    fn taken(&self, place: usize, along: Vector3<f64>) -> f64 {
        let (way, point) = self.lines[place];
        if !self.view.is_rotary(place) {
            return libm::fabs(along.dot(&way)) * self.half[place];
        }
        let tilt = along.cross(&way);
        let arm = libm::fabs(tilt.dot(&(self.centre - point))) + tilt.norm() * self.view.radius();
        arm * self.half[place]
    }

    /// The axis of the machine that is best halved: by which the bound along a direction, or of all ways where there is none,
    /// gets least.
    pub(crate) fn dearest(&self, along: Option<Vector3<f64>>) -> usize {
        let bend = self.bend(&self.half);
        let gains = self.view.axes().map(|(place, axis)| {
            let mut half = self.half;
            half[place] *= 0.5;
            let straight = match (along, self.view.is_rotary(place)) {
                (Some(along), _) => self.taken(place, along),
                (None, false) => self.half[place],
                (None, true) => {
                    let (way, point) = self.lines[place];
                    let arm = way.cross(&(self.centre - point)).norm() + self.view.radius();
                    arm * self.half[place]
                }
            };
            (axis, 0.5 * straight + bend - self.bend(&half))
        });
        let best = gains.max_by(|one, other| one.1.total_cmp(&other.1));
        best.map_or(0, |(axis, _)| axis)
    }
}
