//! What a machine file says of how the control makes motion: `[motion]`.

use super::build::Builder;
use super::motion_file::{BlendRule, CornerRule, LimitsActOn, MotionFile, RapidRule};
use super::quantity::Quantity;
use crate::diagnostic::Short;

/// How a control makes motion of a program. What is posted does not depend on it, but for feeds that are planned.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionRules {
    /// Time from one set-point to the next, s.
    pub period: f64,
    /// The control prepares no more than one block in this time, s.
    pub block_time: f64,
    /// Blocks that it looks ahead; 1: it stands still at the end of each.
    pub look_ahead: usize,
    /// What the limits of the axes hold for where the control keeps the tip.
    pub limits: LimitsActOn,
    /// Largest acceleration of the tip against the part, mm/s²; infinite if the file does not say.
    pub tip_accel: f64,
    /// Largest jerk of the tip against the part, mm/s³; infinite if the file does not say.
    pub tip_jerk: f64,
    /// Largest jump of the velocity of the tip against the part where one block passes into the next, mm/min; none if the
    /// file does not say.
    pub tip_jump: Option<f64>,
    /// How it passes from one cut to the next before the program says anything of it.
    pub corner: CornerRule,
    /// By how much it may leave the path at a corner where the program names no tolerance, mm; none: as far as its rule
    /// leads.
    pub corner_tolerance: Option<f64>,
    /// How it leaves the path at a corner.
    pub blend: BlendRule,
    /// How it passes into and out of rapids.
    pub rapids: RapidRule,
    /// It waits so long wherever it stands still between two moves, until its axes are in position, s.
    pub in_position: f64,
    /// A tool change takes so long, s.
    pub tool_change: f64,
    /// The program waits so long where the spindle starts, stops or changes its sense, s.
    pub spindle: f64,
}

/// Time between set-points where the file does not say, s.
const PERIOD: f64 = 0.001;

/// Shorter and longer periods are slips, s.
const SHORTEST: f64 = 1e-5;
const LONGEST: f64 = 1.0;

/// Blocks that are looked ahead where the file does not say, and the most.
const LOOK_AHEAD: [i64; 2] = [200, 100_000];

/// No wait of a control is longer, s.
const MOST_SECONDS: f64 = 3600.0;

impl Builder<'_> {
    pub(super) fn motion(&mut self, file: &MotionFile) -> MotionRules {
        let period = match &file.period {
            None => PERIOD,
            Some(period) => {
                let value = self.number(period);
                if !(SHORTEST..=LONGEST).contains(&value) {
                    self.fault(
                        "machine-motion",
                        period.span(),
                        format!(
                            "[motion] period is {} s; from {SHORTEST} to {LONGEST} s is possible",
                            Short(value)
                        ),
                        "periods of controls are 0.0005 to 0.02 s: the unit is seconds",
                    );
                }
                value
            }
        };
        let [usual, most] = LOOK_AHEAD;
        let look_ahead = file.look_ahead.as_ref().map_or(usual, |blocks| {
            let count = *blocks.get_ref();
            if !(1..=most).contains(&count) {
                self.fault(
                    "machine-motion",
                    blocks.span(),
                    format!("[motion] look_ahead is {count}; it must be 1 to {most} blocks"),
                    "",
                );
            }
            count.clamp(1, most)
        });
        let mut positive = |name: &str, said: &Option<Quantity>| {
            said.as_ref().and_then(|said| self.above_zero_of(name, said))
        };
        let tip_accel = positive("tip_accel", &file.tip_accel);
        let tip_jerk = positive("tip_jerk", &file.tip_jerk);
        let tip_jump = positive("tip_jump", &file.tip_jump);
        let corner_tolerance = positive("corner_tolerance", &file.corner_tolerance);
        let mut seconds = |name: &str, said: &Option<Quantity>| {
            said.as_ref().map_or(0.0, |said| self.seconds_of("motion", name, said))
        };
        MotionRules {
            period,
            block_time: seconds("block_time", &file.block_time),
            look_ahead: look_ahead as usize,
            limits: file.limits,
            tip_accel: tip_accel.unwrap_or(f64::INFINITY),
            tip_jerk: tip_jerk.unwrap_or(f64::INFINITY),
            tip_jump,
            corner: file.corner,
            corner_tolerance,
            blend: file.blend,
            rapids: file.rapids,
            in_position: seconds("in_position", &file.in_position),
            tool_change: seconds("tool_change", &file.tool_change),
            spindle: seconds("spindle", &file.spindle),
        }
    }

    fn above_zero_of(&mut self, name: &str, said: &Quantity) -> Option<f64> {
        let value = self.number(said);
        if value > 0.0 {
            return Some(value);
        }
        self.fault(
            "machine-motion",
            said.span(),
            format!("[motion] {name} is {}; it must be above zero", Short(value)),
            "leave it out where there is no limit",
        );
        None
    }

    /// A time of `[table]`.
    pub(super) fn seconds_of(&mut self, table: &str, name: &str, said: &Quantity) -> f64 {
        let value = self.number(said);
        // What is no number was told already.
        if !value.is_nan() && !(0.0..=MOST_SECONDS).contains(&value) {
            self.fault(
                "machine-motion",
                said.span(),
                format!("[{table}] {name} is {} s; it must be 0 to {MOST_SECONDS} s", Short(value)),
                "the unit is seconds",
            );
        }
        value
    }
}
