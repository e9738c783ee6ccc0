//! The guide shows what is built and tested here, and lists the options that there are.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use post_host::{Plugin, default_of, takes};
use post_kit::ORDER;
use post_plugin::{CAPABILITIES, Capabilities, EVENTS, Event};

const GUIDE: &str = include_str!("../../../README.md");

#[test]
fn the_guide_shows_the_examples() {
    let model = include_str!("../../../parabolic/src/lib.rs");
    let model = model.split("\n#[cfg(test)]").next().unwrap();
    assert!(
        GUIDE.contains(model),
        "plugins/README.md must show parabolic/src/lib.rs as it is"
    );
    for (name, example) in [
        ("tiny", include_str!("../../examples/post_tiny.rs")),
        ("gcode", include_str!("../../examples/post_gcode.rs")),
    ] {
        assert!(
            GUIDE.contains(example),
            "plugins/README.md must show examples/post_{name}.rs as it is"
        );
    }
}

#[test]
fn the_guide_lists_the_options_of_the_stock_plugins() {
    for linked in post_stock::plugins() {
        let plugin = Plugin::linked(*linked).unwrap();
        if plugin.options().is_empty() {
            continue;
        }
        let mut table =
            String::from("| option | takes | default | what it does |\n|---|---|---|---|\n");
        for spec in plugin.options() {
            let (takes, default) = (takes(spec.kind), default_of(spec));
            let (key, help) = (spec.key, spec.help);
            table.push_str(&format!("| `{key}` | {takes} | {default} | {help} |\n"));
        }
        let name = plugin.name();
        assert!(
            GUIDE.contains(&table),
            "plugins/README.md must list the options of `{name}`:\n\n{table}"
        );
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

#[test]
fn the_guide_has_all_events_and_capabilities() {
    let mut guide = GUIDE.to_owned();
    for (mark, table) in [("events", events()), ("capabilities", capabilities())] {
        let (begin, end) = (
            format!("<!-- {mark}: begin -->\n"),
            format!("<!-- {mark}: end -->"),
        );
        let (before, rest) = guide.split_once(&begin).unwrap();
        let (_, after) = rest.split_once(&end).unwrap();
        guide = format!("{before}{begin}{table}{end}{after}");
    }
    if std::env::var_os("UPDATE_GUIDE").is_some() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
        std::fs::write(path, guide).unwrap();
        return;
    }
    assert!(
        guide == GUIDE,
        "plugins/README.md is stale: run UPDATE_GUIDE=1 cargo test -p post-host --test it guide"
    );
}
