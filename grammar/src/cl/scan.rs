//! The fast way for plain `GOTO/` lines: no allocation, no grammar.
//!
//! It takes only what it is sure of. All else is left to pest, which reads it or says what is wrong.

use super::record::{Direction, Point};

/// A `GOTO` with three or six numbers; `None` if the line is anything else or in any way unusual.
pub(crate) fn goto(line: &[u8]) -> Option<(Point, Option<Direction>)> {
    let rest = skip_blanks(line).strip_prefix(b"GOTO")?;
    let mut rest = skip_blanks(rest).strip_prefix(b"/")?;
    let mut values = [0.0; 6];
    for count in 0..6 {
        if count > 0 {
            match rest.strip_prefix(b",") {
                Some(behind) => rest = behind,
                None if count == 3 && rest.is_empty() => {
                    return Some(([values[0], values[1], values[2]], None));
                }
                None => return None,
            }
        }
        (values[count], rest) = number(skip_blanks(rest))?;
        rest = skip_blanks(rest);
    }
    let [x, y, z, i, j, k] = values;
    rest.is_empty().then_some(([x, y, z], Some([i, j, k])))
}

fn skip_blanks(mut text: &[u8]) -> &[u8] {
    while let [b' ' | b'\t', rest @ ..] = text {
        text = rest;
    }
    text
}

/// Powers of ten that a double holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The decimal number at the start of `text` and what stands behind it.
///
/// Bit for bit what `str::parse` gives: up to 15 digits and a power of ten up to 22 are both exact as doubles,
/// so that their quotient is rounded once, as it should be. Anything longer, or with an exponent, goes to `str::parse`.
#[inline(always)]
fn number(text: &[u8]) -> Option<(f64, &[u8])> {
    // Signs come as they like, so there is no branch on them.
    let negative = text.first() == Some(&b'-');
    let unsigned = &text[usize::from(negative || text.first() == Some(&b'+'))..];
    let (mut mantissa, mut rest) = digits(unsigned, 0);
    let mut count = unsigned.len() - rest.len();
    let mut decimals = 0;
    if let [b'.', fraction @ ..] = rest {
        (mantissa, rest) = digits(fraction, mantissa);
        decimals = fraction.len() - rest.len();
        count += decimals;
    }
    if count == 0 {
        return None;
    }
    // Up to 19 digits, leading zeros among them, cannot overflow the mantissa.
    let exponent = matches!(rest, [b'e' | b'E', ..]);
    if exponent || count > 19 || mantissa >= 1_000_000_000_000_000 {
        let rest = if exponent { skip_exponent(rest)? } else { rest };
        let token = std::str::from_utf8(&text[..text.len() - rest.len()]).ok()?;
        let value = token.parse::<f64>().ok()?;
        return value.is_finite().then_some((value, rest));
    }
    let value = mantissa as f64 / POWERS[decimals];
    let sign = u64::from(negative) << 63;
    Some((f64::from_bits(value.to_bits() | sign), rest))
}

/// Appends the digits at the start of `text` to `mantissa`; gives what stands behind them.
#[inline(always)]
fn digits(mut text: &[u8], mut mantissa: u64) -> (u64, &[u8]) {
    while let [digit @ b'0'..=b'9', rest @ ..] = text {
        mantissa = mantissa
            .wrapping_mul(10)
            .wrapping_add(u64::from(digit - b'0'));
        text = rest;
    }
    (mantissa, text)
}

/// What stands behind an exponent; `None` if it has no digits.
fn skip_exponent(text: &[u8]) -> Option<&[u8]> {
    let (_e, text) = text.split_first()?;
    let text = match text {
        [b'+' | b'-', rest @ ..] => rest,
        _ => text,
    };
    let (_, rest) = digits(text, 0);
    (rest.len() < text.len()).then_some(rest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Reader, Statement, parse_record};
    use proptest::prelude::*;

    fn assert_like_std(text: &str) {
        let (value, rest) = number(text.as_bytes()).expect(text);
        let expected: f64 = text.parse().expect(text);
        assert_eq!(value.to_bits(), expected.to_bits(), "{text}");
        assert!(rest.is_empty(), "{text}");
    }

    #[test]
    fn numbers_at_the_edges() {
        for text in [
            "0",
            "-0",
            "-0.000",
            "1.",
            ".5",
            "-.5",
            "+1.0",
            "1.5E-3",
            "1e22",
            "1.E5",
            "999999999999999",
            "1000000000000000",
            "9007199254740993",
            "0.1",
            "0.3",
            "0000000000000000000.5",
            "00000000000000000000.5",
            "0.0000000000000000000000123",
            "123456789012345.6789012345",
            "2.2250738585072014e-308",
            "4.9e-324",
            "1e-400",
            "179769313486231570000000000000000000000000000",
        ] {
            assert_like_std(text);
        }
        for text in [
            "", ".", "-", "+.", "e5", "1e", "1e+", "1e400", "--1", "inf", "nan",
        ] {
            assert_eq!(number(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn unsure_lines_are_left_to_pest() {
        for line in [
            "GOTO/1,2",
            "GOTO/1,2,3,4",
            "GOTO/1,2,3,",
            "GOTO/1,2,3,4,5,6,",
            "GOTO/1,2,3,4,5,6,7",
            "GOTO/1 2 3",
            "goto/1,2,3",
            "GOTO/1,2,3 $$ x",
            "GOTOX/1,2,3",
            "GODLTA/1,2,3",
            "GOTO/1,2,3x",
            "GOTO/1,2,3,4,5,6x",
            "GOTO/1,2,3,4,5,6, ",
            "GOTO 1,2,3",
            "",
        ] {
            assert_eq!(goto(line.as_bytes()), None, "{line}");
        }
        assert_eq!(
            goto(b" GOTO  /  1. ,-.5,+3 "),
            Some(([1.0, -0.5, 3.0], None))
        );
    }

    /// What pest reads, bit for bit; `None` if it reads no `GOTO`.
    fn pest_bits(line: &str) -> Option<Vec<u64>> {
        match parse_record(line) {
            Ok(Statement::Goto { point, axis }) => Some(bits(point, axis)),
            _ => None,
        }
    }

    fn bits(point: Point, axis: Option<Direction>) -> Vec<u64> {
        let numbers = point.into_iter().chain(axis.into_iter().flatten());
        numbers.map(f64::to_bits).collect()
    }

    #[test]
    fn the_scanner_takes_every_goto_of_the_real_files() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/cl");
        let Ok(files) = std::fs::read_dir(folder) else {
            assert!(std::env::var_os("CI").is_none(), "{folder} is missing");
            eprintln!("skipped: {folder} is missing");
            return;
        };
        let mut taken = 0;
        for file in files {
            let mut reader = Reader::new(std::fs::File::open(file.unwrap().path()).unwrap());
            while let Some(record) = reader.next_record().unwrap() {
                if matches!(record.statement, Statement::Goto { .. }) {
                    let scanned = goto(record.raw).map(|(point, axis)| bits(point, axis));
                    assert!(scanned.is_some(), "{}", record.text());
                    assert_eq!(scanned, pest_bits(&record.text()), "{}", record.text());
                    taken += 1;
                }
            }
        }
        assert!(taken >= 67_916);
    }

    const NUMBER: &str = "[+-]?([0-9]{1,4}|[0-9]{1,4}\\.[0-9]{0,10}|\\.[0-9]{1,18}|[0-9]{10,24}\\.?|[0-9]\\.[0-9]{1,6}[eE][+-]?[0-9]{1,3})";
    const BLANKS: &str = "[ \t]{0,2}";

    proptest! {
        #[test]
        fn scanner_and_pest_agree(
            numbers in prop::collection::vec((BLANKS, NUMBER, BLANKS), 1..8),
            (before, between, tail) in (BLANKS, BLANKS, "(|,| ,| \\$\\$ x|x|,A)"),
        ) {
            let numbers: Vec<String> = numbers.into_iter().map(|(a, number, b)| format!("{a}{number}{b}")).collect();
            let line = format!("{before}GOTO{between}/{}{tail}", numbers.join(","));
            let scanned = goto(line.as_bytes()).map(|(point, axis)| bits(point, axis));
            if scanned.is_some() || (tail.is_empty() && !line.contains(['e', 'E'])) {
                prop_assert_eq!(scanned, pest_bits(&line), "{}", line);
            }
        }

        #[test]
        fn numbers_like_std(text in "[+-]?([0-9]{1,22}\\.?[0-9]{0,22}|\\.[0-9]{1,22})([eE][+-]?[0-9]{1,2})?") {
            assert_like_std(&text);
        }

        #[test]
        fn printed_doubles_come_back(value in any::<f64>().prop_filter("finite", |v| v.is_finite()), decimals in 0..12usize) {
            assert_like_std(&format!("{value:?}"));
            assert_like_std(&format!("{:.decimals$}", value % 1e6));
        }
    }
}
