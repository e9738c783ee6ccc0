//! Why a pose cannot be reached, or a chain not be solved.

/// Where the wanted axis lies closer to k1 than this, k1 turns the tool axis by nothing that a CL file
/// with seven decimals could mean, and its angle is free: radians.
pub const POLE: f64 = 1e-6;

/// Why a pose cannot be reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unreachable {
    /// No rotary angles give the tool axis; the nearest orientation misses by this angle.
    Axis {
        /// Radians.
        miss: f64,
    },
    /// The linear axes span no volume at these angles.
    Linear,
    /// A numeric search found nothing; the nearest pose misses the tip by this.
    Numeric {
        /// mm, an error of the tool axis counted on an arm of 300 mm.
        miss: f64,
    },
}

/// What a chain lacks for being solved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoClosedForm {
    /// Not three linear axes that place the tip.
    LinearAxes {
        /// How many there are.
        count: usize,
    },
    /// The three linear directions lie in one plane.
    FlatLinearAxes,
    /// More free rotary axes than the tool needs.
    RotaryAxes {
        /// Their places in the chain.
        joints: Vec<usize>,
    },
    /// Two free rotary axes are parallel.
    Parallel {
        /// Their places in the chain.
        joints: [usize; 2],
    },
}
