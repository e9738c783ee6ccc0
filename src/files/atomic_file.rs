//! A text in the making: a temporary file beside the target that takes its name at the end, or a stream.

use std::fs::{self, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use post_posting::Output;

use super::temporary::Temporary;
use super::{FileFault, PathArg};
use crate::terminal;

/// What a text becomes at the end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Standard output.
    Standard,
    /// A pipe or a device: written to at the end, never replaced.
    Stream(PathBuf),
    /// A file, made or replaced whole.
    File(PathBuf),
}

impl Target {
    /// What stands at a path, or would. A link is followed, and stays.
    pub fn of(target: &PathArg) -> Self {
        // By its other names too: libraries are kept out of standard output (`terminal::results`), so that what
        // these names lead to is another stream by now.
        let standard = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].map(Path::new);
        let path = target.path().filter(|path| !standard.contains(path));
        let Some(path) = path else {
            return Self::Standard;
        };
        match fs::metadata(path) {
            Ok(metadata) if metadata.is_file() => {
                Self::File(path.canonicalize().unwrap_or_else(|_| path.to_owned()))
            }
            Ok(metadata) if !metadata.is_dir() => Self::Stream(path.to_owned()),
            _ => Self::File(path.to_owned()),
        }
    }

    /// Both are the same file.
    pub fn is(&self, other: &Path) -> bool {
        let Self::File(path) = self else {
            return false;
        };
        match (path.canonicalize(), other.canonicalize()) {
            (Ok(path), Ok(other)) => path == other,
            _ => path == other,
        }
    }
}

/// A text in the making. Dropped without [`AtomicFile::finish`], it leaves nothing behind, nor if the command is
/// interrupted.
pub struct AtomicFile {
    file: BufWriter<Temporary>,
    target: Target,
    /// The target as the user named it.
    named: PathArg,
}

impl AtomicFile {
    /// A text that will stand at `target`.
    pub fn create(target: &PathArg) -> Result<Self, FileFault> {
        let named = target.clone();
        let target = Target::of(&named);
        let file = match &target {
            Target::File(path) => Temporary::new_in(folder(path)),
            // Nothing may be seen before all is good, and memory must not grow: it waits in a file.
            Target::Standard | Target::Stream(_) => Temporary::new_in(&std::env::temp_dir()),
        };
        // The name of the temporary file would only puzzle.
        let file = file.map_err(|error| FileFault::write(&named, error.kind().into()))?;
        Ok(Self {
            file: BufWriter::with_capacity(1 << 16, file),
            target,
            named,
        })
    }

    /// Adds to the text.
    pub fn write_bytes(&mut self, text: &[u8]) -> Result<(), FileFault> {
        let written = self.file.write_all(text);
        written.map_err(|error| FileFault::write(&self.named, error))
    }

    /// Puts the text in its place.
    pub fn finish(self) -> Result<(), FileFault> {
        let named = self.named;
        place(self.file, self.target).map_err(|error| FileFault::write(&named, error))
    }
}

impl Output for AtomicFile {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        self.file
            .write_all(text)
            .map_err(|error| format!("the program cannot be written: {error}"))
    }
}

/// Takes a text and keeps none of it: a program is made and judged, and nobody wants its lines.
pub struct NullSink;

impl Output for NullSink {
    fn write(&mut self, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}

fn place(file: BufWriter<Temporary>, target: Target) -> io::Result<()> {
    let mut file = file.into_inner().map_err(|fault| fault.into_error())?;
    match target {
        Target::Standard => copy(&mut file, &mut terminal::results()),
        Target::Stream(path) => copy(&mut file, &mut OpenOptions::new().write(true).open(path)?),
        Target::File(path) => {
            readable(&file, &path)?;
            file.as_file()?.sync_all()?;
            file.persist(&path)?;
            // The new name is safe once its folder is on the disk; not every system can open a folder.
            if let Ok(folder) = fs::File::open(folder(&path)) {
                let _ = folder.sync_all();
            }
            Ok(())
        }
    }
}

fn copy(file: &mut Temporary, to: &mut dyn Write) -> io::Result<()> {
    file.seek(SeekFrom::Start(0))?;
    match io::copy(file, to).and_then(|_| to.flush()) {
        // A reader that has seen enough is no fault.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        done => done,
    }
}

/// A temporary file is for its owner alone; the program gets the rights of the file it replaces, or the usual ones.
#[cfg(unix)]
fn readable(file: &Temporary, target: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    let mode = fs::metadata(target).map_or(0o644, |metadata| metadata.permissions().mode());
    file.as_file()?
        .set_permissions(fs::Permissions::from_mode(mode))
}

#[cfg(not(unix))]
fn readable(_: &Temporary, _: &Path) -> io::Result<()> {
    Ok(())
}

fn folder(target: &Path) -> &Path {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
