//! How near any two bodies come on each line of the program and what it cuts, and what is known of each pair.

use post_report::meta::{ClearanceMeta, ClearancePairMeta, Meta};

use super::page_table::PageTable;
use super::parts::Parts;
use crate::clearance::{ClearanceSummary, Heard, LineRow};
use crate::failure::Failure;

/// Packs a row of each line.
pub struct ClearanceRows {
    table: PageTable<LineRow>,
    last: LineRow,
}

impl ClearanceRows {
    /// No line yet; `cuts`: of a stock that is cut.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new(cuts: bool) -> Result<Self, Failure> {
        let table = PageTable::new("clearance", LineRow::short_columns(cuts))?;
        Ok(Self { table, last: LineRow::default() })
    }

    /// Hears of a motion.
    pub fn hear(&mut self, heard: &Heard) {
        if let Some(row) = self.last.hear(heard) {
            self.table.row(&row);
        }
    }

    /// All was heard: the table goes to `parts`, and what was proven with the distance to keep, mm, to `meta`.
    ///
    /// # Errors
    /// It could not be kept.
    pub fn finish(
        mut self,
        proven: &ClearanceSummary,
        keep: f64,
        parts: &mut Parts,
        meta: &mut Meta,
    ) -> Result<(), Failure> {
        if self.last.is_told() {
            self.table.row(&self.last);
        }
        let pairs = proven.pairs.iter().map(|pair| ClearancePairMeta {
            bodies: pair.bodies.clone(),
            clear_by: pair.clear_by_mm,
            nearest: pair.nearest_mm,
            nc: pair.nearest_line,
            not_clear: pair.not_clear,
        });
        let mut pairs: Vec<_> = pairs.collect();
        let distance = |pair: &ClearancePairMeta| pair.nearest.unwrap_or(f64::INFINITY);
        pairs.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
        meta.clearance = Some(ClearanceMeta { keep, pairs });
        self.table.finish(parts)
    }
}
