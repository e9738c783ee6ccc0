//! Pages of the book, and their fenced blocks.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{PACKAGE, root};

/// The book's sources.
pub fn sources() -> PathBuf {
    root().join("docs/src")
}

/// All pages in the order of their names, from the folder of the sources.
pub fn pages() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![sources()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "md") {
                found.push(path.strip_prefix(sources()).unwrap().to_owned());
            }
        }
    }
    found.sort();
    found
}

/// `UPDATE_GUIDE=1`: pages are written, not compared.
pub fn updating() -> bool {
    std::env::var_os("UPDATE_GUIDE").is_some()
}

/// What writes them.
pub fn update() -> String {
    format!("UPDATE_GUIDE=1 cargo test -p {PACKAGE} --test it guides")
}

/// Compares the page of the reference with what is written from `from`, or writes it.
#[track_caller]
pub fn is(page: &str, from: &str, text: &str) {
    let path = sources().join("reference").join(page);
    let text = format!("<!-- Written from {from} by {} -->\n\n{}\n", update(), text.trim_end());
    if updating() {
        write(&path, &text);
    }
    let there = fs::read_to_string(&path).unwrap_or_default();
    assert!(there == text, "docs/src/reference/{page} is stale: run {}", update());
}

/// A stretch of a page.
#[derive(Debug, PartialEq)]
pub enum Part<'a> {
    /// Lines outside of fenced blocks, and the fences.
    Text(Vec<&'a str>),
    /// The lines of a fenced block, with what stands behind its fence and the page's line of its first line.
    Block { info: &'a str, line: usize, lines: Vec<&'a str> },
}

/// A page as text and blocks in turns: all lines are in it, in order.
pub fn parts(text: &str) -> Vec<Part<'_>> {
    let mut parts = vec![Part::Text(Vec::new())];
    let mut fence = None;
    for (index, line) in text.lines().enumerate() {
        let ticks = line.len() - line.trim_start_matches('`').len();
        match fence {
            Some(opened) if ticks == opened && ticks == line.len() => {
                fence = None;
                parts.push(Part::Text(vec![line]));
                continue;
            }
            None if ticks >= 3 => {
                fence = Some(ticks);
                let Some(Part::Text(lines)) = parts.last_mut() else { unreachable!() };
                lines.push(line);
                parts.push(Part::Block {
                    info: &line[ticks..],
                    line: index + 2,
                    lines: Vec::new(),
                });
                continue;
            }
            _ => {}
        }
        match parts.last_mut().unwrap() {
            Part::Text(lines) | Part::Block { lines, .. } => lines.push(line),
        }
    }
    assert_eq!(fence, None, "a fenced block is not closed");
    parts
}

/// What `key=` says behind a fence.
pub fn told<'a>(info: &'a str, key: &str) -> Option<&'a str> {
    info.split(',').find_map(|word| word.trim().strip_prefix(key)?.strip_prefix('='))
}

/// The language of a block.
pub fn language(info: &str) -> &str {
    info.split(',').next().unwrap().trim()
}

/// Writes a page if it is something else.
pub fn write(path: &Path, text: &str) {
    if fs::read_to_string(path).ok().as_deref() != Some(text) {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

#[test]
fn a_page_is_taken_apart() {
    let page = "A\n```console,exit=1\n$ b\n```\nC\n````md\n```sh\nd\n```\n````\n";
    let parts = parts(page);
    let Part::Block { info, line, lines } = &parts[1] else { panic!("{parts:?}") };
    assert_eq!((language(info), told(info, "exit")), ("console", Some("1")));
    assert_eq!((*line, lines.as_slice()), (3, &["$ b"][..]));
    let Part::Block { lines, .. } = &parts[3] else { panic!("{parts:?}") };
    assert_eq!(lines, &["```sh", "d", "```"]);
}
