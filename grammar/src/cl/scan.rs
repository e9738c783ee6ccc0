//! The fast way to a record, by hand: bit for bit what pest makes of the line.
//!
//! It takes only what it is sure of. All else is left to pest, which reads it or says what is wrong.

use std::borrow::Cow;

use super::line::{LONGEST_WORD, LineItem, LogicalLine};
use super::record::Statement;
use super::statements::statement;
use super::vocabulary::{self, ArgumentForm};
use crate::decimal::{number, short_number};

/// A `GOTO` with three or six numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainGoto {
    /// The point and, if `has_axis`, the tool axis; else zeros.
    pub values: [f64; 6],
    /// Six numbers are given.
    pub has_axis: bool,
    /// Where the line ends, in bytes.
    pub end: usize,
}

impl PlainGoto {
    pub fn statement(&self) -> Statement {
        let [x, y, z, i, j, k] = self.values;
        Statement::Goto { point: [x, y, z], axis: self.has_axis.then_some([i, j, k]) }
    }
}

/// The plain `GOTO` at the start of `text`, which may run on after the line; `None` if the line is anything else
/// or in any way unusual.
#[inline(always)]
pub fn plain_goto(text: &[u8]) -> Option<PlainGoto> {
    let mut at = match text.strip_prefix(b"GOTO/") {
        Some(_) => 4,
        None => unusual_slash(text)?,
    };
    let mut values = [0.0; 6];
    let mut count = 0;
    loop {
        // After the slash or the comma.
        at += 1;
        (values[count], at) = match short_number(text, at) {
            Some(found) => found,
            None => number(text, skip_blanks(text, at))?,
        };
        count += 1;
        if count == 6 {
            break;
        }
        if text.get(at) != Some(&b',') {
            at = skip_blanks(text, at);
            if text.get(at) != Some(&b',') {
                break;
            }
        }
    }
    at = skip_blanks(text, at);
    let ends = matches!(text.get(at), None | Some(b'\n' | b'\r'));
    (ends && (count == 3 || count == 6)).then_some(PlainGoto {
        values,
        has_axis: count == 6,
        end: at,
    })
}

/// Where the slash after `GOTO` stands, with blanks before or after the word.
fn unusual_slash(text: &[u8]) -> Option<usize> {
    let at = skip_blanks(text, 0);
    if text.get(at..at + 4) != Some(b"GOTO") {
        return None;
    }
    let at = skip_blanks(text, at + 4);
    (text.get(at) == Some(&b'/')).then_some(at)
}

/// What the pieces of a record say that a `$` parted; most likely a `GOTO`.
pub(super) fn joined(raw: &[u8]) -> Option<Statement> {
    let plain = plain_goto(raw).filter(|plain| plain.end == raw.len());
    plain.map(|plain| plain.statement()).or_else(|| record(raw))
}

/// What a logical line says; `None` if it is unusual, or wrong.
pub fn record(raw: &[u8]) -> Option<Statement> {
    let text = std::str::from_utf8(raw).ok()?;
    let plain = is_plain(raw);
    if !plain && !raw.iter().all(|&byte| CLASSES[usize::from(byte)] & TEXT != 0) {
        return None;
    }
    let at = skip_blanks(raw, 0);
    if raw[at..].starts_with(b"$$") {
        let remark = text[at + 2..].trim();
        // `$$->` begins a directive.
        return (!remark.starts_with("->")).then(|| Statement::Remark(remark.to_owned()));
    }
    let end = at + run(&raw[at..], FREE_WORD);
    if !raw.get(at).is_some_and(u8::is_ascii_alphabetic)
        || raw[at..end].eq_ignore_ascii_case(b"TOOL")
    {
        return None;
    }
    let mut known = vocabulary::find(&text[at..end]);
    if let Some((spelling, word)) = known
        && let ArgumentForm::Text(read) = word.behind
    {
        let text = text[end..].trim_start_matches([' ', '\t']);
        let text = text.strip_prefix('/').unwrap_or(text).trim();
        let directive = spelling == "REMARK" && text.starts_with("->");
        return (!directive).then(|| read(spelling, text.to_owned()));
    }
    if !plain && !raw.is_ascii() {
        return None;
    }
    let rest = run(&raw[end..], WORD);
    let word_span = at..end + rest;
    if word_span.len() > LONGEST_WORD {
        return None;
    }
    if rest > 0 {
        known = vocabulary::find(&text[word_span.clone()]);
    }
    let behind = skip_blanks(raw, word_span.end);
    // `TLON,GOFWD/` has a form of its own.
    if raw.get(behind) == Some(&b',') {
        return None;
    }
    let slash = raw.get(behind) == Some(&b'/');
    let begin = behind + usize::from(slash);
    let parted = begin > word_span.end || ends(raw, begin);
    let line = LogicalLine {
        text,
        word: match known {
            Some((spelling, _)) => Cow::Borrowed(spelling),
            None => Cow::Owned(text[word_span.clone()].to_ascii_uppercase()),
        },
        known: known.map(|(_, word)| word),
        word_span,
        slash,
        items: items(text, begin)?,
    };
    // Pest says of a faulty one what is wrong.
    parted.then(|| statement(&line).ok()).flatten()
}

/// Items that nearly every statement keeps to.
const USUAL_ITEMS: usize = 12;

/// The items from `at` to the end of the statement.
fn items(text: &str, mut at: usize) -> Option<Vec<LineItem<'_>>> {
    let bytes = text.as_bytes();
    at = skip_blanks(bytes, at);
    let mut items = match ends(bytes, at) {
        true => Vec::new(),
        false => Vec::with_capacity(USUAL_ITEMS),
    };
    // Whether an item is due: at the beginning and after a comma.
    let mut due = true;
    loop {
        at = skip_blanks(bytes, at);
        if ends(bytes, at) {
            return Some(items);
        }
        let mut item = LineItem { text: "", start: at, value: None, comma_missing: false };
        if bytes[at] == b',' {
            if due {
                items.push(item);
            }
            due = true;
            at += 1;
            continue;
        }
        let mut end = at;
        if matches!(bytes[at], b'0'..=b'9' | b'.' | b'+' | b'-') {
            let (value, behind) = number(bytes, at)?;
            end = behind;
            item.value = Some(value);
        }
        if !ends_item(bytes, end) {
            item.value = None;
            end += run(&bytes[end..], NAME);
            // A single `$` may mean that the record goes on.
            if !ends_item(bytes, end) {
                return None;
            }
        }
        item.text = &text[at..end];
        item.comma_missing = !due;
        due = false;
        items.push(item);
        at = end;
    }
}

/// The statement ends here: at the end of the text or at a comment.
fn ends(text: &[u8], at: usize) -> bool {
    at >= text.len() || text[at..].starts_with(b"$$")
}

fn ends_item(text: &[u8], at: usize) -> bool {
    match text.get(at) {
        None | Some(b',' | b' ' | b'\t') => true,
        Some(b'$') => text.get(at + 1) == Some(&b'$'),
        Some(_) => false,
    }
}

/// A byte of a text: no control character but the tab.
const TEXT: u8 = 1;
/// A character that a word with free text after it may hold.
const FREE_WORD: u8 = 2;
/// A character of a major word.
const WORD: u8 = 4;
/// A character of an item; a `$` may begin a comment.
const NAME: u8 = 8;

/// What each byte may be.
const CLASSES: [u8; 256] = {
    let mut classes = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let character = byte as u8;
        let mut class = 0;
        if (character >= b' ' && character != 0x7F) || character == b'\t' {
            class |= TEXT;
        }
        if character.is_ascii_alphanumeric() || character == b'_' {
            class |= FREE_WORD | WORD;
        }
        if character == b'-' || character == b'.' {
            class |= WORD;
        }
        if !matches!(character, b',' | b' ' | b'\t' | b'$') {
            class |= NAME;
        }
        classes[byte] = class;
        byte += 1;
    }
    classes
};

/// How many bytes at the start are of a class.
fn run(text: &[u8], class: u8) -> usize {
    let end = text.iter().position(|&byte| CLASSES[usize::from(byte)] & class == 0);
    end.unwrap_or(text.len())
}

/// The bytes are all printable ASCII. Eight are looked at together.
fn is_plain(text: &[u8]) -> bool {
    const HIGH: u64 = 0x8080_8080_8080_8080;
    let (eights, rest) = text.as_chunks();
    let odd = eights.iter().fold(0, |odd, &eight| {
        let eight = u64::from_le_bytes(eight);
        // Below a blank the first wraps; 0x7F and what is beyond ASCII have the highest bit in one of the others.
        odd | eight.wrapping_sub(0x2020_2020_2020_2020)
            | eight.wrapping_add(0x0101_0101_0101_0101)
            | eight
    });
    odd & HIGH == 0 && rest.iter().all(|byte| matches!(byte, b' '..=b'~'))
}

#[inline(always)]
fn skip_blanks(text: &[u8], at: usize) -> usize {
    match text.get(at) {
        Some(b' ' | b'\t') => skip_further_blanks(text, at + 1),
        _ => at,
    }
}

fn skip_further_blanks(text: &[u8], mut at: usize) -> usize {
    while let Some(b' ' | b'\t') = text.get(at) {
        at += 1;
    }
    at
}
