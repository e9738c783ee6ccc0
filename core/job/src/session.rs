//! One run of jobs: what it reads and writes, and the face through which it speaks. It is passed; nothing of a run is a static.

use std::fmt;
use std::io::{self, Read, Seek, SeekFrom};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use post_host::Isolation;
use post_machine::diagnostic::Diagnostic;

use crate::files::{ReadFiles, TextOutcomes};

/// Records, blocks or batches between two looks at the clock.
const EVERY: u64 = 4096;

/// Whoever a run speaks to: the command prints, a library gathers, the jobs of a batch are quiet.
pub trait Face: Send + Sync {
    /// Takes findings at once, in their order; `texts` says what the run has done to the user's files by then.
    fn findings(&self, findings: &[Diagnostic], texts: &TextOutcomes);

    /// Shows how far reading has come, of so many bytes if that is known; none: nobody looks.
    fn bar(&self, bytes: Option<u64>) -> Option<Box<dyn Bar>> {
        let _ = bytes;
        None
    }

    /// Says that the run shall end; it is asked as CL files and programs are read, and from one batch to the next.
    fn is_stopped(&self) -> bool {
        false
    }

    /// Says that standard output is the run's own, for results alone.
    fn owns_output(&self) -> bool {
        false
    }
}

/// A bar that shows how far reading has come. Dropped, it is taken away.
pub trait Bar {
    /// So many bytes are read.
    fn set(&self, position: u64);
}

/// A face for jobs whose outcome says all: nothing else is heard of them.
pub struct Quiet;

impl Face for Quiet {
    fn findings(&self, _: &[Diagnostic], _: &TextOutcomes) {}
}

/// A run. Clones are the same run.
#[derive(Clone)]
pub struct Session {
    run: Arc<Run>,
    /// How far reading has come is shown.
    shows: bool,
}

struct Run {
    read: Mutex<ReadFiles>,
    texts: Mutex<TextOutcomes>,
    isolation: Mutex<Option<Isolation>>,
    face: Box<dyn Face>,
}

impl fmt::Debug for Session {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Session")
    }
}

impl Session {
    /// A run that has read and written nothing yet.
    pub fn new(face: impl Face + 'static) -> Self {
        let face = Box::new(face);
        let (read, texts, isolation) = Default::default();
        let run = Run { read, texts, isolation, face };
        Self { run: Arc::new(run), shows: true }
    }

    /// The same run where several threads read: how far each has come is not shown.
    pub fn unseen(&self) -> Self {
        Self { run: Arc::clone(&self.run), shows: false }
    }

    /// A run that is not heard.
    pub fn quiet() -> Self {
        Self::new(Quiet)
    }

    /// The files that it reads, none of which is written to.
    pub fn read_files(&self) -> MutexGuard<'_, ReadFiles> {
        // A list is whole whatever a thread died of.
        self.run.read.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What it has done to the user's files.
    pub fn texts(&self) -> MutexGuard<'_, TextOutcomes> {
        self.run.texts.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Tells findings at once.
    pub fn findings(&self, findings: &[Diagnostic]) {
        self.run.face.findings(findings, &self.texts());
    }

    /// Shows how far reading has come, of so many bytes if that is known.
    pub fn progress(&self, bytes: Option<u64>) -> Progress {
        let bar = if self.shows { self.run.face.bar(bytes) } else { None };
        Progress { bar, records: 0 }
    }

    /// From here on libraries run in processes of their own, or in this one.
    pub fn isolate(&self, isolation: Option<Isolation>) {
        *self.run.isolation.lock().unwrap_or_else(PoisonError::into_inner) = isolation;
    }

    /// The processes of libraries; none: they run in this one.
    pub fn isolation(&self) -> Option<Isolation> {
        self.run.isolation.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Says that standard output is the run's own, for results alone.
    pub fn owns_output(&self) -> bool {
        self.run.face.owns_output()
    }

    /// Refuses to go on once the run shall end.
    ///
    /// # Errors
    /// It shall end.
    pub fn go_on(&self) -> io::Result<()> {
        match self.run.face.is_stopped() {
            true => Err(io::Error::other("interrupted")),
            false => Ok(()),
        }
    }

    /// What reads `bytes`, and fails once the run shall end.
    pub fn stoppable<R>(&self, bytes: R) -> Stoppable<R> {
        Stoppable { bytes, session: self.clone() }
    }
}

/// A text that cannot be read any more once its run shall end.
#[derive(Debug)]
pub struct Stoppable<R> {
    bytes: R,
    session: Session,
}

impl<R: Read> Read for Stoppable<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.session.go_on()?;
        self.bytes.read(into)
    }
}

impl<R: Seek> Seek for Stoppable<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.bytes.seek(to)
    }
}

/// How far reading has come.
pub struct Progress {
    bar: Option<Box<dyn Bar>>,
    records: u64,
}

impl Progress {
    /// Counts one more record; `position` bytes of the input are read.
    #[inline]
    pub fn record(&mut self, position: impl FnOnce() -> u64) {
        self.some_records(1, position);
    }

    /// Counts so many more.
    #[inline]
    pub fn some_records(&mut self, count: u64, position: impl FnOnce() -> u64) {
        let before = self.records / EVERY;
        self.records += count;
        if let Some(bar) = &self.bar
            && self.records / EVERY > before
        {
            bar.set(position());
        }
    }

    /// Takes the bar away.
    pub fn finish(self) {}
}
