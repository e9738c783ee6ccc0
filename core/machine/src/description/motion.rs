//! What a machine file says of how the control makes motion: `[motion]`.

use super::bounds::Bounds;
use super::build::Builder;
use super::quantity::KeyedNumber;
use super::table::{Count, keys, words};

const ABOVE: Bounds = Bounds {
    table: "[motion] ",
    help: "leave it out where there is no limit",
    ..Bounds::above_zero("machine-motion")
};

/// Times in which a control waits or makes something ready.
pub(super) const WAIT: Bounds = Bounds {
    above: None,
    least: Some(0.0),
    farthest: 3600.0,
    says: " s; it must be 0 to 3600 s",
    help: "the unit is seconds",
    ..ABOVE
};

const PERIOD: Bounds = Bounds {
    least: Some(1e-5),
    most: Some(1.0),
    farthest: 1.0,
    says: " s; from 0.00001 to 1 s is possible",
    help: "periods of controls are 0.0005 to 0.02 s: the unit is seconds",
    ..WAIT
};

const BLOCKS: Bounds = Bounds {
    table: "[motion] ",
    ..Bounds::within(1.0, 1e5, "machine-motion", "; it must be 1 to 100000 blocks")
};

keys! {
    /// How the control makes motion of a program. What is posted does not depend on it, but for feeds that are planned.
    MotionFile {
        /// Time from one set-point of the axes to the next (interpolation cycle, IPO), s, 0.00001 to 1; 0.001 if not said.
        period: Option<KeyedNumber> = PERIOD,
        /// The control prepares no more than one block in this time, s; 0 if not said.
        block_time: Option<KeyedNumber> = WAIT,
        /// Blocks that it looks ahead; 200 if not said, 1 stops at the end of each.
        look_ahead: Option<Count> = BLOCKS,
        /// What max_feed, max_accel and max_jerk of the axes hold for where the control keeps the tip: the axes, or the
        /// coordinates that are programmed (X, Y and Z of the tip); axes if not said.
        limits: LimitsActOn,
        /// Largest acceleration of the tip against the part, mm/s²; none if not said.
        tip_accel: Option<KeyedNumber> = ABOVE,
        /// Largest jerk of the tip against the part, mm/s³; none if not said.
        tip_jerk: Option<KeyedNumber> = ABOVE,
        /// Largest jump of the velocity of the tip against the part where one block passes into the next without a curve
        /// between them, mm/min; if not said what tip_accel makes of it in one period.
        tip_jump: Option<KeyedNumber> = ABOVE,
        /// How the control passes from one cut to the next before the program says anything of it; blend if not said.
        corner: CornerRule,
        /// By how much it may leave the path at a corner where the program names no tolerance, mm; as far as its rule leads
        /// if not said.
        corner_tolerance: Option<KeyedNumber> = ABOVE,
        /// How it leaves the path at a corner; round if not said.
        blend: BlendRule,
        /// Whether it passes into and out of rapids without standing still; stop if not said.
        rapids: RapidRule,
        /// It waits so long wherever it stands still between two moves, until its axes are in position (exact stop), s;
        /// 0 if not said: it goes on as soon as the commanded position stands.
        in_position: Option<KeyedNumber> = WAIT,
        /// A tool change takes so long, s; 0 if not said.
        tool_change: Option<KeyedNumber> = WAIT,
        /// The program waits so long where the spindle starts, stops or changes its sense, s; 0 if not said.
        spindle: Option<KeyedNumber> = WAIT,
    }
}

words! {
    /// What the limits of the axes hold for where the control keeps the tip.
    LimitsActOn = Axes {
        /// The axes, whatever they do for the tip.
        Axes "axes",
        /// The programmed coordinates: the linear axes may go faster while rotary ones turn (LinuxCNC).
        Programmed "programmed",
    }
}

words! {
    /// How a control passes from one cut to the next.
    CornerRule = Blend {
        /// It stands still at the end of every block (exact stop).
        Stop "stop",
        /// It keeps the path, and stands still only where the direction changes (exact path).
        Path "path",
        /// It may leave the path (continuous path).
        Blend "blend",
    }
}

words! {
    /// How a control passes into and out of rapids.
    RapidRule = Stop {
        /// It stands still before and behind each (in-position check).
        Stop "stop",
        /// As between cuts from one rapid into the next; between rapids and cuts it stands still (LinuxCNC).
        AmongRapids "among-rapids",
        /// As between cuts.
        Blend "blend",
    }
}

words! {
    /// How a control leaves the path at a corner.
    BlendRule = Round {
        /// The next block is speeded up while the last one is slowed down: LinuxCNC's rule, with its halves of
        /// accelerations; blocks in which rotary axes turn have a standstill between them on an exact path.
        Overlap "overlap",
        /// A curve takes the place of both ends.
        Round "round",
    }
}

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
    /// Distance by which it may leave the path at a corner where the program names no tolerance, mm; none: as far as
    /// its rule leads.
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

impl Builder<'_> {
    pub(super) fn motion(&mut self, file: &MotionFile) -> MotionRules {
        let period = self.checked(&file.period).unwrap_or(0.001);
        let look_ahead = self.counted(&file.look_ahead).unwrap_or(200) as usize;
        let mut number = |given: &Option<KeyedNumber>| self.checked(given);
        let tip_accel = number(&file.tip_accel).unwrap_or(f64::INFINITY);
        let tip_jerk = number(&file.tip_jerk).unwrap_or(f64::INFINITY);
        let tip_jump = number(&file.tip_jump);
        let corner_tolerance = number(&file.corner_tolerance);
        MotionRules {
            period,
            block_time: number(&file.block_time).unwrap_or(0.0),
            look_ahead,
            limits: file.limits,
            tip_accel,
            tip_jerk,
            tip_jump,
            corner: file.corner,
            corner_tolerance,
            blend: file.blend,
            rapids: file.rapids,
            in_position: number(&file.in_position).unwrap_or(0.0),
            tool_change: number(&file.tool_change).unwrap_or(0.0),
            spindle: number(&file.spindle).unwrap_or(0.0),
        }
    }
}
