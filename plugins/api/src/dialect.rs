//! A dialect: one control's language.

use crate::{Batch, Capabilities, Event, Language, OptionSpec, PlaneAngles, Setup, VocabularyWord};

/// Writes one control's language. Implemented by the author of a dialect.
///
/// One value serves one program, from one thread at a time; several programs may run at once, each with its own.
pub trait Dialect: Sized + Send + 'static {
    /// The options of `[control.<name>]` that this dialect knows.
    fn options() -> &'static [OptionSpec] {
        &[]
    }

    /// Called once a program, before anything else.
    ///
    /// # Errors
    /// A sentence for the user, if the machine or its options cannot be served. One that begins with `axis C:` is
    /// shown where the machine file describes that axis.
    fn open(setup: &Setup<'_>) -> Result<Self, String>;

    /// How numbers are written; asked once, after [`Dialect::open`].
    fn format(&self) -> Format;

    /// What it writes beyond straight moves; asked once, after [`Dialect::open`].
    fn capabilities(&self) -> Capabilities {
        Capabilities::NONE
    }

    /// The words of this control and what they mean, those that the options have changed among them: with these a
    /// program can be read back. Asked at most once, after [`Dialect::open`].
    fn vocabulary(&self) -> Vec<VocabularyWord> {
        Vec::new()
    }

    /// What its programs rely on at the control, one sentence each: parameters, options, what a word must do there. They
    /// stand on the setup sheet. Asked at most once, after [`Dialect::open`].
    fn relies_on(&self) -> Vec<String> {
        Vec::new()
    }

    /// Appends the lines that `event` needs to `out`, each ended by `\n`.
    /// Called once for every event, in order.
    ///
    /// # Errors
    /// A sentence for the user. An event that the dialect does not know is an error, never dropped:
    /// [`Event::refusal`] says it.
    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String>;
}

/// How a dialect writes numbers, and what its control can do. The host rounds to these before it certifies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Format {
    /// Decimals of each axis word, in the order of [`Setup::words`].
    pub words: Vec<u8>,
    /// Decimals of a feed a minute.
    pub feed: u8,
    /// Decimals of an inverse-time feed; none if the control has no G93.
    pub inverse_time: Option<u8>,
    /// Decimals of a feed a revolution.
    pub feed_per_revolution: u8,
    /// The usual ending of a program's file name, without the dot.
    pub extension: String,
    /// The largest F that the control takes under inverse time, 1/min; none if it has no end. A block that would need
    /// more is slowed down.
    pub most_inverse_time: Option<f64>,
    /// The feed at which a rapid goes on a control whose G0 goes at F, program units a minute, as it stands in each of them;
    /// none where G0 goes as fast as the axes can.
    pub rapid_feed: Option<f64>,
    /// How the control is told a tilted plane.
    pub plane_angles: PlaneAngles,
    /// Decimals of those angles, degrees.
    pub plane_decimals: u8,
    /// What its programs are written in: they are read back by it.
    pub language: Language,
}

/// An opened dialect as the core sees it: batches, whatever implements it. It is called from one thread at a time, not
/// always from that which opened it.
pub trait DialectSession: Send {
    /// How numbers are written.
    fn format(&self) -> &Format;

    /// What the dialect writes beyond straight moves.
    fn capabilities(&self) -> Capabilities {
        Capabilities::NONE
    }

    /// Appends the text of all events to `out`, and for each event the length of `out` after it to `ends`.
    ///
    /// # Errors
    /// Which event could not be written, and why. What was appended before it is valid.
    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault>;
}

/// An event that could not be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WriteFault {
    /// Place of the event in the batch, from 0.
    pub index: usize,
    /// Why, as a sentence.
    pub message: String,
}
