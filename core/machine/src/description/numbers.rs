//! Numbers, vectors and directions of a machine file; any number may be an expression of its parameters.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use post_grammar::parse_expression;

use super::build::Builder;
use super::file::{Number, Quantity};
use super::keys::meant;

impl Builder<'_> {
    pub(super) fn vector(&mut self, quantities: &[Quantity; 3]) -> Vector3<f64> {
        Vector3::from_fn(|row, _| self.number(&quantities[row]))
    }

    pub(super) fn direction(
        &mut self,
        what: &str,
        quantities: &[Quantity; 3],
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
        self.fault(
            "machine-direction",
            span,
            format!("{what} is null"),
            "a direction has any length but zero",
        );
        None
    }

    /// The value; no number and a fault if it has none, so that what is said of numbers is not said of it too.
    pub(super) fn number(&mut self, quantity: &Quantity) -> f64 {
        match self.evaluate(quantity.get_ref(), 0) {
            Ok(value) if value.is_finite() => value,
            Ok(value) => {
                self.fault(
                    "machine-number",
                    quantity.span(),
                    format!("{value} is no finite number"),
                    "",
                );
                f64::NAN
            }
            Err(message) => {
                let known: Vec<&str> = self.parameters.keys().map(String::as_str).collect();
                let help = meant(&unknown(quantity, &known), "the parameters are", &known);
                self.fault("machine-expression", quantity.span(), message, &help);
                f64::NAN
            }
        }
    }

    /// Parameters may be expressions of other parameters; a circle runs into the depth limit.
    fn evaluate(&self, number: &Number, depth: usize) -> Result<f64, String> {
        let text = match number {
            Number::Value(value) => return Ok(*value),
            Number::Expression(text) => text,
        };
        if depth > self.parameters.len() {
            return Err(format!(
                "{text}: parameters that are defined by one another in a circle"
            ));
        }
        let expression =
            parse_expression(text).map_err(|fault| format!("{text}: {}", fault.message))?;
        let mut values = BTreeMap::new();
        for name in expression.names() {
            if let Some(quantity) = self.parameters.get(name) {
                values.insert(name, self.evaluate(quantity.get_ref(), depth + 1)?);
            }
        }
        expression
            .evaluate(&|name| values.get(name).copied())
            .map_err(|fault| format!("{text}: {}", fault.message))
    }
}

/// The first name of an expression that is none of the `known` parameters; empty if there is none.
fn unknown(quantity: &Quantity, known: &[&str]) -> String {
    let Number::Expression(text) = quantity.get_ref() else {
        return String::new();
    };
    parse_expression(text)
        .ok()
        .and_then(|expression| {
            let mut names = expression.names().into_iter();
            names.find(|name| !known.contains(name)).map(str::to_owned)
        })
        .unwrap_or_default()
}
