//! A parabola through the deviations at the ends and at the middle of the move (Sha 2022, eqs. 4 and 5), as a
//! vector: every component has its own.
//!
//! It is what the deviation is, to second order in the turns of the rotary axes.

use post_plugin::{
    Curve, Deviation, ErrorModel, OptionSpec, Tolerance, Value, ask, export_error_model,
};

/// Where the parabola meets the deviation. The ends are asked for too: they are off the path by the rounding
/// of the printed words, which is some of the tolerance and none of the bow.
const PLACES: [f64; 3] = [0.0, 0.5, 1.0];

/// A parabola has one peak, the length of a vector of them up to three.
const PIECES: u32 = 8;

/// The model, as it is opened.
pub struct Parabolic {
    answers: Vec<Deviation>,
}

impl ErrorModel for Parabolic {
    fn options() -> &'static [OptionSpec] {
        &[]
    }

    fn open(_: &[(&str, Value<'_>)]) -> Result<Self, String> {
        Ok(Parabolic { answers: Vec::with_capacity(PLACES.len()) })
    }

    fn fit(
        &mut self,
        _: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        ask(deviation, &PLACES, &mut self.answers)?;
        let &[start, middle, end] = self.answers.as_slice() else {
            return Err("the deviation was not told at every place".to_owned());
        };
        let bow = middle - start.lerp(end, 0.5);
        Ok(Curve::of(&[start, end, bow], PIECES, |t| parabola(start, end, bow, t)))
    }

    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        parabola(curve.kept(0), curve.kept(1), curve.kept(2), t)
    }
}

/// The chord between the ends, and above it a parabola that reaches `bow` at t = 1/2.
fn parabola(start: Deviation, end: Deviation, bow: Deviation, t: f64) -> Deviation {
    start.lerp(end, t) + bow * (4.0 * t * (1.0 - t))
}

export_error_model!(parabolic, Parabolic);
