//! The verbs apart from one another, and the command line as a whole.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::root;

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    entries
        .map(|entry| entry.unwrap().path())
        .flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] })
        .collect()
}

#[test]
fn no_verb_names_another_and_nothing_below_names_a_verb() {
    let src = root().join("src");
    let entries = fs::read_dir(src.join("verbs")).unwrap();
    let mut ways = vec!["crate::verbs".to_owned(), "super::super".to_owned()];
    for entry in entries {
        let path = entry.unwrap().path();
        let verb = path.file_stem().unwrap().to_str().unwrap();
        ways.extend([format!("super::{verb}::"), format!("super::{verb};")]);
    }
    for path in sources(&src) {
        let text = fs::read_to_string(&path).unwrap();
        let named = ways.iter().find(|way| text.contains(*way));
        assert!(
            named.is_none() || path.ends_with("verbs/mod.rs"),
            "{} names a verb by {named:?}: what two of them need belongs into a room below",
            path.display()
        );
    }
}

#[test]
fn the_command_line_holds_together() {
    post_command::internals::command_line().debug_assert();
}
