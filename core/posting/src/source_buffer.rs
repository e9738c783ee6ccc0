//! Text of the last records, for messages: a fault may be found when the record that it belongs to is long read.

use post_grammar::GotoRun;

/// Text of the records whose moves are not settled yet.
#[derive(Debug, Default)]
pub(crate) struct SourceBuffer {
    text: Vec<u8>,
    /// Line and where its text begins.
    lines: Vec<(u64, usize)>,
}

/// Records are forgotten in runs of this length.
const RUN: usize = 1024;

impl SourceBuffer {
    /// Keeps a record; `settled` gives the line before which no fault will be found any more.
    #[inline]
    pub(crate) fn keep(&mut self, line: u64, raw: &[u8], settled: impl FnOnce() -> Option<u64>) {
        if self.lines.len().is_multiple_of(RUN) && !self.lines.is_empty() {
            self.forget(settled().unwrap_or(line));
        }
        self.lines.push((line, self.text.len()));
        self.text.extend_from_slice(raw);
    }

    /// Keeps the records of a run whose text this is.
    pub(crate) fn keep_run(
        &mut self,
        run: &GotoRun,
        text: &[u8],
        settled: impl FnOnce() -> Option<u64>,
    ) {
        let count = run.points().len();
        if self.lines.len() % RUN + count > RUN {
            self.forget(settled().unwrap_or(run.line(0)));
        }
        if run.is_by_lines() {
            let (start, stride) = (self.text.len(), run.stride());
            let lines = (0..count).map(|place| (run.line(place), start + place * stride));
            self.lines.extend(lines);
            self.text.extend_from_slice(text);
            return;
        }
        for place in 0..count {
            let record = run.record(place, text);
            self.lines.push((record.line, self.text.len()));
            self.text.extend_from_slice(record.raw);
        }
    }

    fn forget(&mut self, before: u64) {
        let count = self.lines.partition_point(|(line, _)| *line < before);
        let from = self.lines.get(count).map_or(self.text.len(), |(_, start)| *start);
        self.lines.drain(..count);
        self.text.drain(..from);
        for (_, start) in &mut self.lines {
            *start -= from;
        }
    }

    /// The text of the record on `line`.
    pub(crate) fn text(&self, line: u64) -> Option<String> {
        let place = self.lines.binary_search_by_key(&line, |(line, _)| *line).ok()?;
        let start = self.lines[place].1;
        let end = self.lines.get(place + 1).map_or(self.text.len(), |(_, next)| *next);
        Some(String::from_utf8_lossy(&self.text[start..end]).trim_end().to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_settled_is_remembered() {
        let mut source = SourceBuffer::default();
        for line in 1..5000u64 {
            source.keep(line, format!("GOTO/{line}").as_bytes(), || Some(line - 10));
        }
        assert_eq!(source.text(4999).as_deref(), Some("GOTO/4999"));
        assert_eq!(source.text(4600).as_deref(), Some("GOTO/4600"));
        assert_eq!(source.text(17), None);
        assert!(source.lines.len() <= 2 * RUN);
    }
}
