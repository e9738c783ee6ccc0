//! Where a text goes, and that no file of the user's is lost by it.

use std::io;
use std::path::{Path, PathBuf};

use super::file_id::{FileId, followed};
use super::{FileFault, PathArg, standard};
use crate::disk::{self, Metadata, OpenOptions};
use crate::session::Session;

/// What a text is to the user.
#[derive(Clone, Copy, Debug)]
pub struct Role {
    /// What it is called, `program`.
    pub what: &'static str,
    /// How another place is named for it, `name another file with -o`.
    pub remedy: &'static str,
}

impl Role {
    /// An NC program.
    pub const PROGRAM: Self = Self { what: "program", remedy: "name another file with -o" };

    /// A CL file that is written.
    pub const CL: Self = Self { what: "CL file", remedy: "name another file with --cl" };

    /// What was found, as JSON beside an NC program.
    pub const SUMMARY: Self = Self { what: "summary", remedy: "name another file with --summary" };

    /// What a run came to, as a page to look at.
    pub const REPORT: Self = Self { what: "report", remedy: "name another file with --report" };

    /// What is printed, as JSON.
    pub const JSON: Self = Self { what: "JSON", remedy: "name another file with --json" };

    /// A picture, as SVG.
    pub const PICTURE: Self = Self { what: "picture", remedy: "name another file with --svg" };
}

/// What a text becomes at the end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Standard output.
    Standard,
    /// A pipe or a device: written to at the end, never replaced.
    Stream(PathBuf),
    /// A file, made or replaced whole. The path has no links.
    File(PathBuf),
}

/// Where a text goes.
#[derive(Clone, Debug)]
pub struct Target {
    /// What the text is.
    pub role: Role,
    /// The place as the user named it.
    pub name: String,
    /// What it is.
    pub place: Place,
    /// A file stands there.
    pub replaces: bool,
}

impl Target {
    /// What stands at a place that the user named, or would. A link is followed, and stays.
    ///
    /// # Errors
    /// No text can be written there.
    pub fn find(role: Role, named: &PathArg) -> Result<Self, FileFault> {
        let place = place(role, named)?;
        Ok(Self {
            role,
            name: named
                .path()
                .map_or_else(|| "standard output".to_owned(), |path| path.display().to_string()),
            replaces: matches!(&place, Place::File(path) if disk::exists(path)),
            place,
        })
    }

    /// Which file it is; none where the system does not say.
    fn id(&self) -> Option<FileId> {
        match &self.place {
            Place::Standard => standard::id(),
            Place::Stream(path) | Place::File(path) => FileId::of(path).ok(),
        }
    }
}

/// Refuses targets that are files which the run reads, or one another.
pub fn refuse_losses(session: &Session, targets: &[&Target]) -> Result<(), FileFault> {
    if let Some(read) = standard::is_read(session)
        && targets.iter().all(|target| target.place != Place::Standard)
    {
        return Err(FileFault::PrintedOverRead(read));
    }
    for (index, target) in targets.iter().enumerate() {
        let id = target.id();
        if let Some(read) = id.as_ref().and_then(|id| session.read_files().what(id)) {
            return Err(FileFault::OverRead { role: target.role, name: target.name.clone(), read });
        }
        if target.place == Place::Stream(PathBuf::from("/dev/null")) {
            // Nothing is lost where nothing is kept.
            continue;
        }
        let mut earlier = targets[..index].iter();
        let same =
            |other: &&&Target| target.place == other.place || (id.is_some() && id == other.id());
        if let Some(other) = earlier.find(same) {
            return Err(FileFault::OverWritten {
                role: target.role,
                name: target.name.clone(),
                other: other.role,
                other_name: other.name.clone(),
            });
        }
    }
    Ok(())
}

fn place(role: Role, named: &PathArg) -> Result<Place, FileFault> {
    let (Some(path), Some(shown)) = (named.absolute(), named.path()) else {
        return Ok(Place::Standard);
    };
    if standard::is_named(path) {
        return Ok(Place::Standard);
    }
    let fault = |error| FileFault::write(named, error);
    match disk::metadata(path) {
        Ok(found) if found.is_dir() => Err(FileFault::WriteFolder(shown.to_owned())),
        Ok(found) if is_disk(&found) => Err(FileFault::WriteDisk(shown.to_owned())),
        Ok(found) if is_standard_output(path, &found) => {
            // `-o FILE >> FILE`: replaced or added to? A program behind another one would be run as its end.
            let by_name = path.starts_with("/dev") || path.starts_with("/proc");
            if found.is_file() && found.len() > 0 && !by_name {
                return Err(FileFault::OverAppended { role, name: shown.display().to_string() });
            }
            Ok(Place::Standard)
        }
        Ok(found) if found.is_file() => {
            // A file that is protected against writing is not replaced either.
            OpenOptions::new().write(true).open(path).map_err(fault)?;
            Ok(Place::File(disk::canonicalize(path).map_err(fault)?))
        }
        Ok(_) => Ok(Place::Stream(path.to_owned())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            if path.as_os_str().as_encoded_bytes().ends_with(b"/") {
                return Err(FileFault::NoFolder {
                    path: shown.to_owned(),
                    folder: shown.to_owned(),
                });
            }
            followed(path).map(Place::File).map_err(fault)
        }
        Err(error) => Err(fault(error)),
    }
}

/// The path leads to what standard output is: `/dev/stdout`, or the file that a shell lets it go to. Replaced, it would
/// be cut off from the command.
fn is_standard_output(path: &Path, found: &Metadata) -> bool {
    let same = FileId::of(path).is_ok_and(|id| Some(id) == standard::id());
    // Whoever sends it to /dev/null may send a text there, too.
    same && (!is_device(found) || standard::is_terminal())
}

#[cfg(unix)]
fn is_device(found: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    found.file_type().is_char_device()
}

/// A whole disk, which a text would destroy.
#[cfg(unix)]
fn is_disk(found: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    found.file_type().is_block_device()
}

#[cfg(not(unix))]
fn is_device(_: &Metadata) -> bool {
    false
}

#[cfg(not(unix))]
fn is_disk(_: &Metadata) -> bool {
    false
}
