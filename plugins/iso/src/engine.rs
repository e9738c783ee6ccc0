//! Writes a program by a [`Table`].

use post_plugin::{
    Axes, Block, Compensation, Coolant, Event, Feed, Format, Modal, NumberStyle, Setup, Spindle,
    SpindleSense, Units,
};

use crate::lines::{fits, program_name, remark_lines};
use crate::options::{flag, integer, text};
use crate::table::{Dwell, Step, Table, Tcp};
use crate::{FeedDecimals, Motion};

/// Most decimals of a number with a point where the option of it is not offered.
const DECIMALS: [i64; 3] = [3, 4, 3];

/// A program on its way out: what is in force, and the words that a table and the options give.
#[derive(Debug)]
pub struct Engine {
    table: &'static Table,
    /// Moves, with the block under construction.
    pub motion: Motion,
    program: String,
    machine: String,
    percent: bool,
    inch: bool,
    tcp: bool,
    work_offset: String,
    retract: String,
    home: String,
    tcp_on: String,
    tcp_off: String,
    coolant_codes: [String; 5],
    /// Of the tool in use.
    register: Option<u32>,
    offset_active: Modal<bool>,
    length_active: Modal<bool>,
    retracted: Modal<bool>,
    spindle: Modal<bool>,
    coolant: Modal<bool>,
}

/// Coolants in the order of [`Table::coolant`], with their options.
const COOLANTS: [(Coolant, &str); 5] = [
    (Coolant::Off, "coolant_off"),
    (Coolant::Flood, "coolant_flood"),
    (Coolant::Mist, "coolant_mist"),
    (Coolant::Through, "coolant_through"),
    (Coolant::Air, "coolant_air"),
];

impl Engine {
    pub(crate) fn new(table: &'static Table, setup: &Setup<'_>) -> Result<Self, String> {
        if setup.tcp && matches!(table.tcp, Tcp::None) {
            return Err("this control has no tool centre point control: tcp = \"post\"".to_owned());
        }
        table.axes.check(setup)?;
        let inch = setup.units == Units::Inch;
        let style = NumberStyle {
            point: true,
            trim: !flag(setup, "trailing_zeros", !table.trim),
            plus: false,
        };
        let [linear_mm, linear_inch, rotary] = DECIMALS;
        let linear = match inch {
            true => integer(setup, "decimals_inch", linear_inch),
            false => integer(setup, "decimals", linear_mm),
        };
        let rotary = integer(setup, "rotary_decimals", rotary);
        let axes = Axes::new(setup, linear as u8, rotary as u8, style);
        let step = integer(setup, "block_step", 10) as u32;
        let block = match flag(setup, "block_numbers", false) {
            true => Block::numbered("N", step, step, table.largest_number),
            false => Block::plain(),
        };
        let work_offset = text(setup, "work_offset", "G54");
        if !(table.offset.known)(&work_offset) {
            let range = table.offset.range;
            return Err(format!(
                "the work offset is `{work_offset}`, must be {range}"
            ));
        }
        let retract = match text(setup, "retract", "") {
            given if given.is_empty() => {
                let words: Vec<String> = axes.depths().map(|name| format!("{name}0.")).collect();
                format!("{} {}", table.retract.words, words.join(" "))
            }
            given => given,
        };
        let feeds = FeedDecimals {
            per_minute: integer(setup, "feed_decimals", 1) as u8 + u8::from(inch),
            inverse_time: integer(setup, "inverse_time_decimals", 3) as u8,
            per_revolution: table.per_revolution,
        };
        let (tcp_on, tcp_off) = match table.tcp {
            Tcp::Blocks { on, off, .. } => (on, off),
            Tcp::None | Tcp::Length(_) => ("", ""),
        };
        let register = integer(setup, "length_register", 0) as u32;
        let mut coolant = table.coolant.iter();
        Ok(Engine {
            table,
            motion: Motion::new(&table.codes, block, axes, feeds),
            program: program_name(table, setup.program),
            machine: setup.machine.to_owned(),
            percent: flag(setup, "percent", table.percent),
            inch,
            tcp: setup.tcp,
            work_offset,
            retract,
            home: text(setup, "home", ""),
            tcp_on: text(setup, "tcp_on", tcp_on),
            tcp_off: text(setup, "tcp_off", tcp_off),
            coolant_codes: COOLANTS
                .map(|(_, option)| text(setup, option, coolant.next().unwrap_or(&""))),
            register: (register != 0).then_some(register),
            offset_active: Modal::default(),
            length_active: Modal::default(),
            retracted: Modal::default(),
            spindle: Modal::default(),
            coolant: Modal::default(),
        })
    }

    pub(crate) fn format(&self) -> Format {
        self.motion.format(self.table.extension)
    }

    /// Name of the program.
    pub fn program(&self) -> &str {
        &self.program
    }

    /// A block of these words, or of each line of them; none for no words.
    pub fn line(&mut self, words: &str, out: &mut String) {
        self.motion.line(words, out);
    }

    /// A line that is no block.
    pub fn bare(&self, line: &str, out: &mut String) {
        out.push_str(line);
        out.push('\n');
    }

    /// A remark in a line of its own, or in as many as it needs.
    pub fn remark(&self, text: &str, out: &mut String) {
        for line in remark_lines(self.table, text) {
            self.bare(&line, out);
        }
    }

    pub(crate) fn start(&mut self, title: &str, out: &mut String) {
        if self.percent {
            self.bare("%", out);
        }
        if !title.is_empty() {
            self.bare(title, out);
        }
        if !self.machine.is_empty() {
            self.remark(&self.machine, out);
        }
        let units = self.table.codes.units[usize::from(self.inch)];
        let mut safe = format!("{units} {}", self.table.safe);
        if self.table.offset.at_start {
            safe.push(' ');
            safe.push_str(&self.work_offset);
            self.offset_active.set(true);
        }
        self.line(&safe, out);
        self.length_active.set(false);
        self.motion.feeds_per_minute();
    }

    /// Writes any event but the program's start.
    ///
    /// # Errors
    /// A sentence for the user.
    #[inline]
    pub fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        match *event {
            Event::Rapid { words, .. } => self.motion.rapid(words, out),
            Event::Linear { words, feed, .. } if self.motion.has(feed) => {
                self.motion.cut(words, feed, out);
            }
            _ => return self.command(event, out),
        }
        Ok(())
    }

    fn command(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        let codes = &self.table.codes;
        match *event {
            Event::Linear { feed, .. }
            | Event::Position {
                feed: Some(feed), ..
            } if !self.motion.has(feed) => {
                return Err(format!("this control has no feed like {feed:?}"));
            }
            Event::Compensate(Compensation::Left { .. } | Compensation::Right { .. })
                if codes.compensation[1].is_empty() =>
            {
                return Err(event.refusal());
            }
            Event::Comment { text } => self.remark(text, out),
            Event::Literal { text } => {
                fits(self.table, text)?;
                self.line(text, out);
                self.forget();
            }
            Event::Word { text } => {
                fits(self.table, text)?;
                self.line(text, out);
            }
            Event::ToolChange {
                number,
                register,
                name,
                ..
            } => self.change(number, register, name, out),
            Event::Preselect { number } => self.line(&format!("T{number}"), out),
            Event::Spindle(spindle) => self.turn(spindle, out)?,
            Event::Coolant(coolant) => self.cool(coolant, out)?,
            Event::Compensate(compensation) => self.motion.compensate(compensation),
            Event::Position { words, feed, .. } => self.position(words, feed, out)?,
            Event::Release => self.release(out),
            Event::Dwell { seconds } => self.dwell(seconds, out),
            Event::Stop => self.line(codes.stop[0], out),
            Event::OptionalStop => self.line(codes.stop[1], out),
            Event::Home => self.go_home(out),
            Event::End => self.end(out),
            ref other => return Err(other.refusal()),
        }
        Ok(())
    }

    fn change(&mut self, number: u32, register: u32, name: &str, out: &mut String) {
        self.clear(out);
        if self.spindle.is(true) {
            self.line(self.table.spindle[2], out);
        }
        if !name.is_empty() {
            self.remark(&format!("T{number} {name}"), out);
        }
        let change = format!("T{number} {}", self.table.change);
        self.line(change.trim_end(), out);
        // The changer may have moved any axis.
        self.motion.moved_by_line();
        self.motion.forget_feed();
        self.register = Some(register);
        if !self.table.offset.at_start {
            self.offset_active.forget();
        }
        self.spindle.forget();
    }

    fn turn(&mut self, spindle: Spindle, out: &mut String) -> Result<(), String> {
        let [clockwise, counter, off, orient] = self.table.spindle;
        self.spindle.set(matches!(spindle, Spindle::On { .. }));
        match spindle {
            Spindle::Off => self.line(off, out),
            Spindle::Orient if orient.is_empty() => {
                return Err("this dialect has no words for an oriented stop".to_owned());
            }
            Spindle::Orient => self.line(orient, out),
            Spindle::On { rpm, sense } => {
                let block = &mut self.motion.block;
                block.number("S", rpm, 0, NumberStyle::default());
                block.word(match sense {
                    SpindleSense::Clockwise => clockwise,
                    SpindleSense::CounterClockwise => counter,
                });
                block.end(out);
            }
        }
        Ok(())
    }

    fn cool(&mut self, coolant: Coolant, out: &mut String) -> Result<(), String> {
        let place = COOLANTS.iter().position(|(known, _)| *known == coolant);
        let place = place.unwrap_or_default();
        if self.coolant_codes[place].is_empty() {
            let option = COOLANTS[place].1;
            let offered = self.table.options.iter().any(|spec| spec.key == option);
            return Err(match offered {
                true => format!(
                    "the M code of this coolant is the machine builder's: set the option `{option}`"
                ),
                false => "this control has no such coolant".to_owned(),
            });
        }
        self.coolant.set(coolant != Coolant::Off);
        self.codes(place, out);
        Ok(())
    }

    /// One M in a block, as most controls have it by default.
    fn codes(&mut self, coolant: usize, out: &mut String) {
        for code in self.coolant_codes[coolant].split_whitespace() {
            self.motion.line(code, out);
        }
    }

    fn position(
        &mut self,
        words: &[f64],
        feed: Option<Feed>,
        out: &mut String,
    ) -> Result<(), String> {
        let length = self.length()?;
        if self.offset_active.set(true) && !self.table.offset.at_start {
            self.motion.line(&self.work_offset, out);
        }
        if !self.tcp {
            self.motion.turn_first(words, out);
            self.motion.plane_next(words, out);
            self.motion.arrive(words, feed, &length, out);
        } else if let Tcp::Blocks { approach, .. } = self.table.tcp {
            for step in approach {
                match step {
                    Step::Turn => self.motion.turn_first(words, out),
                    Step::Length => self.motion.line(&length, out),
                    Step::Tcp => self.motion.line(&self.tcp_on, out),
                }
            }
            let last = match approach.contains(&Step::Length) {
                true => "",
                false => &length,
            };
            self.motion.arrive(words, feed, last, out);
        } else {
            self.motion.turn_first(words, out);
            self.motion.arrive(words, feed, &length, out);
        }
        self.length_active.set(true);
        self.retracted.forget();
        Ok(())
    }

    /// The words that put the length in force.
    fn length(&self) -> Result<String, String> {
        let length = &self.table.length;
        let on = match self.table.tcp {
            Tcp::Length(word) if self.tcp => word,
            _ => length.on,
        };
        match self.register {
            _ if on.is_empty() => Ok(String::new()),
            Some(register) => Ok(format!("{on} {}{register}", length.register)),
            None if length.by_itself => Ok(on.to_owned()),
            None => Err(
                "no tool was loaded, so the length register is not known: load one, or set the \
                 option `length_register`"
                    .to_owned(),
            ),
        }
    }

    fn dwell(&mut self, seconds: f64, out: &mut String) {
        let (address, value, decimals) = match self.table.dwell {
            // A dwell too short to be written waits the least.
            Dwell::Milliseconds(address) => (address, (seconds * 1000.0).round().max(1.0), 0),
            Dwell::Seconds(address, decimals) => (address, seconds, decimals),
        };
        let block = &mut self.motion.block;
        block.word("G4");
        block.number(address, value, decimals, NumberStyle::default());
        block.end(out);
    }

    /// Ends length compensation and tool centre point control.
    pub fn release(&mut self, out: &mut String) {
        self.motion.settle(out);
        if self.length_active.set(false) {
            let steps = match self.table.tcp {
                Tcp::Blocks { release, .. } if self.tcp => release,
                _ => &[Step::Length],
            };
            for step in steps {
                match step {
                    Step::Length => self.motion.line(self.table.length.off, out),
                    Step::Tcp => self.motion.line(&self.tcp_off, out),
                    Step::Turn => {}
                }
            }
        }
        self.motion.axes.forget();
    }

    /// The depth axis to its reference, unless it stands there.
    pub fn clear(&mut self, out: &mut String) {
        self.motion.settle(out);
        if !self.length_active.is(false) {
            self.release(out);
        }
        if self.retracted.set(true) {
            self.motion.line(&self.retract, out);
            self.after_retract(out);
        }
    }

    fn after_retract(&mut self, out: &mut String) {
        self.line(self.table.retract.after, out);
        self.motion.moved_by_line();
    }

    /// Spindle and coolant off, unless they are.
    fn stop(&mut self, out: &mut String) {
        if self.spindle.set(false) {
            self.line(self.table.spindle[2], out);
        }
        if self.coolant.set(false) {
            self.codes(0, out);
        }
    }

    fn go_home(&mut self, out: &mut String) {
        self.clear(out);
        if !self.home.is_empty() {
            self.motion.line(&self.home, out);
            self.after_retract(out);
        }
    }

    fn end(&mut self, out: &mut String) {
        // The tool leaves the part first: a spindle that stops in it tears.
        self.clear(out);
        self.stop(out);
        self.go_home(out);
        self.line(self.table.end, out);
        if self.percent {
            self.bare("%", out);
        }
    }

    /// After a line of the user's own nothing is known to be in force.
    pub fn forget(&mut self) {
        self.motion.forget();
        self.offset_active.forget();
        self.length_active.forget();
        self.retracted.forget();
        self.spindle.forget();
        self.coolant.forget();
    }
}
