//! A statement of a robot's language, as a tree of its parts: `MoveAbsJ [[0,0,0,0,30,0],[9E9]],v100,fine,tool0;`,
//! `PTP {A1 0,A2 -90}`, `movej([d2r(0),d2r(-90)], t=0.5)`. What a statement does is for those who know the language.

use super::block::{NcBlock, NcItem, NcTerm};
use super::fault::Unreadable;
use super::number;

type Parsed<T> = Result<T, Unreadable>;

/// Reads the statement `code`, in capitals and without remarks; `original` is the same as it was written.
pub(super) fn parse(code: &str, original: &str, block: &mut NcBlock) -> Parsed<()> {
    let mut line = StatementLine { code, original, at: 0 };
    let terms = line.terms(None)?;
    if !terms.is_empty() {
        block.items.push(NcItem::Statement(terms));
    }
    Ok(())
}

/// A line and how far it is read.
struct StatementLine<'t> {
    code: &'t str,
    original: &'t str,
    /// Byte that comes next.
    at: usize,
}

impl<'t> StatementLine<'t> {
    /// The terms up to the bracket that closes what began with `open` at its place, or to the end of the line.
    fn terms(&mut self, open: Option<(u8, usize)>) -> Parsed<Vec<NcTerm>> {
        let mut terms = Vec::new();
        loop {
            let rest = self.code[self.at..].trim_start();
            self.at = self.code.len() - rest.len();
            let Some(next) = rest.bytes().next() else {
                return match open {
                    None => Ok(terms),
                    Some((open, at)) => {
                        let message =
                            format!("this `{}` is not closed in its line", char::from(open));
                        let fault = Unreadable::new(message).at(at..at + 1);
                        Err(fault.help("a statement stands in one line here"))
                    }
                };
            };
            let term = match next {
                b'(' | b'[' | b'{' => {
                    let begins = self.at;
                    self.at += 1;
                    NcTerm::Group(next, self.terms(Some((next, begins)))?)
                }
                b')' | b']' | b'}' => {
                    if open.map(|(open, _)| closing(open)) != Some(next) {
                        let message = format!("`{}` closes nothing", char::from(next));
                        return Err(Unreadable::new(message).at(self.at..self.at + 1));
                    }
                    self.at += 1;
                    return Ok(terms);
                }
                b'"' | b'\'' => NcTerm::Text(self.text(char::from(next))?),
                b'0'..=b'9' | b'.' => NcTerm::Number(self.number()?),
                b'+' | b'-' if !ends_value(terms.last()) && self.number_follows() => {
                    self.at += 1;
                    NcTerm::Number(self.number()?.signed(next == b'-'))
                }
                _ if begins_name(next) => NcTerm::Name(self.name().to_owned()),
                _ => {
                    let length = rest.chars().next().map_or(1, char::len_utf8);
                    self.at += length;
                    NcTerm::Sign(next)
                }
            };
            terms.push(term);
        }
    }

    fn number_follows(&self) -> bool {
        let next = self.code.as_bytes().get(self.at + 1);
        next.is_some_and(|next| next.is_ascii_digit() || *next == b'.')
    }

    /// A number without a sign, `9E9` and `1.5e-3` among them.
    fn number(&mut self) -> Parsed<super::block::NcNumber> {
        let rest = &self.code.as_bytes()[self.at..];
        let digits =
            |from: usize| rest[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        let mut length = digits(0);
        if rest.get(length) == Some(&b'.') {
            length += 1 + digits(length + 1);
        }
        if rest.get(length) == Some(&b'E') {
            let sign = usize::from(matches!(rest.get(length + 1), Some(b'+' | b'-')));
            let exponent = digits((length + 1 + sign).min(rest.len()));
            if exponent > 0 {
                length += 1 + sign + exponent;
            }
        }
        let begins = self.at;
        self.at += length;
        let read = number::number(&self.code[begins..self.at]);
        read.map_err(|fault| fault.at(begins..begins + length))
    }

    fn name(&mut self) -> &'t str {
        let rest = &self.code[self.at..];
        let length = rest
            .bytes()
            .take_while(|byte| begins_name(*byte) || byte.is_ascii_digit() || *byte == b'.');
        let name = &rest[..length.count()];
        self.at += name.len();
        name
    }

    /// What stands between two of `mark`, as it was written.
    fn text(&mut self, mark: char) -> Parsed<String> {
        let begins = self.at + 1;
        let Some(length) = self.code[begins..].find(mark) else {
            let fault = Unreadable::new(format!("this `{mark}` is not closed"));
            return Err(fault.at(self.at..begins));
        };
        self.at = begins + length + 1;
        Ok(self.original.get(begins..begins + length).unwrap_or_default().to_owned())
    }
}

/// What closes a bracket.
fn closing(open: u8) -> u8 {
    match open {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

fn begins_name(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$')
}

/// Behind a value a sign takes away, and is none of the number.
fn ends_value(term: Option<&NcTerm>) -> bool {
    matches!(term, Some(NcTerm::Number(_) | NcTerm::Group(..)))
}
