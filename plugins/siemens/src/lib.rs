//! Siemens SINUMERIK 840D sl: G-code with its own words for tools, arcs, cycles, planes and transformations.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

mod capabilities;
mod cycles;
mod events;
mod motion;
mod options;
mod swivel;
mod table;
mod text;
mod words;

use post_iso::{Control, Engine, Iso, Table};
use post_plugin::{
    Capabilities, Drilling, Event, Format, Modal, NumberStyle, Setup, Units, VocabularyWord,
    export_dialect,
};

use crate::cycles::{CycleCalls, SpindleTurning};
use crate::swivel::{SmoothingCall, SwivelCall};
use crate::text::transfer_header;

struct Siemens {
    cycles: CycleCalls,
    swivel: SwivelCall,
    smoothing: SmoothingCall,
    /// Ahead of a program that is transferred by cable; empty: none.
    header: String,
    edge: i64,
    /// The work offset in force.
    offset: String,
    /// A line of the user's own has named it.
    own_offset: bool,
    /// A transformation may have ended it.
    offset_off: bool,
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
    /// Words of endless axes stay within a turn.
    modulo: bool,
    /// Places of X, Y and Z among the words, if the machine has them and the spindle is along Z.
    linear: Option<[usize; 3]>,
    decimals: u8,
    style: NumberStyle,
    /// Where the last move ended.
    at: Vec<f64>,
    plane: Modal<&'static str>,
    /// The plane across the tool, along whose third axis D puts the length.
    across: &'static str,
    tcp_active: Modal<bool>,
    /// Whether a tilted plane is in force: there is no transformation in it.
    tilted: bool,
    /// Vector of the tool, in units of its last decimal.
    vector: Modal<[f64; 3]>,
    turning: Option<SpindleTurning>,
    /// Boring has left the spindle oriented.
    oriented: bool,
    /// D0 is not in force.
    length: Modal<bool>,
    drilling: Option<Drilling>,
    /// The modal call in force.
    called: Option<String>,
}

impl Control for Siemens {
    const TABLE: &'static Table = &table::TABLE;

    fn table(setup: &Setup<'_>) -> &'static Table {
        match (setup.turns_in_zx(), setup.has_diameters()) {
            (true, true) => &table::TURNING_DIAMETERS,
            (true, false) => &table::TURNING,
            (false, true) => &table::DIAMETERS,
            (false, false) if setup.turns_part => &table::RADII,
            (false, false) => Self::TABLE,
        }
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let place = |name| setup.words.iter().position(|word| word.name == name);
        let linear = match [place("X"), place("Y"), place("Z")] {
            [Some(x), Some(y), Some(z)] if setup.words[z].depth => Some([x, y, z]),
            _ => None,
        };
        let vectors = setup.flag("tool_vectors");
        let tools = setup.ahead.map_or(&[][..], |ahead| ahead.tools);
        Ok(Siemens {
            cycles: CycleCalls::new(setup),
            swivel: SwivelCall::new(setup)?,
            smoothing: SmoothingCall::new(setup),
            header: match setup.flag("transfer_header") {
                true => transfer_header(setup.program),
                false => String::new(),
            },
            edge: setup.integer("edge"),
            offset: setup.text("work_offset").to_owned(),
            own_offset: false,
            offset_off: false,
            tool_names: setup.flag("tool_names"),
            names: tools.iter().map(|tool| (tool.number, tool.name.to_owned())).collect(),
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
            modulo: setup.text("endless") == "modulo",
            linear,
            decimals: setup.integer(match setup.units {
                Units::Millimetre => "decimals",
                Units::Inch => "decimals_inch",
            }) as u8,
            style: NumberStyle { point: true, trim: !setup.flag("trailing_zeros"), plus: false },
            at: Vec::new(),
            plane: Modal::default(),
            across: across(setup),
            tcp_active: Modal::default(),
            tilted: false,
            vector: Modal::default(),
            turning: None,
            oriented: false,
            length: Modal::default(),
            drilling: None,
            called: None,
        })
    }

    fn format(&self, engine: Format) -> Format {
        Format { plane_angles: self.swivel.angles, plane_decimals: 5, ..engine }
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
        self.put(event, engine, out)
    }
}

/// The plane across the tool where the words are axis positions. Under a transformation the control turns the length
/// with the tool.
fn across(setup: &Setup<'_>) -> &'static str {
    if setup.turns_in_zx() {
        return "G18";
    }
    let lies = |name| setup.words.iter().any(|word| word.name == name && word.depth);
    match (setup.tcp, lies("X"), lies("Y")) {
        (false, true, false) => "G19",
        (false, false, true) => "G18",
        _ => "G17",
    }
}

export_dialect!(siemens, Iso<Siemens>);
