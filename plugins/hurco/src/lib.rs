//! Hurco WinMax in its ISNC dialect (the other one, BNC, differs): Fanuc's words, M128 for the tool centre point.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, Dwell, Engine, Iso, Leave, Rigid, Subprogram, Table, Tcp, iso_options, options, words,
};
use post_plugin::{Event, Meaning, OptionSpec, Setup, export_dialect};

struct Hurco {
    /// Rotary words lie within one turn: the control takes the shorter way from the first line to the last.
    shortest: bool,
}

impl Control for Hurco {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        extension: "fnc",
        title: Some(("O", 4)),
        relies: RELIES,
        feed_all_axes: true,
        // Whether M128 alone keeps the tip, or G8.2 and G43.4 behind it, is not settled: the machine file names it.
        tcp: Tcp::Blocks { on: "", off: "M129", length_first: false },
        dwell: Dwell::Seconds("P", 3),
        leave: &[Leave::Tcp, Leave::Retract, Leave::Length],
        // P is not optional there.
        rigid: Rigid::Alone("M29"),
        subprogram: Subprogram::M98,
        words: &[words::SUBPROGRAM_END, OWN],
        ..Table::ISO
    };

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        Ok(Hurco { shortest: setup.words.iter().any(|word| word.wrapped) })
    }

    fn begin(&self, engine: &mut Engine, out: &mut String) {
        if self.shortest {
            engine.line("M126", out);
        }
    }

    fn write(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        if let (Event::End, true) = (event, self.shortest) {
            engine.line("M127", out);
        }
        Ok(false)
    }
}

const OPTIONS: &[OptionSpec] = iso_options![
    options::program_number(9999),
    options::SPACES,
    options::INVERSE_TIME,
    options::inverse_time_decimals(3),
    options::most_inverse_time(999_999.999),
    OptionSpec::text("work_offset", "G54", "G54 to G59."),
    OptionSpec::lines(
        "tcp_on",
        "",
        "Blocks that switch tool centre point control on, {h} for the register of the length: must be named under tcp = \"control\".",
    ),
    OptionSpec::lines(
        "tcp_off",
        "",
        "Block that switches it off; empty: M129 under tcp = \"control\", else nothing is written about it.",
    ),
    options::tapping("rigid"),
    options::BORE_SHIFT,
    options::smoothing(""),
    options::smoothing_off(""),
];

const RELIES: &[&str] = &[
    "the control reads ISNC, not BNC",
    "under M128 rotary words of plain G0 and G1 turn the tool about its tip, and coordinates stay with the part",
    "frame, work offsets, H, D, cycles and subprograms are written as Fanuc has them: confirm at the machine",
];

/// Words that it reads and that are not written here.
const OWN: &[(&str, Meaning)] = &[
    ("G28", Meaning::ReferenceReturn),
    ("G54.1", Meaning::WorkOffset),
    ("G8.2", Meaning::Nothing),
    ("G8.2", Meaning::NoAxisWords),
    ("G68.2", Meaning::TiltedPlane),
    ("G68.3", Meaning::TiltedPlane),
    ("G69", Meaning::TiltedPlaneOff),
    ("M126", Meaning::RotaryShortest),
    ("M127", Meaning::RotaryAsWritten),
    ("M140", Meaning::Retract),
    ("M200", Meaning::Nothing),
    ("M31", Meaning::Nothing),
    ("G76", Meaning::CycleBoreFine),
];

export_dialect!(hurco, Iso<Hurco>);
