//! Heidenhain TNC640, conversational: numbered blocks, `L` moves, a sign on every coordinate.
//!
//! What it assumes about the control stands in `plugins/README.md`.

mod coolant;
mod curves;
mod cycles;
mod datum;
mod frame;
mod moves;
mod options;
mod tool;
mod words;

use post_plugin::{
    Axes, AxisNames, Block, Capabilities, Compensation, Coolant, Dialect, Event, Format, Group,
    Modal, NumberStyle, OptionSpec, PlaneAngles, Setup, Spindle, SpindleSense, Units,
    VocabularyWord, export_dialect,
};

use crate::cycles::{Cycles, Drilling};
use crate::datum::Datum;
use crate::frame::{program_name, stock};
use crate::options::OPTIONS;
use crate::tool::tool_call;

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
    /// Two lines of the stock's corners, or none.
    stock: String,
    cycles: Cycles,
    datum: Datum,
    /// Texts of cycles in German.
    german: bool,
    vectors: bool,
    /// Tools are called by their names; those known ahead.
    tool_names: bool,
    names: Vec<(u32, String)>,
    /// Places of X, Y and Z among the words, if the machine has them and the spindle is along Z.
    linear: Option<[usize; 3]>,
    decimals: u8,
    drilling: Option<Drilling>,
    /// The definition of the cycle in force.
    defined: String,
    /// In a tilted plane the control keeps no tip.
    tilted: bool,
    /// The tool's vector as it was written last, in units of its last decimal.
    vector: Option<[f64; 3]>,
    /// Where the last move ended.
    at: Vec<f64>,
    /// Revolutions a minute, if the spindle turns.
    rpm: Option<f64>,
    /// What takes the place of the next event's lines.
    instead: Option<String>,
    /// A tool call that waits for its speed: a number, or a name in quotes.
    tool: Option<String>,
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
            tcp_on: match own("tcp_on") {
                on if on == "M128" && setup.text("tcp_form") == "TCPM" => {
                    "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS".to_owned()
                }
                on => on,
            },
            tcp_off: match own("tcp_off") {
                off if off == "M129" && setup.text("tcp_form") == "TCPM" => {
                    "FUNCTION RESET TCPM".to_owned()
                }
                off => off,
            },
            stock: stock(setup),
            cycles: Cycles::new(setup),
            datum: Datum::new(setup),
            german: setup.text("language") == "German",
            vectors: setup.flag("tool_vectors"),
            tool_names: setup.flag("tool_names"),
            names: setup.ahead.map_or(Vec::new(), |ahead| {
                let tools = ahead.tools.iter();
                tools
                    .map(|tool| (tool.number, tool.name.to_owned()))
                    .collect()
            }),
            linear: places(setup),
            decimals: decimals as u8,
            drilling: None,
            defined: String::new(),
            tilted: false,
            vector: None,
            at: Vec::new(),
            rpm: None,
            instead: None,
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

    fn capabilities(&self) -> Capabilities {
        self.declared()
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        words::vocabulary(&self.tcp_on, &self.tcp_off)
    }

    fn format(&self) -> Format {
        Format {
            words: self.axes.decimals(),
            feed: self.feed_decimals,
            inverse_time: None,
            feed_per_revolution: 3,
            extension: "h".to_owned(),
            // SPA, SPB, SPC turn about fixed axes: the last of them comes first about those that turn along.
            plane_angles: PlaneAngles::Zyx,
            plane_decimals: 4,
            ..Format::default()
        }
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        if let Event::Instead { text } = *event {
            self.instead = Some(text.to_owned());
            return Ok(());
        }
        let Some(lines) = self.instead.take() else {
            return self.put(event, out);
        };
        // As if it were written, but for the numbers of the blocks.
        let block = self.block.clone();
        self.put(event, &mut String::new())?;
        self.block = block;
        self.own(&lines, out);
        Ok(())
    }
}

impl Heidenhain {
    fn put(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        // The speed belongs to the tool call, so this waits for it; what needs no tool may come between.
        match *event {
            Event::Spindle(Spindle::On { .. })
            | Event::Comment { .. }
            | Event::Operation { .. }
            | Event::OperationEnd
            | Event::Smoothing { .. }
            | Event::SmoothingOff
            | Event::WorkOffset { .. } => {}
            Event::Preselect { number } if self.tool.is_some() => {
                self.held.push(Held::Preselect(number));
                return Ok(());
            }
            Event::Coolant(coolant) if self.tool.is_some() => {
                self.held.push(Held::Coolant(coolant));
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
                self.tool = Some(tool_call(number, name, self.tool_names)?);
            }
            Event::Preselect { number } => self.preselect(number, out)?,
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
            Event::Rapid { words, tool } => self.go(words, tool, None, None, out)?,
            Event::Linear { words, tool, feed } => self.go(words, tool, None, Some(feed), out)?,
            Event::Surface {
                words,
                tool,
                feed,
                normal,
            } => self.go(words, tool, Some(normal), Some(feed), out)?,
            Event::Arc { .. } => self.arc(event, out)?,
            Event::Cycle { .. } => self.drilling = Drilling::of(event),
            Event::CyclePoint { words, .. } => self.drill(words, out)?,
            Event::CycleOff => self.drilling = None,
            Event::Plane { origin, angles, .. } => self.tilt(origin, angles, out),
            Event::PlaneOff => self.upright(out),
            Event::Smoothing {
                tolerance,
                axis_tolerance,
            } => self.smooth(Some(tolerance), axis_tolerance, out),
            Event::SmoothingOff => self.smooth(None, None, out),
            Event::WorkOffset { number, .. } => self.preset(number, out),
            Event::Operation { name } => self.structure(name, out),
            Event::OperationEnd => {}
            Event::Subprogram {
                number,
                times,
                name,
            } => self.subprogram(number, times, name, out),
            Event::Units(_) => {
                return Err(
                    "the units of this control stand in the first line: a program has one"
                        .to_owned(),
                );
            }
            Event::Dwell { seconds } => {
                let [name, word] = match self.german {
                    true => ["VERWEILZEIT", "V.ZEIT"],
                    false => ["DWELL TIME", "DWELL"],
                };
                self.block.line(&format!("CYCL DEF 9.0 {name}"), out);
                self.block.word("CYCL DEF 9.1").word(word);
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

/// X, Y and Z, the spindle along Z: the plane of arcs and cycles.
fn places(setup: &Setup<'_>) -> Option<[usize; 3]> {
    let place = |name| setup.words.iter().position(|word| word.name == name);
    let found = [place("X")?, place("Y")?, place("Z")?];
    setup.words[found[2]].depth.then_some(found)
}

export_dialect!(heidenhain, Heidenhain);

#[cfg(test)]
mod tests;
