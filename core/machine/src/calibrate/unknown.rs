//! Numbers of a machine file that readings are to tell.

use nalgebra::Vector3;

use crate::description::{Axis, Machine, Setting};

/// Half of the distance over which a derivative is taken: mm, or a slope.
const STEP: f64 = 1e-4;

/// A line of an axis: one of the two things that say where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CalibratedLine {
    /// `point` of a rotary axis.
    Point,
    /// `rotary` or `linear`.
    Direction,
}

/// Something of a machine that is not known well.
#[derive(Clone, Debug, PartialEq)]
pub enum Unknown {
    /// A parameter of the machine file.
    Parameter {
        /// Its name.
        name: String,
        /// What the file says.
        value: f64,
    },
    /// The place or the direction of an axis' line: of three numbers the two that are not along it.
    Line {
        /// The key, `axis.C.point`.
        key: String,
        /// What stands there, as the machine file counts.
        vector: Vector3<f64>,
        /// The coordinates that are looked for.
        free: [usize; 2],
    },
}

/// Names of coordinates.
const COORDINATES: [&str; 3] = ["X", "Y", "Z"];

impl Unknown {
    /// The line of an axis, as the machine has it.
    pub fn of_axis(axis: &Axis, which: CalibratedLine) -> Self {
        let direction = axis.joint.direction;
        let along = direction.iamax();
        let (key, vector) = match which {
            CalibratedLine::Point => ("point", axis.joint.point),
            // Of length one along its largest coordinate: the others are the tangents that ISO 230 gives. A reversed
            // axis is written as the file has it.
            CalibratedLine::Direction => {
                let written = if axis.reversed { -direction } else { direction };
                let key = if axis.joint.rotary { "rotary" } else { "linear" };
                (key, written / libm::fabs(direction[along]))
            }
        };
        let free = match along {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        Self::Line { key: format!("axis.{}.{key}", axis.name), vector, free }
    }

    /// What is looked for where nobody says it: the lines of all rotary axes.
    pub fn usual(machine: &Machine) -> Vec<Self> {
        let rotary = machine.axes.iter().filter(|axis| axis.joint.rotary);
        rotary
            .flat_map(|axis| {
                [CalibratedLine::Point, CalibratedLine::Direction]
                    .map(|which| Self::of_axis(axis, which))
            })
            .collect()
    }

    /// Names of its numbers.
    pub fn names(&self) -> Vec<String> {
        match self {
            Self::Parameter { name, .. } => vec![name.clone()],
            Self::Line { key, free, .. } => {
                let short = key.trim_start_matches("axis.");
                free.iter().map(|place| format!("{short} {}", COORDINATES[*place])).collect()
            }
        }
    }

    /// Its numbers as the machine file has them.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Self::Parameter { value, .. } => vec![*value],
            Self::Line { vector, free, .. } => free.iter().map(|place| vector[*place]).collect(),
        }
    }

    /// Half of the distance over which a derivative of each is taken.
    pub(super) fn steps(&self) -> Vec<f64> {
        match self {
            Self::Parameter { value, .. } => vec![STEP * libm::fabs(*value).max(1.0)],
            Self::Line { .. } => vec![STEP; 2],
        }
    }
}

/// The settings that give the machine these values.
pub(super) fn settings(unknowns: &[Unknown], values: &[f64]) -> Vec<Setting> {
    let mut rest = values.iter().copied();
    let mut next = || rest.next().unwrap_or_default();
    let setting = |unknown: &Unknown| match unknown {
        Unknown::Parameter { name, .. } => Setting::Number { name: name.clone(), value: next() },
        Unknown::Line { key, vector, free } => {
            let mut vector = *vector;
            free.iter().for_each(|place| vector[*place] = next());
            Setting::Written(format!("{key}=[{}, {}, {}]", vector.x, vector.y, vector.z))
        }
    };
    unknowns.iter().map(setting).collect()
}
