//! What pictures and tables of a study tell alike: units, digits, which move is looked at.

use super::DeviationStudy;
use post_job::files::chart::{LIMIT, Series};

/// Micrometres in a mm.
pub const MICRO: f64 = 1e3;

/// Even pieces that a curve is drawn in.
pub const FINE: u32 = 120;

/// Where the largest deviation is more than this times the tolerance, what is left could not be seen.
pub const HUGE: f64 = 20.0;

/// A length over a move, in µm.
pub fn sampled(length: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
    (0..=FINE)
        .map(|step| {
            let t = f64::from(step) / f64::from(FINE);
            [t, length(t) * MICRO]
        })
        .collect()
}

/// Which move is looked at.
pub fn focus(study: &DeviationStudy) -> String {
    let row = &study.rows[study.focus];
    format!(
        "move {}, CL line {}: {:.3} mm, {:.4}° of rotary axes",
        study.focus + 1,
        row.line,
        row.length,
        row.turn.to_degrees()
    )
}

/// A line at the tolerance from `from` to `to`, if it does not dwarf the rest.
pub fn tolerance(study: &DeviationStudy, [from, to]: [f64; 2], largest: f64) -> Option<Series> {
    let tolerance = study.machine.accuracy.tolerance * MICRO;
    (tolerance < 3.0 * largest).then(|| {
        Series::line(
            format!("tolerance, {tolerance} µm"),
            vec![[from, tolerance], [to, tolerance]],
            LIMIT,
        )
    })
}

/// R² with so many digits that it is not 1.
pub fn digits(share: f64) -> String {
    if share > 0.999_999_5 {
        "> 0.999999".to_owned()
    } else if share > 0.9999 {
        format!("{share:.6}")
    } else {
        format!("{share:.4}")
    }
}

/// So many moves, in words.
pub fn count_of_moves(count: usize) -> String {
    match count {
        1 => "1 move".to_owned(),
        count => format!("{count} moves"),
    }
}
