//! The expressions that stand for numbers in a machine file. Angles are in degrees.

mod bounds;
mod linear;
mod slope;

use crate::fault::SyntaxFault;
use pest::Parser;
use pest::error::InputLocation;
use pest::iterators::Pair;
use pest::pratt_parser::{Assoc, Op, PrattParser};
use pest_derive::Parser;
use std::error::Error;
use std::fmt;
use std::ops::Range;
use std::sync::LazyLock;

pub use bounds::Bounds;
pub use linear::LinearForm;
pub use slope::Slope;

#[derive(Parser)]
#[grammar = "expression.pest"]
struct ExpressionGrammar;

/// Longest text, in bytes, and deepest nesting of parentheses: the parser calls itself, and no machine file needs more.
const LONGEST: usize = 4096;
const DEEPEST: usize = 64;

static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    PrattParser::new()
        .op(Op::infix(Rule::add, Assoc::Left) | Op::infix(Rule::subtract, Assoc::Left))
        .op(Op::infix(Rule::multiply, Assoc::Left) | Op::infix(Rule::divide, Assoc::Left))
        .op(Op::prefix(Rule::minus))
        .op(Op::infix(Rule::power, Assoc::Right))
});

/// The functions that an expression may call.
pub const FUNCTIONS: [&str; 11] =
    ["sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "abs", "min", "max"];

/// A number, written as a formula of named numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    span: Range<usize>,
    term: Term,
}

#[derive(Clone, Debug, PartialEq)]
enum Term {
    Number(f64),
    Name(String),
    Negative(Box<Expression>),
    Binary(Box<Expression>, Operator, Box<Expression>),
    Call(Function, Vec<Expression>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    Sqrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Abs,
    Min,
    Max,
}

/// An expression that has no value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EvaluationFault {
    /// The part of the text that has none, in bytes.
    pub span: Range<usize>,
    /// Why not.
    pub message: String,
}

impl fmt::Display for EvaluationFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl Error for EvaluationFault {}

/// Reads an expression: numbers, names, `+ - * / ^`, parentheses, `pi` and
/// `sqrt sin cos tan asin acos atan atan2(y,x) abs min max`, with angles in degrees.
///
/// `^` binds tighter than the minus before it (`-2^2` is -4) and goes from right to left.
pub fn parse_expression(text: &str) -> Result<Expression, SyntaxFault> {
    if text.len() > LONGEST {
        return Err(SyntaxFault::new(
            text,
            0..text.len(),
            format!("an expression has at most {LONGEST} bytes"),
        ));
    }
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            return Err(SyntaxFault::new(
                text,
                at..at + 1,
                format!("more than {DEEPEST} parentheses are open"),
            ));
        }
    }
    let mut pairs = ExpressionGrammar::parse(Rule::expression, text).map_err(|error| {
        let at = match error.location {
            InputLocation::Pos(at) => at,
            InputLocation::Span((at, _)) => at,
        };
        unreadable(text, at)
    })?;
    let sum = pairs.next().and_then(|expression| expression.into_inner().next());
    build(text, sum.expect("an expression holds a sum"))
}

/// The fault of an expression that pest could not go on with at `at`.
fn unreadable(text: &str, at: usize) -> SyntaxFault {
    let before = text[..at].trim_end().chars().next_back();
    let next = text[at..].chars().next();
    let span = at..at + next.map_or(0, char::len_utf8);
    let value_due = before.is_none_or(|before| "+-*/^(,".contains(before));
    let message = match next {
        None if value_due => "a number or a name is missing at the end".to_owned(),
        None => "a `)` is missing".to_owned(),
        Some(other) if value_due => format!("a number or a name is expected, not `{other}`"),
        Some(')') => "this `)` closes nothing".to_owned(),
        Some(',') => {
            "a `,` belongs between the arguments of a function; decimals have a point".to_owned()
        }
        Some(other) => format!("an operator is expected, not `{other}`"),
    };
    SyntaxFault::new(text, span, message)
}

fn build(text: &str, pair: Pair<'_, Rule>) -> Result<Expression, SyntaxFault> {
    let span = pair.as_span().start()..pair.as_span().end();
    let term = match pair.as_rule() {
        Rule::number => match pair.as_str().parse::<f64>() {
            Ok(value) if value.is_finite() => Term::Number(value),
            _ => return Err(SyntaxFault::new(text, span, "this number is too large")),
        },
        Rule::name => Term::Name(pair.as_str().to_owned()),
        Rule::call => return call(text, pair),
        _ => {
            return PRECEDENCE
                .map_primary(|primary| build(text, primary))
                .map_prefix(|minus, operand| {
                    let operand = operand?;
                    Ok(Expression {
                        span: minus.as_span().start()..operand.span.end,
                        term: Term::Negative(Box::new(operand)),
                    })
                })
                .map_infix(|left, operator, right| {
                    let (left, right) = (left?, right?);
                    let operator = match operator.as_rule() {
                        Rule::add => Operator::Add,
                        Rule::subtract => Operator::Subtract,
                        Rule::multiply => Operator::Multiply,
                        Rule::divide => Operator::Divide,
                        _ => Operator::Power,
                    };
                    Ok(Expression {
                        span: left.span.start..right.span.end,
                        term: Term::Binary(Box::new(left), operator, Box::new(right)),
                    })
                })
                .parse(pair.into_inner());
        }
    };
    Ok(Expression { span, term })
}

fn call(text: &str, pair: Pair<'_, Rule>) -> Result<Expression, SyntaxFault> {
    let span = pair.as_span().start()..pair.as_span().end();
    let mut parts = pair.into_inner();
    let name = parts.next().expect("a call has a name");
    let name_span = name.as_span().start()..name.as_span().end();
    let arguments: Vec<Expression> =
        parts.map(|part| build(text, part)).collect::<Result<_, _>>()?;
    let Some(function) = Function::named(name.as_str()) else {
        let message = format!("there is no function `{}`", name.as_str());
        return Err(SyntaxFault::new(text, name_span, message)
            .help(format!("there are {}", FUNCTIONS.join(" "))));
    };
    let (fits, wanted) = match function {
        Function::Atan2 => (arguments.len() == 2, "two arguments, y and x"),
        Function::Min | Function::Max => (!arguments.is_empty(), "at least one argument"),
        _ => (arguments.len() == 1, "one argument"),
    };
    if !fits {
        let message = format!("{} takes {wanted}, {} given", name.as_str(), arguments.len());
        return Err(SyntaxFault::new(text, span, message));
    }
    Ok(Expression { span, term: Term::Call(function, arguments) })
}

impl Function {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "sqrt" => Self::Sqrt,
            "sin" => Self::Sin,
            "cos" => Self::Cos,
            "tan" => Self::Tan,
            "asin" => Self::Asin,
            "acos" => Self::Acos,
            "atan" => Self::Atan,
            "atan2" => Self::Atan2,
            "abs" => Self::Abs,
            "min" => Self::Min,
            "max" => Self::Max,
            _ => return None,
        })
    }
}

impl Expression {
    /// The value, with `name` giving the value of each name but `pi`. Every step must be finite.
    pub fn evaluate(&self, name: &dyn Fn(&str) -> Option<f64>) -> Result<f64, EvaluationFault> {
        let value = match &self.term {
            Term::Number(value) => *value,
            Term::Name(pi) if pi == "pi" => std::f64::consts::PI,
            Term::Name(unknown) => {
                name(unknown).ok_or_else(|| self.fault(format!("`{unknown}` is not known")))?
            }
            Term::Negative(operand) => -operand.evaluate(name)?,
            Term::Binary(left, operator, right) => {
                let (left, right) = (left.evaluate(name)?, right.evaluate(name)?);
                match operator {
                    Operator::Add => left + right,
                    Operator::Subtract => left - right,
                    Operator::Multiply => left * right,
                    Operator::Divide if right == 0.0 => {
                        return Err(self.fault("division by zero".to_owned()));
                    }
                    Operator::Divide => left / right,
                    Operator::Power => libm::pow(left, right),
                }
            }
            Term::Call(function, arguments) => {
                let values = arguments
                    .iter()
                    .map(|argument| argument.evaluate(name))
                    .collect::<Result<Vec<_>, _>>()?;
                function.value(&values)
            }
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.fault("this has no finite value".to_owned()))
        }
    }

    /// Where each name stands that it needs, bytes of the text, in the order written: a name as often as it is written.
    pub fn references(&self) -> Vec<(Range<usize>, &str)> {
        let mut references = Vec::new();
        self.collect_references(&mut references);
        references
    }

    fn collect_references<'a>(&'a self, references: &mut Vec<(Range<usize>, &'a str)>) {
        match &self.term {
            Term::Number(_) => {}
            Term::Name(name) => {
                if name != "pi" {
                    references.push((self.span.clone(), name));
                }
            }
            Term::Negative(operand) => operand.collect_references(references),
            Term::Binary(left, _, right) => {
                left.collect_references(references);
                right.collect_references(references);
            }
            Term::Call(_, arguments) => {
                arguments.iter().for_each(|argument| argument.collect_references(references))
            }
        }
    }

    /// The names it needs, each once, in the order written.
    pub fn names(&self) -> Vec<&str> {
        let mut names = Vec::new();
        for (_, name) in self.references() {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names
    }

    fn fault(&self, message: String) -> EvaluationFault {
        EvaluationFault { span: self.span.clone(), message }
    }
}

impl Function {
    /// The function's value; not finite where there is none: the root of -1, the tangent of 90°.
    fn value(self, arguments: &[f64]) -> f64 {
        let x = arguments[0];
        match self {
            Self::Sqrt => x.sqrt(),
            Self::Sin => sine_cosine(x).0,
            Self::Cos => sine_cosine(x).1,
            Self::Tan => {
                let (sine, cosine) = sine_cosine(x);
                sine / cosine
            }
            Self::Asin => libm::asin(x).to_degrees(),
            Self::Acos => libm::acos(x).to_degrees(),
            Self::Atan => libm::atan(x).to_degrees(),
            Self::Atan2 => libm::atan2(x, arguments[1]).to_degrees(),
            Self::Abs => x.abs(),
            Self::Min => arguments.iter().copied().fold(x, f64::min),
            Self::Max => arguments.iter().copied().fold(x, f64::max),
        }
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90: a direction of `cos(90)` must be 0, not 6e-17.
fn sine_cosine(degrees: f64) -> (f64, f64) {
    let turn = degrees % 360.0;
    let quarter = (turn / 90.0).round();
    let (sine, cosine) = libm::sincos((turn - 90.0 * quarter).to_radians());
    let (sine, cosine) = match (quarter as i32).rem_euclid(4) {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    };
    // Zero has no sign here.
    (sine + 0.0, cosine + 0.0)
}
