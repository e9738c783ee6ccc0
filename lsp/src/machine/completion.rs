//! What is offered while a machine file is written.

use gen_lsp_types::{CompletionItem, CompletionItemKind};
use post_grammar::{FUNCTIONS, LinkKind, parse_chain};

use super::cursor::Cursor;
use super::library::Library;
use super::meaning::Meaning;
use super::parameters;
use super::tree::Tree;
use crate::document::Snapshot;
use crate::offers::item;
use post_job::plugin_finder::built_in;

/// What is offered at a byte of the text.
pub fn items(of: &Snapshot, byte: usize, library: &Library) -> Vec<CompletionItem> {
    let tree = Tree::of(&of.text);
    let offers = Offers { of, tree: &tree, library };
    match Cursor::at(&of.text, byte, &tree) {
        Cursor::Table(path) => offers.tables(&path),
        Cursor::Key(path) => offers.keys(&path),
        Cursor::Value(path, quoted) => offers.values(&path, quoted),
        Cursor::Nothing => Vec::new(),
    }
}

struct Offers<'a> {
    of: &'a Snapshot,
    tree: &'a Tree,
    library: &'a Library,
}

impl Offers<'_> {
    /// Names of tables.
    fn tables(&self, path: &[String]) -> Vec<CompletionItem> {
        let Some(meaning) = Meaning::of(path) else {
            return Vec::new();
        };
        let tables = meaning.keys().filter(|(_, meaning)| meaning.is_table());
        let mut items: Vec<_> = tables
            .map(|(key, meaning)| item(key, CompletionItemKind::Module, meaning.text()))
            .collect();
        if let [table] = path
            && matches!(table.as_str(), "axis" | "servo")
        {
            items.extend(self.axes(&self.missing(path)));
        }
        items
    }

    /// Keys of a table, those without that it has already.
    fn keys(&self, path: &[String]) -> Vec<CompletionItem> {
        let Some(meaning) = Meaning::of(path) else {
            return Vec::new();
        };
        let present: Vec<&str> = self.tree.keys(path).collect();
        let keys = meaning.keys().filter(|(key, _)| !present.contains(key));
        let mut items: Vec<_> = keys
            .map(|(key, meaning)| {
                let text = meaning.text();
                let mut item = item(key, CompletionItemKind::Property, text);
                if !meaning.is_table() {
                    item.insert_text = Some(format!("{key} = "));
                }
                item
            })
            .collect();
        if items.is_empty() && self.is_by_axis(path) {
            items.extend(self.axes(&self.missing(path)));
        }
        items
    }

    /// Tables whose keys are the axes.
    fn is_by_axis(&self, path: &[String]) -> bool {
        let names: Vec<&str> = path.iter().map(String::as_str).collect();
        matches!(
            names.as_slice(),
            ["solution", "prefer" | "require" | "start"]
                | ["control", "retract" | "change" | "park"]
                | ["control", "leave", "then"]
                | ["axis" | "servo"]
        )
    }

    /// Values.
    fn values(&self, path: &[String], quoted: bool) -> Vec<CompletionItem> {
        let Some(meaning) = Meaning::of(path) else {
            return Vec::new();
        };
        let text = |value: &str, kind, about: String| {
            let mut item = item(value, kind, about);
            if !quoted {
                item.insert_text = Some(format!("\"{value}\""));
            }
            item
        };
        let names: Vec<&str> = path.iter().map(String::as_str).collect();
        let named = |names: Vec<String>, what: &str| -> Vec<CompletionItem> {
            let items = names.into_iter();
            items.map(|name| text(&name, CompletionItemKind::Value, what.to_owned())).collect()
        };
        let own = |names: Vec<&str>| names.into_iter().map(str::to_owned).collect();
        match names.as_slice() {
            ["control", "dialect"] => return named(own(built_in(false)), "A dialect, built in."),
            ["accuracy", "model"] => {
                return named(own(built_in(true)), "An error model, built in.");
            }
            ["extends"] => {
                let machines = self.library.names(&self.of.name).into_iter();
                return named(machines.map(|(name, _)| name).collect(), "A machine.");
            }
            ["solution", "rule"] => {
                let mut rules = own(vec!["time", "cycle-time", "travel", "largest-axis"]);
                let axes = self.chain().into_iter();
                rules.extend(axes.map(|axis| format!("axis:{axis}")));
                return named(rules, meaning.description().unwrap_or_default());
            }
            ["solution", "exclusive", ..] => return named(self.chain(), "An axis."),
            _ => {}
        }
        if meaning.is_flag() {
            let flags = ["true", "false"];
            return flags
                .map(|flag| item(flag, CompletionItemKind::Value, meaning.text()))
                .to_vec();
        }
        if meaning.is_number() {
            return self.numbers(text);
        }
        let choices = meaning.choices().into_iter();
        choices
            .map(|choice| text(&choice.value, CompletionItemKind::EnumMember, choice.meaning))
            .collect()
    }

    /// Parameters and functions.
    fn numbers(
        &self,
        text: impl Fn(&str, CompletionItemKind, String) -> CompletionItem,
    ) -> Vec<CompletionItem> {
        let known = parameters::values(self.of, self.library);
        let mut items: Vec<_> = known
            .into_iter()
            .map(|(name, value)| {
                let about = match value {
                    Some(value) => format!("A parameter: {value}"),
                    None => "A parameter.".to_owned(),
                };
                text(&name, CompletionItemKind::Variable, about)
            })
            .collect();
        items.extend(FUNCTIONS.map(|name| {
            text(
                name,
                CompletionItemKind::Function,
                "A function; angles are in degrees.".to_owned(),
            )
        }));
        items.push(text("pi", CompletionItemKind::Constant, "3.14159…".to_owned()));
        items
    }

    /// The axes of the chain that a table does not have.
    fn missing(&self, path: &[String]) -> Vec<String> {
        let present: Vec<&str> = self.tree.keys(path).collect();
        let mut axes = self.chain();
        axes.retain(|axis| !present.contains(&axis.as_str()));
        axes
    }

    fn axes(&self, names: &[String]) -> Vec<CompletionItem> {
        let items = names.iter();
        items
            .map(|name| {
                let about = "An axis of the chain.".to_owned();
                item(name, CompletionItemKind::Field, about)
            })
            .collect()
    }

    /// The axes of the chain, of this file or of one that it extends.
    fn chain(&self) -> Vec<String> {
        for source in parameters::layers(self.of, self.library) {
            let tree = Tree::of(&source.text);
            let chain = tree.get(&["chain"]).and_then(|entry| entry.text.as_deref());
            let Some(links) = chain.and_then(|chain| parse_chain(chain).ok()) else {
                continue;
            };
            let axes = links.into_iter().filter_map(|link| match link.kind {
                LinkKind::Axis { name, .. } => Some(name),
                _ => None,
            });
            return axes.collect();
        }
        Vec::new()
    }
}
