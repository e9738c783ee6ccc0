//! Numbers of a machine file: values, or expressions of its parameters.

use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};

use super::table::Given;

/// A number, or an expression of the file's parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Number {
    Value(f64),
    Expression(String),
}

/// A number or expression, where it stands, and of which key.
pub(crate) type Quantity = Given<Number>;

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = Number;

            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a number, or an expression of parameters in quotes")
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
                Ok(Number::Value(value))
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
                Ok(Number::Value(value as f64))
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Number, E> {
                Ok(Number::Expression(text.to_owned()))
            }
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}
