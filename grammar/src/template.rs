//! Lines of a program with places for the numbers of a CL record: `G{n+53}`, `M{n}`, `G54.1 P{n2}`.

use std::fmt;

use crate::expression::{Expression, parse_expression};

/// Values from here on are no code of any control, and a slip.
const TOO_LARGE: f64 = 1e9;

/// A line of a program in which braces stand for whole numbers.
///
/// Between braces stands an expression of the machine file's language in which `n1`, `n2`, … are the numbers of the
/// record in their order and `n` is the first; `{1}`, `{2}`, … alone are the same as `{n1}`, `{n2}`.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    pieces: Vec<TemplatePart>,
}

#[derive(Clone, Debug, PartialEq)]
enum TemplatePart {
    Text(String),
    Value { text: String, expression: Expression },
}

/// Why a record does not fill a template.
#[derive(Clone, Debug, PartialEq)]
pub enum FillFault {
    /// The record has fewer numbers than the template asks for.
    Missing {
        /// Place of the number that is asked for, counted from 1.
        number: usize,
    },
    /// A value is no code.
    Value {
        /// What stands between the braces.
        text: String,
        /// Why not, as the end of a sentence that begins with the text.
        why: String,
    },
}

impl fmt::Display for FillFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { number } => {
                write!(formatter, "the record has no number {number}, which the rule asks for")
            }
            Self::Value { text, why } => write!(formatter, "{{{text}}} {why}"),
        }
    }
}

impl std::error::Error for FillFault {}

impl Template {
    /// Reads a template.
    ///
    /// # Errors
    /// What is wrong with it, as a sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.trim().is_empty() {
            return Err("a line of the program is empty".to_owned());
        }
        if text.contains(char::is_control) {
            return Err("a line of the program holds a line end or another control character; several lines are a list of texts".to_owned());
        }
        let mut pieces = Vec::new();
        let mut rest = text;
        while let Some(at) = rest.find(['{', '}']) {
            let (before, behind) = rest.split_at(at);
            let inner = behind.strip_prefix('{').ok_or("a `}` closes nothing")?;
            let (inner, behind) = inner.split_once('}').ok_or("a `}` is missing")?;
            if !before.is_empty() {
                pieces.push(TemplatePart::Text(before.to_owned()));
            }
            pieces.push(value(inner)?);
            rest = behind;
        }
        if !rest.is_empty() {
            pieces.push(TemplatePart::Text(rest.to_owned()));
        }
        Ok(Self { pieces })
    }

    /// How many numbers a record must have at least.
    pub fn numbers(&self) -> usize {
        let names = self.pieces.iter().flat_map(|piece| match piece {
            TemplatePart::Text(_) => Vec::new(),
            TemplatePart::Value { expression, .. } => expression.names(),
        });
        let places = names.filter_map(place);
        places.max().map_or(0, |last| last + 1)
    }

    /// The line for a record with these numbers.
    ///
    /// # Errors
    /// A number that is missing, and a value that is not whole or below zero.
    pub fn fill(&self, numbers: &[f64]) -> Result<String, FillFault> {
        if self.numbers() > numbers.len() {
            return Err(FillFault::Missing { number: numbers.len() + 1 });
        }
        let mut line = String::new();
        for piece in &self.pieces {
            match piece {
                TemplatePart::Text(text) => line.push_str(text),
                TemplatePart::Value { text, expression } => {
                    let fault = |why: String| FillFault::Value { text: text.clone(), why };
                    let value = expression
                        .evaluate(&|name| numbers.get(place(name)?).copied())
                        .map_err(|lack| fault(format!("has no value: {}", lack.message)))?;
                    let whole = libm::rint(value);
                    if libm::fabs(value - whole) > 1e-6 {
                        return Err(fault(format!("is {value}, and a code is a whole number")));
                    }
                    if !(0.0..TOO_LARGE).contains(&whole) {
                        return Err(fault(format!("is {value}, and codes go from 0 up")));
                    }
                    line.push_str(&(whole as u64).to_string());
                }
            }
        }
        Ok(line)
    }
}

/// What stands between braces.
fn value(text: &str) -> Result<TemplatePart, String> {
    let text = text.trim();
    let alone = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let expression =
        if alone { parse_expression(&format!("n{text}")) } else { parse_expression(text) }
            .map_err(|fault| format!("{{{text}}}: {}", fault.message))?;
    let names = expression.names();
    if names.is_empty() {
        return Err(format!(
            "{{{text}}} holds no number of the record: n is the first behind the slash, n2 the second"
        ));
    }
    if let Some(name) = names.iter().find(|name| place(name).is_none()) {
        return Err(format!(
            "{{{text}}}: {name} is no number of the record: n is the first behind the slash, n2 the second"
        ));
    }
    Ok(TemplatePart::Value { text: text.to_owned(), expression })
}

/// Which number of the record a name stands for, counted from 0: `n` and `n1` the first.
fn place(name: &str) -> Option<usize> {
    match name.strip_prefix('n')? {
        "" => Some(0),
        number => number.parse::<usize>().ok()?.checked_sub(1).filter(|place| *place < 100),
    }
}
