//! How the servos of a machine file behave: `[servo.X.loops]`, `[servo.X.transfer]`, `[servo.X.pid]`.

use toml::Spanned;

use super::build::Builder;
use super::quantity::KeyedNumber;
use super::servo_file::{DirectFile, GearFile, LoopsFile, PidFile, ScrewFile, TransferFile};
use crate::servo::{Current, Drive, Loops, MAX_ORDER, Pid, Transfer};

impl Builder<'_> {
    pub(super) fn servo_loops(
        &mut self,
        name: &str,
        rotary: bool,
        spanned: &Spanned<LoopsFile>,
    ) -> Option<Loops> {
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
            kv: self.checked(&file.kv).unwrap_or(1.0),
            velocity_feed_forward: self.checked(&file.velocity_feed_forward).unwrap_or(0.0),
            acceleration_feed_forward: self.checked(&file.acceleration_feed_forward).unwrap_or(0.0),
            velocity_gain: self.checked(&file.velocity_gain).unwrap_or(1.0),
            velocity_time: self.checked(&file.velocity_time),
            current: current?,
            motor_inertia: self.checked(&file.motor_inertia).unwrap_or(1.0),
            motor_damping: self.checked(&file.motor_damping).unwrap_or(0.0),
            drive: drive?,
        })
    }

    /// The current loop, if the file says one; none if what it says is refused.
    fn current(&mut self, name: &str, spanned: &Spanned<LoopsFile>) -> Option<Option<Current>> {
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
            gain: self.checked(&file.current_gain).unwrap_or(1.0),
            time: self.checked(&file.current_time),
            resistance: self.checked(&file.resistance).unwrap_or(1.0),
            inductance: self.checked(&file.inductance).unwrap_or(1.0),
            torque_constant: self.checked(&file.torque_constant).unwrap_or(1.0),
            back_emf: self.checked(&file.back_emf).unwrap_or(0.0),
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
                let message = format!("[servo.{name}.loops]: what drives {name}, a {kind} axis?");
                let help = &format!("one of {drives}: [servo.{name}.loops.direct] …");
                self.fault("machine-servo", span, message, help);
                None
            }
        }
    }

    fn screw(&mut self, name: &str, spanned: &Spanned<ScrewFile>) -> Option<Drive> {
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.loops.screw]");
        let needed = [("lead", file.lead.is_some()), ("table_mass", file.table_mass.is_some())];
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        let drive = Drive::Screw {
            lead: self.checked(&file.lead).unwrap_or(1.0),
            screw_damping: self.checked(&file.screw_damping).unwrap_or(0.0),
            axial_stiffness: self.checked(&file.axial_stiffness),
            torsional_stiffness: self.checked(&file.torsional_stiffness),
            axial_damping: self.checked(&file.axial_damping).unwrap_or(0.0),
            table_mass: self.checked(&file.table_mass).unwrap_or(1.0),
            table_damping: self.checked(&file.table_damping).unwrap_or(0.0),
        };
        self.check_damping("axial_damping", &file.axial_damping, &drive);
        Some(drive)
    }

    fn gear(&mut self, name: &str, spanned: &Spanned<GearFile>) -> Option<Drive> {
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.loops.gear]");
        let needed =
            [("ratio", file.ratio.is_some()), ("table_inertia", file.table_inertia.is_some())];
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        let drive = Drive::Gear {
            ratio: self.checked(&file.ratio).unwrap_or(1.0),
            gear_stiffness: self.checked(&file.gear_stiffness),
            gear_damping: self.checked(&file.gear_damping).unwrap_or(0.0),
            table_inertia: self.checked(&file.table_inertia).unwrap_or(1.0),
            table_damping: self.checked(&file.table_damping).unwrap_or(0.0),
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
            load: self.checked(&file.load).unwrap_or(1.0),
            load_damping: self.checked(&file.load_damping).unwrap_or(0.0),
        })
    }

    pub(super) fn servo_transfer(
        &mut self,
        name: &str,
        spanned: &Spanned<TransferFile>,
    ) -> Option<Transfer> {
        let file = spanned.get_ref();
        let what = format!("[servo.{name}.transfer]");
        let needed =
            [("numerator", file.numerator.is_some()), ("denominator", file.denominator.is_some())];
        if self.lacks(&what, spanned.span(), &needed) {
            return None;
        }
        let (Some(numerator), Some(denominator)) = (&file.numerator, &file.denominator) else {
            return None;
        };
        let mut powers = |given: &Spanned<Vec<KeyedNumber>>| -> Vec<f64> {
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
            return Some(Transfer { numerator: above, denominator: below });
        };
        self.fault("machine-servo", span, message, help);
        None
    }

    pub(super) fn servo_pid(&mut self, name: &str, spanned: &Spanned<PidFile>) -> Option<Pid> {
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
            kp: self.checked(&file.kp).unwrap_or(1.0),
            ki: self.checked(&file.ki).unwrap_or(0.0),
            kd: self.checked(&file.kd).unwrap_or(0.0),
            gain: self.checked(&file.gain).unwrap_or(1.0),
            inertia: self.checked(&file.inertia).unwrap_or(1.0),
            damping: self.checked(&file.damping).unwrap_or(0.0),
        })
    }

    /// Damping stands beside a stiffness; beside a rigid transmission it would do nothing.
    fn check_damping(&mut self, key: &str, given: &Option<KeyedNumber>, drive: &Drive) {
        if let (Some(given), None) = (given, drive.mechanics().stiffness) {
            let message = format!("{key}: the transmission is rigid, nothing in it is damped");
            let help = "say its stiffness too, or leave the damping out";
            self.fault("machine-servo", given.span(), message, help);
        }
    }
}
