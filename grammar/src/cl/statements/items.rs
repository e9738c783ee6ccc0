//! The items of a line, one by one, and what is said when one is not what it should be.

use std::borrow::Cow;
use std::ops::Range;

use super::{Read, other};
use crate::cl::line::{LineItem, LogicalLine, SHOWN};
use crate::cl::record::{Direction, Point, Statement};
use crate::fault::SyntaxFault;
use crate::text::excerpt;

/// The items of a line, taken one by one.
pub(crate) struct Items<'l, 't> {
    pub(super) line: &'l LogicalLine<'t>,
    pub(super) next: usize,
}

impl<'l, 't> Items<'l, 't> {
    pub(super) fn peek(&self) -> Option<&'l LineItem<'t>> {
        self.line.items.get(self.next)
    }

    pub(super) fn take(&mut self) -> Option<&'l LineItem<'t>> {
        let item = self.peek()?;
        self.next += 1;
        Some(item)
    }

    /// The next item, if it is a number.
    pub(super) fn take_number(&mut self) -> Option<f64> {
        let value = self.peek()?.value?;
        self.next += 1;
        Some(value)
    }

    /// The number that must follow `word`.
    pub(super) fn number(&mut self, word: &str, form: &str) -> Read<f64> {
        match self.peek() {
            Some(LineItem { value: Some(value), .. }) => {
                self.next += 1;
                Ok(*value)
            }
            Some(item) => Err(self.unexpected(item, &format!("a number must follow {word}"), form)),
            None => Err(self.fault(self.rest(), format!("a number must follow {word}"), form)),
        }
    }

    /// A tool or register number.
    pub(super) fn whole(&mut self, word: &str, form: &str) -> Read<u32> {
        let span = self.peek().map_or_else(|| self.rest(), LineItem::span);
        let value = self.number(word, form)?;
        if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
            return Ok(value as u32);
        }
        Err(self.fault(span, format!("{value} is no whole number from 0 up"), form))
    }

    /// All items, as numbers, at least one.
    pub(super) fn numbers(&self, form: &str) -> Read<Vec<f64>> {
        let number = |item: &LineItem<'_>| {
            item.value.ok_or_else(|| self.unexpected(item, "a number is expected", form))
        };
        let numbers: Vec<f64> = self.line.items.iter().map(number).collect::<Read<_>>()?;
        if numbers.is_empty() {
            let message = format!("{} needs numbers", self.line.word);
            return Err(self.fault(self.rest(), message, form));
        }
        Ok(numbers)
    }

    /// All items, if they are exactly `N` numbers.
    fn exactly<const N: usize>(&self) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        if self.line.items.len() != N {
            return None;
        }
        for (number, item) in numbers.iter_mut().zip(&self.line.items) {
            *number = item.value?;
        }
        Some(numbers)
    }

    /// All items, as exactly `N` numbers.
    pub(super) fn array<const N: usize>(&self, form: &str) -> Read<[f64; N]> {
        match self.exactly() {
            Some(numbers) => Ok(numbers),
            None => Err(self.miscounted(&N.to_string(), self.numbers(form)?.len(), form)),
        }
    }

    /// All items: a point, or a point and a tool axis.
    pub(super) fn point(&self, form: &str) -> Read<(Point, Option<Direction>)> {
        self.point_or("3 or 6", form)
    }

    /// [`Items::point`], where `counts` says how many numbers there may be in all forms of the word.
    pub(super) fn point_or(&self, counts: &str, form: &str) -> Read<(Point, Option<Direction>)> {
        if let Some(point) = self.exactly() {
            return Ok((point, None));
        }
        match self.exactly() {
            Some([x, y, z, i, j, k]) => Ok(([x, y, z], Some([i, j, k]))),
            None => Err(self.miscounted(counts, self.numbers(form)?.len(), form)),
        }
    }

    /// A statement that takes no items.
    pub(super) fn nothing(&self, statement: Statement) -> Read<Statement> {
        match self.peek() {
            None => Ok(statement),
            Some(_) => {
                let message = format!("nothing is expected behind {}", self.line.word);
                Err(SyntaxFault::new(self.line.text, self.rest(), message))
            }
        }
    }

    /// The first item is a word without a meaning here.
    pub(super) fn other(&self) -> Read<Statement> {
        Ok(other(self.line, false))
    }

    /// Bytes from the next item to the end of the last one; the place after the word or the last item if none is left.
    pub(super) fn rest(&self) -> Range<usize> {
        let items = &self.line.items;
        let end = items
            .last()
            .map_or(self.line.word_span.end + usize::from(self.line.slash), |item| item.span().end);
        let end = end.min(self.line.text.len());
        self.peek().map_or(end, |item| item.start)..end
    }

    pub(super) fn fault(
        &self,
        span: Range<usize>,
        message: impl Into<String>,
        form: &str,
    ) -> SyntaxFault {
        SyntaxFault::new(self.line.text, span, message).help(format!("expected {form}"))
    }

    pub(super) fn unexpected(&self, item: &LineItem<'_>, message: &str, form: &str) -> SyntaxFault {
        let message = match item.text {
            "" => format!("{message}, nothing stands between the commas"),
            text => format!("{message}, not `{}`", excerpt(text, SHOWN)),
        };
        self.fault(item.span(), message, form)
    }

    pub(super) fn miscounted(&self, expected: &str, found: usize, form: &str) -> SyntaxFault {
        let verb = if found == 1 { "is" } else { "are" };
        let message = format!("{} takes {expected} numbers, {found} {verb} given", self.line.word);
        self.fault(self.line.items[0].start..self.rest().end, message, form)
    }
}

/// The item as a word in capitals; empty if it is a number.
pub(super) fn word<'t>(item: &LineItem<'t>) -> Cow<'t, str> {
    match item.value {
        Some(_) => Cow::Borrowed(""),
        None if item.text.bytes().any(|byte| byte.is_ascii_lowercase()) => {
            Cow::Owned(item.text.to_ascii_uppercase())
        }
        None => Cow::Borrowed(item.text),
    }
}
