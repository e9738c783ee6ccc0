//! Numbers, times and rows of cells as people are shown them.

use std::fmt::Write as _;

use post_plugin::fixed;

/// A number with so many decimals.
pub fn number(value: f64, decimals: u8) -> String {
    let mut text = String::new();
    fixed(&mut text, value, decimals);
    text
}

/// A bound, not negative, with so many decimals: rounded up, but for a thousandth of the last of them.
pub fn at_most(value: f64, decimals: u8) -> String {
    let scale = libm::pow(10.0, f64::from(decimals));
    number(libm::ceil(value * scale - 1e-3) / scale, decimals)
}

/// A time as one says it.
pub fn clock(seconds: f64) -> String {
    let whole = seconds as u64;
    let (hours, minutes) = (whole / 3600, whole / 60 % 60);
    if hours > 0 {
        format!("{hours} h {minutes:02} min")
    } else if minutes > 0 {
        format!("{minutes} min {:02} s", whole % 60)
    } else {
        format!("{seconds:.1} s")
    }
}

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
