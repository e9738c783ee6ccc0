//! Where machines come from: a file, a machine folder, or built in.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use post_machine::description::{self, MOST_BYTES, Machine, Setting, Source};
use post_machine::diagnostic::Diagnostic;

use crate::failure::Failure;

/// Names and texts of the machines built in.
const BUILT_IN: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/machines.rs"));

/// Loads the machine `name` from the folders that the user `named`, the usual ones, or those built in, with
/// `settings` over it.
pub fn load(name: &str, named: &[PathBuf], settings: &[Setting]) -> Result<Machine, Failure> {
    let folders = folders(named);
    let source = find(name, &folders).map_err(|message| Diagnostic::error("machine", message))?;
    // A machine extends its neighbours first.
    let mut near: Vec<PathBuf> = Path::new(&source.name)
        .parent()
        .filter(|folder| folder.is_dir())
        .map(Path::to_owned)
        .into_iter()
        .collect();
    near.extend(folders);
    let machine = description::load(source, settings, &mut |parent| {
        check_extended(parent, &near)?;
        find(parent, &near)
    })?;
    Ok(machine)
}

/// The folders of machines: those of the command line, of the environment, and `machines` here.
fn folders(named: &[PathBuf]) -> Vec<PathBuf> {
    let mut folders = super::folders(named, "POST_MACHINES");
    folders.push(PathBuf::from("machines"));
    folders
}

fn find(name: &str, folders: &[PathBuf]) -> Result<Source, String> {
    let path = Path::new(name);
    let file =
        path.extension().is_some_and(|ending| ending == "toml") || path.components().count() > 1;
    if file {
        // A file that is extended is named as seen from the one that extends it.
        let beside = folders.iter().map(|folder| folder.join(path));
        let found = std::iter::once(path.to_owned())
            .chain(beside)
            .find(|path| path.is_file())
            .unwrap_or_else(|| path.to_owned());
        return read(&found);
    }
    for folder in folders {
        let path = folder.join(format!("{name}.toml"));
        if path.is_file() {
            return read(&path);
        }
    }
    if let Some((name, text)) = BUILT_IN.iter().find(|(known, _)| *known == name) {
        return Ok(Source {
            name: format!("{name}.toml (built in)"),
            text: (*text).to_owned(),
        });
    }
    let known: Vec<&str> = BUILT_IN.iter().map(|(name, _)| *name).collect();
    Err(format!(
        "there is no machine {name}: no {name}.toml in {}, and built in are {}",
        folders
            .iter()
            .map(|folder| folder.display().to_string())
            .collect::<Vec<_>>()
            .join(", "),
        known.join(", ")
    ))
}

/// A machine file may be a stranger's, and name any file of the user's: what it extends is a machine by its name, or a
/// regular file that ends in `.toml`. (A pipe could keep the command waiting, a device has no end.)
fn check_extended(name: &str, folders: &[PathBuf]) -> Result<(), String> {
    let path = Path::new(name);
    let toml = path.extension().is_some_and(|ending| ending == "toml");
    if !toml && path.components().count() < 2 {
        return Ok(());
    }
    if !toml {
        return Err(format!(
            "extends names a machine or a file that ends in .toml, and {name} is neither"
        ));
    }
    let beside = folders.iter().map(|folder| folder.join(path));
    let mut places = std::iter::once(path.to_owned()).chain(beside);
    match places.any(|place| place.is_file()) {
        false if path.exists() => Err(format!("{name} is no regular file")),
        _ => Ok(()),
    }
}

fn read(path: &Path) -> Result<Source, String> {
    let bytes = read_bounded(path).map_err(|error| format!("{}: {error}", path.display()))?;
    if bytes.len() > MOST_BYTES {
        return Err(format!(
            "{}: longer than {MOST_BYTES} bytes, which no machine file is",
            path.display()
        ));
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        format!(
            "{}: a machine file is UTF-8 text, this is not",
            path.display()
        )
    })?;
    Ok(Source {
        name: path.display().to_string(),
        text,
    })
}

/// The bytes of a file, up to one more than a machine file may have.
fn read_bounded(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let most = u64::try_from(MOST_BYTES).unwrap_or(u64::MAX);
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The machines that a bare name finds: their names, and where each is found.
pub fn list(named: &[PathBuf]) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    for folder in folders(named) {
        let Ok(entries) = fs::read_dir(&folder) else {
            continue;
        };
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
        paths.sort();
        for path in paths {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            rows.push((name.into_owned(), path.display().to_string()));
        }
    }
    for (name, _) in BUILT_IN {
        if !rows.iter().any(|(known, _)| known == name) {
            rows.push(((*name).to_owned(), "built in".to_owned()));
        }
    }
    rows
}
