//! The linear equations of a fit: data pulls, the third derivative resists.

use super::basis::{BasisRow, ORDER};
use super::track::SplineSpan;
use crate::interior::band::Band;

/// A place where data pulls.
pub(super) struct Pull<'a, const W: usize> {
    pub(super) span: usize,
    pub(super) row: &'a BasisRow,
    pub(super) weight: f64,
    /// The reference spline minus the data.
    pub(super) error: [f64; W],
}

/// The equations of some coordinates for what is added to the control points of the reference.
#[derive(Debug, Default)]
pub(super) struct Equations<const W: usize> {
    /// Matrix of the data alone.
    data: Band<ORDER>,
    pulls: Vec<[f64; W]>,
    band: Band<ORDER>,
    sides: Vec<[f64; W]>,
}

impl<const W: usize> Equations<W> {
    /// The part of the data, for `count` control points.
    pub(super) fn weigh<'a>(&mut self, count: usize, all: impl Iterator<Item = Pull<'a, W>>) {
        self.data.reset(count);
        self.pulls.clear();
        self.pulls.resize(count, [0.0; W]);
        for pull in all.filter(|pull| pull.weight > 0.0) {
            let rows = self.data.rows[pull.span..].iter_mut();
            let sides = self.pulls[pull.span..].iter_mut();
            for (index, (row, side)) in rows.zip(sides).take(ORDER).enumerate() {
                let share = pull.weight * pull.row[index];
                for (entry, value) in row.iter_mut().zip(&pull.row[index..]) {
                    *entry += share * value;
                }
                for (side, error) in side.iter_mut().zip(pull.error) {
                    *side -= share * error;
                }
            }
        }
    }

    /// Solves, with smoothing over these lengths; `held` control points at the start, and at the end, stay.
    pub(super) fn solve(
        &mut self,
        spans: &[SplineSpan],
        forces: &[[[f64; W]; ORDER]],
        lengths: &[f64],
        held: [usize; 2],
        deltas: &mut [[f64; W]],
    ) {
        self.band.rows.clone_from(&self.data.rows);
        self.sides.clone_from(&self.pulls);
        for (start, ((span, force), length)) in spans.iter().zip(forces).zip(lengths).enumerate() {
            let cube = length * length * length;
            let weight = cube * cube;
            let rows = self.band.rows[start..].iter_mut();
            let sides = self.sides[start..].iter_mut();
            for ((row, side), (gram, force)) in rows.zip(sides).zip(span.gram.iter().zip(force)) {
                for (entry, value) in row.iter_mut().zip(gram) {
                    *entry += weight * value;
                }
                for (side, force) in side.iter_mut().zip(force) {
                    *side -= weight * force;
                }
            }
        }
        let count = deltas.len();
        for index in (0..held[0]).chain(count - held[1]..count) {
            self.hold(index, deltas[index]);
        }
        self.band.factor();
        self.band.solve_each(&mut self.sides);
        deltas.copy_from_slice(&self.sides);
    }

    /// Takes a control point that is known out of the equations.
    fn hold(&mut self, index: usize, delta: [f64; W]) {
        let count = self.sides.len();
        for step in 1..ORDER {
            let later = (index + step < count).then(|| (index, index + step));
            let earlier = index.checked_sub(step).map(|row| (row, row));
            for (row, other) in later.into_iter().chain(earlier) {
                let entry = std::mem::take(&mut self.band.rows[row][step]);
                for (side, delta) in self.sides[other].iter_mut().zip(delta) {
                    *side -= entry * delta;
                }
            }
        }
        self.band.rows[index] = [0.0; ORDER];
        self.band.rows[index][0] = 1.0;
        self.sides[index] = delta;
    }
}
