//! A word that is a multiple of the way of the tip in cuts: what an extruder pushes out along it.

use post_plugin::Format;

use crate::axis_words::unit_length;
use crate::description::Machine;

/// A word of the program that goes with the way of the tip, beside those of the axes.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongWord {
    /// Its letter.
    pub name: String,
    /// Units of the word for one unit of the way: mm for a mm.
    pub per_way: f64,
}

/// How the word is written: its place among those of a block is behind all axes.
#[derive(Clone, Copy, Debug)]
pub struct AlongPrinter {
    place: usize,
    /// Units of the word for one mm of the way.
    per_mm: f64,
    /// Ten to the number of decimals.
    scale: f64,
}

impl AlongPrinter {
    /// Of a machine whose dialect prints as `format` says; none without such a word.
    pub fn new(machine: &Machine, format: &Format) -> Option<Self> {
        let word = machine.along.as_ref()?;
        let place = machine.axes.len();
        let decimals = *format.words.get(place)?;
        Some(Self {
            place,
            per_mm: word.per_way / unit_length(machine.control.units),
            scale: (0..decimals).fold(1.0, |scale, _| scale * 10.0),
        })
    }

    /// Puts the word after `way` mm of cuts in all to `values`.
    pub fn print(&self, way: f64, values: &mut [f64]) {
        if let Some(value) = values.get_mut(self.place) {
            *value = libm::rint(way * self.per_mm * self.scale) / self.scale + 0.0;
        }
    }
}
