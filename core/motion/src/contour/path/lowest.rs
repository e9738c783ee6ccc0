//! The nearest point of one piece: Newton's steps in a bracket.

use nalgebra::Vector3;

use super::super::spline::SplineSegment;

/// Newton steps in a piece; they are bisections where Newton leaves its bracket.
const STEPS: usize = 60;

/// Least Newton step, mm.
const SMALL: f64 = 1e-13;

/// How far the next one would go is told by the square of one that is no longer than this share of a piece.
const SHORT: f64 = 1e-3;

/// Share of a piece that counts as nothing.
const NONE: f64 = 1e-13;

/// The share of a piece at which the distance is least, downhill from `start`; 0 or 1 where it falls beyond the ends.
#[inline]
pub(super) fn lowest(cubic: &SplineSegment, from: &Vector3<f64>, start: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut share = start.clamp(0.0, 1.0);
    for _ in 0..STEPS {
        let offset = cubic.at(share) - from;
        let slope = cubic.slope(share);
        let bend = cubic.bend(share);
        let square = slope.norm_squared();
        let rise = match square == 0.0 {
            // Where the machine stands: as just inside the piece.
            true => offset.dot(&bend) * if share < 0.5 { 1.0 } else { -1.0 },
            false => offset.dot(&slope),
        };
        if offset == Vector3::zeros() {
            return share;
        }
        match rise > 0.0 {
            true => high = share,
            false => low = share,
        }
        if low >= high {
            return share;
        }
        let curve = square + offset.dot(&bend);
        if rise == 0.0 && curve > 0.0 && square > 0.0 {
            // Here it is, and the bracket closes upon nothing.
            break;
        }
        let next = share - rise / curve;
        // Newton; or downhill as far as the bracket goes, which is an end of the piece if none was passed before.
        let newton = curve > 0.0 && next > low && next < high;
        let next = match newton {
            true => next,
            false if curve > 0.0 && rise > 0.0 && low == 0.0 => 0.0,
            false if curve > 0.0 && rise <= 0.0 && high == 1.0 => 1.0,
            false => 0.5 * (low + high),
        };
        let done = match newton {
            // The next step would be the square of this one times half the change of the curve over the curve.
            true => {
                let step = next - share;
                let change = 3.0 * slope.dot(&bend) + offset.dot(&cubic.jerk());
                let left = step * step * change;
                libm::fabs(step) < SHORT
                    && left * left * square < 4.0 * curve * curve * (SMALL * SMALL)
            }
            false => high - low < NONE,
        };
        share = next;
        if done {
            break;
        }
    }
    match share {
        share if share < NONE => 0.0,
        share if share > 1.0 - NONE => 1.0,
        share => share,
    }
}
