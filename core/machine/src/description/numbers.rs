//! Numbers, vectors and directions of a machine file; any number may be an expression of its parameters.

use std::ops::Range;

use nalgebra::Vector3;
use post_grammar::text::excerpt;
use post_grammar::{Expression, parse_expression};

use super::build::Builder;
use super::limits::MOST_NUMBER;
use super::quantity::{KeyedNumber, Number};
use crate::diagnostic::meant;

/// Longest piece of an expression that a message shows, bytes.
const SHOWN: usize = 80;

impl Builder<'_> {
    pub(super) fn vector(&mut self, quantities: &[KeyedNumber; 3]) -> Vector3<f64> {
        Vector3::from_fn(|row, _| self.number(&quantities[row]))
    }

    pub(super) fn direction(
        &mut self,
        what: &str,
        quantities: &[KeyedNumber; 3],
    ) -> Option<Vector3<f64>> {
        let vector = self.vector(quantities);
        if vector.iter().any(|part| part.is_nan()) {
            return None;
        }
        // Of any length: made one in two steps, so that squares stay finite.
        let largest = vector.amax();
        if largest > 1e-9 {
            return Some((vector / largest).normalize());
        }
        let span = quantities[0].span().start..quantities[2].span().end;
        let message = format!("{what} is null");
        let help = "a direction has any length but zero";
        self.fault("machine-direction", span, message, help);
        None
    }

    /// The value; no number and a fault if it has none, so that what is said of numbers is not said of it too.
    pub(super) fn number(&mut self, quantity: &KeyedNumber) -> f64 {
        if self.leans_on_a_fault(quantity.get_ref()) {
            return f64::NAN;
        }
        match self.evaluate(quantity.get_ref()) {
            Ok(value) if value.abs() <= MOST_NUMBER => {
                if matches!(quantity.get_ref(), Number::Expression(_)) {
                    self.evaluated.push((quantity.span(), value));
                }
                value
            }
            Ok(value) => {
                let message = if value.is_finite() {
                    format!(
                        "{value:e} is no number of a machine: none is larger than {MOST_NUMBER:e}"
                    )
                } else {
                    format!("{value} is no finite number")
                };
                self.fault("machine-number", quantity.span(), message, "");
                f64::NAN
            }
            Err(message) => {
                self.without_value(quantity, message);
                f64::NAN
            }
        }
    }

    /// The expression has no value.
    fn without_value(&mut self, quantity: &KeyedNumber, message: String) {
        let known: Vec<&str> = self.parameters.keys().map(String::as_str).collect();
        let help = match known.as_slice() {
            [] => "the file has no [parameters]".to_owned(),
            known => meant(&unknown(quantity, known), "the parameters are", known),
        };
        self.fault("machine-expression", quantity.span(), message, &help);
    }

    /// It is worked out from a parameter that has no value, which is said where that one stands.
    fn leans_on_a_fault(&self, number: &Number) -> bool {
        let Number::Expression(text) = number else {
            return false;
        };
        !self.without.is_empty()
            && parsed(text).is_ok_and(|expression| {
                let names = expression.names();
                names.iter().any(|name| self.without.contains(*name))
            })
    }

    /// Gives each parameter its value, once, those first that others are defined by. One that nothing uses is checked
    /// too: it may be used tomorrow.
    pub(super) fn evaluate_parameters(&mut self) {
        let parameters = self.parameters;
        for (name, quantity) in parameters {
            match self.settle(name, quantity.get_ref(), 0) {
                Ok(()) => {
                    if self.number(quantity).is_nan() {
                        self.without.insert(name);
                    }
                }
                Err(Unsettled::Own(message) | Unsettled::Circle(message)) => {
                    self.without.insert(name);
                    self.without_value(quantity, message);
                }
                Err(Unsettled::Told) => {
                    self.without.insert(name);
                }
            }
        }
    }

    /// Gives a parameter its value, and before that those that it is defined by; `depth` of them wait for it.
    fn settle(&mut self, name: &str, number: &Number, depth: usize) -> Result<(), Unsettled> {
        let parameters = self.parameters;
        let Some((name, _)) = parameters.get_key_value(name) else {
            return Ok(());
        };
        if self.values.contains_key(name.as_str()) {
            return Ok(());
        }
        if self.without.contains(name.as_str()) {
            return Err(Unsettled::Told);
        }
        if depth > parameters.len() {
            let name = excerpt(name, SHOWN);
            return Err(Unsettled::Circle(format!(
                "{name}: parameters that are defined by one another in a circle"
            )));
        }
        if let Number::Expression(text) = number {
            let expression = parsed(text).map_err(Unsettled::Own)?;
            for other in expression.names() {
                let Some((other, quantity)) = parameters.get_key_value(other) else {
                    continue;
                };
                match self.settle(other, quantity.get_ref(), depth + 1) {
                    Ok(()) => {}
                    Err(Unsettled::Own(message)) => {
                        self.without.insert(other);
                        self.without_value(quantity, message);
                        return Err(Unsettled::Told);
                    }
                    Err(unsettled) => return Err(unsettled),
                }
            }
        }
        let value = self.evaluate(number).map_err(Unsettled::Own)?;
        self.values.insert(name, value);
        Ok(())
    }

    /// A number or an expression of the parameters that have a value.
    fn evaluate(&self, number: &Number) -> Result<f64, String> {
        let text = match number {
            Number::Value(value) => return Ok(*value),
            Number::Expression(text) => text,
        };
        parsed(text)?
            .evaluate(&|name| self.values.get(name).copied())
            .map_err(|fault| format!("{}: {}", excerpt(text, SHOWN), fault.message))
    }
}

/// Why a parameter has no value.
enum Unsettled {
    /// The parameter's own expression has none.
    Own(String),
    /// It is defined by itself.
    Circle(String),
    /// One that it is defined by has none, which is said there.
    Told,
}

/// The value of an expression, and where it stands in all layers.
pub(super) type EvaluatedAt = (Range<usize>, f64);

/// The first name of an expression that is none of the `known` parameters; empty if there is none.
fn unknown(quantity: &KeyedNumber, known: &[&str]) -> String {
    let Number::Expression(text) = quantity.get_ref() else {
        return String::new();
    };
    parsed(text)
        .ok()
        .and_then(|expression| {
            let mut names = expression.names().into_iter();
            names.find(|name| !known.contains(name)).map(str::to_owned)
        })
        .unwrap_or_default()
}

fn parsed(text: &str) -> Result<Expression, String> {
    parse_expression(text).map_err(|fault| format!("{}: {}", excerpt(text, SHOWN), fault.message))
}
