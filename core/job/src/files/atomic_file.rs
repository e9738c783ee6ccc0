//! A text in the making: a temporary file beside the target that takes its name at the end, or a stream.

use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use post_posting::TextSink;

use super::file_id::folder;
use super::naming::{self, NamingFault};
use super::outcome::TextOutcome;
use super::target::{Place, Role, Target, refuse_losses};
use super::temporary::Temporary;
use super::{FileFault, PathArg, rights, standard};
use crate::disk::{self, File, OpenOptions, TryLockError};
use crate::session::Session;

/// A text in the making. Dropped before [`AtomicFile::finish`], it leaves nothing behind, nor if the command is
/// interrupted.
pub struct AtomicFile {
    file: BufWriter<Temporary>,
    target: Target,
}

impl AtomicFile {
    /// Texts that will stand at these targets.
    ///
    /// # Errors
    /// One of them cannot be written, or would take the place of a file that is read, or of another one.
    pub fn create(session: &Session, targets: &[(Role, &PathArg)]) -> Result<Vec<Self>, FileFault> {
        let targets: Vec<Target> = targets
            .iter()
            .map(|(role, named)| Target::find(*role, named))
            .collect::<Result<_, _>>()?;
        for target in targets.iter().filter(|target| target.replaces) {
            session.texts().note(&target.name, TextOutcome::Kept);
        }
        refuse_losses(session, &targets.iter().collect::<Vec<_>>())?;
        targets.into_iter().map(Self::begin).collect()
    }

    fn begin(target: Target) -> Result<Self, FileFault> {
        // The names of temporary files would only puzzle: of a fault its kind alone is told.
        let made = match &target.place {
            Place::File(path) if target.replaces => Temporary::private(folder(path)),
            Place::File(path) => Temporary::shared(folder(path)),
            // Nothing may be seen before all is good, and memory must not grow: it waits in a file.
            Place::Standard | Place::Stream(_) => {
                let waiting = disk::temp_dir();
                let made = Temporary::private(&waiting);
                let made = made.map_err(|error| FileFault::NoWaiting {
                    name: target.name.clone(),
                    folder: waiting,
                    error: error.kind().into(),
                });
                return Ok(Self::new(made?, target));
            }
        };
        let fault = |error: io::Error| FileFault::write_named(&target.name, error.kind().into());
        let file = made.map_err(fault)?;
        if let Place::File(path) = &target.place
            && target.replaces
        {
            let open = file.as_file().map_err(fault)?;
            rights::take_over(open, path).map_err(|error| FileFault::NotKept {
                role: target.role,
                name: target.name.clone(),
                error,
            })?;
        }
        Ok(Self::new(file, target))
    }

    fn new(file: Temporary, target: Target) -> Self {
        Self { file: BufWriter::with_capacity(1 << 16, file), target }
    }

    /// It goes to standard output, where nothing else may stand then.
    pub fn is_standard(&self) -> bool {
        self.target.place == Place::Standard
    }

    /// Adds to the text.
    pub fn write_bytes(&mut self, text: &[u8]) -> Result<(), FileFault> {
        let written = self.file.write_all(text);
        written.map_err(|error| FileFault::write_named(&self.target.name, error))
    }

    /// What was written so far, to be read back from the disk; nothing more may be written then.
    ///
    /// # Errors
    /// It cannot be written, or not be read.
    pub fn reread(&mut self) -> Result<File, FileFault> {
        let again = || -> io::Result<File> {
            self.file.flush()?;
            let mut file = self.file.get_ref().as_file()?.try_clone()?;
            file.seek(SeekFrom::Start(0))?;
            Ok(file)
        };
        let mut again = again;
        again().map_err(|error| FileFault::write_named(&self.target.name, error))
    }

    /// As the user named the place.
    pub fn name(&self) -> &str {
        &self.target.name
    }

    /// Puts the texts in their places: all of them, or none. What can be taken back comes last: first all texts are on
    /// the disk, then pipes and devices are written to, then files take their names.
    pub fn finish(session: &Session, texts: Vec<Self>) -> Result<(), FileFault> {
        // A file may have been made since, and more be read.
        refuse_losses(session, &texts.iter().map(|text| &text.target).collect::<Vec<_>>())?;
        let mut streams = Vec::new();
        let mut files = Vec::new();
        let mut names = Vec::new();
        for Self { file, target } in texts {
            let fault = |error| FileFault::write_named(&target.name, error);
            let file = file.into_inner().map_err(|error| fault(error.into_error()))?;
            match target.place {
                Place::Standard => streams.push((file, None, target.name)),
                Place::Stream(path) => streams.push((file, Some(path), target.name)),
                Place::File(path) => {
                    let open = file.as_file().map_err(fault)?;
                    open.sync_all().map_err(fault)?;
                    files.push((file, path));
                    names.push(target.name);
                }
            }
        }
        for (file, path, name) in streams {
            deliver(session, file, path.as_deref(), &name)?;
        }
        name_all(session, files, &names)
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl TextSink for AtomicFile {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        self.write_bytes(text).map_err(|fault| fault.to_string())
    }
}

/// Takes a text and keeps none of it: a program is made and judged, and nobody wants its lines.
pub struct NullSink;

impl TextSink for NullSink {
    fn write(&mut self, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}

/// Files take their names.
fn name_all(
    session: &Session,
    mut files: Vec<(Temporary, PathBuf)>,
    names: &[String],
) -> Result<(), FileFault> {
    let mut folders: Vec<PathBuf> = files.iter().map(|(_, path)| folder(path).to_owned()).collect();
    folders.sort();
    folders.dedup();
    // Of two runs that write the same files, one has both. Not every system can open or lock a folder.
    let folders: Vec<File> = folders.iter().flat_map(File::open).collect();
    if files.len() > 1 {
        folders.iter().for_each(lock);
    }
    let named = naming::name_all(&mut files);
    let stuck: Vec<usize> = match &named {
        Ok(()) => (0..names.len()).collect(),
        Err(unnamed) => unnamed.stuck.iter().map(|(index, _)| *index).collect(),
    };
    for index in stuck {
        session.texts().note(&names[index], TextOutcome::Written);
    }
    for folder in &folders {
        // A new name is safe once its folder is on the disk.
        let _ = folder.sync_all();
    }
    named.map_err(|NamingFault { index, error, stuck }| FileFault::Named {
        name: names[index].clone(),
        error,
        stuck: stuck.into_iter().map(|(index, old)| (names[index].clone(), old)).collect(),
    })
}

/// Waits until no other run gives names in a folder, but not for ever: whoever else holds it may have other reasons.
fn lock(folder: &File) {
    for _ in 0..100 {
        if !matches!(folder.try_lock(), Err(TryLockError::WouldBlock)) {
            return;
        }
        thread::sleep(Duration::from_millis(20));
    }
}

/// Writes a text to a pipe or a device; without a path to standard output.
fn deliver(
    session: &Session,
    mut file: Temporary,
    path: Option<&Path>,
    name: &str,
) -> Result<(), FileFault> {
    let mut begun = false;
    let copied = open(path).and_then(|mut to| copy(&mut file, &mut to, &mut begun));
    let became = match copied {
        Ok(()) => Some(TextOutcome::Written),
        Err(_) if begun => Some(TextOutcome::Begun),
        Err(_) => None,
    };
    if let Some(became) = became {
        session.texts().note(name, became);
    }
    copied.map_err(|error| match error.kind() {
        io::ErrorKind::BrokenPipe => FileFault::ReaderGone(name.to_owned()),
        _ => FileFault::write_named(name, error),
    })
}

/// Copies by hand: after a fault it must be known whether anything got through.
fn copy(from: &mut Temporary, to: &mut dyn Write, begun: &mut bool) -> io::Result<()> {
    from.seek(SeekFrom::Start(0))?;
    let mut buffer = vec![0; 1 << 16];
    loop {
        let length = from.read(&mut buffer)?;
        let mut text = &buffer[..length];
        if text.is_empty() {
            return to.flush();
        }
        while !text.is_empty() {
            match to.write(text) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(written) => {
                    *begun = true;
                    text = &text[written..];
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
    }
}

/// Opens a pipe or a device; without a path standard output.
fn open(path: Option<&Path>) -> io::Result<Box<dyn Write>> {
    match path {
        Some(path) => Ok(Box::new(OpenOptions::new().write(true).open(path)?)),
        None => Ok(standard::open()?),
    }
}
