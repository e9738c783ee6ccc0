//! What a machine file says of accuracy: tolerances, the error model, and where points are put in.

use std::collections::BTreeMap;

use serde::Serialize;

use super::GivenOption;
use super::build::Builder;
use super::file::{AccuracyFile, ControlPointFile, Method, Placement};
use super::quantity::Quantity;
use crate::diagnostic::{Place, Short};

/// Of the tool axis' tolerance so much may be used close to a pole; the rest is for what happens between points.
pub const SHARE_AT_POLES: f64 = 0.75;

/// Tolerances and how they are kept.
#[derive(Clone, Debug)]
pub struct Accuracy {
    /// Name of the error model.
    pub model: String,
    /// Where the file names it.
    pub model_place: Option<Place>,
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
    /// By how much a point may be moved to compensate what the servos leave, mm; none: not at all.
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

/// More points than this in one move are a slip.
const MOST_POINTS: i64 = 999;

/// No point is moved by more to make up for servos, mm: more is a slip of the unit.
const MOST_COMPENSATION: f64 = 1.0;

impl Builder<'_> {
    pub(super) fn accuracy(
        &mut self,
        file: &AccuracyFile,
        options: &mut BTreeMap<String, Vec<GivenOption>>,
    ) -> Accuracy {
        let model = file
            .model
            .as_ref()
            .map_or_else(|| "sampled".to_owned(), |model| model.get_ref().clone());
        let tolerance = self.tolerance("tolerance", &file.tolerance, 0.005);
        let axis_tolerance = self.tolerance("axis_tolerance", &file.axis_tolerance, 0.05);
        let rapid_tolerance = self.tolerance("rapid_tolerance", &file.rapid_tolerance, 0.5);
        let corner = file.corner.as_ref().map_or(10.0, |corner| {
            let value = self.number(corner);
            if !(0.0..=180.0).contains(&value) {
                self.fault(
                    "machine-corner",
                    corner.span(),
                    format!("corner is {}; it must be 0 to 180 degrees", Short(value)),
                    "",
                );
            }
            value
        });
        let points = file.points.as_ref().map_or(1, |points| {
            let count = *points.get_ref();
            if !(1..=MOST_POINTS).contains(&count) {
                self.fault(
                    "machine-points",
                    points.span(),
                    format!("points is {count}; it must be 1 to {MOST_POINTS}"),
                    "",
                );
            }
            count.clamp(1, MOST_POINTS) as u32
        });
        let servo_compensation = file.servo_compensation.as_ref().map(|said| {
            let bound = self.tolerance("servo_compensation", &file.servo_compensation, 0.0);
            if bound > MOST_COMPENSATION {
                self.fault(
                    "machine-accuracy",
                    said.span(),
                    format!(
                        "servo_compensation is {} mm; at most {MOST_COMPENSATION} mm is possible",
                        Short(bound)
                    ),
                    "the unit is mm: 3 µm are 0.003",
                );
            }
            bound
        });
        Accuracy {
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
        let along = file.along.as_ref().map_or(0.0, |along| self.number(along));
        let radius = file.radius.as_ref().map_or(0.0, |radius| {
            let value = self.number(radius);
            if value < 0.0 {
                self.fault(
                    "machine-control-point",
                    radius.span(),
                    format!(
                        "the radius of the cutting edge is {}; it cannot be below zero",
                        Short(value)
                    ),
                    "",
                );
            }
            value
        });
        ControlPoint { along, radius }
    }

    fn tolerance(&mut self, name: &str, quantity: &Option<Quantity>, default: f64) -> f64 {
        let Some(quantity) = quantity else {
            return default;
        };
        let value = self.number(quantity);
        if value <= 0.0 {
            self.fault(
                "machine-tolerance",
                quantity.span(),
                format!("{name} is {}; it must be above zero", Short(value)),
                "",
            );
        }
        value
    }
}
