//! The interpolated path: where the tip goes between the ends of the blocks, and how far that is off the path of the CL
//! file.

use nalgebra::Vector3;
use post_machine::description::Machine;

use super::block_rows::{decimals, packed};
use super::page_table::PageTable;
use super::parts::Parts;
use crate::columns::Column;
use crate::failure::Failure;

/// A place of the path.
struct PathRow {
    /// The row of its block.
    block: u64,
    /// Where it is, and how far off the CL path, as they are packed, mm.
    left: Vector3<f64>,
    off: Vector3<f64>,
    /// It is held against the CL path.
    held: bool,
}

/// Packs the places of the path.
pub struct PathRows {
    table: PageTable<PathRow>,
    /// The end of the last block, as packed.
    last: Option<Vector3<f64>>,
}

impl PathRows {
    /// For a machine.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new(machine: &Machine) -> Result<Self, Failure> {
        // A tenth of the decimals of the bounds: vectors are looked at.
        let off = decimals(machine.accuracy.tolerance) - 1;
        let columns = vec![
            Column::new("row", "", 0, |row: &PathRow| row.block),
            Column::new("x", "mm", 4, |row: &PathRow| row.left.x).from("tip"),
            Column::new("y", "mm", 4, |row: &PathRow| row.left.y).from("tip"),
            Column::new("z", "mm", 4, |row: &PathRow| row.left.z).from("tip"),
            Column::new("d.x", "mm", off, |row: &PathRow| row.off.x).from("tip"),
            Column::new("d.y", "mm", off, |row: &PathRow| row.off.y).from("tip"),
            Column::new("d.z", "mm", off, |row: &PathRow| row.off.z).from("tip"),
            Column::new("held", "", 0, |row: &PathRow| row.held),
        ];
        Ok(Self { table: PageTable::new("path", columns)?, last: None })
    }

    /// Places of block `row`, in order, the last its end at `tip` (as packed), and how far each is off the CL path, if that
    /// is known. Where the page has a `middle` by the chain, a single place on the way is told against it.
    pub fn block(
        &mut self,
        row: u64,
        tip: Vector3<f64>,
        middle: Option<Vector3<f64>>,
        places: &[(Vector3<f64>, Option<Vector3<f64>>)],
    ) {
        let from = self.last.replace(tip);
        // The first block comes from nowhere.
        let single = from.is_some() && places.len() == 2;
        let from = from.unwrap_or(tip);
        let step = tip - from;
        let count = places.len() as f64;
        for (place, (at, off)) in places.iter().enumerate() {
            let share = (place + 1) as f64 / count;
            let on_the_way = single && place == 0;
            let known = middle.filter(|_| on_the_way).unwrap_or(from + step * share);
            let left = at - known;
            let held = off.is_some();
            let off = off.map_or_else(Vector3::zeros, |off| match on_the_way {
                true => off - bow(known + left.map(packed), from, step),
                false => off,
            });
            self.table.row(&PathRow { block: row, left, off, held });
        }
    }

    /// The table goes to `parts`.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(self, parts: &mut Parts) -> Result<(), Failure> {
        self.table.finish(parts)
    }
}

/// How far a place is off the straight way from a point by a step.
fn bow(place: Vector3<f64>, from: Vector3<f64>, step: Vector3<f64>) -> Vector3<f64> {
    let bow = place - from - step * 0.5;
    let square = step.norm_squared();
    let share = bow.dot(&step) / if square == 0.0 { 1.0 } else { square };
    bow - step * share
}
