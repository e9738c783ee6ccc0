//! What is offered while a CL file is written.

use gen_lsp_types::{CompletionItem, CompletionItemKind};
use post_grammar::{MajorWord, WordUsage};

use super::hover::record;
use crate::document::Snapshot;
use crate::offers::item;

/// What is offered at a byte of the text: words that the program takes something from, or those that may stand behind the
/// word of the record.
pub fn items(of: &Snapshot, byte: usize) -> Vec<CompletionItem> {
    let (first, text) = record(of, of.lines.line_of(byte));
    let start = of.lines.span(&of.text, first).start;
    let before = text.get(..byte.saturating_sub(start)).unwrap_or(text);
    // Behind `$$` stands a remark.
    if before.contains("$$") {
        return Vec::new();
    }
    match before.split_once('/') {
        None => majors(),
        Some((word, _)) => MajorWord::find(word.trim()).map(minors).unwrap_or_default(),
    }
}

fn majors() -> Vec<CompletionItem> {
    let all = MajorWord::all().iter();
    let taken = all.filter(|word| matches!(word.usage, WordUsage::Used | WordUsage::Passed));
    taken
        .map(|word| {
            let records: Vec<&str> = word.records().collect();
            let about = format!("{}\n\n```\n{}\n```", word.meaning, records.join("\n"));
            let mut item = item(word.name(), CompletionItemKind::Keyword, about);
            item.detail = Some(word.example.to_owned());
            // What stands behind it follows.
            if word.example.get(word.name().len()..).is_some_and(|rest| rest.starts_with('/')) {
                item.insert_text = Some(format!("{}/", word.name()));
            }
            item
        })
        .collect()
}

fn minors(word: &MajorWord) -> Vec<CompletionItem> {
    let offered = word.minor_words().into_iter();
    offered
        .map(|minor| {
            let has = |record: &&str| record.split(['/', ',']).any(|part| part == minor);
            let record = word.records().find(has).unwrap_or_default();
            item(minor, CompletionItemKind::EnumMember, format!("```\n{record}\n```"))
        })
        .collect()
}
