//! Numbers, vectors and directions of a machine file; any number may be an expression of its parameters.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use post_grammar::parse_expression;

use super::build::Builder;
use super::file::{Number, Quantity};

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

    /// The value; 0 and a fault if it has none.
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
                0.0
            }
            Err(message) => {
                let known: Vec<&str> = self.parameters.keys().map(String::as_str).collect();
                let help = format!("the parameters are: {}", known.join(", "));
                self.fault("machine-expression", quantity.span(), message, &help);
                0.0
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
