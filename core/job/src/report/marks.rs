//! What is marked on the rows of a page: events, and where heads are swapped in.

use post_report::meta::{EventMeta, Meta};

/// More events than this are counted and not listed.
const MOST_EVENTS: usize = 5000;

/// Marks of the rows of a program.
#[derive(Debug, Default)]
pub struct Marks {
    events: Vec<EventMeta>,
    left_out: u64,
    heads: Vec<[u64; 2]>,
}

impl Marks {
    /// Before `row` something happens.
    pub fn event(&mut self, row: u64, kind: &'static str, text: impl Into<String>) {
        match self.events.len() < MOST_EVENTS {
            true => self.events.push(EventMeta { row, kind, text: text.into() }),
            false => self.left_out += 1,
        }
    }

    /// From `row` on a head is in use, known by its name and its number from 1; 0: none.
    pub fn head(&mut self, row: u64, name: &str, number: u64) {
        self.heads.push([row, number]);
        self.event(row, "head", format!("head {name}"));
    }

    /// All is marked.
    pub fn finish(self, meta: &mut Meta) {
        meta.head_rows = self.heads;
        meta.events = self.events;
        meta.events_left_out = self.left_out;
    }
}
