//! Numbers as a program has them: fixed point, the same on every machine, never `-0.000`.

#![allow(unsafe_code)]

use std::fmt::Write;

/// Powers of ten that an `f64` and a `u64` hold exactly.
const POWERS: [u64; 16] = {
    let mut powers = [1; 16];
    let mut index = 1;
    while index < powers.len() {
        powers[index] = powers[index - 1] * 10;
        index += 1;
    }
    powers
};

/// [`POWERS`] as `f64`.
const POWERS_F: [f64; 16] = {
    let mut powers = [1.0; 16];
    let mut index = 0;
    while index < powers.len() {
        powers[index] = POWERS[index] as f64;
        index += 1;
    }
    powers
};

/// Appends `value` with `decimals` digits after the point (at most 15; none and no point for 0).
///
/// Digit for digit what `format!("{value:.decimals$}")` gives (ties of the exact binary value go to the
/// even digit), except that a number which rounds to nothing has no sign: `0.000`, never `-0.000`.
pub fn fixed(out: &mut String, value: f64, decimals: u8) {
    if !NumberForm::default().append(out, Front::NONE, value, decimals) {
        // Writing to a String cannot fail.
        let _ = write!(out, "{value:.*}", usize::from(decimals));
    }
}

/// [`fixed`] as a text of its own.
pub fn fixed_text(value: f64, decimals: u8) -> String {
    let mut text = String::new();
    fixed(&mut text, value, decimals);
    text
}

/// What stands in front of a number: at most eight bytes, so that they are written at once.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Front {
    /// The first in the lowest byte.
    bytes: u64,
    len: usize,
}

impl Front {
    pub(crate) const NONE: Front = Front { bytes: 0, len: 0 };

    /// Without its first byte, the blank.
    #[inline]
    pub(crate) const fn bare(self) -> Front {
        Front { bytes: self.bytes >> 8, len: self.len.saturating_sub(1) }
    }

    /// With a byte more, ASCII; none if it is too long then.
    #[inline]
    pub(crate) const fn and(self, byte: u8) -> Option<Front> {
        if self.len >= 8 {
            return None;
        }
        Some(Front { bytes: self.bytes | (byte as u64) << (8 * self.len), len: self.len + 1 })
    }

    /// A blank and `text`, all ASCII; none if they are longer.
    #[inline]
    pub(crate) const fn blank(text: &str) -> Option<Front> {
        let text = text.as_bytes();
        // Nearly every address is one letter.
        if let [letter] = *text
            && letter.is_ascii()
        {
            return Some(Front { bytes: b' ' as u64 | (letter as u64) << 8, len: 2 });
        }
        if text.len() > 7 || !text.is_ascii() {
            return None;
        }
        let mut bytes = b' ' as u64;
        let mut index = 0;
        while index < text.len() {
            bytes |= (text[index] as u64) << (8 * (index + 1));
            index += 1;
        }
        let len = text.len() + 1;
        Some(Front { bytes, len })
    }
}

/// What [`fixed`] leaves open.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NumberForm {
    /// A plus where there is no minus.
    pub(crate) plus: bool,
    /// No zeros at the end.
    pub(crate) trim: bool,
    /// A point also where no decimals are left.
    pub(crate) point: bool,
}

impl NumberForm {
    /// Appends `front` and the number; false, and nothing appended, if that is beyond this way.
    ///
    /// Everything is written where it will stay: putting it together elsewhere and copying it costs more than
    /// the digits do.
    // Always, since five words a block are most of what a dialect does.
    #[inline(always)]
    pub(crate) fn append(self, out: &mut String, front: Front, value: f64, decimals: u8) -> bool {
        let Some(count) = count(value, decimals) else {
            return false;
        };
        let negative = value < 0.0 && count != 0;
        let signed = usize::from(negative | self.plus);
        let sign = if negative { b'-' } else { b'+' };
        let places = usize::from(decimals);
        if let Some(short) = u32::try_from(count).ok().and_then(|it| ShortDecimal::new(it, places))
        {
            self.append_short(out, front, signed, sign, short);
            return true;
        }
        if count >= 100_000_000 || places > 7 {
            self.append_long(out, front, signed, sign, count, places);
            return true;
        }
        let packed = eight_digits(count);
        // All eight are zeros for a zero.
        let leading = (packed.trailing_zeros() / 8) as usize;
        let trailing = (packed.leading_zeros() / 8) as usize;
        let digits = (8 - leading).max(places + 1);
        let dropped = if self.trim { trailing.min(places) } else { 0 };
        let point = usize::from(places > dropped || self.point);
        let length = front.len + signed + digits - dropped + point;
        // Eight bytes are written at a time; the last may reach past the end.
        out.reserve(length + 16);
        // SAFETY: what is appended is ASCII. There is room for `length` bytes and sixteen more after the old end;
        // front and sign come first, then the digits with the point among them. Together they are `length`, and
        // each write begins within it and has eight bytes at most.
        unsafe {
            let bytes = out.as_mut_vec();
            let start = bytes.len();
            let mut to = bytes.as_mut_ptr().add(start);
            to.cast::<u64>().write_unaligned(front.bytes.to_le());
            to = to.add(front.len);
            to.write(sign);
            to = to.add(signed);
            let text = (packed | 0x3030_3030_3030_3030) >> (8 * (8 - digits));
            let whole = digits - places;
            to.cast::<u64>().write_unaligned(text.to_le());
            to = to.add(whole);
            to.write(b'.');
            // A shift by all 64 bits would be none.
            let rest = (text >> 8) >> (8 * (whole - 1));
            to.add(1).cast::<u64>().write_unaligned(rest.to_le());
            bytes.set_len(start + length);
        }
        true
    }

    /// Numbers whose digits are in a table.
    #[inline(always)]
    fn append_short(
        self,
        out: &mut String,
        front: Front,
        signed: usize,
        sign: u8,
        short: ShortDecimal,
    ) {
        out.reserve(SHORT_WORD);
        // SAFETY: what is appended is ASCII, and there is room for it.
        unsafe {
            let bytes = out.as_mut_vec();
            let start = bytes.len();
            let length = self.put_short(bytes.as_mut_ptr().add(start), front, signed, sign, short);
            bytes.set_len(start + length);
        }
    }

    /// Writes a word at `to`; its length.
    ///
    /// # Safety
    /// There must be room for [`SHORT_WORD`] bytes.
    #[inline(always)]
    pub(crate) unsafe fn put_short(
        self,
        mut to: *mut u8,
        front: Front,
        signed: usize,
        sign: u8,
        short: ShortDecimal,
    ) -> usize {
        let dropped = if self.trim { short.zeros() } else { 0 };
        let bare = usize::from(dropped == short.places && !self.point);
        // SAFETY: front, sign and digits before the point come first, eight, one and three bytes at most, then point
        // and decimals, of which the length leaves out no more than all. So each write begins no later than at its end,
        // and has eight bytes at most.
        unsafe {
            to.cast::<u64>().write_unaligned(front.bytes.to_le());
            to = to.add(front.len);
            to.write(sign);
            to = to.add(signed);
            to.cast::<u32>().write_unaligned(short.whole.to_le());
            to = to.add(short.digits);
            to.cast::<u64>().write_unaligned(short.fraction.to_le());
        }
        front.len + signed + short.digits + 1 + short.places - dropped - bare
    }

    /// Numbers of more than eight digits.
    #[cold]
    fn append_long(
        self,
        out: &mut String,
        front: Front,
        signed: usize,
        sign: u8,
        mut count: u64,
        mut decimals: usize,
    ) {
        if self.trim {
            while decimals > 0 && count.is_multiple_of(10) {
                count /= 10;
                decimals -= 1;
            }
        }
        let point = usize::from(decimals > 0 || self.point);
        let digits = (count.max(1).ilog10() as usize + 1).max(decimals + 1);
        let length = front.len + signed + digits + point;
        out.reserve(length + 16);
        // SAFETY: as above; the digits are written from their end, and there are as many as were counted.
        unsafe {
            let bytes = out.as_mut_vec();
            let start = bytes.len();
            let to = bytes.as_mut_ptr().add(start);
            to.cast::<u64>().write_unaligned(front.bytes.to_le());
            to.add(front.len).write(sign);
            let mut end = to.add(length);
            if point == 1 {
                end = digits_before(end, &mut count, decimals).sub(1);
                end.write(b'.');
            }
            digits_before(end, &mut count, digits - decimals);
            bytes.set_len(start + length);
        }
    }
}

/// Room that a word takes with a number below 1,000, and what is written past its end.
pub(crate) const SHORT_WORD: usize = 32;

/// Appends to `counts` the units of the last decimal in numbers of a program that [`ShortDecimal`] has; false if it has not
/// all of them.
pub(crate) fn short_counts(values: &[f64], decimals: u8, counts: &mut Vec<u32>) -> bool {
    // No rounding brings less to 1,000.
    const BELOW: f64 = 999.9;
    // As in `count`: what is printed is no farther from a whole number of units.
    const EXACT: f64 = 1e-3;
    if !matches!(decimals, 3 | 4) {
        return false;
    }
    let power = POWERS_F[usize::from(decimals)];
    if !values.iter().fold(true, |all, value| all & (value.abs() < BELOW)) {
        return false;
    }
    let units = |value: f64| -> i32 {
        // SAFETY: it is not negative, below 10^7 and not NaN, as was just asked of every value.
        unsafe { (value.abs() * power + 0.5).to_int_unchecked() }
    };
    counts.extend(values.iter().map(|value| units(*value) as u32));
    values.iter().fold(true, |all, value| {
        all & ((value.abs() * power - f64::from(units(*value))).abs() < EXACT)
    })
}

/// The text of a number below 1,000 with three or four decimals, which nearly every word of a program is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShortDecimal {
    /// Digits before the point, the first in the lowest byte; what is above them is overwritten.
    whole: u32,
    /// How many these are, 1 to 3.
    digits: usize,
    /// The point, in the lowest byte, and the decimals.
    fraction: u64,
    /// How many decimals there are.
    places: usize,
}

impl ShortDecimal {
    /// None if the number is larger, or has other decimals.
    #[inline(always)]
    pub(crate) fn new(count: u32, places: usize) -> Option<Self> {
        let (rest, last) = (count / 1000, FRACTIONS[(count % 1000) as usize]);
        let (whole, fraction) = match places {
            3 => (rest, u64::from(last)),
            4 => {
                let first = u64::from(b'0') + u64::from(rest % 10);
                (rest / 10, u64::from(last >> 8) << 16 | first << 8 | u64::from(b'.'))
            }
            _ => return None,
        };
        let whole = *WHOLES.get(whole as usize)?;
        Some(Self { whole, digits: (whole >> 24) as usize, fraction, places })
    }

    /// Zeros at the end of the decimals.
    #[inline(always)]
    fn zeros(self) -> usize {
        // The last digit in the highest byte; the point is no zero and ends them.
        let digits = self.fraction << (56 - 8 * self.places) & 0x0f0f_0f0f_0f0f_0f0f;
        (digits.leading_zeros() / 8) as usize
    }
}

/// `0` to `999`, the first digit in the lowest byte; in the highest how many digits these are.
static WHOLES: [u32; 1000] = {
    let mut table = [0; 1000];
    let mut number = 0;
    while number < 1000 {
        let digits = if number < 10 { 1 } else { 2 + (number >= 100) as u32 };
        let text = FRACTIONS[number as usize] >> 8;
        table[number as usize] = text >> (8 * (3 - digits)) | digits << 24;
        number += 1;
    }
    table
};

/// `.000` to `.999`, the point in the lowest byte.
static FRACTIONS: [u32; 1000] = {
    let mut table = [0; 1000];
    let mut number = 0;
    while number < 1000 {
        let digits = [number / 100, number / 10 % 10, number % 10];
        table[number as usize] = 0x3030_302e | digits[0] << 8 | digits[1] << 16 | digits[2] << 24;
        number += 1;
    }
    table
};

/// The eight decimal digits of a number below 10^8, a byte each, the first in the lowest.
#[inline]
fn eight_digits(count: u64) -> u64 {
    // Halves of four digits, quarters of two, digits: each split divides all lanes at once, by a
    // multiplication and a shift that are exact for numbers so small.
    let halves = (count / 10_000) | ((count % 10_000) << 32);
    let hundreds = ((halves * 10_486) >> 20) & 0x0000_007f_0000_007f;
    let quarters = hundreds | ((halves - hundreds * 100) << 16);
    let tens = ((quarters * 103) >> 10) & 0x000f_000f_000f_000f;
    tens | ((quarters - tens * 10) << 8)
}

/// Writes the last `left` digits of `count` before `end` and takes them off it; where the first stands.
///
/// # Safety
/// There must be room for `left` bytes before `end`.
#[inline]
unsafe fn digits_before(mut end: *mut u8, count: &mut u64, mut left: usize) -> *mut u8 {
    while left >= 2 {
        let pair = &PAIRS[(*count % 100) as usize];
        *count /= 100;
        // SAFETY: the caller's promise.
        unsafe {
            end = end.sub(2);
            end.copy_from_nonoverlapping(pair.as_ptr(), 2);
        }
        left -= 2;
    }
    if left == 1 {
        // SAFETY: the caller's promise.
        unsafe {
            end = end.sub(1);
            end.write(b'0' + (*count % 10) as u8);
        }
        *count /= 10;
    }
    end
}

/// `00` to `99`.
const PAIRS: [[u8; 2]; 100] = {
    let mut pairs = [[0; 2]; 100];
    let mut index = 0;
    while index < pairs.len() {
        pairs[index] = [b'0' + (index / 10) as u8, b'0' + (index % 10) as u8];
        index += 1;
    }
    pairs
};

/// The `f64` nearest to the number that [`fixed`] prints, so that it prints the same again and comparing
/// two such numbers with `==` compares what stands in the program.
pub fn quantise(value: f64, decimals: u8) -> f64 {
    match count(value, decimals) {
        // Both are exact, and a division rounds once.
        Some(count) if count < 1 << 53 => {
            let size = count as f64 / POWERS[usize::from(decimals)] as f64;
            if value < 0.0 && count != 0 { -size } else { size }
        }
        _ => {
            let mut text = String::new();
            fixed(&mut text, value, decimals);
            text.parse().unwrap_or(value)
        }
    }
}

/// How many units of the last decimal `|value|` has, rounded exactly; none if that is beyond this way.
#[inline]
fn count(value: f64, decimals: u8) -> Option<u64> {
    let power = *POWERS_F.get(usize::from(decimals))?;
    // One multiplication is off by less than 2^-13 here, so only near a tie it does not settle the matter.
    let scaled = value.abs() * power;
    if scaled < (1_u64 << 40) as f64 {
        // SAFETY: it is not negative, below 2^40 and not NaN, so the cast need not look.
        let whole: i64 = unsafe { scaled.to_int_unchecked() };
        let rest = scaled - whole as f64;
        if (rest - 0.5).abs() > 1e-3 {
            return Some(whole as u64 + u64::from(rest > 0.5));
        }
    }
    count_exactly(value, POWERS[usize::from(decimals)])
}

/// Counts any number by its bits.
#[cold]
fn count_exactly(value: f64, power: u64) -> Option<u64> {
    let bits = value.abs().to_bits();
    // |value| = mantissa / 2^shift.
    let (exponent, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
    let (mantissa, shift) = match exponent {
        0 => (fraction, 1074),
        _ => (fraction | 1 << 52, 1075 - exponent),
    };
    if shift <= 0 {
        return None;
    }
    // Below 2^53 · 2^50, so nothing is lost, and whatever is shifted out wholly is less than a half.
    let units = u128::from(mantissa) * u128::from(power);
    if shift > 104 {
        return Some(0);
    }
    let whole = units >> shift;
    let half = 1_u128 << (shift - 1);
    let rest = units & ((1_u128 << shift) - 1);
    let up = rest > half || (rest == half && whole & 1 == 1);
    u64::try_from(whole + u128::from(up)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn own(value: f64, decimals: u8) -> String {
        let mut text = String::new();
        fixed(&mut text, value, decimals);
        text
    }

    fn std(value: f64, decimals: u8) -> String {
        let text = format!("{value:.*}", usize::from(decimals));
        match text.strip_prefix('-') {
            Some(rest) if rest.bytes().all(|byte| byte == b'0' || byte == b'.') => rest.to_owned(),
            _ => text,
        }
    }

    #[test]
    fn eight_digits_are_those_of_std() {
        // Miri is some thousand times slower.
        let step = if cfg!(miri) { 9_999_991 } else { 997 };
        for count in (0..100_000_000_u64).step_by(step).chain([99_999_999]) {
            assert_eq!(
                (eight_digits(count) | 0x3030_3030_3030_3030).to_le_bytes().as_slice(),
                format!("{count:08}").as_bytes()
            );
        }
    }

    fn check(value: f64) {
        for decimals in 0..=9 {
            for value in [value, -value] {
                let text = own(value, decimals);
                assert_eq!(text, std(value, decimals), "{value:e} with {decimals}");
                let same = quantise(value, decimals);
                assert_eq!(own(same, decimals), text, "{value:e} with {decimals}");
                assert_eq!(quantise(same, decimals), same);
                assert!(same != 0.0 || same.is_sign_positive());
            }
        }
    }

    #[test]
    fn writes_what_std_writes() {
        for value in [
            0.0,
            0.5,
            1.5,
            2.5,
            0.25,
            0.125,
            0.375,
            0.0005,
            0.0015,
            0.9995,
            1e-300,
            5e-324,
            1e15,
            9e15,
            4.5e15,
            1e16,
            1e22,
            1e300,
            0.1,
            0.35,
            1.005,
            123_456.789_5,
        ] {
            check(value);
        }
        // Miri is some thousand times slower.
        let (steps, rounds) = if cfg!(miri) { (40, 100) } else { (4000, 20_000) };
        for step in 0..steps {
            // Exact ties and their neighbours.
            let value = f64::from(step) / 64.0;
            check(value);
            check(f64::from_bits(value.to_bits() + 1));
            check(f64::from_bits(value.to_bits().saturating_sub(1)));
        }
        // xorshift: any bit pattern, and the sizes that occur on machines.
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        for _ in 0..rounds {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            let any = f64::from_bits(state);
            if any.is_finite() && any.abs() < 1e40 {
                check(any);
            }
            check((state % 2_000_000_000_000) as f64 / 1e6 - 1e6);
            check((state % 20_000_000) as f64 / 1e4 + 0.000_05);
        }
    }

    /// Signs, points and zeros at the end, against the standard library's text with them put in and taken off.
    #[test]
    fn every_look_is_the_plain_number_with_its_changes() {
        for value in [
            0.0,
            0.5,
            10.0,
            -12.25,
            100.0,
            123_456.7,
            99_999_999.0,
            1e8,
            -1e8,
            1_234_567_890.5,
            1e-9,
            0.01,
            -7.7,
            85.05,
            999.999,
            -999.9996,
            1000.0,
        ] {
            for decimals in 0..=9 {
                for look in 0..8 {
                    let look = NumberForm {
                        plus: look & 1 != 0,
                        trim: look & 2 != 0,
                        point: look & 4 != 0,
                    };
                    let mut wanted = std(value, decimals);
                    if look.trim && wanted.contains('.') {
                        wanted.truncate(wanted.trim_end_matches('0').trim_end_matches('.').len());
                    }
                    if look.point && !wanted.contains('.') {
                        wanted.push('.');
                    }
                    if look.plus && !wanted.starts_with('-') {
                        wanted.insert(0, '+');
                    }
                    for front in ["X", "", "CR=", "ABCDEFG"] {
                        let mut text = String::from("before");
                        let blank = Front::blank(front).unwrap();
                        assert!(look.append(&mut text, blank, value, decimals));
                        assert_eq!(text, format!("before {front}{wanted}"), "{look:?}");
                    }
                }
            }
        }
        assert!(Front::blank("ABCDEFGH").is_none());
        assert!(Front::blank("Ü").is_none());
    }

    #[test]
    fn numbers_that_are_not_finite_are_left_to_std() {
        assert_eq!(own(f64::INFINITY, 3), "inf");
        assert_eq!(own(f64::NAN, 3), "NaN");
    }
}
