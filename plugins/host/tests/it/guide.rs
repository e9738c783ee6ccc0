//! The guide shows what is built and tested here, and lists the options that there are.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use post_kit::ORDER;
use post_plugin::{CAPABILITIES, Capabilities, EVENTS, Event};

/// A page of the guide for authors.
macro_rules! page {
    ($name:literal) => {
        include_str!(concat!("../../../../docs/src/plugin-author/", $name, ".md"))
    };
}

#[test]
fn the_guide_shows_the_examples() {
    let model = include_str!("../../../parabolic/src/lib.rs");
    let model = model.split("\n#[cfg(test)]").next().unwrap();
    for (name, page, source) in [
        ("error-model", page!("error-model"), model),
        ("dialect-in-rust", page!("dialect-in-rust"), include_str!("../../examples/post_tiny.rs")),
        ("iso-table", page!("iso-table"), include_str!("../../examples/post_gcode.rs")),
    ] {
        assert!(page.contains(source), "{name}.md must show its example as it is");
    }
}

/// The names of a set, as in Rust.
fn names(set: Capabilities) -> String {
    let specs = CAPABILITIES.iter().filter(|spec| set.has(spec.set));
    let mut names: Vec<String> = specs.map(|spec| format!("`{}`", spec.name)).collect();
    if names.len() > 2 {
        // One for all: `ARC_XY`, `CYCLE_DRILL`.
        let family = names[0].split('_').next().unwrap();
        names = vec![format!("{family}_…`")];
    }
    names.join(", ")
}

fn events() -> String {
    let mut table = String::from("| event | declared by | carries | comes |\n|---|---|---|---|\n");
    for (spec, event) in EVENTS.iter().zip(Event::samples()) {
        assert_eq!(spec.kind, event.kind());
        let fields: Vec<&str> = spec.fields.iter().map(|field| field.name).collect();
        let order = ORDER.iter().find(|(name, _)| *name == spec.name).unwrap();
        table.push_str(&format!(
            "| `{}` | {} | {} | {} |\n",
            spec.name,
            names(event.sent_under()),
            fields.join(", "),
            order.1
        ));
    }
    table
}

fn capabilities() -> String {
    let mut table = String::from("| capability | the dialect writes |\n|---|---|\n");
    for spec in CAPABILITIES {
        table.push_str(&format!("| `{}` | {} |\n", spec.name, spec.doc.trim()));
    }
    table
}

/// The fields of the table that a control of the G-code family fills in, from their documentation.
fn fields() -> String {
    let source = include_str!("../../../iso/src/table.rs");
    let table = source.split_once("pub struct Table {\n").unwrap().1;
    let table = table.split_once("\n}\n").unwrap().0;
    let mut fields = String::from("| field | what it is |\n|---|---|\n");
    let mut doc: Vec<&str> = Vec::new();
    for line in table.lines().map(str::trim) {
        if let Some(text) = line.strip_prefix("/// ") {
            doc.push(text);
        } else if let Some((name, _)) =
            line.strip_prefix("pub ").and_then(|rest| rest.split_once(':'))
        {
            let doc = std::mem::take(&mut doc).join(" ");
            // Links of rustdoc lead nowhere here.
            let doc = doc.replace("[`", "`").replace("`]", "`").replace("crate::", "post_iso::");
            fields.push_str(&format!("| `{name}` | {doc} |\n"));
        }
    }
    fields
}

#[test]
fn the_guide_has_all_events_capabilities_and_fields_of_the_table() {
    for (name, page, marks) in [
        ("events", page!("events"), vec![("events", events()), ("capabilities", capabilities())]),
        ("iso-table", page!("iso-table"), vec![("iso-table", fields())]),
    ] {
        let mut guide = page.to_owned();
        for (mark, table) in marks {
            let (begin, end) =
                (format!("<!-- {mark}: begin -->\n"), format!("<!-- {mark}: end -->"));
            let (before, rest) = guide.split_once(&begin).unwrap();
            let (_, after) = rest.split_once(&end).unwrap();
            guide = format!("{before}{begin}{table}{end}{after}");
        }
        if std::env::var_os("UPDATE_GUIDE").is_some() {
            let pages = "../../docs/src/plugin-author";
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(pages).join(format!("{name}.md"));
            std::fs::write(path, guide).unwrap();
            continue;
        }
        assert!(
            guide == page,
            "{name}.md is stale: run UPDATE_GUIDE=1 cargo test -p post-host --test it guide"
        );
    }
}
