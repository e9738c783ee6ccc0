//! The interpolated path: where the tip goes between the ends of the blocks, and how far that is off the path of the CL
//! file.

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_report::table::{Column, TableWriter};

use super::block_rows::decimals;
use super::parts::{Parts, fault};
use crate::failure::Failure;
use crate::files::Scratch;

/// Packs the places of the path.
pub struct PathRows {
    table: TableWriter<Scratch>,
    fault: Option<Failure>,
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
            Column::new("row", "", 0),
            Column::new("x", "mm", 4),
            Column::new("y", "mm", 4),
            Column::new("z", "mm", 4),
            Column::new("d.x", "mm", off),
            Column::new("d.y", "mm", off),
            Column::new("d.z", "mm", off),
            Column::new("held", "", 0),
        ];
        Ok(Self {
            table: TableWriter::new("path", columns, Parts::scratch()?),
            fault: None,
        })
    }

    /// A place within block `row` or at its end, and how far it is off the CL path, if that is known.
    pub fn place(&mut self, row: u64, tip: Vector3<f64>, off: Option<Vector3<f64>>) {
        let held = f64::from(u8::from(off.is_some()));
        let off = off.unwrap_or_default();
        let row = [row as f64, tip.x, tip.y, tip.z, off.x, off.y, off.z, held];
        if let Err(error) = self.table.row(&row) {
            self.fault.get_or_insert(fault(error));
        }
    }

    /// The table goes to `parts`.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(self, parts: &mut Parts) -> Result<(), Failure> {
        match self.fault {
            Some(fault) => Err(fault),
            None => parts.table(self.table),
        }
    }
}
