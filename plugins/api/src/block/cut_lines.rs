//! The lines of a run of cuts, each word straight to where it stays.

#![allow(unsafe_code)]

use super::{Axes, AxisState, Block, Modal, NumberStyle};
use crate::CutRun;
use crate::number::{Front, NumberForm, SHORT_WORD, ShortDecimal, short_counts};

/// What stands in the lines of a run beside the axis words.
#[derive(Clone, Copy, Debug)]
pub struct CutLine {
    /// In front of the axis words, ASCII of at most seven letters: `L`; empty for none.
    pub head: &'static str,
    /// Decimals of F.
    pub decimals: u8,
    /// How it looks.
    pub style: NumberStyle,
    /// F stands in every line, else where it changes.
    pub every_feed: bool,
}

/// An axis word of the lines of a run.
#[derive(Clone, Copy, Debug)]
struct CutWord {
    /// What stands in front of the digits of a number that is not negative, and of one that is.
    fronts: [Front; 2],
    places: usize,
    /// The value in force; not a number where none is known.
    last: f64,
}

impl CutWord {
    const NONE: Self = Self { fronts: [Front::NONE; 2], places: 0, last: f64::NAN };

    /// The word of an axis; none if it is more than a short letter and a number.
    fn of(axis: &AxisState, style: NumberStyle) -> Option<Self> {
        let front = axis.front.filter(|_| axis.modulo.is_none() && axis.behind.is_empty())?;
        let plus = if style.plus { front.and(b'+')? } else { front };
        let fronts = [plus, front.and(b'-')?];
        let last = axis.last.0.unwrap_or(f64::NAN);
        Some(Self { fronts, places: usize::from(axis.decimals), last })
    }

    /// Writes the word for `value`, of which `count` is the units of the last decimal; its length, none if it has not
    /// changed.
    ///
    /// # Safety
    /// There must be room for [`SHORT_WORD`] bytes at `to`.
    #[inline(always)]
    unsafe fn put(
        &mut self,
        to: *mut u8,
        bare: bool,
        value: f64,
        count: u32,
        look: NumberForm,
    ) -> usize {
        if value == self.last {
            return 0;
        }
        self.last = value;
        let Some(short) = ShortDecimal::new(count, self.places) else {
            return 0;
        };
        let front = self.fronts[usize::from((value < 0.0) & (count != 0))];
        let front = if bare { front.bare() } else { front };
        // SAFETY: the caller's promise.
        unsafe { look.put_short(to, front, 0, 0, short) }
    }
}

/// The text of a feed that stands in line after line.
#[derive(Debug)]
struct FeedText {
    value: f64,
    text: String,
}

impl FeedText {
    /// Appends the word of a feed.
    #[inline(always)]
    fn append(&mut self, value: f64, line: &CutLine, out: &mut String) {
        if value != self.value {
            self.value = value;
            self.text.clear();
            self.text.push_str(" F");
            line.style.write(&mut self.text, value, line.decimals);
        }
        out.push_str(&self.text);
    }
}

impl Axes {
    /// Most words of a line.
    const MOST: usize = 12;

    /// Gets ready to write the lines of `run` by [`Axes::write_cuts`]; false if a word of it is more than a letter and a
    /// number below 1,000 with three or four decimals.
    pub fn takes_cuts(&mut self, run: &CutRun<'_>) -> bool {
        let Self { axes, counts, style } = self;
        counts.clear();
        axes.len() == run.columns().len()
            && axes.len() <= Self::MOST
            && axes.iter().zip(run.columns()).all(|(axis, column)| {
                CutWord::of(axis, *style).is_some() && short_counts(column, axis.decimals, counts)
            })
    }

    /// Appends the lines of the cuts of `run` from the one at `from` on: of each the words that have changed, and the
    /// feed; no line for a cut that changes no word. [`Axes::takes_cuts`] has been asked of this run, and the block
    /// under construction is empty.
    pub fn write_cuts(
        &mut self,
        run: &CutRun<'_>,
        from: usize,
        line: &CutLine,
        block: &mut Block,
        feed: &mut Modal<f64>,
        out: &mut String,
    ) {
        let mut words = [CutWord::NONE; Self::MOST];
        for (word, axis) in words.iter_mut().zip(&self.axes) {
            *word = CutWord::of(axis, self.style).unwrap_or(CutWord::NONE);
        }
        let words = &mut words[..self.axes.len().min(Self::MOST)];
        let mut text = FeedText { value: f64::NAN, text: String::new() };
        for place in from..run.len() {
            let (start, number) = (out.len(), block.number);
            block.begin(out);
            out.push_str(line.head);
            let bare = line.head.is_empty();
            let written = match self.style.trim {
                true => self.write_cut::<true>(words, run, place, bare, out),
                false => self.write_cut::<false>(words, run, place, bare, out),
            };
            if !written {
                out.truncate(start);
                block.number = number;
                continue;
            }
            let value = run.feeds()[place];
            if feed.set(value) || line.every_feed {
                text.append(value, line, out);
            }
            out.push('\n');
        }
        for (word, axis) in words.iter().zip(&mut self.axes) {
            axis.last.set(word.last);
        }
    }

    /// Appends the words of a cut that have changed, the first without its blank if it is `bare`; false for none.
    #[inline(always)]
    fn write_cut<const TRIM: bool>(
        &self,
        words: &mut [CutWord],
        run: &CutRun<'_>,
        place: usize,
        mut bare: bool,
        out: &mut String,
    ) -> bool {
        out.reserve(Self::MOST * SHORT_WORD);
        // A number with decimals has a point anyway, and the sign is part of what stands in front.
        let look = NumberForm { trim: TRIM, point: TRIM && self.style.point, plus: false };
        let (values, counts) = (run.words(), self.counts.as_slice());
        // SAFETY: what is appended is ASCII, and there is room for all words.
        unsafe {
            let bytes = out.as_mut_vec();
            let start = bytes.len();
            let first = bytes.as_mut_ptr().add(start);
            let mut to = first;
            for (word, index) in words.iter_mut().zip((place..).step_by(run.len())) {
                let length = word.put(to, bare, values[index], counts[index], look);
                bare &= length == 0;
                to = to.add(length);
            }
            let length = to.offset_from_unsigned(first);
            bytes.set_len(start + length);
            length > 0
        }
    }
}
