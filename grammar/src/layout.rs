//! Text laid out as other text before it: the same characters at the same places, digits aside, so that numbers are read by
//! loads at known places.

use crate::decimal::{POWERS, eight_digits};

/// Most bytes of a text that has a layout, with its line ends.
pub(crate) const LONGEST: usize = 192;

/// Bytes of the buffer that are loaded together with a text, from [`FRONT`] before it.
pub(crate) const WINDOW: usize = 272;

/// Bytes before a text: as many are loaded where its first number has few digits.
const FRONT: usize = 16;

/// Bytes that are compared together.
const BLOCK: usize = 16;

/// Most digits of a number: they and a power of ten are exact as doubles, and their quotient is rounded once.
const MOST_DIGITS: usize = 15;

/// Most texts that are passed by before a layout is looked for again.
const LONGEST_PAUSE: u32 = 64;

/// Characters of a text, and what may differ.
#[derive(Clone, Copy, Debug)]
struct ByteBlock {
    /// Characters as written, digits as `0`.
    characters: [u8; BLOCK],
    /// Largest difference (exclusive or) from the character: 9 of a digit, 0 of any other, 255 after the text.
    leeway: [u8; BLOCK],
}

/// The characters of a text, of which digits may be others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Characters {
    blocks: [ByteBlock; LONGEST / BLOCK],
    /// Bytes of the text, with its last line end; 0 if none is known.
    length: usize,
}

impl Characters {
    /// Of no text.
    pub(crate) const NONE: Self = Self {
        blocks: [ByteBlock { characters: [0; BLOCK], leeway: [0; BLOCK] }; LONGEST / BLOCK],
        length: 0,
    };

    /// Bytes of the text, with its last line end; 0 if none is known.
    #[inline(always)]
    pub(crate) fn length(&self) -> usize {
        self.length
    }

    /// No text is known any more.
    pub(crate) fn forget(&mut self) {
        self.length = 0;
    }

    /// Takes over the characters of a text of up to [`LONGEST`] bytes; where `stands` says so of a place, its digit may be no
    /// other.
    pub(crate) fn take(&mut self, text: &[u8], stands: impl Fn(usize) -> bool) {
        for (number, (block, text)) in self.blocks.iter_mut().zip(text.chunks(BLOCK)).enumerate() {
            *block = ByteBlock { characters: [0; BLOCK], leeway: [u8::MAX; BLOCK] };
            for (place, byte) in text.iter().enumerate() {
                let digit = byte.is_ascii_digit() && !stands(BLOCK * number + place);
                block.characters[place] = if digit { b'0' } else { *byte };
                block.leeway[place] = if digit { 9 } else { 0 };
            }
        }
        self.length = text.len();
    }

    /// Whether the text of a window is laid out so. Without a branch a byte: the compiler makes vectors of it.
    #[inline(always)]
    pub(crate) fn is_of(&self, window: &[u8; WINDOW]) -> bool {
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
}

/// When a layout is looked for: where texts share none, more and more seldom.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LearningPace {
    /// Further texts that were laid out as the one that was looked at last.
    pub(crate) hits: u32,
    /// Texts to pass by before a layout is looked for again.
    pause: u32,
    /// How long to pause after the next layout that no other text has.
    next_pause: u32,
}

impl LearningPace {
    /// The first text is to be learned at once.
    pub(crate) const FIRST: Self = Self { hits: 1, pause: 0, next_pause: 1 };

    /// Whether a layout is to be looked for in the text at hand.
    pub(crate) fn learns(&mut self) -> bool {
        if self.pause > 0 {
            self.pause -= 1;
            if self.pause > 0 {
                return false;
            }
        } else if self.hits == 0 {
            self.pause = self.next_pause;
            self.next_pause = (2 * self.next_pause).min(LONGEST_PAUSE);
            return false;
        } else {
            self.next_pause = 1;
        }
        self.hits = 0;
        true
    }
}

/// Where the digits of a number are.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NumberPlace {
    /// Byte of the window, 17 before the end of the number.
    pub(crate) before: u8,
    /// Bits of the last eight digits: in the eight bytes before the end of the number, and one byte further in front,
    /// where they stand before a point.
    pub(crate) low: [u64; 2],
    /// The same of the eight digits before those.
    pub(crate) high: [u64; 2],
    /// Sign bit of a double.
    pub(crate) sign: u64,
    /// Ten to the count of decimals.
    pub(crate) power: f64,
}

impl NumberPlace {
    /// The digits of the number in a text, as one whole number; `LONG` if there may be more than eight.
    #[inline(always)]
    pub(crate) fn size<const LONG: bool>(&self, window: &[u8; WINDOW]) -> f64 {
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
    pub(crate) fn sizes<const LONG: bool>(&self, windows: &[&[u8; WINDOW]], sizes: &mut [f64]) {
        let number = *self;
        for (size, window) in sizes.iter_mut().zip(windows) {
            *size = number.size::<LONG>(window);
        }
    }

    /// The number that has these digits.
    #[inline(always)]
    pub(crate) fn value(&self, size: f64) -> f64 {
        f64::from_bits((size / self.power).to_bits() | self.sign)
    }
}

/// What is loaded together with the text that begins at `start`; none too close to an end of the buffer.
#[inline(always)]
pub(crate) fn window(buffer: &[u8], start: usize) -> Option<&[u8; WINDOW]> {
    buffer.get(start.checked_sub(FRONT)?..)?.first_chunk()
}

#[inline(always)]
fn eight_bytes(window: &[u8; WINDOW], at: usize) -> u64 {
    u64::from_le_bytes(window[at..at + 8].try_into().expect("eight bytes"))
}

/// A text, and how far it was looked at.
pub(crate) struct LayoutScan<'a> {
    pub(crate) text: &'a [u8],
    pub(crate) at: usize,
}

/// How a number is written.
pub(crate) struct WrittenNumber {
    pub(crate) digits: usize,
    /// Whether a decimal point is written.
    pub(crate) point: bool,
}

impl LayoutScan<'_> {
    pub(crate) fn is(&self, byte: u8) -> bool {
        self.text.get(self.at) == Some(&byte)
    }

    pub(crate) fn is_digit(&self) -> bool {
        self.text.get(self.at).is_some_and(u8::is_ascii_digit)
    }

    pub(crate) fn blanks(&mut self) {
        while self.is(b' ') || self.is(b'\t') {
            self.at += 1;
        }
    }

    pub(crate) fn word(&mut self, word: &[u8]) -> Option<()> {
        let found = self.text[self.at..].starts_with(word);
        found.then(|| self.at += word.len())
    }

    pub(crate) fn line_end(&mut self) -> Option<()> {
        let before = usize::from(self.is(b'\r'));
        let ends = self.text.get(self.at + before) == Some(&b'\n');
        ends.then(|| self.at += before + 1)
    }

    /// Count of the digits here, which are passed.
    fn digits(&mut self) -> usize {
        let begin = self.at;
        while self.text.get(self.at).is_some_and(u8::is_ascii_digit) {
            self.at += 1;
        }
        self.at - begin
    }

    /// Takes over where the number here has its digits; gives how it is written. None if there is no number, or if it has
    /// too many digits.
    pub(crate) fn number(&mut self, place: &mut NumberPlace) -> Option<WrittenNumber> {
        let negative = self.is(b'-');
        self.at += usize::from(negative);
        let mut digits = self.digits();
        let mut decimals = 0;
        // Digits at the end of the number, with no point after them.
        let mut last = digits;
        let point = self.is(b'.');
        if point {
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
        Some(WrittenNumber { digits, point })
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
