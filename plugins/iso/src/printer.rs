//! Firmware of printers: a command in a line, G0 at F, and E for what an extruder pushes out.

use post_plugin::{
    AxisNames, Capabilities, Event, Language, Meaning, OptionSpec, Setup, Units, VocabularyWord,
    ascii,
};

use crate::table::{Dwell, Leave, Length, MotionCodes, Offset, Stops, Table};
use crate::{Engine, no_range, options};

/// What the dialects of printers have in common beside their table.
#[derive(Clone, Copy, Debug)]
pub struct Printer {
    /// A word E goes with the way of the tip.
    extrudes: bool,
    /// Lines of the user's own retract the tool.
    retracts: bool,
    /// There is a spindle.
    mills: bool,
}

impl Printer {
    /// The option that rapids need.
    pub const TRAVEL_FEED: OptionSpec = OptionSpec::number(
        "travel_feed",
        (1.0, 1_000_000.0),
        6000.0,
        "F of rapids, mm/min: G0 goes at F, as G1 does. Degrees a minute where rotary axes alone turn.",
    );

    /// The option that says that there is a spindle.
    pub const MILL: OptionSpec = OptionSpec::flag(
        "mill",
        false,
        "The machine has a spindle: M3, M4, M5 and M7, M8, M9 are words of the firmware as it is built, or macros of your \
         own; else what turns a spindle or opens a coolant is refused.",
    );
    /// [`Table::spindle`] of a machine that has one.
    pub const SPINDLE: [&str; 4] = ["M3", "M4", "M5", ""];
    /// [`Table::coolant`] of a machine with a spindle.
    pub const COOLANT: [&str; 5] = ["M9", "M8", "M7", "", ""];

    /// What is refused whatever the firmware: inches, words within one turn, and linear axes that F does not count, where
    /// it counts those of X, Y and Z alone (`counts`: what does so).
    ///
    /// # Errors
    /// The sentence for the user.
    pub fn open(setup: &Setup<'_>, counts: Option<&str>) -> Result<Self, String> {
        no_range(
            setup,
            "this control goes to the number of a rotary word, the long way round where that is one",
        )?;
        if setup.units == Units::Inch {
            return Err("inches are not sure to be read by this control: [control] units = \"mm\""
                .to_owned());
        }
        let beside = |name: &str| !matches!(name, "X" | "Y" | "Z" | "E");
        let slide = setup.words.iter().find(|word| !word.rotary && beside(word.name));
        if let (Some(slide), Some(counts)) = (slide, counts) {
            return Err(format!(
                "axis {}: {counts} counts F along X, Y and Z alone, so that a linear axis beside them would go at a speed of \
                 its own",
                slide.name
            ));
        }
        Ok(Printer {
            extrudes: setup.words.iter().any(|word| word.name == "E"),
            retracts: !setup.text("retract").is_empty(),
            mills: setup.flag("mill"),
        })
    }

    /// No length is put on, and no register named.
    pub const LENGTHS: Capabilities = Capabilities::TOOL_TABLE.and(Capabilities::LENGTH_IN_OFFSET);

    /// Of firmware without machine coordinates: the machine file must say how the tool leaves, unless lines do.
    pub fn retract(&self) -> Capabilities {
        match self.retracts {
            true => Capabilities::NONE,
            false => Capabilities::RETRACT_SAID,
        }
    }

    /// The extruder counts from here, by positions.
    pub fn begin(&self, engine: &mut Engine, out: &mut String) {
        if self.extrudes {
            engine.line("M82\nG92 E0", out);
        }
    }

    /// T alone would take the tool at once: the one that comes next is a remark.
    pub fn write(event: &Event<'_>, engine: &Engine, out: &mut String) -> bool {
        match *event {
            Event::Preselect { number } => {
                engine.remark(&format!("next T{number}"), out);
                true
            }
            _ => false,
        }
    }

    /// The words of the family that firmware of printers has: nothing ends a program but the end of its file (M30 deletes a
    /// file), nothing is in force that G80 would end.
    pub fn vocabulary(&self, words: Vec<VocabularyWord>) -> Vec<VocabularyWord> {
        let foreign = |meaning| match meaning {
            Meaning::End | Meaning::CycleOff => true,
            Meaning::CoolantOn | Meaning::CoolantOff => !self.mills,
            _ => false,
        };
        let read = words.into_iter().filter(|word| !foreign(word.meaning));
        read.filter(|word| !matches!(word.word.as_ref(), "%" | "(" | ")")).collect()
    }
}

impl Table {
    /// Firmware of printers. What it does not have in common stands in the tables of its dialects.
    pub const PRINTER: Table = Table {
        options: PRINTER_OPTIONS,
        axes: AxisNames::PRINTER,
        language: Language::Rs274,
        extension: "gcode",
        percent: false,
        remark: semicolon,
        remark_length: 90,
        // Marlin's buffer has 96 characters, and the end of the line is one of them.
        line_length: Some(95),
        codes: MotionCodes {
            // They would be cut into chords there, by a length of the control's own.
            arc: ["", ""],
            feed: ["", "", ""],
            compensation: ["", "", ""],
            stop: ["", ""],
            ..MotionCodes::ISO
        },
        safe: "G90",
        rapids_at_feed: true,
        command_a_line: true,
        offset: Offset { known: str::is_empty, range: "none", word: |_| None, at_start: false },
        length: Length { on: "", off: "", ..Table::ISO.length },
        machine: "",
        leave: &[Leave::Retract],
        stops: Stops { spindle: false, coolant: false },
        dwell: Dwell::Milliseconds("P"),
        change: "",
        cycles: &[],
        spindle: ["", "", "", ""],
        coolant: ["", "", "", "", ""],
        end: "",
        interpolates: false,
        words: &[PRINTER_WORDS],
        ..Table::ISO
    };
}

/// The options of a printer's dialect.
const PRINTER_OPTIONS: &[OptionSpec] = &[
    Printer::TRAVEL_FEED,
    Printer::MILL,
    options::decimals(3),
    options::rotary_decimals(3),
    options::WORD_DECIMALS,
    options::TRAILING_ZEROS,
    options::feed_decimals(3),
    options::RETRACT,
    options::PARAMETERS,
];

/// A remark to the end of the line: parentheses are none.
fn semicolon(text: &str) -> String {
    format!("; {}", ascii(text).replace(['*', '\n'], " "))
}

/// Words that all of them read beside those that are written, and what others of the language mean by a word of theirs. M30
/// deletes a file of the card, and the job goes on.
const PRINTER_WORDS: &[(&str, Meaning)] = &[
    (";", Meaning::Remark),
    ("G2", Meaning::ArcClockwise),
    ("G3", Meaning::ArcCounterClockwise),
    ("G28", Meaning::ReferenceReturn),
    ("G92", Meaning::SetPosition),
    ("M17", Meaning::Nothing),
    ("M23", Meaning::NotFollowed),
    ("M24", Meaning::NotFollowed),
    ("M30", Meaning::NotFollowed),
    ("M32", Meaning::NotFollowed),
    ("M73", Meaning::Nothing),
    ("M82", Meaning::ExtruderPositions),
    ("M83", Meaning::NotFollowed),
    ("M18", Meaning::Nothing),
    ("M84", Meaning::Nothing),
    ("M92", Meaning::NotFollowed),
    ("M98", Meaning::NotFollowed),
    ("M104", Meaning::Nothing),
    ("M104 S", Meaning::Nothing),
    ("M104 T", Meaning::Nothing),
    ("M106", Meaning::Nothing),
    ("M106 S", Meaning::Nothing),
    ("M107", Meaning::Nothing),
    ("M109", Meaning::Nothing),
    ("M109 S", Meaning::Nothing),
    ("M109 T", Meaning::Nothing),
    ("M140", Meaning::Nothing),
    ("M140 S", Meaning::Nothing),
    ("M190", Meaning::Nothing),
    ("M190 S", Meaning::Nothing),
    ("M206", Meaning::NotFollowed),
    ("M220", Meaning::NotFollowed),
    ("M221", Meaning::NotFollowed),
    ("M290", Meaning::NotFollowed),
    ("M400", Meaning::Nothing),
    ("M600", Meaning::NotFollowed),
];
