//! A dialect with one fault at a time: each is one that a certificate would not see, since the text says something else
//! than the event.

use post_iso::{Control, Iso, Table, Tcp};
use post_plugin::export::Exported;
use post_plugin::{
    AxisNames, Capabilities, Compensation, Coolant, Dialect, Event, Feed, Format, Linked,
    OptionSpec, Setup, Spindle, SpindleSense, Units, quantise,
};

/// What is wrong, and a part of the sentence that says so.
pub const FAULTS: &[(&str, &str)] = &[
    (
        "decimals",
        "words and feeds: a rapid: with X 0.0001 instead of 0 (the last declared decimal) its text is the same",
    ),
    ("rapid without A", "words and feeds: a rapid: with A 0.001 instead of 0"),
    ("cut without C", "words and feeds: a cut: with C 0.001 instead of 0"),
    ("rapid without what moves alone", "words and feeds: a rapid: with A "),
    ("position without Y", "words and feeds: a first position: with Y "),
    ("one height", "words and feeds: a retract: with Z "),
    ("turn without C", "words and feeds: a turn of the rotary axes: with C "),
    ("park without X", "words and feeds: a position of the machine: with X "),
    ("timed cut without Y", "words and feeds: a cut in inverse time: with Y "),
    ("one turn", "words and feeds: a cut: with C 360 instead of 0 (a turn)"),
    ("no sign", "words and feeds: a cut: with Y -12.346 instead of 12.346 (the other sign)"),
    ("eight digits", "words and feeds: a rapid: with X 2345.68 instead of 2345.679"),
    (
        "whole feeds",
        "words and feeds: a cut: with the feed 0.2 instead of 0.1 (the last declared decimal)",
    ),
    ("one feed", "words and feeds: a cut: with the feed 0.2 instead of 0.1"),
    (
        "whole inverse time",
        "words and feeds: a cut in inverse time: with the feed 0.002 instead of 0.001",
    ),
    (
        "position at rapid",
        "words and feeds: a first position at a feed: with the feed 0.2 instead of 0.1",
    ),
    ("no dwell", "commands: a dwell makes no difference to the text"),
    ("one dwell", "commands: the time of a dwell, 2 s for 1 s, makes no difference"),
    ("one speed", "commands: the speed of the spindle, 3001 for 3000, makes no difference"),
    ("no speed", "commands: the speed of the spindle, 3001 for 3000, makes no difference"),
    ("one sense", "commands: the sense of the spindle makes no difference"),
    ("spindle stays on", "commands: the stop of the spindle makes no difference"),
    ("one tool", "commands: the number of a tool makes no difference"),
    (
        "one length register",
        "commands: the register of a tool's length, 6 for 5, makes no difference",
    ),
    (
        "one radius register",
        "commands: the register of a tool's radius, 6 for 5, makes no difference",
    ),
    ("one side", "commands: the side of cutter compensation makes no difference"),
    ("no coolant", "commands: coolant makes no difference"),
    ("no stop", "commands: a stop makes no difference"),
    ("every stop is optional", "commands: an optional stop for a stop makes no difference"),
    ("no park", "commands: a position of the machine makes no difference"),
    ("no remark", "commands: a remark makes no difference"),
    ("capitals", "commands: a line of the machine's own is not written letter for letter"),
    ("inches ignored", "in inches: the program begins as it does without"),
    ("tcp ignored", "with TCP: the program begins as it does without"),
    (
        "refuses stops",
        "program: it refuses Stop, which programs need: dialect `sloppy`, event Stop: this dialect has no words for a stop",
    ),
    ("refuses lines", "program: it refuses Word, which programs need"),
    (
        "refuses feeds ahead",
        "a first position at a feed is refused: dialect `sloppy`, event Position: it comes at rapid",
    ),
    (
        "declares vectors",
        "with TCP: the tool's direction: another direction makes no difference to the text",
    ),
    (
        "numbered names",
        "axis names: an axis called X1 is written `X1450.000`, which is a value of X",
    ),
];

struct Plain;

impl Control for Plain {
    const TABLE: &'static Table = &Table {
        tcp: Tcp::Length("G43.4"),
        axes: AxisNames { numbered: true, ..AxisNames::ISO },
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Plain)
    }
}

struct Sloppy {
    inner: Iso<Plain>,
    fault: String,
    /// Words of the move in hand.
    words: Vec<f64>,
    /// Words of the move before it.
    last: Vec<f64>,
}

/// The dialect; its option `fault` says what is wrong with it, nothing where it is empty.
pub fn plugin() -> Linked {
    static SLOPPY: Exported = Exported::dialect::<Sloppy>("sloppy", "1", "");
    Linked::dialect::<Sloppy>(&SLOPPY, "sloppy")
}

impl Dialect for Sloppy {
    fn options() -> &'static [OptionSpec] {
        const OPTIONS: &[OptionSpec] = &[OptionSpec::text("fault", "", "What is wrong with it.")];
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let fault = setup.text("fault").to_owned();
        let mut setup = *setup;
        match fault.as_str() {
            "inches ignored" => setup.units = Units::Millimetre,
            "tcp ignored" => setup.tcp = false,
            "lives under TCP" if !setup.tcp => return Err("it keeps the tip".to_owned()),
            _ => {}
        }
        Ok(Sloppy {
            inner: Iso::open(&setup)?,
            fault,
            words: Vec::new(),
            last: vec![0.0; setup.words.len()],
        })
    }

    fn capabilities(&self) -> Capabilities {
        let declared = self.inner.capabilities();
        match self.fault.as_str() {
            "declares vectors" => declared.and(Capabilities::TOOL_VECTOR),
            _ => declared,
        }
    }

    fn format(&self) -> Format {
        let mut format = self.inner.format();
        if self.fault == "decimals" {
            format.words[0] += 1;
        }
        format
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let from = out.len();
        match *event {
            Event::Position { words, feed, .. } => self.position(words, feed, out)?,
            Event::Rapid { words, .. } => self.rapid(words, out)?,
            Event::Linear { words, feed, .. } => self.cut(words, feed, out)?,
            _ => self.command(event, out)?,
        }
        let text = match self.fault.as_str() {
            "numbered names" => out[from..].replace("X1=", "X1"),
            "capitals" => out[from..].to_uppercase(),
            "no speed" => out[from..].replace("S3000 ", "").replace("S3001 ", ""),
            _ => return Ok(()),
        };
        out.truncate(from);
        out.push_str(&text);
        Ok(())
    }
}

impl Sloppy {
    fn take(&mut self, words: &[f64]) {
        self.words = words.to_vec();
        let words = &mut self.words;
        match self.fault.as_str() {
            "one turn" => words[4] %= 360.0,
            "no sign" => words[1] = words[1].abs(),
            "eight digits" if words[0].abs() > 1000.0 => words[0] = quantise(words[0], 2),
            _ => {}
        }
    }

    fn position(
        &mut self,
        words: &[f64],
        feed: Option<Feed>,
        out: &mut String,
    ) -> Result<(), String> {
        self.take(words);
        let feed = match self.fault.as_str() {
            "refuses feeds ahead" if feed.is_some() => return Err("it comes at rapid".to_owned()),
            "position at rapid" => None,
            _ => feed,
        };
        if self.fault == "position without Y" {
            self.words[1] = 0.0;
        }
        self.last.clone_from(&self.words);
        self.inner.write(&Event::position(&self.words, feed), out)
    }

    fn rapid(&mut self, words: &[f64], out: &mut String) -> Result<(), String> {
        self.take(words);
        let linear = |words: &[f64]| [words[0], words[1], words[2]];
        let alone = linear(&self.words) == linear(&self.last);
        match self.fault.as_str() {
            "rapid without A" => self.words[3] = self.last[3],
            "rapid without what moves alone" if alone => self.words[3] = self.last[3],
            _ => {}
        }
        self.last.clone_from(&self.words);
        self.inner.write(&Event::rapid(&self.words), out)
    }

    fn cut(&mut self, words: &[f64], feed: Feed, out: &mut String) -> Result<(), String> {
        self.take(words);
        let timed = matches!(feed, Feed::InverseTime(_));
        match self.fault.as_str() {
            "cut without C" => self.words[4] = self.last[4],
            "timed cut without Y" if timed => self.words[1] = self.last[1],
            _ => {}
        }
        let feed = match (self.fault.as_str(), feed) {
            ("whole feeds", Feed::PerMinute(feed)) => Feed::PerMinute(feed.ceil()),
            ("one feed", Feed::PerMinute(_)) => Feed::PerMinute(500.0),
            ("whole inverse time", Feed::InverseTime(feed)) => Feed::InverseTime(feed.ceil()),
            (_, feed) => feed,
        };
        self.last.clone_from(&self.words);
        self.inner.write(&Event::linear(&self.words, feed), out)
    }

    fn command(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let on = |rpm, sense| Event::Spindle(Spindle::On { rpm, sense });
        let clockwise = SpindleSense::Clockwise;
        let event = match (self.fault.as_str(), *event) {
            ("no dwell", Event::Dwell { .. })
            | ("spindle stays on", Event::Spindle(Spindle::Off))
            | ("no coolant", Event::Coolant(Coolant::Flood))
            | ("no stop", Event::Stop)
            | ("no park", Event::Park { .. })
            | ("no remark", Event::Comment { .. }) => return Ok(()),
            ("one height", Event::Retract { axes, .. }) => {
                Event::Retract { axes, words: &[0.0, 0.0, 100.0, 0.0, 0.0] }
            }
            ("turn without C", Event::Turn { words }) => {
                self.take(words);
                self.words[4] = 0.0;
                return self.inner.write(&Event::Turn { words: &self.words }, out);
            }
            ("park without X", Event::Park { axes, words }) => {
                Event::Park { axes: axes & !1, words }
            }
            ("refuses stops", Event::Stop) | ("refuses lines", Event::Word { .. }) => {
                return Err(event.refusal());
            }
            ("one dwell", Event::Dwell { .. }) => Event::Dwell { seconds: 1.0 },
            ("one speed", Event::Spindle(Spindle::On { sense, .. })) => on(3000.0, sense),
            ("one sense", Event::Spindle(Spindle::On { rpm, .. })) => on(rpm, clockwise),
            ("one tool", Event::ToolChange { register, .. }) => Event::tool_change(1, register, ""),
            ("one length register", Event::ToolChange { number, .. }) => {
                Event::tool_change(number, 1, "")
            }
            ("one radius register", Event::Compensate(Compensation::Left { .. })) => {
                Event::Compensate(Compensation::Left { register: 1 })
            }
            ("one side", Event::Compensate(Compensation::Right { register })) => {
                Event::Compensate(Compensation::Left { register })
            }
            ("every stop is optional", Event::Stop) => Event::OptionalStop,
            (_, event) => event,
        };
        self.inner.write(&event, out)
    }
}
