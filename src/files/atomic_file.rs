//! Where the program goes: a temporary file beside the target that takes its name at the end, or a stream.

use std::fs::{self, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use post_posting::Output;
use tempfile::NamedTempFile;

/// Where a text goes.
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
    /// What `path` stands for; `-` is standard output. A link is followed, and stays.
    pub fn of(path: &Path) -> Self {
        if path == Path::new("-") {
            return Self::Standard;
        }
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

/// A text in the making. Dropped without [`Whole::finish`], it leaves nothing behind.
pub struct Whole {
    file: BufWriter<NamedTempFile>,
    target: Target,
}

impl Whole {
    /// A text that will stand at `target`.
    pub fn create(target: Target) -> io::Result<Self> {
        let file = match &target {
            Target::File(path) => NamedTempFile::new_in(folder(path)),
            // Nothing may be seen before all is good, and memory must not grow: it waits in a file.
            Target::Standard | Target::Stream(_) => NamedTempFile::new(),
        };
        Ok(Self {
            // The name of the temporary file would only puzzle.
            file: BufWriter::with_capacity(1 << 16, file.map_err(|error| error.kind())?),
            target,
        })
    }

    /// Puts the text in its place.
    pub fn finish(self) -> io::Result<()> {
        let mut file = self.file.into_inner().map_err(|fault| fault.into_error())?;
        match self.target {
            Target::Standard => copy(&mut file, &mut io::stdout().lock()),
            Target::Stream(path) => {
                copy(&mut file, &mut OpenOptions::new().write(true).open(path)?)
            }
            Target::File(path) => {
                readable(&file, &path)?;
                file.as_file().sync_all()?;
                file.persist(&path).map_err(|fault| fault.error.kind())?;
                // The new name is safe once its folder is on the disk; not every system can open a folder.
                if let Ok(folder) = fs::File::open(folder(&path)) {
                    let _ = folder.sync_all();
                }
                Ok(())
            }
        }
    }
}

impl Output for Whole {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        self.file
            .write_all(text)
            .map_err(|error| format!("the program cannot be written: {error}"))
    }
}

fn copy(file: &mut NamedTempFile, to: &mut dyn Write) -> io::Result<()> {
    file.as_file_mut().seek(SeekFrom::Start(0))?;
    match io::copy(file.as_file_mut(), to).and_then(|_| to.flush()) {
        // A reader that has seen enough is no fault.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        done => done,
    }
}

/// A temporary file is for its owner alone; the program gets the rights of the file it replaces, or the usual ones.
#[cfg(unix)]
fn readable(file: &NamedTempFile, target: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    let mode = fs::metadata(target).map_or(0o644, |metadata| metadata.permissions().mode());
    file.as_file()
        .set_permissions(fs::Permissions::from_mode(mode))
}

#[cfg(not(unix))]
fn readable(_: &NamedTempFile, _: &Path) -> io::Result<()> {
    Ok(())
}

fn folder(target: &Path) -> &Path {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
