//! The servos of a machine file, checked: `[servo.X]`.

use std::ops::Range;

use toml::Spanned;

use super::Axis;
use super::build::Builder;
use super::file::MachineFile;
use super::keys::axes_are;
use super::quantity::Quantity;
use super::servo_file::{
    DirectFile, FrictionFile, GearFile, LoopsFile, PidFile, ScrewFile, ServoFile, TransferFile,
};
use crate::diagnostic::Short;
use crate::servo::{
    Current, Drive, Friction, Loops, MAX_ORDER, Pid, Servo, ServoModel, StateSpace, Transfer,
    stable,
};

/// A position loop whose gain at rest is further from 1 leaves the axis beside where it is commanded.
const UNIT_GAIN: f64 = 1e-6;

/// The fastest that a table may swing on its transmission, rad/s: nothing of a machine tool does.
const FASTEST: f64 = 1e5;

/// What a number of a servo may be.
#[derive(Clone, Copy)]
enum Allowed {
    Above,
    From,
    Share,
}

impl Builder<'_> {
    /// Gives each axis its servo.
    pub(super) fn servos(&mut self, file: &MachineFile, axes: &mut [Axis]) {
        for (name, spanned) in &file.servo {
            let Some(place) = axes.iter().position(|axis| axis.name == *name) else {
                let message = format!("[servo.{name}]: the chain has no axis {name}");
                self.fault("machine-servo", spanned.span(), message, &axes_are(axes));
                continue;
            };
            axes[place].servo = self.servo(&axes[place], spanned).map(Box::new);
        }
    }

    fn servo(&mut self, axis: &Axis, spanned: &Spanned<ServoFile>) -> Option<Servo> {
        let file = spanned.get_ref();
        let name = axis.name.as_str();
        let rotary = axis.joint.rotary;
        let before = self.faults.len();
        let model = match (&file.loops, &file.transfer, &file.pid) {
            (Some(loops), None, None) => {
                ServoModel::Loops(Box::new(self.loops(name, rotary, loops)?))
            }
            (None, Some(transfer), None) => ServoModel::Transfer(self.transfer(name, transfer)?),
            (None, None, Some(pid)) => ServoModel::Pid(self.pid(name, pid)?),
            (None, None, None) => {
                self.fault(
                    "machine-servo",
                    spanned.span(),
                    format!("[servo.{name}] does not say how the servo behaves"),
                    "one of [servo.X.loops], [servo.X.transfer] and [servo.X.pid]",
                );
                return None;
            }
            _ => {
                self.fault(
                    "machine-servo",
                    spanned.span(),
                    format!("[servo.{name}] describes the servo in more than one way"),
                    "keep one of loops, transfer and pid",
                );
                return None;
            }
        };
        let backlash = self.servo_number("backlash", &file.backlash, Allowed::From, 0.0);
        let friction = file
            .friction
            .as_ref()
            .map(|friction| self.friction(name, friction, &model));
        let servo = Servo {
            place: self.sources.place(spanned.span()),
            rotary,
            model,
            friction,
            backlash,
        };
        self.check_backlash(name, file, &servo);
        // Numbers that are refused already would only be refused again.
        if self.faults.len() == before {
            self.check_dynamics(name, spanned.span(), &servo);
        }
        Some(servo)
    }

    fn loops(&mut self, name: &str, rotary: bool, spanned: &Spanned<LoopsFile>) -> Option<Loops> {
        use Allowed::{Above, From, Share};
        let file = spanned.get_ref();
        let drive = self.drive(name, rotary, spanned);
        let current = self.current(name, spanned);
        let lacks = self.lacks(
            &format!("[servo.{name}.loops]"),
            spanned.span(),
            &[
                ("kv", file.kv.is_some()),
                ("velocity_gain", file.velocity_gain.is_some()),
                ("motor_inertia", file.motor_inertia.is_some()),
            ],
        );
        if lacks {
            return None;
        }
        Some(Loops {
            feedback: file.feedback.unwrap_or_default(),
            kv: self.servo_number("kv", &file.kv, Above, 1.0),
            velocity_feed_forward: self.servo_number(
                "velocity_feed_forward",
                &file.velocity_feed_forward,
                Share,
                0.0,
            ),
            acceleration_feed_forward: self.servo_number(
                "acceleration_feed_forward",
                &file.acceleration_feed_forward,
                Share,
                0.0,
            ),
            velocity_gain: self.servo_number("velocity_gain", &file.velocity_gain, Above, 1.0),
            velocity_time: self.servo_option("velocity_time", &file.velocity_time),
            current: current?,
            motor_inertia: self.servo_number("motor_inertia", &file.motor_inertia, Above, 1.0),
            motor_damping: self.servo_number("motor_damping", &file.motor_damping, From, 0.0),
            drive: drive?,
        })
    }

    /// The current loop, if the file says one; none if what it says is refused.
    fn current(&mut self, name: &str, spanned: &Spanned<LoopsFile>) -> Option<Option<Current>> {
        use Allowed::{Above, From};
        let file = spanned.get_ref();
        let needed = [
            ("current_gain", file.current_gain.is_some()),
            ("resistance", file.resistance.is_some()),
            ("inductance", file.inductance.is_some()),
            ("torque_constant", file.torque_constant.is_some()),
            ("back_emf", file.back_emf.is_some()),
        ];
        if file.current_time.is_none() && needed.iter().all(|(_, said)| !said) {
            return Some(None);
        }
        let what = format!("the current loop of [servo.{name}.loops]");
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        Some(Some(Current {
            gain: self.servo_number("current_gain", &file.current_gain, Above, 1.0),
            time: self.servo_option("current_time", &file.current_time),
            resistance: self.servo_number("resistance", &file.resistance, Above, 1.0),
            inductance: self.servo_number("inductance", &file.inductance, Above, 1.0),
            torque_constant: self.servo_number(
                "torque_constant",
                &file.torque_constant,
                Above,
                1.0,
            ),
            back_emf: self.servo_number("back_emf", &file.back_emf, From, 0.0),
        }))
    }

    fn drive(&mut self, name: &str, rotary: bool, spanned: &Spanned<LoopsFile>) -> Option<Drive> {
        let file = spanned.get_ref();
        match (&file.screw, &file.gear, &file.direct) {
            (Some(screw), None, None) if !rotary => self.screw(name, screw),
            (None, Some(gear), None) if rotary => self.gear(name, gear),
            (None, None, Some(direct)) => self.direct(name, direct),
            (screw, gear, direct) => {
                let span = match (screw, gear) {
                    (Some(screw), None) if direct.is_none() => screw.span(),
                    (None, Some(gear)) if direct.is_none() => gear.span(),
                    _ => spanned.span(),
                };
                let (kind, drives) = if rotary {
                    ("rotary", "gear and direct")
                } else {
                    ("linear", "screw and direct")
                };
                self.fault(
                    "machine-servo",
                    span,
                    format!("[servo.{name}.loops]: what drives {name}, a {kind} axis?"),
                    &format!("one of {drives}: [servo.{name}.loops.direct] …"),
                );
                None
            }
        }
    }

    fn screw(&mut self, name: &str, spanned: &Spanned<ScrewFile>) -> Option<Drive> {
        use Allowed::{Above, From};
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.loops.screw]");
        let needed = [
            ("lead", file.lead.is_some()),
            ("table_mass", file.table_mass.is_some()),
        ];
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        let drive = Drive::Screw {
            lead: self.servo_number("lead", &file.lead, Above, 1.0),
            screw_damping: self.servo_number("screw_damping", &file.screw_damping, From, 0.0),
            axial_stiffness: self.servo_option("axial_stiffness", &file.axial_stiffness),
            torsional_stiffness: self
                .servo_option("torsional_stiffness", &file.torsional_stiffness),
            axial_damping: self.servo_number("axial_damping", &file.axial_damping, From, 0.0),
            table_mass: self.servo_number("table_mass", &file.table_mass, Above, 1.0),
            table_damping: self.servo_number("table_damping", &file.table_damping, From, 0.0),
        };
        self.check_damping("axial_damping", &file.axial_damping, &drive);
        Some(drive)
    }

    fn gear(&mut self, name: &str, spanned: &Spanned<GearFile>) -> Option<Drive> {
        use Allowed::{Above, From};
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.loops.gear]");
        let needed = [
            ("ratio", file.ratio.is_some()),
            ("table_inertia", file.table_inertia.is_some()),
        ];
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        let drive = Drive::Gear {
            ratio: self.servo_number("ratio", &file.ratio, Above, 1.0),
            gear_stiffness: self.servo_option("gear_stiffness", &file.gear_stiffness),
            gear_damping: self.servo_number("gear_damping", &file.gear_damping, From, 0.0),
            table_inertia: self.servo_number("table_inertia", &file.table_inertia, Above, 1.0),
            table_damping: self.servo_number("table_damping", &file.table_damping, From, 0.0),
        };
        self.check_damping("gear_damping", &file.gear_damping, &drive);
        Some(drive)
    }

    fn direct(&mut self, name: &str, spanned: &Spanned<DirectFile>) -> Option<Drive> {
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.loops.direct]");
        if self.lacks(&what, spanned.span(), &[("load", file.load.is_some())]) {
            return None;
        }
        Some(Drive::Direct {
            load: self.servo_number("load", &file.load, Allowed::Above, 1.0),
            load_damping: self.servo_number("load_damping", &file.load_damping, Allowed::From, 0.0),
        })
    }

    fn transfer(&mut self, name: &str, spanned: &Spanned<TransferFile>) -> Option<Transfer> {
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.transfer]");
        let needed = [
            ("numerator", file.numerator.is_some()),
            ("denominator", file.denominator.is_some()),
        ];
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        let (Some(numerator), Some(denominator)) = (&file.numerator, &file.denominator) else {
            return None;
        };
        let mut powers = |given: &Spanned<Vec<Quantity>>| -> Vec<f64> {
            let most = given.get_ref().iter().take(2 * MAX_ORDER);
            let values: Vec<f64> = most.map(|quantity| self.number(quantity)).collect();
            let zeros = values.iter().take_while(|value| **value == 0.0).count();
            values[zeros..].to_vec()
        };
        let (above, below) = (powers(numerator), powers(denominator));
        if above.iter().chain(&below).any(|value| value.is_nan()) {
            return None;
        }
        let order = below.len().saturating_sub(1);
        let (span, message, help) = if !(1..=MAX_ORDER).contains(&order) {
            (
                denominator.span(),
                format!(
                    "{what}: the denominator is of order {order}; 1 to {MAX_ORDER} are possible"
                ),
                "its coefficients stand highest power of s first: [0.02, 1] is 0.02 s + 1",
            )
        } else if above.len() > below.len() {
            (
                numerator.span(),
                format!("{what}: the numerator is of a higher order than the denominator"),
                "such a servo would follow a change of velocity by an infinite jump",
            )
        } else {
            return Some(Transfer {
                numerator: above,
                denominator: below,
            });
        };
        self.fault("machine-servo", span, message, help);
        None
    }

    fn pid(&mut self, name: &str, spanned: &Spanned<PidFile>) -> Option<Pid> {
        use Allowed::{Above, From};
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.pid]");
        let needed = [
            ("kp", file.kp.is_some()),
            ("gain", file.gain.is_some()),
            ("inertia", file.inertia.is_some()),
        ];
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        Some(Pid {
            kp: self.servo_number("kp", &file.kp, Above, 1.0),
            ki: self.servo_number("ki", &file.ki, From, 0.0),
            kd: self.servo_number("kd", &file.kd, From, 0.0),
            gain: self.servo_number("gain", &file.gain, Above, 1.0),
            inertia: self.servo_number("inertia", &file.inertia, Above, 1.0),
            damping: self.servo_number("damping", &file.damping, From, 0.0),
        })
    }

    fn friction(
        &mut self,
        name: &str,
        spanned: &Spanned<FrictionFile>,
        model: &ServoModel,
    ) -> Friction {
        let file = spanned.get_ref();
        let force = self.servo_number("coulomb", &file.coulomb, Allowed::From, 0.0);
        if !matches!(model, ServoModel::Loops(_)) && force != 0.0 {
            self.fault(
                "machine-servo",
                spanned.span(),
                format!("[servo.{name}.friction]: no table is known that it could act on"),
                "friction goes with [servo.X.loops], which describes the table",
            );
        }
        let needed = [("coulomb", file.coulomb.is_some())];
        self.lacks(&format!("[servo.{name}.friction]"), spanned.span(), &needed);
        Friction {
            coulomb: force,
            width: self.servo_number("width", &file.width, Allowed::From, 0.0),
        }
    }

    fn check_backlash(&mut self, name: &str, file: &ServoFile, servo: &Servo) {
        let (Some(given), true) = (&file.backlash, servo.backlash > 0.0) else {
            return;
        };
        let ServoModel::Loops(loops) = &servo.model else {
            return;
        };
        let help = if matches!(loops.drive, Drive::Direct { .. }) {
            "a direct drive has no play: leave backlash out"
        } else if servo.play_inside() || loops.feedback == crate::servo::Feedback::Motor {
            return;
        } else {
            "with feedback = \"scale\" the play is inside the position loop: say the stiffness of the transmission, or leave backlash out"
        };
        let message = format!("backlash of {name}: the transmission has no stiffness");
        self.fault("machine-servo", given.span(), message, help);
    }

    /// Damping stands beside a stiffness; beside a rigid transmission it would do nothing.
    fn check_damping(&mut self, key: &str, given: &Option<Quantity>, drive: &Drive) {
        if let (Some(given), None) = (given, drive.mechanics().stiffness) {
            let message = format!("{key}: the transmission is rigid, nothing in it is damped");
            let help = "say its stiffness too, or leave the damping out";
            self.fault("machine-servo", given.span(), message, help);
        }
    }

    /// It must come to rest where it is commanded.
    fn check_dynamics(&mut self, name: &str, span: Range<usize>, servo: &Servo) {
        if let ServoModel::Loops(loops) = &servo.model
            && let Some(fastest) = loops.drive.mechanics().natural_frequency()
            && fastest > FASTEST
        {
            let message = format!(
                "the table of {name} would swing on its transmission at {} rad/s; at most {FASTEST} are possible",
                Short(fastest)
            );
            let help = "are the units those of the machine file: N/µm, N·m/rad, kg, kg·m²?";
            self.fault("machine-servo", span, message, help);
            return;
        }
        let space = StateSpace::of(servo);
        let Some(poles) = space.poles() else {
            let message = format!("the poles of the servo of {name} cannot be found");
            let help = "are its numbers in the units of the machine file?";
            self.fault("machine-servo", span, message, help);
            return;
        };
        if !stable(&poles) {
            let told: Vec<String> = poles.iter().map(ToString::to_string).collect();
            let message = format!(
                "the servo of {name} is not stable: of its poles, {} 1/s, those whose real part is not below zero let an error grow",
                told.join(", ")
            );
            let help = match servo.model {
                ServoModel::Loops(_) => {
                    "a smaller kv, a longer velocity_time, or damping of the transmission"
                }
                ServoModel::Transfer(_) => {
                    "all zeros of the denominator must have real parts below zero"
                }
                ServoModel::Pid(_) => "a smaller ki, or a larger kd",
            };
            self.fault("machine-servo", span, message, help);
            return;
        }
        let gain = space.static_gain().unwrap_or(f64::NAN);
        if libm::fabs(gain - 1.0).is_nan() || libm::fabs(gain - 1.0) > UNIT_GAIN {
            let message = format!(
                "the servo of {name} would come to rest at {} of where it is commanded",
                Short(gain)
            );
            let help = "the last coefficients of numerator and denominator are the same";
            self.fault("machine-servo", span, message, help);
        }
    }

    /// Tells which of the keys that must be there are not.
    fn lacks(&mut self, what: &str, span: Range<usize>, needed: &[(&str, bool)]) -> bool {
        let missing: Vec<&str> = needed
            .iter()
            .filter(|(_, said)| !said)
            .map(|(key, _)| *key)
            .collect();
        if !missing.is_empty() {
            let message = format!("{what} lacks {}", missing.join(", "));
            self.fault("machine-servo", span, message, "");
        }
        !missing.is_empty()
    }

    fn servo_option(&mut self, key: &str, quantity: &Option<Quantity>) -> Option<f64> {
        quantity
            .as_ref()
            .map(|_| self.servo_number(key, quantity, Allowed::Above, 1.0))
    }

    fn servo_number(
        &mut self,
        key: &str,
        quantity: &Option<Quantity>,
        range: Allowed,
        default: f64,
    ) -> f64 {
        let Some(quantity) = quantity else {
            return default;
        };
        let value = self.number(quantity);
        let (refused, must) = match range {
            Allowed::Above => (value <= 0.0, "must be above zero"),
            Allowed::From => (value < 0.0, "cannot be below zero"),
            Allowed::Share => (
                !(0.0..=2.0).contains(&value) && !value.is_nan(),
                "must be from 0 to 2",
            ),
        };
        if refused {
            let message = format!("{key} is {}; it {must}", Short(value));
            self.fault("machine-servo", quantity.span(), message, "");
        }
        value
    }
}
