//! Keys and values of a TOML text, each with its place; of a text with faults, what can be read.

use std::ops::Range;

use post_machine::description::readable;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A key with its value, or an item of a list.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The keys that lead to it; of an item `[0]` behind those of the list.
    pub path: Vec<String>,
    /// Where its key stands, bytes; none of an item.
    pub key: Option<Range<usize>>,
    /// Where its value stands, bytes, quotes with it.
    pub value: Range<usize>,
    /// A text, without its quotes.
    pub text: Option<String>,
    /// A number.
    pub number: Option<f64>,
}

/// All of them, in the order of their keys.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// The entries.
    pub entries: Vec<Entry>,
}

impl Tree {
    /// Of a text.
    pub fn of(text: &str) -> Self {
        let mut tree = Self::default();
        let readable = readable(text);
        let (table, _) = DeTable::parse_recoverable(&readable);
        tree.table(table.get_ref(), &mut Vec::new());
        // What could not be read may stand anywhere.
        let sound = |span: &Range<usize>| text.get(span.clone()).is_some();
        tree.entries.retain(|entry| sound(&entry.value) && entry.key.as_ref().is_none_or(sound));
        tree
    }

    fn table(&mut self, table: &DeTable<'_>, path: &mut Vec<String>) {
        for (key, value) in table {
            path.push(key.get_ref().to_string());
            self.value(value, Some(key.span()), path);
            path.pop();
        }
    }

    fn value(
        &mut self,
        value: &Spanned<DeValue<'_>>,
        key: Option<Range<usize>>,
        path: &mut Vec<String>,
    ) {
        let number = match value.get_ref() {
            DeValue::Integer(number) => number.as_str().replace('_', "").parse().ok(),
            DeValue::Float(number) => number.as_str().replace('_', "").parse().ok(),
            _ => None,
        };
        self.entries.push(Entry {
            path: path.clone(),
            key,
            value: value.span(),
            text: value.get_ref().as_str().map(str::to_owned),
            number,
        });
        match value.get_ref() {
            DeValue::Table(inner) => self.table(inner, path),
            DeValue::Array(items) => {
                for (index, item) in items.iter().enumerate() {
                    path.push(format!("[{index}]"));
                    self.value(item, None, path);
                    path.pop();
                }
            }
            _ => {}
        }
    }

    /// The entry at these keys.
    pub fn get(&self, path: &[&str]) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.path == path)
    }

    /// Keys that stand directly in a table.
    pub fn keys(&self, table: &[String]) -> impl Iterator<Item = &str> {
        self.entries.iter().filter_map(move |entry| {
            let (last, before) = entry.path.split_last()?;
            (before == table).then_some(last.as_str())
        })
    }

    /// The smallest entry whose key or value stands at a byte.
    pub fn at(&self, byte: usize) -> Option<&Entry> {
        let holds = |span: &Range<usize>| span.start <= byte && byte <= span.end;
        let here = self.entries.iter().filter_map(|entry| {
            let key = entry.key.as_ref().filter(|key| holds(key));
            let value = Some(&entry.value).filter(|value| holds(value));
            let span = key.or(value)?;
            Some((span.len(), entry))
        });
        here.min_by_key(|(length, _)| *length).map(|(_, entry)| entry)
    }
}
