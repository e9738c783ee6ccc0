//! What is fuzzed (`tests/fuzz/targets.toml`) is read by the command too: texts that fuzzing begins with, and what it once
//! found.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{command, root, run};

/// A target's command lines are run on a file of these bytes: each ends well, or is refused with a reason.
fn take(name: &str, target: &toml::Table, bytes: &[u8], what: &str) {
    let text = |key: &str| target.get(key).and_then(toml::Value::as_str);
    let list = |key: &str| -> Vec<&str> {
        let list = target.get(key).and_then(toml::Value::as_array);
        list.into_iter().flatten().filter_map(toml::Value::as_str).collect()
    };
    let folder = tempfile::tempdir().unwrap();
    for beside in list("beside") {
        let (from, to) = beside.split_once('=').unwrap();
        fs::copy(root().join(from), folder.path().join(to)).unwrap();
    }
    let made = match text("around") {
        None => bytes.to_vec(),
        Some(around) => {
            let (before, after) = around.split_once("INPUT").unwrap();
            [before.as_bytes(), bytes, after.as_bytes()].concat()
        }
    };
    fs::write(folder.path().join(text("file").unwrap()), made).unwrap();
    for words in list("runs") {
        let done = run(command().current_dir(folder.path()).args(words.split_whitespace()), b"");
        let said = format!("{name}, {what}: post {words}: {}\n{}{}", done.code, done.out, done.err);
        match done.code {
            0 => continue,
            1 => assert!(format!("{}{}", done.out, done.err).contains("error["), "{said}"),
            _ => panic!("{said}"),
        }
        return;
    }
}

fn targets() -> toml::Table {
    fs::read_to_string(root().join("tests/fuzz/targets.toml")).unwrap().parse().unwrap()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn what_fuzzing_begins_with_and_has_found_is_read_or_refused() {
    let kept = root().join("tests/fuzz/kept");
    let mut all = 0;
    for (name, target) in &targets() {
        let target = target.as_table().unwrap();
        let words = target.get("words").and_then(toml::Value::as_array).into_iter().flatten();
        for words in words {
            take(name, target, words.as_str().unwrap().as_bytes(), "a text to begin with");
            all += 1;
        }
        for file in files(&kept.join(name)) {
            take(name, target, &fs::read(&file).unwrap(), &file.display().to_string());
            all += 1;
        }
    }
    assert!(all >= 20, "{all}");
    // What was found for a target that is none any more would be read by nobody.
    for folder in files(&kept) {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        assert!(name.starts_with('.') || targets().contains_key(&name), "{name}");
    }
}
