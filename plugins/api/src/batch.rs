//! A run of events, stored flat: no allocation for an event once the buffers have grown.

mod bytes;

use crate::Event;
use crate::field::{FieldReader, MAX_TEXTS};
use crate::flat::Flat;

/// Events in order, each with the line of the CL file it comes from.
#[derive(Debug, Default)]
pub struct Batch {
    events: Vec<Stored>,
    flat: Flat,
}

/// An event whose numbers and texts end here; they begin where those of the event before it end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stored {
    pub(crate) line: u64,
    pub(crate) kind: u32,
    numbers_end: u32,
    texts_end: u32,
}

impl Batch {
    /// Appends an event that comes from `line`.
    #[inline]
    pub fn push(&mut self, line: u64, event: Event<'_>) {
        event.put(&mut self.flat);
        self.events.push(Stored {
            line,
            kind: event.kind(),
            numbers_end: self.flat.numbers.len() as u32,
            texts_end: self.flat.texts.len() as u32,
        });
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
        self.flat.numbers.clear();
        self.flat.texts.clear();
        self.flat.text.clear();
    }

    /// Line of the CL file that event `index` comes from.
    pub fn line(&self, index: usize) -> u64 {
        self.events[index].line
    }

    /// Event `index`.
    #[inline]
    pub fn event(&self, index: usize) -> Event<'_> {
        let (stored, numbers) = self.stored(index);
        let mut texts = [""; MAX_TEXTS];
        for (place, text) in self.texts(index).zip(&mut texts) {
            *text = place;
        }
        // What was pushed comes back.
        Event::get(stored.kind, &mut FieldReader::new(numbers, texts))
            .unwrap_or(Event::Unknown { kind: stored.kind })
    }

    /// All events in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Event<'_>> {
        (0..self.len()).map(|index| self.event(index))
    }

    /// Event `index` with its numbers.
    #[inline]
    pub(crate) fn stored(&self, index: usize) -> (Stored, &[f64]) {
        let stored = self.events[index];
        let start = self.before(index).map_or(0, |before| before.numbers_end);
        let numbers = &self.flat.numbers[start as usize..stored.numbers_end as usize];
        (stored, numbers)
    }

    /// The texts of event `index`.
    #[inline]
    pub(crate) fn texts(&self, index: usize) -> impl Iterator<Item = &str> {
        let start = self.before(index).map_or(0, |before| before.texts_end) as usize;
        let end = self.events[index].texts_end as usize;
        (start..end).map(|place| {
            let ends = &self.flat.texts;
            let from = place.checked_sub(1).map_or(0, |before| ends[before]);
            &self.flat.text[from as usize..ends[place] as usize]
        })
    }

    #[inline]
    fn before(&self, index: usize) -> Option<&Stored> {
        index.checked_sub(1).map(|before| &self.events[before])
    }
}
