//! How a tool lies to the axis that draws it back.

use nalgebra::Vector3;

/// A tool that is measured, and not drawn, leans by less: the sine of 0.1 degrees.
const MEASURED: f64 = 1.8e-3;

/// A tool lies across an axis where the cosine of the angle between them is less: such an axis wins it nothing.
const LYING: f64 = 0.01;

/// The lie of a tool, or of the normal of a plane, to the way of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ToolAlignment {
    /// The axis moves it along its own line.
    Along,
    /// The axis moves it along its line, and aside.
    Aslant,
    /// The axis moves it aside alone.
    Across,
}

impl ToolAlignment {
    /// Compares a direction with the way of an axis, both unit vectors.
    pub(super) fn of(direction: &Vector3<f64>, way: &Vector3<f64>) -> Self {
        if way.cross(direction).norm() <= MEASURED {
            Self::Along
        } else if libm::fabs(way.dot(direction)) <= LYING {
            Self::Across
        } else {
            Self::Aslant
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tool_lies_along_aslant_or_across() {
        let way = Vector3::z();
        for (degrees, wanted) in [
            (0.0, ToolAlignment::Along),
            (0.05, ToolAlignment::Along),
            (179.95, ToolAlignment::Along),
            (0.2, ToolAlignment::Aslant),
            (45.0, ToolAlignment::Aslant),
            (89.0, ToolAlignment::Aslant),
            (89.9, ToolAlignment::Across),
            (90.3, ToolAlignment::Across),
            (135.0, ToolAlignment::Aslant),
        ] {
            let (sine, cosine) = libm::sincos(f64::to_radians(degrees));
            let tool = Vector3::new(0.6 * sine, 0.8 * sine, cosine);
            assert_eq!(ToolAlignment::of(&tool, &way), wanted, "{degrees}");
        }
    }
}
