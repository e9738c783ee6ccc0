//! Rows of cells in columns.

use std::fmt::Write as _;

/// Rows as lines, two blanks between the columns: the first `left` of them begin below one another, the others end so.
pub fn table<const N: usize>(rows: &[[String; N]], left: usize) -> String {
    let widths: [usize; N] = std::array::from_fn(|column| {
        let cells = rows.iter().map(|row| row[column].chars().count());
        cells.max().unwrap_or_default()
    });
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, width)) in row.iter().zip(widths).enumerate() {
            let between = if column > 0 { "  " } else { "" };
            // Writing to a String cannot fail.
            let _ = match column < left {
                true => write!(line, "{between}{cell:<width$}"),
                false => write!(line, "{between}{cell:>width$}"),
            };
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}
