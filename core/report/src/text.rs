//! A text, without loss.

use std::io::{self, Write};

use crate::deflate::Deflate;
use crate::meta::TextMeta;
use crate::{part, template};

/// Lines of a chunk: few enough that the page shows a far one at once.
const CHUNK: u64 = 1 << 12;

/// Bytes of a chunk, whatever its lines.
const MOST: usize = 1 << 20;

/// Takes a text and hands it on packed, chunk by chunk.
pub struct TextWriter<W> {
    name: &'static str,
    lines: u64,
    in_chunk: u64,
    chunk: Vec<u8>,
    bytes: u64,
    /// Packer for chunks that go as they are, and for templates.
    deflate: Deflate,
    numbers: Deflate,
    packed: Vec<u8>,
    out: W,
}

impl<W: Write> TextWriter<W> {
    /// An empty text of that name, whose chunks go to `out`.
    pub fn new(name: &'static str, out: W) -> Self {
        Self {
            name,
            lines: 0,
            in_chunk: 0,
            chunk: Vec::new(),
            bytes: 0,
            deflate: Deflate::of_texts(),
            numbers: Deflate::of_numbers(),
            packed: Vec::new(),
            out,
        }
    }

    /// Takes more of the text.
    ///
    /// # Errors
    /// What is packed cannot be written.
    pub fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        for line in template::lines_of(bytes) {
            self.chunk.extend_from_slice(line);
            if line.ends_with(b"\n") {
                self.in_chunk += 1;
                if self.in_chunk >= CHUNK || self.chunk.len() >= MOST {
                    self.flush()?;
                }
            }
        }
        Ok(())
    }

    /// The end of the text: what the page must know of it, and its sink.
    ///
    /// # Errors
    /// What is packed cannot be written.
    pub fn finish(mut self) -> io::Result<(TextMeta, W)> {
        if !self.chunk.is_empty() {
            if !self.chunk.ends_with(b"\n") {
                self.in_chunk += 1;
            }
            self.flush()?;
        }
        let meta = TextMeta { name: self.name, lines: self.lines, bytes: self.bytes };
        Ok((meta, self.out))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.lines += self.in_chunk;
        let lines = (self.in_chunk as u32).to_le_bytes();
        // What would not come back letter for letter goes as it is.
        let templates = template::encode(&self.chunk).filter(|packed| {
            let back = template::decode(packed, self.in_chunk as usize);
            back.as_deref() == Some(self.chunk.as_slice())
        });
        match templates {
            Some(packed) => {
                self.numbers.piece(&lines);
                self.numbers.piece(&[TEMPLATES]);
                self.numbers.piece(&packed);
                self.numbers.take(&mut self.packed);
            }
            None => {
                self.deflate.piece(&lines);
                self.deflate.piece(&[PLAIN]);
                self.deflate.piece(&self.chunk);
                self.deflate.take(&mut self.packed);
            }
        }
        // A table may have the same name.
        let name = format!("text.{}", self.name);
        self.bytes += part::write(&mut self.out, &name, &self.packed)?;
        self.in_chunk = 0;
        self.chunk.clear();
        Ok(())
    }
}

/// The chunk is the text as it is.
const PLAIN: u8 = 0;

/// The chunk is templates and columns.
const TEMPLATES: u8 = 1;
