//! What a CL file may ask for: beyond these a number is a slip, or the file means harm.
//!
//! Every number of a CL file is finite (the grammar sees to it); here each gets a size that a machine could have, so that
//! no sum or square of them leaves the doubles, no word loses its decimals, and no record becomes work without end.

use nalgebra::Vector3;

/// A coordinate, mm: ten kilometres. No machine is a hundredth as large, and six decimals still fit a double.
pub const MOST_COORDINATE: f64 = 1e7;

/// Chords of one arc or spline. A helix of a thousand turns at a radius of 50 mm takes 700,000 for half a micrometre.
pub const MOST_CHORDS: u64 = 1_000_000;

/// Knots or control points of one spline: it is held in memory until it ends.
pub const MOST_SPLINE_NUMBERS: usize = 1_000_000;

/// Pecks in one hole.
pub const MOST_PECKS: f64 = 10_000.0;

/// A dwell, s: a day.
pub const LONGEST_DWELL: f64 = 86_400.0;

/// Least and largest feed, mm/min: up to a kilometre a minute, three times the fastest linear motors.
pub const FEEDS: [f64; 2] = [1e-12, 1e6];

/// Least and largest feed a revolution, mm.
pub const FEEDS_A_TURN: [f64; 2] = [1e-12, 1e4];

/// Least and largest feed by time, moves a minute.
pub const FEEDS_BY_TIME: [f64; 2] = [1e-12, 1e9];

/// An angle of an index axis, degrees: a hundred turns.
pub const MOST_DEGREES: f64 = 36_000.0;

/// Different words that post does not know. Of the real files at hand none has more than 19; one with fifty times as many is no
/// cutter-location file.
pub const MOST_WORDS: usize = 1_000;

/// Different tools of one file, and different cutters of one that loads none.
pub const MOST_TOOLS: usize = 1_000;

/// Waits of a channel for others: they are kept to the end, for the job that joins the channels.
pub const MOST_WAITS: usize = 10_000;

/// Normalises a direction; none if its length is zero, or so large or small that its square is lost.
#[inline]
pub(crate) fn direction(vector: Vector3<f64>) -> Option<Vector3<f64>> {
    (vector.amax() < 1e9).then(|| vector.try_normalize(1e-9)).flatten()
}

/// The point is one that a machine could reach.
#[inline]
pub(crate) fn is_near(point: Vector3<f64>) -> bool {
    point.amax() <= MOST_COORDINATE
}
