//! Keys of `[motion]`: how the control makes motion of a program.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::quantity::{Number, Quantity};

/// How the control makes motion of a program. What is posted does not depend on it, but for feeds that are planned.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MotionFile {
    /// Time from one set-point of the axes to the next (interpolation cycle, IPO), s, 0.00001 to 1; 0.001 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0.00001, "maximum" = 1))]
    pub period: Option<Quantity>,
    /// The control prepares no more than one block in this time, s; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub block_time: Option<Quantity>,
    /// Blocks that it looks ahead; 200 if not said, 1 stops at the end of each.
    #[schemars(with = "Option<u32>", extend("minimum" = 1, "maximum" = 100_000))]
    pub look_ahead: Option<Spanned<i64>>,
    /// What max_feed, max_accel and max_jerk of the axes hold for where the control keeps the tip: the axes, or the
    /// coordinates that are programmed (X, Y and Z of the tip); axes if not said.
    #[serde(default)]
    pub limits: LimitsActOn,
    /// Largest acceleration of the tip against the part, mm/s²; none if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub tip_accel: Option<Quantity>,
    /// Largest jerk of the tip against the part, mm/s³; none if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub tip_jerk: Option<Quantity>,
    /// Largest jump of the velocity of the tip against the part where one block passes into the next without a curve
    /// between them, mm/min; if not said what tip_accel makes of it in one period.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub tip_jump: Option<Quantity>,
    /// How the control passes from one cut to the next before the program says anything of it; blend if not said.
    #[serde(default)]
    pub corner: CornerRule,
    /// By how much it may leave the path at a corner where the program names no tolerance, mm; as far as its rule leads
    /// if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub corner_tolerance: Option<Quantity>,
    /// How it leaves the path at a corner; round if not said.
    #[serde(default)]
    pub blend: BlendRule,
    /// Whether it passes into and out of rapids without standing still; stop if not said.
    #[serde(default)]
    pub rapids: RapidRule,
    /// It waits so long wherever it stands still between two moves, until its axes are in position (exact stop), s; 0 if
    /// not said: it goes on as soon as the commanded position stands.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub in_position: Option<Quantity>,
    /// A tool change takes so long, s; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub tool_change: Option<Quantity>,
    /// The program waits so long where the spindle starts, stops or changes its sense, s; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub spindle: Option<Quantity>,
}

/// What the limits of the axes hold for where the control keeps the tip.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum LimitsActOn {
    /// The axes, whatever they do for the tip.
    #[default]
    Axes,
    /// The programmed coordinates: the linear axes may go faster while rotary ones turn (LinuxCNC).
    Programmed,
}

/// How a control passes from one cut to the next.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum CornerRule {
    /// It stands still at the end of every block (exact stop).
    Stop,
    /// It keeps the path, and stands still only where the direction changes (exact path).
    Path,
    /// It may leave the path (continuous path).
    #[default]
    Blend,
}

/// How a control passes into and out of rapids.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum RapidRule {
    /// It stands still before and behind each (in-position check).
    #[default]
    Stop,
    /// As between cuts from one rapid into the next; between rapids and cuts it stands still (LinuxCNC).
    AmongRapids,
    /// As between cuts.
    Blend,
}

/// How a control leaves the path at a corner.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum BlendRule {
    /// The next block is speeded up while the last one is slowed down: LinuxCNC's rule, with its halves of accelerations;
    /// blocks in which rotary axes turn have a standstill between them on an exact path.
    Overlap,
    /// A curve takes the place of both ends.
    #[default]
    Round,
}
