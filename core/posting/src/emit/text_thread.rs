//! The thread on which batches of events become text, beside the stages that make them.
//!
//! Batches go there and come back in their order, and the thread alone has dialect and output: what is written is what
//! would be without it. Only so many are on the way, and they come back to be filled again. While no text waits the thread
//! does what else is asked of it.

use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::{self, Scope};

use super::text::{EventBatch, TextWriter};

/// What the thread of the texts does while none waits, a little at a time; false: there was nothing to do. It is asked
/// again after each text.
pub type SpareWork<'s> = &'s (dyn Fn() -> bool + Sync);

/// Work of the batches that go together ([`EventBatch::work`]): less is worth less than waking a thread.
const TOGETHER: usize = 2048;

/// So many times [`TOGETHER`] are on the way at most.
const ON_THE_WAY: usize = 4;

/// Stack of a thread that runs a dialect or reads a file, bytes: as much as the first thread of a process mostly has.
pub const STACK: usize = 8 << 20;

/// What goes to the thread.
enum Work<'a> {
    /// What the thread writes with.
    Begin(TextWriter<'a>),
    /// Batches to be written.
    Write(Vec<EventBatch>),
}

/// What comes back: batches that are text, or what a panic had to say.
type Done = Result<Vec<EventBatch>, Box<dyn Any + Send>>;

/// A thread that writes texts; dropped, it ends.
pub(super) struct TextThread<'a> {
    to: Sender<Work<'a>>,
    from: Receiver<Done>,
    /// Batches that go next, and their work.
    waiting: Vec<EventBatch>,
    work: usize,
    /// First line of the CL file of those that are on the way, and of those that wait behind them.
    lines: VecDeque<u64>,
    /// Batches to be filled again, and what they go in.
    empty: Vec<EventBatch>,
    spare: Vec<Vec<EventBatch>>,
}

impl<'a> TextThread<'a> {
    /// A thread of `scope`; none if no more can be started.
    pub(super) fn start<'s>(scope: &'s Scope<'s, '_>, spare: SpareWork<'s>) -> Option<Self>
    where
        'a: 's,
    {
        let (to, work) = channel::<Work<'a>>();
        let (done, from) = channel::<Done>();
        let thread = thread::Builder::new().name("text".to_owned()).stack_size(STACK);
        let started = thread.spawn_scoped(scope, move || {
            let written = catch_unwind(AssertUnwindSafe(|| write_all(&work, &done, spare)));
            if let Err(payload) = written {
                // Whoever waits for it has to know; nobody may wait any more.
                let _ = done.send(Err(payload));
            }
        });
        started.ok().map(|_| Self {
            to,
            from,
            waiting: Vec::new(),
            work: 0,
            lines: VecDeque::new(),
            empty: Vec::new(),
            spare: Vec::new(),
        })
    }

    /// Gives the thread what it writes with.
    pub(super) fn begin(&mut self, text: TextWriter<'a>) {
        self.send(Work::Begin(text));
    }

    /// First line of the CL file whose events are no text yet.
    pub(super) fn first_line(&self) -> Option<u64> {
        let on_the_way = self.lines.front().copied();
        on_the_way.or_else(|| self.waiting.first().map(|batch| batch.events.line(0)))
    }

    /// Takes a batch, and leaves an empty one that notes what it noted.
    pub(super) fn hand(&mut self, batch: &mut EventBatch) {
        let mut next = self.empty.pop().unwrap_or_default();
        next.places = batch.places.is_some().then(|| next.places.take().unwrap_or_default());
        self.work += batch.work;
        self.waiting.push(std::mem::replace(batch, next));
        if self.work >= TOGETHER {
            self.send_waiting();
        }
    }

    /// Shows batches that are text, in their order: `all` of them, or only those that leave room for the next.
    pub(super) fn take_back(&mut self, all: bool, take: &mut dyn FnMut(&mut EventBatch)) {
        if all {
            self.send_waiting();
        }
        let most = if all { 0 } else { ON_THE_WAY };
        while self.lines.len() > most {
            let mut batches = match self.from.recv() {
                Ok(Ok(batches)) => batches,
                Ok(Err(payload)) => resume_unwind(payload),
                Err(_) => return,
            };
            self.lines.pop_front();
            batches.iter_mut().for_each(&mut *take);
            self.empty.append(&mut batches);
            self.spare.push(batches);
        }
    }

    fn send_waiting(&mut self) {
        let Some(first) = self.waiting.first() else {
            return;
        };
        self.lines.push_back(first.events.line(0));
        self.work = 0;
        let next = self.spare.pop().unwrap_or_default();
        let batches = std::mem::replace(&mut self.waiting, next);
        self.send(Work::Write(batches));
    }

    fn send(&self, work: Work<'a>) {
        // The thread ends before this only by a panic, which comes back instead of the batches.
        let _ = self.to.send(work);
    }
}

/// Writes what comes until nothing more does.
fn write_all(work: &Receiver<Work<'_>>, done: &Sender<Done>, spare: SpareWork<'_>) {
    let mut writer = None;
    while let Some(work) = next(work, spare) {
        match work {
            Work::Begin(text) => writer = Some(text),
            Work::Write(mut batches) => {
                if let Some(writer) = &mut writer {
                    batches.iter_mut().for_each(|batch| writer.write(batch));
                }
                if done.send(Ok(batches)).is_err() {
                    return;
                }
            }
        }
    }
}

/// What comes next, once it is there.
fn next<'a>(work: &Receiver<Work<'a>>, spare: SpareWork<'_>) -> Option<Work<'a>> {
    loop {
        match work.try_recv() {
            Ok(work) => return Some(work),
            Err(TryRecvError::Disconnected) => return None,
            Err(TryRecvError::Empty) if spare() => {}
            Err(TryRecvError::Empty) => return work.recv().ok(),
        }
    }
}
