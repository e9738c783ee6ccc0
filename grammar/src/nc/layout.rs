//! Blocks of words laid out as others before them, by loads at known places.
//!
//! A program writes its words in few forms, which differ in signs, in how many digits stand before the point, and in what is
//! left out because it stays. A few of these layouts are kept. A block with the same characters at the same places, digits
//! aside, is then taken without a search, a loop over digits, or a branch that depends on a number: bit for bit what the
//! scanner gives.

use super::run::{NcRun, NcRunRule};
use crate::layout::{
    Characters, LONGEST, LayoutScan, LearningPace, NumberPlace, WINDOW, WrittenNumber, window,
};

/// Layouts that are kept.
const KEPT: usize = 4;

/// Most words of a block that has a layout, its number and its G code aside.
const MOST_WORDS: usize = 10;

/// A word, and where its digits are.
#[derive(Clone, Copy, Debug, Default)]
struct WordPlace {
    /// The letter, counted from A.
    letter: u8,
    number: NumberPlace,
}

/// How a block was laid out.
#[derive(Clone, Copy, Debug)]
struct BlockLayout {
    characters: Characters,
    /// Where the digits of its number are, if it has one.
    number: Option<NumberPlace>,
    words: [WordPlace; MOST_WORDS],
    count: usize,
    /// Bits of the letters of its words, G aside.
    letters: u32,
    /// Bits of those whose number has no decimal point.
    pointless: u32,
    /// The number of its G code, if it has one: it is part of the layout.
    code: Option<f64>,
    /// Some number has more than eight digits.
    long: bool,
}

impl BlockLayout {
    const NONE: Self = Self {
        characters: Characters::NONE,
        number: None,
        words: [WordPlace {
            letter: 0,
            number: NumberPlace { before: 0, low: [0; 2], high: [0; 2], sign: 0, power: 1.0 },
        }; MOST_WORDS],
        count: 0,
        letters: 0,
        pointless: 0,
        code: None,
        long: false,
    };

    /// Whether the block of a window is laid out so; what is `left` bytes on and after it is not read yet.
    #[inline(always)]
    fn is_of(&self, window: &[u8; WINDOW], left: usize) -> bool {
        let length = self.characters.length();
        length > 0 && length <= left && self.characters.is_of(window)
    }

    /// Puts the words of a block of this layout into a place of `run`.
    #[inline(always)]
    fn put(&self, window: &[u8; WINDOW], place: usize, run: &mut NcRun) {
        match self.long {
            true => self.put_words::<true>(window, place, run),
            false => self.put_words::<false>(window, place, run),
        }
        run.said[place] = self.letters;
        run.numbers[place] = self.number.map(|number| number.size::<true>(window) as u64);
    }

    #[inline(always)]
    fn put_words<const LONG: bool>(&self, window: &[u8; WINDOW], place: usize, run: &mut NcRun) {
        for word in &self.words[..self.count.min(MOST_WORDS)] {
            let size = word.number.size::<LONG>(window);
            run.columns[usize::from(word.letter) % NcRun::LETTERS][place] = word.number.value(size);
        }
    }

    /// The layout of the block at the start of `text`; none if it is anything but plain words with numbers, each of another
    /// letter.
    fn find(text: &[u8]) -> Option<Self> {
        let mut layout = Self::NONE;
        let mut scan = LayoutScan { text: &text[..text.len().min(LONGEST)], at: 0 };
        scan.blanks();
        if scan.word(b"N").is_some() {
            let mut number = NumberPlace::default();
            // A sign is no part of it.
            if !scan.is_digit() || scan.number(&mut number)?.point {
                return None;
            }
            layout.number = Some(number);
            scan.blanks();
        }
        let mut code = 0..0;
        while scan.line_end().is_none() {
            let letter = *scan.text.get(scan.at)?;
            scan.at += 1;
            match letter {
                b'G' if layout.code.is_none() => {
                    let begin = scan.at;
                    if !scan.is_digit() {
                        return None;
                    }
                    scan.number(&mut NumberPlace::default())?;
                    code = begin..scan.at;
                    let written = std::str::from_utf8(&scan.text[code.clone()]).ok()?;
                    layout.code = Some(written.parse().ok()?);
                }
                b'G' | b'M' | b'N' | b'O' => return None,
                b'A'..=b'Z' => layout.word(letter, &mut scan)?,
                _ => return None,
            }
            let next = *scan.text.get(scan.at)?;
            if !next.is_ascii_uppercase() && !matches!(next, b' ' | b'\t' | b'\r' | b'\n') {
                return None;
            }
            scan.blanks();
        }
        if layout.count == 0 {
            return None;
        }
        let length = scan.at;
        layout.characters.take(&text[..length], |place| code.contains(&place));
        Some(layout)
    }

    /// Takes over a word, behind its letter.
    fn word(&mut self, letter: u8, scan: &mut LayoutScan<'_>) -> Option<()> {
        let word = self.words.get_mut(self.count)?;
        word.letter = letter - b'A';
        // A `+` says nothing; what follows it has no sign.
        if scan.word(b"+").is_some() && scan.is(b'-') {
            return None;
        }
        let WrittenNumber { digits, point } = scan.number(&mut word.number)?;
        self.count += 1;
        self.long |= digits > 8;
        let bit = 1 << word.letter;
        if self.letters & bit != 0 {
            return None;
        }
        self.letters |= bit;
        if !point {
            self.pointless |= bit;
        }
        Some(())
    }
}

/// The layouts of blocks before.
#[derive(Clone, Debug)]
pub(super) struct BlockLayouts {
    kept: [BlockLayout; KEPT],
    /// Their places, that of the last block first.
    order: [u8; KEPT],
    pace: LearningPace,
}

impl BlockLayouts {
    /// None is known yet.
    pub(super) fn new() -> Self {
        Self {
            kept: [BlockLayout::NONE; KEPT],
            order: std::array::from_fn(|place| place as u8),
            pace: LearningPace::FIRST,
        }
    }

    /// Takes the blocks from `start` on that are laid out as others before them and keep to `rule`, up to `end` and as many
    /// as the run holds. Where the one behind them has another layout, that is looked for.
    pub(super) fn take(
        &mut self,
        buffer: &[u8],
        [start, end]: [usize; 2],
        rule: &NcRunRule,
        run: &mut NcRun,
    ) {
        run.count = 0;
        let mut at = start;
        while run.count < NcRun::MOST
            && let Some(window) = window(buffer, at)
        {
            let Some(layout) = self.layout_of(window, end - at) else {
                if !self.learn(&buffer[at..end]) {
                    break;
                }
                continue;
            };
            if !rule.takes(layout.letters, layout.pointless, layout.code) {
                break;
            }
            layout.put(window, run.count, run);
            at += layout.characters.length();
            run.ends[run.count] = at - start;
            run.count += 1;
        }
        self.pace.hits = self.pace.hits.saturating_add(run.count as u32);
    }

    /// The layout of the block of a window, which is then the first that is asked.
    #[inline(always)]
    fn layout_of(&mut self, window: &[u8; WINDOW], left: usize) -> Option<&BlockLayout> {
        let is_of = |place: &u8| self.kept[usize::from(*place) % KEPT].is_of(window, left);
        let found = self.order.iter().position(is_of)?;
        if found > 0 {
            self.order[..=found].rotate_right(1);
        }
        Some(&self.kept[usize::from(self.order[0]) % KEPT])
    }

    /// Looks for the layout of the block at the start of `text`, in place of that which was used longest ago; true if it has
    /// one.
    #[cold]
    #[inline(never)]
    fn learn(&mut self, text: &[u8]) -> bool {
        if !self.pace.learns() {
            return false;
        }
        let Some(layout) = BlockLayout::find(text) else {
            return false;
        };
        self.order.rotate_right(1);
        self.kept[usize::from(self.order[0]) % KEPT] = layout;
        true
    }
}
