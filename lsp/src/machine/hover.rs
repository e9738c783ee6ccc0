//! What is said of a place in a machine file.

use std::ops::Range;

use post_machine::diagnostic::Short;

use super::library::Library;
use super::meaning::Meaning;
use super::parameters;
use super::tree::{Entry, Tree};
use crate::document::Snapshot;

/// What is said, in Markdown, and of which bytes.
pub fn text(of: &Snapshot, byte: usize, library: &Library) -> Option<(String, Range<usize>)> {
    if let Some(name) = parameters::at(&of.text, byte) {
        let values = parameters::values(of, library);
        let value = match values.get(&name.name).copied().flatten() {
            Some(value) => format!(" = {}", Short(value)),
            None => String::new(),
        };
        let mut text = format!("`{}`{value}", name.name);
        let layers = parameters::layers(of, library);
        let definers = layers.iter().filter(|layer| {
            let mut all = parameters::occurrences(&layer.text).into_iter();
            all.any(|one| one.defines && one.name == name.name)
        });
        let definers: Vec<&str> = definers.map(|layer| layer.name.as_str()).collect();
        text.push_str(&match definers.as_slice() {
            [] => "\n\nNo such parameter.".to_owned(),
            [own] if *own == of.name => "\n\nA parameter of this file.".to_owned(),
            [first, ..] => format!("\n\nA parameter, defined in {first}."),
        });
        return Some((text, name.span));
    }
    let tree = Tree::of(&of.text);
    let entry = tree.at(byte)?;
    // A header says what its last name means: of `[axis.X]` the table of an axis.
    let meaning = Meaning::of(&entry.path)?;
    let on_key = entry.key.clone().filter(|key| key.contains(&byte));
    let span = on_key.unwrap_or_else(|| entry.value.clone());
    let mut text = format!("`{}`", entry.path.join(".").replace(".[", "["));
    if let Some(value) = evaluated(of, entry, library) {
        text.push_str(&format!(" = {}", Short(value)));
    }
    let about = match meaning.description() {
        // Items of a list are explained by the list.
        None => Meaning::of(&entry.path[..entry.path.len().saturating_sub(1)])?.text(),
        Some(_) => meaning.text(),
    };
    text.push_str(&format!("\n\n{about}"));
    if let Some(unit) = unit(&tree, &entry.path, &about) {
        text.push_str(&format!("\n\nHere: {unit}."));
    }
    Some((text, span))
}

/// The value of an expression.
fn evaluated(of: &Snapshot, entry: &Entry, library: &Library) -> Option<f64> {
    entry.text.as_ref()?;
    let reading = super::examine(of, library).ok()?;
    let mut values = reading.values.into_iter();
    values.find(|value| value.file == of.name && value.span == entry.value).map(|value| value.value)
}

/// Which of two units a number of an axis has: `mm or degrees` is told for any axis.
fn unit(tree: &Tree, path: &[String], about: &str) -> Option<&'static str> {
    let [table, axis, ..] = path else {
        return None;
    };
    let both = about.contains(" or degrees") || about.contains(" or deg");
    if table != "axis" || !both {
        return None;
    }
    let has = |kind: &str| tree.get(&["axis", axis, kind]).is_some();
    match (has("linear"), has("rotary")) {
        (true, false) => Some("a linear axis, so mm"),
        (false, true) => Some("a rotary axis, so degrees"),
        _ => None,
    }
}
