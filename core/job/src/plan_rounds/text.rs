//! What planning in rounds has done, for people.

use std::fmt::Write as _;

use super::{PlanRoundsSummary, Round};
use crate::text::number;
use crate::text_table::NamedValues;

/// As a table.
pub fn text(found: &PlanRoundsSummary) -> String {
    let mut rows = NamedValues::default();
    let said = if found.kept { "kept" } else { "exceeded" };
    let limit = found.limit_mm;
    let shown = number(limit, 5);
    rows.row(
        "contour limit",
        format_args!("{shown} mm, {said} by the program that is written, as it is predicted"),
    );
    rows.row("  unplanned", line(&found.unplanned, limit, None));
    let first = found.rounds.first();
    for (index, round) in found.rounds.iter().enumerate() {
        let before = first.filter(|_| index > 0);
        let mut told = line(round, limit, before);
        if index == found.chosen {
            told.push_str("; written");
        }
        rows.row(format_args!("  round {}", index + 1), told);
    }
    rows.lines(16)
}

fn line(round: &Round, limit: f64, first: Option<&Round>) -> String {
    let mut told = format!(
        "{} s, contour error {} mm (line {}, CL line {}), ",
        number(round.cycle_s, 3),
        number(round.contour_mm, 5),
        round.nc_line,
        round.cl_line
    );
    // Writing to a String cannot fail.
    let _ = match round.contour_mm > limit {
        true => write!(
            told,
            "{} % over the limit, beyond it for {} s",
            number(100.0 * (round.contour_mm / limit - 1.0), 1),
            number(round.over_s, 3)
        ),
        false => write!(told, "{} % to spare", number(100.0 * (1.0 - round.contour_mm / limit), 1)),
    };
    if let Some(first) = first {
        let _ = write!(
            told,
            "; tightened in {} cells, {} s longer for it",
            round.tightened,
            number(round.cycle_s - first.cycle_s, 3)
        );
    }
    if round.beside_rapid_mm > limit {
        let _ = write!(told, "; {} mm beside rapids", number(round.beside_rapid_mm, 5));
    }
    told
}
