//! Mazak Smooth, EIA/ISO: Fanuc's words for the most part, no `%`, files that end in `.EIA`.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, Iso, Leave, Offset, Plane, Rigid, Subprogram, Table, Tcp, iso_options, options, words,
};
use post_plugin::{Meaning, OptionSpec, Setup, export_dialect};

struct Mazak;

impl Control for Mazak {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        extension: "EIA",
        percent: false,
        title: Some(("O", 4)),
        offset: Offset::ADDITIONAL,
        relies: RELIES,
        feed_all_axes: true,
        cancel: CANCEL,
        tcp: Tcp::Length("G43.4"),
        // Whether G49 moves the axis by the length is a parameter: behind it the axis goes up once more.
        leave: &[Leave::Retract, Leave::Length, Leave::Again],
        vector: "G43.5",
        // P0: I J K are Euler angles.
        plane: Plane::Euler { on: "G68.2 P0", turn: "G53.1", off: "G69" },
        cycles_in_plane: true,
        rigid: Rigid::Codes { codes: ["G84.2", "G84.3"], pitch: "" },
        smoothing: SMOOTHING,
        smoothing_anywhere: true,
        probe: "G31",
        subprogram: Subprogram::M98,
        words: &[words::RETURNS, words::POLAR, words::SUBPROGRAM_END, OWN],
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Mazak)
    }
}

const OPTIONS: &[OptionSpec] = iso_options![
    options::program_number(99_999_999),
    OptionSpec::flag("percent", false, "% before and after the program."),
    options::SPACES,
    options::INVERSE_TIME,
    options::inverse_time_decimals(3),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G54.1 Pn."),
    OptionSpec::lines(
        "cancel",
        CANCEL,
        "Block at the start that cancels a tilted plane; empty on a control without them.",
    ),
    options::TOOL_VECTOR,
    options::cycles_in_plane(true),
    options::tapping("floating"),
    options::BORE_SHIFT,
    options::smoothing(SMOOTHING[0]),
    options::smoothing_off(SMOOTHING[1]),
];

const RELIES: &[&str] = &[
    "F86.6 = 1: tool centre point control is in force; F93.3, F94.7: the length is that of H",
    "under G43.4 coordinates stay with the table (parameter)",
    "G53 counts from the machine's zero; cycles and their letters are those of Fanuc: confirm at the machine",
];

/// Tilted plane off.
const CANCEL: &str = "G69";

/// Geometry compensation; the range of its P is the control's.
const SMOOTHING: [&str; 2] = ["0 G61.1", "G64"];

/// Words that it reads and that are not written here.
const OWN: &[(&str, Meaning)] = &[
    ("G4 X", Meaning::DwellSeconds),
    ("G68", Meaning::Rotation),
    ("G68.2", Meaning::TiltedPlane),
    ("G5", Meaning::Smoothing),
    ("G5", Meaning::NoAxisWords),
    ("G76", Meaning::CycleBoreFine),
    ("G87", Meaning::CycleBoreBack),
    ("G84.2", Meaning::CycleTap),
    ("G84.3", Meaning::CycleTapLeft),
];

export_dialect!(mazak, Iso<Mazak>);
