//! How fast the spindle turns: `[spindle]`.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::build::Builder;
use super::file::SpindleFile;
use crate::diagnostic::{Diagnostic, Short};

/// The speeds that a spindle can turn at, rpm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleSpeeds {
    /// Least speed; 0 if the file does not say.
    pub min: f64,
    /// Largest speed; infinite if the file does not say.
    pub max: f64,
    /// It turns the part, and the control can keep its cutting speed constant.
    pub surface_speed: bool,
}

impl Default for SpindleSpeeds {
    fn default() -> Self {
        Self { min: 0.0, max: f64::INFINITY, surface_speed: false }
    }
}

/// Revolutions a minute that keep a cutting speed of `speed` m/min at `radius` mm, no more than `most`.
pub fn surface_rpm(speed: f64, radius: f64, most: f64) -> f64 {
    (speed * 1000.0 / (TAU * radius)).min(most)
}

/// Revolutions a minute on a straight way between two places across the line of the spindle, mm, at a cutting speed of
/// `speed` m/min and no more than `most`: those that the way takes as long with, and the most of them. A way that passes the
/// line is taken to go through it.
pub fn surface_rpm_on_way(speed: f64, [from, to]: [Vector2<f64>; 2], most: f64) -> [f64; 2] {
    if !(speed > 0.0 && most > 0.0) {
        return [0.0; 2];
    }
    let sign = if from.dot(&to) < 0.0 { -1.0 } else { 1.0 };
    let ends = [from.norm(), sign * to.norm()];
    let fastest = match sign > 0.0 {
        true => surface_rpm(speed, ends[0].min(ends[1]), most),
        false => most,
    };
    let way = ends[1] - ends[0];
    if libm::fabs(way) < 1e-6 {
        return [surface_rpm(speed, libm::fabs(ends[0]), most), fastest];
    }
    // Minutes of a turn at a radius are the larger of two: they grow with it, or are those of the largest speed.
    let [grows, least] = [TAU / (speed * 1000.0), 1.0 / most];
    let turned = |radius: f64| {
        let size = libm::fabs(radius);
        let bounded = size.min(least / grows);
        let whole = least * bounded + 0.5 * grows * (size * size - bounded * bounded);
        libm::copysign(whole, radius)
    };
    [way / (turned(ends[1]) - turned(ends[0])), fastest]
}

/// No spindle turns as fast, rpm.
const MOST: f64 = 1e6;

impl SpindleSpeeds {
    /// What is wrong with a speed, rpm: the finding has no place yet.
    pub fn refuse(&self, rpm: f64) -> Option<Diagnostic> {
        // S has no decimals.
        if !(0.5..MOST).contains(&rpm) {
            let message =
                format!("a spindle at {} rpm: from 0.5 to {MOST} rpm are possible", Short(rpm));
            return Some(
                Diagnostic::error("spindle-speed", message)
                    .help("another speed in the CAM system, in revolutions a minute"),
            );
        }
        let (end, key, limit) = if rpm < self.min {
            ("least", "min_speed", self.min)
        } else if rpm > self.max {
            ("largest", "max_speed", self.max)
        } else {
            return None;
        };
        let message = format!(
            "the spindle would turn at {} rpm, its {end} speed is {} rpm",
            Short(rpm),
            Short(limit)
        );
        let help = format!(
            "another speed in the CAM system; {key} of [spindle] in the machine file is the limit"
        );
        Some(Diagnostic::error("spindle-speed", message).help(help))
    }
}

impl SpindleSpeeds {
    /// The revolutions a minute that a constant cutting speed may lead to, where the CL file says `most`.
    ///
    /// # Errors
    /// No limit is known, or one that the spindle does not reach or passes: the finding has no place yet.
    pub fn limit(&self, most: Option<f64>) -> Result<f64, Box<Diagnostic>> {
        let limit = most.or(Some(self.max).filter(|max| max.is_finite()));
        let Some(limit) = limit else {
            let message = "a constant cutting speed without a limit: towards the centre the spindle would turn without end";
            let finding = Diagnostic::error("spindle-speed", message.to_owned()).help(
                "SPINDL/SMM,speed,MAXRPM,limit; or max_speed of [spindle] in the machine file",
            );
            return Err(finding.boxed());
        };
        self.refuse(limit).map_or(Ok(limit), |finding| Err(finding.boxed()))
    }
}

impl Builder<'_> {
    pub(super) fn spindle(&mut self, file: &SpindleFile) -> SpindleSpeeds {
        let speeds = SpindleSpeeds {
            min: self.checked(&file.min_speed).unwrap_or(0.0),
            max: self.checked(&file.max_speed).unwrap_or(f64::INFINITY),
            surface_speed: file.surface_speed,
        };
        if let (Some(max), true) = (&file.max_speed, speeds.min > speeds.max) {
            let message = format!(
                "the least speed, {} rpm, lies above the largest, {} rpm",
                Short(speeds.min),
                Short(speeds.max)
            );
            self.fault("machine-spindle", max.span(), message, "");
        }
        speeds
    }
}
