//! Text of the last records, for messages: a fault may be found when the record that it belongs to is long read.

use post_grammar::GotoRun;

/// Text of the records whose moves are not settled yet.
#[derive(Debug, Default)]
pub(crate) struct SourceBuffer {
    text: Vec<u8>,
    pieces: Vec<TextPiece>,
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
    /// Where the text of the first begins, and bytes from one to the next.
    start: usize,
    stride: usize,
    /// Bytes of each.
    length: usize,
}

/// Records are forgotten in runs of this length.
const RUN: usize = 1024;

impl TextPiece {
    fn last_line(&self) -> u64 {
        self.line + (self.count as u64 - 1) * self.lines
    }
}

impl SourceBuffer {
    /// Keeps a record; `settled` gives the line before which no fault will be found any more.
    #[inline]
    pub(crate) fn keep(&mut self, line: u64, raw: &[u8], settled: impl FnOnce() -> Option<u64>) {
        let (start, length) = (self.text.len(), raw.len());
        let piece = TextPiece { line, lines: 1, count: 1, start, stride: length, length };
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
            start: self.text.len(),
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
            piece.start = self.text.len();
        }
        self.kept += piece.count;
        self.pieces.push(piece);
        self.text.extend_from_slice(text);
    }

    fn forget(&mut self, before: u64) {
        let count = self.pieces.partition_point(|piece| piece.last_line() < before);
        let from = self.pieces.get(count).map_or(self.text.len(), |piece| piece.start);
        self.kept = 0;
        // What stays is moved: never more than what goes, so that a byte is moved once at most.
        if from < self.text.len() - from {
            return;
        }
        self.pieces.drain(..count);
        self.text.drain(..from);
        for piece in &mut self.pieces {
            piece.start -= from;
        }
    }

    /// The text of the record on `line`.
    pub(crate) fn text(&self, line: u64) -> Option<String> {
        let after = self.pieces.partition_point(|piece| piece.line <= line);
        let piece = self.pieces[..after].last()?;
        let away = line - piece.line;
        if !away.is_multiple_of(piece.lines) || line > piece.last_line() {
            return None;
        }
        let start = piece.start + (away / piece.lines) as usize * piece.stride;
        let text = &self.text[start..start + piece.length];
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
