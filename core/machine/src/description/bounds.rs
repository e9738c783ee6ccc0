//! What the value of a key may be: what the JSON Schema says of it, and how a number outside is refused.

use std::ops::Range;

use serde_json::{Value, json};

use super::build::Builder;
use super::quantity::KeyedNumber;
use super::table::{Count, Key};
use crate::diagnostic::Short;

/// What the value of a key may be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    /// It lies above this.
    pub above: Option<f64>,
    /// It is this or more.
    pub least: Option<f64>,
    /// It is this or less, as the schema has it.
    pub most: Option<f64>,
    /// It is this or less, as the check has it: what is larger is a slip of the unit.
    pub farthest: f64,
    /// A text has this pattern.
    pub pattern: Option<&'static str>,
    /// The names in a table have this pattern.
    pub names: Option<&'static str>,
    /// A list has so many items or more.
    pub items: Option<usize>,
    /// What the schema tells as the default, as JSON.
    pub default: Option<&'static str>,
    /// The code of the message that refuses a number.
    pub code: &'static str,
    /// What the message has before the key's name.
    pub table: &'static str,
    /// What it has in place of both.
    pub called: Option<&'static str>,
    /// What it has behind the value: unit, and what must be.
    pub says: &'static str,
    /// What helps.
    pub help: &'static str,
}

impl Bounds {
    /// Anything.
    pub const ANY: Self = Self {
        above: None,
        least: None,
        most: None,
        farthest: f64::INFINITY,
        pattern: None,
        names: None,
        items: None,
        default: None,
        code: "",
        table: "",
        called: None,
        says: "",
        help: "",
    };

    /// A flag that is off where the file does not say it.
    pub const OFF: Self = Self { default: Some("false"), ..Self::ANY };

    /// Texts with this pattern.
    pub const fn pattern(pattern: &'static str) -> Self {
        Self { pattern: Some(pattern), ..Self::ANY }
    }

    /// Tables whose names have this pattern.
    pub const fn names(pattern: &'static str) -> Self {
        Self { names: Some(pattern), ..Self::ANY }
    }

    /// Lists of so many items or more.
    pub const fn items(least: usize) -> Self {
        Self { items: Some(least), ..Self::ANY }
    }

    /// Numbers above zero, refused by `code`.
    pub const fn above_zero(code: &'static str) -> Self {
        Self { above: Some(0.0), code, says: "; it must be above zero", ..Self::ANY }
    }

    /// Numbers from zero on, refused by `code`.
    pub const fn from_zero(code: &'static str) -> Self {
        Self { least: Some(0.0), code, says: "; it cannot be below zero", ..Self::ANY }
    }

    /// Numbers from `least` to `most`, refused by `code`.
    pub const fn within(least: f64, most: f64, code: &'static str, says: &'static str) -> Self {
        let least = Some(least);
        Self { least, most: Some(most), farthest: most, code, says, ..Self::ANY }
    }

    /// Puts what the schema says of it beside its type.
    pub fn describe(&self, schema: &mut Value) {
        for (key, number) in
            [("exclusiveMinimum", self.above), ("minimum", self.least), ("maximum", self.most)]
        {
            if let Some(number) = number {
                let whole = number.fract() == 0.0;
                schema[key] = if whole { json!(number as i64) } else { json!(number) };
            }
        }
        if let Some(pattern) = self.pattern {
            schema["pattern"] = json!(pattern);
        }
        if let Some(pattern) = self.names {
            schema["propertyNames"] = json!({ "pattern": pattern });
        }
        if let Some(least) = self.items {
            schema["minItems"] = json!(least);
        }
        if let Some(default) = self.default {
            schema["default"] = default.parse().unwrap_or_default();
        }
    }

    /// The number lies outside. What is no number does not: that was told already.
    fn refuse(&self, value: f64) -> bool {
        self.above.is_some_and(|above| value <= above)
            || self.least.is_some_and(|least| value < least)
            || value > self.farthest
    }
}

impl Builder<'_> {
    /// The number that a key is given, if it is; a fault where its bounds refuse it.
    pub(super) fn checked(&mut self, given: &Option<KeyedNumber>) -> Option<f64> {
        given.as_ref().map(|given| self.within_bounds(given, ""))
    }

    /// The number that a key is given; a fault where its bounds refuse it, with `of` behind the key's name.
    pub(super) fn within_bounds(&mut self, given: &KeyedNumber, of: &str) -> f64 {
        let value = self.number(given);
        if given.key.bounds.refuse(value) {
            self.out_of_bounds(given.key, given.span(), of, &Short(value).to_string());
        }
        value
    }

    /// The whole number that a key is given, if it is; a fault where its bounds refuse it, and the nearest one inside.
    pub(super) fn counted(&mut self, given: &Option<Count>) -> Option<i64> {
        let given = given.as_ref()?;
        let (value, bounds) = (*given.get_ref(), &given.key.bounds);
        let [least, most] = [bounds.least.unwrap_or_default(), bounds.farthest];
        if bounds.refuse(value as f64) {
            self.out_of_bounds(given.key, given.span(), "", &value.to_string());
        }
        Some(value.clamp(least as i64, most as i64))
    }
    fn out_of_bounds(&mut self, key: &Key, span: Range<usize>, of: &str, value: &str) {
        let Bounds { code, table, called, says, help, .. } = key.bounds;
        let name = called.map_or_else(|| format!("{table}{}{of}", key.name), str::to_owned);
        self.fault(code, span, format!("{name} is {value}{says}"), help);
    }
}
