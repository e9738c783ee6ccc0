//! Units of a log: `--log-units`, else those in its head.

use std::f64::consts::PI;

/// What a unit is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuantityKind {
    /// The time, s.
    Time,
    /// Linear axes, mm.
    Length,
    /// Rotary axes, radians.
    Angle,
}

impl QuantityKind {
    /// `a unit of time`.
    pub fn spoken(self) -> &'static str {
        match self {
            Self::Time => "a unit of time (s, ms, us)",
            Self::Length => "a unit of length (mm, um, m, inch)",
            Self::Angle => "a unit of angles (deg, rad)",
        }
    }

    /// Where nothing is said.
    pub fn usual(self) -> Unit {
        match self {
            Self::Time => SECOND,
            Self::Length => MILLIMETRE,
            Self::Angle => DEGREE,
        }
    }
}

/// A unit of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As it is told.
    pub name: &'static str,
    /// What it is of.
    pub kind: QuantityKind,
    /// How much it is, in s, mm or radians.
    pub size: f64,
}

const fn unit(name: &'static str, kind: QuantityKind, size: f64) -> Unit {
    Unit { name, kind, size }
}

const SECOND: Unit = unit("s", QuantityKind::Time, 1.0);
const MILLIMETRE: Unit = unit("mm", QuantityKind::Length, 1.0);
const DEGREE: Unit = unit("deg", QuantityKind::Angle, PI / 180.0);

/// All, as they are told.
pub const UNITS: [Unit; 9] = [
    SECOND,
    unit("ms", QuantityKind::Time, 1e-3),
    unit("us", QuantityKind::Time, 1e-6),
    MILLIMETRE,
    unit("um", QuantityKind::Length, 1e-3),
    unit("m", QuantityKind::Length, 1e3),
    unit("inch", QuantityKind::Length, 25.4),
    DEGREE,
    unit("rad", QuantityKind::Angle, 1.0),
];

/// Other names of them. The micro sign and the Greek letter are two characters.
const OTHERS: [(&str, &str); 9] = [
    ("sec", "s"),
    ("µs", "us"),
    ("μs", "us"),
    ("µm", "um"),
    ("μm", "um"),
    ("in", "inch"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("°", "deg"),
];

/// The unit of that name.
pub fn named(name: &str) -> Option<Unit> {
    let name = name.trim().to_lowercase();
    let other = OTHERS.iter().find(|(other, _)| *other == name);
    let name = other.map_or(name.as_str(), |(_, known)| known);
    UNITS.iter().find(|unit| unit.name == name).copied()
}

/// What the command line says of a log's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LogUnits([Option<Unit>; 3]);

impl LogUnits {
    /// That of a kind.
    pub fn of(&self, kind: QuantityKind) -> Option<Unit> {
        self.0[kind as usize]
    }
}

/// `ms,um,deg`: any of them, in any order.
pub fn log_units(text: &str) -> Result<LogUnits, String> {
    let mut units = LogUnits::default();
    for word in text.split(',').map(str::trim) {
        let Some(unit) = named(word) else {
            return Err(format!(
                "`{word}` is no unit of a log: s, ms, us; mm, um, m, inch; deg, rad"
            ));
        };
        if units.0[unit.kind as usize].replace(unit).is_some() {
            return Err(format!("`{word}` is a second unit of its kind"));
        }
    }
    Ok(units)
}
