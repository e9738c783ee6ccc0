//! Places in a text: bytes here, lines and UTF-16 units in the protocol.

use std::ops::Range;

use gen_lsp_types::{Position, Range as LspRange};

/// Where the lines of a text begin.
#[derive(Clone, Debug)]
pub struct LineStarts {
    starts: Vec<usize>,
}

impl LineStarts {
    /// Of a text. A line ends at LF, CR LF or CR, as in CL files.
    pub fn of(text: &str) -> Self {
        let mut starts = vec![0];
        starts.extend(ends(text, 0..text.len()));
        Self { starts }
    }

    /// The bytes `old` of a text were replaced by `length` others, which gave `text`: what stands elsewhere is not looked
    /// through again.
    pub fn edit(&mut self, text: &str, old: &Range<usize>, length: usize) {
        // One line more on either side: a CR and a LF make one end together.
        let first = self.line_of(old.start).saturating_sub(1);
        let last = (self.line_of(old.end) + 2).min(self.starts.len());
        let mut behind = self.starts.split_off(last);
        for start in &mut behind {
            *start = *start - old.len() + length;
        }
        self.starts.truncate(first + 1);
        let end = behind.first().copied().unwrap_or(text.len());
        let found = ends(text, self.starts[first]..end);
        let is_new = |start: &usize| behind.first() != Some(start);
        self.starts.extend(found.filter(is_new));
        self.starts.append(&mut behind);
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// Bytes of line `line`, counted from 0, without its end; of one behind the last nothing.
    pub fn span(&self, text: &str, line: usize) -> Range<usize> {
        let Some(start) = self.starts.get(line).copied() else {
            return text.len()..text.len();
        };
        let end = self.starts.get(line + 1).copied().unwrap_or(text.len());
        let line = text.get(start..end).unwrap_or_default();
        start..start + line.trim_end_matches(['\r', '\n']).len()
    }

    /// The line that byte `at` stands in, counted from 0.
    pub fn line_of(&self, at: usize) -> usize {
        self.starts.partition_point(|start| *start <= at).max(1) - 1
    }

    /// The byte of a position; one behind the end of its line is that end, as the protocol wants it.
    pub fn byte(&self, text: &str, position: Position) -> usize {
        let line = usize::try_from(position.line).unwrap_or(usize::MAX);
        let span = self.span(text, line);
        let mut units = 0;
        for (at, letter) in text[span.clone()].char_indices() {
            if units >= position.character {
                return span.start + at;
            }
            units += letter.len_utf16() as u32;
        }
        span.end
    }

    /// The position of a byte; one inside a letter is that of the letter.
    pub fn position(&self, text: &str, at: usize) -> Position {
        let at = at.min(text.len());
        let line = self.line_of(at);
        let start = self.starts[line];
        let before = text[start..].char_indices();
        let before = before.take_while(|(place, letter)| start + place + letter.len_utf8() <= at);
        let units: usize = before.map(|(_, letter)| letter.len_utf16()).sum();
        Position::new(number(line), number(units))
    }

    /// The range of bytes.
    pub fn range(&self, text: &str, span: Range<usize>) -> LspRange {
        LspRange::new(
            self.position(text, span.start),
            self.position(text, span.end.max(span.start)),
        )
    }

    /// The whole of a line, counted from 1 as in findings.
    pub fn whole(&self, text: &str, line: u64) -> LspRange {
        let line = usize::try_from(line.saturating_sub(1)).unwrap_or(usize::MAX);
        let span = self.span(text, line.min(self.count() - 1));
        self.range(text, span)
    }
}

/// Where lines end in a part of a text, each end with its bytes.
fn ends(text: &str, part: Range<usize>) -> impl Iterator<Item = usize> + '_ {
    let bytes = text.as_bytes();
    part.filter(move |at| {
        let byte = bytes[*at];
        byte == b'\n' || (byte == b'\r' && bytes.get(at + 1) != Some(&b'\n'))
    })
    .map(|at| at + 1)
}

/// A count as the protocol has it.
pub fn number(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_follow_edits() {
        const PIECES: [&str; 7] = ["", "\n", "\r", "\r\n", "ab", "ä\n\nb", "x\ry\n"];
        let mut state = 1_u64;
        let mut random = |below: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % below
        };
        let mut text = String::new();
        let mut lines = LineStarts::of(&text);
        for _ in 0..5000 {
            let mut border = |text: &str| {
                let mut at = random(text.len() + 1);
                while !text.is_char_boundary(at) {
                    at -= 1;
                }
                at
            };
            let (one, other) = (border(&text), border(&text));
            // Long enough to have lines on either side, short enough to meet all borders.
            let most = one.min(other) + 5;
            let mut end = one.max(other).min(most);
            while !text.is_char_boundary(end) {
                end += 1;
            }
            let old = one.min(other)..end;
            let piece = PIECES[random(PIECES.len())];
            text.replace_range(old.clone(), piece);
            lines.edit(&text, &old, piece.len());
            assert_eq!(lines.starts, LineStarts::of(&text).starts, "{text:?}");
            if text.len() > 60 {
                text.clear();
                lines = LineStarts::of(&text);
            }
        }
    }

    #[test]
    fn columns_are_utf_16() {
        // One unit, two, one.
        let text = "ä𝄞z\r\nb\rc\n";
        let lines = LineStarts::of(text);
        assert_eq!(lines.count(), 4);
        for (at, line, column) in [(0, 0, 0), (2, 0, 1), (6, 0, 3), (7, 0, 4), (9, 1, 0)] {
            let position = Position::new(line, column);
            assert_eq!(lines.position(text, at), position, "{at}");
            assert_eq!(lines.byte(text, position), at);
        }
        // Behind the end of a line, and of the text.
        assert_eq!(lines.byte(text, Position::new(0, 99)), 7);
        assert_eq!(lines.byte(text, Position::new(99, 0)), text.len());
        assert_eq!(&text[lines.span(text, 2)], "c");
    }
}
