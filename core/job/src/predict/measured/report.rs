//! What is left between a prediction and a measurement: the JSON of `--summary`.
//!
//! Axes in mm and degrees, contour errors in mm, times in seconds: of the log's clock.

use post_motion::measured::DifferenceSum;
use serde::Serialize;

/// A log laid over a prediction.
#[derive(Clone, Debug, Serialize)]
pub struct MeasuredFound {
    /// Its file.
    pub log: String,
    /// Rows that it has.
    pub rows: usize,
    /// Columns that are read.
    pub columns: Vec<ColumnRead>,
    /// Names of those that are not.
    pub unread: Vec<String>,
    /// Time from one row to the next.
    pub period_s: f64,
    /// How long it is.
    pub seconds: f64,
    /// Rows that are missing between others; positions are interpolated there.
    pub missing_rows: usize,
    /// Root of the mean square of how far rows lie beside even distances in time.
    pub jitter_s: f64,
    /// Times are rounded; rows are taken to lie at even distances.
    pub rounded_times: bool,
    /// Jumps of a rotary axis by a full turn that are taken for its count starting again.
    pub turns: u64,
    /// Its clock minus that of the prediction.
    pub shift_s: f64,
    /// Standard deviation of the shift, were what is left independent from row to row.
    pub shift_deviation_s: f64,
    /// Another shift that leaves hardly more.
    pub rival_shift_s: Option<f64>,
    /// How well both are alike then, in the rows that are not far off: 1 if nothing is left.
    pub correlation: f64,
    /// Share of the rows, 0 to 1, in which an axis is so far off that the row says nothing of clock and zeros.
    pub far_off: f64,
    /// From when to when both are known.
    pub overlap_s: [f64; 2],
    /// How long the prediction is.
    pub predicted_s: f64,
    /// From the first commanded motion of the log's axes to the last: in the log, and as predicted. None of a log without
    /// commanded positions, or that begins or ends in motion.
    pub motion_s: Option<[f64; 2]>,
    /// Of the axes what is left.
    pub axes: Vec<AxisLaid>,
    /// Contour error in cuts; none if no following error is known.
    pub contour: Option<ContourLaid>,
}

/// A column that is read.
#[derive(Clone, Debug, Serialize)]
pub struct ColumnRead {
    /// Its name, else its number from 1.
    pub column: String,
    /// `time`, `X commanded`, `X actual`.
    pub holds: String,
    /// What it counts in.
    pub unit: &'static str,
}

/// What is left of an axis.
#[derive(Clone, Debug, Serialize)]
pub struct AxisLaid {
    /// Its name.
    pub name: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// 1 if nothing is left, 0 if log and prediction have nothing in common, -1 if the log counts the other way; none of
    /// an axis that stands still.
    pub alike: Option<f64>,
    /// What the log counts more than the prediction; it is taken off.
    pub zero: f64,
    /// Commanded position: predicted minus logged, at the same time.
    pub commanded: Option<RemainingDifference>,
    /// Actual position: predicted minus logged, at the same time.
    pub actual: Option<RemainingDifference>,
    /// Commanded minus actual position, as logged; of a log without commanded positions those of the prediction are taken.
    pub following_measured: Option<RemainingDifference>,
    /// The same, as the servo of the machine file follows the commanded positions of the log.
    pub following_predicted: Option<RemainingDifference>,
    /// The latter minus the former: what the servo's description is wrong by, whatever was commanded.
    pub following: Option<RemainingDifference>,
    /// Commanded position between rows that are further apart than set-points of the control: about how far the cubic lies
    /// beside it that is put there. None if the rows are no further apart.
    pub between_rows: Option<RemainingDifference>,
}

/// The contour error of the log, in cuts, and what the servos make of its commanded positions (of a log without, of the
/// predicted ones).
#[derive(Clone, Debug, Serialize)]
pub struct ContourLaid {
    /// As measured.
    pub measured: RemainingDifference,
    /// As predicted from the commanded positions of the log.
    pub predicted: RemainingDifference,
    /// Predicted minus measured.
    pub difference: RemainingDifference,
}

/// A difference over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct RemainingDifference {
    /// The one of the largest size, with its sign.
    pub most: f64,
    /// When that was.
    pub most_at_s: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// Mean.
    pub mean: f64,
}

impl RemainingDifference {
    /// In another unit; none of none.
    pub fn of(difference: &DifferenceSum, unit: f64) -> Option<Self> {
        (difference.count > 0).then(|| Self {
            most: difference.most / unit,
            most_at_s: difference.most_at,
            rms: difference.rms() / unit,
            mean: difference.mean() / unit,
        })
    }
}
