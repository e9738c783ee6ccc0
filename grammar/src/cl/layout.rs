//! `GOTO` records laid out as the one before, by loads at known places.
//!
//! A CAM system writes the same decimals and the same blanks in nearly every record, so that digits stand where the
//! record before has them. Such a layout is found once. A record with the same characters at the same places, digits
//! aside, is then taken without a search, a loop over digits, or a branch that depends on a number: bit for bit
//! what the scanner gives.

use crate::layout::{Characters, LONGEST, LayoutScan, LearningPace, NumberPlace, WINDOW, window};

/// How the last `GOTO` record was laid out.
#[derive(Clone, Debug)]
pub(super) struct RecordLayout {
    characters: Characters,
    numbers: [NumberPlace; 6],
    /// Numbers, 3 or 6; the last three are the tool axis.
    count: usize,
    /// Some number has more than eight digits.
    long: bool,
    /// Lines of the file.
    lines: usize,
    /// Where the text of each line begins and ends, blanks and `$` at the ends of a continued line aside.
    pieces: [(usize, usize); 6],
    pace: LearningPace,
}

impl RecordLayout {
    /// No layout is known yet.
    pub(super) fn new() -> Self {
        Self {
            characters: Characters::NONE,
            numbers: [NumberPlace::default(); 6],
            count: 0,
            long: false,
            lines: 0,
            pieces: [(0, 0); 6],
            pace: LearningPace::FIRST,
        }
    }

    /// Bytes of the record, with its line ends.
    pub(super) fn length(&self) -> usize {
        self.characters.length()
    }

    /// Lines of the file that the record takes.
    pub(super) fn lines(&self) -> u64 {
        self.lines as u64
    }

    /// Six numbers are given, the last three being the tool axis.
    pub(super) fn has_axis(&self) -> bool {
        self.count == 6
    }

    /// Numbers of the record that begins at `start`, if it is laid out so; what is at `end` and after it is not read yet.
    /// Zeros stand for a tool axis that is not given.
    #[inline(always)]
    pub(super) fn goto(&mut self, buffer: &[u8], start: usize, end: usize) -> Option<[f64; 6]> {
        let window = window(buffer, start)?;
        if !self.begins(buffer, start, end) {
            return None;
        }
        self.pace.hits = self.pace.hits.saturating_add(1);
        let mut values = [0.0; 6];
        if self.long {
            self.values::<true>(window, &mut values);
        } else {
            self.values::<false>(window, &mut values);
        }
        Some(values)
    }

    /// Takes the records from `start` on that are laid out so, up to `end` and as many as the columns hold: a column each
    /// number, zeros for a tool axis that is not given. Gives how many.
    pub(super) fn gotos<const MOST: usize>(
        &mut self,
        buffer: &[u8],
        start: usize,
        end: usize,
        columns: &mut [[f64; MOST]; 6],
    ) -> usize {
        let Some(first) = window(buffer, start).filter(|_| self.characters.length() > 0) else {
            return 0;
        };
        let mut windows = [first; MOST];
        let (mut count, mut at) = (0, start);
        while count < MOST
            && at + self.characters.length() <= end
            && let Some(window) = window(buffer, at)
            && self.characters.is_of(window)
        {
            windows[count] = window;
            count += 1;
            at += self.characters.length();
        }
        let windows = &windows[..count];
        self.pace.hits = self.pace.hits.saturating_add(count as u32);
        for (number, column) in self.numbers[..self.count].iter().zip(&mut *columns) {
            let column = &mut column[..count];
            if self.long {
                number.sizes::<true>(windows, column);
            } else {
                number.sizes::<false>(windows, column);
            }
            for value in column {
                *value = number.value(*value);
            }
        }
        for column in &mut columns[self.count..] {
            column[..count].fill(0.0);
        }
        count
    }

    /// A record that is laid out so begins at `start`; what is at `end` and after it is not read yet.
    pub(super) fn begins(&self, buffer: &[u8], start: usize, end: usize) -> bool {
        let length = self.characters.length();
        length > 0
            && start + length <= end
            && window(buffer, start).is_some_and(|window| self.characters.is_of(window))
    }

    /// Fills in the numbers; `LONG` if one has more than eight digits.
    #[inline(always)]
    fn values<const LONG: bool>(&self, window: &[u8; WINDOW], values: &mut [f64; 6]) {
        for (value, number) in values.iter_mut().zip(&self.numbers[..self.count]) {
            *value = number.value(number.size::<LONG>(window));
        }
    }

    /// Joins the lines of the record at the start of `text` by one blank, over the `$` between them; gives
    /// where the record then ends.
    #[inline]
    pub(super) fn join(&self, text: &mut [u8]) -> usize {
        let (_, mut end) = self.pieces[0];
        for &(from, to) in &self.pieces[1..self.lines] {
            text[end] = b' ';
            text.copy_within(from..to, end + 1);
            end += 1 + to - from;
        }
        end
    }

    /// Where the record ends that [`RecordLayout::join`] has joined.
    pub(super) fn joined_length(&self) -> usize {
        let pieces = &self.pieces[..self.lines];
        let all: usize = pieces.iter().map(|(from, to)| 1 + to - from).sum();
        all.saturating_sub(1)
    }

    /// Looks for the layout of the record that begins at `start`; true if it has one.
    ///
    /// Where records share no layout it is looked for more and more seldom.
    #[cold]
    #[inline(never)]
    pub(super) fn learn(&mut self, buffer: &[u8], start: usize, end: usize) -> bool {
        let text = &buffer[start..end];
        if window(buffer, start).is_none() || goto(text).is_none() {
            return false;
        }
        self.characters.forget();
        self.pace.learns() && self.find(text).is_some()
    }

    /// Takes over the layout of the record at the start of `text`; none, and the length stays 0, if it is unusual.
    fn find(&mut self, text: &[u8]) -> Option<()> {
        let text = &text[..text.len().min(LONGEST)];
        let mut scan = goto(text)?;
        scan.blanks();
        scan.word(b"/")?;
        self.long = false;
        let mut begin = 0;
        let mut lines = 0;
        for count in 1.. {
            scan.blanks();
            let number = self.numbers.get_mut(count - 1)?;
            self.long |= scan.number(number)?.digits > 8;
            scan.blanks();
            if scan.word(b",").is_none() {
                self.pieces[lines] = (begin, scan.at);
                lines += 1;
                self.count = count;
                break;
            }
            let end = scan.at;
            scan.blanks();
            if scan.word(b"$").is_some() {
                scan.blanks();
                scan.line_end()?;
                self.pieces[lines] = (begin, end);
                lines += 1;
                scan.blanks();
                begin = scan.at;
            }
        }
        scan.line_end()?;
        if self.count != 3 && self.count != 6 {
            return None;
        }
        self.lines = lines;
        self.characters.take(&text[..scan.at], |_| false);
        Some(())
    }
}

/// What follows the word `GOTO`; none if another begins the text.
fn goto(text: &[u8]) -> Option<LayoutScan<'_>> {
    let mut scan = LayoutScan { text, at: 0 };
    scan.blanks();
    scan.word(b"GOTO")?;
    Some(scan)
}
