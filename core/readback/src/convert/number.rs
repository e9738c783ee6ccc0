//! Numbers of a CL file.

use std::fmt::Write;

/// Decimals of a coordinate: a millionth of a micrometre, which no print shows.
pub(super) const LENGTH: usize = 9;

/// Decimals of a direction: a metre away they are a millionth of a micrometre, too.
pub(super) const DIRECTION: usize = 12;

/// Writes a number without needless zeros.
pub(super) fn write(out: &mut String, value: f64, decimals: usize) {
    let start = out.len();
    // Writing to a string cannot fail.
    let _ = write!(out, "{value:.decimals$}");
    if out[start..].contains('.') {
        let kept = out[start..].trim_end_matches('0').trim_end_matches('.');
        out.truncate(start + kept.len());
    }
    if &out[start..] == "-0" {
        out.replace_range(start.., "0");
    }
}

/// Writes numbers with commas between them.
pub(super) fn write_all<'n>(
    out: &mut String,
    values: impl IntoIterator<Item = &'n f64>,
    decimals: usize,
) {
    for (place, value) in values.into_iter().enumerate() {
        if place > 0 {
            out.push(',');
        }
        write(out, *value, decimals);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_no_needless_zeros_and_no_negative_nothing() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-1e-12, "0"),
            (12.5, "12.5"),
            (100.0, "100"),
            (-0.125, "-0.125"),
            (1e6, "1000000"),
            (0.1 + 0.2, "0.3"),
            (1e-9, "0.000000001"),
        ] {
            let mut out = String::new();
            write(&mut out, value, LENGTH);
            assert_eq!(out, text);
        }
    }
}
