//! The smallest dialect that is of use: absolute moves, nothing modal.

use post_plugin::{
    Axes, AxisNames, Block, Coolant, Dialect, Event, Feed, Format, Group, Meaning, NumberStyle,
    Setup, Spindle, SpindleSense, Units, VocabularyWord, export_dialect, remark,
};

/// What the words mean, so that a program can be read back.
const VOCABULARY: &[VocabularyWord] = &[
    VocabularyWord::new("(", Meaning::RemarkOpen),
    VocabularyWord::new(")", Meaning::RemarkClose),
    VocabularyWord::new("G21", Meaning::Millimetre),
    VocabularyWord::new("G20", Meaning::Inch),
    VocabularyWord::new("G17", Meaning::PlaneXy),
    VocabularyWord::new("G40", Meaning::CompensationOff),
    VocabularyWord::new("G80", Meaning::CycleOff),
    VocabularyWord::new("G90", Meaning::Absolute),
    VocabularyWord::new("G94", Meaning::FeedPerMinute),
    VocabularyWord::new("G0", Meaning::Rapid),
    VocabularyWord::new("G1", Meaning::Linear),
    VocabularyWord::new("F", Meaning::Feed),
    VocabularyWord::new("G53", Meaning::MachineCoordinates),
    VocabularyWord::new("G43", Meaning::LengthOn),
    VocabularyWord::new("H", Meaning::LengthRegister),
    VocabularyWord::new("G49", Meaning::LengthOff),
    VocabularyWord::new("T", Meaning::Tool),
    VocabularyWord::new("M6", Meaning::ToolChange),
    VocabularyWord::new("S", Meaning::SpindleSpeed),
    VocabularyWord::new("M3", Meaning::SpindleClockwise),
    VocabularyWord::new("M4", Meaning::SpindleCounterClockwise),
    VocabularyWord::new("M5", Meaning::SpindleOff),
    VocabularyWord::new("M8", Meaning::CoolantOn),
    VocabularyWord::new("M9", Meaning::CoolantOff),
    VocabularyWord::new("G4", Meaning::Dwell),
    VocabularyWord::new("G4 P", Meaning::DwellMilliseconds),
    VocabularyWord::new("M0", Meaning::Stop),
    VocabularyWord::new("M1", Meaning::OptionalStop),
    VocabularyWord::new("M30", Meaning::End),
];

struct Writer {
    axes: Axes,
    block: Block,
    units: &'static str,
    /// Of the tool's length; 0 before the first tool.
    register: u32,
}

impl Dialect for Writer {
    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        AxisNames::ISO.check(setup)?;
        if setup.tcp {
            return Err("this control does not keep the tip: tcp = \"post\"".to_owned());
        }
        Ok(Writer {
            axes: Axes::new(setup, 4, 3, NumberStyle::default()),
            block: Block::plain(),
            units: match setup.units {
                Units::Millimetre => "G21",
                Units::Inch => "G20",
            },
            register: 0,
        })
    }

    fn format(&self) -> Format {
        Format {
            words: self.axes.decimals(),
            feed: 1,
            inverse_time: None,
            feed_per_revolution: 3,
            extension: "nc".to_owned(),
            ..Format::default()
        }
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        VOCABULARY.to_vec()
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        match *event {
            Event::Start => {
                self.line(self.units, out);
                self.line("G17 G40 G80 G90 G94", out);
            }
            Event::Comment { text } => self.line(&remark(text), out),
            Event::Literal { text } | Event::Word { text } => self.line(text, out),
            Event::ToolChange { number, register, .. } => {
                self.register = register;
                self.line(&format!("T{number} M6"), out);
            }
            Event::Spindle(Spindle::Off) => self.line("M5", out),
            Event::Spindle(Spindle::On { rpm, sense }) => {
                self.block.number("S", rpm, 0, NumberStyle::default());
                self.line(
                    match sense {
                        SpindleSense::Clockwise => "M3",
                        SpindleSense::CounterClockwise => "M4",
                    },
                    out,
                );
            }
            Event::Coolant(Coolant::Off) => self.line("M9", out),
            Event::Coolant(Coolant::Flood) => self.line("M8", out),
            Event::Position { .. } if self.register == 0 => {
                return Err("no tool was loaded, so its length is not known".to_owned());
            }
            Event::Turn { words } => self.group("G0", words, Group::Rotary, None, out)?,
            // The plane first, then the depth with the tool's length.
            Event::Position { words, feed, .. } => {
                self.group("G0", words, Group::Plane, None, out)?;
                let motion = if feed.is_some() { "G1" } else { "G0" };
                let length = format!("{motion} G43 H{}", self.register);
                self.group(&length, words, Group::Depth, feed, out)?;
            }
            Event::Rapid { words, .. } => self.go("G0", words, None, out)?,
            Event::Linear { words, feed, .. } => self.go("G1", words, Some(feed), out)?,
            Event::Dwell { seconds } => {
                self.block.word("G4");
                self.block.number("P", seconds * 1000.0, 0, NumberStyle::default());
                self.block.end(out);
            }
            Event::Stop => self.line("M0", out),
            Event::OptionalStop => self.line("M1", out),
            // Up, and only there the length away.
            Event::Retract { axes, words } => {
                self.machine(axes, words, out);
                self.line("G49", out);
            }
            Event::Park { axes, words } => self.machine(axes, words, out),
            Event::End => self.line("M30", out),
            other => return Err(other.refusal()),
        }
        Ok(())
    }
}

impl Writer {
    fn line(&mut self, words: &str, out: &mut String) {
        self.block.line(words, out);
    }

    /// Axes to positions of the machine.
    fn machine(&mut self, axes: u32, words: &[f64], out: &mut String) {
        self.block.word("G53 G0");
        self.axes.write_machine(&mut self.block, axes, words);
        self.block.end(out);
    }

    fn go(
        &mut self,
        motion: &str,
        words: &[f64],
        feed: Option<Feed>,
        out: &mut String,
    ) -> Result<(), String> {
        self.block.word(motion);
        // Every word, whatever was written before.
        self.axes.forget();
        self.axes.write(&mut self.block, words);
        self.end(feed, out)
    }

    /// As `go`, with the words of one group alone.
    fn group(
        &mut self,
        motion: &str,
        words: &[f64],
        group: Group,
        feed: Option<Feed>,
        out: &mut String,
    ) -> Result<(), String> {
        self.axes.forget();
        if !self.axes.moved_group(words, group) {
            return Ok(());
        }
        self.block.word(motion);
        self.axes.write_group(&mut self.block, words, group);
        self.end(feed, out)
    }

    fn end(&mut self, feed: Option<Feed>, out: &mut String) -> Result<(), String> {
        match feed {
            None => {}
            Some(Feed::PerMinute(feed)) => {
                self.block.number("F", feed, 1, NumberStyle::default());
            }
            Some(other) => return Err(format!("this control has no feed like {other}")),
        }
        self.block.end(out);
        Ok(())
    }
}

export_dialect!(tiny, Writer);
