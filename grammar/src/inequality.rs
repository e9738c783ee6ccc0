//! What must hold between numbers: `Z > -300 + 2 * abs(B)`.

use std::ops::Range;

use crate::expression::{Bounds, EvaluationFault, Expression, parse_expression};
use crate::fault::SyntaxFault;

/// Two expressions, one of which must not be less than the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Inequality {
    left: Expression,
    right: Expression,
    /// Bytes of the text before the right one.
    offset: usize,
    /// The left one is the larger.
    falls: bool,
}

/// Reads an inequality: two expressions ([`parse_expression`]) with one of `>`, `>=`, `<`, `<=` between them. Ends belong to
/// it: `>` is `>=`.
///
/// # Errors
/// What cannot be read.
pub fn parse_inequality(text: &str) -> Result<Inequality, SyntaxFault> {
    let help = "such as Z > -300 + 2 * abs(B)";
    let is_sign = |byte: char| matches!(byte, '<' | '>');
    let Some(at) = text.find(is_sign) else {
        let message = "one of > >= < <= is missing";
        return Err(SyntaxFault::new(text, text.len()..text.len(), message).help(help));
    };
    let offset = at + if text[at + 1..].starts_with('=') { 2 } else { 1 };
    if let Some(second) = text[offset..].find(is_sign) {
        let second = offset + second;
        let message = "one comparison is possible";
        return Err(SyntaxFault::new(text, second..second + 1, message)
            .help("write two limits, one for each"));
    }
    let part = |range: Range<usize>| {
        let start = range.start;
        parse_expression(&text[range]).map_err(|fault| SyntaxFault {
            text: text.to_owned(),
            span: fault.span.start + start..fault.span.end + start,
            ..fault
        })
    };
    Ok(Inequality {
        left: part(0..at)?,
        right: part(offset..text.len())?,
        offset,
        falls: text[at..].starts_with('>'),
    })
}

impl Inequality {
    /// Values of the left and the right expression, with `name` giving the value of each name.
    ///
    /// # Errors
    /// One of them has none.
    pub fn sides(&self, name: &dyn Fn(&str) -> Option<f64>) -> Result<[f64; 2], EvaluationFault> {
        Ok([self.left.evaluate(name)?, self.right.evaluate(name)?])
    }

    /// By how much it holds between the values of [`Inequality::sides`]; below zero where it does not.
    pub fn margin(&self, [left, right]: [f64; 2]) -> f64 {
        if self.falls { left - right } else { right - left }
    }

    /// A lower bound on the margin while each name stays within bounds of its own.
    pub fn least_margin(&self, name: &dyn Fn(&str) -> Option<Bounds>) -> f64 {
        let (left, right) = (self.left.bounds(name), self.right.bounds(name));
        let least = if self.falls { left[0] - right[1] } else { right[0] - left[1] };
        if least.is_nan() { f64::NEG_INFINITY } else { least }
    }

    /// An upper bound on the margin while each name stays within bounds of its own.
    pub fn most_margin(&self, name: &dyn Fn(&str) -> Option<Bounds>) -> f64 {
        let (left, right) = (self.left.bounds(name), self.right.bounds(name));
        let most = if self.falls { left[1] - right[0] } else { right[1] - left[0] };
        if most.is_nan() { f64::INFINITY } else { most }
    }

    /// The sign between the sides, as it is read: an end belongs to what holds.
    pub fn sign(&self) -> &'static str {
        if self.falls { "≥" } else { "≤" }
    }

    /// Where each name stands that it needs, bytes of the text, in the order written.
    pub fn references(&self) -> Vec<(Range<usize>, &str)> {
        let mut references = self.left.references();
        let right = self.right.references().into_iter();
        references.extend(
            right.map(|(span, name)| (span.start + self.offset..span.end + self.offset, name)),
        );
        references
    }
}
