//! What a click puts right in a machine file.

use std::ops::Range;

use post_machine::diagnostic::Diagnostic;

use super::library::Library;
use super::tree::Tree;
use crate::document::Snapshot;
use crate::fixes::{Change, Fix, meant, touching, written};

/// The fixes for findings that touch a part of the text.
pub fn fixes(of: &Snapshot, part: &Range<usize>, library: &Library) -> Vec<Fix> {
    let tree = Tree::of(&of.text);
    touching(of, part, super::findings(of, library), |finding, span| {
        near_word(of, finding, span)
            .or_else(|| turned_travel(of, &tree, finding, span))
            .or_else(|| missing_axis(of, &tree, finding, span))
    })
}

/// A word that was likely meant.
fn near_word(of: &Snapshot, finding: &Diagnostic, span: &Range<usize>) -> Option<(String, Change)> {
    let meant = meant(finding)?;
    let wrong_text = &of.text[span.clone()];
    let quote = wrong_text.chars().next().filter(|first| matches!(first, '"' | '\''));
    let text = match quote {
        // In an expression the wrong name is a part of it.
        Some(_) if finding.code == "machine-expression" => {
            let wrong =
                finding.message.split_once(": `").and_then(|(_, rest)| rest.split_once('`'))?.0;
            let at = wrong_text.find(wrong)?;
            format!("{}{meant}{}", &wrong_text[..at], &wrong_text[at + wrong.len()..])
        }
        Some(quote) => format!("{quote}{meant}{quote}"),
        None => meant.to_owned(),
    };
    Some(written(meant, span, text))
}

/// A travel whose ends stand the wrong way round.
fn turned_travel(
    of: &Snapshot,
    tree: &Tree,
    finding: &Diagnostic,
    span: &Range<usize>,
) -> Option<(String, Change)> {
    if finding.code != "machine-travel" {
        return None;
    }
    let travel = tree.entries.iter().find(|entry| {
        entry.value.start <= span.start
            && span.end <= entry.value.end
            && entry.path.last().is_some_and(|key| key == "travel")
    })?;
    let end = |item: &str| {
        let path: Vec<&str> = travel.path.iter().map(String::as_str).collect();
        tree.get(&[path.as_slice(), &[item]].concat())
    };
    let (least, most) = (end("[0]")?, end("[1]")?);
    if least.number? <= most.number? {
        return None;
    }
    let text = format!("[{}, {}]", &of.text[most.value.clone()], &of.text[least.value.clone()]);
    Some((format!("Turn it round: {text}"), Change { span: travel.value.clone(), text }))
}

/// An axis of the chain that is not described.
fn missing_axis(
    of: &Snapshot,
    tree: &Tree,
    finding: &Diagnostic,
    span: &Range<usize>,
) -> Option<(String, Change)> {
    let chain = &tree.get(&["chain"])?.value;
    if finding.code != "machine-axis" || span.start < chain.start || chain.end < span.end {
        return None;
    }
    let name = of.text[span.clone()].trim_end_matches('\'');
    if tree.get(&["axis", name]).is_some() {
        return None;
    }
    let mut letters = name.chars();
    let letter = letters.next().filter(char::is_ascii_uppercase)?;
    let direction = |first: char| match letter as u8 - first as u8 {
        0 => "[1, 0, 0]",
        1 => "[0, 1, 0]",
        _ => "[0, 0, 1]",
    };
    let axis = match letter {
        'A'..='C' => {
            format!("rotary = {}\npoint = [0, 0, 0]\ntravel = [-120, 120]\n", direction('A'))
        }
        'X'..='Z' => format!("linear = {}\ntravel = [-300, 300]\n", direction('X')),
        _ => "linear = [1, 0, 0]\ntravel = [-300, 300]\n".to_owned(),
    };
    // Behind the last axis, or at the end.
    let last = tree
        .entries
        .iter()
        .filter(|entry| entry.path.first().is_some_and(|key| key == "axis"))
        .map(|entry| entry.value.end)
        .max();
    let end = last.map_or(of.text.len(), |last| {
        let line = of.lines.line_of(last);
        of.lines.span(&of.text, line).end
    });
    Some((
        format!("Describe {name} (fill in its numbers)"),
        Change { span: end..end, text: format!("\n\n[axis.{name}]\n{}", axis.trim_end()) },
    ))
}
