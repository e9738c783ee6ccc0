//! What compensation has done, for people.

use super::{CompensationSummary, CutDeviation};
use crate::text::number;
use crate::text_table::NamedValues;

/// As a table.
pub fn text(found: &CompensationSummary) -> String {
    let mut rows = NamedValues::default();
    rows.row("servo", said(found));
    rows.row("  before", stray(&found.before));
    rows.row("  after", stray(&found.after));
    rows.lines(16)
}

fn said(found: &CompensationSummary) -> String {
    let bound = number(found.bound_mm, 6);
    if !found.kept {
        return format!(
            "no move of points by {bound} mm or less makes it better ({} tried): the program is written without",
            found.runs
        );
    }
    format!(
        "{} of {} points moved by at most {} of {bound} mm, found in {} runs; the deviations above are those from the \
         moved path",
        found.points_moved,
        found.points,
        number(found.largest_move_mm, 6),
        found.runs
    )
}

fn stray(stray: &CutDeviation) -> String {
    let cl_line = match stray.cl_line {
        Some(line) => format!(", CL line {line}"),
        None => String::new(),
    };
    format!(
        "tip at most {} mm off the CL path with the servos in between (line {}{cl_line}), RMS {} mm; the servos \
         themselves {} mm",
        number(stray.largest_mm, 6),
        stray.nc_line,
        number(stray.rms_mm, 6),
        number(stray.following_rms_mm, 6)
    )
}
