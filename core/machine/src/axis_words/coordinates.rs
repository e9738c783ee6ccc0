//! Linear words as points: the frame in which a control that is told of X, Y and Z lays arcs and splines.

use nalgebra::Vector3;

use super::{AxisWords, Word, WordValues};
use crate::description::Tcp;
use crate::kinematics::Joints;

impl AxisWords {
    /// The linear words in the order X, Y, Z; none where they are others, fewer or more.
    fn cartesian(&self) -> Option<&[Word; 3]> {
        let words = self.linear.as_slice().try_into().ok()?;
        self.cartesian.then_some(words)
    }

    /// The linear words of a place, not rounded, mm: those of the `tip` (mm, part frame) in a tilted plane and where the
    /// control keeps it, else those of the axis values `joints`. None where the linear words are not X, Y and Z.
    pub fn place(&self, tip: Vector3<f64>, joints: &Joints) -> Option<Vector3<f64>> {
        let words = self.cartesian()?;
        Some(match (&self.plane, self.tcp) {
            (Some(plane), _) => plane.into_plane(tip),
            (None, Tcp::Control) => tip,
            (None, Tcp::Post) => Vector3::from_fn(|row, _| {
                let joint = words[row].joint;
                joints[joint] - self.zero[joint]
            }),
        })
    }

    /// The linear words of a block as a point, mm.
    pub fn point(&self, values: &WordValues) -> Option<Vector3<f64>> {
        let words = self.cartesian()?;
        Some(Vector3::from_fn(|row, _| values[words[row].place] * words[row].unit))
    }

    /// The printed point nearest to `point` (mm), in program units and in mm.
    pub fn printed_point(&self, point: Vector3<f64>) -> Option<([f64; 3], Vector3<f64>)> {
        let words = self.cartesian()?;
        let printed = [0, 1, 2].map(|row| words[row].printed(point[row] * words[row].per_unit));
        let mm = Vector3::from_fn(|row, _| printed[row] * words[row].unit);
        Some((printed, mm))
    }

    /// The number nearest to `number` that has no more decimals than any linear word.
    pub fn printed_number(&self, number: f64) -> Option<f64> {
        let words = self.cartesian()?.iter();
        let coarsest = words.min_by(|a, b| a.scale.total_cmp(&b.scale))?;
        Some(coarsest.printed(number))
    }

    /// The words of `values` with their linear ones as in `point`, program units.
    pub fn with_point(&self, values: &WordValues, point: [f64; 3]) -> WordValues {
        let mut values = *values;
        for (word, value) in self.cartesian().into_iter().flatten().zip(point) {
            values[word.place] = value;
        }
        values
    }

    /// Do the rotary axes of `rotary`, put on printed numbers, stand as those of `at`, which are printed?
    pub fn stand(&self, rotary: &Joints, at: &Joints) -> bool {
        let mut joints = *rotary;
        self.print_rotary(&mut joints, &mut WordValues::default());
        let mut words = self.rotary.iter();
        words.all(|word| joints[word.joint] == at[word.joint])
    }
}
