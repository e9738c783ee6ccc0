//! What is proven of a block.

/// Proven bounds on the deviation along a piece.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeviationBound {
    /// Tip, mm.
    pub tip: f64,
    /// Tool axis, radians.
    pub axis: f64,
}

impl DeviationBound {
    /// Nothing is proven.
    pub(super) const NONE: Self = Self { tip: f64::INFINITY, axis: f64::INFINITY };

    /// The smaller of two bounds on the same block.
    pub fn least(self, other: Self) -> Self {
        Self { tip: self.tip.min(other.tip), axis: self.axis.min(other.axis) }
    }

    /// What holds for both of two blocks.
    pub fn and(self, other: Self) -> Self {
        Self { tip: self.tip.max(other.tip), axis: self.axis.max(other.axis) }
    }
}
