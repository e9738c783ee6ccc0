//! The guide shows what is built and tested here, and lists the options that there are.

use post_host::{Plugin, default_of, takes};

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
