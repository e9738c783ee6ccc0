//! The fast way to a block of words and numbers, by hand: what the grammars make of it, without an allocation.
//!
//! It takes only what it is sure of. All else is left to the grammars, which read it or say what is wrong.

use std::borrow::Cow;

use super::block::{NcBlock, NcItem, NcNumber, NcValue, NcWord, Notation};
use crate::decimal::decimal;

/// Reads the block at the start of `text`, which runs on after it, into `block`, and gives where its line ends. None if
/// it is anything but words with numbers, or if the line does not end within `text`: the block may hold part of it
/// then.
#[inline(always)]
pub(super) fn plain(text: &[u8], notation: Notation, block: &mut NcBlock) -> Option<usize> {
    match notation {
        Notation::Words => words(text, block),
        Notation::Conversational => conversational(text, block),
        Notation::Statements => None,
    }
}

/// `N10 G1 X10. Y-.5 A3=0.1`
#[inline(always)]
fn words(text: &[u8], block: &mut NcBlock) -> Option<usize> {
    let mut at = skip_blanks(text, 0);
    if let [b'N' | b'n', digit, ..] = text[at..]
        && digit.is_ascii_digit()
    {
        (block.number, at) = block_number(text, at + 1)?;
        at = skip_blanks(text, at);
    }
    loop {
        let first = *text.get(at)?;
        if is_end(first) {
            break;
        }
        let letter = first.to_ascii_uppercase();
        // The number of a block may be parted from its letter.
        let head = letter == b'N' && block.number.is_none() && block.items.is_empty();
        if !letter.is_ascii_uppercase() || letter == b'O' || head {
            return None;
        }
        let next = *text.get(at + 1)?;
        let item;
        (item, at) = if next == b'=' || text.get(at + 2) == Some(&b'=') {
            set(text, at, letter)?
        } else {
            let (number, end) = value(text, skip_blanks(text, at + 1))?;
            (word(letter, number), end)
        };
        if !ends_value(*text.get(at)?) {
            return None;
        }
        block.items.push(item);
        at = skip_blanks(text, at);
    }
    (!block.items.is_empty()).then_some(at)
}

/// `X=10`, `A3=0.5`, and where it ends.
#[inline(never)]
fn set(text: &[u8], at: usize, letter: u8) -> Option<(NcItem, usize)> {
    if text[at + 1] == b'=' {
        let (number, end) = value(text, at + 2)?;
        return Some((word(letter, number), end));
    }
    let name = address(letter, text[at + 1])?;
    let (number, end) = value(text, at + 3)?;
    Some((named(name, number), end))
}

/// `12 L X+10 Y-5.5 R0 FMAX M91`
#[inline(always)]
fn conversational(text: &[u8], block: &mut NcBlock) -> Option<usize> {
    let mut at = skip_blanks(text, 0);
    if text.get(at)?.is_ascii_digit() {
        (block.number, at) = block_number(text, at)?;
        if !is_blank(*text.get(at)?) {
            return None;
        }
        at = skip_blanks(text, at);
    }
    if let Some((name, length)) = keyword(&text[at..]) {
        at = skip_blanks(text, at + length);
        // A value after it would make it a word.
        let next = *text.get(at)?;
        if !next.is_ascii_alphabetic() && !is_end(next) || matches!(next, b'Q' | b'q') {
            return None;
        }
        block.items.push(NcItem::Name(Cow::Borrowed(name)));
    }
    loop {
        let first = *text.get(at)?;
        if is_end(first) {
            break;
        }
        if !first.is_ascii_uppercase() || first == b'Q' {
            return None;
        }
        let next = *text.get(at + 1)?;
        let item = if let Some((name, length)) = name(&text[at..]) {
            at += length;
            if !is_blank(*text.get(at)?) && !is_end(text[at]) {
                return None;
            }
            NcItem::Name(Cow::Borrowed(name))
        } else if first == b'I' && next.is_ascii_alphabetic() {
            if !next.is_ascii_uppercase() || next == b'Q' {
                return None;
            }
            let (number, end) = value(text, at + 2)?;
            at = end;
            NcItem::Word(NcWord { letter: next, incremental: true, value: NcValue::Number(number) })
        } else if let Some(name) = vector(first, next) {
            let (number, end) = value(text, at + 2)?;
            at = end;
            named(name, number)
        } else {
            let (number, end) = value(text, at + 1)?;
            at = end;
            word(first, number)
        };
        if !ends_value(*text.get(at)?) {
            return None;
        }
        block.items.push(item);
        at = skip_blanks(text, at);
    }
    (!block.items.is_empty()).then_some(at)
}

fn word(letter: u8, number: NcNumber) -> NcItem {
    NcItem::Word(NcWord { letter, incremental: false, value: NcValue::Number(number) })
}

fn named(name: &'static str, number: NcNumber) -> NcItem {
    NcItem::Named { name: Cow::Borrowed(name), value: NcValue::Number(number) }
}

/// The number at `at`, and where it ends.
#[inline(always)]
fn value(text: &[u8], at: usize) -> Option<(NcNumber, usize)> {
    // A `+` says nothing; what follows it has no sign.
    let signed = matches!(text.get(at + 1), Some(b'+' | b'-'));
    let plus = usize::from(text.get(at) == Some(&b'+') && !signed);
    let found = decimal(text, at + plus)?;
    let number = NcNumber { value: found.value, point: found.point };
    Some((number, found.end))
}

/// The number of a block: digits alone.
#[inline(always)]
fn block_number(text: &[u8], at: usize) -> Option<(Option<u64>, usize)> {
    let found = decimal(text, at)?;
    (!found.point).then_some((Some(found.value as u64), found.end))
}

/// Tool axes and radii of word programs.
#[inline(always)]
fn address(first: u8, second: u8) -> Option<&'static str> {
    Some(match (first, second.to_ascii_uppercase()) {
        (b'A', b'3') => "A3",
        (b'B', b'3') => "B3",
        (b'C', b'3') => "C3",
        (b'C', b'R') => "CR",
        _ => return None,
    })
}

/// Tool axes and normals of conversational programs.
#[inline(always)]
fn vector(first: u8, second: u8) -> Option<&'static str> {
    Some(match (first, second) {
        (b'T', b'X') => "TX",
        (b'T', b'Y') => "TY",
        (b'T', b'Z') => "TZ",
        (b'N', b'X') => "NX",
        (b'N', b'Y') => "NY",
        (b'N', b'Z') => "NZ",
        _ => return None,
    })
}

/// What a conversational block does, and how long the word is; a blank or the line's end follows.
#[inline(always)]
fn keyword(text: &[u8]) -> Option<(&'static str, usize)> {
    let (name, length) = match text {
        [b'L', b'N', ..] => ("LN", 2),
        [b'L', ..] => ("L", 1),
        [b'C', b'C', ..] => ("CC", 2),
        [b'C', b'R', ..] => ("CR", 2),
        [b'C', ..] => ("C", 1),
        _ => return None,
    };
    let ends = text.get(length).is_some_and(|&next| is_blank(next) || is_end(next));
    ends.then_some((name, length))
}

/// A name that comes with motions.
#[inline(always)]
fn name(text: &[u8]) -> Option<(&'static str, usize)> {
    Some(match text {
        [b'F', b'M', b'A', b'X', ..] => ("FMAX", 4),
        [b'R', b'0', ..] => ("R0", 2),
        [b'R', b'L', ..] => ("RL", 2),
        [b'R', b'R', ..] => ("RR", 2),
        [b'D', b'R', b'+', ..] => ("DR+", 3),
        [b'D', b'R', b'-', ..] => ("DR-", 3),
        _ => return None,
    })
}

#[inline(always)]
fn skip_blanks(text: &[u8], mut at: usize) -> usize {
    while text.get(at).is_some_and(|&byte| is_blank(byte)) {
        at += 1;
    }
    at
}

#[inline(always)]
fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t')
}

#[inline(always)]
fn is_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

/// What may follow a number: anything else makes more of it than a number.
#[inline(always)]
fn ends_value(byte: u8) -> bool {
    is_blank(byte) || is_end(byte) || byte.is_ascii_alphabetic()
}
