//! How fast the spindle turns: `[spindle]`.

use std::f64::consts::TAU;

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
