//! GRBL 1.1: three axes, no cycles, no changer, no length; grblHAL, by an option, has more of them.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{
    Control, Dwell, Engine, Iso, Leave, Length, MotionCodes, Offset, Stops, Table, no_range,
    offset_of_six, options, words,
};
use post_plugin::{
    Capabilities, Event, Language, Meaning, OptionSpec, Setup, export_dialect, remark,
};

struct Grbl {
    hal: bool,
    /// A block of the machine file's own retracts the tool.
    retracts: bool,
}

impl Control for Grbl {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        language: Language::Rs274,
        percent: false,
        remark: passive,
        // Its buffer has 80 characters, and the line's end is one of them.
        remark_length: 78,
        line_length: Some(78),
        codes: MotionCodes {
            feed: ["G94", "G93", ""],
            compensation: ["G40", "", ""],
            ..MotionCodes::ISO
        },
        offset: Offset { word: offset_of_six, at_start: true, ..Table::ISO.offset },
        // A sender's G43.1 or G92 may be left over.
        safe: "G17 G40 G49 G80 G90 G94",
        cancel: "G92.1",
        // The length is in the work offset: the operator sets it after each change.
        length: Length { on: "", off: "", ..Table::ISO.length },
        relies: RELIES,
        leave: &[Leave::Retract],
        stops: Stops { spindle: false, coolant: false },
        dwell: Dwell::Seconds("P", 3),
        // The operator changes the tool.
        change: "M0",
        cycles: &[],
        units_inside: true,
        spindle: ["M3", "M4", "M5", ""],
        probe: "G38.2",
        interpolates: false,
        words: &[words::RETURNS, OWN],
        ..Table::ISO
    };

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        no_range(
            setup,
            "GRBL goes to the number of a rotary word, the long way round where that is one",
        )?;
        let hal = setup.flag("hal");
        let beyond = |name: &str| !matches!(name, "X" | "Y" | "Z");
        match setup.words.iter().find(|word| beyond(word.name)) {
            Some(word) if !hal => Err(format!(
                "axis {}: GRBL 1.1 has the axes X Y Z alone; the option `hal` is for grblHAL, which may have more",
                word.name
            )),
            _ => Ok(Grbl { hal, retracts: !setup.text("retract").is_empty() }),
        }
    }

    /// The end of travel is the homing switch: a homed machine stands off it by the pull-off.
    fn capabilities(&self) -> Capabilities {
        let all = Capabilities::TOOL_TABLE | Capabilities::LENGTH_IN_OFFSET;
        match self.retracts {
            true => all,
            false => all | Capabilities::RETRACT_SAID,
        }
    }

    fn write(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        match *event {
            Event::Preselect { number } if !self.hal => {
                engine.remark(&format!("NEXT T{number}"), out);
                Ok(true)
            }
            _ => Ok(false),
        }
    }
}

/// A remark without the characters that GRBL acts on wherever they stand.
fn passive(text: &str) -> String {
    remark(&text.replace(['?', '!', '~'], " ")).replace('?', " ")
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::flag(
        "hal",
        false,
        "The control is grblHAL: axes beside X Y Z, if it is built with them.",
    ),
    OptionSpec::text(
        "change",
        "M0",
        "Behind T: what changes the tool. M0: the operator does; M6 on a control that has it.",
    ),
    options::BLOCK_NUMBERS,
    options::BLOCK_STEP,
    options::SPACES,
    options::LEADING_ZEROS,
    options::decimals(3),
    options::decimals_inch(4),
    options::rotary_decimals(3),
    options::WORD_DECIMALS,
    options::TRAILING_ZEROS,
    options::feed_decimals(1),
    options::inverse_time_decimals(3),
    OptionSpec::text("work_offset", "G54", "G54 to G59."),
    options::RETRACT,
    options::RESTART,
    options::PARAMETERS,
    options::CLAMPS,
    options::COOLANT_THROUGH,
    options::COOLANT_AIR,
];

const RELIES: &[&str] = &[
    "the machine is homed: G53 counts from its zero",
    "the work offset holds the length of the tool in the spindle: it is set after each change",
    "$11 is the deviation at a junction: the control leaves corners by so much",
];

/// Words that GRBL 1.1 and grblHAL read and that are not written here.
const OWN: &[(&str, Meaning)] = &[
    (";", Meaning::Remark),
    ("G92", Meaning::SetPosition),
    ("G92.1", Meaning::SetPositionOff),
    ("G10", Meaning::TableData),
    ("G28.1", Meaning::TableData),
    ("G30.1", Meaning::TableData),
    ("G38.3", Meaning::Probe),
    ("G38.4", Meaning::Probe),
    ("G38.5", Meaning::Probe),
    ("G5", Meaning::Spline),
    ("G5.1", Meaning::Spline),
    ("G91.1", Meaning::CentreIncremental),
    ("G95", Meaning::FeedPerRevolution),
    ("G43", Meaning::LengthOn),
    ("H", Meaning::LengthRegister),
    ("G43.1", Meaning::LengthStated),
    ("G49", Meaning::LengthOff),
    ("G51", Meaning::Scale),
    ("G50", Meaning::ScaleOff),
    ("G61", Meaning::SmoothingOff),
    ("G73", Meaning::CycleBreakChip),
    ("G81", Meaning::CycleDrill),
    ("G82", Meaning::CycleDrill),
    ("G83", Meaning::CycleDeep),
    ("G85", Meaning::CycleReam),
    ("G89", Meaning::CycleReam),
    ("G86", Meaning::CycleBore),
    ("G98", Meaning::ReturnStart),
    ("G99", Meaning::ReturnClearance),
    ("M6", Meaning::ToolChange),
    ("M56", Meaning::Nothing),
    ("M62", Meaning::Nothing),
    ("M63", Meaning::Nothing),
    ("M64", Meaning::Nothing),
    ("M65", Meaning::Nothing),
];

export_dialect!(grbl, Iso<Grbl>);
