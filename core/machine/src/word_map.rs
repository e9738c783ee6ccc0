//! Words that are no axis values: each is a sum of multiples of axis values, such as a diameter or the angle of an arm
//! against the horizontal.

use nalgebra::SMatrix;

use crate::kinematics::{Joints, MAX_AXES};

type Matrix = SMatrix<f64, MAX_AXES, MAX_AXES>;

/// Multiples that differ from one by less are one.
const SAME: f64 = 1e-12;

/// What words make of axis values, by the places of the axes in the chain: the word of an axis stands at its place.
#[derive(Clone, Debug, PartialEq)]
pub struct WordMap {
    rows: Matrix,
    inverse: Matrix,
}

impl WordMap {
    /// The map of `rows`: what each axis is multiplied by in the word at each place. None where words do not tell the axis
    /// values.
    pub(crate) fn new(rows: [Joints; MAX_AXES]) -> Option<Self> {
        let rows = Matrix::from_fn(|word, joint| rows[word][joint]);
        let inverse = rows.try_inverse()?;
        let sound = (rows * inverse - Matrix::identity()).amax() < 1e-9;
        sound.then_some(Self { rows, inverse })
    }

    /// The map of words that are multiples of their own axes, by their places in the chain; none where all are one.
    pub(crate) fn multiples(factors: Joints) -> Option<Self> {
        let mut rows = [Joints::default(); MAX_AXES];
        for (place, row) in rows.iter_mut().enumerate() {
            row[place] = factors[place];
        }
        Self::new(rows).filter(|_| factors.iter().any(|factor| *factor != 1.0))
    }

    /// Words of axis values.
    pub fn words(&self, values: &Joints) -> Joints {
        (self.rows * nalgebra::SVector::from(*values)).into()
    }

    /// Axis values of words.
    pub fn values(&self, words: &Joints) -> Joints {
        (self.inverse * nalgebra::SVector::from(*words)).into()
    }

    /// What the word at `place` multiplies its own axis by.
    pub fn factor(&self, place: usize) -> f64 {
        self.rows[(place, place)]
    }

    /// The word at `place` is its axis value.
    pub fn is_plain(&self, place: usize) -> bool {
        libm::fabs(self.factor(place) - 1.0) < SAME && !self.is_coupled(place)
    }

    /// The word at `place` holds another axis, or its axis stands in another word.
    pub fn is_coupled(&self, place: usize) -> bool {
        let others = (0..MAX_AXES).filter(|other| *other != place);
        others
            .into_iter()
            .any(|other| self.rows[(place, other)] != 0.0 || self.rows[(other, place)] != 0.0)
    }

    /// Some word holds more than one axis.
    pub fn couples(&self) -> bool {
        (0..MAX_AXES).any(|place| self.is_coupled(place))
    }

    /// The words at these places change with the axis at `joint`.
    pub fn moved_by(&self, joint: usize) -> impl Iterator<Item = usize> {
        (0..MAX_AXES).filter(move |place| self.rows[(*place, joint)] != 0.0)
    }

    /// How far rounding takes an axis, `halves` being what it takes each word.
    pub fn rounded(&self, joint: usize, halves: &Joints) -> f64 {
        (0..MAX_AXES).map(|word| libm::fabs(self.inverse[(joint, word)]) * halves[word]).sum()
    }
}
