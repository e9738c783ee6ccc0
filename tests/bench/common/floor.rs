//! What any program that turns such a file into another must do: read it, parse the six numbers of every line, and
//! format and write five. Twice, by plain loops over digits and by the fastest scalar means known to us: eight bytes
//! of a number at a time, and no branch that depends on them.

use std::error::Error;
use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;

/// Bytes that may be read behind the end of a line, and written behind the end of a word.
const SLACK: usize = 16;

/// Input that is taken at once.
const CHUNK: usize = 1 << 20;

/// Letter and decimals of the five words of a line.
const WORDS: [(u8, usize); 5] = [(b'X', 4), (b'Y', 4), (b'Z', 4), (b'A', 3), (b'C', 3)];

const POWERS: [f64; 17] = [
    1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
];

/// Digit by digit, pair by pair.
pub fn plain(input: &Path, output: &Path) -> Result<(), Box<dyn Error>> {
    floor(input, output, plain_line)
}

/// Eight bytes at a time.
pub fn masked(input: &Path, output: &Path) -> Result<(), Box<dyn Error>> {
    floor(input, output, masked_line)
}

/// Hands the numbers of each line to `line`, with what follows them, and the place where it may write; it says how
/// far it wrote.
fn floor(
    input: &Path,
    output: &Path,
    line: impl Fn(&[u8], &mut [u8]) -> usize,
) -> Result<(), Box<dyn Error>> {
    let mut input = File::open(input)?;
    let mut output = File::create(output)?;
    let mut buffer = vec![0; CHUNK + SLACK];
    // A line of the output is shorter than three of the input.
    let mut out = vec![0; 3 * CHUNK];
    let mut kept = 0;
    loop {
        let read = input.read(&mut buffer[kept..CHUNK])?;
        if read == 0 {
            return Ok(());
        }
        let filled = kept + read;
        let (mut start, mut written) = (0, 0);
        while let Some(length) = memchr::memchr(b'\n', &buffer[start..filled]) {
            let text = &buffer[start..start + length + SLACK];
            start += length + 1;
            if let Some(numbers) = text.strip_prefix(b"GOTO/") {
                written += line(numbers, &mut out[written..]);
            }
        }
        buffer.copy_within(start..filled, 0);
        kept = filled - start;
        output.write_all(&out[..written])?;
    }
}

fn plain_line(numbers: &[u8], out: &mut [u8]) -> usize {
    let mut from = 0;
    let values: [f64; 6] = std::array::from_fn(|_| parse(numbers, &mut from));
    let mut at = 0;
    for ((letter, decimals), value) in WORDS.into_iter().zip(values) {
        out[at] = letter;
        at += 1;
        at += format(&mut out[at..], value, decimals);
        out[at] = b' ';
        at += 1;
    }
    out[at] = b'\n';
    at + 1
}

/// The number at `at`, and the comma behind it.
fn parse(text: &[u8], at: &mut usize) -> f64 {
    let mut mantissa: u64 = 0;
    let mut decimals = 0;
    let mut point = false;
    let minus = text.get(*at) == Some(&b'-');
    *at += usize::from(minus);
    while let Some(&byte) = text.get(*at) {
        *at += 1;
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            mantissa = mantissa * 10 + u64::from(digit);
            decimals += usize::from(point);
        } else if byte == b'.' {
            point = true;
        } else {
            break;
        }
    }
    let value = mantissa as f64 / POWERS[decimals];
    if minus { -value } else { value }
}

const PAIRS: &[u8; 200] = b"0001020304050607080910111213141516171819\
2021222324252627282930313233343536373839\
4041424344454647484950515253545556575859\
6061626364656667686970717273747576777879\
8081828384858687888990919293949596979899";

fn format(out: &mut [u8], value: f64, decimals: usize) -> usize {
    let mut count = (value.abs() * POWERS[decimals] + 0.5) as u64;
    let mut text = [b'0'; 20];
    let mut at = text.len();
    while count >= 100 || text.len() - at < decimals {
        let pair = (count % 100) as usize * 2;
        count /= 100;
        at -= 2;
        text[at..at + 2].copy_from_slice(&PAIRS[pair..pair + 2]);
    }
    while count > 0 || text.len() - at <= decimals {
        at -= 1;
        text[at] = b'0' + (count % 10) as u8;
        count /= 10;
    }
    let mut to = usize::from(value < 0.0);
    out[0] = b'-';
    let point = text.len() - decimals;
    let mut put = |bytes: &[u8]| {
        out[to..to + bytes.len()].copy_from_slice(bytes);
        to += bytes.len();
    };
    put(&text[at..point]);
    put(b".");
    put(&text[point..]);
    to
}

fn masked_line(numbers: &[u8], out: &mut [u8]) -> usize {
    let mut from = 0;
    let values: [f64; 6] = std::array::from_fn(|_| masked_parse(numbers, &mut from));
    let mut at = 0;
    for ((letter, decimals), value) in WORDS.into_iter().zip(values) {
        let out = &mut out[at..at + 32];
        out[0] = letter;
        let length = match decimals {
            4 => masked_format::<4>(&mut out[1..], value),
            _ => masked_format::<3>(&mut out[1..], value),
        };
        out[1 + length] = b' ';
        at += length + 2;
    }
    out[at] = b'\n';
    at + 1
}

/// A byte in every place of eight.
const fn all(byte: u8) -> u64 {
    u64::from_le_bytes([byte; 8])
}

/// The number at `at`, which has a point, and the comma behind it.
fn masked_parse(text: &[u8], at: &mut usize) -> f64 {
    let minus = text[*at] == b'-';
    let begin = *at + usize::from(minus);
    let mut bytes = [0; 8];
    bytes.copy_from_slice(&text[begin..begin + 8]);
    let word = u64::from_le_bytes(bytes);
    // Of digits, point, comma and line end the digits alone have this bit.
    let others = !word & all(0x10);
    let point = others.trailing_zeros() & !7;
    // 64 if the eight are all of the number.
    let end = (others & others.wrapping_sub(1)).trailing_zeros() & !7;
    let behind = begin + (end / 8) as usize;
    if point > 48 || text[behind].is_ascii_digit() {
        // Longer than the words of such a file are.
        return parse(text, at);
    }
    *at = behind + 1;
    // The point taken out, and the digits pushed to the end of eight places.
    let front = (1 << point) - 1;
    let digits = ((word & front) | ((word >> 8) & !front)) << (72 - end);
    let value = eight(digits) as f64 / POWERS[((end - point) / 8 - 1) as usize];
    if minus { -value } else { value }
}

/// The number that eight digits make, the first in the lowest byte; a zero byte counts as the digit 0.
fn eight(text: u64) -> u64 {
    let ones = text & all(0x0f);
    let pairs = (ones * 10 + (ones >> 8)) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs * 100 + (pairs >> 16)) & 0x0000_ffff_0000_ffff;
    (fours * 10_000 + (fours >> 32)) & 0xffff_ffff
}

/// Less than 10⁸ counts of the last decimal.
fn masked_format<const DECIMALS: usize>(out: &mut [u8], value: f64) -> usize {
    let count = (value.abs() * POWERS[DECIMALS] + 0.5) as u64;
    debug_assert!(count < 100_000_000);
    let fours = count / 10_000 | ((count % 10_000) << 32);
    let hundreds = ((fours * 10_486) >> 20) & 0x0000_007f_0000_007f;
    let pairs = hundreds | ((fours - 100 * hundreds) << 16);
    let tens = ((pairs * 103) >> 10) & 0x000f_000f_000f_000f;
    let digits = tens | ((pairs - 10 * tens) << 8);
    // No zeros in front, but one before the point.
    let whole = 8 - DECIMALS;
    let skipped = ((digits.trailing_zeros() / 8) as usize).min(whole - 1);
    let text = digits | all(b'0');
    let minus = usize::from(value < 0.0);
    let point = minus + whole - skipped;
    out[0] = b'-';
    out[minus..minus + 8].copy_from_slice(&(text >> (8 * skipped)).to_le_bytes());
    out[point] = b'.';
    out[point + 1..point + 9].copy_from_slice(&(text >> (8 * whole)).to_le_bytes());
    point + 1 + DECIMALS
}
