//! Writes what the fuzzing of a target begins with into a folder: `seeds TARGET FOLDER`.

use std::fs;
use std::path::{Path, PathBuf};

use post_fuzz::{root, run, targets};

/// Files of the checkout that a pattern names: `*` in its last part stands for any letters.
fn found(pattern: &str) -> Vec<PathBuf> {
    let path = root().join(pattern);
    let folder = path.parent().expect("a folder");
    let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
    let Some((begin, end)) = name.split_once('*') else {
        return vec![path];
    };
    let all = fs::read_dir(folder).expect(pattern).map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = all
        .filter(|path| {
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            name.len() >= begin.len() + end.len() && name.starts_with(begin) && name.ends_with(end)
        })
        .collect();
    files.sort();
    files
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, folder] = arguments.as_slice() else { panic!("seeds TARGET FOLDER") };
    let target = targets().remove(name).unwrap_or_else(|| panic!("no target {name}"));
    let folder = Path::new(folder);
    fs::create_dir_all(folder).expect("a folder");
    for (place, words) in target.words.iter().enumerate() {
        fs::write(folder.join(format!("word-{place}")), words).expect("a seed");
    }
    for file in target.seeds.iter().flat_map(|pattern| found(pattern)) {
        let seed = folder.join(file.file_name().expect("a name"));
        fs::copy(&file, seed).expect("a seed");
    }
    let Some(made) = target.made else { return };
    for file in made.of.iter().flat_map(|pattern| found(pattern)) {
        let out = folder.join(file.file_name().expect("a name")).with_extension("seed");
        let words = made.run.replace("IN", &file.display().to_string());
        let words = words.replace("OUT", &out.display().to_string());
        // Not each file is for this machine.
        let _ = run(&words);
    }
}
