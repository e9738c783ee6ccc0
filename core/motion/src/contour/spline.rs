//! The cubic spline through set-points.
//!
//! A knot is passed with the derivative of five set-points (its error falls with the fourth power of the period, and so
//! does that of the spline), under three limits, so that the spline neither overshoots at stops, corners and reversals
//! nor swings before and behind them:
//!
//! - a second difference counts with no more than [`PEAK`] times the larger of its neighbours: a corner between two
//!   set-points stands alone among them, and is passed on its chords;
//! - so do the two third differences, each against the other: what lies behind a corner does not bend the way up to it;
//! - a tangent never points back along its chord and is no longer than three chords: the way along the chord never falls
//!   (Fritsch, Carlson 1980), and where the machine stands the spline stands.

use nalgebra::Vector3;

/// A difference counts with so many times its neighbours.
const PEAK: f64 = 4.0;

/// How a knot is reached and left, a period as unit of time.
pub(super) type Tangents = [Vector3<f64>; 2];

/// The tangents at the middle one of five set-points.
#[inline]
pub(super) fn tangents(at: [&Vector3<f64>; 5]) -> Tangents {
    let chords: [Vector3<f64>; 4] = std::array::from_fn(|place| at[place + 1] - at[place]);
    let [before, second, behind] = [0, 1, 2].map(|place| chords[place + 1] - chords[place]);
    let (third, next) = (second - before, behind - second);
    let neighbours = before.norm_squared().max(behind.norm_squared());
    let half = clipped(second, neighbours) * 0.5;
    let [third, next] = [
        clipped(third, next.norm_squared()),
        clipped(next, third.norm_squared()),
    ];
    let bend = (third + next) * (1.0 / 12.0);
    [
        held(chords[1] + half - bend, &chords[1]),
        held(chords[2] - half - bend, &chords[2]),
    ]
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
pub(super) struct Cubic {
    start: Vector3<f64>,
    first: Vector3<f64>,
    second: Vector3<f64>,
    third: Vector3<f64>,
}

impl Cubic {
    /// From one knot, left so, to another, reached so.
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

    /// Its first derivative.
    #[inline]
    pub fn slope(&self, s: f64) -> Vector3<f64> {
        self.first + (self.second * 2.0 + self.third * (3.0 * s)) * s
    }

    /// Its second derivative.
    #[inline]
    pub fn bend(&self, s: f64) -> Vector3<f64> {
        self.second * 2.0 + self.third * (6.0 * s)
    }

    /// Its third derivative.
    #[inline]
    pub fn jerk(&self) -> Vector3<f64> {
        self.third * 6.0
    }
}
