//! Siemens SINUMERIK 840D sl: G-code with its own words for tools, arcs, cycles, planes and transformations.
//!
//! What it assumes about the control stands in `plugins/README.md`.

mod capabilities;
mod cycles;
mod motion;
mod options;
mod swivel;
mod table;
mod text;
mod words;

use post_iso::{Control, Engine, Iso, Table};
use post_plugin::{
    Capabilities, Event, Feed, Format, Modal, NumberStyle, Setup, Spindle, Units, VocabularyWord,
    export_dialect,
};

use crate::cycles::{Cycles, Drilling, Turning};
use crate::swivel::{Smoothing, Swivel};
use crate::table::is_work_offset;
use crate::text::{callable, called, message, transfer_header};

struct Siemens {
    cycles: Cycles,
    swivel: Swivel,
    smoothing: Smoothing,
    /// Ahead of a program that is transferred by cable; empty: none.
    header: String,
    edge: i64,
    /// The work offset in force; none where a line of the user's own may have named another.
    offset: Option<String>,
    tool_names: bool,
    /// Names of the program's tools by their numbers, as far as they are known ahead.
    names: Vec<(u32, String)>,
    tcp: bool,
    rotary: bool,
    tcp_on: String,
    tcp_off: String,
    vectors: bool,
    arcs_off_xy: bool,
    swivels: bool,
    messages: bool,
    /// Places of X, Y and Z among the words, if the machine has them and the spindle is along Z.
    linear: Option<[usize; 3]>,
    decimals: u8,
    style: NumberStyle,
    /// Where the last move ended.
    at: Vec<f64>,
    plane: Modal<&'static str>,
    tcp_active: Modal<bool>,
    /// In a tilted plane there is no transformation.
    tilted: bool,
    /// Of the tool, in units of its last decimal.
    vector: Modal<[f64; 3]>,
    turning: Option<Turning>,
    /// The speed is one of cutting.
    surface: bool,
    /// D0 is not in force.
    length: Modal<bool>,
    drilling: Option<Drilling>,
    /// The modal call in force.
    called: Option<String>,
}

impl Control for Siemens {
    const TABLE: &'static Table = &table::TABLE;

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let place = |name| setup.words.iter().position(|word| word.name == name);
        let linear = match [place("X"), place("Y"), place("Z")] {
            [Some(x), Some(y), Some(z)] if setup.words[z].depth => Some([x, y, z]),
            _ => None,
        };
        let vectors = setup.flag("tool_vectors");
        let tools = setup.ahead.map_or(&[][..], |ahead| ahead.tools);
        Ok(Siemens {
            cycles: Cycles::new(setup),
            swivel: Swivel::new(setup)?,
            smoothing: Smoothing::new(setup),
            header: match setup.flag("transfer_header") {
                true => transfer_header(setup.program),
                false => String::new(),
            },
            edge: setup.integer("edge"),
            offset: Some(setup.text("work_offset").to_owned()),
            tool_names: setup.flag("tool_names"),
            names: tools
                .iter()
                .map(|tool| (tool.number, tool.name.to_owned()))
                .collect(),
            tcp: setup.tcp,
            rotary: setup.words.iter().any(|word| word.rotary),
            tcp_on: match setup.text("tcp_on") {
                "" if vectors => "TRAORI\nORIWKS ORIAXES",
                "" => "TRAORI\nORIMKS ORIAXES",
                own => own,
            }
            .to_owned(),
            tcp_off: setup.text("tcp_off").to_owned(),
            vectors,
            arcs_off_xy: setup.flag("arcs_off_xy"),
            swivels: setup.flag("swivel"),
            messages: setup.flag("messages"),
            linear,
            decimals: setup.integer(match setup.units {
                Units::Millimetre => "decimals",
                Units::Inch => "decimals_inch",
            }) as u8,
            style: NumberStyle {
                point: true,
                trim: !setup.flag("trailing_zeros"),
                plus: false,
            },
            at: Vec::new(),
            plane: Modal::default(),
            tcp_active: Modal::default(),
            tilted: false,
            vector: Modal::default(),
            turning: None,
            surface: false,
            length: Modal::default(),
            drilling: None,
            called: None,
        })
    }

    fn format(&self, engine: Format) -> Format {
        Format {
            plane_angles: self.swivel.angles,
            plane_decimals: 5,
            ..engine
        }
    }

    fn capabilities(&self) -> Capabilities {
        self.declared()
    }

    fn vocabulary(&self, _: Vec<VocabularyWord>) -> Vec<VocabularyWord> {
        words::vocabulary(&self.tcp_on, &self.tcp_off)
    }

    fn begin(&self, engine: &mut Engine, out: &mut String) {
        if self.swivels {
            engine.line("CYCLE800()", out);
        }
    }

    fn write(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        if !matches!(event, Event::CyclePoint { .. } | Event::Comment { .. }) {
            self.end_call(engine, out);
        }
        match *event {
            Event::Start => {
                engine.motion.axes.shorter_way("=DC(", ")");
                if !self.header.is_empty() {
                    engine.bare(&self.header, out);
                }
                self.plane.set("G17");
                self.tcp_active.set(false);
                return Ok(false);
            }
            Event::Linear { feed, .. } if self.surface && !matches!(feed, Feed::PerMinute(_)) => {
                return Err(format!(
                    "a feed of {feed} would end the constant cutting speed (G961)"
                ));
            }
            Event::Rapid { words, tool } if self.by_vector() => {
                self.go(words, tool, None, engine, out)
            }
            Event::Linear { words, tool, feed } if self.by_vector() => {
                self.go(words, tool, Some(feed), engine, out);
            }
            Event::Rapid { words, .. } | Event::Linear { words, .. } => {
                self.stand(words);
                return Ok(false);
            }
            Event::Position {
                words,
                feed,
                plane_first,
                ..
            } => {
                self.position(words, feed, plane_first, engine, out)?;
            }
            Event::Park { .. } => {
                self.length.set(false);
                return Ok(false);
            }
            Event::Retract { .. } => {
                self.length.set(false);
                engine.motion.settle(out);
                if self.rotary && self.tcp_active.set(false) {
                    engine.line(&self.tcp_off, out);
                }
                return Ok(false);
            }
            Event::ToolChange {
                number,
                register,
                name,
                ..
            } if self.tool_names && !name.is_empty() => {
                self.length.forget();
                engine.change(number, &called(name)?, register, name, out);
            }
            Event::ToolChange { .. } => {
                self.length.forget();
                return Ok(false);
            }
            Event::Preselect { number } => {
                let name = self
                    .names
                    .iter()
                    .find(|(known, name)| *known == number && !name.is_empty());
                match name {
                    Some((_, name)) if self.tool_names => engine.line(&called(name)?, out),
                    _ => return Ok(false),
                }
            }
            Event::Spindle(spindle) => {
                self.surface = false;
                self.turning = match spindle {
                    Spindle::On { rpm, sense } => Some((rpm, sense)),
                    Spindle::Off | Spindle::Orient => None,
                };
                return Ok(false);
            }
            Event::SurfaceSpeed { .. } => {
                engine.write(event, out)?;
                // G961 leaves the feed a minute.
                engine.motion.forget_feed();
                engine.motion.feeds_per_minute();
                self.surface = true;
                self.turning = None;
            }
            Event::Arc { .. } => self.arc(event, engine, out)?,
            Event::Cycle { .. } => self.drilling = Drilling::of(event),
            Event::CyclePoint { words, .. } => self.drill(words, engine, out)?,
            Event::CycleOff => self.drilling = None,
            Event::Plane {
                origin,
                angles,
                words,
                ..
            } => {
                // The cycle asks for a tool with its length.
                self.length_on(engine, out);
                engine.line(&self.swivel.plane(origin, angles, words), out);
                self.tilted = true;
            }
            Event::PlaneOff => {
                engine.line("CYCLE800()", out);
                self.tilted = false;
            }
            Event::Smoothing {
                tolerance,
                axis_tolerance,
            } => {
                engine.line(&self.smoothing.on(tolerance, axis_tolerance), out);
            }
            Event::SmoothingOff => engine.line(self.smoothing.off(), out),
            Event::Operation { name } => {
                if !name.is_empty() {
                    engine.remark(name, out);
                }
                if self.messages {
                    engine.line(&message(name), out);
                }
            }
            Event::OperationEnd => {}
            Event::Message { text } => engine.line(&message(text), out),
            Event::WorkOffset { number, .. } => {
                self.offset = (Self::TABLE.offset.word)(number);
                return Ok(false);
            }
            Event::Tcp { on } => {
                let line = if on { &self.tcp_on } else { &self.tcp_off };
                engine.line(line, out);
                self.tcp_active.set(on);
                engine.motion.axes.forget();
            }
            Event::Subprogram { number, name, .. } => {
                if number.is_none() {
                    callable(name)?;
                }
                self.forget();
                return Ok(false);
            }
            Event::Probe { words, feed, .. } => {
                engine.motion.block.word("MEAS=1");
                engine.motion.arrive(words, None, Some(feed), "", out);
                engine.motion.moved_by_line();
            }
            Event::Literal { text } => {
                if text.split_whitespace().any(is_work_offset) {
                    self.offset = None;
                }
                self.forget();
                return Ok(false);
            }
            _ => return Ok(false),
        }
        Ok(true)
    }
}

export_dialect!(siemens, Iso<Siemens>);

#[cfg(test)]
mod tests;
