//! How near any two bodies come on each line of the program, and what is known of each pair.

use post_report::meta::{ClearanceMeta, ClearancePairMeta, Meta};

use super::page_table::PageTable;
use super::parts::Parts;
use crate::clearance::ClearanceSummary;
use crate::columns::Column;
use crate::failure::Failure;

/// Decimals of a distance, mm.
const DECIMALS: u8 = 3;

/// A line of the program that moves.
struct LineClearance {
    line: u64,
    /// No two bodies are nearer, mm.
    clear_by: f64,
}

/// Packs a row of each line.
pub struct ClearanceRows {
    table: PageTable<LineClearance>,
    last: Option<LineClearance>,
}

impl ClearanceRows {
    /// No line yet.
    ///
    /// # Errors
    /// There is no place for them.
    pub fn new() -> Result<Self, Failure> {
        let columns = vec![
            Column::new("nc", "", 0, |row: &LineClearance| row.line),
            Column::new("clearance", "mm", DECIMALS, |row: &LineClearance| rounded(row.clear_by)),
        ];
        Ok(Self { table: PageTable::new("clearance", columns)?, last: None })
    }

    /// On a motion of `line` no two bodies are nearer than this, mm; of several on a line the least counts.
    pub fn hear(&mut self, line: u64, clear_by: f64) {
        match &mut self.last {
            Some(last) if last.line == line => last.clear_by = last.clear_by.min(clear_by),
            last => {
                if let Some(done) = last.replace(LineClearance { line, clear_by }) {
                    self.table.row(&done);
                }
            }
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
        if let Some(last) = &self.last {
            self.table.row(last);
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

/// Rounded down as it is packed: no more is told than is proven.
fn rounded(distance: f64) -> f64 {
    libm::floor(distance * 1e3 + 1e-3) / 1e3
}
