//! Short programs, each written by a dialect that was opened for it alone.

use post_host::{OpenedDialect, Plugin, PluginFault, ProgramSetup};
use post_plugin::{
    Batch, Capabilities, DialectSession as _, Event, Feed, Format, Meaning, Spindle, WriteFault,
    quantise,
};

use super::pose::posed;
use crate::{TOP, at, turn, turning};

/// The start, a tool and all that turns, as every program of the kit has them.
pub(super) const BEGIN: &[Event<'static>] =
    &[Event::Start, TOP, Event::tool_change(1, 1, "ball 6"), turning(3000.0)];

/// The end of a program.
pub(super) const END: &[Event<'static>] = &[TOP, Event::Spindle(Spindle::Off), Event::End];

/// Words of a point away from where cases look, where the tool comes from and goes to.
pub(super) const ELSEWHERE: [f64; 5] = [1.0, 2.0, 90.0, 3.0, 4.0];
/// Words of the point where the tool stands before what is tried, the tool upright but for a plane.
pub(super) const HERE: &[f64] = &[10.0, 20.0, 30.0, 5.0, 6.0];

pub(super) const SLOW: Feed = Feed::PerMinute(400.0);

/// Whatever writes the programs of the kit.
pub(super) struct Pen<'a> {
    pub plugin: &'a Plugin,
    pub setup: &'a ProgramSetup,
    /// Names of the events that it refuses: programs do without them.
    pub left_out: &'a [&'static str],
}

/// A program as a dialect wrote it.
pub(super) struct WrittenParts {
    pub text: String,
    /// Where the text of each part ends.
    ends: Vec<usize>,
}

impl WrittenParts {
    /// The text of the part at a place.
    pub fn part(&self, place: usize) -> &str {
        let end = |place: usize| self.ends.get(place).copied().unwrap_or(0);
        self.text.get(place.checked_sub(1).map_or(0, end)..end(place)).unwrap_or("")
    }
}

/// Names of events that a dialect has no words for, as what it declares tells: programs do without them, and that it refuses
/// them is right. None are told of one without a vocabulary.
pub(super) fn wordless(opened: &mut OpenedDialect) -> Vec<&'static str> {
    let writes = opened.capabilities();
    let mut names = Vec::new();
    if writes.has(Capabilities::NO_PARK) {
        names.push("Park");
        if writes.has(Capabilities::RETRACT_SAID) {
            names.push("Retract");
        }
    }
    let words = opened.vocabulary().unwrap_or_default();
    let lacks = |meaning: &Meaning| !words.iter().any(|word| word.meaning == *meaning);
    let needed = [
        ("Spindle", Meaning::SpindleClockwise),
        ("Coolant", Meaning::CoolantOn),
        ("Stop", Meaning::Stop),
        ("OptionalStop", Meaning::OptionalStop),
    ];
    if words.iter().any(|word| word.meaning == Meaning::Linear) {
        names.extend(needed.iter().filter(|(_, meaning)| lacks(meaning)).map(|(name, _)| *name));
    }
    names
}

impl Pen<'_> {
    /// Names of events that programs under another `setup` do without: those that were refused here, and those without
    /// words there.
    pub fn left_out_under(&self, setup: &ProgramSetup) -> Result<Vec<&'static str>, PluginFault> {
        let here = wordless(&mut self.open()?);
        let mut names = wordless(&mut self.plugin.dialect(setup)?);
        names.extend(self.left_out.iter().filter(|name| !here.contains(name)));
        Ok(names)
    }

    pub fn open(&self) -> Result<OpenedDialect, PluginFault> {
        self.plugin.dialect(self.setup)
    }

    /// A move has the tool's direction in the place of rotary words: a full turn of these is not in its text.
    pub fn writes_vectors(&self) -> Result<bool, PluginFault> {
        Ok(self.setup.tcp && self.open()?.capabilities().has(Capabilities::TOOL_VECTOR))
    }

    /// The event as the host tells it to a dialect that writes `vectors`, or does not.
    pub fn told<'e>(&self, event: Event<'e>, vectors: bool) -> Event<'e> {
        if vectors { posed(event, self.setup.units) } else { event }
    }

    pub fn leaves_out(&self, event: &Event<'_>) -> bool {
        self.left_out.contains(&event.name())
    }

    /// The program of these parts; or why an event was refused.
    pub fn write(
        &self,
        parts: &[&[Event<'_>]],
    ) -> Result<Result<WrittenParts, String>, PluginFault> {
        let vectors = self.writes_vectors()?;
        self.write_each(parts, &|event| self.told(event, vectors))
    }

    /// As [`Pen::write`], where nobody knows how the tool stands.
    pub fn write_unposed(
        &self,
        parts: &[&[Event<'_>]],
    ) -> Result<Result<WrittenParts, String>, PluginFault> {
        self.write_each(parts, &|event| event)
    }

    fn write_each<'e>(
        &self,
        parts: &[&[Event<'e>]],
        told: &dyn Fn(Event<'e>) -> Event<'e>,
    ) -> Result<Result<WrittenParts, String>, PluginFault> {
        let mut batch = Batch::default();
        let mut counts = Vec::with_capacity(parts.len());
        for part in parts {
            for event in part.iter().filter(|event| !self.leaves_out(event)) {
                batch.push(batch.len() as u64 + 1, told(*event));
            }
            counts.push(batch.len());
        }
        let (mut text, mut ends) = (String::new(), Vec::new());
        let written = self.open()?.write_batch(&batch, &mut text, &mut ends);
        let end = |count: usize| Some(*ends.get(count.checked_sub(1)?)?);
        let ends = counts.into_iter().map(|count| end(count).unwrap_or(0)).collect();
        Ok(written.map(|()| WrittenParts { text, ends }).map_err(|fault| fault.message))
    }

    /// The program that comes to the part, does `events` there, or `away` from it, and goes on.
    pub fn write_around(
        &self,
        events: &[Event<'_>],
        away: bool,
    ) -> Result<Result<String, String>, PluginFault> {
        const BACK: &[Event<'static>] = &[turning(3000.0), turn(&ELSEWHERE), at(&ELSEWHERE)];
        let here = Event::linear(HERE, SLOW);
        let (leaves, back): (&[Event<'_>], _) = if away { (&[TOP], BACK) } else { (&[], &[] as _) };
        let came = [at(&ELSEWHERE), here];
        let goes_on = [Event::linear(&ELSEWHERE, SLOW), here];
        let written = self.write(&[BEGIN, &came, leaves, events, back, &goes_on, END])?;
        Ok(written.map(|written| written.text))
    }

    /// The text of all `events`, given in batches of so many; or which of them was refused, and why.
    pub fn write_batches(
        &self,
        events: &[Event<'_>],
        most: usize,
    ) -> Result<Result<String, WriteFault>, PluginFault> {
        let vectors = self.writes_vectors()?;
        let mut session = self.open()?;
        let (mut text, mut ends) = (String::new(), Vec::new());
        let mut done = 0;
        for chunk in events.chunks(most.min(events.len()).max(1)) {
            let mut batch = Batch::default();
            for (event, line) in chunk.iter().zip(1..) {
                batch.push(line, self.told(*event, vectors));
            }
            if let Err(fault) = session.write_batch(&batch, &mut text, &mut ends) {
                return Ok(Err(WriteFault { index: done + fault.index, ..fault }));
            }
            done += chunk.len();
        }
        Ok(Ok(text))
    }
}

/// Words as the dialect prints them.
pub(super) fn rounded(mut words: [f64; 5], format: &Format) -> [f64; 5] {
    for (word, decimals) in words.iter_mut().zip(&format.words) {
        *word = quantise(*word, *decimals);
    }
    words
}
