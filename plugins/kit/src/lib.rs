//! What authors test a plugin with: the cases whose answer is known (`conformance`), and for what the text of a dialect
//! says, a bench with a machine of five axes and jobs to write, and the order in which events come.
//!
//! ```ignore
//! let bench = Bench::of(crate::plugin());
//! insta::assert_snapshot!(bench.write_job().unwrap());
//! assert!(bench.with("decimals", Value::Integer(2)).write(&[Event::Start, rapid(P1)]).is_ok());
//! ```
//!
//! It writes the way the host does with a dialect that is linked in. What it leaves to `post plugin test` is whether
//! the text is the same in every cut of the batches, and through the C contract.

#[cfg(feature = "conformance")]
pub mod conformance;
pub mod jobs;
mod order;

pub use order::{EventOrder, ORDER};

use post_plugin::{
    AxisWord, Batch, Capabilities, Compensation, Coolant, Event, Feed, Linked, LinkedDialect,
    Promise, Setup, Spindle, SpindleSense, Units, Value,
};

/// What tests look into; no part of the crate's face.
#[cfg(feature = "conformance")]
#[doc(hidden)]
pub mod internals {
    pub use crate::conformance::dialect::{CUTS, LAST, events};
    pub use crate::conformance::texts::ends_early;
}

/// A dialect on the bench, with the axis words X Y Z A C.
#[derive(Clone, Debug)]
pub struct Bench {
    plugin: Linked,
    units: Units,
    tcp: bool,
    /// Number of the axis words that the dialect is told of.
    axes: usize,
    given: Vec<(&'static str, Value<'static>)>,
}

const WORDS: &[AxisWord<'_>] = &[
    word("X", false, false),
    word("Y", false, false),
    word("Z", false, true),
    word("A", true, false),
    word("C", true, false),
];

const fn word(name: &str, rotary: bool, depth: bool) -> AxisWord<'_> {
    AxisWord {
        name,
        rotary,
        wrapped: false,
        signed: false,
        depth,
        carries_part: rotary,
        diameter: false,
        // The trunnion has ends, its table none.
        travel: match name.as_bytes() {
            b"A" => Some([-120.0, 120.0]),
            _ => None,
        },
    }
}

impl Bench {
    /// Millimetres, axis positions, every option at its default.
    pub fn of(plugin: Linked) -> Self {
        Self { plugin, units: Units::Millimetre, tcp: false, axes: WORDS.len(), given: Vec::new() }
    }

    /// An inch program.
    pub fn inch(mut self) -> Self {
        self.units = Units::Inch;
        self
    }

    /// The control keeps the tip.
    pub fn tcp(mut self) -> Self {
        self.tcp = true;
        self
    }

    /// A machine with X Y Z alone: events keep the first three of their words.
    pub fn three_axes(mut self) -> Self {
        self.axes = 3;
        self
    }

    /// An option at another value than its default.
    pub fn with(mut self, key: &'static str, value: Value<'static>) -> Self {
        self.given.push((key, value));
        self
    }

    /// The text of `events`.
    ///
    /// # Errors
    /// The dialect's sentence, if it does not open or refuses one of them.
    pub fn write(&self, events: &[Event<'_>]) -> Result<String, String> {
        self.write_with(&mut *self.open()?, events)
    }

    /// The text of [`job`], without inverse time if the control has none, and without cutter compensation where the
    /// control keeps the tip and cannot do both.
    ///
    /// # Errors
    /// As [`Bench::write`].
    pub fn write_job(&self) -> Result<String, String> {
        let mut dialect = self.open()?;
        let (format, writes) = dialect.format()?;
        let mut events = job(format.inverse_time.is_some());
        if self.tcp && !writes.has(Capabilities::COMPENSATE_TCP) {
            events.retain(|event| !matches!(event, Event::Compensate(_)));
        }
        self.write_with(&mut *dialect, &events)
    }

    /// The text of a job of [`jobs`], without what the dialect does not declare: a host would not send it.
    ///
    /// # Errors
    /// As [`Bench::write`].
    pub fn write_declared(&self, events: &[Event<'_>]) -> Result<String, String> {
        let mut dialect = self.open()?;
        let (_, writes) = dialect.format()?;
        let mut in_plane = false;
        let mut in_cycle = true;
        let declared = events.iter().filter(|event| {
            let written = writes.has(jobs::declared_by(event));
            match event {
                Event::Plane { .. } => in_plane = true,
                Event::PlaneOff => in_plane = false,
                Event::Cycle { dwell, .. } => {
                    let waits = dwell.is_none() || !writes.has(Capabilities::CYCLE_NO_DWELL);
                    let stands = !in_plane || writes.has(Capabilities::CYCLE_IN_PLANE);
                    in_cycle = written && waits && stands;
                }
                Event::Arc { .. } if in_plane && !writes.has(Capabilities::CYCLE_IN_PLANE) => {
                    return false;
                }
                _ => {}
            }
            match event {
                Event::Cycle { .. } | Event::CyclePoint { .. } | Event::CycleOff => in_cycle,
                _ => written,
            }
        });
        let declared: Vec<Event<'_>> = declared.copied().collect();
        self.write_with(&mut *dialect, &declared)
    }

    fn open(&self) -> Result<Box<dyn LinkedDialect>, String> {
        let declared = self.plugin.options();
        for (key, _) in &self.given {
            if !declared.iter().any(|spec| spec.key == *key) {
                return Err(format!("the option `{key}` is not declared"));
            }
        }
        let options = declared.iter().map(|spec| {
            let given = self.given.iter().find(|(key, _)| *key == spec.key);
            (spec.key, given.map_or(spec.default, |(_, value)| *value))
        });
        let options: Vec<_> = options.collect();
        let setup = Setup {
            program: "bracket",
            machine: "AC trunnion",
            units: self.units,
            tcp: self.tcp,
            words: &WORDS[..self.axes],
            options: &options,
            cl_file: "bracket.cls",
            ..Setup::default()
        };
        let opened = self.plugin.open(&setup);
        opened.unwrap_or_else(|| Err("it is no dialect".to_owned()))
    }

    fn write_with(
        &self,
        dialect: &mut dyn LinkedDialect,
        events: &[Event<'_>],
    ) -> Result<String, String> {
        let (format, _) = dialect.format()?;
        let promise = Promise {
            words: self.axes,
            // A dialect without inverse time must be able to refuse it by itself.
            inverse_time: true,
        };
        assert_eq!(format.words.len(), self.axes, "decimals of each word");
        let mut batch = Batch::default();
        for (line, event) in (1..).zip(events) {
            batch.push(line, first_words(*event, self.axes));
        }
        let (mut out, mut ends) = (String::new(), Vec::new());
        let written = dialect.write(&batch, &promise, &mut out, &mut ends);
        written.map(|()| out).map_err(|fault| fault.message)
    }
}

/// The event with as many words as the dialect is told of.
fn first_words(event: Event<'_>, axes: usize) -> Event<'_> {
    let mut event = event;
    match &mut event {
        Event::Position { words, .. }
        | Event::Retract { words, .. }
        | Event::Rapid { words, .. }
        | Event::Linear { words, .. }
        | Event::Park { words, .. }
        | Event::Turn { words }
        | Event::Plane { words, .. }
        | Event::Arc { words, .. }
        | Event::CyclePoint { words, .. }
        | Event::Surface { words, .. }
        | Event::Probe { words, .. } => *words = &words[..axes.min(words.len())],
        _ => {}
    }
    event
}

/// Above the part.
pub const P1: &[f64] = &[10.0, -20.5, 100.0, -30.0, 45.0];
/// Down to it: the depth alone.
pub const P2: &[f64] = &[10.0, -20.5, 2.0, -30.0, 45.0];
/// A linear and a rotary word further.
pub const P3: &[f64] = &[12.5, -20.5, 2.0, -30.125, 45.0];
/// Another of each.
pub const P4: &[f64] = &[15.0, -20.5, 2.0, -30.125, 46.0];

/// A tool with a name that needs care.
pub const TOOL: Event<'static> = Event::tool_change(1, 1, "Ball Ø10 (R5)");

/// Clear of the part: the depth axis at its end, machine coordinates.
pub const TOP: Event<'static> = Event::Retract { axes: 0b100, words: &[0.0, 0.0, 500.0, 0.0, 0.0] };
/// The rotary axes at zero and the plane aside, machine coordinates.
pub const ASIDE: Event<'static> =
    Event::Park { axes: 0b11011, words: &[-250.0, 200.0, 0.0, 0.0, 0.0] };

/// The turn to a first position.
pub const fn turn(words: &[f64]) -> Event<'_> {
    Event::Turn { words }
}

/// A first position at rapid.
pub const fn at(words: &[f64]) -> Event<'_> {
    Event::position(words, None)
}

/// A rapid.
pub const fn rapid(words: &[f64]) -> Event<'_> {
    Event::rapid(words)
}

/// A cut at a feed a minute.
pub const fn cut(words: &[f64], feed: f64) -> Event<'_> {
    Event::linear(words, Feed::PerMinute(feed))
}

/// A cut in inverse time.
pub const fn timed(words: &[f64], feed: f64) -> Event<'_> {
    Event::linear(words, Feed::InverseTime(feed))
}

/// The spindle on.
pub const fn turning(rpm: f64) -> Event<'static> {
    let sense = SpindleSense::Clockwise;
    Event::Spindle(Spindle::On { rpm, sense })
}

/// What a five-axis job does: two tools, rapids, cuts in two feed modes (where it is `timed`), compensation, stops,
/// lines of the user's own.
pub fn job(timed: bool) -> Vec<Event<'static>> {
    let mut events = vec![
        Event::Start,
        TOP,
        Event::Comment { text: "Schlichten (fein) 100%" },
        TOOL,
        turning(3000.0),
        Event::Coolant(Coolant::Flood),
        TOP,
        turn(P1),
        at(P1),
        rapid(P2),
        rapid(P2),
        cut(P3, 850.0),
        cut(P4, 850.0),
    ];
    if timed {
        events.extend([self::timed(P3, 12.0), self::timed(P4, 12.0), cut(P3, 850.0)]);
    }
    events.extend([
        rapid(P1),
        Event::Dwell { seconds: 2.5 },
        Event::OptionalStop,
        TOP,
        Event::Spindle(Spindle::Off),
        Event::Coolant(Coolant::Off),
        Event::tool_change(2, 12, ""),
        turning(1200.0),
        TOP,
        turn(P1),
        Event::Position {
            tool: None,
            feed: Some(Feed::PerMinute(2000.5)),
            plane_first: false,
            words: P1,
        },
        Event::Compensate(Compensation::Left { register: 32 }),
        cut(P2, 300.0),
        cut(P3, 300.0),
        Event::Compensate(Compensation::Off),
        rapid(P1),
        Event::Literal { text: "M77" },
        Event::Word { text: "M78" },
        rapid(P1),
        TOP,
        Event::Spindle(Spindle::Off),
        Event::Coolant(Coolant::Off),
        ASIDE,
        Event::End,
    ]);
    events
}
