//! JSON whose values know where they stand, so that what is wrong with one is told with its line.

use std::fmt::{self, Display};

use post_machine::diagnostic::{Diagnostic, SourcePlace};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

/// A JSON file that is read.
#[derive(Clone, Copy)]
pub struct JsonText<'a> {
    /// The file as the user named it.
    pub file: &'a str,
    /// All of it.
    pub text: &'a str,
}

/// A value of a JSON file, not looked into yet.
pub type Raw<'a> = &'a RawValue;

/// A number, and the digits that it was read from.
pub type NumberText<'a> = (f64, Raw<'a>);

impl<'a> JsonText<'a> {
    /// The whole file as one of `T`.
    ///
    /// # Errors
    /// It is no JSON, or lacks a key or has one too many.
    pub fn whole<T: Deserialize<'a>>(&self) -> Result<T, Box<Diagnostic>> {
        serde_json::from_str(self.text).map_err(|error| self.unread(&error, self.text))
    }

    /// A value as one of `T`.
    ///
    /// # Errors
    /// It is something else.
    pub fn value<T: Deserialize<'a>>(&self, raw: Raw<'a>) -> Result<T, Box<Diagnostic>> {
        serde_json::from_str(raw.get()).map_err(|error| self.unread(&error, raw.get()))
    }

    /// A list of values.
    ///
    /// # Errors
    /// It is no list.
    pub fn list(&self, raw: Raw<'a>, of: &str) -> Result<Vec<Raw<'a>>, Box<Diagnostic>> {
        let list: Result<Vec<Raw<'a>>, _> = serde_json::from_str(raw.get());
        list.map_err(|_| self.fault(raw, format!("a list of {of} is expected"), ""))
    }

    /// The keys of an object and their values, in its order.
    ///
    /// # Errors
    /// It is no object, or has a key twice.
    pub fn entries(&self, raw: Raw<'a>) -> Result<Vec<(String, Raw<'a>)>, Box<Diagnostic>> {
        let Entries(entries) = self.value(raw)?;
        for (place, (key, value)) in entries.iter().enumerate() {
            if entries[..place].iter().any(|(other, _)| other == key) {
                return Err(self.fault(value, format!("{key} is said twice"), ""));
            }
        }
        Ok(entries)
    }

    /// A number that is finite.
    ///
    /// # Errors
    /// It is none.
    pub fn number(&self, raw: Raw<'a>, what: &str) -> Result<f64, Box<Diagnostic>> {
        match raw.get().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(self.fault(raw, format!("{what}: a number is expected"), "")),
        }
    }

    /// A number above zero.
    ///
    /// # Errors
    /// It is none.
    pub fn positive(&self, raw: Raw<'a>, what: &str) -> Result<f64, Box<Diagnostic>> {
        match self.number(raw, what)? {
            number if number > 0.0 => Ok(number),
            number => {
                let message = format!("{what} is {number}; it must be above zero");
                Err(self.fault(raw, message, "leave it out where there is no limit"))
            }
        }
    }

    /// A list of numbers.
    ///
    /// # Errors
    /// It is none.
    pub fn numbers(
        &self,
        raw: Raw<'a>,
        what: &str,
    ) -> Result<Vec<NumberText<'a>>, Box<Diagnostic>> {
        let each = self.list(raw, "numbers")?.into_iter();
        each.map(|raw| Ok((self.number(raw, what)?, raw))).collect()
    }

    /// That something is wrong with a value, or what would help.
    pub fn fault(&self, raw: Raw<'a>, message: impl Display, help: &str) -> Box<Diagnostic> {
        let start = self.offset(raw.get());
        let fault = Diagnostic::error("curve", message.to_string())
            .at(Some(self.place(start, raw.get().len())));
        match help {
            "" => fault.boxed(),
            help => fault.help(help).boxed(),
        }
    }

    /// Where a part of the text begins: parts are slices of it.
    fn offset(&self, part: &str) -> usize {
        (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    fn place(&self, start: usize, length: usize) -> SourcePlace {
        let start = start.min(self.text.len());
        let before = &self.text[..start];
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let rest = &self.text[line_start..];
        let line = rest.lines().next().unwrap_or_default();
        let number = before.matches('\n').count() as u64 + 1;
        let from = start - line_start;
        SourcePlace::new(self.file, number, line, from..from + length)
    }

    /// What serde says of a part of the text, at the place that it names.
    fn unread(&self, error: &serde_json::Error, part: &str) -> Box<Diagnostic> {
        let lines = part.split_inclusive('\n').take(error.line().max(1) - 1);
        let within = lines.map(str::len).sum::<usize>() + error.column().max(1) - 1;
        let start = self.offset(part) + within.min(part.len());
        let full = error.to_string();
        // The place is told beside it.
        let message = full.split(" at line ").next().unwrap_or(&full);
        let fault = Diagnostic::error("curve", message).at(Some(self.place(start, 1)));
        fault.help("`post plan --help` lists the keys of a curve file").boxed()
    }
}

/// An object in its order.
struct Entries<'a>(Vec<(String, Raw<'a>)>);

impl<'de> Deserialize<'de> for Entries<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Keys;
        impl<'de> Visitor<'de> for Keys {
            type Value = Entries<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Keys)
    }
}
