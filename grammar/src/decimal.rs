//! Decimal numbers, eight digits at a time: bit for bit what `str::parse` gives.

/// Powers of ten that a double holds exactly.
pub(crate) const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Power of ten by which digits after a mantissa multiply it.
const SHIFTS: [u64; 8] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000];

/// Digits, leading zeros among them, that cannot overflow the mantissa.
const MOST_DIGITS: usize = 19;

/// Eight characters `0`.
const ZEROS: u64 = 0x3030_3030_3030_3030;

/// The decimal number at `at`, and where it ends; `None` if there is none, or if it is beyond any double.
///
/// A mantissa below 2⁵³ and a power of ten up to 22 are both exact as doubles, so that their quotient is rounded
/// once, as it should be. Anything longer, or with an exponent, goes to `str::parse`.
pub(crate) fn number(text: &[u8], at: usize) -> Option<(f64, usize)> {
    if let Some(short) = short_number(text, at) {
        return Some(short);
    }
    let rest = text.get(at..)?;
    let (value, length) = near_the_end(rest).or_else(|| general(rest))?;
    Some((value, at + length))
}

/// A short number with less than a window after it.
fn near_the_end(text: &[u8]) -> Option<(f64, usize)> {
    let mut window = [b' '; 17];
    window.get_mut(..text.len())?.copy_from_slice(text);
    short_number(&window, 0)
}

/// Reads as [`number`] does, but only a number of up to seven digits on either side of the point, with neither `+` nor
/// exponent, and not at the very end of the text: without a loop, and without a branch on its sign and length.
#[inline(always)]
pub(crate) fn short_number(text: &[u8], at: usize) -> Option<(f64, usize)> {
    let short = short(text, at)?;
    (!is_exponent(text[short.end])).then_some((short.value, short.end))
}

/// A number without an exponent; what follows it is not looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Decimal {
    pub(crate) value: f64,
    /// Whether a decimal point is written.
    pub(crate) point: bool,
    /// Byte at which the number ends.
    pub(crate) end: usize,
}

/// The number at `at` of up to 19 digits, with or without a sign; none if there is none, or if it is longer.
#[inline(always)]
pub(crate) fn decimal(text: &[u8], at: usize) -> Option<Decimal> {
    match short(text, at) {
        Some(short) => Some(short),
        None => long_decimal(text, at),
    }
}

/// Reads as [`decimal`] does, a number that is long, near the end of the text, or has a `+`.
#[inline(never)]
fn long_decimal(text: &[u8], at: usize) -> Option<Decimal> {
    let rest = text.get(at..)?;
    let mantissa = mantissa(rest)?;
    Some(Decimal {
        value: mantissa.exact(rest)?,
        point: mantissa.decimals.is_some(),
        end: at + mantissa.end,
    })
}

/// Reads as [`decimal`] does, without the long numbers.
#[inline(always)]
fn short(text: &[u8], at: usize) -> Option<Decimal> {
    let window: &[u8; 17] = text.get(at..at + 17)?.try_into().ok()?;
    let negative = window[0] == b'-';
    let begin = usize::from(negative);
    let all: [u8; 16] = window[begin..begin + 16].try_into().ok()?;
    // The first character in the lowest byte.
    let all = u128::from_le_bytes(all);
    let [low, high] = [all as u64 ^ ZEROS, (all >> 64) as u64 ^ ZEROS];
    let others = others(low);
    if others == 0 {
        return None;
    }
    let before = others.trailing_zeros() & 0x38;
    let digits = (before / 8) as usize;
    let mut mantissa = eight_digits(low << 8 << (56 - before));
    let mut decimals = 0;
    let mut length = digits;
    let point = window[begin + digits] == b'.';
    if point {
        // The eight characters after the point.
        let fraction = (low >> 8 >> before) | (high << (56 - before));
        let others = self::others(fraction);
        if others == 0 {
            return None;
        }
        let end = others.trailing_zeros() & 0x38;
        decimals = (end / 8) as usize;
        mantissa = mantissa * SHIFTS[decimals] + eight_digits(fraction << 8 << (56 - end));
        length += 1 + decimals;
    }
    if digits + decimals == 0 {
        return None;
    }
    let value = mantissa as i64 as f64 / POWERS[decimals];
    let sign = u64::from(negative) << 63;
    Some(Decimal { value: f64::from_bits(value.to_bits() | sign), point, end: at + begin + length })
}

/// The number at the start of `text`, of any length, and its length.
fn general(text: &[u8]) -> Option<(f64, usize)> {
    let mantissa = mantissa(text)?;
    let exponent = text.get(mantissa.end).is_some_and(|&byte| is_exponent(byte));
    match mantissa.exact(text) {
        Some(value) if !exponent => Some((value, mantissa.end)),
        _ => long(text, mantissa.end),
    }
}

/// A number without its exponent.
struct Mantissa {
    /// Digits as one number, if there are no more than [`MOST_DIGITS`].
    digits: u64,
    count: usize,
    /// Count of digits after the point; none if there is no point.
    decimals: Option<usize>,
    end: usize,
}

/// The digits at the start of `text`, with or without a sign; none if there are none.
fn mantissa(text: &[u8]) -> Option<Mantissa> {
    let begin = usize::from(matches!(text.first(), Some(b'-' | b'+')));
    let (mut value, mut end) = digits(text, begin, 0);
    let mut count = end - begin;
    let mut decimals = None;
    if text.get(end) == Some(&b'.') {
        let point = end;
        (value, end) = digits(text, point + 1, value);
        decimals = Some(end - point - 1);
        count += end - point - 1;
    }
    (count > 0).then_some(Mantissa { digits: value, count, decimals, end })
}

impl Mantissa {
    /// The value where a double holds the digits exactly; `text` begins with the number.
    fn exact(&self, text: &[u8]) -> Option<f64> {
        if self.count > MOST_DIGITS || self.digits >= 1 << 53 {
            return None;
        }
        let value = self.digits as f64 / POWERS[self.decimals.unwrap_or_default()];
        Some(if text[0] == b'-' { -value } else { value })
    }
}

/// A number whose mantissa ends at `end`, by `str::parse`.
fn long(text: &[u8], mut end: usize) -> Option<(f64, usize)> {
    if text.get(end).is_some_and(|&byte| is_exponent(byte)) {
        let sign = matches!(text.get(end + 1), Some(b'+' | b'-'));
        let from = end + 1 + usize::from(sign);
        (_, end) = digits(text, from, 0);
        if end == from {
            return None;
        }
    }
    let token = std::str::from_utf8(&text[..end]).ok()?;
    let value = token.parse::<f64>().ok()?;
    value.is_finite().then_some((value, end))
}

#[inline(always)]
fn is_exponent(byte: u8) -> bool {
    matches!(byte, b'e' | b'E')
}

/// Which of eight characters, less [`ZEROS`], are no digits: some bit in the upper half of the byte. Right up to the
/// first such byte, and to the next after a point; one above 0xF9 carries into those after it.
#[inline(always)]
fn others(eight: u64) -> u64 {
    (eight.wrapping_add(0x0606_0606_0606_0606) | eight) & 0xF0F0_F0F0_F0F0_F0F0
}

/// Appends the digits at `at` to `mantissa`, wrapping; gives also where they end.
fn digits(text: &[u8], mut at: usize, mut mantissa: u64) -> (u64, usize) {
    while let Some(bytes) = text.get(at..at + 8) {
        let eight = u64::from_le_bytes(bytes.try_into().expect("eight bytes")) ^ ZEROS;
        let others = others(eight);
        if others == 0 {
            mantissa = mantissa.wrapping_mul(100_000_000).wrapping_add(eight_digits(eight));
            at += 8;
            continue;
        }
        let count = others.trailing_zeros() / 8;
        // As many zeros come in front.
        let eight = eight << 8 << (56 - 8 * count);
        let mantissa =
            mantissa.wrapping_mul(SHIFTS[count as usize]).wrapping_add(eight_digits(eight));
        return (mantissa, at + count as usize);
    }
    while let Some(digit @ b'0'..=b'9') = text.get(at) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit - b'0'));
        at += 1;
    }
    (mantissa, at)
}

/// The number of eight digits, each 0 to 9, the first in the lowest byte: pairs, then fours, then all.
#[inline(always)]
pub(crate) fn eight_digits(digits: u64) -> u64 {
    let pairs = digits.wrapping_mul(10).wrapping_add(digits >> 8) & 0x00FF_00FF_00FF_00FF;
    let fours = pairs.wrapping_mul(100).wrapping_add(pairs >> 16) & 0x0000_FFFF_0000_FFFF;
    fours.wrapping_mul(10_000).wrapping_add(fours >> 32) & 0xFFFF_FFFF
}

#[cfg(test)]
mod tests {
    use super::*;
    use post_testkit::randomised;

    /// Checks the number with what follows it in a file, and at the end of the text.
    fn assert_like_std(text: &str) {
        let expected: f64 = text.parse().expect(text);
        for behind in [
            "",
            ",",
            "\n",
            ", 12345678, 12345678",
            "$$ 12345678 12345678",
            "\u{FA}\u{FA}\u{FA}\u{FA}\u{FA}\u{FA}\u{FA}\u{FA}\u{FA}",
        ] {
            let line = format!("{text}{behind}");
            let (value, length) = number(line.as_bytes(), 0).expect(text);
            assert_eq!(value.to_bits(), expected.to_bits(), "{line}");
            assert_eq!(length, text.len(), "{line}");
        }
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
            "12345678",
            "1234567.12345678",
            "999999999999999",
            "1000000000000000",
            "9007199254740991",
            "9007199254740992",
            "9007199254740993",
            "900719925474099.3",
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
        for text in ["", ".", "-", "+.", "e5", "1e", "1e+", "1e400", "--1", "inf", "nan", ":", "/"]
        {
            assert_eq!(number(text.as_bytes(), 0), None, "{text}");
            assert_eq!(number(format!("{text}, 12345678, 12345678").as_bytes(), 0), None, "{text}");
        }
    }

    #[test]
    fn any_byte_but_a_digit_ends_a_number() {
        for byte in (0..=u8::MAX).filter(|byte| !byte.is_ascii_digit() && !b".eE".contains(byte)) {
            for text in ["7", "12.5", "1234567", "1.2345678"] {
                let mut line = text.as_bytes().to_vec();
                line.extend([byte; 17]);
                assert_eq!(number(&line, 0), Some((text.parse().unwrap(), text.len())), "{byte}");
            }
        }
    }

    #[test]
    fn numbers_like_std() {
        let (rounds, mut rng) = randomised(512, 1);
        for _ in rounds {
            assert_like_std(
                &rng.text("[+-]?([0-9]{1,22}\\.?[0-9]{0,22}|\\.[0-9]{1,22})([eE][+-]?[0-9]{1,2})?"),
            );
            assert_like_std(&rng.text("[+-]?[0-9]{1,10}\\.[0-9]{0,10}"));
        }
    }

    #[test]
    fn printed_doubles_come_back() {
        let (rounds, mut rng) = randomised(512, 2);
        for _ in rounds {
            let value = f64::from_bits(rng.next());
            if value.is_finite() {
                let decimals = rng.pick(12);
                assert_like_std(&format!("{value:?}"));
                assert_like_std(&format!("{:.decimals$}", value % 1e6));
            }
        }
    }
}
