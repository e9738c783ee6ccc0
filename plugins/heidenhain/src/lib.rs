//! Heidenhain TNC640, conversational: numbered blocks, `L` moves, a sign on every coordinate.
//!
//! What it assumes about the control stands in `plugins/README.md`.

mod options;

use post_plugin::{
    Axes, AxisNames, Block, Capabilities, Compensation, Coolant, Dialect, Event, Feed, Format,
    Group, Modal, NumberStyle, OptionSpec, Setup, Spindle, SpindleSense, Units, ascii,
    export_dialect, wrapped,
};

use crate::options::OPTIONS;

const SIGNED: NumberStyle = NumberStyle {
    plus: true,
    point: false,
    trim: false,
};

/// Characters of a program's name that the control shows (TNC 640, ISO programming 1/2015, p. 112).
const NAME_LENGTH: usize = 24;

/// Longer remarks become several; no manual gives a limit, and the screen shows as many.
const REMARK_LENGTH: usize = 80;

struct Heidenhain {
    block: Block,
    axes: Axes,
    program: String,
    machine: String,
    inch: bool,
    tcp: bool,
    feed_decimals: u8,
    preset: i64,
    rotary_way: String,
    /// The control has rotary axes: it knows M129 and PLANE.
    rotary: bool,
    /// The transformations of a program that came before are cancelled.
    reset: bool,
    /// In the place of a retract in machine coordinates; empty: none.
    retract: String,
    tcp_on: String,
    tcp_off: String,
    coolant: [(Coolant, String); 5],
    /// What ends mist, coolant through the tool and air, where they have an end of their own.
    coolant_ends: [(Coolant, String); 3],
    /// A tool call that waits for its speed.
    tool: Option<u32>,
    /// What came between a tool change and its call.
    held: Vec<Held>,
    speed: Modal<f64>,
    feed: Modal<f64>,
    radius: Modal<&'static str>,
    compensation: &'static str,
    tcp_active: Modal<bool>,
    spindle_on: Modal<bool>,
    /// How the spindle turns, if it does.
    sense: Option<SpindleSense>,
    coolant_on: Modal<bool>,
    /// The coolant that is on.
    flowing: Option<Coolant>,
}

/// An event that waits for the tool call.
#[derive(Clone, Copy, Debug)]
enum Held {
    Preselect(u32),
    Coolant(Coolant),
}

impl Dialect for Heidenhain {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        AxisNames::ISO.check(setup)?;
        let inch = setup.units == Units::Inch;
        let decimals = setup.integer(if inch { "decimals_inch" } else { "decimals" });
        let rotary = setup.integer("rotary_decimals");
        let own = |key| setup.text(key).to_owned();
        Ok(Heidenhain {
            block: Block::numbered("", 0, 1, u32::MAX - 1),
            axes: Axes::new(setup, decimals as u8, rotary as u8, SIGNED),
            program: program_name(setup.program),
            machine: setup.machine.to_owned(),
            inch,
            tcp: setup.tcp,
            // An inch program counts F in tenths of an inch a minute: one digit less behind the point.
            feed_decimals: setup.integer("feed_decimals") as u8 + u8::from(inch),
            preset: setup.integer("preset"),
            rotary_way: if setup.words.iter().any(|word| word.wrapped) {
                // Words below a turn mean the shorter way.
                "M126".to_owned()
            } else {
                own("rotary_way")
            },
            rotary: setup.words.iter().any(|word| word.rotary),
            reset: setup.flag("reset"),
            retract: own("retract"),
            tcp_on: own("tcp_on"),
            tcp_off: own("tcp_off"),
            coolant_ends: [
                (Coolant::Mist, own("coolant_mist_off")),
                (Coolant::Through, own("coolant_through_off")),
                (Coolant::Air, own("coolant_air_off")),
            ],
            coolant: [
                (Coolant::Off, own("coolant_off")),
                (Coolant::Flood, "M8".to_owned()),
                (Coolant::Mist, own("coolant_mist")),
                (Coolant::Through, own("coolant_through")),
                (Coolant::Air, own("coolant_air")),
            ],
            tool: None,
            held: Vec::new(),
            speed: Modal::default(),
            feed: Modal::default(),
            radius: Modal::default(),
            compensation: "R0",
            tcp_active: Modal::default(),
            spindle_on: Modal::default(),
            sense: None,
            coolant_on: Modal::default(),
            flowing: None,
        })
    }

    /// M128 moves nothing; length and radius are those of the tool table.
    fn capabilities(&self) -> Capabilities {
        Capabilities::TCP_STILL | Capabilities::TOOL_TABLE
    }

    fn format(&self) -> Format {
        Format {
            words: self.axes.decimals(),
            feed: self.feed_decimals,
            inverse_time: None,
            feed_per_revolution: 3,
            extension: "h".to_owned(),
            ..Format::default()
        }
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        // The speed belongs to the tool call, so this waits for it; remarks may come between.
        match *event {
            Event::Spindle(Spindle::On { .. }) | Event::Comment { .. } => {}
            Event::Preselect { .. } | Event::Coolant(_) if self.tool.is_some() => {
                self.held.push(match *event {
                    Event::Coolant(coolant) => Held::Coolant(coolant),
                    Event::Preselect { number } => Held::Preselect(number),
                    _ => return Ok(()),
                });
                return Ok(());
            }
            _ => self.call_tool(None, out)?,
        }
        match *event {
            Event::Start => self.start(out),
            Event::Comment { text } => self.comment(text, out),
            Event::Literal { text } => {
                self.own(text, out);
                self.forget();
            }
            Event::Word { text } => self.own(text, out),
            Event::ToolChange { number, name, .. } => {
                if !name.is_empty() {
                    self.comment(&format!("T{number} {name}"), out);
                }
                self.tool = Some(number);
            }
            Event::Preselect { number } => self.block.line(&format!("TOOL DEF {number}"), out),
            Event::Spindle(spindle) => self.turn(spindle, out)?,
            Event::Coolant(coolant) => self.cool(coolant, out)?,
            // The radius stands in the tool table, not in a register.
            Event::Compensate(compensation) => {
                self.compensation = match compensation {
                    Compensation::Off => "R0",
                    Compensation::Left { .. } => "RL",
                    Compensation::Right { .. } => "RR",
                }
            }
            Event::Turn { words } => {
                self.axes.forget();
                self.rapid_group(words, Group::Rotary, out)?;
            }
            Event::Position {
                words,
                feed,
                plane_first,
                ..
            } => self.approach(words, feed, plane_first, out)?,
            Event::Retract { axes, words } => self.leave(axes, words, out),
            Event::Park { axes, words } => self.in_machine_coordinates(axes, words, out),
            Event::Rapid { words, .. } => {
                if self.axes.moved(words) {
                    self.block.word("L");
                    self.axes.write(&mut self.block, words);
                    self.finish_move(None, true, out)?;
                }
            }
            Event::Linear { words, feed, .. } => {
                if self.axes.moved(words) {
                    let length = [Group::Plane, Group::Depth]
                        .iter()
                        .any(|group| self.axes.moved_group(words, *group));
                    self.block.word("L");
                    self.axes.write(&mut self.block, words);
                    self.finish_move(Some(feed), length, out)?;
                }
            }
            Event::Dwell { seconds } => {
                self.block.line("CYCL DEF 9.0 DWELL TIME", out);
                self.block.word("CYCL DEF 9.1 DWELL");
                self.block
                    .number("", seconds, 3, NumberStyle::default())
                    .end(out);
            }
            Event::Stop => self.halt("M0", out),
            Event::OptionalStop => self.halt("M1", out),
            Event::End => self.end(out),
            other => return Err(other.refusal()),
        }
        Ok(())
    }
}

impl Heidenhain {
    fn start(&mut self, out: &mut String) {
        self.frame("BEGIN", out);
        if !self.machine.is_empty() {
            self.comment(&self.machine.clone(), out);
        }
        if self.preset >= 0 {
            // The second line continues the block and has no number.
            let words = format!(
                "CYCL DEF 247 DATUM SETTING ~\n    Q339=+{} ;DATUM NUMBER",
                self.preset
            );
            self.block.line(&words, out);
        }
        if self.reset {
            self.cancel(out);
        }
        self.block.line(&self.rotary_way, out);
    }

    /// What a program before, or the operator, may have left in force. Nothing of it moves an axis.
    fn cancel(&mut self, out: &mut String) {
        if self.rotary {
            // M128 outlives the end of a program; in a tilted plane M91 would still be the machine's own.
            self.own(&self.tcp_off.clone(), out);
            self.tcp_active.set(false);
            self.block.line("PLANE RESET STAY", out);
        }
        for line in [
            "CYCL DEF 7.0 DATUM SHIFT",
            "CYCL DEF 7.1 X+0",
            "CYCL DEF 7.2 Y+0",
            "CYCL DEF 7.3 Z+0",
            "CYCL DEF 8.0 MIRROR IMAGE",
            "CYCL DEF 8.1",
            "CYCL DEF 10.0 ROTATION",
            "CYCL DEF 10.1 ROT+0",
            "CYCL DEF 11.0 SCALING",
            "CYCL DEF 11.1 SCL 1",
        ] {
            self.block.line(line, out);
        }
    }

    fn frame(&mut self, word: &str, out: &mut String) {
        let units = if self.inch { "INCH" } else { "MM" };
        self.block
            .line(&format!("{word} PGM {} {units}", self.program), out);
    }

    fn comment(&mut self, text: &str, out: &mut String) {
        // A tilde at the end would continue the block.
        let text = ascii(text).replace('~', "-");
        for piece in wrapped(text.trim(), REMARK_LENGTH) {
            self.block.line(format!("; {piece}").trim_end(), out);
        }
    }

    /// Lines of the user's own, a block each; one behind a tilde goes on with its block and has no number.
    fn own(&mut self, lines: &str, out: &mut String) {
        let mut goes_on = false;
        for line in lines.lines().filter(|line| !line.is_empty()) {
            if goes_on {
                out.push_str(line);
                out.push('\n');
            } else {
                self.block.line(line, out);
            }
            goes_on = line.trim_end().ends_with('~');
        }
    }

    /// The tool call that waits, with its speed if one is known, and what waited for it.
    fn call_tool(&mut self, speed: Option<f64>, out: &mut String) -> Result<(), String> {
        let Some(number) = self.tool.take() else {
            return Ok(());
        };
        self.block.word("TOOL CALL").integer("", number);
        self.block.word(self.axes.depth());
        if let Some(speed) = speed {
            self.block.number("S", speed, 0, NumberStyle::default());
        }
        self.block.end(out);
        self.speed = Modal::default();
        self.spindle_on.forget();
        self.sense = None;
        self.axes.forget();
        for held in std::mem::take(&mut self.held) {
            match held {
                Held::Preselect(number) => self.block.line(&format!("TOOL DEF {number}"), out),
                Held::Coolant(coolant) => self.cool(coolant, out)?,
            }
        }
        Ok(())
    }

    fn turn(&mut self, spindle: Spindle, out: &mut String) -> Result<(), String> {
        let (rpm, sense) = match spindle {
            Spindle::On { rpm, sense } => (rpm, sense),
            Spindle::Off => {
                self.block.line("M5", out);
                self.spindle_on.set(false);
                self.sense = None;
                return Ok(());
            }
            Spindle::Orient => {
                return Err("the oriented stop is a cycle of the machine builder's".to_owned());
            }
        };
        if self.tool.is_some() {
            self.call_tool(Some(rpm), out)?;
            self.speed.set(rpm);
        } else if self.speed.set(rpm) {
            // A tool call, even one for the speed alone, is not allowed under TCP.
            let tcp = self.tcp && !self.tcp_active.is(false);
            if tcp {
                self.own(&self.tcp_off.clone(), out);
            }
            self.block.word("TOOL CALL");
            self.block
                .number("S", rpm, 0, NumberStyle::default())
                .end(out);
            if tcp {
                self.own(&self.tcp_on.clone(), out);
            }
        }
        self.block.line(turns(sense), out);
        self.spindle_on.set(true);
        self.sense = Some(sense);
        Ok(())
    }

    /// A stop switches spindle and coolant off: both are on again before the tool moves.
    fn halt(&mut self, word: &str, out: &mut String) {
        self.block.line(word, out);
        if let Some(sense) = self.sense {
            self.block.line(turns(sense), out);
        }
        if let Some(flowing) = self.flowing {
            self.coolant_codes(flowing, out);
        }
    }

    /// What ends the coolant that is on; that of all, if it has no end of its own or nobody knows.
    fn end_coolant(&mut self, out: &mut String) {
        let flowing = self.flowing.take();
        let own = self
            .coolant_ends
            .iter()
            .find(|(coolant, _)| Some(*coolant) == flowing);
        let own = own.map_or("", |(_, codes)| codes);
        for code in own.split_whitespace() {
            self.block.line(code, out);
        }
        if own.is_empty() {
            self.coolant_codes(Coolant::Off, out);
        }
        self.coolant_on.set(false);
    }

    /// The M codes of a coolant; false if it has none.
    fn coolant_codes(&mut self, wanted: Coolant, out: &mut String) -> bool {
        let codes = self.coolant.iter().find(|(coolant, _)| *coolant == wanted);
        let codes = codes.map_or("", |(_, codes)| codes);
        for code in codes.split_whitespace() {
            self.block.line(code, out);
        }
        !codes.is_empty()
    }

    fn cool(&mut self, wanted: Coolant, out: &mut String) -> Result<(), String> {
        if wanted == Coolant::Off {
            self.end_coolant(out);
            return Ok(());
        }
        if self.flowing.is_some_and(|flowing| flowing != wanted) {
            // One coolant takes the place of another.
            self.end_coolant(out);
        }
        if !self.coolant_codes(wanted, out) {
            let name = format!("{wanted:?}").to_lowercase();
            return Err(format!(
                "the M code of the coolant `{name}` is the machine builder's: set the option \
                 `coolant_{name}`"
            ));
        }
        self.coolant_on.set(true);
        self.flowing = Some(wanted);
        Ok(())
    }

    fn rapid_group(&mut self, words: &[f64], group: Group, out: &mut String) -> Result<(), String> {
        if self.axes.moved_group(words, group) {
            self.block.word("L");
            self.axes.write_group(&mut self.block, words, group);
            self.finish_move(None, true, out)?;
        }
        Ok(())
    }

    fn approach(
        &mut self,
        words: &[f64],
        feed: Option<Feed>,
        plane_first: bool,
        out: &mut String,
    ) -> Result<(), String> {
        self.radius.forget();
        // The rotary axes have been turned; what is left of them here moves nothing else.
        self.rapid_group(words, Group::Rotary, out)?;
        if self.tcp && self.tcp_active.set(true) {
            self.own(&self.tcp_on.clone(), out);
        }
        if plane_first {
            self.rapid_group(words, Group::Plane, out)?;
        }
        if self.axes.moved(words) {
            self.block.word("L");
            self.axes.write(&mut self.block, words);
            self.finish_move(feed, true, out)?;
        }
        Ok(())
    }

    /// Radius compensation and feed, the words behind the axes. In an inch program F counts tenths of an inch,
    /// but degrees where rotary axes move alone.
    fn finish_move(
        &mut self,
        feed: Option<Feed>,
        length: bool,
        out: &mut String,
    ) -> Result<(), String> {
        if self.radius.set(self.compensation) {
            self.block.word(self.compensation);
        }
        match feed {
            None => {
                // For this block alone; the F before stays in force.
                self.block.word("FMAX");
            }
            Some(Feed::PerMinute(feed)) => {
                let (value, decimals) = match self.inch && length {
                    true => (feed * 10.0, self.feed_decimals - 1),
                    false => (feed, self.feed_decimals),
                };
                if self.feed.set(value) {
                    self.block
                        .number("F", value, decimals, NumberStyle::default());
                }
            }
            Some(other) => {
                return Err(format!("this control has no feed like {other}"));
            }
        }
        self.block.end(out);
        Ok(())
    }

    /// The tool leaves the part; the control keeps the tip no longer, as M91 asks for.
    fn leave(&mut self, axes: u32, words: &[f64], out: &mut String) {
        if self.rotary && self.tcp_active.set(false) {
            self.own(&self.tcp_off.clone(), out);
        }
        if self.retract.is_empty() {
            self.in_machine_coordinates(axes, words, out);
        } else {
            self.own(&self.retract.clone(), out);
        }
        self.axes.forget();
        self.radius.forget();
    }

    /// Axes at rapid to positions in machine coordinates, for this block alone.
    fn in_machine_coordinates(&mut self, axes: u32, words: &[f64], out: &mut String) {
        self.block.word("L");
        self.axes.write_machine(&mut self.block, axes, words);
        self.block.line("R0 FMAX M91", out);
        self.radius.forget();
    }

    /// Spindle and coolant off, unless they are.
    fn stop(&mut self, out: &mut String) {
        if self.spindle_on.set(false) {
            self.block.line("M5", out);
        }
        if !self.coolant_on.is(false) {
            self.end_coolant(out);
        }
    }

    fn end(&mut self, out: &mut String) {
        self.stop(out);
        self.block.line("M30", out);
        self.frame("END", out);
    }

    /// After a line of the user's own nothing is known to be in force.
    fn forget(&mut self) {
        self.speed.forget();
        self.feed.forget();
        self.radius.forget();
        self.axes.forget();
        self.tcp_active.forget();
        // What turns and flows was asked for all the same: a stop behind it switches that off.
        self.spindle_on.forget();
        self.coolant_on.forget();
    }
}

fn turns(sense: SpindleSense) -> &'static str {
    match sense {
        SpindleSense::Clockwise => "M3",
        SpindleSense::CounterClockwise => "M4",
    }
}

/// A name that the control takes: letters, digits, `_` and `-`, as many as it shows.
fn program_name(name: &str) -> String {
    let plain = ascii(name);
    let allowed = |letter: char| match letter {
        letter if letter.is_ascii_alphanumeric() || letter == '-' => letter.to_ascii_uppercase(),
        _ => '_',
    };
    match plain.trim() {
        "" => "PROGRAM".to_owned(),
        plain => plain.chars().take(NAME_LENGTH).map(allowed).collect(),
    }
}

export_dialect!(heidenhain, Heidenhain);

#[cfg(test)]
mod tests;
