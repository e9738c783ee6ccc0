//! Where a parameter is defined and used, in a file, in those that it extends, and in those that extend it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use post_grammar::parse_expression;
use post_machine::description::Source;

use super::library::Library;
use super::meaning::Meaning;
use super::tree::{Entry, Tree};
use crate::document::Snapshot;

/// A machine extends another over so many steps, as the loader has it.
const DEPTH: usize = 8;

/// Files beside the open ones that are looked through for machines that extend one another.
const MOST_FILES: usize = 200;

/// A name in a text.
#[derive(Clone, Debug)]
pub struct Occurrence {
    /// The parameter.
    pub name: String,
    /// Where its name stands, bytes.
    pub span: Range<usize>,
    /// It is defined there, else used.
    pub defines: bool,
}

/// All names of parameters in a text.
pub fn occurrences(text: &str) -> Vec<Occurrence> {
    let mut found = Vec::new();
    for entry in &Tree::of(text).entries {
        if let Some(key) = &entry.key
            && let [.., table, name] = entry.path.as_slice()
            && table == "parameters"
            && let Some(key) = unquoted(text, key, name)
        {
            found.push(Occurrence { name: name.clone(), span: key, defines: true });
        }
        found.extend(uses(text, entry));
    }
    found.sort_by_key(|one| one.span.start);
    found
}

/// The names in an expression.
fn uses(text: &str, entry: &Entry) -> Vec<Occurrence> {
    let Some(written) = &entry.text else {
        return Vec::new();
    };
    if !Meaning::of(&entry.path).is_some_and(Meaning::is_number) {
        return Vec::new();
    }
    // A text with escapes is at no place that its letters tell.
    let Some(inner) = unquoted(text, &entry.value, written) else {
        return Vec::new();
    };
    let Ok(expression) = parse_expression(written) else {
        return Vec::new();
    };
    let references = expression.references().into_iter();
    references
        .map(|(span, name)| Occurrence {
            name: name.to_owned(),
            span: inner.start + span.start..inner.start + span.end,
            defines: false,
        })
        .collect()
}

/// Where `written` stands at `span`, without quotes.
fn unquoted(text: &str, span: &Range<usize>, written: &str) -> Option<Range<usize>> {
    let raw = text.get(span.clone())?;
    let at = raw.find(written)?;
    let quotes = |part: &str| part.chars().all(|letter| letter == '"' || letter == '\'');
    let (before, after) = (&raw[..at], &raw[at + written.len()..]);
    (quotes(before) && quotes(after)).then(|| span.start + at..span.start + at + written.len())
}

/// The name at a byte.
pub fn at(text: &str, byte: usize) -> Option<Occurrence> {
    let mut all = occurrences(text).into_iter();
    all.find(|one| one.span.start <= byte && byte <= one.span.end)
}

/// A file and those that it extends, the file first.
pub fn layers(of: &Snapshot, library: &Library) -> Vec<Source> {
    let own = Source { name: of.name.clone(), text: of.text.clone() };
    with_parents(own, library)
}

fn with_parents(own: Source, library: &Library) -> Vec<Source> {
    let mut layers = vec![own];
    while layers.len() <= DEPTH
        && let Some(last) = layers.last()
    {
        let tree = Tree::of(&last.text);
        let extends = tree.get(&["extends"]).and_then(|entry| entry.text.clone());
        let Some(parent) = extends.and_then(|name| library.parent(&last.name, &name)) else {
            break;
        };
        if layers.iter().any(|layer| layer.name == parent.name) {
            break;
        }
        layers.push(parent);
    }
    layers
}

/// The parameters of a machine with their values, those that have one.
pub fn values(of: &Snapshot, library: &Library) -> BTreeMap<String, Option<f64>> {
    let evaluated = super::examine(of, library).map(|reading| reading.values);
    let evaluated = evaluated.unwrap_or_default();
    let mut values = BTreeMap::new();
    for layer in layers(of, library) {
        for entry in Tree::of(&layer.text).entries {
            let [table, name] = entry.path.as_slice() else {
                continue;
            };
            if table != "parameters" || values.contains_key(name) {
                continue;
            }
            let worked_out = evaluated
                .iter()
                .find(|value| value.file == layer.name && value.span == entry.value)
                .map(|value| value.value);
            values.insert(name.clone(), entry.number.or(worked_out));
        }
    }
    values
}

/// A file that shares parameters with others.
pub struct Member {
    /// Its name and text.
    pub source: Source,
    /// Its path; none for a machine that is built in.
    pub path: Option<PathBuf>,
}

impl Member {
    fn of(source: Source) -> Self {
        let path = Path::new(&source.name);
        let path = path.is_file().then(|| std::path::absolute(path).ok());
        Self { path: path.flatten(), source }
    }
}

/// The files that share the parameter `name` with a file: those that it extends, and those that extend one of them that
/// defines it.
pub fn family(of: &Snapshot, name: &str, library: &Library) -> Vec<Member> {
    let layers = layers(of, library);
    let defines = |source: &Source| {
        let mut all = occurrences(&source.text).into_iter();
        all.any(|one| one.defines && one.name == name)
    };
    let definers: Vec<String> =
        layers.iter().filter(|layer| defines(layer)).map(|layer| layer.name.clone()).collect();
    let mut members: Vec<Member> = layers.into_iter().map(Member::of).collect();
    for source in beside(of, library) {
        if members.iter().any(|member| member.source.name == source.name) {
            continue;
        }
        let chain = with_parents(source, library);
        if chain.iter().any(|layer| definers.contains(&layer.name)) {
            for layer in chain {
                if members.iter().all(|member| member.source.name != layer.name) {
                    members.push(Member::of(layer));
                }
            }
        }
    }
    members
}

/// Machine files that are open, or stand where this file or its machines do.
fn beside(of: &Snapshot, library: &Library) -> Vec<Source> {
    let mut paths: Vec<PathBuf> = library.open.keys().cloned().collect();
    let found = library.names(&of.name).into_iter();
    paths.extend(found.filter_map(|(_, path)| std::path::absolute(path?).ok()));
    paths.sort();
    paths.dedup();
    let sources = paths.iter().take(MOST_FILES);
    let sources = sources.filter_map(|path| library.read(path).ok());
    sources.filter(|source| super::is_machine(&source.text)).collect()
}

/// A name that a parameter can have.
pub fn is_name(name: &str) -> bool {
    let word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    name.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_')
        && name.chars().all(word)
        && name != "pi"
        && !post_grammar::FUNCTIONS.contains(&name)
}
