//! Heidenhain TNC640, conversational: numbered blocks, `L` moves, a sign on every coordinate.
//!
//! What it assumes about the control stands in `plugins/README.md`.

mod coolant;
mod frame;
mod moves;
mod options;
mod tool;

use post_plugin::{
    Axes, AxisNames, Block, Capabilities, Compensation, Coolant, Dialect, Event, Format, Group,
    Modal, NumberStyle, OptionSpec, Setup, Spindle, SpindleSense, Units, export_dialect,
};

use crate::frame::program_name;
use crate::options::OPTIONS;

const SIGNED: NumberStyle = NumberStyle {
    plus: true,
    point: false,
    trim: false,
};

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

export_dialect!(heidenhain, Heidenhain);

#[cfg(test)]
mod tests;
