//! Runs of cuts that write nothing but axis words and feeds.

use post_plugin::{CutLine, CutRun, Feed};

use super::{FEED_STYLE, MotionWriter};

impl MotionWriter {
    /// Number of axis words.
    pub(crate) fn words(&self) -> usize {
        self.places.len()
    }

    /// A cut at such a feed writes nothing but words that change and its number.
    pub(crate) fn carries_on(&self, feed: Feed) -> bool {
        let word = self.feed_word(feed);
        self.has(feed)
            && self.motion.is(self.codes.motion[1])
            && self.feed_mode.is(word)
            && self.pending.is_none()
            && self.length.is_none()
    }

    /// Writes the cuts of a run from the one at `from` on: [`MotionWriter::cut`] of each, where each carries on.
    pub(crate) fn carry_on(&mut self, run: &CutRun<'_>, from: usize, out: &mut String) {
        let (decimals, every_feed) = match run.kind() {
            Feed::PerMinute(_) => (self.decimals.per_minute, false),
            Feed::InverseTime(_) => (self.decimals.inverse_time, true),
            Feed::PerRevolution(_) => (self.decimals.per_revolution, false),
        };
        let head = if self.every_block { self.codes.motion[1] } else { "" };
        let line = CutLine { head, decimals, style: FEED_STYLE, every_feed };
        self.axes.write_cuts(run, from, &line, &mut self.block, &mut self.feed, out);
        self.at.clear();
        self.at.extend(run.end());
    }
}
