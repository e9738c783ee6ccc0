//! What a machine file says of accuracy: tolerances, the error model, and where points are put in.

use std::collections::BTreeMap;

use serde::Serialize;

use super::GivenOption;
use super::build::Builder;
use super::file::{AccuracyFile, ControlPointFile, Method, Placement};
use crate::diagnostic::{Short, SourcePlace};

/// Share of the tool axis' tolerance that may be used close to a pole; the rest is for what happens between points.
pub const SHARE_AT_POLES: f64 = 0.75;

/// Tolerances and how they are kept.
#[derive(Clone, Debug)]
pub struct AccuracyRules {
    /// Name of the error model.
    pub model: String,
    /// Where the file names it.
    pub model_place: Option<SourcePlace>,
    /// Options for the model.
    pub options: Vec<GivenOption>,
    /// What is done about a move that strays.
    pub method: Method,
    /// The least number of points put into a move that is compensated.
    pub points: u32,
    /// Where points are put in.
    pub placement: Placement,
    /// CL points that the tolerance makes needless are dropped.
    pub reduce: bool,
    /// Where the path turns by more than this, radians, a CL point is a corner.
    pub corner: f64,
    /// Largest deviation of the tip in a cut, mm.
    pub tolerance: f64,
    /// Largest deviation of the tool axis in a cut, radians.
    pub axis_tolerance: f64,
    /// Largest deviation of the tip in a rapid, mm.
    pub rapid_tolerance: f64,
    /// Largest way of a point that is moved to compensate what the servos leave, mm; none: not at all.
    pub servo_compensation: Option<f64>,
}

/// The point of the tool whose deviation is bounded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ControlPoint {
    /// How far it stands from the point that the CL file gives, along the tool axis towards the holder, mm: the
    /// centre of a disc whose lower face the CL file guides, the centre of a ball. This point, not the tip, goes
    /// along straight lines between CL points.
    pub along: f64,
    /// Radius of the cutting edge about the tool axis at that point, mm (R of eqs. 9 and 10 of the parabolic paper,
    /// Sha et al. 2022). Every point of this circle is within the bound.
    pub radius: f64,
}

/// No point is moved by more to make up for servos, mm: more is a slip of the unit.
const MOST_COMPENSATION: f64 = 1.0;

impl Builder<'_> {
    pub(super) fn accuracy(
        &mut self,
        file: &AccuracyFile,
        options: &mut BTreeMap<String, Vec<GivenOption>>,
    ) -> AccuracyRules {
        let model = file
            .model
            .as_ref()
            .map_or_else(|| "sampled".to_owned(), |model| model.get_ref().clone());
        let tolerance = self.checked(&file.tolerance).unwrap_or(0.005);
        let axis_tolerance = self.checked(&file.axis_tolerance).unwrap_or(0.05);
        let rapid_tolerance = self.checked(&file.rapid_tolerance).unwrap_or(0.5);
        let corner = self.checked(&file.corner).unwrap_or(10.0);
        let points = self.counted(&file.points).unwrap_or(1) as u32;
        let servo_compensation = self.checked(&file.servo_compensation);
        if let (Some(said), Some(bound)) = (&file.servo_compensation, servo_compensation)
            && bound > MOST_COMPENSATION
        {
            let message = format!(
                "servo_compensation is {} mm; at most {MOST_COMPENSATION} mm is possible",
                Short(bound)
            );
            self.fault("machine-accuracy", said.span(), message, "the unit is mm: 3 µm are 0.003");
        }
        AccuracyRules {
            servo_compensation,
            options: options.remove(&model).unwrap_or_default(),
            model,
            model_place: file.model.as_ref().and_then(|model| self.sources.place(model.span())),
            method: file.method,
            points,
            placement: file.placement,
            reduce: file.reduce,
            corner: corner.to_radians(),
            tolerance,
            axis_tolerance: axis_tolerance.to_radians(),
            rapid_tolerance,
        }
    }

    pub(super) fn control_point(&mut self, file: &ControlPointFile) -> ControlPoint {
        ControlPoint {
            along: self.checked(&file.along).unwrap_or(0.0),
            radius: self.checked(&file.radius).unwrap_or(0.0),
        }
    }
}
