//! Arcs become chords within a tolerance.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::limits::direction;

/// An arc about an axis; a spiral or a helix where its ends differ in radius or height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathArc {
    /// Where heights count from, mm.
    pub(crate) centre: Vector3<f64>,
    /// Axis about which it turns right-handed, unit vector.
    pub(crate) axis: Vector3<f64>,
    /// Direction from the centre to the start, in the plane, unit vector.
    pub(crate) radial: Vector3<f64>,
    /// Radii of its start and its end, mm.
    pub(crate) radii: [f64; 2],
    /// Heights of its start and its end above the centre along the axis, mm.
    pub(crate) heights: [f64; 2],
    /// Angle that it turns by, radians, above zero.
    pub(crate) sweep: f64,
}

/// Ends nearer than this are one point, so the arc is a whole turn: mm. No CAM system writes arcs so short.
const CLOSED: f64 = 1e-3;

/// An end that lies less ahead of the start is the start: what is left of it in numbers of ten digits, mm.
const ROUNDED: f64 = 1e-7;

/// An arc whose end lies so little ahead of its start that the other reading may be meant: by how much, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArcAmbiguity {
    /// The arc is made as the short one between them.
    Short(f64),
    /// The arc is made as a whole turn.
    Turn(f64),
}

impl PathArc {
    /// The arc from `start` to `end`, right-handed about `axis`, over `turns` passes of its end (1 is the usual arc).
    ///
    /// # Errors
    /// If the axis is null or an end lies on it.
    pub fn new(
        start: Vector3<f64>,
        end: Vector3<f64>,
        centre: Vector3<f64>,
        axis: Vector3<f64>,
        turns: u32,
    ) -> Result<Self, &'static str> {
        let axis = direction(axis).ok_or("its axis has no direction")?;
        let split = |point: Vector3<f64>| {
            let height = axis.dot(&(point - centre));
            (point - centre - axis * height, height)
        };
        let (from, start_height) = split(start);
        let (to, end_height) = split(end);
        let radial = from.try_normalize(1e-9).ok_or("it starts at its own centre")?;
        if to.norm() < 1e-9 {
            return Err("it ends at its own centre");
        }
        let tangent = axis.cross(&radial);
        let mut sweep = libm::atan2(tangent.dot(&to), radial.dot(&to));
        if (to - from).norm() < CLOSED {
            sweep = TAU;
        } else if sweep <= 0.0 {
            sweep += TAU;
        }
        sweep += TAU * f64::from(turns.max(1) - 1);
        Ok(Self {
            centre,
            axis,
            radial,
            radii: [from.norm(), to.norm()],
            heights: [start_height, end_height],
            sweep,
        })
    }

    /// Places the arc elsewhere: `turn` takes directions and `shift` points, a rotation and what goes with it.
    pub fn placed(
        &self,
        shift: impl Fn(Vector3<f64>) -> Vector3<f64>,
        turn: impl Fn(Vector3<f64>) -> Vector3<f64>,
    ) -> Self {
        Self {
            centre: shift(self.centre),
            axis: turn(self.axis),
            radial: turn(self.radial),
            ..*self
        }
    }

    /// Difference of the distances of its ends from the centre, mm.
    pub fn mismatch(&self) -> f64 {
        libm::fabs(self.radii[1] - self.radii[0])
    }

    /// What else may be meant where the end lies just ahead of the start; an end just after it is nearly a whole turn
    /// either way. `end` is the point that the file gives, in the frame of the arc.
    pub fn doubt(&self, end: Vector3<f64>) -> Option<ArcAmbiguity> {
        let ahead = self.axis.cross(&self.radial).dot(&(end - self.centre));
        if !(ROUNDED..10.0 * CLOSED).contains(&ahead) || self.radial.dot(&(end - self.centre)) < 0.0
        {
            return None;
        }
        Some(match self.sweep < PI {
            true => ArcAmbiguity::Short(ahead),
            false => ArcAmbiguity::Turn(ahead),
        })
    }

    /// The largest of its radii, mm.
    pub fn radius(&self) -> f64 {
        self.radii[0].max(self.radii[1])
    }

    /// Number of chords that stay within `tolerance` mm, and how far they stray.
    ///
    /// The second derivative along t is at most `radius·sweep² + 2·|Δradius|·sweep`, so a chord over 1/n of
    /// the arc strays by at most an eighth of that over n².
    pub fn chords(&self, tolerance: f64) -> (u64, f64) {
        let bend = self.radius() * self.sweep * self.sweep + 2.0 * self.mismatch() * self.sweep;
        let count = libm::ceil(libm::sqrt(bend / (8.0 * tolerance))).max(1.0);
        (count as u64, bend / (8.0 * count * count))
    }

    /// Radius and height at `t`.
    fn level(&self, t: f64) -> [f64; 2] {
        [self.radii, self.heights].map(|[from, to]| from + (to - from) * t)
    }

    /// The piece of it from `from` to `to`, both in 0 to 1.
    pub fn piece(&self, from: f64, to: f64) -> Self {
        let (sine, cosine) = libm::sincos(self.sweep * from);
        let [first, last] = [from, to].map(|t| self.level(t));
        Self {
            radial: self.radial * cosine + self.axis.cross(&self.radial) * sine,
            radii: [first[0], last[0]],
            heights: [first[1], last[1]],
            sweep: self.sweep * (to - from),
            ..*self
        }
    }

    /// The point at `t` in 0 to 1.
    pub fn at(&self, t: f64) -> Vector3<f64> {
        let (sine, cosine) = libm::sincos(self.sweep * t);
        let [radius, height] = self.level(t);
        self.centre
            + (self.radial * cosine + self.axis.cross(&self.radial) * sine) * radius
            + self.axis * height
    }

    /// The direction of travel at `t` in 0 to 1, part frame, not of length one.
    pub(crate) fn travel(&self, t: f64) -> Vector3<f64> {
        let (sine, cosine) = libm::sincos(self.sweep * t);
        let across = self.axis.cross(&self.radial);
        let [radius, _] = self.level(t);
        let [outwards, upwards] = [self.radii, self.heights].map(|[from, to]| to - from);
        (self.radial * cosine + across * sine) * outwards
            + (across * cosine - self.radial * sine) * (radius * self.sweep)
            + self.axis * upwards
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(x: f64, y: f64, z: f64) -> Vector3<f64> {
        Vector3::new(x, y, z)
    }

    #[test]
    fn quarter_turns_go_the_way_of_the_axis() {
        let (start, end) = (point(10.0, 0.0, 0.0), point(0.0, 10.0, 0.0));
        let forth = PathArc::new(start, end, Vector3::zeros(), Vector3::z(), 1).unwrap();
        let back = PathArc::new(start, end, Vector3::zeros(), -Vector3::z(), 1).unwrap();
        let half = std::f64::consts::FRAC_1_SQRT_2 * 10.0;
        assert!((forth.at(0.5) - point(half, half, 0.0)).norm() < 1e-12);
        assert!((back.at(0.5) - point(-half, -half, 0.0)).norm() < 1e-12);
        assert!((back.at(1.0) - end).norm() < 1e-12);
    }

    #[test]
    fn travel_is_what_the_point_does() {
        let arc = PathArc::new(
            point(10.0, 0.0, 0.0),
            point(-2.0, 7.0, 3.0),
            point(0.5, 0.2, 0.0),
            -Vector3::z(),
            2,
        );
        let arc = arc.unwrap();
        for t in [0.1, 0.4, 0.9] {
            let way = (arc.at(t + 1e-6) - arc.at(t - 1e-6)) / 2e-6;
            assert!((arc.travel(t) - way).norm() < 1e-6 * way.norm(), "{way}");
        }
    }

    #[test]
    fn equal_ends_are_a_whole_turn_and_heights_a_helix() {
        let start = point(10.0, 0.0, 0.0);
        let arc =
            PathArc::new(start, point(10.0, 0.0, 3.0), Vector3::zeros(), Vector3::z(), 1).unwrap();
        assert!((arc.at(0.5) - point(-10.0, 0.0, 1.5)).norm() < 1e-12);
        let two =
            PathArc::new(start, point(10.0, 0.0, 3.0), Vector3::zeros(), Vector3::z(), 2).unwrap();
        assert!((two.at(0.5) - point(10.0, 0.0, 1.5)).norm() < 1e-12);
    }

    #[test]
    fn an_end_just_ahead_of_the_start_is_doubtful() {
        let start = point(10.0, 0.0, 0.0);
        let doubt = |end: Vector3<f64>, axis: f64| {
            let axis = Vector3::z() * axis;
            PathArc::new(start, end, Vector3::zeros(), axis, 1).unwrap().doubt(end)
        };
        let turn = doubt(point(10.0, 2e-4, 0.0), 1.0);
        assert!(matches!(turn, Some(ArcAmbiguity::Turn(ahead)) if (ahead - 2e-4).abs() < 1e-9));
        let short = doubt(point(10.0, 4e-3, 1.0), 1.0);
        assert!(matches!(short, Some(ArcAmbiguity::Short(ahead)) if (ahead - 4e-3).abs() < 1e-9));
        // The start itself, an end after it, an arc, and a half turn are what they are.
        assert_eq!(doubt(start, 1.0), None);
        assert_eq!(doubt(point(10.0, 2e-4, 0.0), -1.0), None);
        assert_eq!(doubt(point(10.0, 4e-3, 0.0), -1.0), None);
        assert_eq!(doubt(point(9.998, 0.2, 0.0), 1.0), None);
        assert_eq!(doubt(point(-10.0, 1e-3, 0.0), 1.0), None);
    }

    #[test]
    fn chords_stay_within_what_they_promise() {
        let arc = PathArc::new(
            point(50.0, 0.0, 0.0),
            point(-49.0, 3.0, 7.0),
            point(0.0, 1.0, 0.0),
            point(0.1, 0.0, 1.0),
            1,
        )
        .unwrap();
        for tolerance in [0.5, 0.01, 0.001] {
            let (count, promised) = arc.chords(tolerance);
            assert!(promised <= tolerance);
            let mut worst: f64 = 0.0;
            for piece in 0..count {
                let (a, b) = (piece as f64 / count as f64, (piece + 1) as f64 / count as f64);
                for step in 0..=20 {
                    let t = f64::from(step) / 20.0;
                    let chord = arc.at(a) * (1.0 - t) + arc.at(b) * t;
                    worst = worst.max((arc.at(a + (b - a) * t) - chord).norm());
                }
            }
            assert!(worst <= promised, "{worst} above {promised}");
            assert!(worst >= 0.6 * promised, "{worst} far below {promised}");
        }
    }
}
