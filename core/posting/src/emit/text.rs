//! Batches of events become text: the dialect writes them, and the output takes it.

use post_machine::diagnostic::Diagnostic;
use post_plugin::{Batch, DialectSession};

use crate::observer::TextSink;

/// Events on their way to the dialect, and what comes back of them.
#[derive(Default)]
pub(super) struct EventBatch {
    /// The events.
    pub events: Batch,
    /// Lines of the user's own that no dialect sees: before the text of the events, and behind it.
    pub bare: [String; 2],
    /// How much work they are, in blocks.
    pub work: usize,
    /// Its place among the batches, from 1.
    pub number: u64,
    /// Findings before it.
    pub found: usize,
    /// Something was wrong before it: no text is written any more, but the dialect may find more.
    pub failed: bool,
    /// Events whose lines are asked for.
    pub marks: [Option<usize>; 3],
    /// Lines of the program that these events end on.
    pub marks_lines: [Option<u64>; 3],
    /// Where the blocks stand, if an observer asks for it.
    pub places: Option<BlockLines>,
    /// Lines of the program up to its end.
    pub lines_behind: u64,
    /// The dialect refused an event, or the output text.
    pub fault: Option<BatchFault>,
}

/// Why the program ends with a batch.
pub(super) struct BatchFault {
    /// Line of the CL file, of an event that the dialect refuses.
    pub line: Option<u64>,
    /// Findings before it.
    pub found: usize,
    /// What is wrong.
    pub finding: Diagnostic,
}

/// Where blocks stand in the program.
#[derive(Default)]
pub(super) struct BlockLines {
    /// Indices of the events that the blocks of the batch end on; none for a block without one.
    pub events: Vec<Option<usize>>,
    /// Lines of the program that the blocks before them end on; zero where there is none.
    pub lines: Vec<u64>,
}

/// Has the dialect write batches, and counts lines.
pub(super) struct TextWriter<'a> {
    dialect: &'a mut dyn DialectSession,
    output: &'a mut dyn TextSink,
    text: String,
    ends: Vec<usize>,
    lines: u64,
    /// The dialect refused an event, or the output text: no more is made.
    broken: bool,
}

impl<'a> TextWriter<'a> {
    pub(super) fn new(dialect: &'a mut dyn DialectSession, output: &'a mut dyn TextSink) -> Self {
        Self { dialect, output, text: String::new(), ends: Vec::new(), lines: 0, broken: false }
    }

    /// Writes a batch, and notes in it what came of it.
    pub(super) fn write(&mut self, batch: &mut EventBatch) {
        batch.marks_lines = [None; 3];
        batch.lines_behind = self.lines;
        if self.broken {
            return;
        }
        let Self { text, ends, .. } = self;
        text.clear();
        ends.clear();
        text.push_str(&batch.bare[0]);
        let written = self.dialect.write_batch(&batch.events, text, ends);
        text.push_str(&batch.bare[1]);
        for (line, mark) in batch.marks_lines.iter_mut().zip(batch.marks) {
            *line = mark.map(|index| {
                let end = ends.get(index).copied().unwrap_or(text.len());
                self.lines + newlines(&text.as_bytes()[..end])
            });
        }
        if let Some(places) = &mut batch.places {
            places.written(self.lines, text.as_bytes(), ends);
        }
        self.lines += newlines(text.as_bytes());
        batch.lines_behind = self.lines;
        let fault = match written {
            Err(refused) => {
                let events = &batch.events;
                // What stands ahead of all that the CL file says comes from no line of it.
                let line = Some(events.line(refused.index.min(events.len() - 1)));
                let finding = Diagnostic::error("dialect", refused.message);
                Some((line.filter(|line| *line > 0), finding))
            }
            Ok(()) if batch.failed => None,
            Ok(()) => {
                let kept = self.output.write(text.as_bytes());
                kept.err().map(|message| (None, Diagnostic::error("output", message)))
            }
        };
        self.broken = fault.is_some();
        batch.fault = fault.map(|(line, finding)| BatchFault { line, found: batch.found, finding });
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
