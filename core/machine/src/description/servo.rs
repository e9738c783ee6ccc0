//! The servos of a machine file, checked: `[servo.X]`.

use std::ops::Range;

use toml::Spanned;

use super::Axis;
use super::build::Builder;
use super::file::MachineFile;
use super::keys::axes_are;
use super::servo_file::{FrictionFile, ServoFile};
use crate::diagnostic::Short;
use crate::servo::{Drive, Feedback, Friction, Servo, ServoModel, ServoPole, StateSpace, stable};

/// A position loop whose gain at rest is further from 1 leaves the axis beside where it is commanded.
const UNIT_GAIN: f64 = 1e-6;

/// The fastest that a table may swing on its transmission, rad/s: nothing of a machine tool does.
const FASTEST: f64 = 1e5;

/// The fastest pole, 1/s: windings have some thousands.
const FASTEST_POLE: f64 = 1e7;

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
                ServoModel::Loops(Box::new(self.servo_loops(name, rotary, loops)?))
            }
            (None, Some(transfer), None) => {
                ServoModel::Transfer(self.servo_transfer(name, transfer)?)
            }
            (None, None, Some(pid)) => ServoModel::Pid(self.servo_pid(name, pid)?),
            (None, None, None) => {
                let message = format!("[servo.{name}] does not say how the servo behaves");
                let help = "one of [servo.X.loops], [servo.X.transfer] and [servo.X.pid]";
                self.fault("machine-servo", spanned.span(), message, help);
                return None;
            }
            _ => {
                let message = format!("[servo.{name}] describes the servo in more than one way");
                let help = "keep one of loops, transfer and pid";
                self.fault("machine-servo", spanned.span(), message, help);
                return None;
            }
        };
        let backlash = self.checked(&file.backlash).unwrap_or(0.0);
        let friction = file.friction.as_ref().map(|friction| self.friction(name, friction, &model));
        let servo =
            Servo { place: self.sources.place(spanned.span()), rotary, model, friction, backlash };
        self.check_backlash(name, file, &servo);
        // Numbers that are refused already would only be refused again.
        if self.faults.len() == before {
            self.check_dynamics(name, spanned.span(), &servo);
        }
        Some(servo)
    }

    fn friction(
        &mut self,
        name: &str,
        spanned: &Spanned<FrictionFile>,
        model: &ServoModel,
    ) -> Friction {
        let file = spanned.get_ref();
        let force = self.checked(&file.coulomb).unwrap_or(0.0);
        if !matches!(model, ServoModel::Loops(_)) && force != 0.0 {
            let message =
                format!("[servo.{name}.friction]: no table is known that it could act on");
            let help = "friction goes with [servo.X.loops], which describes the table";
            self.fault("machine-servo", spanned.span(), message, help);
        }
        let needed = [("coulomb", file.coulomb.is_some())];
        self.lacks(&format!("[servo.{name}.friction]"), spanned.span(), &needed);
        Friction { coulomb: force, width: self.checked(&file.width).unwrap_or(0.0) }
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
        } else if servo.play_inside() || loops.feedback == Feedback::Motor {
            return;
        } else {
            "with feedback = \"scale\" the play is inside the position loop: say the stiffness of the transmission, or leave backlash out"
        };
        let message = format!("backlash of {name}: the transmission has no stiffness");
        self.fault("machine-servo", given.span(), message, help);
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
        let largest = poles.iter().map(ServoPole::size).fold(0.0, f64::max);
        if largest > FASTEST_POLE {
            let message = format!(
                "the servo of {name} has a pole of {} 1/s; up to {FASTEST_POLE} are possible",
                Short(largest)
            );
            let help = "are its numbers in the units of the machine file: mH, kg·m², s?";
            self.fault("machine-servo", span, message, help);
            return;
        }
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
        let arrives = libm::fabs(gain - 1.0) <= UNIT_GAIN;
        if !arrives {
            let message = format!(
                "the servo of {name} would come to rest at {} of where it is commanded",
                Short(gain)
            );
            let help = "the last coefficients of numerator and denominator are the same";
            self.fault("machine-servo", span, message, help);
        }
    }

    /// Tells which of the keys that must be there are not.
    pub(super) fn lacks(
        &mut self,
        what: &str,
        span: Range<usize>,
        needed: &[(&str, bool)],
    ) -> bool {
        let missing: Vec<&str> =
            needed.iter().filter(|(_, said)| !said).map(|(key, _)| *key).collect();
        if !missing.is_empty() {
            let message = format!("{what} lacks {}", missing.join(", "));
            self.fault("machine-servo", span, message, "");
        }
        !missing.is_empty()
    }
}
