//! `[profile]`: of what machine a file is, and where its numbers come from. It tells people, and changes no program.

use std::collections::BTreeMap;

use toml::de::{DeTable, DeValue};

use super::layers::{MachineSources, Source};
use super::table::keys;
use crate::diagnostic::Diagnostic;

keys! {
    /// Of what machine the file is, and where its numbers come from: `post profile` tells it, programs do not depend on it.
    /// A key that stands under `sources` and `unknown` is that of a number (`axis.X.travel`) or of a table (`axis.X`), and
    /// the longer one holds.
    ProfileFile {
        /// Who makes the machine; without one the file is an example, or one's own.
        maker: Option<String>,
        /// What its maker calls it.
        model: Option<String>,
        /// What its control is called.
        control: Option<String>,
        /// What was checked at a machine, by whom and when.
        checked: Vec<String>,
        /// Where numbers come from: `"axis.X.travel" = "data sheet, 2021"`.
        sources: BTreeMap<String, String>,
        /// Numbers that are not those of the machine, or that nobody looked up, and what to measure.
        unknown: BTreeMap<String, String>,
    }
}

/// Of what machine a file is, and where its numbers come from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Profile {
    /// Who makes it; empty where the file is nobody's machine.
    pub maker: String,
    /// What its maker calls it.
    pub model: String,
    /// What its control is called.
    pub control: String,
    /// What was checked at a machine, by whom and when.
    pub checked: Vec<String>,
    /// Where numbers come from, by key.
    pub sources: BTreeMap<String, String>,
    /// What to measure, by key.
    pub unknown: BTreeMap<String, String>,
}

/// Where a number comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberOrigin<'p> {
    /// It was looked up there.
    Source(&'p str),
    /// It is not known; what is to be measured.
    Unknown(&'p str),
    /// The file says neither.
    Unsaid,
}

/// A number that a machine file says, or a row of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatedNumber {
    /// Its key: `axis.X.travel`.
    pub key: String,
    /// Its value as the file has it.
    pub value: String,
}

/// Tables with the numbers of the machine itself; the others say what is wanted of it.
const TABLES: [&str; 5] = ["parameters", "tool", "axis", "servo", "spindle"];

/// Texts among them that are none.
const WORDS: [&str; 4] = ["clamp", "unclamp", "length_axis", "feedback"];

impl Profile {
    pub(super) fn of(file: &ProfileFile) -> Self {
        let text = |text: &Option<String>| text.clone().unwrap_or_default();
        Profile {
            maker: text(&file.maker),
            model: text(&file.model),
            control: text(&file.control),
            checked: file.checked.clone(),
            sources: file.sources.clone(),
            unknown: file.unknown.clone(),
        }
    }

    /// Where the number of this key comes from: the longest key that names it, or a table that it stands in. What was
    /// looked up is known.
    pub fn origin(&self, key: &str) -> NumberOrigin<'_> {
        match (longest(&self.sources, key), longest(&self.unknown, key)) {
            (Some((name, _)), Some((other, text))) if other.len() > name.len() => {
                NumberOrigin::Unknown(text)
            }
            (Some((_, text)), _) => NumberOrigin::Source(text),
            (None, Some((_, text))) => NumberOrigin::Unknown(text),
            (None, None) => NumberOrigin::Unsaid,
        }
    }

    /// What is to be measured, a line a key; a key whose source is said too is left out.
    pub fn not_known(&self) -> Vec<String> {
        let unknown = self.unknown.iter().filter(|(key, _)| !self.sources.contains_key(*key));
        unknown.map(|(key, text)| format!("{key}: {text}")).collect()
    }

    /// Keys that name none of `numbers`: slips.
    pub fn strangers(&self, numbers: &[StatedNumber]) -> Vec<&str> {
        let all = self.sources.keys().chain(self.unknown.keys()).map(String::as_str);
        let named = |name: &str| numbers.iter().any(|number| stands_in(&number.key, name));
        all.filter(|name| !named(name)).collect()
    }
}

/// The longest of the keys that name `key`, with its text.
fn longest<'p>(all: &'p BTreeMap<String, String>, key: &str) -> Option<(&'p str, &'p str)> {
    let named = all.iter().filter(|(name, _)| stands_in(key, name));
    named.max_by_key(|(name, _)| name.len()).map(|(name, text)| (name.as_str(), text.as_str()))
}

/// The key is `name`, or stands in the table of that name.
fn stands_in(key: &str, name: &str) -> bool {
    key.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The numbers of a machine file and of what it extends (found by `find`).
///
/// # Errors
/// What cannot be read of them.
pub fn stated_numbers(
    source: Source,
    find: &mut dyn FnMut(&str) -> Result<Source, String>,
) -> Result<Vec<StatedNumber>, Vec<Diagnostic>> {
    let sources = MachineSources::collect(source, &[], find)?;
    let merged = sources.merge()?;
    if !merged.faults.is_empty() {
        return Err(merged.faults);
    }
    let mut numbers = Vec::new();
    for name in TABLES {
        if let Some(DeValue::Table(table)) =
            merged.table.get_ref().get(name).map(|value| value.get_ref())
        {
            gather(name, table, &mut numbers);
        }
    }
    Ok(numbers)
}

fn gather(path: &str, table: &DeTable<'_>, numbers: &mut Vec<StatedNumber>) {
    for (name, value) in table {
        let name = name.get_ref();
        let key = format!("{path}.{name}");
        match value.get_ref() {
            DeValue::Table(table) => gather(&key, table, numbers),
            _ if WORDS.contains(&name.as_ref()) => {}
            value => numbers.extend(number(value).map(|value| StatedNumber { key, value })),
        }
    }
}

/// A number, an expression, what is or is not so, or a row of them as text.
fn number(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::Integer(whole) => Some(whole.as_str().to_owned()),
        DeValue::Float(number) => Some(number.as_str().to_owned()),
        // It turns without end, or counts the other way.
        DeValue::Boolean(said) => Some(said.to_string()),
        DeValue::String(expression) => Some(expression.to_string()),
        DeValue::Array(row) => {
            let row: Option<Vec<String>> = row.iter().map(|part| number(part.get_ref())).collect();
            row.map(|row| format!("[{}]", row.join(", ")))
        }
        _ => None,
    }
}
