//! The lines of a run of cuts, each word straight to where it stays.

#![allow(unsafe_code)]

use super::{Axes, AxisState, Block, Modal, NumberStyle};
use crate::CutRun;
use crate::number::{Front, SHORT_WORD, ShortDecimal, short_counts};

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

impl AxisState {
    /// The word of the cut at a place, at `to`; its length, none if it has not changed.
    ///
    /// # Safety
    /// There must be room for [`SHORT_WORD`] bytes.
    #[inline(always)]
    unsafe fn put(
        &mut self,
        to: *mut u8,
        first: bool,
        value: f64,
        place: usize,
        style: NumberStyle,
    ) -> usize {
        if !self.last.set(value) {
            return 0;
        }
        let count = self.counts.get(place).copied().unwrap_or_default();
        let Some((front, short)) =
            self.front.zip(ShortDecimal::new(count.into(), usize::from(self.decimals)))
        else {
            return 0;
        };
        let front = if first { front.bare() } else { front };
        let negative = value < 0.0 && count != 0;
        let sign = if negative { b'-' } else { b'+' };
        let signed = usize::from(negative | style.plus);
        // SAFETY: the caller's promise.
        unsafe { style.look().put_short(to, front, signed, sign, short) }
    }
}

impl Axes {
    /// Gets ready to write the lines of `run` by [`Axes::write_cuts`]; false if a word of it is more than a letter and a
    /// number below 1,000 with three or four decimals.
    pub fn takes_cuts(&mut self, run: &CutRun<'_>) -> bool {
        let plain = |axis: &AxisState| {
            axis.front.is_some() && axis.modulo.is_none() && axis.behind.is_empty()
        };
        self.axes.len() == run.columns().len()
            && self.axes.iter().all(plain)
            && self
                .axes
                .iter_mut()
                .zip(run.columns())
                .all(|(axis, column)| short_counts(column, axis.decimals, &mut axis.counts))
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
        let look = line.style.look();
        let letter = Front::blank("F").unwrap_or(Front::NONE);
        for place in from..run.len() {
            let (start, number) = (out.len(), block.number);
            block.begin(out);
            out.push_str(line.head);
            if !self.write_cut(run, place, line.head.is_empty(), out) {
                out.truncate(start);
                block.number = number;
                continue;
            }
            let value = run.feeds()[place];
            if (feed.set(value) || line.every_feed)
                && !look.append(out, letter, value, line.decimals)
            {
                out.push_str(" F");
                line.style.write(out, value, line.decimals);
            }
            out.push('\n');
        }
    }

    /// Appends the words of a cut that have changed, the first without its blank if it is `bare`; false for none.
    #[inline(always)]
    fn write_cut(
        &mut self,
        run: &CutRun<'_>,
        place: usize,
        mut bare: bool,
        out: &mut String,
    ) -> bool {
        out.reserve(self.axes.len() * SHORT_WORD);
        let style = self.style;
        // SAFETY: what is appended is ASCII, and there is room for all words.
        unsafe {
            let bytes = out.as_mut_vec();
            let start = bytes.len();
            let to = bytes.as_mut_ptr().add(start);
            let mut length = 0;
            for (axis, column) in self.axes.iter_mut().zip(run.columns()) {
                length += axis.put(to.add(length), bare, column[place], place, style);
                bare &= length == 0;
            }
            bytes.set_len(start + length);
            length > 0
        }
    }
}
