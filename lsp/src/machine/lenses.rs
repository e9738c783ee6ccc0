//! `post check` above a machine file.

use gen_lsp_types::{CodeLens, Command, Range as LspRange};
use serde_json::json;

use super::tree::Tree;
use crate::commands::{CHECK, COMMISSION};
use crate::document::Snapshot;

/// What can be clicked, above the machine's name.
pub fn lenses(of: &Snapshot) -> Vec<CodeLens> {
    let tree = Tree::of(&of.text);
    let name = tree.get(&["name"]).or_else(|| tree.get(&["extends"]));
    let range = match name.and_then(|entry| entry.key.clone()) {
        Some(key) => of.lines.range(&of.text, key),
        None => LspRange::default(),
    };
    let lens = |title: &str, command: &str| CodeLens {
        range,
        command: Some(Command {
            title: title.to_owned(),
            tooltip: None,
            command: command.to_owned(),
            arguments: Some(vec![json!(of.uri)]),
        }),
        data: None,
    };
    vec![lens("post check", CHECK), lens("post check --commission", COMMISSION)]
}
