//! A CL file that is read more than once: a file as often as it is asked for, a stream from a copy.

use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use post_machine::diagnostic::FurtherFile;

use super::joined::JoinedFiles;
use super::seen_files::SeenFiles;
use super::temporary::Temporary;
use super::{ClInput, FileFault, PathArg};
use crate::disk;
use crate::failure::Failure;
use crate::session::Session;
use crate::settings::JobSettings;

/// Where a CL file is read from, as often as it takes.
pub struct ClSource {
    session: Session,
    argument: PathArg,
    /// The file as it was when it was first opened.
    seen: SeenFiles,
    /// Several files.
    joined: Option<JoinedFiles>,
    /// What a pipe or standard input held.
    copy: Option<Temporary>,
    /// What is in the memory already.
    held: Option<HeldText>,
    name: String,
}

/// A text in the memory, that may be given up while it is read.
#[derive(Clone)]
pub struct HeldText {
    /// The text.
    pub bytes: Arc<[u8]>,
    /// Where the files behind the first begin in it.
    pub further: Arc<[FurtherFile]>,
    /// Once this is set, reading it fails.
    pub stop: Arc<AtomicBool>,
}

impl HeldText {
    /// From its start.
    pub fn open(&self) -> impl Read + use<> {
        HeldReader { text: self.clone(), at: 0 }
    }
}

struct HeldReader {
    text: HeldText,
    at: usize,
}

impl Read for HeldReader {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if self.text.stop.load(Ordering::Relaxed) {
            return Err(io::Error::other("given up"));
        }
        let count = (&self.text.bytes[self.at..]).read(into)?;
        self.at += count;
        Ok(count)
    }
}

impl ClSource {
    /// Of the CL files of a job; what is no file is read to its end if `again` says that it will be read more than once.
    ///
    /// # Errors
    /// One of them cannot be read.
    pub fn of_job(session: &Session, job: &JobSettings, again: bool) -> Result<Self, Failure> {
        let mut source = Self::new(session, &job.input, again || job.reading.is_chosen())?;
        if !job.reading.then.is_empty() {
            source.joined = Some(JoinedFiles::new(session, job.files().cloned().collect())?);
        }
        Ok(source)
    }

    /// Of an argument; what is no file is read to its end if `again` says that it will be read more than once.
    pub fn new(session: &Session, argument: &PathArg, again: bool) -> Result<Self, FileFault> {
        let mut source = Self {
            session: session.clone(),
            argument: argument.clone(),
            seen: SeenFiles::default(),
            joined: None,
            copy: None,
            held: None,
            name: String::new(),
        };
        if !again {
            return Ok(source);
        }
        let mut input = ClInput::open_again(session, argument, &source.seen)?;
        if input.length.is_some() {
            return Ok(source);
        }
        let folder = disk::temp_dir();
        let fault = |error: io::Error| FileFault::NoWaiting {
            name: input.name.clone(),
            folder: folder.clone(),
            error,
        };
        let mut copy = Temporary::private(&folder).map_err(|error| fault(error.kind().into()))?;
        io::copy(&mut input.bytes, &mut copy).map_err(fault)?;
        source.name = input.name;
        source.copy = Some(copy);
        Ok(source)
    }

    /// Of a text that is made here and now, and that messages call `name`: `make` is given what takes it piece by piece.
    ///
    /// # Errors
    /// There is no place for it, or what `make` fails with.
    pub fn of_text<T>(
        session: &Session,
        name: String,
        make: impl FnOnce(&mut dyn FnMut(&[u8]) -> Result<(), FileFault>) -> Result<T, FileFault>,
    ) -> Result<(Self, T), FileFault> {
        let folder = disk::temp_dir();
        let fault = |error: io::Error| FileFault::NoWaiting {
            name: name.clone(),
            folder: folder.clone(),
            error: error.kind().into(),
        };
        let mut copy = BufWriter::new(Temporary::private(&folder).map_err(fault)?);
        let made = make(&mut |text| copy.write_all(text).map_err(fault))?;
        let copy = copy.into_inner().map_err(|error| fault(error.into_error()))?;
        let source = Self {
            session: session.clone(),
            argument: PathArg::Standard,
            seen: SeenFiles::default(),
            joined: None,
            copy: Some(copy),
            held: None,
            name,
        };
        Ok((source, made))
    }

    /// Of a text in the memory that the user knows as the file `argument`.
    pub fn of_held(session: &Session, argument: &PathArg, text: HeldText) -> Self {
        let name = argument.path().map(|path| path.display().to_string());
        Self {
            session: session.clone(),
            argument: argument.clone(),
            seen: SeenFiles::default(),
            joined: None,
            copy: None,
            held: Some(text),
            name: name.unwrap_or_default(),
        }
    }

    /// The files behind the first.
    pub fn further(&self) -> Arc<[FurtherFile]> {
        let held = self.held.as_ref().map(|text| Arc::clone(&text.further));
        held.or_else(|| self.joined.as_ref().map(JoinedFiles::further)).unwrap_or_default()
    }

    /// The text in the memory, from its start.
    fn open_held(&self) -> Option<ClInput> {
        let text = self.held.as_ref()?;
        Some(ClInput {
            name: self.name.clone(),
            length: Some(text.bytes.len() as u64),
            bytes: Box::new(text.open()),
            further: Arc::clone(&text.further),
        })
    }

    /// All was read, as often as it takes: no file was written to meanwhile.
    ///
    /// # Errors
    /// One was.
    pub fn refuse_written(&self) -> Result<(), FileFault> {
        match &self.joined {
            Some(joined) => joined.refuse_written(),
            None => self.seen.refuse_written(),
        }
    }

    /// From its start, to be read beside another reader that is not done yet.
    pub fn open_beside(&self) -> Result<ClInput, FileFault> {
        if let Some(input) = self.open_held() {
            return Ok(input);
        }
        if let Some(joined) = &self.joined {
            return joined.open(&self.session);
        }
        let Some(copy) = &self.copy else {
            return ClInput::open_again(&self.session, &self.argument, &self.seen);
        };
        let name = self.name.clone();
        match copy.reopen() {
            Ok(bytes) => {
                Ok(ClInput { name, bytes: Box::new(bytes), length: None, further: Arc::default() })
            }
            Err(error) => Err(FileFault::Read { name, error }),
        }
    }

    /// From its start.
    pub fn open(&mut self) -> Result<ClInput, FileFault> {
        if let Some(input) = self.open_held() {
            return Ok(input);
        }
        if let Some(joined) = &self.joined {
            return joined.open(&self.session);
        }
        let Some(copy) = &mut self.copy else {
            return ClInput::open_again(&self.session, &self.argument, &self.seen);
        };
        let name = self.name.clone();
        let again = || -> io::Result<ClInput> {
            copy.seek(SeekFrom::Start(0))?;
            let bytes = copy.as_file()?.try_clone()?;
            Ok(ClInput {
                name: name.clone(),
                length: Some(bytes.metadata()?.len()),
                bytes: Box::new(bytes),
                further: Arc::default(),
            })
        };
        let mut again = again;
        again().map_err(|error| FileFault::Read { name, error })
    }
}
