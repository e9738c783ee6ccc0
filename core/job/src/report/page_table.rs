//! A table of the page, packed row by row.

use post_report::table;

use super::parts::{Parts, fault};
use crate::columns::Column;
use crate::failure::Failure;
use crate::files::Scratch;

/// Takes rows; the first fault of packing them is told at the end.
pub struct PageTable<R> {
    columns: Vec<Column<R>>,
    packed: table::TableWriter<Scratch>,
    values: Vec<f64>,
    fault: Option<Failure>,
}

impl<R> PageTable<R> {
    /// An empty table, which the page knows by its name.
    ///
    /// # Errors
    /// There is no place for it.
    pub fn new(name: &'static str, columns: Vec<Column<R>>) -> Result<Self, Failure> {
        let heads = columns.iter().map(|column| table::TableColumn {
            name: column.name.clone().into_owned(),
            unit: column.unit,
            decimals: column.decimals,
            from: column.from,
        });
        Ok(Self {
            packed: table::TableWriter::new(name, heads.collect(), Parts::scratch()?),
            values: Vec::with_capacity(columns.len()),
            columns,
            fault: None,
        })
    }

    /// Rows so far.
    pub fn rows(&self) -> u64 {
        self.packed.rows()
    }

    /// Takes the next row; false if it cannot be kept.
    pub fn row(&mut self, row: &R) -> bool {
        self.values.clear();
        self.values.extend(self.columns.iter().map(|column| column.number(row).unwrap_or(0.0)));
        let kept = self.packed.row(&self.values);
        let is_kept = kept.is_ok();
        if let Err(error) = kept {
            self.fault.get_or_insert(fault(error));
        }
        is_kept
    }

    /// The table goes to `parts`.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(self, parts: &mut Parts) -> Result<(), Failure> {
        match self.fault {
            Some(fault) => Err(fault),
            None => parts.table(self.packed),
        }
    }
}
