//! Events on their way to the dialect.

use std::thread::Scope;

use post_plugin::{Capabilities, DialectSession, Event, Format};

use super::extremes::Extremes;
use super::text::{BatchFault, EventBatch, TextWriter};
use super::text_thread::{SpareWork, TextThread};
use crate::findings::Findings;
use crate::observer::TextSink;
use crate::stream::BATCH;

/// Hands events over in batches, and counts lines.
pub(super) struct EventWriter<'a> {
    format: Format,
    capabilities: Capabilities,
    /// The batch in hand.
    batch: EventBatch,
    /// Batches so far.
    count: u64,
    text: TextPlaceOfWork<'a>,
    /// Lines of the batches that have come back.
    lines: u64,
    /// The dialect refused an event, or the output text: no more is made.
    broken: bool,
}

/// Where batches become text.
enum TextPlaceOfWork<'a> {
    /// Here, one after the other.
    Here(TextWriter<'a>),
    /// On a thread of its own.
    Beside(TextThread<'a>),
}

impl<'a> EventWriter<'a> {
    pub(super) fn new(dialect: &'a mut dyn DialectSession, output: &'a mut dyn TextSink) -> Self {
        Self {
            format: dialect.format().clone(),
            capabilities: dialect.capabilities(),
            batch: EventBatch::default(),
            count: 0,
            text: TextPlaceOfWork::Here(TextWriter::new(dialect, output)),
            lines: 0,
            broken: false,
        }
    }

    /// Writes texts on a thread of `scope` from here on, if one can be started; while none waits it does `spare` work.
    pub(super) fn write_beside<'s>(&mut self, scope: &'s Scope<'s, '_>, spare: SpareWork<'s>)
    where
        'a: 's,
    {
        let Some(thread) = TextThread::start(scope, spare) else {
            return;
        };
        let text = std::mem::replace(&mut self.text, TextPlaceOfWork::Beside(thread));
        if let (TextPlaceOfWork::Here(text), TextPlaceOfWork::Beside(thread)) =
            (text, &mut self.text)
        {
            thread.begin(text);
        }
    }

    /// Notes from here on where the blocks stand.
    pub(super) fn watch(&mut self) {
        self.batch.places.get_or_insert_default();
    }

    /// Somebody notes where the blocks stand.
    pub(super) fn notes_places(&self) -> bool {
        self.batch.places.is_some()
    }

    /// A block stands where the last event does, if there are more than `before`.
    #[inline]
    pub(super) fn place(&mut self, before: usize) {
        let index = self.batch.events.len();
        if let Some(places) = &mut self.batch.places {
            places.events.push((index > before).then(|| index - 1));
        }
    }

    /// Hands over where the blocks stand that are written.
    pub(super) fn take_lines(&mut self) -> impl Iterator<Item = u64> {
        self.batch.places.iter_mut().flat_map(|places| places.lines.drain(..))
    }

    /// The dialect declared that it writes this.
    pub(super) fn knows(&self, capability: Capabilities) -> bool {
        self.capabilities.has(capability)
    }

    /// What the dialect prints.
    pub(super) fn format(&self) -> &Format {
        &self.format
    }

    /// Words of a block.
    #[inline]
    pub(super) fn words(&self) -> usize {
        self.format.words.len()
    }

    /// Lines so far.
    pub(super) fn lines(&self) -> u64 {
        self.lines
    }

    /// Index in the batch that the next event gets.
    #[inline]
    pub(super) fn next(&self) -> usize {
        self.batch.events.len()
    }

    /// Whether it is time to flush.
    #[inline]
    pub(super) fn is_full(&self) -> bool {
        self.batch.events.len() >= BATCH
    }

    /// Takes an event that comes from `line`.
    #[inline]
    pub(super) fn push(&mut self, line: u64, event: Event<'_>) {
        if !self.broken {
            self.batch.work += match event {
                Event::Cuts { columns, .. } => columns.0.len() / (self.words() + 1),
                _ => 1,
            };
            self.batch.events.push(line, event);
        }
    }

    /// Writes lines of the user's own as they are: before all events, or behind those of the batch in hand.
    pub(super) fn bare_lines(&mut self, lines: &[String]) {
        let begins = self.count == 0 && self.batch.events.is_empty();
        let bare = &mut self.batch.bare[usize::from(!begins)];
        for line in lines {
            bare.push_str(line);
            bare.push('\n');
        }
    }

    /// First line of the CL file whose events are no text yet.
    pub(super) fn first_line(&self) -> Option<u64> {
        match &self.text {
            TextPlaceOfWork::Here(_) => None,
            TextPlaceOfWork::Beside(thread) => thread.first_line(),
        }
    }

    /// Hands the batch to the dialect and its text to the output.
    pub(super) fn flush(&mut self, extremes: &mut Extremes, findings: &Findings) {
        if self.batch.events.is_empty() {
            if let Some(places) = &mut self.batch.places {
                places.lines.extend(places.events.drain(..).map(|_| 0));
            }
            return;
        }
        self.count += 1;
        let batch = &mut self.batch;
        batch.number = self.count;
        batch.found = findings.count();
        batch.failed = findings.failed();
        batch.marks = extremes.hand_over(self.count);
        match &mut self.text {
            TextPlaceOfWork::Here(text) => {
                text.write(batch);
                if let Some(fault) = came_back(batch, &mut self.lines, extremes) {
                    self.broken = true;
                    fault.tell(findings);
                }
            }
            TextPlaceOfWork::Beside(thread) => {
                thread.hand(batch);
                // Whoever looks on wants the lines at once, and after a fault its place among the others hangs on those of
                // the dialect.
                let at_once = batch.places.is_some() || findings.failed();
                self.take_back(at_once, extremes, findings);
            }
        }
    }

    /// Waits until all that was handed over is text.
    pub(super) fn settle(&mut self, extremes: &mut Extremes, findings: &Findings) {
        self.take_back(true, extremes, findings);
    }

    /// Takes back batches that are text; `all` of them, or only as many as make room for the next.
    fn take_back(&mut self, all: bool, extremes: &mut Extremes, findings: &Findings) {
        let Self { text: TextPlaceOfWork::Beside(thread), batch, lines, broken, .. } = self else {
            return;
        };
        thread.take_back(all, &mut |written| {
            if let Some(fault) = came_back(written, lines, extremes) {
                *broken = true;
                fault.tell(findings);
            }
            if let (Some(places), Some(written)) = (&mut batch.places, &mut written.places) {
                places.lines.append(&mut written.lines);
            }
        });
        if self.broken {
            self.batch.events.clear();
            self.batch.work = 0;
        }
    }
}

/// A batch has come back as text: what was wrong with it.
fn came_back(
    batch: &mut EventBatch,
    lines: &mut u64,
    extremes: &mut Extremes,
) -> Option<BatchFault> {
    extremes.written(batch.number, batch.marks_lines);
    *lines = batch.lines_behind;
    batch.events.clear();
    batch.bare.iter_mut().for_each(String::clear);
    batch.work = 0;
    batch.fault.take()
}

impl BatchFault {
    /// Adds it to the findings, where it would stand had the text been written at once.
    #[cold]
    fn tell(self, findings: &Findings) {
        let finding = match self.line {
            Some(line) => findings.placed(line, self.finding),
            None => self.finding,
        };
        findings.insert(self.found, finding);
    }
}
