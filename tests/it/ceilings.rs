//! Each room keeps to the lines that CONTRIBUTING gives it: a room that grows past them takes something away in the same
//! commit, or says there why it may not.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::common::root;

/// A room that has a tenth fewer lines than its ceiling, and so many, has a ceiling that holds nothing.
const SLACK: usize = 300;

/// Folders that hold tests, measurements, examples, or what is built.
const OUTSIDE: [&str; 6] = ["tests", "benches", "examples", "target", "vendor", "node_modules"];

/// The ceilings by room, as the table of CONTRIBUTING has them.
fn ceilings() -> BTreeMap<String, usize> {
    let text = fs::read_to_string(root().join("CONTRIBUTING.md")).unwrap();
    let table = text.split_once("| room | lines at most |").unwrap().1;
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let row = |line: &str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let lines = cells[2].replace(',', "");
        (cells[1].trim_matches('`').to_owned(), lines.parse().unwrap())
    };
    rows.map(row).collect()
}

/// The rooms: the crates of `core` and `plugins`, and the folders beside them that hold Rust.
fn rooms() -> Vec<String> {
    let folders = |within: &str| -> Vec<String> {
        let entries = fs::read_dir(root().join(within)).unwrap();
        let paths = entries.map(|entry| entry.unwrap().path());
        let crates = paths.filter(|path| path.join("Cargo.toml").is_file());
        crates.map(|path| path.strip_prefix(root()).unwrap().display().to_string()).collect()
    };
    let mut rooms = vec!["src".to_owned()];
    for within in ["core", "plugins", ""] {
        rooms.extend(folders(within));
    }
    rooms.sort();
    rooms
}

/// The files of Rust within a folder.
fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && !OUTSIDE.contains(&name.as_str()) {
            sources(&path, into);
        } else if name.ends_with(".rs") && name != "tests.rs" {
            into.push(path);
        }
    }
}

/// The lines of a text without its inline modules of tests.
fn lines_outside_tests(text: &str) -> usize {
    let mut lines = text.lines().peekable();
    let mut count = 0;
    while let Some(line) = lines.next() {
        if line != "#[cfg(test)]" || !lines.peek().is_some_and(|next| next.starts_with("mod ")) {
            count += 1;
            continue;
        }
        let whole = lines.next().is_some_and(|line| line.ends_with('{'));
        while whole && lines.next().is_some_and(|line| line != "}") {}
    }
    count
}

/// The row of what a user's house weighs: all rooms but that of the papers' comparisons.
const WHOLE: &str = "all but papers";

fn size(room: &str) -> usize {
    if room == WHOLE {
        return rooms().iter().filter(|room| *room != "papers").map(|room| size(room)).sum();
    }
    let mut files = Vec::new();
    sources(&root().join(room), &mut files);
    files.iter().map(|file| lines_outside_tests(&fs::read_to_string(file).unwrap())).sum()
}

#[test]
fn each_room_keeps_to_its_lines() {
    let ceilings = ceilings();
    let mut faults = Vec::new();
    for room in rooms().into_iter().chain([WHOLE.to_owned()]) {
        let lines = size(&room);
        match ceilings.get(&room) {
            None => faults.push(format!("{room} has {lines} lines and no row in the table of CONTRIBUTING")),
            Some(most) if lines > *most => faults.push(format!(
                "{room} has {lines} lines, {} more than its {most}: take away what the change replaces, or raise the row and say in the commit why",
                lines - most
            )),
            Some(most) if most - lines > SLACK.max(most / 10) => faults
                .push(format!("{room} has {lines} lines, and {most} in the table of CONTRIBUTING: lower the row")),
            Some(_) => {}
        }
    }
    let is_room = |room: &str| room == WHOLE || root().join(room).is_dir();
    for room in ceilings.keys().filter(|room| !is_room(room)) {
        faults.push(format!("{room} has a row in the table of CONTRIBUTING and is not there"));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn lines_of_tests_are_not_counted() {
    let text = "fn a() {}\n\n#[cfg(test)]\nmod tests {\n    fn b() {}\n}\nfn c() {}\n#[cfg(test)]\nmod more;\n";
    assert_eq!(lines_outside_tests(text), 3);
}
