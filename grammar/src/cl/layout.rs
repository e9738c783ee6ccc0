//! `GOTO` records laid out as the one before, by loads at known places.
//!
//! A CAM system writes the same decimals and the same blanks in nearly every record, so that digits stand where the
//! record before has them. Such a layout is found once. A record with the same characters at the same places, digits
//! aside, is then taken without a search, a loop over digits, or a branch that depends on a number: bit for bit
//! what the scanner gives.

use crate::decimal::{POWERS, eight_digits};

/// Most bytes of a record that has a layout, with its line ends.
const LONGEST: usize = 192;

/// Bytes of the buffer that are loaded together with a record, from [`FRONT`] before it.
const WINDOW: usize = 272;

/// Bytes before a record: as many are loaded where its first number has few digits.
const FRONT: usize = 16;

/// Bytes that are compared together.
const BLOCK: usize = 16;

/// Most digits of a number: they and a power of ten are exact as doubles, and their quotient is rounded once.
const MOST_DIGITS: usize = 15;

/// Most records that are passed by before a layout is looked for again.
const LONGEST_PAUSE: u32 = 64;

/// Characters of a record, and what may differ.
#[derive(Clone, Copy, Debug)]
struct ByteBlock {
    /// Characters as written, digits as `0`.
    characters: [u8; BLOCK],
    /// Largest difference (exclusive or) from the character: 9 of a digit, 0 of any other, 255 after the record.
    leeway: [u8; BLOCK],
}

/// Where the digits of a number are.
#[derive(Clone, Copy, Debug, Default)]
struct NumberPlace {
    /// Byte of the window, 17 before the end of the number.
    before: u8,
    /// Bits of the last eight digits: in the eight bytes before the end of the number, and one byte further in front,
    /// where they stand before a point.
    low: [u64; 2],
    /// The same of the eight digits before those.
    high: [u64; 2],
    /// Sign bit of a double.
    sign: u64,
    /// Ten to the count of decimals.
    power: f64,
}

impl NumberPlace {
    /// The digits of the number in a record, as one whole number; `LONG` if there may be more than eight.
    #[inline(always)]
    fn size<const LONG: bool>(&self, window: &[u8; WINDOW]) -> f64 {
        let before = usize::from(self.before);
        let low = (eight_bytes(window, before + 9) & self.low[0])
            | (eight_bytes(window, before + 8) & self.low[1]);
        let mut digits = eight_digits(low);
        if LONG {
            let high = (eight_bytes(window, before + 1) & self.high[0])
                | (eight_bytes(window, before) & self.high[1]);
            digits += 100_000_000 * eight_digits(high);
        }
        digits as i64 as f64
    }

    /// [`NumberPlace::size`] in many records.
    #[inline(always)]
    fn sizes<const LONG: bool>(&self, windows: &[&[u8; WINDOW]], sizes: &mut [f64]) {
        let number = *self;
        for (size, window) in sizes.iter_mut().zip(windows) {
            *size = number.size::<LONG>(window);
        }
    }

    /// The number that has these digits.
    #[inline(always)]
    fn value(&self, size: f64) -> f64 {
        f64::from_bits((size / self.power).to_bits() | self.sign)
    }
}

/// How the last `GOTO` record was laid out.
#[derive(Clone, Debug)]
pub(super) struct RecordLayout {
    blocks: [ByteBlock; LONGEST / BLOCK],
    numbers: [NumberPlace; 6],
    /// Numbers, 3 or 6; the last three are the tool axis.
    count: usize,
    /// Some number has more than eight digits.
    long: bool,
    /// Bytes, with the last line end; 0 if no layout is known.
    length: usize,
    /// Lines of the file.
    lines: usize,
    /// Where the text of each line begins and ends, blanks and `$` at the ends of a continued line aside.
    pieces: [(usize, usize); 6],
    /// Further records that were laid out so.
    hits: u32,
    /// Records to pass by before a layout is looked for again.
    pause: u32,
    /// How long to pause after the next layout that no other record has.
    next_pause: u32,
}

impl RecordLayout {
    /// No layout is known yet.
    pub(super) fn new() -> Self {
        Self {
            blocks: [ByteBlock { characters: [0; BLOCK], leeway: [0; BLOCK] }; LONGEST / BLOCK],
            numbers: [NumberPlace::default(); 6],
            count: 0,
            long: false,
            length: 0,
            lines: 0,
            pieces: [(0, 0); 6],
            // The first record is to be learned at once.
            hits: 1,
            pause: 0,
            next_pause: 1,
        }
    }

    /// Bytes of the record, with its line ends.
    pub(super) fn length(&self) -> usize {
        self.length
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
        self.hits = self.hits.saturating_add(1);
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
        let Some(first) = window(buffer, start).filter(|_| self.length > 0) else {
            return 0;
        };
        let mut windows = [first; MOST];
        let (mut count, mut at) = (0, start);
        while count < MOST
            && at + self.length <= end
            && let Some(window) = window(buffer, at)
            && self.is_of(window)
        {
            windows[count] = window;
            count += 1;
            at += self.length;
        }
        let windows = &windows[..count];
        self.hits = self.hits.saturating_add(count as u32);
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
        self.length > 0
            && start + self.length <= end
            && window(buffer, start).is_some_and(|window| self.is_of(window))
    }

    /// Whether the record is laid out so. Without a branch a byte: the compiler makes vectors of it.
    #[inline(always)]
    fn is_of(&self, window: &[u8; WINDOW]) -> bool {
        let (text, _) = window[FRONT..].as_chunks::<BLOCK>();
        let blocks = &self.blocks[..self.length.div_ceil(BLOCK).min(LONGEST / BLOCK)];
        let mut differs = [0; BLOCK];
        for (block, text) in blocks.iter().zip(text) {
            for place in 0..BLOCK {
                let difference = text[place] ^ block.characters[place];
                differs[place] |= difference.saturating_sub(block.leeway[place]);
            }
        }
        differs == [0; BLOCK]
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
        if window(buffer, start).is_none() || Scan::goto(text).is_none() {
            return false;
        }
        if self.pause > 0 {
            self.pause -= 1;
            if self.pause > 0 {
                return false;
            }
        } else if self.hits == 0 {
            self.pause = self.next_pause;
            self.next_pause = (2 * self.next_pause).min(LONGEST_PAUSE);
            self.length = 0;
            return false;
        } else {
            self.next_pause = 1;
        }
        self.hits = 0;
        self.length = 0;
        self.find(text).is_some()
    }

    /// Takes over the layout of the record at the start of `text`; none, and the length stays 0, if it is unusual.
    fn find(&mut self, text: &[u8]) -> Option<()> {
        let text = &text[..text.len().min(LONGEST)];
        let mut scan = Scan::goto(text)?;
        scan.blanks();
        scan.word(b"/")?;
        self.long = false;
        let mut begin = 0;
        let mut lines = 0;
        for count in 1.. {
            scan.blanks();
            let number = self.numbers.get_mut(count - 1)?;
            self.long |= scan.number(number)? > 8;
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
        self.take_characters(&text[..scan.at]);
        Some(())
    }

    /// Takes over the characters of a record.
    fn take_characters(&mut self, record: &[u8]) {
        for (block, text) in self.blocks.iter_mut().zip(record.chunks(BLOCK)) {
            *block = ByteBlock { characters: [0; BLOCK], leeway: [u8::MAX; BLOCK] };
            for (place, byte) in text.iter().enumerate() {
                let digit = byte.is_ascii_digit();
                block.characters[place] = if digit { b'0' } else { *byte };
                block.leeway[place] = if digit { 9 } else { 0 };
            }
        }
        self.length = record.len();
    }
}

/// What is loaded together with the record that begins at `start`; none too close to an end of the buffer.
#[inline(always)]
fn window(buffer: &[u8], start: usize) -> Option<&[u8; WINDOW]> {
    buffer.get(start.checked_sub(FRONT)?..)?.first_chunk()
}

#[inline(always)]
fn eight_bytes(window: &[u8; WINDOW], at: usize) -> u64 {
    u64::from_le_bytes(window[at..at + 8].try_into().expect("eight bytes"))
}

/// The text of a record, and how far it was looked at.
struct Scan<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Scan<'a> {
    /// After the word `GOTO`; none if another begins the text.
    fn goto(text: &'a [u8]) -> Option<Self> {
        let mut scan = Self { text, at: 0 };
        scan.blanks();
        scan.word(b"GOTO")?;
        Some(scan)
    }

    fn is(&self, byte: u8) -> bool {
        self.text.get(self.at) == Some(&byte)
    }

    fn blanks(&mut self) {
        while self.is(b' ') || self.is(b'\t') {
            self.at += 1;
        }
    }

    fn word(&mut self, word: &[u8]) -> Option<()> {
        let found = self.text[self.at..].starts_with(word);
        found.then(|| self.at += word.len())
    }

    fn line_end(&mut self) -> Option<()> {
        self.at += usize::from(self.is(b'\r'));
        self.word(b"\n")
    }

    /// Count of the digits here, which are passed.
    fn digits(&mut self) -> usize {
        let begin = self.at;
        while self.text.get(self.at).is_some_and(u8::is_ascii_digit) {
            self.at += 1;
        }
        self.at - begin
    }

    /// Takes over where the number here has its digits; gives their count. None if there is no number, or if it has
    /// too many.
    fn number(&mut self, place: &mut NumberPlace) -> Option<usize> {
        let negative = self.is(b'-');
        self.at += usize::from(negative);
        let mut digits = self.digits();
        let mut decimals = 0;
        // Digits at the end of the number, with no point after them.
        let mut last = digits;
        if self.is(b'.') {
            self.at += 1;
            decimals = self.digits();
            digits += decimals;
            last = decimals;
        }
        if digits == 0 || digits > MOST_DIGITS {
            return None;
        }
        *place = NumberPlace {
            before: u8::try_from(FRONT + self.at - 17).ok()?,
            low: digit_bits(digits, last),
            high: digit_bits(digits.saturating_sub(8), last.saturating_sub(8)),
            sign: u64::from(negative) << 63,
            power: POWERS[decimals],
        };
        Some(digits)
    }
}

/// Bits of the last eight of so many digits: of those at the end of the number, and of those before its point.
fn digit_bits(digits: usize, last: usize) -> [u64; 2] {
    const DIGITS: u64 = 0x0F0F_0F0F_0F0F_0F0F;
    // Of the last bytes of eight, which a little-endian load has in the highest bits.
    let end = |bytes: usize| match bytes {
        0 => 0,
        1..8 => u64::MAX << (64 - 8 * bytes),
        _ => u64::MAX,
    };
    let all = end(digits) & DIGITS;
    [all & end(last), all & !end(last)]
}
