//! The table of what was proven.

use super::ClearanceFound;
use crate::text::{at_least, number};
use crate::text_table::{NamedValues, TextTable};

/// What was proven, as lines.
pub fn text(found: &ClearanceFound) -> String {
    let mut rows = NamedValues::default();
    rows.row("motions", found.motions);
    rows.row("pairs of bodies", found.pairs.len());
    rows.row("distances computed", found.distances);
    if !found.lacks.is_empty() {
        rows.row("without a body, not looked at", found.lacks.join(", "));
    }
    let mut text = rows.table();
    if found.pairs.is_empty() {
        return text;
    }
    let mut table =
        TextTable::headed(2, ["", "", "clear by, mm", "nearest, mm", "line", "not clear"]);
    for row in &found.pairs {
        let distance = |value: f64, text: fn(f64, u8) -> String| match value.is_finite() {
            true => text(value, 3),
            false => "-".to_owned(),
        };
        let line = if row.nearest.1 > 0 { row.nearest.1.to_string() } else { "-".to_owned() };
        let faults = if row.faults > 0 { row.faults.to_string() } else { "-".to_owned() };
        let [one, other] = row.names.clone();
        let clear = distance(row.clear_by, at_least);
        let nearest = distance(row.nearest.0, number);
        table.row([one, other, clear, nearest, line, faults]);
    }
    text.push('\n');
    text.push_str(&table.text());
    text
}
