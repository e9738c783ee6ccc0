//! Fanuc 30i, 31i: G-code with modal words, a point in every number, remarks in capitals.
//!
//! What it assumes about the control stands in `plugins/README.md`.

mod options;

use post_plugin::{
    Axes, Block, Coolant, Dialect, Event, FeedDecimals, Format, IsoMotion, Modal, NumberStyle,
    OptionSpec, Setup, Spindle, SpindleSense, Units, export_dialect, remark,
};

use crate::options::OPTIONS;

struct Fanuc {
    iso: IsoMotion,
    program: String,
    machine: String,
    number: i64,
    inch: bool,
    tcp: bool,
    work_offset: String,
    retract: String,
    home: String,
    coolant_off: String,
    coolant_through: String,
    coolant_air: String,
    /// H of the tool in use.
    register: Option<u32>,
    offset_active: Modal<bool>,
    length_active: Modal<bool>,
    retracted: Modal<bool>,
    spindle: Modal<bool>,
    coolant: Modal<bool>,
}

impl Dialect for Fanuc {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let inch = setup.units == Units::Inch;
        let style = NumberStyle {
            point: true,
            trim: !setup.flag("trailing_zeros"),
            plus: false,
        };
        let decimals = setup.integer(if inch { "decimals_inch" } else { "decimals" });
        let rotary = setup.integer("rotary_decimals");
        let axes = Axes::new(setup, decimals as u8, rotary as u8, style);
        let step = setup.integer("block_step") as u32;
        let block = match setup.flag("block_numbers") {
            true => Block::numbered("N", step, step, 99_999_999),
            false => Block::plain(),
        };
        let work_offset = setup.text("work_offset");
        if !is_work_offset(work_offset) {
            return Err(format!(
                "the work offset is `{work_offset}`, must be G54 to G59 or G54.1 P1 to P300"
            ));
        }
        let retract = match setup.text("retract") {
            "" => {
                let words: Vec<String> = axes.depths().map(|name| format!("{name}0.")).collect();
                format!("G91 G28 {}", words.join(" "))
            }
            given => given.to_owned(),
        };
        let feeds = FeedDecimals {
            per_minute: setup.integer("feed_decimals") as u8 + u8::from(inch),
            inverse_time: setup.integer("inverse_time_decimals") as u8,
            per_revolution: 4,
        };
        let register = setup.integer("length_register") as u32;
        Ok(Fanuc {
            iso: IsoMotion::new(block, axes, feeds),
            program: setup.program.to_owned(),
            machine: setup.machine.to_owned(),
            number: setup.integer("program_number"),
            inch,
            tcp: setup.tcp,
            work_offset: work_offset.to_owned(),
            retract,
            home: setup.text("home").to_owned(),
            coolant_off: setup.text("coolant_off").to_owned(),
            coolant_through: setup.text("coolant_through").to_owned(),
            coolant_air: setup.text("coolant_air").to_owned(),
            register: (register != 0).then_some(register),
            offset_active: Modal::default(),
            length_active: Modal::default(),
            retracted: Modal::default(),
            spindle: Modal::default(),
            coolant: Modal::default(),
        })
    }

    fn format(&self) -> Format {
        self.iso.format("nc")
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        match *event {
            Event::Start => self.start(out),
            Event::Comment { text } => push_line(out, &remark(text)),
            Event::Literal { text } => {
                push_line(out, text);
                self.forget();
            }
            Event::Word { text } => push_line(out, text),
            Event::ToolChange {
                number,
                register,
                name,
                ..
            } => {
                self.clear(out);
                if self.spindle.is(true) {
                    self.iso.line("M5", out);
                }
                if !name.is_empty() {
                    push_line(out, &remark(&format!("T{number} {name}")));
                }
                self.iso.line(&format!("T{number} M6"), out);
                // The changer may have moved any axis.
                self.iso.moved_by_line();
                self.iso.forget_feed();
                self.register = Some(register);
                self.offset_active.forget();
                self.spindle.forget();
            }
            Event::Preselect { number } => self.iso.line(&format!("T{number}"), out),
            Event::Spindle(spindle) => self.turn(spindle, out),
            Event::Coolant(coolant) => self.cool(coolant, out)?,
            Event::Compensate(compensation) => self.iso.compensate(compensation),
            Event::Position { words, feed, .. } => {
                let register = self.register.ok_or(
                    "no tool was loaded, so the length register is not known: load one, or set the \
                     option `length_register`",
                )?;
                if self.offset_active.set(true) {
                    self.iso.line(&self.work_offset, out);
                }
                let word = if self.tcp { "G43.4" } else { "G43" };
                self.iso
                    .approach(words, feed, &format!("{word} H{register}"), self.tcp, out);
                self.length_active.set(true);
                self.retracted.forget();
            }
            Event::Release => self.release(out),
            Event::Rapid { words, .. } => self.iso.rapid(words, out),
            Event::Linear { words, feed, .. } => self.iso.cut(words, feed, out),
            // In ms, without a point. A dwell too short to be written waits the least.
            Event::Dwell { seconds } => {
                let ms = (seconds * 1000.0).round().max(1.0);
                self.iso.block.word("G4");
                self.iso.block.number("P", ms, 0, NumberStyle::default());
                self.iso.block.end(out);
            }
            Event::Stop => self.iso.line("M0", out),
            Event::OptionalStop => self.iso.line("M1", out),
            Event::Home => self.go_home(out),
            Event::End => self.end(out),
            other => return Err(other.refusal()),
        }
        Ok(())
    }
}

impl Fanuc {
    fn start(&mut self, out: &mut String) {
        push_line(out, "%");
        push_line(
            out,
            &format!("O{:04} {}", self.number, remark(&self.program)),
        );
        if !self.machine.is_empty() {
            push_line(out, &remark(&self.machine));
        }
        let units = if self.inch { "G20" } else { "G21" };
        self.iso
            .line(&format!("{units} G17 G40 G49 G80 G90 G94"), out);
        self.length_active.set(false);
        self.iso.feeds_per_minute();
    }

    /// One M in a block, as the control's default has it.
    fn codes(&mut self, codes: &str, out: &mut String) {
        for code in codes.split_whitespace() {
            self.iso.line(code, out);
        }
    }

    fn turn(&mut self, spindle: Spindle, out: &mut String) {
        self.spindle.set(matches!(spindle, Spindle::On { .. }));
        match spindle {
            Spindle::Off => self.iso.line("M5", out),
            Spindle::Orient => self.iso.line("M19", out),
            Spindle::On { rpm, sense } => {
                let block = &mut self.iso.block;
                block.number("S", rpm, 0, NumberStyle::default());
                block.word(match sense {
                    SpindleSense::Clockwise => "M3",
                    SpindleSense::CounterClockwise => "M4",
                });
                block.end(out);
            }
        }
    }

    fn cool(&mut self, coolant: Coolant, out: &mut String) -> Result<(), String> {
        let (codes, option) = match coolant {
            Coolant::Off => (self.coolant_off.clone(), "coolant_off"),
            Coolant::Flood => ("M8".to_owned(), ""),
            Coolant::Mist => ("M7".to_owned(), ""),
            Coolant::Through => (self.coolant_through.clone(), "coolant_through"),
            Coolant::Air => (self.coolant_air.clone(), "coolant_air"),
        };
        if codes.is_empty() {
            return Err(format!(
                "the M code of this coolant is the machine builder's: set the option `{option}`"
            ));
        }
        self.coolant.set(coolant != Coolant::Off);
        self.codes(&codes, out);
        Ok(())
    }

    /// Ends length compensation, or tool centre point control.
    fn release(&mut self, out: &mut String) {
        self.iso.settle(out);
        if self.length_active.set(false) {
            self.iso.line("G49", out);
        }
        self.iso.axes.forget();
    }

    /// The depth axis to its reference, unless it stands there.
    fn clear(&mut self, out: &mut String) {
        self.iso.settle(out);
        if !self.length_active.is(false) {
            self.release(out);
        }
        if self.retracted.set(true) {
            self.iso.line(&self.retract, out);
            self.iso.line("G90", out);
            self.iso.moved_by_line();
        }
    }

    /// Spindle and coolant off, unless they are.
    fn stop(&mut self, out: &mut String) {
        if self.spindle.set(false) {
            self.iso.line("M5", out);
        }
        if self.coolant.set(false) {
            self.codes(&self.coolant_off.clone(), out);
        }
    }

    fn go_home(&mut self, out: &mut String) {
        self.clear(out);
        if !self.home.is_empty() {
            self.iso.line(&self.home, out);
            self.iso.line("G90", out);
            self.iso.moved_by_line();
        }
    }

    fn end(&mut self, out: &mut String) {
        // The tool leaves the part first: a spindle that stops in it tears.
        self.clear(out);
        self.stop(out);
        self.go_home(out);
        self.iso.line("M30", out);
        push_line(out, "%");
    }

    /// After a line of the user's own nothing is known to be in force.
    fn forget(&mut self) {
        self.iso.forget();
        self.offset_active.forget();
        self.length_active.forget();
        self.retracted.forget();
        self.spindle.forget();
        self.coolant.forget();
    }
}

fn push_line(out: &mut String, line: &str) {
    out.push_str(line);
    out.push('\n');
}

fn is_work_offset(text: &str) -> bool {
    let number = |digits: &str| digits.parse().unwrap_or(0);
    match text.strip_prefix("G54.1 P") {
        Some(digits) => (1..=300).contains(&number(digits)),
        None => text
            .strip_prefix('G')
            .is_some_and(|digits| (54..=59).contains(&number(digits))),
    }
}

export_dialect!(fanuc, Fanuc);

#[cfg(test)]
mod tests;
