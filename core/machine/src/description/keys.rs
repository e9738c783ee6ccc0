//! Keys and words of a machine file that it does not have: all of them, each with what was likely meant.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::Axis;
use super::file::MachineFile;
use super::layers::MachineSources;
use super::table::{EntryError, Slip};
use crate::diagnostic::{Diagnostic, meant, nearest};

/// Keys at the top of a file that are taken out before the rest is read.
pub(super) const TAKEN_OUT: [&str; 2] = ["extends", "head"];

/// Who may keep the tip, `[control] tcp`.
const KEEPERS: [&str; 2] = ["control", "post"];

/// Unknown keys of one file that are told, each by itself.
const MOST: usize = 20;

/// What a merged table says, as far as it can be read.
pub(super) struct TypedFile {
    /// The file without what could not be read; none where something that it needs is missing.
    pub(super) file: Option<MachineFile>,
    /// All keys that are not known, all values of another kind than their keys ask for, and what is missing.
    pub(super) faults: Vec<Diagnostic>,
    /// Faults that leave something out of the file: a slip is read as what was likely meant, and leaves nothing out.
    pub(super) hiding: Vec<Diagnostic>,
}

/// What the merged table says; `whole` if all of the texts that it was merged from could be read.
pub(super) fn typed(
    mut table: Spanned<DeTable<'_>>,
    sources: &MachineSources,
    whole: bool,
) -> TypedFile {
    let mut faults = Vec::new();
    let mut hiding: Vec<Diagnostic> = Vec::new();
    let mut taken: Vec<String> = Vec::new();
    let mut stood_in = false;
    while faults.len() < MOST {
        // Reading ends at its first fault: what is wrong is put right or taken out, and the rest read again.
        let EntryError { span, slip } = match MachineFile::of(table.get_ref(), table.span()) {
            Ok(file) => {
                return TypedFile { file: Some(file).filter(|_| !stood_in), faults, hiding };
            }
            Err(unread) => unread,
        };
        let near_taken = |key: &str| nearest(key, taken.iter().map(String::as_str)).is_some();
        let echo = matches!(slip, Slip::Missing(key) if !whole || near_taken(key));
        let fault = slip.fault().at(sources.place(span.clone()));
        let gone = match slip {
            Slip::Missing(key) => {
                stood_in = true;
                stand_in(table.get_mut(), key)
            }
            _ if put_right(table.get_mut(), &span, &slip) => true,
            _ => take(table.get_mut(), &span).is_some_and(|key| {
                taken.push(key);
                hiding.push(fault.clone());
                true
            }),
        };
        if !echo {
            faults.push(fault);
        }
        if !gone {
            break;
        }
    }
    TypedFile { file: None, faults, hiding }
}

impl Slip {
    /// What is wrong, and what would help: the finding has no place yet.
    fn fault(&self) -> Diagnostic {
        let of_several = |says: &str, name: &str, known: &[&str]| {
            let fault =
                Diagnostic::error("machine-key", format!("there is no {says} `{name}` here"));
            fault.help(meant(name, "known are", known))
        };
        match self {
            Self::Key { name, known } if known.contains(&"chain") => {
                of_several("key", name, &[known.as_slice(), &TAKEN_OUT].concat())
            }
            Self::Key { name, known } => of_several("key", name, known),
            Self::Word { name, known } if known == &KEEPERS && ["true", "false"].contains(&name.as_str()) => {
                Diagnostic::error("machine-key", format!("`{name}` does not say who keeps the tip"))
                    .help("\"control\": the words are the tip's (RTCP, TCP, TCPM: G43.4, TRAORI, M128); \"post\": they are axis positions")
            }
            Self::Word { name, known } => of_several("value", name, known),
            Self::Missing(key) => {
                Diagnostic::error("machine-key", format!("missing field `{key}`"))
            }
            Self::Kind(message) => Diagnostic::error("machine-key", message.clone()),
        }
    }
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
fn put_right(table: &mut DeTable<'_>, span: &Range<usize>, slip: &Slip) -> bool {
    match slip {
        Slip::Key { name, known } => {
            nearest(name, known.iter().copied()).is_some_and(|meant| {
                with_key(table, span, &mut |table, key| {
                    let Some(value) = table.remove(key) else {
                        return false;
                    };
                    // Where it stands already, nothing is missing without the slip.
                    if !table.contains_key(meant) {
                        let name = Spanned::new(span.clone(), meant.to_owned().into());
                        table.insert(name, value);
                    }
                    true
                })
            })
        }
        Slip::Word { name, known } => nearest(name, known.iter().copied()).is_some_and(|meant| {
            with_value(table, span, &mut |value| {
                *value = DeValue::String(meant.to_owned().into());
            })
        }),
        _ => false,
    }
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
