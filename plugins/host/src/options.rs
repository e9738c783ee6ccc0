//! The options of a machine file against what a plugin declares.

use post_plugin::{OptionKind, OptionSpec, Value};

use crate::OptionFault;
use crate::shown::is_odd;

/// Value of an option, as a machine file gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum GivenValue {
    /// `true`, `false`.
    Flag(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// Text.
    Text(String),
}

impl GivenValue {
    /// The value as a plugin gets it.
    pub fn as_value(&self) -> Value<'_> {
        match self {
            GivenValue::Flag(flag) => Value::Flag(*flag),
            GivenValue::Integer(integer) => Value::Integer(*integer),
            GivenValue::Number(number) => Value::Number(*number),
            GivenValue::Text(text) => Value::Text(text),
        }
    }
}

impl From<Value<'_>> for GivenValue {
    fn from(value: Value<'_>) -> Self {
        match value {
            Value::Flag(flag) => GivenValue::Flag(flag),
            Value::Integer(integer) => GivenValue::Integer(integer),
            Value::Number(number) => GivenValue::Number(number),
            Value::Text(text) => GivenValue::Text(text.to_owned()),
        }
    }
}

/// Checks `given` and completes it by the defaults; the answer is in the order of `specs`.
///
/// # Errors
/// The first option that is not known, given twice, of another type or out of range.
pub fn check_options(
    specs: &[OptionSpec],
    given: &[(String, GivenValue)],
) -> Result<Vec<(String, GivenValue)>, OptionFault> {
    for (index, (key, _)) in given.iter().enumerate() {
        let message = if !specs.iter().any(|spec| spec.key == key) {
            "not known"
        } else if given[..index].iter().any(|(other, _)| other == key) {
            "given twice"
        } else {
            continue;
        };
        return Err(OptionFault {
            key: key.clone(),
            message: message.to_owned(),
            written: key.clone(),
            allowed: specs.iter().map(|spec| spec.key.to_owned()).collect(),
        });
    }
    specs
        .iter()
        .map(|spec| {
            let value = given.iter().find(|(key, _)| key == spec.key);
            let value = match value {
                Some((_, value)) => check(spec, value)?,
                None => spec.default.into(),
            };
            Ok((spec.key.to_owned(), value))
        })
        .collect()
}

/// `value` in the type that `spec` asks for.
pub(crate) fn check(spec: &OptionSpec, value: &GivenValue) -> Result<GivenValue, OptionFault> {
    let fault = |message: String, allowed: &[&str]| {
        Err(OptionFault {
            key: spec.key.to_owned(),
            message,
            written: match value {
                GivenValue::Text(text) => text.clone(),
                _ => String::new(),
            },
            // That nothing is said is no word to be written.
            allowed: allowed
                .iter()
                .filter(|text| !text.is_empty())
                .map(|&text| text.to_owned())
                .collect(),
        })
    };
    match (spec.kind, value) {
        (OptionKind::Flag, GivenValue::Flag(_)) => Ok(value.clone()),
        (OptionKind::Text, GivenValue::Text(text)) if text.contains(is_odd) => {
            fault("must be one line of text".to_owned(), &[])
        }
        (OptionKind::Lines, GivenValue::Text(text))
            if text.contains(|letter: char| is_odd(letter) && letter != '\n') =>
        {
            fault("holds a character that no line has".to_owned(), &[])
        }
        (OptionKind::Text | OptionKind::Lines, GivenValue::Text(_)) => Ok(value.clone()),
        (OptionKind::Integer { min, max }, GivenValue::Integer(integer)) => {
            if (min..=max).contains(integer) {
                Ok(value.clone())
            } else {
                fault(format!("{integer} is not between {min} and {max}"), &[])
            }
        }
        (OptionKind::Number { min, max }, GivenValue::Number(_) | GivenValue::Integer(_)) => {
            let number = match value {
                GivenValue::Integer(integer) => *integer as f64,
                GivenValue::Number(number) => *number,
                _ => f64::NAN,
            };
            if (min..=max).contains(&number) {
                Ok(GivenValue::Number(number))
            } else {
                fault(format!("{number} is not between {min} and {max}"), &[])
            }
        }
        (OptionKind::Choice(choices), GivenValue::Text(text)) => {
            if choices.contains(&text.as_str()) {
                Ok(value.clone())
            } else {
                fault(format!("`{text}` is not one of its values"), choices)
            }
        }
        (OptionKind::Flag, _) => fault("must be true or false".to_owned(), &["true", "false"]),
        (OptionKind::Integer { .. }, _) => fault("must be a whole number".to_owned(), &[]),
        (OptionKind::Number { .. }, _) => fault("must be a number".to_owned(), &[]),
        (OptionKind::Text, _) => fault("must be text, in quotes".to_owned(), &[]),
        (OptionKind::Lines, _) => {
            fault("must be text, in quotes, or an array of such lines".to_owned(), &[])
        }
        (OptionKind::Choice(choices), _) => fault("must be text, in quotes".to_owned(), choices),
    }
}

/// What an option takes, for tables.
pub fn takes(kind: OptionKind) -> String {
    match kind {
        OptionKind::Flag => "true, false".to_owned(),
        OptionKind::Integer { min, max } => format!("{min} to {max}"),
        OptionKind::Number { min, max } => format!("{min} to {max}, any number"),
        OptionKind::Text => "text".to_owned(),
        OptionKind::Lines => "a line, or an array of lines".to_owned(),
        OptionKind::Choice(choices) => choices.join(", "),
    }
}

/// The default of an option as a machine file would have it.
pub fn default_of(spec: &OptionSpec) -> String {
    match spec.default {
        Value::Flag(flag) => flag.to_string(),
        Value::Integer(integer) => integer.to_string(),
        Value::Number(number) => number.to_string(),
        Value::Text(text) => format!("\"{}\"", text.replace('\n', "\\n")),
    }
}
