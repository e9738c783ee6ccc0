//! How much of each limit a plan uses at a point of the path, worked out from the path itself and not from the rows that
//! a solver was given.

use post_machine::description::{LimitsActOn, Machine};
use post_machine::kinematics::{JointDerivatives, ORDERS};

use super::keep::PlanLimits;

/// What is limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Speed of the tip against the part.
    Feed,
    /// Velocity of an axis.
    Velocity,
    /// Acceleration of an axis.
    Acceleration,
    /// Jerk of an axis.
    Jerk,
    /// Acceleration of the tip.
    TipAcceleration,
    /// Jerk of the tip.
    TipJerk,
    /// How far the chord of an interpolation period is off the path.
    ChordError,
    /// How far the servos leave the path, by the formula of the steady state.
    ContourError,
    /// How soon the control needs its next block.
    BlockRate,
}

/// A limit that is measured.
#[derive(Clone, Debug)]
pub struct Gauge {
    /// What it limits.
    pub quantity: Quantity,
    /// Place among the axes that are told, of axis limits.
    pub axis: Option<usize>,
    /// mm, rad and s; infinite where it is measured alone.
    pub limit: f64,
    /// The solver keeps it.
    pub kept: bool,
    /// What it is called: `acceleration of A`.
    pub name: String,
    /// What it is told in: `°/s²`.
    pub unit: &'static str,
    /// From mm, rad and s to that unit.
    pub scale: f64,
}

/// Where the path is at a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// Parameter of the path.
    pub parameter: f64,
    /// The tip and its derivatives, mm, part frame.
    pub tip: [[f64; 3]; ORDERS],
    /// Axis values and their derivatives.
    pub course: JointDerivatives,
    /// Length of the block that it lies on, in units of the parameter; infinite where there are no blocks.
    pub block: f64,
}

/// A plan at a point of the path.
#[derive(Clone, Debug, Default)]
pub struct PlanPoint {
    /// Parameter of the path.
    pub parameter: f64,
    /// Of the tip from the beginning, mm.
    pub way: f64,
    /// From the beginning, s.
    pub time: f64,
    /// Where the tip is, mm, part frame.
    pub tip: [f64; 3],
    /// Speed of the tip, mm/s.
    pub feed: f64,
    /// Axis values, in the order of the axes that are told, mm and rad.
    pub position: Vec<f64>,
    /// By axis, mm/s and rad/s.
    pub velocity: Vec<f64>,
    /// By axis, mm/s² and rad/s².
    pub acceleration: Vec<f64>,
    /// By axis, mm/s³ and rad/s³.
    pub jerk: Vec<f64>,
    /// Acceleration of the tip, mm/s².
    pub tip_acceleration: f64,
    /// Jerk of the tip, mm/s³.
    pub tip_jerk: f64,
    /// How far the chord of one interpolation period is off the path, mm.
    pub chord_error: f64,
    /// By the formula of the steady state; NaN where nothing is known of the servos.
    pub contour_error: f64,
    /// Blocks in a second, at this speed.
    pub block_rate: f64,
}

/// The limits, and what is needed to measure them.
pub struct Gauges<'a> {
    keep: &'a PlanLimits,
    axes: Vec<usize>,
    /// By axis: where the control limits the programmed coordinates, the one that stands for the axis.
    programmed: Vec<Option<usize>>,
    /// Rotary axes are among them.
    turns: bool,
    /// What is measured, in the order in which it is told.
    pub all: Vec<Gauge>,
}

impl<'a> Gauges<'a> {
    /// Those of the axes of `machine` at the places `axes`, for which `keep` was made; `turns`: rotary axes point the tool;
    /// `jerk`: the solver keeps jerk too.
    pub fn new(
        machine: &Machine,
        axes: &[usize],
        turns: bool,
        keep: &'a PlanLimits,
        jerk: bool,
    ) -> Self {
        let programmed = axes.iter().map(|place| {
            let axis = &machine.axes[*place];
            let coordinate = ["X", "Y", "Z"].iter().position(|name| axis.word() == *name);
            let limited = machine.motion.limits == LimitsActOn::Programmed && !axis.joint.rotary;
            coordinate.filter(|_| limited)
        });
        let programmed = programmed.collect();
        let mut gauges = Self { keep, axes: axes.to_vec(), programmed, turns, all: Vec::new() };
        gauges.add(Quantity::Feed, "feed", "mm/min", 60.0, keep.feed, true);
        gauges.add_axes(
            machine,
            Quantity::Velocity,
            "velocity of",
            ["mm/s", "°/s"],
            &keep.velocity,
            true,
        );
        gauges.add_axes(
            machine,
            Quantity::Acceleration,
            "acceleration of",
            ["mm/s²", "°/s²"],
            &keep.acceleration,
            true,
        );
        gauges.add_axes(machine, Quantity::Jerk, "jerk of", ["mm/s³", "°/s³"], &keep.jerk, jerk);
        gauges.add(
            Quantity::TipAcceleration,
            "acceleration of the tip",
            "mm/s²",
            1.0,
            keep.tip_acceleration,
            true,
        );
        gauges.add(Quantity::TipJerk, "jerk of the tip", "mm/s³", 1.0, keep.tip_jerk, jerk);
        gauges.add(Quantity::ChordError, "chord error", "µm", 1e3, keep.chord_error, true);
        if keep.servos.is_some() {
            gauges.add(
                Quantity::ContourError,
                "contour error",
                "µm",
                1e3,
                keep.contour_error,
                true,
            );
        }
        if keep.block_rate.is_finite() {
            gauges.add(Quantity::BlockRate, "blocks", "1/s", 1.0, keep.block_rate, true);
        }
        gauges
    }

    fn add(
        &mut self,
        quantity: Quantity,
        name: &str,
        unit: &'static str,
        scale: f64,
        limit: f64,
        kept: bool,
    ) {
        self.all.push(Gauge {
            quantity,
            axis: None,
            limit,
            kept: kept && limit.is_finite(),
            name: name.to_owned(),
            unit,
            scale,
        });
    }

    fn add_axes(
        &mut self,
        machine: &Machine,
        quantity: Quantity,
        of: &str,
        [linear, rotary]: [&'static str; 2],
        limits: &[f64],
        kept: bool,
    ) {
        for (axis, (place, &limit)) in self.axes.iter().zip(limits).enumerate() {
            let described = &machine.axes[*place];
            self.all.push(Gauge {
                quantity,
                axis: Some(axis),
                limit,
                kept: kept && limit.is_finite(),
                name: format!("{of} {}", described.name),
                unit: if described.joint.rotary { rotary } else { linear },
                scale: 1.0 / described.unit(),
            });
        }
    }

    /// The plan at a station of the path, where the squared speed of the parameter and its first and second derivative by
    /// it are these. Way and time are left at zero.
    pub fn measure(&self, station: &Station, [q, slope, bend]: [f64; 3]) -> PlanPoint {
        let speed = q.max(0.0).sqrt();
        // By the chain rule, with s̈ = q' / 2 and s⃛ = q'' ṡ / 2.
        let derivatives = |[first, second, third]: [f64; 3]| {
            [
                first * speed,
                0.5 * first * slope + second * q,
                speed * (0.5 * first * bend + 1.5 * second * slope + third * q),
            ]
        };
        let tip: [[f64; 3]; 3] = std::array::from_fn(|axis| {
            derivatives(std::array::from_fn(|order| station.tip[order + 1][axis]))
        });
        let size = |order: usize| {
            let squares = tip.iter().map(|axis| axis[order] * axis[order]);
            libm::sqrt(squares.sum())
        };
        let feed = size(0);
        let curvature = post_feed::samples::curvature(station.tip[1], station.tip[2]);
        let each = self.axes.iter().map(|place| {
            let joints = &station.course.joints;
            let [v, a, j] = derivatives(std::array::from_fn(|order| joints[order + 1][*place]));
            [joints[0][*place], v, a, j]
        });
        let each: Vec<[f64; 4]> = each.collect();
        let limited = |order: usize| {
            let values = each.iter().zip(&self.programmed).map(|(values, coordinate)| {
                coordinate.map_or(values[order], |coordinate| tip[coordinate][order - 1])
            });
            values.collect()
        };
        PlanPoint {
            parameter: station.parameter,
            way: 0.0,
            time: 0.0,
            tip: station.tip[0],
            feed,
            position: each.iter().map(|values| values[0]).collect(),
            velocity: limited(1),
            acceleration: limited(2),
            jerk: limited(3),
            tip_acceleration: size(1),
            tip_jerk: size(2),
            chord_error: chord_error(feed, curvature, self.keep.period),
            contour_error: match &self.keep.servos {
                Some(_) if feed <= 0.0 => 0.0,
                Some(servos) if self.turns => {
                    let axes = self.axes.iter().zip(&each);
                    let axes = axes
                        .map(|(place, [_, v, a, _])| (station.course.rates[*place].into(), *v, *a));
                    servos.through_axes(&axes.collect::<Vec<_>>(), station.tip[1])
                }
                Some(servos) => servos.on_a_circle(feed, curvature),
                None => f64::NAN,
            },
            block_rate: speed / station.block,
        }
    }

    /// The value of each gauge at a point, in mm, rad and s, with its sign.
    pub fn value(&self, gauge: &Gauge, point: &PlanPoint) -> f64 {
        let of = |values: &[f64]| gauge.axis.map_or(0.0, |axis| values[axis]);
        match gauge.quantity {
            Quantity::Feed => point.feed,
            Quantity::Velocity => of(&point.velocity),
            Quantity::Acceleration => of(&point.acceleration),
            Quantity::Jerk => of(&point.jerk),
            Quantity::TipAcceleration => point.tip_acceleration,
            Quantity::TipJerk => point.tip_jerk,
            Quantity::ChordError => point.chord_error,
            Quantity::ContourError => point.contour_error,
            Quantity::BlockRate => point.block_rate,
        }
    }

    /// The share of the speed at which a value that is `share` of its limit comes down to it.
    pub fn speed_at_limit(quantity: Quantity, share: f64) -> f64 {
        match quantity {
            Quantity::Feed | Quantity::Velocity | Quantity::BlockRate => 1.0 / share,
            Quantity::Acceleration | Quantity::TipAcceleration | Quantity::ChordError => {
                1.0 / share.sqrt()
            }
            Quantity::Jerk | Quantity::TipJerk => 1.0 / libm::cbrt(share),
            // It falls with the speed at least.
            Quantity::ContourError => 1.0 / share,
        }
    }
}

/// How far the chord of one period strays from an arc of this curvature, mm: the inverse of
/// [`post_feed::limits::ChordError::feed`].
pub fn chord_error(feed: f64, curvature: f64, period: f64) -> f64 {
    let half = 0.5 * feed * period;
    let radius = 1.0 / curvature;
    if half >= radius {
        return radius;
    }
    // The form that loses no digits where the radius is large.
    half * half * curvature / (1.0 + (1.0 - half * half * curvature * curvature).sqrt())
}
