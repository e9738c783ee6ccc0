//! Keys of `[plan]`: what a planned feed keeps beside the limits of the axes.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::quantity::{Number, Quantity};

/// What a planned feed (`post --plan`) keeps, beside the limits of the axes and of the tip. What is posted without a plan
/// does not depend on it.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlanFile {
    /// Largest contour error that the servos make of the path, mm; not limited if not said. The axes need servos for it.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub contour_error: Option<Quantity>,
    /// By how much the way of one interpolation period may stray from the path, mm; not limited if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub chord_error: Option<Quantity>,
    /// A block is cut where its feed changes if that saves at least this time, s; a fifth of shortest_block if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub least_saving: Option<Quantity>,
    /// No block is cut into pieces that take less than this, s; if not said two periods of [motion], and its block_time
    /// at least.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub shortest_block: Option<Quantity>,
    /// By how much the curve that is planned along may leave the path of the blocks, mm; half the tolerance of
    /// [accuracy] if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub smoothing: Option<Quantity>,
    /// Which solver plans; reach if not said.
    #[schemars(with = "PlanSolver")]
    pub solver: Option<Spanned<PlanSolver>>,
}

/// What plans feeds.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum PlanSolver {
    /// Reachability analysis: velocity, acceleration and errors, in linear time.
    #[default]
    Reach,
    /// Jerk is kept too; a hundred times slower.
    Jerk,
}
