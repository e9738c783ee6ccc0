//! An error model: an opinion on the shape of the deviation along one move.

use crate::{OptionSpec, Value};

/// Deviation of the tool from its chord at one place of a move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Deviation {
    /// Tip: where the linearly interpolated axes put it, minus the chord at the same t; mm, part frame.
    pub tip: [f64; 3],
    /// Tool axis: the rotation vector that takes the wanted axis into the actual one; degrees, part frame.
    pub axis: [f64; 3],
}

/// What a move must stay within.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Tolerance {
    /// Tip, mm.
    pub tip: f64,
    /// Tool axis, degrees.
    pub axis: f64,
}

/// The model's answer for one move.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Curve {
    /// Largest length of the tip's deviation, mm.
    pub tip_peak: f64,
    /// Where, t in 0 to 1.
    pub tip_at: f64,
    /// Largest angle of the tool axis' deviation, degrees.
    pub axis_peak: f64,
    /// Where.
    pub axis_at: f64,
    /// The model's own numbers; only its [`ErrorModel::value`] reads them.
    pub terms: [f64; 60],
}

/// Judges one move at a time. Implemented by the author of an error model.
///
/// One value serves one thread.
pub trait ErrorModel: Sized + Send + 'static {
    /// The options of `[accuracy.<name>]` that this model knows.
    fn options() -> &'static [OptionSpec] {
        &[]
    }

    /// Called once a program and thread.
    ///
    /// # Errors
    /// A sentence for the user.
    fn open(options: &[(&str, Value<'_>)]) -> Result<Self, String>;

    /// Fits a curve to a move. `deviation(ts, out)` fills `out[i]` with the deviation at `ts[i]`
    /// (0 to 1); each place costs one forward solution of the chain, so a model asks as few as it can.
    ///
    /// # Errors
    /// A sentence for the user, if the model cannot answer.
    fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String>;

    /// The fitted deviation at `t`.
    fn value(&self, curve: &Curve, t: f64) -> Deviation;
}

/// An opened error model as the core sees it, whatever implements it.
pub trait ModelSession {
    /// See [`ErrorModel::fit`].
    ///
    /// # Errors
    /// A sentence for the user.
    fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String>;

    /// See [`ErrorModel::value`].
    fn value(&self, curve: &Curve, t: f64) -> Deviation;

    /// Why a [`ModelSession::value`] since the last fit could not be answered (it was zero then); the
    /// next fit fails for the same reason. To be asked once more at the end of a program.
    fn fault(&self) -> Option<String> {
        None
    }
}

impl<M: ErrorModel> ModelSession for M {
    fn fit(
        &mut self,
        tolerance: &Tolerance,
        deviation: &mut dyn FnMut(&[f64], &mut [Deviation]),
    ) -> Result<Curve, String> {
        ErrorModel::fit(self, tolerance, deviation)
    }

    fn value(&self, curve: &Curve, t: f64) -> Deviation {
        ErrorModel::value(self, curve, t)
    }
}
