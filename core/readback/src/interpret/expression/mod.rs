//! Expressions are worked out: arithmetic in f64, angles in degrees. Where controls would answer differently, or an
//! answer depends on their rounding, it is refused.

use post_grammar::nc::{BinaryOperator, NcExpression, NcValue, UnaryOperator};
use post_machine::diagnostic::Diagnostic;
use post_plugin::Language;

use super::variables::{VariableValue, Variables};

/// Expressions inside one another.
const DEEPEST: usize = 100;

/// Bytes of a text that is put together.
const LONGEST_TEXT: usize = 10_000;

/// Two numbers that differ by less than this share of the larger, and are not equal: whether a control takes them for
/// equal depends on how many digits it keeps.
const CLOSE: f64 = 1e-9;

/// `EQ` and `NE` of RS-274/NGC take numbers for equal that differ by less.
const RS274_EQUAL: f64 = 1e-4;

type Answer<T> = Result<T, Box<Diagnostic>>;

impl Variables {
    /// The number that a value stands for; of a position approached in a way of its own the position.
    ///
    /// # Errors
    /// It cannot be worked out, or is a text.
    pub fn worth(&self, value: &NcValue) -> Answer<f64> {
        match value {
            NcValue::Number(number) => Ok(number.value),
            NcValue::Expression(expression) => self.number(expression),
            NcValue::Text(text) => Err(no_number(text)),
            NcValue::Approached(_, inner) => self.worth(inner),
        }
    }

    /// The number that an expression gives.
    ///
    /// # Errors
    /// It cannot be worked out, or is a text.
    pub fn number(&self, expression: &NcExpression) -> Answer<f64> {
        self.number_at(expression, 0)
    }

    /// The number or text that an expression gives.
    ///
    /// # Errors
    /// It cannot be worked out.
    pub fn value(&self, expression: &NcExpression) -> Answer<VariableValue> {
        self.value_at(expression, 0)
    }

    /// Whether a condition holds.
    ///
    /// # Errors
    /// It cannot be worked out.
    pub fn holds(&self, condition: &NcExpression) -> Answer<bool> {
        Ok(self.number(condition)? != 0.0)
    }

    /// The name of the variable that an expression on the left of `=` means.
    ///
    /// # Errors
    /// It is no variable, or its index cannot be worked out.
    pub fn named(&self, variable: &NcExpression) -> Answer<String> {
        self.named_at(variable, 0)
    }

    fn named_at(&self, variable: &NcExpression, depth: usize) -> Answer<String> {
        match variable {
            NcExpression::Variable(name) => Ok(canonical(name)),
            // Of the control's own it does not matter which.
            NcExpression::Indexed { name, .. } if name.starts_with('$') => Ok(name.clone()),
            NcExpression::Indexed { name, index } => {
                let index = whole(self.number_at(index, depth + 1)?, "an index")?;
                Ok(match name.as_str() {
                    // `R[1]` is `R1`.
                    "#" | "R" | "Q" | "QL" | "QR" | "QS" => format!("{name}{index}"),
                    field => format!("{field}[{index}]"),
                })
            }
            _ => Err(fault("what stands in front of `=` is no variable")),
        }
    }

    fn number_at(&self, expression: &NcExpression, depth: usize) -> Answer<f64> {
        match self.value_at(expression, depth)? {
            VariableValue::Number(number) => Ok(number),
            VariableValue::Text(text) => Err(no_number(&text)),
        }
    }

    fn value_at(&self, expression: &NcExpression, depth: usize) -> Answer<VariableValue> {
        if depth > DEEPEST {
            return Err(fault(&format!(
                "an expression has more than {DEEPEST} others inside one another"
            )));
        }
        let number = match expression {
            NcExpression::Number(number) => *number,
            NcExpression::Text(text) => return Ok(VariableValue::Text(text.clone())),
            NcExpression::Variable(name) if self.constant(name).is_some() => {
                self.constant(name).unwrap_or_default()
            }
            NcExpression::Variable(_) | NcExpression::Indexed { .. } => {
                return self.get(&self.named_at(expression, depth)?).cloned();
            }
            NcExpression::Unary(operator, inner) => {
                let inner = self.number_at(inner, depth + 1)?;
                match operator {
                    UnaryOperator::Minus => -inner,
                    UnaryOperator::Not => truth(inner == 0.0),
                }
            }
            NcExpression::Binary(operator, left, right) => {
                let left = self.value_at(left, depth + 1)?;
                let right = self.value_at(right, depth + 1)?;
                return self.binary(*operator, left, right);
            }
            NcExpression::Function { name, arguments } => {
                let mut values = Vec::with_capacity(arguments.len());
                for argument in arguments {
                    values.push(self.number_at(argument, depth + 1)?);
                }
                self.function(name, &values)?
            }
        };
        finite(number).map(VariableValue::Number)
    }

    /// Names that stand for a number.
    fn constant(&self, name: &str) -> Option<f64> {
        match (self.language(), name) {
            (Language::Names | Language::Conversational, "PI") | (Language::Names, "$PI") => {
                Some(std::f64::consts::PI)
            }
            (Language::Names, "TRUE") => Some(1.0),
            (Language::Names, "FALSE") => Some(0.0),
            _ => None,
        }
    }

    fn binary(
        &self,
        operator: BinaryOperator,
        left: VariableValue,
        right: VariableValue,
    ) -> Answer<VariableValue> {
        use BinaryOperator as B;
        if operator == B::Join {
            return joined(text(left), &text(right));
        }
        let (left, right) = match (left, right) {
            (VariableValue::Number(left), VariableValue::Number(right)) => (left, right),
            (VariableValue::Text(left), VariableValue::Text(right)) => {
                return match operator {
                    B::Equal => Ok(VariableValue::Number(truth(left == right))),
                    B::NotEqual => Ok(VariableValue::Number(truth(left != right))),
                    _ => Err(no_number(&left)),
                };
            }
            (VariableValue::Text(text), _) | (_, VariableValue::Text(text)) => {
                return Err(no_number(&text));
            }
        };
        let answer = match operator {
            B::Add => left + right,
            B::Subtract => left - right,
            B::Multiply => left * right,
            B::Divide if right == 0.0 => return Err(fault(&format!("{left} is divided by zero"))),
            B::Divide => left / right,
            B::Remainder => self.remainder(left, right)?,
            B::WholeQuotient => {
                let (left, right) = (whole(left, "DIV")?, whole(right, "DIV")?);
                let quotient = left.checked_div(right);
                quotient.ok_or_else(|| fault(&format!("{left} is divided by zero")))? as f64
            }
            B::Power if left < 0.0 && libm::trunc(right) != right => {
                return Err(fault(&format!("{left} to the power of {right} is no number")));
            }
            B::Power => libm::pow(left, right),
            B::Equal => truth(self.equal(left, right)?),
            B::NotEqual => truth(!self.equal(left, right)?),
            B::Less => truth(self.ordered(left, right)? && left < right),
            B::LessOrEqual => truth(left == right || self.ordered(left, right)? && left < right),
            B::Greater => truth(self.ordered(left, right)? && left > right),
            B::GreaterOrEqual => truth(left == right || self.ordered(left, right)? && left > right),
            B::And | B::Or | B::Xor => self.logical(operator, left, right)?,
            B::Join => 0.0,
        };
        finite(answer).map(VariableValue::Number)
    }

    fn equal(&self, left: f64, right: f64) -> Answer<bool> {
        if self.language() == Language::Rs274 {
            return Ok(libm::fabs(left - right) < RS274_EQUAL);
        }
        Ok(left == right || !self.ordered(left, right)?)
    }

    /// True, or a fault where two values are so near that a control's rounding decides which is larger.
    fn ordered(&self, left: f64, right: f64) -> Answer<bool> {
        let larger = libm::fmax(libm::fabs(left), libm::fabs(right));
        let close = left != right && libm::fabs(left - right) <= CLOSE * larger;
        if close && self.language() != Language::Rs274 {
            return Err(fault(&format!(
                "{left} is compared with {right}: whether they are equal hangs on how many digits the control keeps"
            )));
        }
        Ok(true)
    }

    /// Truths everywhere; whole numbers bit by bit with Fanuc, whose AND is that.
    fn logical(&self, operator: BinaryOperator, left: f64, right: f64) -> Answer<f64> {
        use BinaryOperator as B;
        let truths = |number: f64| number == 0.0 || number == 1.0;
        if self.language() == Language::Macro && !(truths(left) && truths(right)) {
            let (left, right) = (whole(left, "AND")?, whole(right, "AND")?);
            if left < 0 || right < 0 {
                return Err(fault("AND, OR or XOR of a negative number"));
            }
            return Ok(match operator {
                B::And => left & right,
                B::Or => left | right,
                _ => left ^ right,
            } as f64);
        }
        let (left, right) = (left != 0.0, right != 0.0);
        Ok(truth(match operator {
            B::And => left && right,
            B::Or => left || right,
            _ => left != right,
        }))
    }

    /// Positive with RS-274/NGC; of a negative number elsewhere refused, since controls differ.
    fn remainder(&self, left: f64, right: f64) -> Answer<f64> {
        if right == 0.0 {
            return Err(fault(&format!("the remainder of {left} by zero")));
        }
        let remainder = libm::fmod(left, right);
        if self.language() == Language::Rs274 {
            return Ok(if remainder < 0.0 { remainder + libm::fabs(right) } else { remainder });
        }
        if left < 0.0 || right < 0.0 {
            return Err(differ(&format!("the remainder of {left} by {right}")));
        }
        Ok(remainder)
    }

    fn function(&self, name: &str, values: &[f64]) -> Answer<f64> {
        if let [value] = *values {
            return self.of_one(name, value);
        }
        let [first, second] = *values else {
            return self.of_three(name, values);
        };
        Ok(match (self.language(), name) {
            (_, "ATAN" | "ATAN2") => {
                let angle = libm::atan2(first, second).to_degrees();
                if self.language() == Language::Macro && angle < 0.0 {
                    return Err(differ(&format!(
                        "ATAN of {first} by {second}, {angle} or {} degrees,",
                        angle + 360.0
                    )));
                }
                angle
            }
            // FN 8: the length of the hypotenuse; FN 13: its angle, from 0 to 360 degrees.
            (Language::Conversational, "LEN") => libm::hypot(first, second),
            (Language::Conversational, "ANG") => {
                let angle = libm::atan2(first, second).to_degrees();
                if angle < 0.0 { angle + 360.0 } else { angle }
            }
            (Language::Names, "MINVAL") => libm::fmin(first, second),
            (Language::Names, "MAXVAL") => libm::fmax(first, second),
            (Language::Macro, "POW") if first >= 0.0 => libm::pow(first, second),
            _ => return Err(no_function(name, 2)),
        })
    }

    fn of_three(&self, name: &str, values: &[f64]) -> Answer<f64> {
        match (self.language(), name, values) {
            (Language::Names, "BOUND", &[least, most, value]) if least <= most => {
                Ok(libm::fmin(libm::fmax(value, least), most))
            }
            _ => Err(no_function(name, values.len())),
        }
    }

    fn of_one(&self, name: &str, value: f64) -> Answer<f64> {
        use Language as L;
        let language = self.language();
        let sides = |low: f64, high: f64| -> Answer<f64> {
            // Below zero some controls round towards it and others away.
            match low == high || value >= 0.0 {
                true => Ok(high),
                false => Err(differ(&format!("{name} of {value}"))),
            }
        };
        let domain = |inside: bool, answer: f64| match inside {
            true => Ok(answer),
            false => Err(fault(&format!("{name} of {value} is no number"))),
        };
        match (language, name) {
            (_, "SIN") => Ok(libm::sin(value.to_radians())),
            (_, "COS") => Ok(libm::cos(value.to_radians())),
            (_, "TAN") => domain(
                libm::fabs(libm::cos(value.to_radians())) > 1e-12,
                libm::tan(value.to_radians()),
            ),
            (_, "ASIN") => domain(libm::fabs(value) <= 1.0, libm::asin(value).to_degrees()),
            (_, "ACOS") => domain(libm::fabs(value) <= 1.0, libm::acos(value).to_degrees()),
            (L::Macro | L::Conversational, "ATAN") => Ok(libm::atan(value).to_degrees()),
            (_, "SQRT") => domain(value >= 0.0, libm::sqrt(value)),
            (_, "ABS") => Ok(libm::fabs(value)),
            (_, "LN") => domain(value > 0.0, libm::log(value)),
            (_, "EXP") => Ok(libm::exp(value)),
            (L::Rs274, "FIX") => Ok(libm::floor(value)),
            (L::Rs274, "FUP") => Ok(libm::ceil(value)),
            (L::Macro, "FIX") => Ok(libm::trunc(value)),
            (L::Macro, "FUP") => Ok(libm::copysign(libm::ceil(libm::fabs(value)), value)),
            // Halves away from zero; of negative ones controls differ.
            (L::Rs274, "ROUND") => Ok(libm::round(value)),
            (L::Macro | L::Names, "ROUND") => sides(libm::floor(value + 0.5), libm::round(value)),
            (L::Names, "TRUNC") | (L::Conversational, "INT") => Ok(libm::trunc(value)),
            (L::Conversational, "FRAC") => Ok(value - libm::trunc(value)),
            (L::Names, "POT") | (L::Conversational, "SQ") => Ok(value * value),
            (L::Conversational, "LOG") => domain(value > 0.0, libm::log10(value)),
            (L::Conversational, "NEG") => Ok(-value),
            (L::Conversational, "SGN") => Ok(match value {
                0.0 => 0.0,
                _ => libm::copysign(1.0, value),
            }),
            _ => Err(no_function(name, 1)),
        }
    }
}

/// `#01` is `#1`.
fn canonical(name: &str) -> String {
    let digits = name.trim_start_matches(|letter: char| !letter.is_ascii_digit());
    let head = &name[..name.len() - digits.len()];
    match (head, digits.parse::<u64>()) {
        ("#" | "R" | "Q" | "QL" | "QR" | "QS", Ok(number)) => format!("{head}{number}"),
        _ => name.to_owned(),
    }
}

fn text(value: VariableValue) -> String {
    match value {
        VariableValue::Number(number) => format!("{number}"),
        VariableValue::Text(text) => text,
    }
}

/// One text after the other.
fn joined(mut left: String, right: &str) -> Answer<VariableValue> {
    left.push_str(right);
    if left.len() > LONGEST_TEXT {
        let message = format!("a text of more than {LONGEST_TEXT} bytes is put together");
        return Err(fault(&message));
    }
    Ok(VariableValue::Text(left))
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// A whole number, for what must be one: a count, an index, a label.
pub(super) fn whole(value: f64, what: &str) -> Answer<i64> {
    let rounded = libm::round(value);
    if libm::fabs(value - rounded) > 1e-6 || libm::fabs(rounded) > 9e15 {
        return Err(fault(&format!("{what} of {value}: it must be a whole number")));
    }
    Ok(rounded as i64)
}

fn finite(number: f64) -> Answer<f64> {
    match number.is_finite() {
        true => Ok(number),
        false => Err(fault("an expression gives a number that is too large")),
    }
}

fn fault(message: &str) -> Box<Diagnostic> {
    Diagnostic::error("nc-expression", message).boxed()
}

fn differ(what: &str) -> Box<Diagnostic> {
    Diagnostic::error("nc-expression", format!("{what} is not the same on all controls"))
        .help("write the number in its place")
        .boxed()
}

fn no_number(text: &str) -> Box<Diagnostic> {
    fault(&format!("the text \"{text}\" stands where a number belongs"))
}

fn no_function(name: &str, count: usize) -> Box<Diagnostic> {
    let values = if count == 1 { "value" } else { "values" };
    fault(&format!("the function `{name}` of {count} {values} is not known"))
}

#[cfg(test)]
mod tests;
