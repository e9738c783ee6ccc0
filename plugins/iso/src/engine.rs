//! Writes a program by a [`Table`].

use post_plugin::{
    Axes, Block, Compensation, Coolant, Event, Feed, Format, Modal, NumberStyle, Setup, Spindle,
    SpindleSense, Units, Value,
};

use crate::lines::{fits, program_name, remark_lines};
use crate::options::{flag, integer, text};
use crate::table::{Dwell, Leave, Table, Tcp};
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
    /// The parameters that it relies on are written as remarks.
    parameters: bool,
    inch: bool,
    tcp: bool,
    work_offset: String,
    cancel: String,
    /// In the place of a retract in machine coordinates; empty: none.
    retract: String,
    tcp_on: String,
    /// Empty: nothing is written about it.
    tcp_off: String,
    most_inverse_time: Option<f64>,
    coolant_codes: [String; 5],
    /// What ends each of them.
    coolant_ends: [String; 5],
    /// Of the tool in use.
    register: Option<u32>,
    offset_active: Modal<bool>,
    /// A line of the user's own has named a work offset: which one is in force is the user's from there on.
    own_offset: bool,
    length_active: Modal<bool>,
    tcp_active: Modal<bool>,
    /// The spindle's last command, if that has it turning.
    turning: Option<Spindle>,
    spindle: Modal<bool>,
    coolant: Modal<bool>,
    /// The coolant that is on: its place in [`COOLANTS`].
    flowing: Option<usize>,
}

/// Coolants in the order of [`Table::coolant`], with the options that say what switches them on and off.
const COOLANTS: [(Coolant, &str, &str); 5] = [
    (Coolant::Off, "coolant_off", "coolant_off"),
    (Coolant::Flood, "coolant_flood", "coolant_off"),
    (Coolant::Mist, "coolant_mist", "coolant_mist_off"),
    (Coolant::Through, "coolant_through", "coolant_through_off"),
    (Coolant::Air, "coolant_air", "coolant_air_off"),
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
        let feeds = FeedDecimals {
            per_minute: integer(setup, "feed_decimals", 1) as u8 + u8::from(inch),
            inverse_time: integer(setup, "inverse_time_decimals", 3) as u8,
            per_revolution: table.per_revolution,
        };
        let (tcp_on, tcp_off) = match table.tcp {
            Tcp::Blocks { on, off, .. } => (on, off),
            Tcp::None | Tcp::Length(_) => ("", ""),
        };
        // Where the post keeps the tip, the words may not exist: only a machine file that names them has them written.
        let tcp_off = match text(setup, "tcp_off", "") {
            given if given.is_empty() && setup.tcp => tcp_off.to_owned(),
            given => given,
        };
        let register = integer(setup, "length_register", 0) as u32;
        let mut coolant = table.coolant.iter();
        let coolant_codes =
            COOLANTS.map(|(_, option, _)| text(setup, option, coolant.next().unwrap_or(&"")));
        let coolant_ends = COOLANTS.map(|(_, _, option)| match text(setup, option, "") {
            end if end.is_empty() => coolant_codes[0].clone(),
            end => end,
        });
        Ok(Engine {
            table,
            motion: Motion::new(&table.codes, block, axes, feeds),
            program: program_name(table, setup.program),
            machine: setup.machine.to_owned(),
            percent: flag(setup, "percent", table.percent),
            parameters: flag(setup, "parameters", false),
            inch,
            tcp: setup.tcp,
            work_offset,
            cancel: text(setup, "cancel", table.cancel),
            retract: text(setup, "retract", ""),
            tcp_on: text(setup, "tcp_on", tcp_on),
            tcp_off,
            most_inverse_time: match setup.option("most_inverse_time") {
                Some(Value::Number(most)) if most > 0.0 => Some(most),
                _ => None,
            },
            coolant_codes,
            coolant_ends,
            register: (register != 0).then_some(register),
            offset_active: Modal::default(),
            own_offset: false,
            length_active: Modal::default(),
            tcp_active: Modal::default(),
            turning: None,
            spindle: Modal::default(),
            coolant: Modal::default(),
            flowing: None,
        })
    }

    pub(crate) fn format(&self) -> Format {
        Format {
            most_inverse_time: self.most_inverse_time,
            ..self.motion.format(self.table.extension)
        }
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
        if self.parameters {
            for sentence in self.table.relies {
                self.remark(sentence, out);
            }
        }
        self.line(self.table.codes.units[usize::from(self.inch)], out);
        let mut safe = self.table.safe.to_owned();
        if self.table.offset.at_start {
            safe.push(' ');
            safe.push_str(&self.work_offset);
            self.offset_active.set(true);
        }
        self.line(&safe, out);
        let cancel = std::mem::take(&mut self.cancel);
        self.line(&cancel, out);
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
                return Err(format!("this control has no feed like {feed}"));
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
                self.own_offset |= names_offset(self.table, text);
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
            } => self.change(number, &format!("T{number}"), register, name, out),
            Event::Preselect { number } => self.line(&format!("T{number}"), out),
            Event::Spindle(spindle) => self.turn(spindle, out)?,
            Event::Coolant(coolant) => self.cool(coolant, out)?,
            Event::Compensate(compensation) => self.motion.compensate(compensation),
            Event::Turn { words } => {
                self.work_offset(out);
                self.motion.turn(words, out);
            }
            Event::Position {
                words,
                feed,
                plane_first,
                ..
            } => self.position(words, feed, plane_first, out)?,
            Event::Retract { axes, words } => self.leave(axes, words, out),
            Event::Park { axes, words } => {
                self.motion.machine(self.table.machine, axes, words, out);
            }
            Event::Dwell { seconds } => self.dwell(seconds, out),
            Event::Stop => self.stop(codes.stop[0], out)?,
            Event::OptionalStop => self.stop(codes.stop[1], out)?,
            Event::End => self.end(out),
            ref other => return Err(other.refusal()),
        }
        Ok(())
    }

    /// Changes to a tool that is called by `call` (`T1`).
    pub fn change(
        &mut self,
        number: u32,
        call: &str,
        register: u32,
        name: &str,
        out: &mut String,
    ) {
        self.motion.settle(out);
        if !name.is_empty() {
            self.remark(&format!("T{number} {name}"), out);
        }
        let change = format!("{call} {}", self.table.change);
        self.line(change.trim_end(), out);
        // The changer may have moved any axis.
        self.motion.moved_by_line();
        self.motion.forget_feed();
        self.register = Some(register);
        if !self.table.offset.at_start {
            self.offset_active.forget();
        }
        self.turning = None;
        self.spindle.forget();
    }

    fn turn(&mut self, spindle: Spindle, out: &mut String) -> Result<(), String> {
        let [clockwise, counter, off, orient] = self.table.spindle;
        let on = matches!(spindle, Spindle::On { .. });
        self.spindle.set(on);
        self.turning = on.then_some(spindle);
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
        let known = COOLANTS.iter().position(|(known, ..)| *known == coolant);
        let place = known.unwrap_or_default();
        if coolant == Coolant::Off {
            self.end_coolant(out);
            return Ok(());
        }
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
        if self.flowing.is_some_and(|flowing| flowing != place) {
            // One coolant takes the place of another.
            self.end_coolant(out);
        }
        self.coolant.set(true);
        self.flowing = Some(place);
        one_by_one(&self.coolant_codes[place], &mut self.motion, out);
        Ok(())
    }

    /// What ends the coolant that is on; where nobody knows, all of them.
    fn end_coolant(&mut self, out: &mut String) {
        let flowing = self.flowing.take().unwrap_or_default();
        one_by_one(&self.coolant_ends[flowing], &mut self.motion, out);
        self.coolant.set(false);
    }

    /// A stop, and behind it what it has switched off, before the tool moves on.
    fn stop(&mut self, word: &str, out: &mut String) -> Result<(), String> {
        self.line(word, out);
        if let (true, Some(spindle)) = (self.table.stops.spindle, self.turning) {
            self.turn(spindle, out)?;
        }
        if let (true, Some(flowing)) = (self.table.stops.coolant, self.flowing) {
            one_by_one(&self.coolant_codes[flowing], &mut self.motion, out);
        }
        Ok(())
    }

    fn work_offset(&mut self, out: &mut String) {
        if self.own_offset {
            return;
        }
        if self.offset_active.set(true) && !self.table.offset.at_start {
            self.motion.line(&self.work_offset, out);
        }
    }

    fn position(
        &mut self,
        words: &[f64],
        feed: Option<Feed>,
        plane_first: bool,
        out: &mut String,
    ) -> Result<(), String> {
        let mut length = self.length()?;
        self.work_offset(out);
        // The rotary axes have been turned; what is left of them here moves nothing else.
        self.motion.turn(words, out);
        if plane_first {
            self.motion.plane(words, out);
        }
        if let (true, Tcp::Blocks { length_first, .. }) = (self.tcp, self.table.tcp) {
            if length_first {
                self.motion.line(&std::mem::take(&mut length), out);
            }
            self.motion.line(&self.tcp_on, out);
            self.tcp_active.set(true);
        }
        self.motion.arrive(words, feed, &length, out);
        self.length_active.set(true);
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

    /// The tool leaves the part, and what was in force is cancelled, in the order of the table.
    fn leave(&mut self, axes: u32, words: &[f64], out: &mut String) {
        self.motion.settle(out);
        for step in self.table.leave {
            match step {
                Leave::Retract if self.retract.is_empty() => {
                    self.motion.machine(self.table.machine, axes, words, out);
                }
                Leave::Retract => {
                    self.motion.line(&self.retract, out);
                    if counts_on(&self.retract) {
                        self.motion.line("G90", out);
                    }
                    self.motion.moved_by_line();
                }
                Leave::Length => {
                    if self.length_active.set(false) {
                        self.motion.line(self.table.length.off, out);
                    }
                }
                Leave::Tcp => {
                    if self.tcp_active.set(false) {
                        self.motion.line(&self.tcp_off, out);
                    }
                }
            }
        }
        self.motion.axes.forget();
    }

    fn end(&mut self, out: &mut String) {
        self.motion.settle(out);
        if self.spindle.set(false) {
            self.line(self.table.spindle[2], out);
        }
        if !self.coolant.is(false) {
            self.end_coolant(out);
        }
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
        self.tcp_active.forget();
        // What turns and flows was asked for all the same: a stop behind it switches that off.
        self.spindle.forget();
        self.coolant.forget();
    }
}

/// Own lines that end with counting from where the tool stands (`G91 G28 Z0.`) leave that in force.
fn counts_on(lines: &str) -> bool {
    let mut words = lines.split_whitespace().rev();
    words.find(|word| ["G90", "G91"].contains(word)) == Some("G91")
}

/// A line names a work offset: alone, or with the number behind it (`G54.1 P12`).
fn names_offset(table: &Table, line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().collect();
    (0..words.len()).any(|at| {
        let next = words
            .get(at + 1)
            .map(|next| format!("{} {next}", words[at]));
        (table.offset.known)(words[at]) || next.is_some_and(|pair| (table.offset.known)(&pair))
    })
}

/// One M in a block, as most controls have it by default.
fn one_by_one(codes: &str, motion: &mut Motion, out: &mut String) {
    for code in codes.split_whitespace() {
        motion.line(code, out);
    }
}
