//! Moves in G-code.
//!
//! Rapids, cuts, the three feed modes, compensation, arcs and the way a tool comes to the part. A word that is in force
//! is not written again, and a move that changes no word is not written at all.

mod runs;

use post_plugin::{
    Axes, Block, Compensation, Feed, Format, Group, Modal, NumberStyle, Setup, quantise,
};

use crate::lines::takes_number;
use crate::table::MotionCodes;

/// The moving part of a G-code dialect.
#[derive(Clone, Debug)]
pub struct MotionWriter {
    pub(crate) codes: MotionCodes,
    /// The block under construction.
    pub block: Block,
    /// The axis words.
    pub axes: Axes,
    /// How their numbers look.
    pub(crate) style: NumberStyle,
    decimals: FeedDecimals,
    motion: Modal<&'static str>,
    /// The word of motion is never left out.
    every_block: bool,
    /// F of rapids, where they go at one.
    rapid_feed: Option<f64>,
    feed_mode: Modal<&'static str>,
    feed: Modal<f64>,
    pending: Option<Compensation>,
    /// Cutter compensation is on, or waits for the next move.
    compensates: bool,
    /// Another register of the length, to be written with the next move.
    length: Option<String>,
    /// The plane of arcs.
    plane: Modal<&'static str>,
    /// Whether the plane is another one than that of X and Y.
    other_plane: bool,
    /// Words of the last move; empty where it is not known where the axes stand.
    at: Vec<f64>,
    /// Places of the words X, Y and Z among those of the program.
    pub(crate) linear: [Option<usize>; 3],
    /// Decimals of the words.
    places: Vec<u8>,
    /// The tool vector, where its words take the place of rotary ones.
    vector: Option<Vector>,
}

/// Words of the tool vector.
#[derive(Clone, Copy, Debug)]
struct Vector {
    decimals: u8,
    last: Modal<[f64; 3]>,
}

/// Decimals of the three kinds of feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FeedDecimals {
    /// Decimals of a feed a minute.
    pub per_minute: u8,
    /// Decimals of an inverse-time feed.
    pub inverse_time: u8,
    /// Decimals of a feed a revolution.
    pub per_revolution: u8,
}

/// Addresses of the parts of a centre or a vector.
pub(crate) const CENTRE: [&str; 3] = ["I", "J", "K"];

/// A feed has a point but no zeros after it: `F850.`
const FEED_STYLE: NumberStyle = NumberStyle { plus: false, point: true, trim: true };

/// An axis that is measured, and not drawn, leans by less: 0.1 degrees.
const MEASURED: f64 = 1.8e-3;

impl MotionWriter {
    /// Nothing is known to be in force.
    pub fn new(
        setup: &Setup<'_>,
        codes: MotionCodes,
        block: Block,
        axes: Axes,
        style: NumberStyle,
        decimals: FeedDecimals,
    ) -> Self {
        let words = setup.words;
        let place = |name| words.iter().position(|word| word.name == name);
        MotionWriter {
            codes,
            block,
            places: axes.decimals(),
            axes,
            style,
            decimals,
            motion: Modal::default(),
            every_block: false,
            rapid_feed: None,
            feed_mode: Modal::default(),
            feed: Modal::default(),
            pending: None,
            compensates: false,
            length: None,
            plane: Modal::default(),
            other_plane: false,
            at: Vec::with_capacity(words.len()),
            linear: ["X", "Y", "Z"].map(place),
            vector: None,
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
            rapid_feed: self.rapid_feed,
            ..Format::default()
        }
    }

    /// The word of motion stands in every block that moves, if `every_block`; rapids go at `feed`.
    pub(crate) fn in_full(self, every_block: bool, feed: Option<f64>) -> Self {
        MotionWriter { every_block, rapid_feed: feed, ..self }
    }

    /// Nothing is known to be in force any more (a line of the user's own was written).
    pub fn forget(&mut self) {
        self.motion.forget();
        self.feed_mode.forget();
        self.feed.forget();
        self.axes.forget();
        self.plane.forget();
    }

    /// A line of the dialect's own has put the feed a minute in force.
    pub fn feeds_per_minute(&mut self) {
        self.feed_mode.set(self.codes.feed[0]);
        self.plane.set(self.codes.planes[0]);
        self.other_plane = false;
    }

    /// The plane among these words is in force.
    pub(crate) fn plane_is_among(&mut self, words: &str) {
        let named = |plane: &&&str| words.split_whitespace().any(|word| word == **plane);
        if let Some(plane) = self.codes.planes.iter().find(named) {
            self.plane.set(plane);
        }
    }

    /// The kinds of the feed have these words from here on; `now` was written, and is in force.
    pub(crate) fn feeds_by(&mut self, words: [&'static str; 3], now: &'static str) {
        self.codes.feed = words;
        self.feed_mode.set(now);
        self.feed.forget();
    }

    /// The word of the feed's kind in force is this one.
    pub(crate) fn feeds_are(&self, word: &'static str) -> bool {
        self.feed_mode.is(word)
    }

    /// The word of the plane of X and Y, to stand in a line of its own, where another one is in force.
    pub fn leave_other_plane(&mut self) -> Option<&'static str> {
        let word = self.codes.planes[0];
        std::mem::take(&mut self.other_plane).then(|| {
            self.plane.set(word);
            word
        })
    }

    /// The plane of X and Y is in force again, in the block under construction.
    pub(crate) fn plane_xy(&mut self) {
        if std::mem::take(&mut self.other_plane) {
            let word = self.codes.planes[0];
            self.plane.set(word);
            self.block.word(word);
        }
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
        matches!(feed, Feed::PerMinute(_)) || !self.feed_word(feed).is_empty()
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
        self.compensates = compensation != Compensation::Off;
        self.pending = Some(compensation);
    }

    /// Another register of the length in force, to be written with the next move.
    pub(crate) fn change_length(&mut self, words: String) {
        self.length = Some(words);
    }

    /// Cutter compensation that waits for a move which does not come is written in a block of its own.
    pub fn settle(&mut self, out: &mut String) {
        self.write_pending();
        self.block.end(out);
    }

    /// A rapid.
    pub fn rapid(&mut self, words: &[f64], out: &mut String) {
        if self.axes.moved(words) {
            self.write_plane();
            self.motion(self.codes.motion[0]);
            self.write_pending();
            self.axes.write(&mut self.block, words);
            self.rapid_feed();
            self.block.end(out);
        }
        self.stands(words);
    }

    /// Adds the F of a rapid, where it goes at one; that of cuts is to be said again.
    fn rapid_feed(&mut self) {
        if let Some(feed) = self.rapid_feed {
            self.block.number("F", feed, self.decimals.per_minute, FEED_STYLE);
            self.feed.forget();
        }
    }

    /// Adds `feed`, or that of a rapid.
    fn feed_or_rapid(&mut self, feed: Option<Feed>) {
        match feed {
            Some(feed) => self.feed(feed),
            None => self.rapid_feed(),
        }
    }

    /// Decimals of the words X, Y and Z.
    pub(crate) fn linear_decimals(&self, part: usize) -> u8 {
        let place = self.linear[part].unwrap_or_default();
        self.places.get(place).copied().unwrap_or_default()
    }

    /// Cutter compensation is on, or waits for the next move.
    pub(crate) fn is_compensating(&self) -> bool {
        self.compensates || self.pending.is_some()
    }

    /// The axes are known to stand at `words`.
    pub(crate) fn stands_at(&self, words: &[f64]) -> bool {
        self.at == words
    }

    /// The axes stand at `words`, but the one at `place`, which a cycle has left at `level`.
    pub(crate) fn at_level(&mut self, words: &[f64], place: usize, level: f64) {
        self.stands(words);
        self.at[place] = level;
        self.axes.forget_some(1 << place);
        self.motion.forget();
    }

    /// The feed, whatever is in force, with so many decimals more.
    pub(crate) fn feed_again(&mut self, feed: Feed, more: u8) {
        self.feed.forget();
        self.feed_with(feed, more);
    }

    /// A move until the probe touches.
    pub(crate) fn probe(&mut self, code: &str, words: &[f64], feed: Feed, out: &mut String) {
        self.feed_mode(feed);
        self.block.word(code);
        self.forget_linear();
        self.axes.write(&mut self.block, words);
        self.feed(feed);
        self.block.end(out);
        self.moved_by_line();
    }

    /// Where the axes stand.
    pub fn stands(&mut self, words: &[f64]) {
        self.at.clear();
        self.at.extend_from_slice(words);
    }

    /// A move with the tool vector in the place of rotary words; a rapid without a feed.
    pub(crate) fn lead(
        &mut self,
        words: &[f64],
        axis: [f64; 3],
        feed: Option<Feed>,
        out: &mut String,
    ) {
        let linear = [Group::Plane, Group::Depth];
        let moved = linear.map(|group| self.axes.moved_group(words, group));
        let turned = self.vector.is_some_and(|vector| {
            let written = axis.map(|part| quantise(part, vector.decimals));
            !vector.last.is(written)
        });
        if moved != [false; 2] || turned {
            if let Some(feed) = feed {
                self.feed_mode(feed);
            }
            self.motion(self.codes.motion[usize::from(feed.is_some())]);
            self.write_pending();
            for group in linear {
                self.axes.write_group(&mut self.block, words, group);
            }
            self.write_vector(axis);
            self.feed_or_rapid(feed);
            self.block.end(out);
        }
        self.stands(words);
    }

    /// Tool vectors take the place of rotary words from here on; with none, rotary words are written again.
    pub(crate) fn follow_vector(&mut self, decimals: Option<u8>) {
        self.vector = decimals.map(|decimals| Vector { decimals, last: Modal::default() });
    }

    fn write_vector(&mut self, axis: [f64; 3]) {
        let Some(vector) = &mut self.vector else {
            return;
        };
        let written = axis.map(|part| quantise(part, vector.decimals));
        if vector.last.set(written) {
            for (address, part) in CENTRE.into_iter().zip(written) {
                self.block.number(address, part, vector.decimals, self.style);
            }
        }
    }

    /// A cut.
    pub fn cut(&mut self, words: &[f64], feed: Feed, out: &mut String) {
        if self.axes.moved(words) {
            self.write_plane();
            self.feed_mode(feed);
            self.motion(self.codes.motion[1]);
            self.write_pending();
            self.axes.write(&mut self.block, words);
            self.feed(feed);
            self.block.end(out);
        }
        self.stands(words);
    }

    /// The control moves a word of the plane by the length of a tool that lies along `axis`.
    pub(crate) fn lies_across(&self, axis: [f64; 3]) -> bool {
        let words = self.linear.into_iter().zip(axis);
        let mut words = words.filter_map(|(place, part)| Some((place?, part)));
        words.any(|(place, part)| part.abs() > MEASURED && self.axes.is_plane(place))
    }

    /// Writes `words` after the word of rapid, in a block that moves nothing.
    pub(crate) fn at_rapid(&mut self, words: &str, out: &mut String) {
        self.motion.forget();
        self.motion(self.codes.motion[0]);
        self.block.word(words).end(out);
    }

    /// The words of the plane at rapid, each of them, with `length` (`G43.4 H1`); with the tool's `axis` where its
    /// vector is written.
    pub(crate) fn across(
        &mut self,
        words: &[f64],
        axis: Option<[f64; 3]>,
        length: &str,
        out: &mut String,
    ) {
        self.plane_xy();
        self.motion(self.codes.motion[0]);
        self.forget_linear();
        if !length.is_empty() {
            self.block.word(length);
        }
        self.axes.write_group(&mut self.block, words, Group::Plane);
        if let Some(axis) = axis {
            self.write_vector(axis);
        }
        self.rapid_feed();
        self.block.end(out);
    }

    /// What is left of the way to `words`, with `length` (`G43 H1`), at `feed` or at rapid; with the tool's `axis`
    /// where its vector is written.
    pub fn arrive(
        &mut self,
        words: &[f64],
        axis: Option<[f64; 3]>,
        feed: Option<Feed>,
        length: &str,
        out: &mut String,
    ) {
        self.plane_xy();
        if let Some(feed) = feed {
            self.feed_mode(feed);
        }
        self.motion(self.codes.motion[usize::from(feed.is_some())]);
        if !length.is_empty() {
            self.block.word(length);
        }
        self.axes.write(&mut self.block, words);
        if let Some(axis) = axis {
            self.write_vector(axis);
        }
        self.feed_or_rapid(feed);
        self.block.end(out);
        self.stands(words);
    }

    /// Axes at rapid to positions in machine coordinates; `front` is what says so (`G53 G0`).
    pub fn machine(&mut self, front: &str, axes: u32, words: &[f64], out: &mut String) {
        if axes != 0 {
            self.block.word(front);
            self.axes.write_machine(&mut self.block, axes, words);
            self.rapid_feed();
            self.block.end(out);
            self.motion.forget();
            self.at.clear();
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
        self.at.clear();
    }

    /// The linear words have a frame of their own from here on; the rotary axes stand where they did.
    pub(crate) fn other_frame(&mut self) {
        self.forget_linear();
        self.motion.forget();
        self.at.clear();
    }

    /// The next move writes all linear words.
    pub(crate) fn forget_linear(&mut self) {
        let linear = self.linear.into_iter().flatten();
        self.axes.forget_some(linear.fold(0, |all, place| all | 1 << place));
    }

    /// Where the axis of this word stands, if it is known.
    pub(crate) fn stands_on(&self, place: usize) -> Option<f64> {
        self.at.get(place).copied()
    }

    /// A code of the same group as the motion words was written.
    pub(crate) fn forget_motion(&mut self) {
        self.motion.forget();
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
            self.rapid_feed();
            self.block.end(out);
        }
    }

    /// Adds the word of a kind of motion, unless it is in force and may be left out.
    pub fn motion(&mut self, word: &'static str) {
        if self.motion.set(word) || self.every_block {
            self.block.word(word);
        }
    }

    /// Adds the word of the feed's kind, unless it is in force.
    pub fn feed_mode(&mut self, feed: Feed) {
        let word = self.feed_word(feed);
        if self.feed_mode.set(word) {
            if !word.is_empty() {
                self.block.word(word);
            }
            self.feed.forget();
        }
    }

    /// Adds the feed's number, unless it is in force; its kind comes before it.
    pub fn feed(&mut self, feed: Feed) {
        self.feed_with(feed, 0);
    }

    fn feed_with(&mut self, feed: Feed, more: u8) {
        let (value, decimals) = match feed {
            Feed::PerMinute(value) => (value, self.decimals.per_minute),
            Feed::InverseTime(value) => (value, self.decimals.inverse_time),
            Feed::PerRevolution(value) => (value, self.decimals.per_revolution),
        };
        // Under inverse time every block needs its own.
        if self.feed.set(value) || matches!(feed, Feed::InverseTime(_)) {
            self.block.number("F", value, decimals + more, FEED_STYLE);
        }
    }

    /// Compensation is in the plane of X and Y.
    fn write_plane(&mut self) {
        if self.pending.is_some() {
            self.plane_xy();
        }
    }

    /// Adds cutter compensation that waits for a move.
    pub fn write_pending(&mut self) {
        if let Some(length) = self.length.take() {
            self.block.word(&length);
        }
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

    /// An arc or a helix.
    ///
    /// # Errors
    /// If the control cannot be told it: a plane that is none of the three, an unknown start, more than a
    /// turn, an arc that would be read as a whole circle, the first move of a cutter compensation.
    pub fn arc(&mut self, arc: &ArcWords<'_>, feed: Feed, out: &mut String) -> Result<(), String> {
        let (plane, sense) = arc.plane()?;
        let across = PLANES[plane];
        let places = across.map(|part| self.linear[part]);
        let [Some(first), Some(second)] = places else {
            return Err("the machine has not both axes of the arc's plane".to_owned());
        };
        if self.at.len() != arc.words.len() {
            return Err("nobody knows where the arc starts".to_owned());
        }
        if self.pending.is_some() || self.compensates && plane != 0 {
            return Err(
                "cutter compensation begins and ends with a straight move, and holds in the plane of X and Y alone"
                    .to_owned(),
            );
        }
        if arc.turn.abs() > 360.0 + 1e-6 {
            return Err("this control makes one turn in a block at most".to_owned());
        }
        let ends_at_start =
            [first, second].iter().all(|place| self.at[*place] == arc.words[*place]);
        if ends_at_start && (arc.turn.abs() < 180.0 || arc.radius.is_some()) {
            return Err(
                "the arc ends where it starts: the control would make a whole circle of it, or none".to_owned(),
            );
        }
        let word = self.codes.planes[plane];
        if self.plane.set(word) {
            self.block.word(word);
            // Beside another plane the code is not left to be remembered.
            self.motion.forget();
        }
        self.other_plane = plane != 0;
        self.feed_mode(feed);
        self.motion(self.codes.arc[usize::from(arc.turn * sense > 0.0)]);
        self.write_pending();
        self.axes.forget_some(1 << first | 1 << second);
        self.axes.write(&mut self.block, arc.words);
        match arc.radius {
            Some(radius) => {
                self.block.number("R", radius, self.places[first], self.style);
            }
            None => {
                let mut parts = [(across[0], first), (across[1], second)];
                parts.sort_unstable();
                for (part, place) in parts {
                    let offset = arc.centre[part] - self.at[place];
                    self.block.number(CENTRE[part], offset, self.places[place], self.style);
                }
            }
        }
        self.feed(feed);
        self.block.end(out);
        self.stands(arc.words);
        Ok(())
    }
}

/// Coordinates that lie in G17, G18, G19, in the order in which a turn to the left goes from one to the other.
const PLANES: [[usize; 2]; 3] = [[0, 1], [2, 0], [1, 2]];

/// An arc or a helix, as [`Event::Arc`](post_plugin::Event::Arc) has it.
#[derive(Clone, Copy, Debug)]
pub struct ArcWords<'a> {
    /// Centre in the frame and the units of the linear words.
    pub centre: [f64; 3],
    /// Unit vector about which it turns.
    pub normal: [f64; 3],
    /// Degrees, to the left seen against the normal.
    pub turn: f64,
    /// Radius to be written in the place of the centre.
    pub radius: Option<f64>,
    /// All axis words at its end.
    pub words: &'a [f64],
}

impl ArcWords<'_> {
    /// The plane's place among G17, G18, G19, and 1 or -1 where the normal points the other way.
    fn plane(&self) -> Result<(usize, f64), String> {
        // Along Z, Y, X.
        let along = [2, 1, 0].map(|part| self.normal[part]);
        let plane = along.iter().position(|part| part.abs() > 1.0 - 1e-9);
        match plane {
            Some(plane) => Ok((plane, along[plane].signum())),
            None => {
                let [x, y, z] = self.normal;
                Err(format!(
                    "the arc turns about ({x:.6}, {y:.6}, {z:.6}), and this control has arcs about X, Y and Z alone"
                ))
            }
        }
    }
}
