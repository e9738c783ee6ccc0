//! What is left between a prediction and a measurement: the JSON of `--summary`.
//!
//! Axes in mm and degrees, contour errors in mm, times in seconds: of the log's clock.

use post_motion::measured::Difference;
use serde::Serialize;

/// A log laid over a prediction.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredFound {
    /// Its file.
    pub log: String,
    /// Rows that it has.
    pub rows: usize,
    /// Time from one to the next.
    pub period_s: f64,
    /// How long it is.
    pub seconds: f64,
    /// Jumps of a rotary axis by a full turn that are taken for its count starting again.
    pub turns: u64,
    /// Its clock minus that of the prediction.
    pub shift_s: f64,
    /// Standard deviation of the shift, were what is left independent from row to row.
    pub shift_deviation_s: f64,
    /// Another shift that leaves hardly more.
    pub rival_shift_s: Option<f64>,
    /// How well both are alike then: 1 if nothing is left.
    pub correlation: f64,
    /// From when to when both are known.
    pub overlap_s: [f64; 2],
    /// Of the axes what is left.
    pub axes: Vec<AxisLaid>,
    /// Contour error in cuts; none if the log does not have commanded and actual positions of an axis.
    pub contour: Option<ContourLaid>,
}

/// What is left of an axis.
#[derive(Clone, Debug, Serialize)]
pub struct AxisLaid {
    /// Its name.
    pub name: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// What the log counts more than the prediction; it is taken off.
    pub zero: f64,
    /// Commanded position: predicted minus logged, at the same time.
    pub commanded: Option<Left>,
    /// Actual position: predicted minus logged, at the same time.
    pub actual: Option<Left>,
    /// Actual minus commanded position, as logged.
    pub following_measured: Option<Left>,
    /// The same, as the servo of the machine file follows the commanded positions of the log.
    pub following_predicted: Option<Left>,
    /// The latter minus the former: what the servo's description is wrong by, whatever was commanded.
    pub following: Option<Left>,
}

/// The contour error of the log, in cuts, and what the servos make of its commanded positions.
#[derive(Clone, Debug, Serialize)]
pub struct ContourLaid {
    /// As measured.
    pub measured: Left,
    /// As predicted from the commanded positions of the log.
    pub predicted: Left,
    /// Predicted minus measured.
    pub difference: Left,
}

/// A difference over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Left {
    /// The one of the largest size, with its sign.
    pub most: f64,
    /// When that was.
    pub most_at_s: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// Mean.
    pub mean: f64,
}

impl Left {
    /// In another unit; none of none.
    pub fn of(difference: &Difference, unit: f64) -> Option<Self> {
        (difference.count > 0).then(|| Self {
            most: difference.most / unit,
            most_at_s: difference.most_at,
            rms: difference.rms() / unit,
            mean: difference.mean() / unit,
        })
    }
}
