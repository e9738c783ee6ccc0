//! Every code of a message in the sources is explained, and every code that is explained is in the sources.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{post, root};

/// What makes messages: the code is the first text among the arguments, behind one name at most.
const MAKERS: [&str; 8] = [
    "Diagnostic::error(",
    "Diagnostic::warning(",
    ".fault(",
    ".fault_at(",
    ".limit_fault(",
    ".warn(",
    ".refuse(",
    "DryRun::new(",
];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if path.is_dir() {
            if !["tests", "examples", "templates", "benches"].contains(&name) {
                sources(&path, found);
            }
        } else if name.ends_with(".rs") {
            found.push(path);
        }
    }
}

/// The code that a piece of source begins with, behind blanks and one name with a comma at most.
fn first_code(source: &str) -> Option<&str> {
    let mut rest = source.trim_start();
    if !rest.starts_with('"') {
        let (name, behind) = rest.split_once(',')?;
        if !name.chars().all(|letter| letter.is_alphanumeric() || "_&.*".contains(letter)) {
            return None;
        }
        rest = behind.trim_start();
    }
    let text = rest.strip_prefix('"')?.split('"').next()?;
    let is_code =
        !text.is_empty() && text.chars().all(|letter| letter.is_ascii_lowercase() || letter == '-');
    is_code.then_some(text)
}

#[test]
fn every_code_is_explained_and_every_explained_code_is_said() {
    let mut paths = Vec::new();
    for folder in ["cli", "core", "grammar", "lsp", "papers", "plugins", "src"] {
        sources(&root().join(folder), &mut paths);
    }
    let mut said: BTreeMap<String, PathBuf> = BTreeMap::new();
    let mut texts = String::new();
    for path in paths {
        let text = fs::read_to_string(&path).unwrap();
        let text = text.split("#[cfg(test)]\nmod ").next().unwrap();
        for maker in MAKERS {
            for (at, _) in text.match_indices(maker) {
                if let Some(code) = first_code(&text[at + maker.len()..]) {
                    said.insert(code.to_owned(), path.clone());
                }
            }
        }
        texts.push_str(text);
    }
    assert!(said.len() > 140, "{}", said.len());
    let told = post(&["explain"]);
    assert_eq!((told.code, told.err.as_str()), (0, ""));
    let explained: BTreeSet<&str> =
        told.out.lines().filter(|line| !line.is_empty() && !line.contains(' ')).collect();
    for (code, path) in &said {
        assert!(
            explained.contains(code.as_str()),
            "{} says `{code}`, which src/codes.md does not explain",
            path.display()
        );
    }
    for code in explained {
        assert!(
            texts.contains(&format!("\"{code}\"")),
            "src/codes.md explains `{code}`, which nobody says"
        );
    }
}

#[test]
fn a_code_is_explained_as_it_stands_in_a_message() {
    let told = post(&["explain", "over-travel"]);
    assert_eq!((told.code, told.err.as_str()), (0, ""));
    // Posting says it, and so does holding a program against its CL file.
    assert_eq!(told.out.matches("\nover-travel\n").count(), 2, "{}", told.out);
    for code in ["error[over-travel]", "error[over-travel]:", "[over-travel]"] {
        assert_eq!(post(&["explain", code]), told);
    }
    let slip = post(&["explain", "over-travle"]);
    assert_eq!((slip.code, slip.out.as_str()), (2, ""));
    assert!(slip.err.contains("'over-travel'"), "{}", slip.err);
    let far = post(&["explain", "G54"]);
    assert_eq!(far.code, 2);
    assert!(far.err.contains("`post explain` lists"), "{}", far.err);
}
