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
    let count = lines_of(text).count();
    let most = count / SHARE + 16;
    // Looked up and never gone over: no order comes of it.
    let mut places: HashMap<Vec<u8>, usize> = HashMap::new();
    // Of each template its bytes and the columns of its numbers.
    let mut templates: Vec<(Vec<u8>, Vec<u32>)> = Vec::new();
    let mut addresses: BTreeMap<Vec<u8>, usize> = BTreeMap::new();
    let mut columns: Vec<NumberColumn> = Vec::new();
    let mut lines: Vec<i64> = Vec::with_capacity(count);
    let mut template = Vec::new();
    let mut numbers: Vec<FixedNumber> = Vec::new();
    let mut before = LineLayout::default();
    for line in lines_of(text) {
        numbers.clear();
        // Most lines differ from the one before in digits alone.
        if before.is_of(line)
            && before.numbers(line, &mut numbers)
            && let Some(last) = lines.last().copied()
        {
            for (number, slot) in numbers.iter().zip(&templates[last as usize].1) {
                columns[*slot as usize].numbers.push(*number);
            }
            lines.push(last);
            continue;
        }
        template.clear();
        numbers.clear();
        take_apart(line, &mut template, &mut numbers, &mut before);
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

/// The lines of a text, each with its line feed, the last perhaps without.
pub fn lines_of(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let end = memchr::memchr(b'\n', rest).map_or(rest.len(), |at| at + 1);
        let line;
        (line, rest) = rest.split_at(end);
        (!line.is_empty()).then_some(line)
    })
}

/// Where the numbers of a line stand.
#[derive(Default)]
struct LineLayout {
    /// The line, zeros for its digits.
    marks: Vec<u8>,
    /// Of each number where its first digit stands, how many there are ahead of the point, and decimals.
    places: Vec<NumberPlace>,
}

struct NumberPlace {
    digit: usize,
    whole: usize,
    decimals: usize,
    minus: bool,
}

/// The byte, or a zero for any digit.
fn mark(byte: u8) -> u8 {
    if byte.is_ascii_digit() { b'0' } else { byte }
}

impl LineLayout {
    /// A line has this layout: its digits stand at the same places, and all else is the same.
    fn is_of(&self, line: &[u8]) -> bool {
        let differ = |all: u8, (byte, known): (&u8, &u8)| all | (mark(*byte) ^ known);
        line.len() == self.marks.len() && line.iter().zip(&self.marks).fold(0, differ) == 0
    }

    /// Adds the numbers of a line of this layout; false if one of them is not written as usual.
    fn numbers(&self, line: &[u8], numbers: &mut Vec<FixedNumber>) -> bool {
        let value = |digits: &[u8], value: i64| {
            digits.iter().fold(value, |value, digit| 10 * value + i64::from(digit - b'0'))
        };
        for place in &self.places {
            let point = place.digit + place.whole;
            let mut digits = value(&line[place.digit..point], 0);
            if place.decimals > 0 {
                digits = value(&line[point + 1..point + 1 + place.decimals], digits);
            }
            let needless = place.whole > 1 && line[place.digit] == b'0';
            if needless || place.minus && digits == 0 {
                return false;
            }
            let digits = if place.minus { -digits } else { digits };
            numbers.push(FixedNumber { digits, decimals: place.decimals as u8 });
        }
        true
    }

    /// Becomes that of a line, its numbers not yet told.
    fn begin(&mut self, line: &[u8]) {
        self.places.clear();
        self.marks.clear();
        self.marks.extend(line.iter().map(|byte| mark(*byte)));
    }
}

/// A line as its template, its numbers and where they stand.
fn take_apart(
    line: &[u8],
    template: &mut Vec<u8>,
    numbers: &mut Vec<FixedNumber>,
    layout: &mut LineLayout,
) {
    layout.begin(line);
    let mut at = 0;
    // Where what was not taken over yet begins.
    let mut rest = 0;
    while at < line.len() {
        let begins = line[at].is_ascii_digit()
            || line[at] == b'-' && line.get(at + 1).is_some_and(u8::is_ascii_digit);
        if !begins {
            at += 1;
            continue;
        }
        let (number, end) = number(line, at);
        if let Some(number) = number {
            template.extend_from_slice(&line[rest..at]);
            template.push(0);
            numbers.push(number);
            rest = end;
            let minus = line[at] == b'-';
            let digit = at + usize::from(minus);
            let decimals = usize::from(number.decimals);
            let whole = end - digit - decimals - usize::from(decimals > 0);
            layout.places.push(NumberPlace { digit, whole, decimals, minus });
        } else {
            // As it is written it is a part of the template: another line may not have the same digits there.
            layout.marks.clear();
        }
        at = end;
    }
    template.extend_from_slice(&line[rest..]);
}

/// What is written in the run of digits with at most one point that begins at `at`, if it is written as usual; and where
/// it ends.
fn number(line: &[u8], at: usize) -> (Option<FixedNumber>, usize) {
    let minus = line[at] == b'-';
    let begin = at + usize::from(minus);
    // Too many digits are told from their number: the value may run over.
    let run = |value: &mut i64, from: usize| {
        let mut at = from;
        while let Some(digit) = line.get(at).map(|byte| byte.wrapping_sub(b'0'))
            && digit < 10
        {
            *value = value.wrapping_mul(10).wrapping_add(i64::from(digit));
            at += 1;
        }
        at
    };
    let mut value = 0;
    let whole = run(&mut value, begin);
    let mut end = whole;
    let mut decimals = 0;
    if line.get(whole) == Some(&b'.') && line.get(whole + 1).is_some_and(u8::is_ascii_digit) {
        end = run(&mut value, whole + 1);
        decimals = end - whole - 1;
    }
    let needless = whole - begin > 1 && line[begin] == b'0';
    let many = whole - begin + decimals > MOST_DIGITS;
    if needless || many || minus && value == 0 {
        return (None, end);
    }
    let digits = if minus { -value } else { value };
    (Some(FixedNumber { digits, decimals: decimals as u8 }), end)
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
        let mut powers = [1i64; MOST_DECIMALS as usize + 1];
        for place in 1..powers.len() {
            powers[place] = 10 * powers[place - 1];
        }
        let mut scaled = Vec::with_capacity(self.numbers.len());
        for number in &self.numbers {
            let value = number.digits.checked_mul(powers[usize::from(most - number.decimals)])?;
            if value.unsigned_abs() >= 1 << 50 {
                return None;
            }
            scaled.push(value);
        }
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
    // Of each template what stands ahead of its numbers, and its numbers: their columns and what stands behind.
    let mut forms = Vec::with_capacity(count);
    for template in &templates {
        let mut pieces = template.split(|byte| *byte == 0);
        let ahead = pieces.next()?;
        let numbers: Option<Vec<(usize, &[u8])>> =
            pieces.map(|piece| Some((word(bytes, &mut at)?, piece))).collect();
        forms.push((ahead, numbers?));
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
        let (ahead, numbers) = forms.get(place)?;
        text.extend_from_slice(ahead);
        for (column, behind) in numbers {
            let (form, digits, each, row) = read.get_mut(*column)?;
            let digit = *digits.get(*row)?;
            let own = each.get(*row).and_then(|own| u8::try_from(*own).ok());
            *row += 1;
            write(&mut text, digit, *form, own);
            text.extend_from_slice(behind);
        }
    }
    (at == bytes.len()).then_some(text)
}

/// Writes a number as its column says.
fn write(text: &mut Vec<u8>, digits: i64, form: u8, own: Option<u8>) {
    const LONGEST: usize = 56;
    let most = usize::from(form % TRIMMED);
    // Decimals stand at the end, zeros ahead of them up to the one ahead of the point.
    let mut all = [b'0'; LONGEST];
    let point = LONGEST - most - 1;
    let mut rest = digits.unsigned_abs();
    let mut place = LONGEST;
    let mut next = || {
        let digit = b'0' + (rest % 10) as u8;
        rest /= 10;
        (digit, rest)
    };
    while place > point + 1 {
        place -= 1;
        (all[place], _) = next();
    }
    all[point] = b'.';
    let mut begin = point;
    loop {
        begin -= 1;
        let (digit, rest) = next();
        all[begin] = digit;
        if rest == 0 {
            break;
        }
    }
    if digits < 0 {
        begin -= 1;
        all[begin] = b'-';
    }
    let end = match (own, form / TRIMMED) {
        (Some(own), _) => point + 1 + usize::from(own).min(most),
        (None, 1) => {
            let zeros = all[point + 1..].iter().rev().take_while(|digit| **digit == b'0');
            LONGEST - zeros.count()
        }
        _ => LONGEST,
    };
    // Without decimals without a point.
    let end = if end == point + 1 { point } else { end };
    text.extend_from_slice(&all[begin..end]);
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

    /// A number as the format has it, piece by piece.
    fn plainly(text: &str) -> (Option<FixedNumber>, usize) {
        let run = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let minus = usize::from(text.starts_with('-'));
        let whole = run(&text[minus..]);
        let behind = text[minus + whole..].strip_prefix('.').map_or(0, run);
        let end = minus + whole + behind + usize::from(behind > 0);
        let digits = text[minus..end].replace('.', "");
        let needless = whole > 1 && digits.starts_with('0');
        if needless || digits.len() > MOST_DIGITS {
            return (None, end);
        }
        let value: i64 = digits.parse().unwrap();
        let number =
            FixedNumber { digits: if minus == 1 { -value } else { value }, decimals: behind as u8 };
        (Some(number).filter(|_| minus == 0 || value != 0), end)
    }

    #[test]
    fn a_number_is_what_the_format_says() {
        let mut seed = 1u64;
        let mut drawn = |most: u64| {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) % most
        };
        let mut usual = 0;
        for _ in 0..20_000 {
            let count = 1 + drawn(22);
            let digits = (0..count).map(|_| b"0012345678900..-"[drawn(16) as usize] as char);
            let text: String = digits.collect();
            let text = format!("{}{}{text} ", ["", "-"][drawn(2) as usize], drawn(10));
            let (found, end) = number(text.as_bytes(), 0);
            assert_eq!((found, end), plainly(&text), "{text}");
            usual += usize::from(found.is_some());
        }
        assert!(usual > 5_000, "{usual}");
    }

    #[test]
    fn lines_of_one_layout_come_back_whatever_their_digits() {
        let mut seed = 5u64;
        let mut digit = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            // Zeros are what numbers are not written with as usual.
            [0, 0, 0, 1, 2, 5, 9][(seed >> 33) as usize % 7]
        };
        let mut text = String::new();
        for _ in 0..2000 {
            let [a, b, c, d, e, f, g] = std::array::from_fn(|_| digit());
            text.push_str(&format!("N{a} X{b}{c}.{d}0 Y-{e}.{f} Z-{g}{a} T.{b}\n"));
        }
        assert!(back(&text).is_some());
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
