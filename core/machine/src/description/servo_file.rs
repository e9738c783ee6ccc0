//! What a machine file may say of the servo of an axis: `[servo.X]`. What the values do is described with the types of
//! [`crate::servo`].

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::quantity::{Number, Quantity};
use crate::servo::Feedback;

/// The servo of an axis: how far it is from its set-points. One of `loops`, `transfer` and `pid`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ServoFile {
    /// Position, velocity and current loop, motor, transmission and table.
    #[schemars(with = "Option<LoopsFile>")]
    pub loops: Option<Spanned<LoopsFile>>,
    /// A transfer function from the commanded to the actual position.
    #[schemars(with = "Option<TransferFile>")]
    pub transfer: Option<Spanned<TransferFile>>,
    /// A PID position controller over an inertia with damping.
    #[schemars(with = "Option<PidFile>")]
    pub pid: Option<Spanned<PidFile>>,
    /// Dry friction on the table's guide; only with `loops`.
    #[schemars(with = "Option<FrictionFile>")]
    pub friction: Option<Spanned<FrictionFile>>,
    /// Play between motor and table, from one flank to the other, mm or degrees; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub backlash: Option<Quantity>,
}

/// Position, velocity and current loop, motor, transmission and table.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoopsFile {
    /// What the position loop measures: the table (scale, a full closed loop) or the motor's encoder (motor); scale if
    /// not said. The velocity loop always measures the motor.
    pub feedback: Option<Feedback>,
    /// Gain of the position loop, Kv, 1/s: commanded velocity over position error. (Kv = 1 m/(min·mm) is 16.667 1/s.)
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub kv: Option<Quantity>,
    /// Share of the velocity of the set-points that is added to the commanded velocity, 0 to 2; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0, "maximum" = 2))]
    pub velocity_feed_forward: Option<Quantity>,
    /// Share of the torque for the acceleration of the set-points (motor and table) that is added to the commanded
    /// torque, 0 to 2; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0, "maximum" = 2))]
    pub acceleration_feed_forward: Option<Quantity>,
    /// Gain of the velocity loop, N·m·s/rad: commanded torque over the speed error of the motor; N·s/m for the direct
    /// drive of a linear axis.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub velocity_gain: Option<Quantity>,
    /// Integral time of the velocity loop, s; without it the loop has no integral part.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub velocity_time: Option<Quantity>,
    /// Gain of the current loop, V/A. Without it (and the five keys behind it) the torque follows its command at once.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub current_gain: Option<Quantity>,
    /// Integral time of the current loop, s; without it the loop has no integral part.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub current_time: Option<Quantity>,
    /// Resistance of the motor's winding, Ω (q axis, one phase).
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub resistance: Option<Quantity>,
    /// Inductance of the motor's winding, mH (q axis, one phase).
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub inductance: Option<Quantity>,
    /// Torque over current, N·m/A; N/A for the direct drive of a linear axis.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub torque_constant: Option<Quantity>,
    /// Voltage over speed, V·s/rad; V·s/m for the direct drive of a linear axis.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub back_emf: Option<Quantity>,
    /// Inertia that turns with the motor (rotor, coupling, screw or worm), Jm, kg·m²; the mass of its moving part, kg, for
    /// the direct drive of a linear axis.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub motor_inertia: Option<Quantity>,
    /// Viscous damping of the motor, Bm, N·m·s/rad; N·s/m for the direct drive of a linear axis; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub motor_damping: Option<Quantity>,
    /// A lead screw moves a table: linear axes.
    #[schemars(with = "Option<ScrewFile>")]
    pub screw: Option<Spanned<ScrewFile>>,
    /// A gear or a worm turns a table: rotary axes.
    #[schemars(with = "Option<GearFile>")]
    pub gear: Option<Spanned<GearFile>>,
    /// The motor carries the table.
    #[schemars(with = "Option<DirectFile>")]
    pub direct: Option<Spanned<DirectFile>>,
}

/// A lead screw moves a table.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScrewFile {
    /// Lead, mm of table a turn of the motor.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub lead: Option<Quantity>,
    /// Viscous damping of bearings, screw and nut, Bs, N·m·s/rad; 0 if not said. It acts on the motor's shaft.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub screw_damping: Option<Quantity>,
    /// Stiffness along the axis from the screw to the table, Kj, N/µm; rigid if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub axial_stiffness: Option<Quantity>,
    /// Stiffness of the screw against twisting, Ks, N·m/rad; rigid if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub torsional_stiffness: Option<Quantity>,
    /// Damping of the transmission itself, beside its stiffness, N·s/m; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub axial_damping: Option<Quantity>,
    /// Mass of what moves along the axis, Mt, kg.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub table_mass: Option<Quantity>,
    /// Viscous damping of the guide, Bt, N·s/m; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub table_damping: Option<Quantity>,
}

/// A gear or a worm turns a table.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct GearFile {
    /// Turns of the motor for one turn of the table.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub ratio: Option<Quantity>,
    /// Stiffness against twisting, at the table with the motor held, N·m/rad; rigid if not said.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub gear_stiffness: Option<Quantity>,
    /// Damping of the gear itself, beside its stiffness, at the table, N·m·s/rad; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub gear_damping: Option<Quantity>,
    /// Inertia of what turns with the table, kg·m².
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub table_inertia: Option<Quantity>,
    /// Viscous damping of the table's bearing, N·m·s/rad; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub table_damping: Option<Quantity>,
}

/// The motor carries the table.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DirectFile {
    /// What the motor carries beside its own moving part: inertia of a rotary axis, kg·m², or mass of a linear one, kg.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub load: Option<Quantity>,
    /// Viscous damping of bearing or guide, N·m·s/rad or N·s/m; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub load_damping: Option<Quantity>,
}

/// A transfer function from the commanded to the actual position.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TransferFile {
    /// Coefficients of the powers of s, 1/s, the highest first.
    #[schemars(with = "Option<Vec<Number>>", extend("minItems" = 1))]
    pub numerator: Option<Spanned<Vec<Quantity>>>,
    /// Coefficients of the powers of s, 1/s, the highest first; its last equals that of the numerator, so that the axis
    /// arrives where it is commanded.
    #[schemars(with = "Option<Vec<Number>>", extend("minItems" = 2))]
    pub denominator: Option<Spanned<Vec<Quantity>>>,
}

/// A PID position controller over an inertia with damping.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PidFile {
    /// Proportional part, V/mm or V/degree.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub kp: Option<Quantity>,
    /// Integral part, V/(mm·s) or V/(degree·s); 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub ki: Option<Quantity>,
    /// Derivative part, V·s/mm or V·s/degree; 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub kd: Option<Quantity>,
    /// Amplifier, A/V, times torque constant, N·m/A, times travel of the axis per radian of the motor, mm/rad or
    /// degrees/rad.
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub gain: Option<Quantity>,
    /// Inertia of the drive on the motor's shaft, J, kg·m².
    #[schemars(with = "Option<Number>", extend("exclusiveMinimum" = 0))]
    pub inertia: Option<Quantity>,
    /// Viscous damping on the motor's shaft, B, kg·m²/s (N·m·s/rad); 0 if not said.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub damping: Option<Quantity>,
}

/// Dry friction on the table's guide.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FrictionFile {
    /// Its force, N, or torque, N·m, against the motion of the table.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub coulomb: Option<Quantity>,
    /// Below this speed it grows in proportion to speed, mm/s or degrees/s; 0 if not said: the table sticks.
    #[schemars(with = "Option<Number>", extend("minimum" = 0))]
    pub width: Option<Quantity>,
}
