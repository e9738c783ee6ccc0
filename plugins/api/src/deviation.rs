//! What every error model does with deviations: ask for them, add them, find where a curve of them is longest.

use std::ops::{Add, Mul, Sub};

use crate::{Curve, Deviation};

/// Numbers in a deviation, and how many of [`Curve::terms`] one takes.
const NUMBERS: usize = 6;

/// Shrinks a bracket of golden-section search.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Steps of that search: to a two-thousandth of the bracket. A length is flat at its peak, so that is right to
/// some 1e-7 of itself.
const STEPS: usize = 16;

impl Deviation {
    /// The deviation between `self` at t = 0 and `end` at t = 1, linearly.
    pub fn lerp(self, end: Deviation, t: f64) -> Deviation {
        self * (1.0 - t) + end * t
    }

    /// Tip and axis, as they are kept in [`Curve::terms`].
    pub fn to_terms(self) -> [f64; NUMBERS] {
        let ([x, y, z], [a, b, c]) = (self.tip, self.axis);
        [x, y, z, a, b, c]
    }

    /// The inverse of [`Deviation::to_terms`]; numbers that are missing are zero.
    pub fn from_terms(terms: &[f64]) -> Deviation {
        let term = |index: usize| terms.get(index).copied().unwrap_or(0.0);
        Deviation { tip: [0, 1, 2].map(term), axis: [3, 4, 5].map(term) }
    }

    /// No number in it is infinite or none at all.
    pub fn is_finite(&self) -> bool {
        self.to_terms().iter().all(|number| number.is_finite())
    }
}

impl Add for Deviation {
    type Output = Deviation;

    fn add(self, other: Deviation) -> Deviation {
        let sum = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] + b[i]);
        Deviation { tip: sum(self.tip, other.tip), axis: sum(self.axis, other.axis) }
    }
}

impl Sub for Deviation {
    type Output = Deviation;

    fn sub(self, other: Deviation) -> Deviation {
        self + other * -1.0
    }
}

impl Mul<f64> for Deviation {
    type Output = Deviation;

    fn mul(self, factor: f64) -> Deviation {
        Deviation {
            tip: self.tip.map(|part| part * factor),
            axis: self.axis.map(|part| part * factor),
        }
    }
}

impl Curve {
    /// The curve of a model that keeps `kept` in its terms, in that order, and has the value `value(t)`; the
    /// peaks are found here. `pieces` is how many even pieces are looked at first: enough if no two peaks
    /// stand in neighbouring ones.
    ///
    /// # Panics
    /// If there is no room for so many: a curve keeps ten.
    pub fn of(kept: &[Deviation], pieces: u32, value: impl Fn(f64) -> Deviation) -> Curve {
        let mut terms = [0.0; 60];
        assert!(kept.len() * NUMBERS <= terms.len(), "a curve keeps ten");
        for (place, deviation) in terms.chunks_exact_mut(NUMBERS).zip(kept) {
            place.copy_from_slice(&deviation.to_terms());
        }
        let (tip_peak, tip_at) = peak(pieces, |t| length(&value(t).tip));
        let (axis_peak, axis_at) = peak(pieces, |t| length(&value(t).axis));
        Curve { tip_peak, tip_at, axis_peak, axis_at, terms }
    }

    /// The `index`th deviation that the curve keeps.
    pub fn kept(&self, index: usize) -> Deviation {
        let from = (index * NUMBERS).min(self.terms.len());
        Deviation::from_terms(&self.terms[from..])
    }
}

/// Asks for the deviations at `places` (t, 0 to 1); `answers` holds them afterwards.
///
/// # Errors
/// If one of them is not finite: no curve goes through it.
pub fn ask(
    deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    places: &[f64],
    answers: &mut Vec<Deviation>,
) -> Result<(), String> {
    answers.clear();
    answers.resize(places.len(), Deviation::default());
    deviation(places, answers);
    match places.iter().zip(answers).find(|(_, it)| !it.is_finite()) {
        Some((t, _)) => Err(format!("the deviation at {t} of the move is not a finite number")),
        None => Ok(()),
    }
}

/// Length of a vector, in its unit.
pub fn length(vector: &[f64; 3]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// The largest `size(t)` for t in 0 to 1, and where: every even place that is no less than its neighbours,
/// refined between them.
pub fn peak(pieces: u32, size: impl Fn(f64) -> f64) -> (f64, f64) {
    let pieces = pieces.max(1);
    let place = |index: u32| f64::from(index) / f64::from(pieces);
    let mut best = (0.0, 0.5);
    let mut see = |(size, t): (f64, f64)| {
        if size > best.0 {
            best = (size, t);
        }
    };
    let (mut before, mut here) = (0.0, size(0.0));
    for index in 0..=pieces {
        let next = (index + 1).min(pieces);
        let after = size(place(next));
        see((here, place(index)));
        if here > 0.0 && here >= before && here >= after {
            see(climb(place(index.saturating_sub(1)), place(next), &size));
        }
        (before, here) = (here, after);
    }
    best
}

/// Golden-section search for the largest `size(t)` between `from` and `to`; size and t.
fn climb(mut from: f64, mut to: f64, size: impl Fn(f64) -> f64) -> (f64, f64) {
    let mut left = to - GOLDEN * (to - from);
    let mut right = from + GOLDEN * (to - from);
    let (mut at_left, mut at_right) = (size(left), size(right));
    for _ in 0..STEPS {
        if at_left >= at_right {
            (to, right, at_right) = (right, left, at_left);
            left = to - GOLDEN * (to - from);
            at_left = size(left);
        } else {
            (from, left, at_left) = (left, right, at_right);
            right = from + GOLDEN * (to - from);
            at_right = size(right);
        }
    }
    if at_left >= at_right { (at_left, left) } else { (at_right, right) }
}
