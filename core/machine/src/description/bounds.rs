//! What the value of a key may be: what the JSON Schema says of it, and how a number outside is refused.

use std::ops::Range;

use serde_json::{Value, json};

use super::build::Builder;
use super::quantity::Quantity;
use super::table::{Count, Key};
use crate::diagnostic::Short;

/// What the value of a key may be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    /// It lies above this.
    above: Option<f64>,
    /// It is this or more.
    least: Option<f64>,
    /// It is this or less, as the schema has it.
    most: Option<f64>,
    /// It is this or less, as the check has it: what is larger is a slip of the unit.
    farthest: f64,
    /// A text has this pattern.
    pattern: Option<&'static str>,
    /// The names in a table have this pattern.
    names: Option<&'static str>,
    /// A list has so many items or more.
    items: Option<usize>,
    /// What the schema tells as the default, as JSON.
    default: Option<&'static str>,
    /// The code of the message.
    code: &'static str,
    /// What stands before the key's name in the message.
    table: &'static str,
    /// What the message calls it in place of its name.
    called: Option<&'static str>,
    /// What stands behind the value in the message, with a blank before it.
    unit: &'static str,
    /// What the message says that it must be.
    must: &'static str,
    /// What helps.
    help: &'static str,
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
        unit: "",
        must: "",
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

    /// Numbers above zero; of others `code` tells, with `table` before the key's name.
    pub const fn above_zero(code: &'static str, table: &'static str) -> Self {
        let must = "it must be above zero";
        Self { above: Some(0.0), code, table, must, ..Self::ANY }
    }

    /// Numbers from zero on.
    pub const fn from_zero(code: &'static str, table: &'static str) -> Self {
        let must = "it cannot be below zero";
        Self { least: Some(0.0), code, table, must, ..Self::ANY }
    }

    /// Numbers from `least` to `most`, which is what `must` says.
    pub const fn within(
        least: f64,
        most: f64,
        code: &'static str,
        table: &'static str,
        must: &'static str,
    ) -> Self {
        let (least, farthest) = (Some(least), most);
        Self { least, most: Some(most), farthest, code, table, must, ..Self::ANY }
    }

    /// The same, and the schema says that it is `most` at most.
    pub const fn at_most(self, most: f64) -> Self {
        Self { most: Some(most), ..self }
    }

    /// The same, and the check refuses what is larger than `farthest`, which is what `must` says.
    pub const fn up_to(self, farthest: f64, must: &'static str) -> Self {
        Self { farthest, must, ..self }
    }

    /// The same with another name in the message.
    pub const fn called(self, name: &'static str) -> Self {
        Self { called: Some(name), ..self }
    }

    /// The same with a unit behind the value in the message.
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// The same with another sentence of what it must be.
    pub const fn must(self, must: &'static str) -> Self {
        Self { must, ..self }
    }

    /// The same with what helps.
    pub const fn help(self, help: &'static str) -> Self {
        Self { help, ..self }
    }

    /// The same, and the schema tells a default, as JSON.
    pub const fn default(self, default: &'static str) -> Self {
        Self { default: Some(default), ..self }
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
    pub(super) fn checked(&mut self, given: &Option<Quantity>) -> Option<f64> {
        given.as_ref().map(|given| self.within_bounds(given, ""))
    }

    /// The number that a key is given; a fault where its bounds refuse it, with `of` behind the key's name.
    pub(super) fn within_bounds(&mut self, given: &Quantity, of: &str) -> f64 {
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
        let Bounds { code, table, unit, must, help, .. } = key.bounds;
        let name = key.bounds.called.unwrap_or(key.name);
        let must = if must.is_empty() { String::new() } else { format!("; {must}") };
        self.fault(code, span, format!("{table}{name}{of} is {value}{unit}{must}"), help);
    }
}
