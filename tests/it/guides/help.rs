//! The page of the reference that is the help of a command and of its verbs.

use std::fmt::Write as _;
use std::path::Path;

use super::page;
use crate::common::{BINARY, command, run};

/// The verbs that a help lists.
fn verbs(help: &str) -> Vec<&str> {
    let commands = help.split("\nCommands:\n").nth(1).unwrap_or_default();
    let rows = commands.lines().take_while(|line| !line.is_empty());
    rows.filter(|row| !row.starts_with("   "))
        .filter_map(|row| row.split_whitespace().next())
        .filter(|verb| *verb != "help")
        .collect()
}

/// Compares the page with the help of the command under test, or writes it; how many verbs it has.
pub fn check(page: &str, title: &str) -> usize {
    let name = Path::new(BINARY).file_stem().unwrap().to_str().unwrap();
    let mut text = format!("# {title}\n\nWhat `{name} --help` and `{name} VERB --help` print.\n");
    let mut tell = |words: &[&str]| {
        let run = run(command().args(words).arg("--help"), b"");
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{words:?}");
        let _ = write!(
            text,
            "\n## {}\n\n```text\n{}\n```\n",
            [&[name], words].concat().join(" "),
            run.out.lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
        );
        run.out
    };
    let top = tell(&[]);
    let verbs = verbs(&top);
    for verb in &verbs {
        let help = tell(&[verb]);
        for below in self::verbs(&help) {
            tell(&[verb, below]);
        }
    }
    page::is(page, &format!("`{name} --help`"), &text);
    verbs.len()
}
