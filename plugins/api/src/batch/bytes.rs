//! A batch as bytes, for a process of the same program on the same computer: numbers are in the order of its processor.

use super::{Batch, Stored};

/// Bytes of an event: its line, its kind, where its numbers and its texts end.
const EVENT: usize = 20;

impl Batch {
    /// Appends the batch to `bytes`, as [`Batch::from_bytes`] takes it.
    pub fn put_bytes(&self, bytes: &mut Vec<u8>) {
        let Batch { events, flat } = self;
        let lengths = [events.len(), flat.numbers.len(), flat.texts.len(), flat.text.len()];
        bytes.extend(lengths.iter().flat_map(|length| (*length as u64).to_ne_bytes()));
        for event in events {
            bytes.extend_from_slice(&event.line.to_ne_bytes());
            for number in [event.kind, event.numbers_end, event.texts_end] {
                bytes.extend_from_slice(&number.to_ne_bytes());
            }
        }
        for number in &flat.numbers {
            bytes.extend_from_slice(&number.to_ne_bytes());
        }
        for end in &flat.texts {
            bytes.extend_from_slice(&end.to_ne_bytes());
        }
        bytes.extend_from_slice(flat.text.as_bytes());
    }

    /// Takes the place of what it was by the batch of these bytes; none if they are no batch, and then it is empty.
    pub fn from_bytes(&mut self, bytes: &[u8]) -> Option<()> {
        self.clear();
        let read = self.read(bytes);
        if read.is_none() {
            self.clear();
        }
        read
    }

    fn read(&mut self, mut bytes: &[u8]) -> Option<()> {
        let mut lengths = [0; 4];
        for length in &mut lengths {
            *length = usize::try_from(u64::from_ne_bytes(array(&mut bytes)?)).ok()?;
        }
        let [events, numbers, texts, text] = lengths;
        let mut events = taken(&mut bytes, events.checked_mul(EVENT)?)?;
        let mut numbers = taken(&mut bytes, numbers.checked_mul(8)?)?;
        let mut texts = taken(&mut bytes, texts.checked_mul(4)?)?;
        self.flat.text.push_str(std::str::from_utf8(taken(&mut bytes, text)?).ok()?);
        while let Some(number) = array(&mut numbers) {
            self.flat.numbers.push(f64::from_ne_bytes(number));
        }
        let mut before = 0;
        while let Some(end) = array(&mut texts) {
            let end = u32::from_ne_bytes(end);
            self.flat.text.get(before as usize..end as usize)?;
            before = end;
            self.flat.texts.push(end);
        }
        let mut before = (0, 0);
        while let Some(line) = array(&mut events) {
            let line = u64::from_ne_bytes(line);
            let mut number = || Some(u32::from_ne_bytes(array(&mut events)?));
            let (kind, numbers_end, texts_end) = (number()?, number()?, number()?);
            self.flat.numbers.get(before.0 as usize..numbers_end as usize)?;
            self.flat.texts.get(before.1 as usize..texts_end as usize)?;
            before = (numbers_end, texts_end);
            self.events.push(Stored { line, kind, numbers_end, texts_end });
        }
        bytes.is_empty().then_some(())
    }
}

fn taken<'a>(bytes: &mut &'a [u8], length: usize) -> Option<&'a [u8]> {
    let (taken, rest) = bytes.split_at_checked(length)?;
    *bytes = rest;
    Some(taken)
}

fn array<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (taken, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*taken)
}
