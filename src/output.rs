//! Where the program goes: a temporary file beside the target that takes its name at the end, or standard output.

use std::fs;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use post_core::Output;
use tempfile::NamedTempFile;

/// An NC program in the making. Dropped without [`Program::finish`], it leaves nothing behind.
pub struct Program {
    file: BufWriter<NamedTempFile>,
    /// None is standard output.
    target: Option<PathBuf>,
}

impl Program {
    /// A program that will stand at `target`, or go to standard output.
    pub fn create(target: Option<&Path>) -> io::Result<Self> {
        let file = match target {
            Some(target) => NamedTempFile::new_in(folder(target))?,
            // Nothing may be printed before all is good, and memory must not grow: it waits in a file.
            None => NamedTempFile::new()?,
        };
        Ok(Self {
            file: BufWriter::with_capacity(1 << 16, file),
            target: target.map(Path::to_owned),
        })
    }

    /// Puts the program in its place.
    pub fn finish(self) -> io::Result<()> {
        let mut file = self.file.into_inner().map_err(|fault| fault.into_error())?;
        let Some(target) = self.target else {
            file.as_file_mut().seek(SeekFrom::Start(0))?;
            let mut stdout = io::stdout().lock();
            return match io::copy(file.as_file_mut(), &mut stdout).and_then(|_| stdout.flush()) {
                // A reader that has seen enough is no fault.
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
                done => done,
            };
        };
        readable(&file, &target)?;
        file.as_file().sync_all()?;
        file.persist(&target).map_err(|fault| fault.error)?;
        // The new name is safe once its folder is on the disk; not every system can open a folder.
        if let Ok(folder) = fs::File::open(folder(&target)) {
            let _ = folder.sync_all();
        }
        Ok(())
    }
}

impl Output for Program {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        self.file
            .write_all(text)
            .map_err(|error| format!("the program cannot be written: {error}"))
    }
}

/// Writes a small file whole or not at all.
pub fn write_whole(target: &Path, text: &[u8]) -> io::Result<()> {
    let mut file = NamedTempFile::new_in(folder(target))?;
    file.write_all(text)?;
    readable(&file, target)?;
    file.persist(target).map_err(|fault| fault.error)?;
    Ok(())
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
