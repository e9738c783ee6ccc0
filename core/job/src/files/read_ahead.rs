//! A CL file that one thread reads ahead while another takes what is read.
//!
//! Whoever has time reads: a thread beside the one that takes, as far as there is room, and that one itself where nothing
//! is ready. Pieces come in the order of the file either way. Only files are read ahead: who waits for a pipe could not say
//! at once what is wrong with what has come.

use std::collections::VecDeque;
use std::io::Read;
use std::sync::{Mutex, MutexGuard, PoisonError};

use post_grammar::{ClBatch, ClPiece, ClReader, GotoRun};

use super::ClInput;

/// Batches that are read and not taken yet, at most.
const MOST_READY: usize = 8;

/// What a CL file is read from.
type ClBytes = Box<dyn Read + Send>;

/// A CL file, read by whoever has time.
#[derive(Default)]
pub struct ReadAhead {
    /// Who reads on holds this; none: there is no file yet, or nothing follows.
    reading: Mutex<Option<Reading>>,
    batches: Mutex<Batches>,
}

/// What is read with.
struct Reading {
    reader: ClReader<ClBytes>,
    run: GotoRun,
}

#[derive(Default)]
struct Batches {
    /// Those that are read, in the order of the file.
    ready: VecDeque<ClBatch>,
    /// Those that are taken, to be filled again.
    empty: Vec<ClBatch>,
}

impl ReadAhead {
    fn begin(&self, input: ClBytes) {
        let reader = ClReader::new(input);
        *locked(&self.reading) = Some(Reading { reader, run: GotoRun::default() });
    }

    /// Reads one batch ahead; false if there is nothing to be read, or no room for it, or somebody else reads.
    pub fn read_some(&self) -> bool {
        if locked(&self.batches).ready.len() >= MOST_READY {
            return false;
        }
        let Ok(mut reading) = self.reading.try_lock() else {
            return false;
        };
        if reading.is_none() {
            return false;
        }
        let mut batch = locked(&self.batches).empty.pop().unwrap_or_default();
        fill(&mut reading, &mut batch);
        // Before anybody else reads.
        locked(&self.batches).ready.push_back(batch);
        true
    }

    /// The next batch, in the place of one that is taken.
    fn next(&self, batch: &mut ClBatch) {
        if self.take_ready(batch) {
            return;
        }
        let mut reading = locked(&self.reading);
        // Whoever was reading until now has put it there.
        if !self.take_ready(batch) {
            fill(&mut reading, batch);
        }
    }

    fn take_ready(&self, batch: &mut ClBatch) -> bool {
        let mut batches = locked(&self.batches);
        let Some(next) = batches.ready.pop_front() else {
            return false;
        };
        let taken = std::mem::replace(batch, next);
        batches.empty.push(taken);
        true
    }
}

/// Reads on into a batch.
fn fill(reading: &mut Option<Reading>, batch: &mut ClBatch) {
    if let Some(Reading { reader, run }) = reading
        && !batch.fill(reader, run)
    {
        *reading = None;
    }
}

/// A thread that dies while it has this takes the run with it; what it leaves is not used.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A CL file piece by piece.
pub struct ClPieces<'r> {
    /// As the user named it.
    pub name: String,
    /// How long it is, bytes, if it is a file.
    pub length: Option<u64>,
    from: PieceSource<'r>,
}

/// Where pieces come from.
enum PieceSource<'r> {
    /// They are read as they are taken.
    Here(Box<ClReader<ClBytes>>),
    /// They may be read ahead.
    Ahead(&'r ReadAhead, ClBatch),
}

impl<'r> ClPieces<'r> {
    /// Of a CL file, which `ahead` may read from here on if it is a file.
    pub fn new(input: ClInput, ahead: Option<&'r ReadAhead>) -> Self {
        let ClInput { name, bytes, length, .. } = input;
        let from = match ahead.filter(|_| length.is_some()) {
            None => PieceSource::Here(Box::new(ClReader::new(bytes))),
            Some(ahead) => {
                ahead.begin(bytes);
                PieceSource::Ahead(ahead, ClBatch::default())
            }
        };
        Self { name, length, from }
    }

    /// The next piece; the numbers of a run go into `run`. After [`ClPiece::Failed`] and [`ClPiece::End`] there is none.
    #[inline]
    pub fn next(&mut self, run: &mut GotoRun) -> ClPiece<'_> {
        match &mut self.from {
            PieceSource::Here(reader) => reader.next_piece(run),
            PieceSource::Ahead(ahead, batch) => {
                if batch.is_taken() {
                    ahead.next(batch);
                }
                batch.next_piece(run).unwrap_or(ClPiece::End)
            }
        }
    }

    /// Bytes of the file up to the end of the piece that was taken last.
    pub fn position(&self) -> u64 {
        match &self.from {
            PieceSource::Here(reader) => reader.bytes_read(),
            PieceSource::Ahead(_, batch) => batch.position(),
        }
    }

    /// The file ends without a line end after its last line; known once [`ClPiece::End`] has come.
    pub fn ends_within_a_line(&self) -> bool {
        match &self.from {
            PieceSource::Here(reader) => reader.ends_within_a_line(),
            PieceSource::Ahead(_, batch) => batch.ends_within_a_line(),
        }
    }
}
