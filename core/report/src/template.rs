//! Lines of a text as templates, and columns of the numbers in them.
//!
//! A number is an optional minus, digits without needless zeros in front, and a point with digits after it or none.
//! What is written otherwise (`-0.0`, `007`, `.5`, seventeen digits) stays a part of the template. Numbers of the same
//! address go into one column, whatever template they stand in: the letter ahead of them and how often it came in the
//! line; after a slash (CL words) the text up to it and how many numbers came since.
//!
//! A chunk is: the number of templates (32 bits), each with its length (32 bits) and its bytes, where a zero byte
//! stands for a number; the number of columns (32 bits); for each template and number the place of its column (32
//! bits); the column of the templates of the lines; and of each column its number of rows (32 bits), a byte for how its
//! numbers are written, and the column of the numbers without their points. That byte is the number of decimals that
//! all of them have; 32 more: at most so many, without zeros at the end; 64 more: each has its own, in a column after.
//! Numbers are then those of the most decimals. Integers lie as in [`crate::integers`], 32 bits with the least byte
//! first.

use std::collections::{BTreeMap, HashMap};

use crate::integers;

/// Digits that an integer of the page holds exactly, twice differenced.
const MOST_DIGITS: usize = 14;

/// Decimals at most.
const MOST_DECIMALS: u8 = 14;

/// Numbers are written without zeros at the end.
const TRIMMED: u8 = 32;

/// Each number has its own decimals.
const MIXED: u8 = 64;

/// More templates than a share of the lines: the text is not of that kind.
const SHARE: usize = 6;

/// A number of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FixedNumber {
    /// Digits without the point.
    digits: i64,
    decimals: u8,
}

/// Numbers of one address.
#[derive(Default)]
struct NumberColumn {
    numbers: Vec<FixedNumber>,
}

/// The lines of `text` (each with its line feed, the last perhaps without) as templates and columns; none if they are
/// not of that kind.
pub fn encode(text: &[u8]) -> Option<Vec<u8>> {
    if text.contains(&0) {
        return None;
    }
    let count = text.split_inclusive(|byte| *byte == b'\n').count();
    let most = count / SHARE + 16;
    // Looked up and never gone over: no order comes of it.
    let mut places: HashMap<Vec<u8>, usize> = HashMap::new();
    // Of each template its bytes and the columns of its numbers.
    let mut templates: Vec<(Vec<u8>, Vec<u32>)> = Vec::new();
    let mut addresses: BTreeMap<Vec<u8>, usize> = BTreeMap::new();
    let mut columns: Vec<NumberColumn> = Vec::new();
    let mut lines: Vec<i64> = Vec::with_capacity(count);
    let mut template = Vec::new();
    let mut numbers = Vec::new();
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        template.clear();
        numbers.clear();
        take_apart(line, &mut template, &mut numbers);
        // Lines of one kind mostly come together.
        let known = match lines.last() {
            Some(last) if templates[*last as usize].0 == template => Some(*last as usize),
            _ => places.get(&template).copied(),
        };
        let place = match known {
            Some(place) => place,
            None => {
                if templates.len() >= most {
                    return None;
                }
                let slots = slots(&template, &mut addresses, &mut columns);
                templates.push((template.clone(), slots));
                places.insert(template.clone(), templates.len() - 1);
                templates.len() - 1
            }
        };
        for (number, slot) in numbers.iter().zip(&templates[place].1) {
            columns[*slot as usize].numbers.push(*number);
        }
        lines.push(place as i64);
    }
    let mut out = Vec::new();
    let word = |out: &mut Vec<u8>, value: usize| out.extend((value as u32).to_le_bytes());
    word(&mut out, templates.len());
    for (template, _) in &templates {
        word(&mut out, template.len());
        out.extend_from_slice(template);
    }
    word(&mut out, columns.len());
    for (_, slots) in &templates {
        slots.iter().for_each(|slot| word(&mut out, *slot as usize));
    }
    integers::encode(&lines, &mut out);
    for column in &columns {
        word(&mut out, column.numbers.len());
        column.encode(&mut out)?;
    }
    Some(out)
}

/// A line as its template and its numbers.
fn take_apart(line: &[u8], template: &mut Vec<u8>, numbers: &mut Vec<FixedNumber>) {
    let mut at = 0;
    while at < line.len() {
        let byte = line[at];
        let begins = byte.is_ascii_digit()
            || byte == b'-' && line.get(at + 1).is_some_and(u8::is_ascii_digit);
        if !begins {
            template.push(byte);
            at += 1;
            continue;
        }
        let end = end_of_number(line, at);
        match number(&line[at..end]) {
            Some(number) => {
                numbers.push(number);
                template.push(0);
            }
            None => template.extend_from_slice(&line[at..end]),
        }
        at = end;
    }
}

/// Where the run of digits with at most one point ends that begins at `at`.
fn end_of_number(line: &[u8], at: usize) -> usize {
    let digits = |from: usize| {
        let rest = line[from..].iter();
        from + rest.take_while(|byte| byte.is_ascii_digit()).count()
    };
    let whole = digits(at + usize::from(line[at] == b'-'));
    match line.get(whole) {
        Some(b'.') if line.get(whole + 1).is_some_and(u8::is_ascii_digit) => digits(whole + 1),
        _ => whole,
    }
}

/// What is written, if it is written as usual.
fn number(text: &[u8]) -> Option<FixedNumber> {
    let (minus, unsigned) = match text {
        [b'-', rest @ ..] => (true, rest),
        rest => (false, rest),
    };
    let mut parts = unsigned.split(|byte| *byte == b'.');
    let (whole, behind) = (parts.next()?, parts.next().unwrap_or_default());
    let needless = whole.len() > 1 && whole[0] == b'0';
    if needless || whole.len() + behind.len() > MOST_DIGITS {
        return None;
    }
    let digits = whole.iter().chain(behind);
    let value = digits.fold(0i64, |value, digit| value * 10 + i64::from(digit - b'0'));
    if minus && value == 0 {
        return None;
    }
    Some(FixedNumber { digits: if minus { -value } else { value }, decimals: behind.len() as u8 })
}

/// The columns of the numbers of a template.
fn slots(
    template: &[u8],
    addresses: &mut BTreeMap<Vec<u8>, usize>,
    columns: &mut Vec<NumberColumn>,
) -> Vec<u32> {
    let mut slots = Vec::new();
    let mut seen: Vec<(u8, u8)> = Vec::new();
    for (at, byte) in template.iter().enumerate() {
        if *byte != 0 {
            continue;
        }
        let before = &template[..at];
        let address = match before.iter().position(|byte| *byte == b'/') {
            Some(slash) => {
                let numbers = before[slash..].iter().filter(|byte| **byte == 0).count();
                let mut address = before[..=slash].to_vec();
                address.push(numbers as u8);
                address
            }
            None => {
                let letter = before.iter().rev().find(|byte| **byte != b' ');
                let letter = letter.copied().unwrap_or(b' ');
                let count = match seen.iter_mut().find(|(known, _)| *known == letter) {
                    Some((_, count)) => {
                        *count = count.wrapping_add(1);
                        *count
                    }
                    None => {
                        seen.push((letter, 0));
                        0
                    }
                };
                vec![letter, count]
            }
        };
        let place = *addresses.entry(address).or_insert_with(|| {
            columns.push(NumberColumn::default());
            columns.len() - 1
        });
        slots.push(place as u32);
    }
    slots
}

impl NumberColumn {
    /// Writes the column; none if its numbers do not fit one scale.
    fn encode(&self, out: &mut Vec<u8>) -> Option<()> {
        let decimals = || self.numbers.iter().map(|number| number.decimals);
        let (least, most) = (decimals().min().unwrap_or(0), decimals().max().unwrap_or(0));
        if most > MOST_DECIMALS {
            return None;
        }
        let trimmed = |number: &FixedNumber| number.decimals == 0 || number.digits % 10 != 0;
        let form = match () {
            () if least == most => most,
            () if self.numbers.iter().all(trimmed) => TRIMMED + most,
            () => MIXED + most,
        };
        out.push(form);
        let scaled = self.numbers.iter().map(|number| {
            let more = u32::from(most - number.decimals);
            let value = number.digits.checked_mul(10i64.checked_pow(more)?)?;
            (value.unsigned_abs() < 1 << 50).then_some(value)
        });
        let scaled: Vec<i64> = scaled.collect::<Option<_>>()?;
        integers::encode(&scaled, out);
        if form >= MIXED {
            let each: Vec<i64> = decimals().map(i64::from).collect();
            integers::encode(&each, out);
        }
        Some(())
    }
}

/// The text of `lines` lines that was packed as `bytes`; none if they are damaged. What is written is read again before
/// it is believed.
pub fn decode(bytes: &[u8], lines: usize) -> Option<Vec<u8>> {
    let mut at = 0;
    let count = word(bytes, &mut at)?;
    let mut templates = Vec::with_capacity(count);
    for _ in 0..count {
        let length = word(bytes, &mut at)?;
        templates.push(bytes.get(at..at + length)?);
        at += length;
    }
    let columns = word(bytes, &mut at)?;
    let mut slots = Vec::with_capacity(count);
    for template in &templates {
        let numbers = template.iter().filter(|byte| **byte == 0).count();
        let places: Option<Vec<usize>> = (0..numbers).map(|_| word(bytes, &mut at)).collect();
        slots.push(places?);
    }
    let order = integers::decode(bytes, lines, &mut at)?;
    let mut read = Vec::with_capacity(columns);
    for _ in 0..columns {
        let rows = word(bytes, &mut at)?;
        let form = *bytes.get(at)?;
        at += 1;
        let digits = integers::decode(bytes, rows, &mut at)?;
        let each = match form >= MIXED {
            true => integers::decode(bytes, rows, &mut at)?,
            false => Vec::new(),
        };
        read.push((form, digits, each, 0));
    }
    let mut text = Vec::new();
    for place in order {
        let place = usize::try_from(place).ok()?;
        let mut places = slots.get(place)?.iter();
        for byte in *templates.get(place)? {
            if *byte != 0 {
                text.push(*byte);
                continue;
            }
            let (form, digits, each, row) = read.get_mut(*places.next()?)?;
            let digit = *digits.get(*row)?;
            let own = each.get(*row).and_then(|own| u8::try_from(*own).ok());
            *row += 1;
            write(&mut text, digit, *form, own);
        }
    }
    (at == bytes.len()).then_some(text)
}

/// Writes a number as its column says.
fn write(text: &mut Vec<u8>, digits: i64, form: u8, own: Option<u8>) {
    let most = usize::from(form % TRIMMED);
    // The digits, the last first, and zeros up to one ahead of the point.
    let mut all = [b'0'; 40];
    let mut count = 0;
    let mut rest = digits.unsigned_abs();
    while rest > 0 || count <= most {
        all[count] = b'0' + (rest % 10) as u8;
        rest /= 10;
        count += 1;
    }
    let unwanted = match (own, form / TRIMMED) {
        (Some(own), _) => most - usize::from(own).min(most),
        (None, 1) => {
            let zeros = all[..most].iter().take_while(|digit| **digit == b'0');
            zeros.count()
        }
        _ => 0,
    };
    if digits < 0 {
        text.push(b'-');
    }
    text.extend(all[most..count].iter().rev());
    if unwanted < most {
        text.push(b'.');
        text.extend(all[unwanted..most].iter().rev());
    }
}

fn word(bytes: &[u8], at: &mut usize) -> Option<usize> {
    let four = bytes.get(*at..*at + 4)?;
    *at += 4;
    Some(four.iter().rev().fold(0, |word, byte| word << 8 | usize::from(*byte)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn back(text: &str) -> Option<usize> {
        let packed = encode(text.as_bytes())?;
        let lines = text.split_inclusive('\n').count();
        assert_eq!(decode(&packed, lines).as_deref(), Some(text.as_bytes()));
        Some(packed.len())
    }

    #[test]
    fn programs_come_back() {
        let mut text = String::from("%\nO0001 (PART 07)\n");
        for line in 0..500 {
            text.push_str(&format!(
                "N{} G1 X{:.3} Y-{}. Z.5 A{} C-0.000 F007\n",
                10 * line,
                f64::from(line) * 0.125 - 30.0,
                line % 7,
                f64::from(line) / 8.0
            ));
        }
        text.push_str("M30\r\n%");
        let packed = back(&text).unwrap();
        assert!(packed < text.len() / 3, "{packed} of {}", text.len());
    }

    #[test]
    fn every_way_to_write_a_number_comes_back() {
        for line in [
            "GOTO/1.5,-2.25,3,0.100,1e-5,-0,0,00,0.0,-0.10,12345678901234567,+4,1.2.3,--5,-.5,5.\n",
            "",
            "\n",
            "-",
            "9",
            "1\n1.0\n1.00\n",
            "X1Y2X3\nX-1Y-2X-3",
            "é 12 ü\n",
            "99999999999999 0.0000000000001\n",
        ] {
            back(line);
        }
        // Each column by itself: fixed, trimmed, mixed.
        assert!(back("X1.500\nX2.000\n").is_some());
        assert!(back("X1.5\nX2\nX2.25\n").is_some());
        assert!(back("X1.5\nX2.00\nX2.250\n").is_some());
    }

    #[test]
    fn prose_is_left_as_it_is() {
        let text: String = (0..600u32)
            .map(|line| format!("{}\n", "abc".repeat(1 + line as usize % 300)))
            .collect();
        assert_eq!(encode(text.as_bytes()), None);
        assert_eq!(encode(b"a\0b"), None);
    }
}
