//! Curves over one move: the largest value, and how well one explains another.

/// Even pieces that are looked at before the largest is refined.
const PIECES: u32 = 64;

/// Steps of the refinement: each leaves 0.62 of the interval, so that it ends below a billionth of the move.
const STEPS: u32 = 40;

/// Even pieces of a move over which fits are compared: 101 samples, ends included.
const FIT_PIECES: u32 = 100;

/// The largest value over a move, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    /// How large, in the curve's own unit.
    pub size: f64,
    /// Where: share of the move.
    pub at: f64,
}

/// The largest value of `curve` over 0 to 1: densely sampled, then refined about the largest sample (golden section).
pub fn peak(curve: impl Fn(f64) -> f64) -> Peak {
    let mut best = Peak { size: curve(0.0), at: 0.0 };
    let see = |best: &mut Peak, at: f64| {
        let size = curve(at);
        if size > best.size {
            *best = Peak { size, at };
        }
        size
    };
    for step in 1..=PIECES {
        see(&mut best, f64::from(step) / f64::from(PIECES));
    }
    let width = 1.0 / f64::from(PIECES);
    let (mut low, mut high) = ((best.at - width).max(0.0), (best.at + width).min(1.0));
    let golden = (libm::sqrt(5.0) - 1.0) / 2.0;
    let (mut a, mut b) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_a, mut at_b) = (see(&mut best, a), see(&mut best, b));
    for _ in 0..STEPS {
        if at_a >= at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - golden * (high - low);
            at_a = see(&mut best, a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + golden * (high - low);
            at_b = see(&mut best, b);
        }
    }
    best
}

/// Coefficient of determination of `fit` as an explanation of `curve`, both lengths over a move:
/// `R² = 1 - Σ(curve - fit)² / Σ(curve - mean)²` over 101 even samples. 1 is a perfect fit; none if the curve is
/// constant.
pub fn explained(curve: impl Fn(f64) -> f64, fit: impl Fn(f64) -> f64) -> Option<f64> {
    let places = || (0..=FIT_PIECES).map(|step| f64::from(step) / f64::from(FIT_PIECES));
    let values: Vec<f64> = places().map(&curve).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares = |about: &dyn Fn(f64) -> f64| -> f64 {
        let away = values.iter().zip(places()).map(|(value, t)| value - about(t));
        away.map(|away| away * away).sum()
    };
    let total = squares(&|_| mean);
    // Less than what rounding makes of a constant.
    (total > 1e-24 * squares(&|_| 0.0)).then(|| 1.0 - squares(&fit) / total)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_peak_between_samples_is_found() {
        let found = peak(|t| 3.0 - (t - 0.3217) * (t - 0.3217));
        assert!((found.at - 0.3217).abs() < 1e-7);
        assert!((found.size - 3.0).abs() < 1e-12);
        assert_eq!(peak(|t| t), Peak { size: 1.0, at: 1.0 });
        assert_eq!(peak(|_| 0.0).size, 0.0);
    }

    /// The parabola 4t(1 - t) and the sine of the same height: 0.9862 (papers/README.md, parabolic).
    #[test]
    fn a_sine_explains_a_parabola_by_0_9862() {
        let parabola = |t: f64| 4.0 * t * (1.0 - t);
        let sine = |t: f64| libm::sin(PI * t);
        let share = explained(parabola, sine).unwrap();
        assert!((share - 0.9862).abs() < 5e-5, "{share}");
        assert_eq!(explained(parabola, parabola), Some(1.0));
        assert_eq!(explained(|_| 0.1, sine), None);
    }
}
