//! What is offered while a text is written, as the protocol has it.

use gen_lsp_types::{CompletionItem, CompletionItemKind, Documentation, MarkupContent, MarkupKind};

/// A word that is offered, and what is said of it, in Markdown.
pub fn item(label: &str, kind: CompletionItemKind, about: String) -> CompletionItem {
    CompletionItem {
        label: label.to_owned(),
        kind: Some(kind),
        documentation: Some(Documentation::MarkupContent(MarkupContent {
            kind: MarkupKind::Markdown,
            value: about,
        })),
        ..CompletionItem::default()
    }
}
