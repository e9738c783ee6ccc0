//! Along which axis a control puts the length of a tool.

use nalgebra::Vector3;
use toml::Spanned;

use super::build::Builder;
use super::keys::axes_are;
use super::{Axis, Machine};
use crate::axis_words;
use crate::kinematics::Joints;

/// The axis along which the control puts the tool's length where the words are axis positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthAxis {
    /// The one that the dialect takes.
    #[default]
    Dialect,
    /// The one of this place in the chain; the machine file answers for it.
    Said(usize),
    /// None: the length that the control has for the tool is 0, and the work offset was measured with the tool in it.
    None,
}

/// Axes whose ways differ by less lie beside one another, mm of a mm.
const SAME: f64 = 1e-6;

/// A tool leans by less than this where its axis was measured, and not drawn: 0.1 degrees, in mm of a mm of length.
const MEASURED: f64 = 1.8e-3;

impl Machine {
    /// The linear axis along which the tool lies where the rotary axes show zero: with the tool longer by so much, this axis
    /// alone may move by as much to keep the tip on its place; of several beside one another the one of the depth. With how
    /// far the tip of a tool misses that, mm of a mm of its length: what was measured is never quite so. None of a tool
    /// that leans, or points the other way.
    pub fn lies_along(&self) -> Option<(usize, f64)> {
        let [short, long] = [self.zero_of(0.0)?, self.zero_of(1.0)?];
        let solver = self.solver(0.0).ok()?;
        let linear = (0..self.axes.len()).filter(|place| !self.axes[*place].joint.rotary);
        let ways = linear.map(|place| (place, solver.chain().way_of(place, &short)));
        let by: Vector3<f64> =
            ways.clone().map(|(place, way)| way * (long[place] - short[place])).sum();
        let misses = ways.map(|(place, way)| (place, (by - way).norm()));
        let depth = axis_words::depth(self);
        let (along, miss) = misses.reduce(|best, next| {
            let nearer = next.1 - best.1;
            let as_near = libm::fabs(nearer) < SAME && Some(next.0) == depth;
            if nearer < -SAME || as_near { next } else { best }
        })?;
        (miss < MEASURED).then_some((along, miss))
    }

    /// Where the axes stand where words that are axis positions are zero, with a tool of `length` mm in the spindle: what the
    /// control has `put_on`, mm (its length; nothing as long as that is not called; that of the tool before until another
    /// is), is put on along the axis of `place`, and the work offset is one all the while. Where the tool lies along that axis
    /// but for what a measurement leaves, the offset was measured with this very tool, as the writer counts and its warning
    /// asks; where it does not, with the gauge point. Without a `place` nothing is put on, ever: measured with the tool. None
    /// if the linear axes do not bring it there.
    pub fn counted_from(&self, length: f64, put_on: f64, place: Option<usize>) -> Option<Joints> {
        let Some(place) = place else {
            return self.zero_of(length);
        };
        let direction = |place: usize| self.axes[place].joint.direction;
        let beside =
            |along: usize| along == place || direction(along).dot(&direction(place)) > 1.0 - SAME;
        let (measured, along) = match self.lies_along().filter(|(along, _)| beside(*along)) {
            Some((along, _)) => (length, along),
            None => (0.0, place),
        };
        let mut zero = self.zero_of(measured)?;
        zero[along] += put_on - measured;
        Some(zero)
    }

    /// Where the axes stand with the tip of a tool of `length` mm on the part origin and the rotary ones showing zero;
    /// none if the linear ones do not bring it there.
    pub fn zero_of(&self, length: f64) -> Option<Joints> {
        let solver = self.solver(length).ok()?;
        let mut zero = Joints::default();
        for (joint, axis) in zero.iter_mut().zip(&self.axes) {
            if axis.joint.rotary {
                *joint = -axis.zero;
            }
        }
        let turns = solver.chain().turns(&zero);
        solver.place_zero(&mut zero, &turns).ok()?;
        Some(zero)
    }
}

impl Builder<'_> {
    /// Takes `[tool] length_axis`.
    pub(super) fn length_axis(
        &mut self,
        said: Option<&Spanned<String>>,
        axes: &[Axis],
    ) -> LengthAxis {
        let Some(said) = said else {
            return LengthAxis::Dialect;
        };
        let name = said.get_ref();
        if name == "none" {
            return LengthAxis::None;
        }
        let place = axes.iter().position(|axis| axis.name == *name);
        match place.filter(|place| !axes[*place].joint.rotary) {
            Some(place) => LengthAxis::Said(place),
            None => {
                let message = format!("the machine has no linear axis {name}");
                let help =
                    &format!("{}; \"none\" where the control puts on no length", axes_are(axes));
                self.fault("machine-axis", said.span(), message, help);
                LengthAxis::Dialect
            }
        }
    }
}
