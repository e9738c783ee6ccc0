//! Half waves over the move, as vectors (Li 2024, eqs. 3.2 and 3.3): at first order one, whose amplitude is
//! the deviation at the middle less the mean of those at the ends.
//!
//! At order n the sum of sin(jπt), j from 1 to n, is fitted to inner places by least squares. At even places
//! the sines are orthogonal, so each amplitude is one sum (a discrete sine transform), and with one place and
//! order 1 that sum is eq. 3.3. The cosines of eq. 3.2 are left out, as the paper does on the way to eq. 3.3:
//! what is fitted vanishes at both ends, and there the sines alone are complete.

use std::f64::consts::PI;

use post_plugin::{
    Curve, Deviation, ErrorModel, OptionSpec, Tolerance, Value, ask, export_error_model,
};

/// Amplitudes that a curve has room for, beside its two ends.
const HIGHEST: usize = 8;

/// Even pieces for every half wave of the highest order, in which its peaks are looked for.
const PIECES: u32 = 8;

/// The model, as it is opened: its order, where it looks, and its answers.
pub struct Harmonic {
    order: usize,
    /// t of the ends, then of the inner places. The ends are asked for too: they are off the path by the
    /// rounding of the printed words, which is some of the tolerance and none of the wave.
    places: Vec<f64>,
    /// `order` rows: what each inner place gives to an amplitude.
    weights: Vec<Vec<f64>>,
    answers: Vec<Deviation>,
}

impl ErrorModel for Harmonic {
    fn options() -> &'static [OptionSpec] {
        const OPTIONS: &[OptionSpec] = &[
            OptionSpec::integer(
                "order",
                (1, HIGHEST as i64),
                1,
                "Half waves: sin(πt) up to sin(order·πt).",
            ),
            OptionSpec::integer(
                "samples",
                (0, 1000),
                0,
                "Even places between the ends that they are fitted to, no fewer than the order; 0: as many.",
            ),
        ];
        OPTIONS
    }

    fn open(options: &[(&str, Value<'_>)]) -> Result<Self, String> {
        let (mut order, mut samples) = (1, 0);
        for option in options {
            match *option {
                ("order", Value::Integer(given)) => order = given as usize,
                ("samples", Value::Integer(given)) => samples = given as usize,
                (key, value) => return Err(format!("option `{key}` cannot be {value}")),
            }
        }
        if samples == 0 {
            samples = order;
        }
        if samples < order {
            return Err(format!(
                "order = {order} has more amplitudes than samples = {samples} can tell"
            ));
        }
        let pieces = (samples + 1) as f64;
        let inner = (1..=samples).map(|place| place as f64 / pieces);
        let weight = |j: usize, t: f64| 2.0 / pieces * libm::sin(j as f64 * PI * t);
        Ok(Harmonic {
            order,
            weights: (1..=order).map(|j| inner.clone().map(|t| weight(j, t)).collect()).collect(),
            places: [0.0, 1.0].into_iter().chain(inner).collect(),
            answers: Vec::new(),
        })
    }

    fn fit(
        &mut self,
        _: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        ask(deviation, &self.places, &mut self.answers)?;
        let [start, end, inner @ ..] = self.answers.as_mut_slice() else {
            return Err("the deviation was not told at every place".to_owned());
        };
        for (answer, t) in inner.iter_mut().zip(&self.places[2..]) {
            *answer = *answer - start.lerp(*end, *t);
        }
        let mut kept = [Deviation::default(); HIGHEST + 2];
        kept[..2].copy_from_slice(&[*start, *end]);
        for (amplitude, weights) in kept[2..].iter_mut().zip(&self.weights) {
            for (answer, weight) in inner.iter().zip(weights) {
                *amplitude = *amplitude + *answer * *weight;
            }
        }
        let kept = &kept[..self.order + 2];
        let pieces = PIECES * self.order as u32;
        Ok(Curve::of(kept, pieces, |t| waves(|i| kept[i], self.order, t)))
    }

    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        waves(|index| curve.kept(index), self.order, t)
    }
}

/// The chord between the ends, `kept` first and second, and above it the waves of the amplitudes after them.
fn waves(kept: impl Fn(usize) -> Deviation, order: usize, t: f64) -> Deviation {
    let (sin, cos) = libm::sincos(PI * t);
    // sin(jx) = 2·cos(x)·sin((j-1)x) - sin((j-2)x).
    let (mut before, mut wave) = (0.0, sin);
    let mut sum = kept(0).lerp(kept(1), t);
    for j in 1..=order {
        sum = sum + kept(j + 1) * wave;
        (before, wave) = (wave, 2.0 * cos * wave - before);
    }
    sum
}

export_error_model!(harmonic, Harmonic);
