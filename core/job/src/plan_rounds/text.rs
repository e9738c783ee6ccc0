//! What planning in rounds has done, for people.

use std::fmt::Write as _;

use super::{Found, Round};
use crate::text::number;

/// As a table.
pub fn text(found: &Found) -> String {
    let mut text = String::new();
    let mut row = |name: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<16} {value}");
    };
    let said = if found.kept { "kept" } else { "exceeded" };
    row(
        "contour limit",
        format!(
            "{} mm, {said} by the program that is written, as it is predicted",
            number(found.limit_mm, 5)
        ),
    );
    let limit = found.limit_mm;
    row("  unplanned", line(&found.unplanned, limit, None));
    let first = found.rounds.first();
    for (index, round) in found.rounds.iter().enumerate() {
        let before = first.filter(|_| index > 0);
        let mut told = line(round, limit, before);
        if index == found.chosen {
            told.push_str("; written");
        }
        row(&format!("  round {}", index + 1), told);
    }
    text
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
