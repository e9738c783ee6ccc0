//! Several texts take their names: all of them, or none.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, TempPath};

use super::abandoned::{self, PREFIX, former_suffix};
use super::file_id::{FileId, folder};
use super::temporary::{Temporary, forget_former, live};

/// Why not all texts have their names.
#[derive(Debug)]
pub struct NamingFault {
    /// Which one could not be given its name.
    pub index: usize,
    /// What the system says.
    pub error: io::Error,
    /// Those before it that have their names and could not be taken back, and where the file is that stood there before.
    pub stuck: Vec<(usize, Option<PathBuf>)>,
}

/// A text that has its name.
struct NamedFile {
    target: PathBuf,
    /// The file that stood there before.
    old: Option<FormerFile>,
}

/// A file that stood at a target before.
struct FormerFile {
    /// A name of its own that is deleted at the end.
    path: TempPath,
    /// As long as they are held, what stands there and what has that name (a copy, on a disk without hard links), no other
    /// run deletes that name.
    _held: [Option<File>; 2],
}

/// Gives all texts their names in turn. If one of them cannot have it, what the others replaced is put back. A signal
/// waits until all is done; what a machine does that is switched off in the middle, nobody can say.
pub fn name_all(texts: &mut [(Temporary, PathBuf)]) -> Result<(), NamingFault> {
    let mut signals = live();
    let mut named: Vec<NamedFile> = Vec::new();
    let count = texts.len();
    for (index, (text, target)) in texts.iter_mut().enumerate() {
        let last = index + 1 == count;
        let done = refuse_named(&named, target)
            .and_then(|()| if last { Ok(None) } else { second_name(target) })
            .and_then(|old| text.persist(&mut signals, target).map(|()| old));
        match done {
            Ok(old) => named.push(NamedFile { target: target.clone(), old }),
            Err(error) => {
                let stuck = put_back(named);
                return Err(NamingFault { index, error, stuck });
            }
        }
    }
    for NamedFile { target, old } in named {
        drop(old);
        forget_former(&target);
    }
    Ok(())
}

/// Two names that were free can turn out to be one, where small and capital letters are the same.
fn refuse_named(named: &[NamedFile], target: &Path) -> io::Result<()> {
    let same = |other: &NamedFile| match (FileId::of(&other.target), FileId::of(target)) {
        (Ok(other), Ok(target)) => other == target,
        _ => false,
    };
    if named.iter().any(same) {
        let message = "it is the same file as another one that is written";
        return Err(io::Error::other(message));
    }
    Ok(())
}

/// Gives the file at `target` a second name beside it, so that it outlasts being replaced. None if there is none.
fn second_name(target: &Path) -> io::Result<Option<FormerFile>> {
    if !target.exists() {
        return Ok(None);
    }
    let held = abandoned::held(target);
    let suffix = former_suffix(target);
    let second = Builder::new().prefix(PREFIX).suffix(&suffix).make_in(folder(target), |path| {
        fs::hard_link(target, path).or_else(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => Err(error),
            // A disk without hard links, such as a memory stick.
            _ => fs::copy(target, path).map(drop),
        })
    });
    second.map(|file| {
        let copy = abandoned::held(file.path());
        Some(FormerFile { path: file.into_temp_path(), _held: [held, copy] })
    })
}

/// Puts back what was replaced, the last first; what cannot be put back.
fn put_back(named: Vec<NamedFile>) -> Vec<(usize, Option<PathBuf>)> {
    let mut stuck = Vec::new();
    for (index, NamedFile { target, old }) in named.into_iter().enumerate().rev() {
        match old {
            None => {
                if fs::remove_file(&target).is_err() {
                    stuck.push((index, None));
                }
            }
            Some(old) => {
                if let Err(fault) = old.path.persist(&target) {
                    // Deleted with its path, the user's file would be lost.
                    let path = fault.path.to_path_buf();
                    std::mem::forget(fault.path);
                    stuck.push((index, Some(path)));
                }
            }
        }
    }
    stuck
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    fn text(folder: &Path, name: &str) -> (Temporary, PathBuf) {
        let mut text = Temporary::private(folder).unwrap();
        text.write_all(b"new").unwrap();
        (text, folder.join(name))
    }

    fn contents(folder: &Path) -> Vec<(String, String)> {
        let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
        let mut contents: Vec<(String, String)> = entries
            .map(|entry| {
                let text = fs::read_to_string(entry.path()).unwrap_or_default();
                (entry.file_name().into_string().unwrap(), text)
            })
            .collect();
        contents.sort();
        contents
    }

    #[test]
    fn what_was_replaced_is_put_back_if_a_later_name_cannot_be_had() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        fs::write(folder.join("b"), "old").unwrap();
        // A folder has taken the name in the meantime.
        fs::create_dir(folder.join("c")).unwrap();
        let before = contents(folder);
        let mut texts: Vec<_> = ["a", "b", "c", "d"].map(|name| text(folder, name)).into();
        let unnamed = name_all(&mut texts).unwrap_err();
        assert_eq!((unnamed.index, unnamed.stuck), (2, Vec::new()));
        drop(texts);
        assert_eq!(contents(folder), before);
        fs::remove_dir(folder.join("c")).unwrap();
        let mut texts: Vec<_> = ["a", "b", "c", "d"].map(|name| text(folder, name)).into();
        name_all(&mut texts).unwrap();
        drop(texts);
        let new = ["a", "b", "c", "d"].map(|name| (name.to_owned(), "new".to_owned()));
        assert_eq!(contents(folder), new);
    }

    #[test]
    fn two_names_that_turn_out_to_be_one_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let mut texts: Vec<_> = ["a", "./a"].map(|name| text(folder, name)).into();
        let unnamed = name_all(&mut texts).unwrap_err();
        assert_eq!((unnamed.index, unnamed.stuck), (1, Vec::new()));
        drop(texts);
        assert_eq!(contents(folder), []);
    }
}
