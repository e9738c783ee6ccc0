//! Events on their way to the dialect, and its text on the way to the output.

use post_machine::diagnostic::Diagnostic;
use post_plugin::{Batch, Capabilities, DialectSession, Event, Format};

use super::extremes::Extremes;
use crate::findings::Findings;
use crate::observer::TextSink;
use crate::stream::BATCH;

/// Hands events over in batches, and counts lines.
pub(super) struct EventWriter<'a> {
    dialect: &'a mut dyn DialectSession,
    output: &'a mut dyn TextSink,
    /// Words of a block.
    words: usize,
    batch: Batch,
    text: String,
    ends: Vec<usize>,
    lines: u64,
    /// The CL file has loaded a tool.
    tool_known: bool,
    /// The dialect refused an event, or the output text: no more is made.
    broken: bool,
    /// Where the blocks stand, if an observer asks for it.
    places: Option<BlockLines>,
}

/// Where blocks stand in the program.
#[derive(Default)]
struct BlockLines {
    /// Indices of the events that the blocks of the batch end on; none for a block without one.
    events: Vec<Option<usize>>,
    /// Lines of the program that the blocks before them end on; zero where there is none.
    lines: Vec<u64>,
}

impl<'a> EventWriter<'a> {
    pub(super) fn new(dialect: &'a mut dyn DialectSession, output: &'a mut dyn TextSink) -> Self {
        Self {
            words: dialect.format().words.len(),
            dialect,
            output,
            batch: Batch::default(),
            text: String::new(),
            ends: Vec::new(),
            lines: 0,
            tool_known: false,
            broken: false,
            places: None,
        }
    }

    /// Notes from here on where the blocks stand.
    pub(super) fn watch(&mut self) {
        self.places.get_or_insert_default();
    }

    /// Somebody notes where the blocks stand.
    pub(super) fn notes_places(&self) -> bool {
        self.places.is_some()
    }

    /// A block stands where the last event does, if there are more than `before`.
    #[inline]
    pub(super) fn place(&mut self, before: usize) {
        if let Some(places) = &mut self.places {
            let index = self.batch.len();
            places.events.push((index > before).then(|| index - 1));
        }
    }

    /// Hands over where the blocks stand that are written.
    pub(super) fn take_lines(&mut self) -> impl Iterator<Item = u64> {
        self.places.iter_mut().flat_map(|places| places.lines.drain(..))
    }

    /// The dialect declared that it writes this.
    pub(super) fn knows(&self, capability: Capabilities) -> bool {
        self.dialect.capabilities().has(capability)
    }

    /// What the dialect prints.
    pub(super) fn format(&self) -> &Format {
        self.dialect.format()
    }

    /// Words of a block.
    #[inline]
    pub(super) fn words(&self) -> usize {
        self.words
    }

    /// Lines so far.
    pub(super) fn lines(&self) -> u64 {
        self.lines
    }

    /// Index in the batch that the next event gets.
    #[inline]
    pub(super) fn next(&self) -> usize {
        self.batch.len()
    }

    /// Whether it is time to flush.
    #[inline]
    pub(super) fn is_full(&self) -> bool {
        self.batch.len() >= BATCH
    }

    /// The CL file loads a tool.
    pub(super) fn tool_known(&mut self) {
        self.tool_known = true;
    }

    /// Takes an event that comes from `line`.
    #[inline]
    pub(super) fn push(&mut self, line: u64, event: Event<'_>) {
        if !self.broken {
            self.batch.push(line, event);
        }
    }

    /// Hands the batch to the dialect and its text to the output.
    pub(super) fn flush(&mut self, extremes: &mut Extremes, findings: &Findings) {
        let Self { batch, text, ends, .. } = self;
        if batch.is_empty() {
            if let Some(BlockLines { events, lines }) = &mut self.places {
                lines.extend(events.drain(..).map(|_| 0));
            }
            return;
        }
        text.clear();
        ends.clear();
        let written = self.dialect.write_batch(batch, text, ends);
        extremes.written(|index| {
            let end = ends.get(index).copied().unwrap_or(text.len());
            self.lines + newlines(&text.as_bytes()[..end])
        });
        if let Some(places) = &mut self.places {
            places.written(self.lines, text.as_bytes(), ends);
        }
        self.lines += newlines(text.as_bytes());
        match written {
            Err(refused) => {
                self.broken = true;
                let line = batch.line(refused.index.min(batch.len() - 1));
                let mut fault = Diagnostic::error("dialect", refused.message);
                if !self.tool_known {
                    fault = fault.help("the CL file loads no tool: --tool N says which it is");
                }
                findings.at(line, fault);
            }
            // Where something is wrong already no text is written, but the dialect may find more.
            Ok(()) if findings.failed() => {}
            Ok(()) => {
                if let Err(message) = self.output.write(text.as_bytes()) {
                    self.broken = true;
                    findings.add(Diagnostic::error("output", message));
                }
            }
        }
        batch.clear();
    }
}

impl BlockLines {
    /// The batch is written as `text`, its events up to `ends`, after `lines` lines.
    fn written(&mut self, mut lines: u64, text: &[u8], ends: &[usize]) {
        let mut counted = 0;
        for event in self.events.drain(..) {
            let line = event.map(|event| {
                let end = ends.get(event).copied().unwrap_or(text.len());
                // Events come in order: nothing is counted twice.
                lines += newlines(text.get(counted..end).unwrap_or_default());
                counted = counted.max(end);
                lines
            });
            self.lines.push(line.unwrap_or(0));
        }
    }
}

fn newlines(text: &[u8]) -> u64 {
    memchr::memchr_iter(b'\n', text).count() as u64
}
