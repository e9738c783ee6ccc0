//! The table of what was proven.

use post_removal::field::Volume;

use super::summary::between;
use super::{ClearanceFound, ClearanceSummary, CutSummary, Farthest};
use crate::text::{at_least, number};
use crate::text_table::{NamedValues, TextTable};

/// What each tool takes of each stock.
fn cut_table(cuts: &[CutSummary], stocks: usize) -> TextTable {
    let head = ["", "cut, mm³", "depth, mm", "line", "width, mm", "line", "most, mm³", "line"];
    let mut table = TextTable::headed(1, head);
    for cut in cuts {
        let longest = |range: Option<[f64; 2]>, line: Option<u64>, decimals: u8| {
            let range = range.map_or("-".to_owned(), |range| between(range, decimals));
            [range, line.map_or("-".to_owned(), |line| line.to_string())]
        };
        let [deep, deepest] = longest(cut.depth_mm, cut.depth_line, 3);
        let [wide, widest] = longest(cut.width_mm, cut.width_line, 3);
        let [most, on] = longest(cut.most_mm3, cut.most_line, 0);
        let of = if stocks > 1 { format!(", {}", cut.stock) } else { String::new() };
        let tool = format!("tool {}{of}", cut.tool);
        table.row([tool, between(cut.volume_mm3, 0), deep, deepest, wide, widest, most, on]);
    }
    table
}

/// What was proven, as lines.
pub fn text(found: &ClearanceFound) -> String {
    let mut rows = NamedValues::default();
    rows.row("motions", found.motions);
    rows.row("pairs of bodies", found.pairs.len());
    rows.row("distances computed", found.distances);
    let ClearanceSummary { stocks, cuts, .. } = found.summary();
    for (stock, left) in stocks.iter().zip(&found.left) {
        rows.row(format!("{} left, mm³", left.name), between(stock.left_mm3, 0));
        rows.row("cut of it, mm³", between(stock.cut_mm3, 0));
        rows.row("known to within, mm", number(stock.cell_mm, 3));
        if let Some(part) = &left.part {
            let volume = |volume: Volume| between([volume.at_least, volume.at_most], 0);
            let far = |far: &Farthest| {
                let range = between([far.at_least, far.at_most], 3);
                let [x, y, z]: [f64; 3] = far.point.into();
                match far.at_least > 0.0 {
                    true => format!("{range}, at [{x:.3}, {y:.3}, {z:.3}]"),
                    false => range,
                }
            };
            rows.row("cut into the part, mm³", volume(part.gouge));
            rows.row("as deep as, mm", far(&part.deepest));
            rows.row("left on the part, mm³", volume(part.rest));
            rows.row("as thick as, mm", far(&part.thickest));
        }
    }
    if !found.lacks.is_empty() {
        rows.row("without a body, not looked at", found.lacks.join(", "));
    }
    let mut text = rows.table();
    if !cuts.is_empty() {
        text.push('\n');
        text.push_str(&cut_table(&cuts, stocks.len()).text());
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
