//! LinuxCNC: G-code with modal words, remarks in parentheses.
//!
//! What it assumes about the control stands in `plugins/README.md`.

mod options;

use post_plugin::{
    Axes, Block, Coolant, Dialect, Event, FeedDecimals, Format, IsoMotion, Modal, NumberStyle,
    OptionSpec, Setup, Spindle, SpindleSense, Units, export_dialect, remark,
};

use crate::options::OPTIONS;

struct LinuxCnc {
    iso: IsoMotion,
    program: String,
    machine: String,
    percent: bool,
    inch: bool,
    tcp: bool,
    work_offset: String,
    blend: f64,
    retract: String,
    home: String,
    tcp_on: String,
    tcp_off: String,
    coolant_through: String,
    coolant_air: String,
    /// H of the tool in use; without one, G43 takes that of the tool in the spindle.
    register: Option<u32>,
    length_active: Modal<bool>,
    retracted: Modal<bool>,
    spindle: Modal<bool>,
    coolant: Modal<bool>,
}

impl Dialect for LinuxCnc {
    fn options() -> &'static [OptionSpec] {
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        if let Some(word) = setup.words.iter().find(|word| word.wrapped) {
            return Err(format!(
                "{} has a range, but LinuxCNC takes the sign of a wrapped rotary word for its direction: leave the range out, its words are endless",
                word.name
            ));
        }
        let inch = setup.units == Units::Inch;
        let style = NumberStyle {
            point: true,
            ..NumberStyle::default()
        };
        let decimals = setup.integer(if inch { "decimals_inch" } else { "decimals" });
        let rotary = setup.integer("rotary_decimals");
        let axes = Axes::new(setup, decimals as u8, rotary as u8, style);
        let step = setup.integer("block_step") as u32;
        let block = match setup.flag("block_numbers") {
            true => Block::numbered("N", step, step, 99_999),
            false => Block::plain(),
        };
        let work_offset = setup.text("work_offset");
        if !matches!(
            work_offset,
            "G54" | "G55" | "G56" | "G57" | "G58" | "G59" | "G59.1" | "G59.2" | "G59.3"
        ) {
            return Err(format!(
                "the work offset is `{work_offset}`, must be G54 to G59 or G59.1 to G59.3"
            ));
        }
        let retract = match setup.text("retract") {
            "" => {
                let words: Vec<String> = axes.depths().map(|name| format!("{name}0.")).collect();
                format!("G53 G0 {}", words.join(" "))
            }
            given => given.to_owned(),
        };
        let feeds = FeedDecimals {
            per_minute: setup.integer("feed_decimals") as u8 + u8::from(inch),
            inverse_time: setup.integer("inverse_time_decimals") as u8,
            per_revolution: 4,
        };
        Ok(LinuxCnc {
            iso: IsoMotion::new(block, axes, feeds),
            program: setup.program.to_owned(),
            machine: setup.machine.to_owned(),
            percent: setup.flag("percent"),
            inch,
            tcp: setup.tcp,
            work_offset: work_offset.to_owned(),
            blend: setup.number("blend"),
            retract,
            home: setup.text("home").to_owned(),
            tcp_on: setup.text("tcp_on").to_owned(),
            tcp_off: setup.text("tcp_off").to_owned(),
            coolant_through: setup.text("coolant_through").to_owned(),
            coolant_air: setup.text("coolant_air").to_owned(),
            register: None,
            length_active: Modal::default(),
            retracted: Modal::default(),
            spindle: Modal::default(),
            coolant: Modal::default(),
        })
    }

    fn format(&self) -> Format {
        self.iso.format("ngc")
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        match *event {
            Event::Start => self.start(out),
            Event::Comment { text } => push_line(out, &passive(text)),
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
                    push_line(out, &passive(&format!("T{number} {name}")));
                }
                self.iso.line(&format!("T{number} M6"), out);
                // The changer may have moved any axis.
                self.iso.moved_by_line();
                self.iso.forget_feed();
                self.register = Some(register);
                self.spindle.forget();
            }
            Event::Preselect { number } => self.iso.line(&format!("T{number}"), out),
            Event::Spindle(spindle) => self.turn(spindle, out),
            Event::Coolant(coolant) => self.cool(coolant, out)?,
            Event::Compensate(compensation) => self.iso.compensate(compensation),
            Event::Position { words, feed, .. } => {
                let length = match self.register {
                    Some(register) => format!("G43 H{register}"),
                    None => "G43".to_owned(),
                };
                if self.tcp {
                    self.iso.turn_first(words, out);
                    self.iso.line(&self.tcp_on, out);
                }
                self.iso.approach(words, feed, &length, self.tcp, out);
                self.length_active.set(true);
                self.retracted.forget();
            }
            Event::Release => self.release(out),
            Event::Rapid { words, .. } => self.iso.rapid(words, out),
            Event::Linear { words, feed, .. } => self.iso.cut(words, feed, out),
            Event::Dwell { seconds } => {
                self.iso.block.word("G4");
                self.iso
                    .block
                    .number("P", seconds, 3, NumberStyle::default());
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

impl LinuxCnc {
    fn start(&mut self, out: &mut String) {
        if self.percent {
            push_line(out, "%");
        }
        for name in [&self.program, &self.machine] {
            if !name.is_empty() {
                push_line(out, &passive(name));
            }
        }
        let units = if self.inch { "G20" } else { "G21" };
        let safe = format!("{units} G17 G40 G49 G80 G90 G94 {}", self.work_offset);
        self.iso.line(&safe, out);
        if self.blend > 0.0 {
            self.iso.block.word("G64");
            let style = NumberStyle {
                trim: true,
                ..NumberStyle::default()
            };
            self.iso.block.number("P", self.blend, 6, style).end(out);
        } else {
            self.iso.line("G61", out);
        }
        self.length_active.set(false);
        self.iso.feeds_per_minute();
    }

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
            Coolant::Off => ("M9".to_owned(), ""),
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

    /// Ends length compensation and the TCP kinematics.
    fn release(&mut self, out: &mut String) {
        self.iso.settle(out);
        if self.length_active.set(false) {
            self.iso.line("G49", out);
            if self.tcp {
                self.iso.line(&self.tcp_off, out);
            }
        }
        self.iso.axes.forget();
    }

    /// The depth axis to its upper end, unless it stands there.
    fn clear(&mut self, out: &mut String) {
        self.iso.settle(out);
        if !self.length_active.is(false) {
            self.release(out);
        }
        if self.retracted.set(true) {
            self.iso.line(&self.retract, out);
            self.iso.moved_by_line();
        }
    }

    /// Spindle and coolant off, unless they are.
    fn stop(&mut self, out: &mut String) {
        if self.spindle.set(false) {
            self.iso.line("M5", out);
        }
        if self.coolant.set(false) {
            self.iso.line("M9", out);
        }
    }

    fn go_home(&mut self, out: &mut String) {
        self.clear(out);
        if !self.home.is_empty() {
            self.iso.line(&self.home, out);
            self.iso.moved_by_line();
        }
    }

    fn end(&mut self, out: &mut String) {
        // The tool leaves the part first: a spindle that stops in it tears.
        self.clear(out);
        self.stop(out);
        self.go_home(out);
        self.iso.line("M2", out);
        if self.percent {
            push_line(out, "%");
        }
    }

    /// After a line of the user's own nothing is known to be in force.
    fn forget(&mut self) {
        self.iso.forget();
        self.length_active.forget();
        self.retracted.forget();
        self.spindle.forget();
        self.coolant.forget();
    }
}

/// A remark that LinuxCNC does not act on, as it does on `(MSG, …)`, `(PROBEOPEN …)` and their like.
fn passive(text: &str) -> String {
    const ACTIVE: &[&str] = &["MSG", "DEBUG", "PRINT", "LOG", "PROBE", "PY", "ABORT"];
    let remark = remark(text);
    let inner = remark[1..].trim_start();
    match ACTIVE.iter().any(|word| inner.starts_with(word)) {
        true => format!("(- {inner}"),
        false => remark,
    }
}

fn push_line(out: &mut String, line: &str) {
    out.push_str(line);
    out.push('\n');
}

export_dialect!(linuxcnc, LinuxCnc);

#[cfg(test)]
mod tests;
