//! Events as they cross the border, and back.

#![allow(unsafe_code)]

use super::{PostEvent, PostText, slice};
use crate::field::{FieldReader, MAX_TEXTS};
use crate::{Batch, Event};

/// The first `count` events of `batch` in their raw form; they borrow from it without the compiler's help, so both
/// vectors must be emptied before the batch changes.
pub fn events(batch: &Batch, count: usize, events: &mut Vec<PostEvent>, texts: &mut Vec<PostText>) {
    events.clear();
    texts.clear();
    for index in 0..count {
        texts.extend(batch.texts(index).map(PostText::new));
    }
    let mut texts = texts.as_slice();
    for index in 0..count {
        let (stored, numbers) = batch.stored(index);
        let (own, rest) = texts.split_at(batch.texts(index).count());
        texts = rest;
        events.push(PostEvent {
            kind: stored.kind,
            texts_len: own.len() as u32,
            line: stored.line,
            numbers: numbers.as_ptr(),
            numbers_len: numbers.len(),
            texts: own.as_ptr(),
        });
    }
}

impl PostEvent {
    /// The event in its safe form. A kind that is not known, or one with a code that is not, comes out as
    /// [`Event::Unknown`]; none if a text is not valid UTF-8.
    ///
    /// # Safety
    /// Every pointer in it is valid for `'a`.
    #[inline]
    pub unsafe fn get<'a>(&self) -> Option<Event<'a>> {
        // SAFETY: handed on to the caller, here and for the texts.
        let numbers = unsafe { slice(self.numbers, self.numbers_len) };
        let mut texts = [""; MAX_TEXTS];
        let raw = unsafe { slice(self.texts, self.texts_len as usize) };
        for (raw, text) in raw.iter().zip(&mut texts) {
            *text = unsafe { raw.get() }?;
        }
        let unknown = Event::Unknown { kind: self.kind };
        Some(Event::get(self.kind, &mut FieldReader::new(numbers, texts)).unwrap_or(unknown))
    }
}
