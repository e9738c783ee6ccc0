//! What a prediction has found, for people and for programs: the JSON of `--summary`.
//!
//! Lengths in mm, angles in degrees, times in seconds from the beginning of the program, lines counted from 1.

use serde::Serialize;

use super::measured::{AxisFitted, MeasuredFound};

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Prediction {
    /// The program, as the command line names it.
    pub program: String,
    /// Name of the machine.
    pub machine: String,
    /// Its dialect.
    pub dialect: String,
    /// The CL file that the tool is held against.
    pub against: Option<String>,
    /// Blocks that were run.
    pub blocks: u64,
    /// Set-points that the control makes.
    pub set_points: u64,
    /// Time from one to the next, s.
    pub period_s: f64,
    /// How long it takes.
    pub time: Times,
    /// How fast the tool cuts.
    pub feed: Feeds,
    /// Of each axis what it does and how far it lags.
    pub axes: Vec<AxisFound>,
    /// How often a block passes into the next with a jump of the velocity.
    pub corners_with_jump: u64,
    /// How far the tool is off its path in cuts.
    pub contour: ContourFound,
    /// What is left between it and a recorded log.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredFound>,
    /// Servos adjusted to the log.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fitted: Vec<AxisFitted>,
    /// What is taken for granted, as sentences.
    pub assumed: Vec<String>,
}

/// How long the program takes.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Times {
    /// All of it, s.
    pub cycle_s: f64,
    /// Of it moves at feed, s.
    pub cutting_s: f64,
    /// Of it rapids, s.
    pub rapid_s: f64,
    /// Of it waits: dwells, tool changes, the spindle; s.
    pub waiting_s: f64,
    /// How long the moves at feed would take if no limit but the feed of the program held, s.
    pub cutting_at_feed_s: f64,
    /// When it begins to wait for other channels, s, in the order of the program: these waits are counted as no time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub channel_waits_s: Vec<f64>,
    /// What limits the time, the longest first.
    pub limits: Vec<LimitTime>,
    /// By tool and operation, in the order of the program.
    pub operations: Vec<OperationTime>,
}

/// The time that is spent under one limit.
#[derive(Clone, Debug, Serialize)]
pub struct LimitTime {
    /// What it limits: `cut`, `rapid` or `wait`.
    pub kind: &'static str,
    /// What limits: `feed`, `axis velocity`, `axis acceleration`, `axis jerk`, `tip acceleration`, `tip jerk`, `corner`,
    /// `block time`; what is waited for: `dwell`, `tool change`, `spindle`, `standstill`.
    pub limit: &'static str,
    /// The axis, if it is one.
    pub axis: Option<String>,
    /// Moves and waits that it limits.
    pub moves: u64,
    /// How long they take, s.
    pub seconds: f64,
    /// Of the cycle time, 0 to 1.
    pub share: f64,
    /// How much longer they take than their feed asks for, s.
    pub beyond_feed_s: f64,
}

/// The time of an operation with a tool.
#[derive(Clone, Debug, Serialize)]
pub struct OperationTime {
    /// Number of the tool.
    pub tool: Option<u32>,
    /// The operation, as the program names it.
    pub operation: Option<String>,
    /// How long it takes, s.
    pub seconds: f64,
    /// Of it moves at feed, s.
    pub cutting_s: f64,
}

/// How fast the tip goes against the part in cuts, mm/min.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Feeds {
    /// Way of the tip in cuts, mm.
    pub way_mm: f64,
    /// Way over the time that the program asks for.
    pub programmed_mean: f64,
    /// Largest feed that the program states.
    pub programmed_largest: f64,
    /// Way over the time that it takes.
    pub true_mean: f64,
    /// Largest between two set-points.
    pub true_largest: f64,
    /// Line of the program in which it is largest.
    pub largest_nc_line: u64,
    /// Time in cuts in which it is below 95 % of what the program states, s.
    pub below_95_percent_s: f64,
}

/// What an axis does.
#[derive(Clone, Debug, Serialize)]
pub struct AxisFound {
    /// Its name.
    pub name: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// The machine file describes its servo; without it the axis is where it is commanded.
    pub servo: bool,
    /// Largest distance of where it is commanded from where it is at the same time.
    pub following: Extreme,
    /// Largest commanded velocity, units a minute.
    pub velocity: Extreme,
    /// Largest commanded acceleration, jumps of the velocity left out, units/s².
    pub acceleration: Extreme,
    /// Largest commanded jerk, from set-point to set-point, jumps of the velocity left out, units/s³.
    pub jerk: Extreme,
    /// Largest jump of the commanded velocity where one block passes into the next, units a minute.
    pub jump: Extreme,
}

/// The largest of something.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Extreme {
    /// How much.
    pub value: f64,
    /// What the machine file allows; none where it says nothing, and for distances.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<f64>,
    /// Line of the program.
    pub nc_line: u64,
    /// When, s.
    pub time_s: f64,
}

/// How far the tool is off its path in cuts.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ContourFound {
    /// The tip off the commanded path (`--against`: off the path of the CL file), mm.
    pub tip_mm: Spread,
    /// The tool axis, degrees.
    pub axis_deg: Spread,
    /// What the tip's error is made of, mm.
    pub parts: Vec<ErrorPart>,
    /// How far a place of the commanded path is left beside the way where the tool goes from one leg of a corner to the
    /// other, mm: from the path to the tool this is the distance, the contour error is that from the tool to the path.
    pub left_out_mm: Extreme,
}

/// One part of the contour error.
#[derive(Clone, Debug, Serialize)]
pub struct ErrorPart {
    /// `following`: the axes are not where they are commanded; `interpolation`: set-points are met, and not what lies
    /// between them, or the control leaves the path at corners; `program`: the program is not the CL file.
    pub part: &'static str,
    /// How large it is by itself, mm.
    pub tip_mm: Spread,
}

/// How something is spread over the set-points in cuts.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Spread {
    /// The largest.
    pub largest: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// Not passed by half of the set-points.
    pub p50: f64,
    /// By 95 % of them.
    pub p95: f64,
    /// By 99 % of them.
    pub p99: f64,
    /// Where it is largest, line of the program.
    pub nc_line: u64,
    /// Line of the CL file, where one is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cl_line: Option<u64>,
    /// When, s.
    pub time_s: f64,
}
