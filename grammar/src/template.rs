//! Lines of a program with places for the numbers of a CL record: `G{n+53}`, `M{n}`, `G65 P9811 Z{n:.3}`.

use std::fmt;

use crate::expression::{Expression, parse_expression};

/// Values from here on are no code of any control, and a slip.
const TOO_LARGE: f64 = 1e9;

/// Name of the program's units that one unit of the CL file is.
const UNIT: &str = "unit";

/// Most decimals of a number.
const MOST_DECIMALS: u8 = 9;

/// A line of a program in which braces stand for numbers.
///
/// Between braces stands an expression of the machine file's language in which `n1`, `n2`, … are the numbers of the
/// record in their order and `n` is the first; `{1}`, `{2}`, … alone are the same as `{n1}`, `{n2}`. A value is a whole
/// number from 0 up; behind a colon stand the decimals of any other, `{n:.3}` always three, `{n:3}` at most three.
/// `unit` is how many units of the program one unit of the CL file is.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    pieces: Vec<TemplatePart>,
}

#[derive(Clone, Debug, PartialEq)]
enum TemplatePart {
    Text(String),
    Value { text: String, expression: Expression, digits: Digits },
}

/// How a value is printed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Digits {
    /// A whole number from 0 up.
    Code,
    /// So many decimals, those at the end that are zeros left out or not.
    Decimals { count: u8, zeros: bool },
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

    /// The first place whose value has decimals and does not say which unit they are of: where CL file and program count
    /// in other units, nobody knows whether it is a length.
    pub fn without_unit(&self) -> Option<&str> {
        self.pieces.iter().find_map(|piece| match piece {
            TemplatePart::Value { text, expression, digits: Digits::Decimals { .. } }
                if !expression.names().contains(&UNIT) =>
            {
                Some(text.as_str())
            }
            _ => None,
        })
    }

    /// Its texts in their order; none stands for a value.
    pub fn texts(&self) -> impl Iterator<Item = Option<&str>> {
        self.pieces.iter().map(|piece| match piece {
            TemplatePart::Text(text) => Some(text.as_str()),
            TemplatePart::Value { .. } => None,
        })
    }

    /// The line for a record with these numbers; `unit` units of the program are one of the CL file.
    ///
    /// # Errors
    /// A number that is missing, and a value that its place cannot print.
    pub fn fill(&self, numbers: &[f64], unit: f64) -> Result<String, FillFault> {
        if self.numbers() > numbers.len() {
            return Err(FillFault::Missing { number: numbers.len() + 1 });
        }
        let mut line = String::new();
        for piece in &self.pieces {
            match piece {
                TemplatePart::Text(text) => line.push_str(text),
                TemplatePart::Value { text, expression, digits } => {
                    let fault = |why: String| FillFault::Value { text: text.clone(), why };
                    let named = |name: &str| match name {
                        UNIT => Some(unit),
                        name => numbers.get(place(name)?).copied(),
                    };
                    let value = expression
                        .evaluate(&named)
                        .map_err(|lack| fault(format!("has no value: {}", lack.message)))?;
                    line.push_str(&digits.print(value).map_err(fault)?);
                }
            }
        }
        Ok(line)
    }
}

impl Digits {
    /// What stands behind the colon: `.3` or `3`.
    fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let digits = text.strip_prefix('.').unwrap_or(text);
        let one = digits.len() == 1 && digits.bytes().all(|byte| byte.is_ascii_digit());
        let count = digits.parse().ok().filter(|count| one && *count <= MOST_DECIMALS)?;
        Some(Self::Decimals { count, zeros: digits != text })
    }

    /// The value as it is printed; an error says why it is not, as the end of a sentence.
    fn print(self, value: f64) -> Result<String, String> {
        match self {
            Self::Code => {
                let whole = libm::rint(value);
                if libm::fabs(value - whole) > 1e-6 {
                    return Err(format!(
                        "is {value}, and a code is a whole number; {{n:.3}} prints decimals"
                    ));
                }
                if !(0.0..TOO_LARGE).contains(&whole) {
                    return Err(format!("is {value}, and codes go from 0 up"));
                }
                Ok((whole as u64).to_string())
            }
            Self::Decimals { count, zeros } => {
                if !(-TOO_LARGE..TOO_LARGE).contains(&value) {
                    return Err(format!("is {value}, which no control reads"));
                }
                let mut text = format!("{value:.*}", usize::from(count));
                if !zeros && text.contains('.') {
                    text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
                }
                let zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
                Ok(if zero { text.trim_start_matches('-').to_owned() } else { text })
            }
        }
    }
}

/// What stands between braces.
fn value(text: &str) -> Result<TemplatePart, String> {
    let (inner, digits) = match text.split_once(':') {
        None => (text.trim(), Digits::Code),
        Some((inner, decimals)) => {
            let digits = Digits::parse(decimals).ok_or_else(|| {
                format!("{{{text}}}: behind the colon stand decimals, .3 or 3 for at most three, 9 at most")
            })?;
            (inner.trim(), digits)
        }
    };
    let alone = !inner.is_empty() && inner.bytes().all(|byte| byte.is_ascii_digit());
    let expression =
        if alone { parse_expression(&format!("n{inner}")) } else { parse_expression(inner) }
            .map_err(|fault| format!("{{{text}}}: {}", fault.message))?;
    let names = expression.names();
    if let Some(name) = names.iter().find(|name| place(name).is_none() && **name != UNIT) {
        return Err(format!(
            "{{{text}}}: {name} is no number of the record: n is the first behind the slash, n2 the second"
        ));
    }
    if !names.iter().any(|name| place(name).is_some()) {
        return Err(format!(
            "{{{text}}} holds no number of the record: n is the first behind the slash, n2 the second"
        ));
    }
    Ok(TemplatePart::Value { text: text.trim().to_owned(), expression, digits })
}

/// Which number of the record a name stands for, counted from 0: `n` and `n1` the first.
fn place(name: &str) -> Option<usize> {
    match name.strip_prefix('n')? {
        "" => Some(0),
        number => number.parse::<usize>().ok()?.checked_sub(1).filter(|place| *place < 100),
    }
}
