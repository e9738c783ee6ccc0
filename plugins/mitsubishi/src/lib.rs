//! Mitsubishi M800, M80 and M700V: tool centre point and inclined surface as the maker has them, the rest as Fanuc's.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, Iso, Leave, Offset, Plane, Rigid, Subprogram, SurfaceSpeed, Table, Tcp, iso_options,
    options, words,
};
use post_plugin::{Meaning, OptionSpec, Setup, export_dialect};

struct Mitsubishi;

impl Control for Mitsubishi {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        title: Some(("O", 4)),
        offset: Offset::ADDITIONAL,
        relies: RELIES,
        feed_all_axes: true,
        cancel: CANCEL,
        tcp: Tcp::Length("G43.4"),
        // Whether G49 moves the axis by the length is a parameter: behind it the axis goes up once more.
        leave: &[Leave::Retract, Leave::Length, Leave::Again],
        vector: "G43.5",
        plane: Plane::Euler { on: "G68.2", turn: "G53.1", off: "G69" },
        // Else parameter #8159 decides, as delivered for a compensating chuck. Beside `,R1` F may be the pitch.
        rigid: Rigid::Ahead("M29"),
        surface: Some(SurfaceSpeed { codes: ["G96", "G97"], per_minute: None, most: "G92 S" }),
        probe: "G31",
        subprogram: Subprogram::M98,
        words: &[
            words::RETURNS,
            words::SHIFTS,
            words::FRAMES,
            words::AREAS,
            words::POLAR,
            words::STOPS,
            words::SUBPROGRAM_END,
            OWN,
        ],
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Mitsubishi)
    }
}

const OPTIONS: &[OptionSpec] = iso_options![
    options::program_number(99_999_999),
    options::SPACES,
    options::INVERSE_TIME,
    options::inverse_time_decimals(3),
    options::most_inverse_time(999_999.999),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G54.1 Pn."),
    OptionSpec::lines(
        "cancel",
        CANCEL,
        "Block at the start that cancels an inclined surface; empty on a control without them.",
    ),
    options::TOOL_VECTOR,
    options::cycles_in_plane(false),
    options::TAPPING_NAMED,
    options::smoothing(""),
    options::smoothing_off(""),
];

const RELIES: &[&str] = &[
    "frame, work offsets, H, D, cycles and subprograms are written as Fanuc has them: confirm at the machine",
    "7915, 1247, 8901 to 8906, 1450: tool centre point control and inclined surface are set up",
    "under G43.4 coordinates stay with the table, as at its zero",
    "taps: M29 S ahead of G84 makes them synchronous; without it 8159 decides, F is a feed a minute either way",
    "cycles, G41 and G42 stand neither under G43.4 nor on an inclined surface, unless an option says so",
];

/// Inclined surface off.
const CANCEL: &str = "G69";

/// Words that it reads and that are not written here.
const OWN: &[(&str, Meaning)] = &[
    ("G4 X", Meaning::DwellSeconds),
    ("G33", Meaning::Thread),
    ("G44", Meaning::LengthNegative),
    ("G43.1", Meaning::LengthAlongTool),
    ("G11", Meaning::TableDataOff),
    ("G68.3", Meaning::TiltedPlane),
    ("G5", Meaning::Smoothing),
    ("G5", Meaning::NoAxisWords),
    ("G5.1", Meaning::Smoothing),
    ("G5.1", Meaning::NoAxisWords),
    ("G84", Meaning::CycleTap),
    ("G74", Meaning::CycleTapLeft),
    ("M29", Meaning::Nothing),
    // Of a rigid tap; it rounds a corner elsewhere.
    ("G84 ,R", Meaning::Nothing),
    ("G74 ,R", Meaning::Nothing),
    ("G76", Meaning::CycleBoreFine),
    ("G87", Meaning::CycleBoreBack),
    ("G12", Meaning::CycleOther),
    ("G13", Meaning::CycleOther),
];

export_dialect!(mitsubishi, Iso<Mitsubishi>);
