//! Fanuc 30i, 31i: G-code with modal words, a point in every number, remarks in capitals.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

mod lathe;

use post_iso::{
    Control, Engine, Iso, Offset, Plane, Rigid, SplineForm, Subprogram, SurfaceSpeed, Table, Tcp,
    iso_options, options, words,
};
use post_plugin::{Event, Meaning, OptionKind, OptionSpec, Setup, Value, export_dialect};

struct Fanuc {
    /// T calls a tool with its offsets, from a turret.
    turret: bool,
}

impl Control for Fanuc {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        title: Some(("O", 4)),
        largest_number: 99_999_999,
        offset: Offset::ADDITIONAL,
        relies: RELIES,
        cancel: CANCEL,
        cancel_behind_length: true,
        feed_all_axes: true,
        sign_is_way: true,
        tcp: Tcp::Length("G43.4"),
        vector: "G43.5",
        plane: Plane::Euler { on: "G68.2", turn: "G53.1", off: "G69" },
        cycles_in_plane: true,
        rigid: Rigid::Ahead("M29"),
        splines: SplineForm::Knots { code: "G6.2", begin: "G5 P10000", end: "G5 P0" },
        smoothing: SMOOTHING,
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

    fn table(setup: &Setup<'_>) -> &'static Table {
        match setup.text("system") {
            "A" => &lathe::A,
            "B" => &lathe::B,
            "C" => &lathe::C,
            _ => Self::TABLE,
        }
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        Ok(Fanuc { turret: setup.text("system") != "M" })
    }

    fn write(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        match *event {
            Event::ToolChange { number, register, name, .. } if self.turret => {
                if !(1..=99).contains(&number) || register > 99 {
                    return Err(format!(
                        "T has two digits for the tool and two for its offsets, and tool {number} has the offsets {register}"
                    ));
                }
                engine.change(number, &format!("T{number:02}{register:02}"), register, name, out);
                Ok(true)
            }
            // A turret has all of its tools at hand, and T would turn it.
            Event::Preselect { .. } if self.turret => Ok(true),
            _ => Ok(false),
        }
    }
}

/// The system of G codes.
const SYSTEM: OptionSpec = OptionSpec {
    key: "system",
    kind: OptionKind::Choice(&["M", "A", "B", "C"]),
    default: Value::Text("M"),
    help: "The system of G codes: M on machining centres; A, B or C on lathes, as parameter 3401 #6 and #7 has it (A where \
           both are 0). There T calls a tool with its offsets (T0101).",
};

const OPTIONS: &[OptionSpec] = iso_options![
    SYSTEM,
    options::program_number(9999),
    options::SPACES,
    options::inverse_time_decimals(3),
    options::most_inverse_time(9999.999),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G54.1 Pn."),
    OptionSpec::lines(
        "cancel",
        CANCEL,
        "Block behind the first retract that cancels rotation and tilted plane; `G50 G50.1 G69` where scaling and mirror image \
         are there, empty where nothing of it is.",
    ),
    options::TOOL_VECTOR,
    options::cycles_in_plane(true),
    options::tapping("rigid"),
    options::BORE_SHIFT,
    options::SPLINES,
    options::smoothing(SMOOTHING[0]),
    options::smoothing_off(SMOOTHING[1]),
];

/// Numbers of parameters are those of the 30i, 31i, 32i (B-63950EN, B-64490EN).
const RELIES: &[&str] = &[
    "1008#0 ROA = 0: whole turns count; 1 for a range (RAB = 0) or way = \"sign\" (RAB = 1)",
    "1403#5 HTG = 1: F of a helix is along the helix, not along its circle",
    "1401#1 LRP = 1: rapids go straight; with 0 the axes arrive one after the other",
    "5006#6 TOS: either; G53 has taken the length off before G49 cancels it",
    "19696#5 WKP = 0: under G43.4 coordinates stay with the table, as at its zero",
    "19696#6 RFC = 1: under G43.4 F holds where the tip stands and the axes turn",
    "one M code a block is enough, G53 counts from the machine's zero",
];

/// Rotation and tilted plane off. Scaling and mirror image (G50, G50.1) are options of many controls, whose words without
/// the option are an alarm.
const CANCEL: &str = "G69";

/// AI contour control: how much it leaves the path is the parameters' to say.
const SMOOTHING: [&str; 2] = ["0 G5.1 Q1", "G5.1 Q0"];

/// Words that it reads and that are not written here: 30i, machining centre.
const OWN: &[(&str, Meaning)] = &[
    ("G4 X", Meaning::DwellSeconds),
    ("G4 U", Meaning::DwellSeconds),
    ("G33", Meaning::Thread),
    ("G44", Meaning::LengthNegative),
    ("G92.1", Meaning::SetPositionOff),
    ("G68.3", Meaning::TiltedPlane),
    ("G68.4", Meaning::TiltedPlane),
    ("G5", Meaning::Smoothing),
    ("G5", Meaning::NoAxisWords),
    ("G5.1", Meaning::Smoothing),
    ("G5.1", Meaning::OwnAxisWords),
    ("G8", Meaning::Smoothing),
    ("G8", Meaning::NoAxisWords),
    ("G84.2", Meaning::CycleTap),
    ("G84.3", Meaning::CycleTapLeft),
    ("G76", Meaning::CycleBoreFine),
    ("G87", Meaning::CycleBoreBack),
    ("G88", Meaning::CycleOther),
    ("G65", Meaning::Macro),
    ("G66", Meaning::MacroModal),
    ("G67", Meaning::MacroOff),
];

export_dialect!(fanuc, Iso<Fanuc>);
