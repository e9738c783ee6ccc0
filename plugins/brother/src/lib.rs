//! Brother CNC-C00 and CNC-D00 (Speedio): Fanuc's words, taps by their pitch, waits in seconds.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, CycleCode, Dwell, Iso, Leave, MotionCodes, Offset, Plane, Rigid, Subprogram, Table,
    Tcp, check_unit_system, iso_options, options, words,
};
use post_plugin::{Cycle, Meaning, OptionKind, OptionSpec, Setup, Value, export_dialect};

struct Brother;

impl Control for Brother {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        extension: "NC",
        percent: false,
        // The CNC-C00 has no G20 and G21: the units are a setting of the control.
        codes: MotionCodes { units: ["", ""], ..MotionCodes::ISO },
        offset: Offset::ADDITIONAL,
        relies: RELIES,
        feed_all_axes: true,
        // No stored post of this control keeps the tip: the machine file names the words.
        tcp: Tcp::Blocks { on: "", off: "", length_first: false },
        // G49 ends both, and might move the axis: behind the retract.
        leave: &[Leave::Retract, Leave::Tcp, Leave::Length],
        dwell: Dwell::Seconds("P", 3),
        cycles: CYCLES,
        plane: Plane::Euler { on: "G68.2", turn: "G53.1", off: "G69" },
        rigid: Rigid::Codes { codes: ["G77", ""], pitch: "I" },
        subprogram: Subprogram::M98,
        // Mist is no equipment of these machines.
        coolant: ["M9", "M8", "", "", ""],
        words: &[
            words::RETURNS,
            words::SHIFTS,
            words::FRAMES,
            words::STOPS,
            words::SUBPROGRAM_END,
            OWN,
        ],
        ..Table::ISO
    };

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        check_unit_system(
            setup,
            ["mm", "inch"],
            "the units of a program are a setting of this control, which no word of the program chooses",
        )?;
        Ok(Brother)
    }
}

const OPTIONS: &[OptionSpec] = iso_options![
    OptionSpec {
        key: "unit_system",
        kind: OptionKind::Choice(&["", "mm", "inch"]),
        default: Value::Text(""),
        help: "The units that the control is set to, which no word chooses: must be named, and be those of the program.",
    },
    options::SPACES,
    options::inverse_time_decimals(3),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G54.1 Pn."),
    OptionSpec::lines(
        "tcp_on",
        "",
        "Blocks that switch tool centre point control on, {h} for the register of the length, as `G43.4 H{h}`: must be \
         named under tcp = \"control\".",
    ),
    OptionSpec::lines(
        "tcp_off",
        "",
        "Block that switches it off, behind the retract; empty: G49, which ends the length, ends it too.",
    ),
    options::cycles_in_plane(false),
    options::tapping("rigid"),
    options::BORE_SHIFT,
    options::smoothing(""),
    options::smoothing_off(""),
];

/// Left-hand threads are G74 in one production post and G78 in a later one: none is written.
const CYCLES: &[CycleCode] = &[
    CycleCode::new(Cycle::Drill, "G81", "G82"),
    CycleCode::new(Cycle::Deep, "G83", "G83"),
    CycleCode::new(Cycle::BreakChip, "G73", ""),
    CycleCode::new(Cycle::Tap, "G84", "G84"),
    CycleCode::new(Cycle::Ream, "G85", "G89"),
    CycleCode::new(Cycle::Bore, "G86", ""),
    CycleCode::new(Cycle::BoreFine, "G76", "G76"),
    CycleCode::new(Cycle::BoreBack, "G87", "G87"),
];

const RELIES: &[&str] = &[
    "P of waits and cycles is in seconds",
    "the control is set to the units of the program: no word chooses them",
    "I of G77 is the pitch in mm",
    "user parameter 0039: G49 without Z, the tool retracted, raises no alarm",
    "frame, work offsets, H, D and subprograms are written as Fanuc has them: confirm at the machine",
];

/// Words that it reads and that are not written here.
const OWN: &[(&str, Meaning)] = &[
    // T behind it: the tool is changed while the axes go to what else the block says.
    ("G100", Meaning::ToolChange),
    ("G33", Meaning::Thread),
    ("G44", Meaning::LengthNegative),
    ("G43.4", Meaning::TcpOn),
    ("G84", Meaning::CycleTap),
    ("G77", Meaning::CycleTap),
    ("G77 I", Meaning::CycleTap),
    ("G77 J", Meaning::CycleTap),
    ("G74", Meaning::CycleTapLeft),
    ("G74 I", Meaning::CycleTapLeft),
    ("G74 J", Meaning::CycleTapLeft),
    ("G78", Meaning::CycleTapLeft),
    ("G78 I", Meaning::CycleTapLeft),
    ("G78 J", Meaning::CycleTapLeft),
    ("G76", Meaning::CycleBoreFine),
    ("G87", Meaning::CycleBoreBack),
    ("G88", Meaning::CycleOther),
    ("G31", Meaning::Probe),
    ("G65", Meaning::Macro),
    ("M494", Meaning::CoolantOn),
    ("M495", Meaning::CoolantOff),
    ("M400", Meaning::Nothing),
    ("M401", Meaning::Nothing),
    ("M260", Meaning::Smoothing),
    ("M262", Meaning::Smoothing),
    ("M265", Meaning::Smoothing),
    ("M269", Meaning::SmoothingOff),
];

export_dialect!(brother, Iso<Brother>);
