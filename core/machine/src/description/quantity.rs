//! Numbers of a machine file: values, or expressions of its parameters.

use serde_json::json;

use super::table::{
    DeValue, EntryError, Key, KeyType, KeyedValue, Schemas, Spanned, Value, of_another_kind, plain,
};

/// A number, or an expression of the file's parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Number {
    Value(f64),
    Expression(String),
}

/// A number or expression, where it stands, and of which key.
pub(crate) type KeyedNumber = KeyedValue<Number>;

impl KeyType for Number {
    fn read(value: &Spanned<DeValue<'_>>, _: &'static Key) -> Result<Self, EntryError> {
        let number = match value.get_ref() {
            DeValue::String(text) => return Ok(Self::Expression(text.to_string())),
            DeValue::Integer(_) => plain::<i64>(value).map(|number| number as f64),
            _ => plain::<f64>(value),
        };
        let what = "a number, or an expression of parameters in quotes";
        number.map(Self::Value).map_err(|_| of_another_kind(value, what))
    }

    fn schema(_: &mut Schemas) -> Value {
        json!({ "type": ["number", "string"] })
    }
}
