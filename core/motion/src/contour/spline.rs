//! The cubic spline through set-points.
//!
//! A knot is passed with the derivative of five set-points (its error falls with the fourth power of the period, and so
//! does that of the spline), under three limits, so that the spline neither overshoots at stops, corners and reversals
//! nor swings before and after them:
//!
//! - a second difference counts with no more than [`PEAK`] times the larger of its neighbours: a corner between two
//!   set-points stands alone among them, and is passed on its chords;
//! - so do the two third differences, each against the other: what lies after a corner does not bend the way up to it;
//! - a tangent never points back along its chord and is no longer than three chords: the way along the chord never
//!   falls (Fritsch, Carlson 1980), and where the machine stands the spline stands.

use nalgebra::Vector3;

/// Weight of a difference against its neighbours.
const PEAK: f64 = 4.0;

/// How a knot is reached and left, a period as unit of time.
pub(super) type Tangents = [Vector3<f64>; 2];

/// Five set-points that move on one by one: their differences, each taken once.
#[derive(Clone, Debug, Default)]
pub(super) struct FivePoints {
    last: Vector3<f64>,
    /// The last three chords; the last three second differences with their squares; the last two third ones likewise.
    chords: [Vector3<f64>; 3],
    seconds: [(Vector3<f64>, f64); 3],
    thirds: [(Vector3<f64>, f64); 2],
}

impl FivePoints {
    /// Five set-points that all stand at `point`.
    pub fn all_at(point: &Vector3<f64>) -> Self {
        Self { last: *point, ..Self::default() }
    }

    /// Takes the next one, and says the tangents at the middle one of the five that there are now.
    #[inline]
    pub fn take(&mut self, point: &Vector3<f64>) -> Tangents {
        let with_square = |vector: Vector3<f64>| (vector, vector.norm_squared());
        let chord = point - self.last;
        let second = with_square(chord - self.chords[2]);
        let third = with_square(second.0 - self.seconds[2].0);
        self.last = *point;
        self.chords = [self.chords[1], self.chords[2], chord];
        self.seconds = [self.seconds[1], self.seconds[2], second];
        self.thirds = [self.thirds[1], third];
        let [before, (second, _), behind] = self.seconds;
        let half = clipped(second, before.1.max(behind.1)) * 0.5;
        let [(third, square), (next, next_square)] = self.thirds;
        let bend = (clipped(third, next_square) + clipped(next, square)) * (1.0 / 12.0);
        let [before, behind, _] = self.chords;
        [held(before + half - bend, &before), held(behind - half - bend, &behind)]
    }
}

/// A vector no longer than [`PEAK`] times the one whose square is given.
#[inline]
fn clipped(vector: Vector3<f64>, neighbour: f64) -> Vector3<f64> {
    no_longer(vector, neighbour * (PEAK * PEAK))
}

/// A vector no longer than the root of `most`.
#[inline]
fn no_longer(vector: Vector3<f64>, most: f64) -> Vector3<f64> {
    let square = vector.norm_squared();
    match square > most {
        true => vector * (most / square).sqrt(),
        false => vector,
    }
}

/// A tangent that neither points back along its chord nor is longer than three of it.
#[inline]
fn held(tangent: Vector3<f64>, chord: &Vector3<f64>) -> Vector3<f64> {
    let square = chord.norm_squared();
    let along = tangent.dot(chord);
    let tangent = match along < 0.0 && square > 0.0 {
        true => tangent - chord * (along / square),
        false => tangent,
    };
    no_longer(tangent, square * 9.0)
}

/// The spline between two knots.
#[derive(Clone, Copy, Debug)]
pub(super) struct SplineSegment {
    start: Vector3<f64>,
    first: Vector3<f64>,
    second: Vector3<f64>,
    third: Vector3<f64>,
}

impl SplineSegment {
    /// The cubic from one knot, left with the derivative `leaves`, to another, reached with `reaches`.
    #[inline]
    pub fn new(ends: [&Vector3<f64>; 2], leaves: &Vector3<f64>, reaches: &Vector3<f64>) -> Self {
        let chord = ends[1] - ends[0];
        Self {
            start: *ends[0],
            first: *leaves,
            second: chord * 3.0 - leaves * 2.0 - reaches,
            third: leaves + reaches - chord * 2.0,
        }
    }

    /// The point at `s` from 0 to 1.
    #[inline]
    pub fn at(&self, s: f64) -> Vector3<f64> {
        self.start + (self.first + (self.second + self.third * s) * s) * s
    }

    /// First derivative at `s`.
    #[inline]
    pub fn slope(&self, s: f64) -> Vector3<f64> {
        self.first + (self.second * 2.0 + self.third * (3.0 * s)) * s
    }

    /// Second derivative at `s`.
    #[inline]
    pub fn bend(&self, s: f64) -> Vector3<f64> {
        self.second * 2.0 + self.third * (6.0 * s)
    }

    /// Third derivative, the same everywhere.
    #[inline]
    pub fn jerk(&self) -> Vector3<f64> {
        self.third * 6.0
    }
}
