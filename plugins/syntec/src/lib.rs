//! Syntec, machining centres: Fanuc's words, as the production post for it has them. LNC, GSK and HNC are said to be
//! like it.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, Iso, Offset, Plane, Rigid, Subprogram, Table, Tcp, iso_options, options, words,
};
use post_plugin::{Capabilities, Meaning, OptionSpec, Setup, export_dialect};

struct Syntec;

impl Control for Syntec {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        title: Some(("O", 4)),
        offset: Offset::ADDITIONAL,
        relies: RELIES,
        feed_all_axes: true,
        tcp: Tcp::Length("G43.4"),
        vector: "G43.5",
        plane: Plane::Euler { on: "G68.2", turn: "G53.1", off: "G69" },
        rigid: Rigid::Ahead("M29"),
        subprogram: Subprogram::M98,
        words: &[
            words::RETURNS,
            words::SHIFTS,
            words::FRAMES,
            words::POLAR,
            words::STOPS,
            words::SUBPROGRAM_END,
            OWN,
        ],
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Syntec)
    }

    /// Whether P of a cycle counts in ms, as in G4, or in seconds, is told either way: no cycle waits.
    fn capabilities(&self) -> Capabilities {
        Capabilities::CYCLE_NO_DWELL
    }
}

const OPTIONS: &[OptionSpec] = iso_options![
    options::program_number(9999),
    options::SPACES,
    options::INVERSE_TIME,
    options::inverse_time_decimals(3),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G54.1 Pn."),
    options::TOOL_VECTOR,
    options::cycles_in_plane(false),
    options::tapping("rigid"),
    options::BORE_SHIFT,
    options::smoothing(""),
    options::smoothing_off(""),
];

const RELIES: &[&str] = &[
    "frame, work offsets, H, D, cycles, waits and subprograms are written as Fanuc has them: confirm at the machine",
    "under G43.4 coordinates stay with the table",
];

/// Words that it reads and that are not written here.
const OWN: &[(&str, Meaning)] = &[
    ("G4 X", Meaning::DwellSeconds),
    ("G33", Meaning::Thread),
    ("G44", Meaning::LengthNegative),
    ("G68.3", Meaning::TiltedPlane),
    ("G5.1", Meaning::Smoothing),
    ("G76", Meaning::CycleBoreFine),
    ("G87", Meaning::CycleBoreBack),
    ("G88", Meaning::CycleOther),
    ("G31", Meaning::Probe),
    ("G65", Meaning::Macro),
    ("G66", Meaning::MacroModal),
    ("G67", Meaning::MacroOff),
];

export_dialect!(syntec, Iso<Syntec>);
