//! What compensation has done, for people.

use std::fmt::Write as _;

use super::{Found, Stray};
use crate::text::number;

/// As a table.
pub fn text(found: &Found) -> String {
    let mut text = String::new();
    let mut row = |name: &str, value: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<16} {value}");
    };
    row("servo", said(found));
    row("  before", stray(&found.before));
    row("  after", stray(&found.after));
    text
}

fn said(found: &Found) -> String {
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

fn stray(stray: &Stray) -> String {
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
