//! A run of events, stored flat: no allocation for an event once the buffers have grown.

use crate::{Compensation, Coolant, Event, Feed, Spindle};

/// Events in order, each with the line of the CL file it comes from.
#[derive(Debug, Default)]
pub struct Batch {
    events: Vec<Stored>,
    values: Vec<f64>,
    text: String,
}

#[derive(Clone, Copy, Debug)]
struct Stored {
    line: u64,
    step: Step,
}

/// [`Event`] with ranges in the place of slices.
#[derive(Clone, Copy, Debug)]
enum Step {
    Start,
    Comment(Range),
    Literal(Range),
    Word(Range),
    ToolChange(u32, u32, Range),
    Preselect(u32),
    Spindle(Spindle),
    Coolant(Coolant),
    Compensate(Compensation),
    Position(Range, Option<Feed>),
    Release,
    Rapid(Range),
    Linear(Range, Feed),
    Dwell(f64),
    Stop,
    OptionalStop,
    Home,
    End,
    Unknown(u32),
}

#[derive(Clone, Copy, Debug)]
struct Range {
    start: u32,
    len: u32,
}

impl Batch {
    /// Appends an event that comes from `line`.
    pub fn push(&mut self, line: u64, event: Event<'_>) {
        let step = match event {
            Event::Start => Step::Start,
            Event::Comment { text } => Step::Comment(self.keep_text(text)),
            Event::Literal { text } => Step::Literal(self.keep_text(text)),
            Event::Word { text } => Step::Word(self.keep_text(text)),
            Event::ToolChange {
                number,
                register,
                name,
            } => Step::ToolChange(number, register, self.keep_text(name)),
            Event::Preselect { number } => Step::Preselect(number),
            Event::Spindle(spindle) => Step::Spindle(spindle),
            Event::Coolant(coolant) => Step::Coolant(coolant),
            Event::Compensate(compensation) => Step::Compensate(compensation),
            Event::Position { words, feed } => Step::Position(self.keep_values(words), feed),
            Event::Release => Step::Release,
            Event::Rapid { words } => Step::Rapid(self.keep_values(words)),
            Event::Linear { words, feed } => Step::Linear(self.keep_values(words), feed),
            Event::Dwell { seconds } => Step::Dwell(seconds),
            Event::Stop => Step::Stop,
            Event::OptionalStop => Step::OptionalStop,
            Event::Home => Step::Home,
            Event::End => Step::End,
            Event::Unknown { kind } => Step::Unknown(kind),
        };
        self.events.push(Stored { line, step });
    }

    /// Number of events.
    pub fn len(&self) -> usize {
        self.events.len()
    }

    /// No events.
    pub fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// Forgets all events and keeps the memory.
    pub fn clear(&mut self) {
        self.events.clear();
        self.values.clear();
        self.text.clear();
    }

    /// Line of the CL file that event `index` comes from.
    pub fn line(&self, index: usize) -> u64 {
        self.events[index].line
    }

    /// Event `index`.
    pub fn event(&self, index: usize) -> Event<'_> {
        match self.events[index].step {
            Step::Start => Event::Start,
            Step::Comment(range) => Event::Comment {
                text: self.text(range),
            },
            Step::Literal(range) => Event::Literal {
                text: self.text(range),
            },
            Step::Word(range) => Event::Word {
                text: self.text(range),
            },
            Step::ToolChange(number, register, range) => Event::ToolChange {
                number,
                register,
                name: self.text(range),
            },
            Step::Preselect(number) => Event::Preselect { number },
            Step::Spindle(spindle) => Event::Spindle(spindle),
            Step::Coolant(coolant) => Event::Coolant(coolant),
            Step::Compensate(compensation) => Event::Compensate(compensation),
            Step::Position(range, feed) => Event::Position {
                words: self.values(range),
                feed,
            },
            Step::Release => Event::Release,
            Step::Rapid(range) => Event::Rapid {
                words: self.values(range),
            },
            Step::Linear(range, feed) => Event::Linear {
                words: self.values(range),
                feed,
            },
            Step::Dwell(seconds) => Event::Dwell { seconds },
            Step::Stop => Event::Stop,
            Step::OptionalStop => Event::OptionalStop,
            Step::Home => Event::Home,
            Step::End => Event::End,
            Step::Unknown(kind) => Event::Unknown { kind },
        }
    }

    /// All events in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Event<'_>> {
        (0..self.len()).map(|index| self.event(index))
    }

    fn keep_text(&mut self, text: &str) -> Range {
        let start = self.text.len() as u32;
        self.text.push_str(text);
        Range {
            start,
            len: text.len() as u32,
        }
    }

    fn keep_values(&mut self, values: &[f64]) -> Range {
        let start = self.values.len() as u32;
        self.values.extend_from_slice(values);
        Range {
            start,
            len: values.len() as u32,
        }
    }

    fn text(&self, range: Range) -> &str {
        &self.text[range.start as usize..][..range.len as usize]
    }

    fn values(&self, range: Range) -> &[f64] {
        &self.values[range.start as usize..][..range.len as usize]
    }
}
