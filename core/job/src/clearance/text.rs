//! The table of what was proven.

use super::{ClearanceFound, Farthest, LongestAt, StockLeft, ToolCut};
use crate::text::{at_least, number};
use crate::text_table::{NamedValues, TextTable};

/// What each tool takes of the stock.
fn cut_table(cuts: &[ToolCut]) -> TextTable {
    let mut table = TextTable::headed(
        1,
        ["", "cut, mm³", "no deeper than, mm", "line", "no wider than, mm", "line"],
    );
    for ToolCut { tool, volume, depth, width } in cuts {
        let taken = format!("{} to {}", number(volume.at_least, 0), number(volume.at_most, 0));
        let longest = |LongestAt { at_most, line }: &LongestAt| match *line > 0 {
            true => [number(*at_most, 3), line.to_string()],
            false => ["-".to_owned(), "-".to_owned()],
        };
        let [deep, deepest] = longest(depth);
        let [wide, widest] = longest(width);
        table.row([format!("tool {tool}"), taken, deep, deepest, wide, widest]);
    }
    table
}

/// What was proven, as lines.
pub fn text(found: &ClearanceFound) -> String {
    let mut rows = NamedValues::default();
    rows.row("motions", found.motions);
    rows.row("pairs of bodies", found.pairs.len());
    rows.row("distances computed", found.distances);
    if let Some(StockLeft { before, left, cell, part, .. }) = &found.left {
        let between = |low: f64, high: f64| format!("{} to {}", number(low, 0), number(high, 0));
        rows.row("stock left, mm³", between(left.at_least, left.at_most));
        let cut = [before.at_least - left.at_most, before.at_most - left.at_least];
        rows.row("cut of it, mm³", between(cut[0].max(0.0), cut[1]));
        rows.row("known to within, mm", number(cell.max(), 3));
        if let Some(part) = part {
            let far = |far: &Farthest| {
                let range = format!("{} to {}", number(far.at_least, 3), number(far.at_most, 3));
                let [x, y, z]: [f64; 3] = far.point.into();
                match far.at_least > 0.0 {
                    true => format!("{range}, at [{x:.3}, {y:.3}, {z:.3}]"),
                    false => range,
                }
            };
            rows.row("cut into the part, mm³", between(part.gouge.at_least, part.gouge.at_most));
            rows.row("as deep as, mm", far(&part.deepest));
            rows.row("left on the part, mm³", between(part.rest.at_least, part.rest.at_most));
            rows.row("as thick as, mm", far(&part.thickest));
        }
    }
    if !found.lacks.is_empty() {
        rows.row("without a body, not looked at", found.lacks.join(", "));
    }
    let mut text = rows.table();
    if let Some(cuts) = found.left.as_ref().map(|left| &left.cuts).filter(|cuts| !cuts.is_empty()) {
        text.push('\n');
        text.push_str(&cut_table(cuts).text());
    }
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
