//! What a machine file may say of the servo of an axis: `[servo.X]`. What the values do is described with the types of
//! [`crate::servo`].

use super::bounds::Bounds;
use super::quantity::KeyedNumber;
use super::table::{Spanned, keys};
use crate::servo::Feedback;

const ABOVE: Bounds = Bounds::above_zero("machine-servo");

const FROM: Bounds = Bounds::from_zero("machine-servo");

/// Shares of what the set-points ask for.
const SHARE: Bounds = Bounds::within(0.0, 2.0, "machine-servo", "; it must be from 0 to 2");

keys! {
    /// The servo of an axis: how far it is from its set-points. One of `loops`, `transfer` and `pid`.
    ServoFile {
        /// Position, velocity and current loop, motor, transmission and table.
        loops: Option<Spanned<LoopsFile>>,
        /// A transfer function from the commanded to the actual position.
        transfer: Option<Spanned<TransferFile>>,
        /// A PID position controller over an inertia with damping.
        pid: Option<Spanned<PidFile>>,
        /// Dry friction on the table's guide; only with `loops`.
        friction: Option<Spanned<FrictionFile>>,
        /// Play between motor and table, from one flank to the other, mm or degrees; 0 if not said.
        backlash: Option<KeyedNumber> = FROM,
    }
}

keys! {
    /// Position, velocity and current loop, motor, transmission and table.
    LoopsFile {
        /// What the position loop measures: the table (scale, a full closed loop) or the motor's encoder (motor); scale if
        /// not said. The velocity loop always measures the motor.
        feedback: Option<Feedback>,
        /// Gain of the position loop, Kv, 1/s: commanded velocity over position error. (Kv = 1 m/(min·mm) is 16.667 1/s.)
        kv: Option<KeyedNumber> = ABOVE,
        /// Share of the velocity of the set-points that is added to the commanded velocity, 0 to 2; 0 if not said.
        velocity_feed_forward: Option<KeyedNumber> = SHARE,
        /// Share of the torque for the acceleration of the set-points (motor and table) that is added to the commanded
        /// torque, 0 to 2; 0 if not said.
        acceleration_feed_forward: Option<KeyedNumber> = SHARE,
        /// Gain of the velocity loop, N·m·s/rad: commanded torque over the speed error of the motor; N·s/m for the direct
        /// drive of a linear axis.
        velocity_gain: Option<KeyedNumber> = ABOVE,
        /// Integral time of the velocity loop, s; without it the loop has no integral part.
        velocity_time: Option<KeyedNumber> = ABOVE,
        /// Gain of the current loop, V/A. Without it (and the five keys behind it) the torque follows its command at once.
        current_gain: Option<KeyedNumber> = ABOVE,
        /// Integral time of the current loop, s; without it the loop has no integral part.
        current_time: Option<KeyedNumber> = ABOVE,
        /// Resistance of the motor's winding, Ω (q axis, one phase).
        resistance: Option<KeyedNumber> = ABOVE,
        /// Inductance of the motor's winding, mH (q axis, one phase).
        inductance: Option<KeyedNumber> = ABOVE,
        /// Torque over current, N·m/A; N/A for the direct drive of a linear axis.
        torque_constant: Option<KeyedNumber> = ABOVE,
        /// Voltage over speed, V·s/rad; V·s/m for the direct drive of a linear axis.
        back_emf: Option<KeyedNumber> = FROM,
        /// Inertia that turns with the motor (rotor, coupling, screw or worm), Jm, kg·m²; the mass of its moving part,
        /// kg, for the direct drive of a linear axis.
        motor_inertia: Option<KeyedNumber> = ABOVE,
        /// Viscous damping of the motor, Bm, N·m·s/rad; N·s/m for the direct drive of a linear axis; 0 if not said.
        motor_damping: Option<KeyedNumber> = FROM,
        /// A lead screw moves a table: linear axes.
        screw: Option<Spanned<ScrewFile>>,
        /// A gear or a worm turns a table: rotary axes.
        gear: Option<Spanned<GearFile>>,
        /// The motor carries the table.
        direct: Option<Spanned<DirectFile>>,
    }
}

keys! {
    /// A lead screw moves a table.
    ScrewFile {
        /// Lead, mm of table a turn of the motor.
        lead: Option<KeyedNumber> = ABOVE,
        /// Viscous damping of bearings, screw and nut, Bs, N·m·s/rad; 0 if not said. It acts on the motor's shaft.
        screw_damping: Option<KeyedNumber> = FROM,
        /// Stiffness along the axis from the screw to the table, Kj, N/µm; rigid if not said.
        axial_stiffness: Option<KeyedNumber> = ABOVE,
        /// Stiffness of the screw against twisting, Ks, N·m/rad; rigid if not said.
        torsional_stiffness: Option<KeyedNumber> = ABOVE,
        /// Damping of the transmission itself, beside its stiffness, N·s/m; 0 if not said.
        axial_damping: Option<KeyedNumber> = FROM,
        /// Mass of what moves along the axis, Mt, kg.
        table_mass: Option<KeyedNumber> = ABOVE,
        /// Viscous damping of the guide, Bt, N·s/m; 0 if not said.
        table_damping: Option<KeyedNumber> = FROM,
    }
}

keys! {
    /// A gear or a worm turns a table.
    GearFile {
        /// Turns of the motor for one turn of the table.
        ratio: Option<KeyedNumber> = ABOVE,
        /// Stiffness against twisting, at the table with the motor held, N·m/rad; rigid if not said.
        gear_stiffness: Option<KeyedNumber> = ABOVE,
        /// Damping of the gear itself, beside its stiffness, at the table, N·m·s/rad; 0 if not said.
        gear_damping: Option<KeyedNumber> = FROM,
        /// Inertia of what turns with the table, kg·m².
        table_inertia: Option<KeyedNumber> = ABOVE,
        /// Viscous damping of the table's bearing, N·m·s/rad; 0 if not said.
        table_damping: Option<KeyedNumber> = FROM,
    }
}

keys! {
    /// The motor carries the table.
    DirectFile {
        /// What the motor carries beside its own moving part: inertia of a rotary axis, kg·m², or mass of a linear one, kg.
        load: Option<KeyedNumber> = ABOVE,
        /// Viscous damping of bearing or guide, N·m·s/rad or N·s/m; 0 if not said.
        load_damping: Option<KeyedNumber> = FROM,
    }
}

keys! {
    /// A transfer function from the commanded to the actual position.
    TransferFile {
        /// Coefficients of the powers of s, 1/s, the highest first.
        numerator: Option<Spanned<Vec<KeyedNumber>>> = Bounds::items(1),
        /// Coefficients of the powers of s, 1/s, the highest first; its last equals that of the numerator, so that the axis
        /// arrives where it is commanded.
        denominator: Option<Spanned<Vec<KeyedNumber>>> = Bounds::items(2),
    }
}

keys! {
    /// A PID position controller over an inertia with damping.
    PidFile {
        /// Proportional part, V/mm or V/degree.
        kp: Option<KeyedNumber> = ABOVE,
        /// Integral part, V/(mm·s) or V/(degree·s); 0 if not said.
        ki: Option<KeyedNumber> = FROM,
        /// Derivative part, V·s/mm or V·s/degree; 0 if not said.
        kd: Option<KeyedNumber> = FROM,
        /// Amplifier, A/V, times torque constant, N·m/A, times travel of the axis per radian of the motor, mm/rad or
        /// degrees/rad.
        gain: Option<KeyedNumber> = ABOVE,
        /// Inertia of the drive on the motor's shaft, J, kg·m².
        inertia: Option<KeyedNumber> = ABOVE,
        /// Viscous damping on the motor's shaft, B, kg·m²/s (N·m·s/rad); 0 if not said.
        damping: Option<KeyedNumber> = FROM,
    }
}

keys! {
    /// Dry friction on the table's guide.
    FrictionFile {
        /// Its force, N, or torque, N·m, against the motion of the table.
        coulomb: Option<KeyedNumber> = FROM,
        /// Below this speed it grows in proportion to speed, mm/s or degrees/s; 0 if not said: the table sticks.
        width: Option<KeyedNumber> = FROM,
    }
}
