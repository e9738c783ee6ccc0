//! Runs of plain `GOTO` records, as arrays.

use std::ops::Range;

/// A run of plain `GOTO/x,y,z[,i,j,k]` records, one a line, filled by [`Reader::next_points`](crate::Reader::next_points).
///
/// All arrays have the same length; numbers are as the file has them.
#[derive(Clone, Debug, Default)]
pub struct Points {
    /// Line of the file on which the first record stands, counted from 1; the others follow it line by line.
    pub first_line: u64,
    /// X of the points.
    pub x: Vec<f64>,
    /// Y of the points.
    pub y: Vec<f64>,
    /// Z of the points.
    pub z: Vec<f64>,
    /// X of the tool axes; 0 where the record gives none.
    pub i: Vec<f64>,
    /// Y of the tool axes; 0 where the record gives none.
    pub j: Vec<f64>,
    /// Z of the tool axes; 0 where the record gives none.
    pub k: Vec<f64>,
    /// The record gives a tool axis.
    pub has_axis: Vec<bool>,
    /// Where the records' texts stand, for [`Reader::text`](crate::Reader::text).
    pub text: Vec<Range<usize>>,
}

impl Points {
    /// How many they are.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// There are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    pub(super) fn clear(&mut self, most: usize) {
        for values in self.values() {
            values.clear();
            values.reserve(most);
        }
        self.has_axis.clear();
        self.has_axis.reserve(most);
        self.text.clear();
        self.text.reserve(most);
    }

    #[inline(always)]
    pub(super) fn push(&mut self, point: [f64; 6], has_axis: bool, text: Range<usize>) {
        for (values, value) in self.values().into_iter().zip(point) {
            values.push(value);
        }
        self.has_axis.push(has_axis);
        self.text.push(text);
    }

    #[inline(always)]
    fn values(&mut self) -> [&mut Vec<f64>; 6] {
        [
            &mut self.x,
            &mut self.y,
            &mut self.z,
            &mut self.i,
            &mut self.j,
            &mut self.k,
        ]
    }
}
