//! A profile of revolution of lines and arcs, between two of lines alone.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Lines that stand for an arc are no farther from it, mm.
const WITHIN: f64 = 0.002;

/// Angles that differ by less are the same, radians: what rounding leaves at the ends of an arc.
const SAME: f64 = 1e-9;

/// A profile of revolution, points [z, r] in mm, z in rising order. Where it has arcs no point of the outer outline is inside
/// of them and none of the inner outside, and both are within two micrometres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TurnedProfile {
    /// On the outline: ends of lines and arcs, and points of arcs between them.
    pub points: Vec<[f64; 2]>,
    /// Around it: what may hit something, and what may be cut.
    pub outer: Vec<[f64; 2]>,
    /// In it: what certainly is cut, and what certainly is hit.
    pub inner: Vec<[f64; 2]>,
}

/// Why there is no such arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoArc {
    /// Its radius does not reach from one end to the other, this far apart, mm.
    Short(f64),
    /// It goes back in z on its way.
    Back,
    /// It comes nearer to the axis than this, mm: beyond it.
    Beyond(f64),
}

impl From<Vec<[f64; 2]>> for TurnedProfile {
    fn from(points: Vec<[f64; 2]>) -> Self {
        Self { outer: points.clone(), inner: points.clone(), points }
    }
}

impl TurnedProfile {
    /// It has no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Goes on along a line.
    pub fn line_to(&mut self, to: [f64; 2]) {
        for points in [&mut self.points, &mut self.outer, &mut self.inner] {
            points.push(to);
        }
    }

    /// Goes on along the shorter arc of a radius, mm: above zero it bulges away from the axis, its middle on the side of what
    /// it bounds; below zero it is hollow.
    ///
    /// # Errors
    /// No arc of this radius leads there that keeps the order of z and its side of the axis.
    pub fn arc_to(&mut self, to: [f64; 2], radius: f64) -> Result<(), NoArc> {
        let Some(&from) = self.points.last() else {
            self.line_to(to);
            return Ok(());
        };
        let (size, hollow) = (libm::fabs(radius), radius < 0.0);
        let [dz, dr] = [to[0] - from[0], to[1] - from[1]];
        let chord = libm::hypot(dz, dr);
        if 0.5 * chord > size * (1.0 + SAME) || chord == 0.0 {
            return Err(NoArc::Short(chord));
        }
        let height = (size * size - 0.25 * chord * chord).max(0.0).sqrt();
        // To the right of the way from one end to the other is what the profile bounds.
        let side = if hollow { -height / chord } else { height / chord };
        let centre = [0.5 * (from[0] + to[0]) + side * dr, 0.5 * (from[1] + to[1]) - side * dz];
        // Angles from the direction of z: from PI down to 0 if it bulges, else on from PI to two PI. Rounding tells the ends of
        // half a turn by either sign.
        let angle = |[z, r]: [f64; 2]| libm::atan2(r - centre[1], z - centre[0]);
        let [start, end] = match hollow {
            false => [angle(from), angle(to)].map(|at| if at < -FRAC_PI_2 { at + TAU } else { at }),
            true => [angle(from), angle(to)].map(|at| if at < SAME { at + TAU } else { at }),
        };
        let range = if hollow { [PI, TAU] } else { [0.0, PI] };
        let inside = |at: f64| (range[0] - SAME..=range[1] + SAME).contains(&at);
        let rises = if hollow { end > start } else { start > end };
        if !(inside(start) && inside(end) && rises) {
            return Err(NoArc::Back);
        }
        let far = if hollow { 3.0 * FRAC_PI_2 } else { FRAC_PI_2 };
        let mut ends = vec![start];
        if (start - far) * (end - far) < 0.0 {
            if centre[1] < size && hollow {
                return Err(NoArc::Beyond(centre[1] - size));
            }
            // Where it is farthest from the axis, or nearest, both outlines have a point.
            ends.push(far);
        }
        ends.push(end);
        let place = |at: f64, size: f64| {
            let z = centre[0] + size * libm::cos(at);
            [z.clamp(from[0], to[0]), (centre[1] + size * libm::sin(at)).max(0.0)]
        };
        let most = 2.0 * libm::acos((1.0 - WITHIN / size).max(0.5));
        for pair in ends.windows(2) {
            let turn = pair[1] - pair[0];
            let count = libm::ceil(libm::fabs(turn) / most).max(1.0);
            let half = 0.5 * turn / count;
            for piece in 0..count as u32 {
                let at = pair[0] + 2.0 * half * f64::from(piece);
                let last = pair[1] == end && f64::from(piece + 1) == count;
                let next = if last { to } else { place(at + 2.0 * half, size) };
                // Tangents at the ends of the piece meet there.
                let meet = place(at + half, size / libm::cos(half));
                let (chords, tangents) = match hollow {
                    true => (&mut self.outer, &mut self.inner),
                    false => (&mut self.inner, &mut self.outer),
                };
                chords.push(next);
                tangents.push(meet);
                if last {
                    tangents.push(to);
                }
                self.points.push(next);
            }
        }
        Ok(())
    }
}
