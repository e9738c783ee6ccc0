//! The servo of an axis: what a machine file says of it, and the linear equations that follow.
//!
//! Three ways to describe one:
//!
//! - [`Loops`]: position, velocity and current loop, motor, transmission and table, after Zhang, Chen (2025), "Offline
//!   prediction of contour errors for five-axis machine tools based on processing instructions", eqs. 8 to 10;
//! - [`Transfer`]: a transfer function;
//! - [`Pid`]: the servo of Chen, Ren, Sun (2016), "Contouring accuracy improvement using an adaptive feedrate planning
//!   method for CNC machine tools", eq. 2.
//!
//! With `r` commanded, `x` the table, `y` what is measured (table or motor), `ω` the motor's speed and `ρ` the way of the
//! axis per radian of the motor, the equations of [`Loops`] are:
//!
//! ```text
//! position   ω* = (Kv·(r - y) + kv·r') / ρ                    kv: velocity feed-forward
//! velocity   T* = G·(e + ∫e dt / Tn) + ka·J·r''/ρ,  e = ω* - ω    ka: acceleration feed-forward, J: motor and table
//! current    i* = T*/kt,  V = Gc·(c + ∫c dt / Tc),  c = i* - i
//! motor      L·i' = V - R·i - ke·ω,  Tm = kt·i
//! shaft      Jm·ω' + (Bm + Bs)·ω + ρ·F = Tm                   eq. 8, first line
//! table      Mt·x'' + Bt·x' + Tf = F                          eq. 8, second line
//! screw      F = K·(xm - x) + D·(xm' - x'),  xm = ρ·θ         eq. 8, third line; D is not in the paper, 0 if not said
//! ```
//!
//! with `K = 1/(1/Kj + l²/(4π²Ks))` (eq. 9). A synchronous motor with permanent magnets whose current has no d part
//! (`id = 0`, the rule for surface magnets below the rated speed) is just this: its torque is `1.5·p·ψ·iq`, the d axis
//! decouples, and `kt = 1.5·p·ψ`, `ke = p·ψ` (p pole pairs, ψ flux linkage) with the q axis' R and L. Voltage and current
//! have no limits here: what an axis cannot do is for the limits of the planner.
//!
//! Approximations, each an option: dry friction ([`Friction`]) and play ([`Servo::backlash`]). Left out: cogging, unbalance
//! of a tilted table, cutting forces, delays of the drive's sampling, and that a trunnion's inertia depends on what it
//! carries.

mod parameters;
mod poles;
mod response;
mod state_space;

use std::f64::consts::TAU;

pub use parameters::Parameter;
pub use poles::{ServoPole, stable};
pub use response::FrequencyResponse;
pub use state_space::{Released, StateSpace};

use crate::description::table::words;
use crate::diagnostic::SourcePlace;

/// Largest number of states of a servo.
pub const MAX_ORDER: usize = 12;

/// The servo of an axis. All values are in the units of the machine file.
#[derive(Clone, Debug, PartialEq)]
pub struct Servo {
    /// Where the file describes it.
    pub place: Option<SourcePlace>,
    /// The axis is rotary: degrees, N·m and kg·m² where a linear one has mm, N and kg.
    pub rotary: bool,
    /// How it behaves.
    pub model: ServoModel,
    /// Dry friction on the table's guide; none: there is none. Only of [`ServoModel::Loops`].
    pub friction: Option<Friction>,
    /// Play between motor and table, from one flank to the other, mm or degrees.
    ///
    /// In [`Loops`] with a stiffness it is a dead zone of the transmission, inside the loops: while the flanks do not
    /// touch, no force is handed on. Everywhere else it is a play behind the loops: the table stands still until the motor
    /// has gone from one flank to the other, and then goes along with it.
    pub backlash: f64,
}

/// How a servo behaves.
#[derive(Clone, Debug, PartialEq)]
pub enum ServoModel {
    /// Position, velocity and current loop.
    Loops(Box<Loops>),
    /// A transfer function.
    Transfer(Transfer),
    /// A PID position controller.
    Pid(Pid),
}

/// Position, velocity and current loop, motor, transmission and table.
#[derive(Clone, Debug, PartialEq)]
pub struct Loops {
    /// What the position loop measures.
    pub feedback: Feedback,
    /// Gain of the position loop, 1/s.
    pub kv: f64,
    /// Share of the set-points' velocity that is added to the commanded velocity.
    pub velocity_feed_forward: f64,
    /// Share of the torque for the set-points' acceleration that is added to the commanded torque.
    pub acceleration_feed_forward: f64,
    /// Gain of the velocity loop, N·m·s/rad (direct drive of a linear axis: N·s/m).
    pub velocity_gain: f64,
    /// Integral time of the velocity loop, s; none: no integral part.
    pub velocity_time: Option<f64>,
    /// Current loop and winding; none: the torque follows its command at once.
    pub current: Option<Current>,
    /// Inertia that turns with the motor, kg·m² (direct drive of a linear axis: mass, kg).
    pub motor_inertia: f64,
    /// Viscous damping of the motor, N·m·s/rad (direct drive of a linear axis: N·s/m).
    pub motor_damping: f64,
    /// What stands between motor and table.
    pub drive: Drive,
}

words! {
    /// What the position loop measures.
    Feedback = Scale {
        /// The table: a full closed loop, as in the prediction paper.
        Scale "scale",
        /// The motor's encoder.
        Motor "motor",
    }
}

/// Current loop and winding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Current {
    /// Gain of the loop, V/A.
    pub gain: f64,
    /// Integral time of the loop, s; none: no integral part.
    pub time: Option<f64>,
    /// Resistance, Ω.
    pub resistance: f64,
    /// Inductance, mH.
    pub inductance: f64,
    /// Torque over current, N·m/A (direct drive of a linear axis: N/A).
    pub torque_constant: f64,
    /// Voltage over speed, V·s/rad (direct drive of a linear axis: V·s/m).
    pub back_emf: f64,
}

/// What stands between motor and table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// A lead screw moves a table.
    Screw {
        /// mm of table a turn of the motor.
        lead: f64,
        /// Viscous damping of bearings, screw and nut on the motor's shaft, N·m·s/rad.
        screw_damping: f64,
        /// Kj, N/µm; none: rigid.
        axial_stiffness: Option<f64>,
        /// Ks, N·m/rad; none: rigid.
        torsional_stiffness: Option<f64>,
        /// Damping beside the stiffness, N·s/m.
        axial_damping: f64,
        /// Mt, kg.
        table_mass: f64,
        /// Bt, N·s/m.
        table_damping: f64,
    },
    /// A gear or a worm turns a table.
    Gear {
        /// Turns of the motor for one of the table.
        ratio: f64,
        /// Stiffness at the table, N·m/rad; none: rigid.
        gear_stiffness: Option<f64>,
        /// Damping beside the stiffness, at the table, N·m·s/rad.
        gear_damping: f64,
        /// kg·m².
        table_inertia: f64,
        /// N·m·s/rad.
        table_damping: f64,
    },
    /// The motor carries the table.
    Direct {
        /// What it carries, kg·m² or kg.
        load: f64,
        /// N·m·s/rad or N·s/m.
        load_damping: f64,
    },
}

/// A transfer function from the commanded to the actual position: coefficients of the powers of s, highest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// Numerator.
    pub numerator: Vec<f64>,
    /// Denominator; not of a lower power than the numerator.
    pub denominator: Vec<f64>,
}

/// A PID position controller over an inertia with damping:
/// `G(s) = K(kd s² + kp s + ki) / (J s³ + (B + K kd) s² + K kp s + K ki)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid {
    /// Proportional part, V/mm or V/degree.
    pub kp: f64,
    /// Integral part, V/(mm·s) or V/(degree·s).
    pub ki: f64,
    /// Derivative part, V·s/mm or V·s/degree.
    pub kd: f64,
    /// K: amplifier, A/V, × torque constant, N·m/A, × travel, mm/rad or degrees/rad.
    pub gain: f64,
    /// J, kg·m².
    pub inertia: f64,
    /// B, kg·m²/s.
    pub damping: f64,
}

/// Dry friction on the table's guide: `Tf = coulomb·clamp(v/width, -1, 1)`. With `width` 0 the table sticks until `coulomb`
/// is passed. Static friction is no larger than that of motion, and nothing depends on the place or on time: an
/// approximation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Force, N, or torque, N·m.
    pub coulomb: f64,
    /// Below this speed it grows in proportion to speed, mm/s or degrees/s.
    pub width: f64,
}

/// A drive as the equations see it: m, kg, N for linear axes, radians, kg·m², N·m for rotary ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mechanics {
    /// Way of the axis per radian of the motor, m/rad or rad/rad; 1 for a direct drive.
    pub travel: f64,
    /// Damping on the motor's shaft beside that of the motor, N·m·s/rad.
    pub shaft_damping: f64,
    /// Stiffness between motor and table, N/m or N·m/rad; none: rigid.
    pub stiffness: Option<f64>,
    /// Damping beside the stiffness, N·s/m or N·m·s/rad.
    pub stiffness_damping: f64,
    /// Mass or inertia of the table, kg or kg·m².
    pub mass: f64,
    /// Damping of the table's guide, N·s/m or N·m·s/rad.
    pub damping: f64,
}

impl Mechanics {
    /// Angular frequency at which the table swings on its transmission with the motor held and nothing damped, rad/s:
    /// `sqrt(K/Mt)` (eq. 10 with Bt = 0); none where it is rigid.
    pub fn natural_frequency(&self) -> Option<f64> {
        Some(libm::sqrt(self.stiffness? / self.mass))
    }
}

impl Drive {
    /// The drive as the equations see it.
    pub fn mechanics(&self) -> Mechanics {
        match *self {
            Self::Screw {
                lead,
                screw_damping,
                axial_stiffness,
                torsional_stiffness,
                axial_damping,
                table_mass,
                table_damping,
            } => {
                let travel = lead * 1e-3 / TAU;
                // Eq. 9: compliances in a row, that of the twisted screw seen along the axis.
                let axial = axial_stiffness.map_or(0.0, |stiffness| 1e-6 / stiffness);
                let torsional =
                    torsional_stiffness.map_or(0.0, |stiffness| travel * travel / stiffness);
                let compliance = axial + torsional;
                Mechanics {
                    travel,
                    shaft_damping: screw_damping,
                    stiffness: (compliance > 0.0).then(|| 1.0 / compliance),
                    stiffness_damping: axial_damping,
                    mass: table_mass,
                    damping: table_damping,
                }
            }
            Self::Gear { ratio, gear_stiffness, gear_damping, table_inertia, table_damping } => {
                Mechanics {
                    travel: 1.0 / ratio,
                    shaft_damping: 0.0,
                    stiffness: gear_stiffness,
                    stiffness_damping: gear_damping,
                    mass: table_inertia,
                    damping: table_damping,
                }
            }
            Self::Direct { load, load_damping } => Mechanics {
                travel: 1.0,
                shaft_damping: 0.0,
                stiffness: None,
                stiffness_damping: 0.0,
                mass: load,
                damping: load_damping,
            },
        }
    }
}

impl Servo {
    /// One unit of the axis (mm, radian) in those of the equations (m, radian).
    pub(crate) fn length(&self) -> f64 {
        if self.rotary { 1.0 } else { 1e-3 }
    }

    /// One unit of the file (mm, degree) in those of the axis (mm, radian).
    pub fn unit(&self) -> f64 {
        if self.rotary { 1f64.to_radians() } else { 1.0 }
    }

    /// The play is inside the loops: a dead zone of the transmission.
    pub fn play_inside(&self) -> bool {
        match &self.model {
            ServoModel::Loops(loops) => loops.drive.mechanics().stiffness.is_some(),
            ServoModel::Transfer(_) | ServoModel::Pid(_) => false,
        }
    }
}
