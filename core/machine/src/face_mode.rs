//! Polar interpolation by the control: while it is in force the part is turned by the control, and two words are right-angled
//! coordinates of the tip on the end face (G12.1, TRANSMIT, G112).
//!
//! The machine in the mode is one of three linear axes: the word of the axis that turns the part moves the tip across that of
//! the axis towards its line. What the real axes do follows from these two in polar coordinates.

use std::f64::consts::{PI, TAU};

use crate::kinematics::Joints;

/// A mode of the control for the end face of the part.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceMode {
    /// Lines of the program that begin it.
    pub on: Vec<String>,
    /// Lines of the program that end it.
    pub off: Vec<String>,
    /// The letter behind which the word of the turning axis stands in it.
    pub letter: String,
    /// The tip comes no nearer to the line of the turning axis, mm.
    pub pole: f64,
    /// Place in the chain of the axis that turns the part.
    pub turning: usize,
    /// Place in the chain of the linear axis that leads towards its line.
    pub across: usize,
    /// Value of that axis with the tip on the line, mm.
    pub centre: f64,
    /// Largest feed of the turning axis, rad/min.
    pub turning_feed: f64,
    /// Largest feed of the linear axis that leads to its line, mm/min.
    pub across_feed: f64,
}

impl FaceMode {
    /// Coordinates of the tip on the face, mm, of axis values in the mode.
    pub fn place(&self, virtual_joints: &Joints) -> [f64; 2] {
        [virtual_joints[self.across] - self.centre, virtual_joints[self.turning]]
    }

    /// Coordinates of the tip on the face, mm, of the real axis values.
    pub fn real_place(&self, real: &Joints) -> [f64; 2] {
        let radius = real[self.across] - self.centre;
        let (sine, cosine) = libm::sincos(real[self.turning]);
        [radius * cosine, radius * sine]
    }

    /// The real values of the axes of a place on the face, the others of `joints`; of all turns of the part that next to
    /// `near`, radians.
    pub fn real(&self, [x, y]: [f64; 2], joints: &Joints, near: f64) -> Joints {
        let mut real = *joints;
        real[self.across] = self.centre + libm::hypot(x, y);
        let angle = libm::atan2(y, x);
        real[self.turning] = match x == 0.0 && y == 0.0 {
            true => near,
            false => angle + TAU * libm::rint((near - angle) / TAU),
        };
        real
    }

    /// How near the straight way between two places comes to the line of the turning axis, mm.
    pub fn nearest(from: [f64; 2], to: [f64; 2]) -> f64 {
        let way = [to[0] - from[0], to[1] - from[1]];
        let square = way[0] * way[0] + way[1] * way[1];
        let along = match square > 0.0 {
            true => (-(from[0] * way[0] + from[1] * way[1]) / square).clamp(0.0, 1.0),
            false => 0.0,
        };
        libm::hypot(from[0] + way[0] * along, from[1] + way[1] * along)
    }

    /// How far the part would turn on the straight way between two places if it turned all the way as fast as at the place
    /// nearest to the line, radians; none on a way that leads along a radius.
    pub fn most_turn(from: [f64; 2], to: [f64; 2]) -> f64 {
        let moment = libm::fabs(from[0] * to[1] - from[1] * to[0]);
        let nearest = Self::nearest(from, to);
        if moment <= 0.0 { 0.0 } else { moment / (nearest * nearest) }
    }

    /// The least time of the straight way between two places, minutes: neither real axis passes its largest feed.
    pub fn least_minutes(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let way = libm::hypot(to[0] - from[0], to[1] - from[1]);
        (Self::most_turn(from, to) / self.turning_feed).max(way / self.across_feed)
    }

    /// Places on the way from the radius `radius` mm at angle zero, where the mode begins, to a place at that radius: each no
    /// more than a sixth of a turn from the one before, the place itself the last. None where that is where it begins.
    pub fn round_to(place: [f64; 2]) -> Vec<[f64; 2]> {
        let radius = libm::hypot(place[0], place[1]);
        let angle = libm::atan2(place[1], place[0]);
        let count = libm::ceil(libm::fabs(angle) / (PI / 3.0)) as u32;
        let between = (1..count).map(|step| {
            let (sine, cosine) = libm::sincos(angle * f64::from(step) / f64::from(count));
            [radius * cosine, radius * sine]
        });
        let last = (count > 0).then_some(place);
        between.chain(last).collect()
    }
}
