//! Moves in G-code: what the dialects of the ISO family share.
//!
//! `G0`, `G1`, the feed modes `G93` to `G95`, `G40` to `G42` and the way a tool comes to the part. A word
//! that is in force is not written again, and a move that changes no word is not written at all.

use crate::{Axes, Block, Compensation, Feed, Format, Group, Modal, NumberStyle};

/// The moving part of a G-code dialect.
#[derive(Clone, Debug)]
pub struct IsoMotion {
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
    /// `G94`.
    pub per_minute: u8,
    /// `G93`.
    pub inverse_time: u8,
    /// `G95`.
    pub per_revolution: u8,
}

/// A feed has a point but no zeros behind it: `F850.`
const FEED_STYLE: NumberStyle = NumberStyle {
    plus: false,
    point: true,
    trim: true,
};

impl IsoMotion {
    /// Nothing is known to be in force.
    pub fn new(block: Block, axes: Axes, decimals: FeedDecimals) -> Self {
        IsoMotion {
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
            inverse_time: Some(self.decimals.inverse_time),
            feed_per_revolution: self.decimals.per_revolution,
            extension: extension.to_owned(),
        }
    }

    /// Nothing is known to be in force any more (a line of the user's own was written).
    pub fn forget(&mut self) {
        self.motion.forget();
        self.feed_mode.forget();
        self.feed.forget();
        self.axes.forget();
    }

    /// A line of the dialect's own has put `G94` in force.
    pub fn feeds_per_minute(&mut self) {
        self.feed_mode.set("G94");
    }

    /// A block of its own.
    pub fn line(&mut self, words: &str, out: &mut String) {
        self.block.line(words, out);
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

    /// `G0`.
    pub fn rapid(&mut self, words: &[f64], out: &mut String) {
        if self.axes.moved(words) {
            self.motion("G0");
            self.write_pending();
            self.axes.write(&mut self.block, words);
            self.block.end(out);
        }
    }

    /// `G1`.
    pub fn cut(&mut self, words: &[f64], feed: Feed, out: &mut String) {
        if self.axes.moved(words) {
            self.feed_mode(feed);
            self.motion("G1");
            self.write_pending();
            self.axes.write(&mut self.block, words);
            self.feed(feed);
            self.block.end(out);
        }
    }

    /// Rotary axes first, then the plane, then the depth with `length` (`G43 H1`); the last of them at
    /// `feed`. With `at_once` all linear axes go in the last block, as they must where `length` also
    /// changes what they mean.
    pub fn approach(
        &mut self,
        words: &[f64],
        feed: Option<Feed>,
        length: &str,
        at_once: bool,
        out: &mut String,
    ) {
        self.turn_first(words, out);
        if !at_once {
            self.rapid_group(words, Group::Plane, out);
        }
        if let Some(feed) = feed {
            self.feed_mode(feed);
        }
        self.motion(if feed.is_some() { "G1" } else { "G0" });
        self.block.word(length);
        self.axes.write(&mut self.block, words);
        if let Some(feed) = feed {
            self.feed(feed);
        }
        self.block.end(out);
    }

    /// The rotary axes alone, with `G0`: the beginning of [`IsoMotion::approach`], for a dialect that has
    /// to switch something once they stand.
    pub fn turn_first(&mut self, words: &[f64], out: &mut String) {
        self.rapid_group(words, Group::Rotary, out);
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
            self.motion("G0");
            self.axes.write_group(&mut self.block, words, group);
            self.block.end(out);
        }
    }

    fn motion(&mut self, word: &'static str) {
        if self.motion.set(word) {
            self.block.word(word);
        }
    }

    fn feed_mode(&mut self, feed: Feed) {
        let word = match feed {
            Feed::InverseTime(_) => "G93",
            Feed::PerMinute(_) => "G94",
            Feed::PerRevolution(_) => "G95",
        };
        if self.feed_mode.set(word) {
            self.block.word(word);
            self.feed.forget();
        }
    }

    fn feed(&mut self, feed: Feed) {
        let (value, decimals) = match feed {
            Feed::PerMinute(value) => (value, self.decimals.per_minute),
            Feed::InverseTime(value) => (value, self.decimals.inverse_time),
            Feed::PerRevolution(value) => (value, self.decimals.per_revolution),
        };
        // Under G93 every block needs its own.
        if self.feed.set(value) || matches!(feed, Feed::InverseTime(_)) {
            self.block.number("F", value, decimals, FEED_STYLE);
        }
    }

    fn write_pending(&mut self) {
        let (word, register) = match self.pending.take() {
            None => return,
            Some(Compensation::Off) => ("G40", None),
            Some(Compensation::Left { register }) => ("G41", Some(register)),
            Some(Compensation::Right { register }) => ("G42", Some(register)),
        };
        self.block.word(word);
        if let Some(register) = register {
            self.block.integer("D", register);
        }
    }
}
