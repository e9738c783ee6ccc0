//! Heidenhain TNC640, conversational: numbered blocks, `L` moves, a sign on every coordinate.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

mod coolant;
mod curves;
mod cycles;
mod datum;
mod events;
mod frame;
mod moves;
mod options;
mod tool;
mod words;

use post_plugin::{
    Axes, AxisNames, Block, Capabilities, Coolant, CutRun, Dialect, Drilling, Event, Format,
    Language, Meaning, Modal, NumberStyle, OptionSpec, PlaneAngles, Setup, SpindleSense,
    Standstill, Units, VocabularyWord, export_dialect,
};

use crate::cycles::CycleParameters;
use crate::datum::Datum;
use crate::frame::{program_name, stock};
use crate::options::OPTIONS;

/// What its programs rely on at the control.
const RELIES: &[&str] = &[
    "M91 counts from the machine's zero, as the travels of the machine file do",
    "the length and the radius of the tool stand in the tool table; TOOL CALL puts them in force",
    "a display of a rotary axis that is reduced below 360 asks for the option rotary_way = \"M126\"",
    "under M128 and PLANE coordinates stay with the part: the kinematics of the table are set up",
];

const SIGNED: NumberStyle = NumberStyle { plus: true, point: false, trim: false };

struct Heidenhain {
    block: Block,
    axes: Axes,
    program: String,
    machine: String,
    inch: bool,
    tcp: bool,
    feed_decimals: u8,
    /// Of F where it counts tenths of an inch.
    tenths_decimals: u8,
    preset: i64,
    rotary_way: String,
    /// The control has rotary axes: it knows M129 and PLANE.
    rotary: bool,
    /// The transformations of a program that came before are cancelled.
    reset: bool,
    /// Block in the place of a retract in machine coordinates; empty: none.
    retract: String,
    tcp_on: String,
    tcp_off: String,
    coolant: [(Coolant, String); 5],
    /// What ends mist, coolant through the tool and air, where they have an end of their own.
    coolant_ends: [(Coolant, String); 3],
    /// Two lines of the stock's corners, or none.
    stock: String,
    cycles: CycleParameters,
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
    /// Whether a tilted plane is in force: the control keeps no tip in it.
    tilted: bool,
    /// The tool's vector as it was written last, in units of its last decimal.
    vector: Option<[f64; 3]>,
    /// Where the last move ended.
    at: Vec<f64>,
    /// Revolutions a minute, if the spindle turns.
    rpm: Option<f64>,
    /// What takes the place of the next event's lines.
    instead: Option<String>,
    /// Lines that end the program.
    ending: String,
    /// The block of the user's own that was written last goes on in the next line.
    goes_on: bool,
    /// A tool call that waits for its speed.
    tool: Option<ToolCall>,
    /// A tool has been called here, or the program calls none: the control knows the axis of the tool.
    called: bool,
    /// What M140 should have retracted before that: nothing may move until then.
    stays: bool,
    /// What came between a tool change and its call.
    held: Vec<PendingEvent>,
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
    /// What a stop has switched off.
    standstill: Standstill,
}

/// A tool call on its way.
#[derive(Clone, Debug)]
enum ToolCall {
    /// A number, or a name in quotes.
    Tool(String),
    /// Lines of the user's own, which call the tool.
    Own(String),
}

/// An event that waits for the tool call.
#[derive(Clone, Debug)]
enum PendingEvent {
    Preselect(u32),
    Coolant(Coolant),
    /// A line of the user's own.
    Word(String),
}

/// The block that says which way rotary axes turn.
fn rotary_way(setup: &Setup<'_>) -> String {
    // Words below a turn mean the shorter way.
    let wrapped = setup.words.iter().any(|word| word.wrapped);
    (if wrapped { "M126" } else { setup.text("rotary_way") }).to_owned()
}

/// The blocks that switch TCPM on and off.
fn tcp_blocks(setup: &Setup<'_>) -> [String; 2] {
    let function = setup.text("tcp_form") == "TCPM";
    let on = match setup.text("tcp_on") {
        "M128" if function => "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS",
        on => on,
    };
    let off = match setup.text("tcp_off") {
        "M129" if function => "FUNCTION RESET TCPM",
        off => off,
    };
    [on, off].map(str::to_owned)
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
        let [tcp_on, tcp_off] = tcp_blocks(setup);
        Ok(Heidenhain {
            block: Block::numbered("", 0, 1, u32::MAX - 1),
            axes: Axes::new(setup, decimals as u8, rotary as u8, SIGNED),
            program: program_name(setup.program),
            machine: setup.machine.to_owned(),
            inch,
            tcp: setup.tcp,
            feed_decimals: setup.integer("feed_decimals") as u8,
            tenths_decimals: setup.integer("feed_decimals_inch") as u8,
            preset: setup.integer("preset"),
            rotary_way: rotary_way(setup),
            rotary: setup.words.iter().any(|word| word.rotary),
            reset: setup.flag("reset"),
            retract: own("retract"),
            tcp_on,
            tcp_off,
            stock: stock(setup),
            cycles: CycleParameters::new(setup),
            datum: Datum::new(setup),
            german: setup.text("language") == "German",
            vectors: setup.flag("tool_vectors"),
            tool_names: setup.flag("tool_names"),
            names: setup.ahead.map_or(Vec::new(), |ahead| {
                let tools = ahead.tools.iter();
                tools.map(|tool| (tool.number, tool.name.to_owned())).collect()
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
            ending: "M30".to_owned(),
            goes_on: false,
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
            called: setup.ahead.is_some_and(|ahead| ahead.tools.is_empty()),
            stays: false,
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
            standstill: Standstill::default(),
        })
    }

    fn capabilities(&self) -> Capabilities {
        self.declared()
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        let ends = self.coolant_ends.iter();
        let ends = ends.map(|(_, word)| (word.as_str(), Meaning::CoolantOff));
        let coolants = self.coolant.iter().map(|(kind, word)| match kind {
            Coolant::Off => (word.as_str(), Meaning::CoolantOff),
            _ => (word.as_str(), Meaning::CoolantOn),
        });
        words::vocabulary(&self.tcp_on, &self.tcp_off, ends.chain(coolants))
    }

    fn relies_on(&self) -> Vec<String> {
        RELIES.iter().map(|sentence| (*sentence).to_owned()).collect()
    }

    fn format(&self) -> Format {
        Format {
            words: self.axes.decimals(),
            // Tenths of an inch have one digit less after the point than inches.
            feed: if self.inch { self.tenths_decimals + 1 } else { self.feed_decimals },
            inverse_time: None,
            feed_per_revolution: 3,
            extension: "h".to_owned(),
            // SPA, SPB, SPC turn about fixed axes: the last of them comes first about those that turn along.
            plane_angles: PlaneAngles::Zyx,
            plane_decimals: 4,
            language: Language::Conversational,
            ..Format::default()
        }
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        if let Event::Cuts { feed, columns } = *event {
            let run = CutRun::new(feed, columns, self.axes.decimals().len())?;
            return self.cuts(&run, out);
        }
        if let Event::Instead { text } = *event {
            self.instead = Some(text.to_owned());
            return Ok(());
        }
        let Some(lines) = self.instead.take() else {
            return self.put(event, out);
        };
        if let Event::Retract { .. } = event {
            // For the way alone: what the control must cancel is cancelled around them.
            let own = std::mem::replace(&mut self.retract, lines);
            let written = self.put(event, out);
            self.retract = own;
            return written;
        }
        if let Event::End = event {
            self.ending = lines;
            return self.put(event, out);
        }
        if let Event::ToolChange { .. } = event {
            self.call_tool(None, out)?;
            self.tool = Some(ToolCall::Own(lines));
            return Ok(());
        }
        // As if it were written, but for the numbers of the blocks.
        let block = self.block.clone();
        self.put(event, &mut String::new())?;
        self.block = block;
        self.own(&lines, out);
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
