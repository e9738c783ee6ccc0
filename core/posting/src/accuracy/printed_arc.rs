//! An arc as a control makes it of the printed words, and how far it is from the arc of the CL file.
//!
//! The control turns evenly about the centre from the printed start to the printed end; where these differ in their
//! distance from the centre, that goes evenly from one to the other, as the height does. A helix that is given by its turn
//! stays at its first distance: it ends beside the words. All in the frame of the linear words, in mm.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Vector2, Vector3};

use crate::program::PathArc;
use post_machine::kinematics::chain::turn;

/// Angles of the printed arc and of the wanted one differ by no more, radians: else the control goes another way round.
const ANOTHER_WAY: f64 = 0.2;

/// Between samples the bound is blind by so much, mm.
const BLIND: f64 = 1e-5;

/// A normal that leans by more is that of another plane.
const LEANS: f64 = 1e-2;

/// An arc by its radius has its centre no nearer to the middle of its chord, in radii: there a radius says little of it.
const WELL_KNOWN: f64 = 0.15;

/// Which way an arc turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ArcDirection {
    /// Which of X, Y, Z it turns about.
    pub axis: usize,
    /// 1.0: counter-clockwise seen against that axis; -1.0: clockwise.
    pub sense: f64,
}

/// An arc about an axis of the words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PrintedArc {
    /// Which of X, Y, Z it turns about.
    pub axis: usize,
    /// 1.0: counter-clockwise seen against that axis; -1.0: clockwise.
    pub sense: f64,
    /// Centre on the level of the start.
    pub centre: Vector3<f64>,
    /// Angle of the start about the axis, from the direction behind the axis in X, Y, Z, X, radians.
    pub from: f64,
    /// Angle that it turns by, radians, above zero.
    pub turn: f64,
    /// Distances of start and end from the centre.
    pub radii: [f64; 2],
    /// Heights of start and end along the axis.
    heights: [f64; 2],
}

/// The part of a vector in the plane across an axis of the words.
pub(super) fn in_plane(axis: usize, vector: Vector3<f64>) -> Vector2<f64> {
    Vector2::new(vector[(axis + 1) % 3], vector[(axis + 2) % 3])
}

/// The unit vector at an angle.
fn toward(angle: f64) -> Vector2<f64> {
    let (sine, cosine) = libm::sincos(angle);
    Vector2::new(cosine, sine)
}

/// An angle as it is printed, radians: to 0.00001 degrees.
fn told(angle: f64) -> f64 {
    (libm::rint(angle.to_degrees() * 1e5) / 1e5).to_radians()
}

/// An angle brought to where it is no larger than half a turn.
pub(super) fn least_turn(angle: f64) -> f64 {
    angle - TAU * libm::rint(angle / TAU)
}

impl PrintedArc {
    /// Lays an arc from `start` to `end` about `centre`; ends that are one in the plane are a whole turn apart. None
    /// where an end lies on the centre.
    pub(crate) fn new(
        direction: ArcDirection,
        [start, end]: [Vector3<f64>; 2],
        centre: Vector3<f64>,
    ) -> Option<Self> {
        let ArcDirection { axis, sense } = direction;
        let arms = [start, end].map(|end| in_plane(axis, end - centre));
        let radii = arms.map(|arm| arm.norm());
        if radii[0] < 1e-6 || radii[1] < 1e-6 {
            return None;
        }
        let angles = arms.map(|arm| libm::atan2(arm.y, arm.x));
        let turn = sense * (angles[1] - angles[0]);
        let turn = turn - TAU * libm::floor(turn / TAU);
        let mut centre = centre;
        centre[axis] = start[axis];
        Some(Self {
            axis,
            sense,
            centre,
            from: angles[0],
            turn: if turn > 0.0 { turn } else { TAU },
            radii,
            heights: [start[axis], end[axis]],
        })
    }

    /// Makes it an arc given by its turn alone, the tool standing at `start`: it keeps its distance from the centre.
    pub(crate) fn by_turn(self, start: Vector3<f64>) -> Self {
        let arm = in_plane(self.axis, start - self.centre);
        Self {
            from: libm::atan2(arm.y, arm.x),
            turn: told(self.turn),
            radii: [arm.norm(); 2],
            ..self
        }
    }

    /// The centre of the arc of less than half a turn that has this radius. None where the ends are too far apart for it,
    /// or so far that the radius says little of the centre.
    pub(crate) fn centre_by_radius(
        direction: ArcDirection,
        [start, end]: [Vector3<f64>; 2],
        radius: f64,
    ) -> Option<Vector3<f64>> {
        let ArcDirection { axis, sense } = direction;
        let chord = in_plane(axis, end - start);
        let length = chord.norm();
        let depth = libm::sqrt((radius * radius - length * length / 4.0).max(0.0));
        if length <= 0.0 || depth < WELL_KNOWN * radius {
            return None;
        }
        let left = Vector2::new(-chord.y, chord.x) * (sense * depth / length);
        let mut centre = (start + end) / 2.0;
        centre[axis] = start[axis];
        centre[(axis + 1) % 3] += left.x;
        centre[(axis + 2) % 3] += left.y;
        Some(centre)
    }

    /// Difference of its ends in their distance from the centre.
    pub(crate) fn mismatch(&self) -> f64 {
        libm::fabs(self.radii[1] - self.radii[0])
    }

    /// What it goes along its axis.
    pub(crate) fn rise(&self) -> f64 {
        self.heights[1] - self.heights[0]
    }

    /// Length of the arc in the plane.
    pub(crate) fn length(&self) -> f64 {
        let radius = (self.radii[0] + self.radii[1]) / 2.0;
        libm::hypot(radius * self.turn, self.mismatch())
    }

    /// The place at `t` in 0 to 1.
    pub(crate) fn at(&self, t: f64) -> Vector3<f64> {
        let radius = self.radii[0] + (self.radii[1] - self.radii[0]) * t;
        let arm = toward(self.from + self.sense * self.turn * t) * radius;
        let mut place = self.centre;
        place[(self.axis + 1) % 3] += arm.x;
        place[(self.axis + 2) % 3] += arm.y;
        place[self.axis] = self.heights[0] + self.rise() * t;
        place
    }

    /// A bound on its second derivative by `t`, mm.
    pub(crate) fn bend(&self) -> f64 {
        let radius = self.radii[0].max(self.radii[1]);
        self.turn * (radius * self.turn + 2.0 * libm::fabs(self.radii[1] - self.radii[0]))
    }

    /// A bound on how far it is from `wanted`, an arc in the frame of the words, both gone along evenly; infinite where
    /// it is not that arc at all.
    ///
    /// `wanted` is first laid square to the axis by the least turn about its middle, which moves none of its points by more
    /// than the chord of that turn times its distance from there. Then both are seen from a frame that turns with the
    /// wanted one: what its radius and angle are off goes along nearly straight lines (off by no more than an eighth of
    /// the second derivative), and the way from centre to centre turns backwards evenly. That sum is looked at in
    /// places, between which it strays by no more than an eighth of its second derivative.
    pub(crate) fn deviation(&self, wanted: &PathArc) -> f64 {
        let mut up = Vector3::zeros();
        up[self.axis] = self.sense;
        let lean = (wanted.axis - up).norm();
        let extra = self.turn - wanted.sweep;
        if lean > LEANS || libm::fabs(extra) > ANOTHER_WAY {
            return f64::INFINITY;
        }
        let [low, high] = wanted.heights;
        let middle = wanted.centre + wanted.axis * ((low + high) / 2.0);
        let farthest = libm::hypot(wanted.radius(), (high - low) / 2.0);
        let across = wanted.axis.cross(&up);
        let sine = across.norm();
        let radial = match across.try_normalize(1e-300) {
            Some(about) => turn(wanted.radial, about, sine, wanted.axis.dot(&up)),
            None => wanted.radial,
        };
        let radial = in_plane(self.axis, radial);
        let wanted_from = libm::atan2(radial.y, radial.x);
        // Of the printed end seen in the turning frame, less the wanted one.
        let off = |end: usize| {
            let ahead = least_turn(self.from - wanted_from) + self.sense * extra * end as f64;
            toward(ahead) * self.radii[end] - Vector2::new(wanted.radii[end], 0.0)
        };
        let level = |end: usize| {
            let height = wanted.heights[end] - (low + high) / 2.0;
            self.heights[end] - (middle[self.axis] + self.sense * height)
        };
        let [first, last] = [off(0), off(1)];
        let [under, over] = [level(0), level(1)];
        let aside = in_plane(self.axis, self.centre - middle);
        let largest = self.radii[0].max(self.radii[1]);
        let extra = libm::fabs(extra);
        let bow = (2.0 * self.mismatch() * extra + largest * extra * extra) / 8.0;
        let bend = aside.norm() * wanted.sweep * wanted.sweep;
        let count = libm::ceil(libm::sqrt(bend / (8.0 * BLIND))).clamp(4.0, 512.0);
        let mut most: f64 = 0.0;
        for step in 0..=count as u32 {
            let t = f64::from(step) / count;
            // The way between the centres in the frame that turns with the wanted arc.
            let (sine, cosine) = libm::sincos(wanted_from + self.sense * wanted.sweep * t);
            let back =
                Vector2::new(aside.x * cosine + aside.y * sine, aside.y * cosine - aside.x * sine);
            let flat = first * (1.0 - t) + last * t + back;
            let upright = under * (1.0 - t) + over * t;
            most = most.max(libm::hypot(flat.norm(), upright));
        }
        most + bend / (8.0 * count * count) + bow + lean * farthest
    }

    /// Shares of the way at which an axis turns back that goes with the words as `slide` says, mm a mm.
    pub(crate) fn turns_back(&self, slide: Vector3<f64>) -> impl Iterator<Item = f64> {
        let plane = in_plane(self.axis, slide);
        let speed = plane.norm() * self.radii[0].max(self.radii[1]) * self.turn;
        // It stands where what it goes with the turn and with the height cancel out.
        let sine = self.sense * slide[self.axis] * self.rise() / speed;
        let toward = libm::atan2(plane.y, plane.x);
        let turns = sine.is_finite() && libm::fabs(sine) <= 1.0;
        let rest = libm::asin(sine.clamp(-1.0, 1.0));
        let (from, sense, turn) = (self.from, self.sense, self.turn);
        [toward + rest, toward + PI - rest]
            .into_iter()
            .filter(move |_| turns)
            .flat_map(move |angle| {
                let ahead = sense * (angle - from);
                let first = ahead - TAU * libm::floor(ahead / TAU);
                [first, first + TAU]
            })
            .map(move |ahead| ahead / turn)
            .filter(|share| *share > 0.0 && *share < 1.0)
    }

    /// What an axis that goes with the words as `slide` says goes at most in the time of the whole arc, if it went as fast
    /// as it does where it is fastest, mm.
    pub(crate) fn fastest(&self, slide: Vector3<f64>) -> f64 {
        let plane = in_plane(self.axis, slide);
        let toward = libm::atan2(plane.y, plane.x);
        // The speed goes with the sine of the angle from where the axis points.
        let angle = self.from - toward;
        let ends = [angle, angle + self.sense * self.turn];
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let peak = libm::ceil((low - FRAC_PI_2) / PI) * PI + FRAC_PI_2;
        let most = match peak <= high {
            true => 1.0,
            false => ends.map(|end| libm::fabs(libm::sin(end))).into_iter().fold(0.0, f64::max),
        };
        let largest = self.radii[0].max(self.radii[1]);
        plane.norm() * (largest * self.turn * most + self.mismatch())
            + libm::fabs(slide[self.axis] * self.rise())
    }
}
