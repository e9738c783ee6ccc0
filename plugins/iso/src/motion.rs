//! Moves in G-code.
//!
//! Rapids, cuts, the three feed modes, compensation and the way a tool comes to the part. A word that is in force is
//! not written again, and a move that changes no word is not written at all.

use post_plugin::{Axes, Block, Compensation, Feed, Format, Group, Modal, NumberStyle};

use crate::lines::takes_number;
use crate::table::Codes;

/// The moving part of a G-code dialect.
#[derive(Clone, Debug)]
pub struct Motion {
    codes: &'static Codes,
    /// The block under construction.
    pub block: Block,
    /// The axis words.
    pub axes: Axes,
    decimals: FeedDecimals,
    motion: Modal<&'static str>,
    feed_mode: Modal<&'static str>,
    feed: Modal<f64>,
    pending: Option<Compensation>,
}

/// Decimals of the three kinds of feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FeedDecimals {
    /// Of a feed a minute.
    pub per_minute: u8,
    /// Of an inverse-time feed.
    pub inverse_time: u8,
    /// Of a feed a revolution.
    pub per_revolution: u8,
}

/// A feed has a point but no zeros behind it: `F850.`
const FEED_STYLE: NumberStyle = NumberStyle {
    plus: false,
    point: true,
    trim: true,
};

impl Motion {
    /// Nothing is known to be in force.
    pub fn new(codes: &'static Codes, block: Block, axes: Axes, decimals: FeedDecimals) -> Self {
        Motion {
            codes,
            block,
            axes,
            decimals,
            motion: Modal::default(),
            feed_mode: Modal::default(),
            feed: Modal::default(),
            pending: None,
        }
    }

    /// The format that goes with it.
    pub fn format(&self, extension: &str) -> Format {
        Format {
            words: self.axes.decimals(),
            feed: self.decimals.per_minute,
            inverse_time: (!self.codes.feed[1].is_empty()).then_some(self.decimals.inverse_time),
            feed_per_revolution: self.decimals.per_revolution,
            extension: extension.to_owned(),
            ..Format::default()
        }
    }

    /// Nothing is known to be in force any more (a line of the user's own was written).
    pub fn forget(&mut self) {
        self.motion.forget();
        self.feed_mode.forget();
        self.feed.forget();
        self.axes.forget();
    }

    /// A line of the dialect's own has put the feed a minute in force.
    pub fn feeds_per_minute(&mut self) {
        self.feed_mode.set(self.codes.feed[0]);
    }

    /// A block of its own, or one for each line; none for no words. A remark, or a line that is numbered already, is
    /// written as it is.
    pub fn line(&mut self, words: &str, out: &mut String) {
        for line in words.lines().filter(|line| !line.is_empty()) {
            if takes_number(line) {
                self.block.line(line, out);
            } else {
                out.push_str(line);
                out.push('\n');
            }
        }
    }

    /// Does the control have a word for this kind of feed?
    #[inline]
    pub fn has(&self, feed: Feed) -> bool {
        !self.feed_word(feed).is_empty()
    }

    #[inline]
    fn feed_word(&self, feed: Feed) -> &'static str {
        let [per_minute, inverse_time, per_revolution] = self.codes.feed;
        match feed {
            Feed::PerMinute(_) => per_minute,
            Feed::InverseTime(_) => inverse_time,
            Feed::PerRevolution(_) => per_revolution,
        }
    }

    /// Cutter compensation, to be written with the next move.
    pub fn compensate(&mut self, compensation: Compensation) {
        self.pending = Some(compensation);
    }

    /// Cutter compensation that waits for a move which does not come is written in a block of its own.
    pub fn settle(&mut self, out: &mut String) {
        self.write_pending();
        self.block.end(out);
    }

    /// A rapid.
    pub fn rapid(&mut self, words: &[f64], out: &mut String) {
        if self.axes.moved(words) {
            self.motion(self.codes.motion[0]);
            self.write_pending();
            self.axes.write(&mut self.block, words);
            self.block.end(out);
        }
    }

    /// A cut.
    pub fn cut(&mut self, words: &[f64], feed: Feed, out: &mut String) {
        if self.axes.moved(words) {
            self.feed_mode(feed);
            self.motion(self.codes.motion[1]);
            self.write_pending();
            self.axes.write(&mut self.block, words);
            self.feed(feed);
            self.block.end(out);
        }
    }

    /// What is left of the way to `words`, with `length` (`G43 H1`), at `feed` or at rapid.
    pub fn arrive(&mut self, words: &[f64], feed: Option<Feed>, length: &str, out: &mut String) {
        if let Some(feed) = feed {
            self.feed_mode(feed);
        }
        self.motion(self.codes.motion[usize::from(feed.is_some())]);
        if !length.is_empty() {
            self.block.word(length);
        }
        self.axes.write(&mut self.block, words);
        if let Some(feed) = feed {
            self.feed(feed);
        }
        self.block.end(out);
    }

    /// Axes at rapid to positions in machine coordinates; `front` is what says so (`G53 G0`).
    pub fn machine(&mut self, front: &str, axes: u32, words: &[f64], out: &mut String) {
        if axes != 0 {
            self.block.word(front);
            self.axes.write_machine(&mut self.block, axes, words);
            self.block.end(out);
            self.motion.forget();
        }
    }

    /// The rotary axes alone, at rapid.
    pub fn turn(&mut self, words: &[f64], out: &mut String) {
        self.rapid_group(words, Group::Rotary, out);
    }

    /// The linear axes but the depth, at rapid.
    pub fn plane(&mut self, words: &[f64], out: &mut String) {
        self.rapid_group(words, Group::Plane, out);
    }

    /// A line of the dialect's own has moved the axes, with a motion word of its own.
    pub fn moved_by_line(&mut self) {
        self.motion.forget();
        self.axes.forget();
    }

    /// Feed and its mode are not known any more.
    pub fn forget_feed(&mut self) {
        self.feed_mode.forget();
        self.feed.forget();
    }

    fn rapid_group(&mut self, words: &[f64], group: Group, out: &mut String) {
        if self.axes.moved_group(words, group) {
            self.motion(self.codes.motion[0]);
            self.axes.write_group(&mut self.block, words, group);
            self.block.end(out);
        }
    }

    /// Adds the word of a kind of motion, unless it is in force.
    pub fn motion(&mut self, word: &'static str) {
        if self.motion.set(word) {
            self.block.word(word);
        }
    }

    /// Adds the word of the feed's kind, unless it is in force.
    pub fn feed_mode(&mut self, feed: Feed) {
        let word = self.feed_word(feed);
        if self.feed_mode.set(word) {
            self.block.word(word);
            self.feed.forget();
        }
    }

    /// Adds the feed's number, unless it is in force. Its kind comes before it.
    pub fn feed(&mut self, feed: Feed) {
        let (value, decimals) = match feed {
            Feed::PerMinute(value) => (value, self.decimals.per_minute),
            Feed::InverseTime(value) => (value, self.decimals.inverse_time),
            Feed::PerRevolution(value) => (value, self.decimals.per_revolution),
        };
        // Under inverse time every block needs its own.
        if self.feed.set(value) || matches!(feed, Feed::InverseTime(_)) {
            self.block.number("F", value, decimals, FEED_STYLE);
        }
    }

    /// Adds cutter compensation that waits for a move.
    pub fn write_pending(&mut self) {
        let [off, left, right] = self.codes.compensation;
        let (word, register) = match self.pending.take() {
            None => return,
            Some(Compensation::Off) => (off, None),
            Some(Compensation::Left { register }) => (left, Some(register)),
            Some(Compensation::Right { register }) => (right, Some(register)),
        };
        self.block.word(word);
        // Without an address the control knows the radius by itself.
        if let Some(register) = register.filter(|_| !self.codes.radius.is_empty()) {
            self.block.integer(self.codes.radius, register);
        }
    }
}
