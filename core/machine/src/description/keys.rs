//! Keys and words of a machine file that it does not have: all of them, each with what was likely meant.

use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::Axis;
use super::file::MachineFile;
use super::layers::Sources;
use crate::diagnostic::{Diagnostic, meant, nearest};

/// Unknown keys of one file that are told, each by itself.
const MOST: usize = 20;

/// What a merged table says, as far as it can be read.
pub(super) struct Typed {
    /// The file without what could not be read; none where something that it needs is missing.
    pub(super) file: Option<MachineFile>,
    /// All keys that are not known, all values of another kind than their keys ask for, and what is missing.
    pub(super) faults: Vec<Diagnostic>,
    /// Those of them that leave something out of the file: a slip is read as what was likely meant, and leaves nothing out.
    pub(super) hiding: Vec<Diagnostic>,
}

/// What the merged table says; `whole` if all of the texts that it was merged from could be read.
pub(super) fn typed(mut table: Spanned<DeTable<'_>>, sources: &Sources, whole: bool) -> Typed {
    let mut faults = Vec::new();
    let mut hiding: Vec<Diagnostic> = Vec::new();
    let mut taken: Vec<String> = Vec::new();
    let mut stood_in = false;
    while faults.len() < MOST {
        // Reading ends at its first fault: what is wrong is put right or taken out, and the rest read again.
        let error = match MachineFile::deserialize(Deserializer::from(table.clone())) {
            Ok(file) => {
                return Typed { file: Some(file).filter(|_| !stood_in), faults, hiding };
            }
            Err(error) => error,
        };
        let message = error.message();
        let missing = message.strip_prefix(MISSING).and_then(|rest| rest.strip_suffix('`'));
        let near_taken = |key: &str| nearest(key, taken.iter().map(String::as_str)).is_some();
        let echo = missing.is_some_and(|key| !whole || near_taken(key));
        let (told, help) = explained(message);
        let mut fault = Diagnostic::error("machine-key", told)
            .at(error.span().and_then(|span| sources.place(span)));
        fault.help = help;
        let gone = match (missing, error.span()) {
            (Some(key), _) => {
                stood_in = true;
                stand_in(table.get_mut(), key)
            }
            (None, Some(span)) if put_right(table.get_mut(), &span, message) => true,
            (None, Some(span)) => take(table.get_mut(), &span).is_some_and(|key| {
                taken.push(key);
                hiding.push(fault.clone());
                true
            }),
            (None, None) => false,
        };
        if !echo {
            faults.push(fault);
        }
        if !gone {
            break;
        }
    }
    Typed { file: None, faults, hiding }
}

/// How serde begins what it says of a key, and of a word in place of one of a few.
const FIELD: &str = "unknown field `";
const VARIANT: &str = "unknown variant `";
const MISSING: &str = "missing field `";

/// serde's words in those of a machine file, and what would help.
fn explained(message: &str) -> (String, Option<String>) {
    let told = [(FIELD, "there is no key"), (VARIANT, "there is no value")];
    for (start, says) in told {
        let Some((word, mut names)) = expected(message, start) else {
            continue;
        };
        if names.contains(&"chain") {
            // These are taken out before the rest is read.
            names.extend(["extends", "head"]);
        }
        return (
            format!("{says} `{word}` here"),
            Some(meant(word, "known are", &names)).filter(|_| !names.is_empty()),
        );
    }
    (message.to_owned(), None)
}

/// The word that a message of serde begins with behind `start`, and those that are expected in its place.
fn expected<'m>(message: &'m str, start: &str) -> Option<(&'m str, Vec<&'m str>)> {
    let (word, expected) = message.strip_prefix(start)?.split_once('`')?;
    // Of `one of `a`, `b`` every second piece is a name.
    Some((word, expected.split('`').skip(1).step_by(2).collect()))
}

/// `its axes are C, A, Y, X, Z`.
pub(super) fn axes_are(axes: &[Axis]) -> String {
    let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
    format!("its axes are {}", names.join(", "))
}

/// Takes the key that stands at `span`, or whose value holds it, out, however deep; the key that was taken.
fn take(table: &mut DeTable<'_>, span: &Range<usize>) -> Option<String> {
    for (_, value) in table.iter_mut() {
        if let DeValue::Table(inner) = value.get_mut()
            && let Some(key) = take(inner, span)
        {
            return Some(key);
        }
    }
    let holds = |whole: Range<usize>| {
        whole.start <= span.start && span.end <= whole.end && span.start < whole.end
    };
    let found = table.iter().find(|(key, value)| key.span() == *span || holds(value.span()));
    let name = found.map(|(key, _)| key.get_ref().to_string())?;
    table.remove(name.as_str()).map(|_| name)
}

/// Puts what was likely meant in the place of a misspelt key or word at `span`; whether there is anything near.
fn put_right(table: &mut DeTable<'_>, span: &Range<usize>, message: &str) -> bool {
    if let Some((word, names)) = expected(message, FIELD) {
        let Some(meant) = nearest(word, names) else {
            return false;
        };
        return with_key(table, span, &mut |table, key| {
            let Some(value) = table.remove(key) else {
                return false;
            };
            // Where it stands already, nothing is missing without the slip.
            if !table.contains_key(meant) {
                let name = Spanned::new(span.clone(), meant.to_owned().into());
                table.insert(name, value);
            }
            true
        });
    }
    let Some((word, names)) = expected(message, VARIANT) else {
        return false;
    };
    nearest(word, names).is_some_and(|meant| {
        with_value(table, span, &mut |value| {
            *value = DeValue::String(meant.to_owned().into());
        })
    })
}

/// Does something to the key that stands at `span`, and the table that it stands in; whether that was of use.
fn with_key(
    table: &mut DeTable<'_>,
    span: &Range<usize>,
    act: &mut dyn FnMut(&mut DeTable<'_>, &str) -> bool,
) -> bool {
    let found = table.keys().find(|key| key.span() == *span);
    if let Some(name) = found.map(|key| key.get_ref().to_string()) {
        return act(table, &name);
    }
    table.iter_mut().any(|(_, value)| match value.get_mut() {
        DeValue::Table(inner) => with_key(inner, span, act),
        _ => false,
    })
}

/// Does something to the text that stands at `span`; whether there is one.
fn with_value(
    table: &mut DeTable<'_>,
    span: &Range<usize>,
    act: &mut dyn FnMut(&mut DeValue<'_>),
) -> bool {
    table.iter_mut().any(|(_, value)| {
        let here = value.span() == *span;
        match value.get_mut() {
            DeValue::Table(inner) => with_value(inner, span, act),
            text @ DeValue::String(_) if here => {
                act(text);
                true
            }
            _ => false,
        }
    })
}

/// Puts something of the right kind in the place of a key that is missing, so that the rest can be read; whether it could.
fn stand_in(table: &mut DeTable<'_>, key: &str) -> bool {
    // Each of these stands at one place alone.
    let (parent, text) = match key {
        "name" => (None, "x = ''"),
        "chain" => (None, "x = '[w b t]'"),
        "axis" => (None, "x = {}"),
        "tool" => (None, "x = { gauge = [0, 0, 0] }"),
        "control" => (None, "x = { dialect = '' }"),
        "gauge" => (Some("tool"), "x = [0, 0, 0]"),
        "dialect" => (Some("control"), "x = ''"),
        _ => return false,
    };
    let parent = match parent {
        None => Some(table),
        Some(parent) => match table.get_mut(parent).map(Spanned::get_mut) {
            Some(DeValue::Table(inner)) => Some(inner),
            _ => None,
        },
    };
    let value = DeTable::parse(text).map(Spanned::into_inner);
    let (Some(parent), Ok(mut value)) = (parent, value) else {
        return false;
    };
    let Some(value) = value.remove("x") else {
        return false;
    };
    let key = key.to_owned().into();
    parent.insert(Spanned::new(0..0, key), value).is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_serde_are_told_as_those_of_a_machine_file() {
        #[derive(Debug, Deserialize)]
        #[serde(deny_unknown_fields)]
        #[expect(dead_code, reason = "only its messages are of use")]
        struct One {
            tolerance: Option<Two>,
            corner: Option<f64>,
        }
        #[derive(Debug, Deserialize)]
        #[serde(rename_all = "lowercase")]
        enum Two {
            Bisect,
            Even,
        }
        let said = |text: &str| {
            let error = toml::from_str::<One>(text).unwrap_err();
            explained(error.message())
        };
        assert_eq!(
            said("tolerence = 1"),
            (
                "there is no key `tolerence` here".to_owned(),
                Some("did you mean `tolerance`? known are tolerance, corner".to_owned())
            )
        );
        assert_eq!(
            said("tolerance = \"evn\""),
            (
                "there is no value `evn` here".to_owned(),
                Some("did you mean `even`? known are bisect, even".to_owned())
            )
        );
        let (message, help) = said("corner = \"x\"");
        assert!(message.contains("expected f64"), "{message}");
        assert_eq!(help, None);
    }
}
