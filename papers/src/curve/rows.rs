//! A plan as rows: a point of the path each.

use std::fmt::Write as _;

use post_machine::description::Machine;
use post_plugin::fixed;
use serde::Serialize;

use post_job::plan::gauges::PlanPoint;

/// A row, mm, degrees and s; errors in µm.
#[derive(Clone, Debug, Serialize)]
pub struct PlanRow {
    pub parameter: f64,
    pub way_mm: f64,
    pub time_s: f64,
    pub tip_mm: [f64; 3],
    pub feed_mm_min: f64,
    /// By axis.
    pub position: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub jerk: Vec<f64>,
    pub tip_acceleration: f64,
    pub tip_jerk: f64,
    pub chord_error_um: f64,
    pub contour_error_um: Option<f64>,
    /// The limit that is reached there, if one is.
    pub limit: Option<String>,
}

impl PlanRow {
    pub fn new(machine: &Machine, axes: &[usize], point: &PlanPoint, limit: Option<&str>) -> Self {
        let shown = |values: &[f64]| -> Vec<f64> {
            let each = axes.iter().zip(values);
            each.map(|(place, value)| value / machine.axes[*place].unit()).collect()
        };
        let readings = axes.iter().zip(&point.position);
        Self {
            parameter: point.parameter,
            way_mm: point.way,
            time_s: point.time,
            tip_mm: point.tip,
            feed_mm_min: 60.0 * point.feed,
            position: readings.map(|(place, value)| machine.axes[*place].reading(*value)).collect(),
            velocity: shown(&point.velocity),
            acceleration: shown(&point.acceleration),
            jerk: shown(&point.jerk),
            tip_acceleration: point.tip_acceleration,
            tip_jerk: point.tip_jerk,
            chord_error_um: 1e3 * point.chord_error,
            contour_error_um: (!point.contour_error.is_nan()).then_some(1e3 * point.contour_error),
            limit: limit.map(str::to_owned),
        }
    }
}

/// The rows as CSV, the axes by their names.
pub fn csv(axes: &[String], rows: &[PlanRow]) -> String {
    let mut text = "parameter,way_mm,time_s,tip_x,tip_y,tip_z,feed_mm_min".to_owned();
    for what in ["", "_velocity", "_acceleration", "_jerk"] {
        for axis in axes {
            // Writing to a String cannot fail.
            let _ = write!(text, ",{axis}{what}");
        }
    }
    text.push_str(",tip_acceleration,tip_jerk,chord_error_um,contour_error_um,limit\n");
    for row in rows {
        let mut first = true;
        let mut column = |value: f64, decimals: u8| {
            if !std::mem::take(&mut first) {
                text.push(',');
            }
            fixed(&mut text, value, decimals);
        };
        column(row.parameter, 9);
        column(row.way_mm, 6);
        column(row.time_s, 6);
        row.tip_mm.iter().for_each(|value| column(*value, 6));
        column(row.feed_mm_min, 3);
        let axes = [&row.position, &row.velocity, &row.acceleration, &row.jerk];
        for (values, decimals) in axes.into_iter().zip([6, 6, 5, 4]) {
            values.iter().for_each(|value| column(*value, decimals));
        }
        column(row.tip_acceleration, 4);
        column(row.tip_jerk, 3);
        column(row.chord_error_um, 6);
        text.push(',');
        if let Some(error) = row.contour_error_um {
            fixed(&mut text, error, 5);
        }
        let _ = writeln!(text, ",{}", row.limit.as_deref().unwrap_or_default());
    }
    text
}
