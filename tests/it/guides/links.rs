//! Links of the book and of the guides beside it lead somewhere.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::common::root;
use crate::guides::page::{Part, pages, parts, sources};

/// Pages outside of the book.
const BESIDE: [&str; 7] = [
    "README.md",
    "CONTRIBUTING.md",
    "CHANGELOG.md",
    "machines/README.md",
    "plugins/README.md",
    "core/README.md",
    "editors/README.md",
];

/// A page's text with what it includes.
fn text_of(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let mut whole = String::new();
    for line in text.lines() {
        match line.strip_prefix("{{#include ").and_then(|line| line.strip_suffix("}}")) {
            Some(file) if !file.contains(':') => {
                whole.push_str(&text_of(&path.parent().unwrap().join(file)));
            }
            _ => {
                whole.push_str(line);
                whole.push('\n');
            }
        }
    }
    whole
}

/// The lines outside of fenced blocks.
fn prose(text: &str) -> Vec<String> {
    let parts = parts(text).into_iter();
    let lines = parts.flat_map(|part| match part {
        Part::Text(lines) => lines,
        Part::Block { .. } => Vec::new(),
    });
    lines.map(without_code).collect()
}

/// A line without what stands between backticks.
fn without_code(line: &str) -> String {
    let mut rest = line;
    let mut bare = String::new();
    while let Some(at) = rest.find('`') {
        let ticks = rest[at..].len() - rest[at..].trim_start_matches('`').len();
        let (fence, behind) = (&rest[at..at + ticks], &rest[at + ticks..]);
        bare.push_str(&rest[..at]);
        let Some(end) = behind.find(fence) else {
            rest = behind;
            continue;
        };
        rest = &behind[end + ticks..];
    }
    bare + rest
}

/// Where the links and pictures of a line lead.
fn targets(line: &str) -> Vec<&str> {
    let ends = [("](", ')'), ("src=\"", '"'), ("href=\"", '"')];
    let found = ends.into_iter().flat_map(|(begins, ends)| {
        line.match_indices(begins).filter_map(move |(at, _)| {
            let target = line[at + begins.len()..].split(ends).next()?;
            target.split_whitespace().next()
        })
    });
    found.collect()
}

/// The anchors of a page, as mdBook and the forges make them of its headings.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    let parts = parts(text).into_iter();
    let lines = parts.flat_map(|part| match part {
        Part::Text(lines) => lines,
        Part::Block { .. } => Vec::new(),
    });
    for line in lines {
        let heading = line.trim_start_matches('#');
        let depth = line.len() - heading.len();
        if !(1..=6).contains(&depth) || !heading.starts_with(' ') {
            continue;
        }
        let anchor: String = heading
            .trim()
            .chars()
            .filter_map(|letter| match letter {
                ' ' => Some('-'),
                _ if letter.is_alphanumeric() || "-_".contains(letter) => {
                    Some(letter.to_ascii_lowercase())
                }
                _ => None,
            })
            .collect();
        let mut own = anchor.clone();
        let mut count = 0;
        while !anchors.insert(own.clone()) {
            count += 1;
            own = format!("{anchor}-{count}");
        }
    }
    anchors
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => {
                plain.pop();
            }
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}

#[test]
fn every_link_leads_somewhere() {
    let book = pages().into_iter().map(|page| sources().join(page));
    let beside = BESIDE.map(|page| root().join(page));
    let (mut links, mut faults) = (0, Vec::new());
    for path in book.chain(beside) {
        let text = text_of(&path);
        for line in prose(&text) {
            for target in targets(&line) {
                if target.contains("://") || target.starts_with("mailto:") {
                    continue;
                }
                links += 1;
                let mut fault = |why: &str| {
                    let page = path.strip_prefix(root()).unwrap().display();
                    faults.push(format!("{page}: {target} {why}"));
                };
                let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
                let there = match file {
                    "" => path.clone(),
                    file => plain(&path.parent().unwrap().join(file)),
                };
                if !there.exists() {
                    fault("is not there");
                    continue;
                }
                if path.starts_with(sources()) && !there.starts_with(sources()) {
                    fault("leads out of the book, which is read without the checkout");
                }
                let is_page = there.extension().is_some_and(|end| end == "md");
                if !anchor.is_empty() && is_page && !anchors(&text_of(&there)).contains(anchor) {
                    fault("has no such heading");
                }
            }
        }
    }
    assert!(links > 100, "{links} links");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_contents_have_every_page_once() {
    let summary = fs::read_to_string(sources().join("SUMMARY.md")).unwrap();
    let mut listed: Vec<PathBuf> = summary.lines().flat_map(targets).map(PathBuf::from).collect();
    listed.sort();
    let mut there = pages();
    there.retain(|page| page != Path::new("SUMMARY.md"));
    assert_eq!(listed, there);
}

#[test]
fn a_heading_is_found_as_the_book_makes_its_anchor() {
    let text = "# A `post` page\n## 1. What it means\n```sh\n# no heading\n```\n## Same\n## Same\n";
    let wanted = ["1-what-it-means", "a-post-page", "same", "same-1"];
    assert!(anchors(text).iter().eq(wanted), "{:?}", anchors(text));
    assert_eq!(without_code("a `[b](c)` [d](e)"), "a  [d](e)");
    assert_eq!(targets("[d](e) ![f](g.svg \"h\")"), ["e", "g.svg"]);
}
