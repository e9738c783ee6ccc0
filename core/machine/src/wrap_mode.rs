//! Cylinder interpolation by the control: while it is in force the word of the axis that turns the part belongs to the mantle
//! of a cylinder (G7.1, TRACYL), and a feed counts along that.
//!
//! The axes go as they do outside, all of them linearly: only what the word of the turning axis and F mean is another thing.

use crate::kinematics::{Joints, MAX_AXES};

/// A mode of the control for the mantle of the part.
#[derive(Clone, Debug, PartialEq)]
pub struct WrapMode {
    /// Lines of the program that begin it.
    pub on: Vec<String>,
    /// Lines of the program that end it.
    pub off: Vec<String>,
    /// The letter behind which the word of the turning axis stands in it.
    pub letter: String,
    /// That word is a length along the cylinder; else an angle.
    pub lengths: bool,
    /// Radius of the cylinder, mm.
    pub radius: f64,
    /// Place in the chain of the axis that turns the part.
    pub turning: usize,
}

impl WrapMode {
    /// The way along which F counts between axis values, mm: all other axes are linear.
    pub fn way(&self, from: &Joints, to: &Joints) -> f64 {
        let along = |place: usize| match place == self.turning {
            true => (to[place] - from[place]) * self.radius,
            false => to[place] - from[place],
        };
        libm::sqrt((0..MAX_AXES).map(|place| along(place) * along(place)).sum())
    }
}
