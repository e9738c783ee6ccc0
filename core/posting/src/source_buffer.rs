//! Text of the last records, for messages: a fault may be found when the record that it belongs to is long read.

use std::collections::VecDeque;

use post_grammar::GotoRun;

/// Text of the records whose moves are not settled yet. It stays where it was put until it is forgotten.
#[derive(Debug, Default)]
pub(crate) struct SourceBuffer {
    /// Texts of many pieces each.
    chunks: VecDeque<Vec<u8>>,
    /// Chunks before the first of these.
    gone: u64,
    /// A chunk that is forgotten, to be filled again.
    spare: Vec<u8>,
    pieces: VecDeque<TextPiece>,
    /// Records that were kept since some were forgotten.
    kept: usize,
}

/// Records whose text is kept in one piece.
#[derive(Clone, Copy, Debug)]
struct TextPiece {
    /// Line of the first, and lines of the file from one to the next.
    line: u64,
    lines: u64,
    count: usize,
    /// Number of the chunk that has them.
    chunk: u64,
    /// Where in it the text of the first begins, and bytes from one to the next.
    start: usize,
    stride: usize,
    /// Bytes of each.
    length: usize,
}

/// Records are forgotten in runs of this length.
const RUN: usize = 1024;

/// Bytes of a chunk, unless a piece has more.
const CHUNK: usize = 64 * 1024;

impl TextPiece {
    fn last_line(&self) -> u64 {
        self.line + (self.count as u64 - 1) * self.lines
    }
}

impl SourceBuffer {
    /// Keeps a record; `settled` gives the line before which no fault will be found any more.
    #[inline]
    pub(crate) fn keep(&mut self, line: u64, raw: &[u8], settled: impl FnOnce() -> Option<u64>) {
        let length = raw.len();
        let piece =
            TextPiece { line, lines: 1, count: 1, chunk: 0, start: 0, stride: length, length };
        self.keep_piece(piece, raw, settled);
    }

    /// Keeps the records of a run whose text this is.
    pub(crate) fn keep_run(
        &mut self,
        run: &GotoRun,
        text: &[u8],
        settled: impl FnOnce() -> Option<u64>,
    ) {
        if run.count() == 0 {
            return;
        }
        let piece = TextPiece {
            line: run.line(0),
            lines: run.lines(),
            count: run.count(),
            chunk: 0,
            start: 0,
            stride: run.stride(),
            length: run.length(),
        };
        self.keep_piece(piece, text, settled);
    }

    #[inline]
    fn keep_piece(
        &mut self,
        mut piece: TextPiece,
        text: &[u8],
        settled: impl FnOnce() -> Option<u64>,
    ) {
        if self.kept >= RUN {
            self.forget(settled().unwrap_or(piece.line));
        }
        let room = self.chunks.back().is_some_and(|chunk| chunk.len() + text.len() <= CHUNK);
        if !room {
            let mut chunk = std::mem::take(&mut self.spare);
            chunk.clear();
            chunk.reserve(CHUNK);
            self.chunks.push_back(chunk);
        }
        let Some(chunk) = self.chunks.back_mut() else {
            return;
        };
        piece.start = chunk.len();
        chunk.extend_from_slice(text);
        piece.chunk = self.gone + self.chunks.len() as u64 - 1;
        self.kept += piece.count;
        self.pieces.push_back(piece);
    }

    fn forget(&mut self, before: u64) {
        let count = self.pieces.partition_point(|piece| piece.last_line() < before);
        self.kept = 0;
        self.pieces.drain(..count);
        let end = self.gone + self.chunks.len() as u64;
        let first = self.pieces.front().map_or(end, |piece| piece.chunk);
        while self.gone < first
            && let Some(chunk) = self.chunks.pop_front()
        {
            self.spare = chunk;
            self.gone += 1;
        }
    }

    /// The text of the record on `line`.
    pub(crate) fn text(&self, line: u64) -> Option<String> {
        let after = self.pieces.partition_point(|piece| piece.line <= line);
        let piece = self.pieces.get(after.checked_sub(1)?)?;
        let chunk = self.chunks.get((piece.chunk - self.gone) as usize)?;
        let away = line - piece.line;
        if !away.is_multiple_of(piece.lines) || line > piece.last_line() {
            return None;
        }
        let start = piece.start + (away / piece.lines) as usize * piece.stride;
        let text = &chunk[start..start + piece.length];
        Some(String::from_utf8_lossy(text).trim_end().to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use post_grammar::ClReader;

    #[test]
    fn what_is_not_settled_is_remembered() {
        let mut source = SourceBuffer::default();
        for line in 1..5000u64 {
            source.keep(line, format!("GOTO/{line}").as_bytes(), || Some(line - 10));
        }
        assert_eq!(source.text(4999).as_deref(), Some("GOTO/4999"));
        assert_eq!(source.text(4600).as_deref(), Some("GOTO/4600"));
        assert_eq!(source.text(17), None);
        assert!(source.pieces.len() <= 2 * RUN);
    }

    #[test]
    fn the_records_of_a_run_are_remembered_one_by_one() {
        let plain = "GOTO/1.00,2.00,3.00\n";
        let parted = "GOTO / 1.00, 2.00, 3.00,  $\n0.00, 0.00, 1.00\n";
        for (form, lines) in [(plain, 1), (parted, 2)] {
            let file = form.repeat(100);
            let mut reader = ClReader::new(file.as_bytes());
            let (mut source, mut run) = (SourceBuffer::default(), GotoRun::default());
            let (mut expected, mut in_runs) = (Vec::new(), 0);
            loop {
                let text = reader.next_gotos(&mut run);
                source.keep_run(&run, text, || None);
                in_runs += run.count();
                for place in 0..run.count() {
                    let record = run.record(place, text);
                    expected.push((record.line, record.text().trim_end().to_owned()));
                }
                let Some(record) = reader.next_record().unwrap() else {
                    break;
                };
                source.keep(record.line, record.raw, || None);
                expected.push((record.line, record.text().trim_end().to_owned()));
            }
            assert_eq!(expected.len(), 100);
            assert!(in_runs > 50);
            for (line, text) in expected {
                assert_eq!(source.text(line).as_deref(), Some(text.as_str()));
                assert!(lines == 1 || source.text(line + 1).is_none());
            }
        }
    }
}
