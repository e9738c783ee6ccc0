//! The numbers of a servo by the names of the machine file.

use super::{Drive, Servo, ServoModel};

/// A number of a servo.
#[derive(Debug)]
pub struct Parameter<'a> {
    /// The table below `[servo.X]` that it stands in, `loops.screw`; empty for `[servo.X]` itself.
    pub table: &'static str,
    /// Key in the machine file.
    pub name: &'static str,
    /// Value in the file's unit.
    pub value: &'a mut f64,
}

/// Numbers by their keys, those that the file says.
type NamedParameters<'a> = Vec<(&'static str, Option<&'a mut f64>)>;

impl Servo {
    /// The numbers of the servo that the file says, by their keys; those of a transfer function have none.
    pub fn parameters(&mut self) -> Vec<Parameter<'_>> {
        let mut found: Vec<Parameter<'_>> = Vec::new();
        match &mut self.model {
            ServoModel::Loops(loops) => {
                let numbers = vec![
                    ("kv", Some(&mut loops.kv)),
                    ("velocity_feed_forward", Some(&mut loops.velocity_feed_forward)),
                    ("acceleration_feed_forward", Some(&mut loops.acceleration_feed_forward)),
                    ("velocity_gain", Some(&mut loops.velocity_gain)),
                    ("velocity_time", loops.velocity_time.as_mut()),
                    ("motor_inertia", Some(&mut loops.motor_inertia)),
                    ("motor_damping", Some(&mut loops.motor_damping)),
                ];
                found.extend(said("loops", numbers));
                if let Some(current) = &mut loops.current {
                    let numbers = vec![
                        ("current_gain", Some(&mut current.gain)),
                        ("current_time", current.time.as_mut()),
                        ("resistance", Some(&mut current.resistance)),
                        ("inductance", Some(&mut current.inductance)),
                        ("torque_constant", Some(&mut current.torque_constant)),
                        ("back_emf", Some(&mut current.back_emf)),
                    ];
                    found.extend(said("loops", numbers));
                }
                let (table, numbers) = of_drive(&mut loops.drive);
                found.extend(said(table, numbers));
            }
            ServoModel::Pid(pid) => {
                let numbers = vec![
                    ("kp", Some(&mut pid.kp)),
                    ("ki", Some(&mut pid.ki)),
                    ("kd", Some(&mut pid.kd)),
                    ("gain", Some(&mut pid.gain)),
                    ("inertia", Some(&mut pid.inertia)),
                    ("damping", Some(&mut pid.damping)),
                ];
                found.extend(said("pid", numbers));
            }
            ServoModel::Transfer(_) => {}
        }
        if let Some(friction) = &mut self.friction {
            let numbers = vec![
                ("coulomb", Some(&mut friction.coulomb)),
                ("width", Some(&mut friction.width)),
            ];
            found.extend(said("friction", numbers));
        }
        found.extend(said("", vec![("backlash", Some(&mut self.backlash))]));
        found
    }

    /// The number of that key.
    pub fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        let mut all = self.parameters().into_iter();
        all.find(|parameter| parameter.name == name).map(|parameter| parameter.value)
    }
}

fn said<'a>(
    table: &'static str,
    numbers: NamedParameters<'a>,
) -> impl Iterator<Item = Parameter<'a>> {
    numbers.into_iter().filter_map(move |(name, value)| {
        let value = value?;
        Some(Parameter { table, name, value })
    })
}

fn of_drive(drive: &mut Drive) -> (&'static str, NamedParameters<'_>) {
    match drive {
        Drive::Screw {
            lead,
            screw_damping,
            axial_stiffness,
            torsional_stiffness,
            axial_damping,
            table_mass,
            table_damping,
        } => (
            "loops.screw",
            vec![
                ("lead", Some(lead)),
                ("screw_damping", Some(screw_damping)),
                ("axial_stiffness", axial_stiffness.as_mut()),
                ("torsional_stiffness", torsional_stiffness.as_mut()),
                ("axial_damping", Some(axial_damping)),
                ("table_mass", Some(table_mass)),
                ("table_damping", Some(table_damping)),
            ],
        ),
        Drive::Gear { ratio, gear_stiffness, gear_damping, table_inertia, table_damping } => (
            "loops.gear",
            vec![
                ("ratio", Some(ratio)),
                ("gear_stiffness", gear_stiffness.as_mut()),
                ("gear_damping", Some(gear_damping)),
                ("table_inertia", Some(table_inertia)),
                ("table_damping", Some(table_damping)),
            ],
        ),
        Drive::Direct { load, load_damping } => {
            let numbers = vec![("load", Some(load)), ("load_damping", Some(load_damping))];
            ("loops.direct", numbers)
        }
    }
}
