//! RepRapFirmware (Duet) as it runs printers, in the mode of M451.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use std::borrow::Cow;

use post_iso::{Control, Engine, Iso, MotionCodes, Offset, Printer, Table, offset_of_six, options};
use post_plugin::{
    Capabilities, Event, Feed, Meaning, OptionSpec, Setup, VocabularyWord, export_dialect, quantise,
};

struct RepRapFirmware {
    printer: Printer,
    /// No move is slower, mm/min.
    least_feed: f64,
}

impl Control for RepRapFirmware {
    const TABLE: &'static Table = &Table {
        options: OPTIONS,
        codes: MotionCodes { stop: ["M226", ""], ..Table::PRINTER.codes },
        relies: RELIES,
        offset: Offset {
            known: |text| {
                (Table::ISO.offset.known)(text) || matches!(text, "G59.1" | "G59.2" | "G59.3")
            },
            range: "G54 to G59 or G59.1 to G59.3",
            word: |number| match number {
                7..=9 => Some(format!("G59.{}", number - 6)),
                _ => offset_of_six(number),
            },
            at_start: false,
        },
        machine: "G53 G0",
        words: &[OWN, Table::PRINTER.words[0]],
        ..Table::PRINTER
    };

    fn table(setup: &Setup<'_>) -> &'static Table {
        if setup.flag("mill") { MILL } else { Self::TABLE }
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        let printer = Printer::open(setup, None)?;
        Ok(RepRapFirmware { printer, least_feed: setup.number("least_feed") })
    }

    fn begin(&self, engine: &mut Engine, out: &mut String) {
        self.printer.begin(engine, out);
    }

    fn write(
        &mut self,
        event: &Event<'_>,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        let feed = match event {
            Event::Linear { feed, .. } => Some(*feed),
            Event::Position { feed, .. } => *feed,
            _ => None,
        };
        match feed {
            Some(Feed::PerMinute(feed)) if feed < self.least_feed => Err(format!(
                "F{} is slower than RepRapFirmware goes, F{} (`least_feed`, M203 I): the bead would come too fast. \
                 The linear axes nearly stand while others turn: a larger feed, or another way of the part on the machine",
                quantise(feed, 3),
                self.least_feed
            )),
            _ => Ok(Printer::write(event, engine, out)),
        }
    }

    fn capabilities(&self) -> Capabilities {
        Printer::LENGTHS
    }

    fn vocabulary(&self, engine: Vec<VocabularyWord>) -> Vec<VocabularyWord> {
        let mut words = self.printer.vocabulary(engine);
        let end = |word| VocabularyWord { word: Cow::Borrowed(word), meaning: Meaning::End };
        words.extend(ENDS.map(end));
        words
    }
}

const OPTIONS: &[OptionSpec] = &[
    Printer::TRAVEL_FEED,
    Printer::MILL,
    OptionSpec::number(
        "least_feed",
        (0.0, 300.0),
        0.6,
        "F below which the firmware does not go, mm/min: that of M203 I. 30 where config.g says nothing.",
    ),
    OptionSpec::text("work_offset", "G54", "G54 to G59, or G59.1 to G59.3."),
    options::decimals(3),
    options::rotary_decimals(3),
    options::WORD_DECIMALS,
    options::TRAILING_ZEROS,
    options::feed_decimals(3),
    options::RETRACT,
    options::PARAMETERS,
];

const RELIES: &[&str] = &[
    "M451: the machine is a printer, whose G0 goes at F",
    "each rotary axis is made by M584 with R1, so that F does not count it beside linear axes",
    "config.g has M203 I0.6: without it no move is slower than 30 mm/min, and beads come too fast",
];

/// Each ends the job: no stop that goes on.
const ENDS: [&str; 3] = ["M0", "M1", "M2"];

/// Words that it reads and that are not written here.
const OWN: &[(&str, Meaning)] =
    &[("G10", Meaning::TableData), ("G4 S", Meaning::DwellSeconds), ("M116", Meaning::Nothing)];

/// Of a machine with a spindle.
const MILL: &Table = &Table {
    spindle: Printer::SPINDLE,
    coolant: Printer::COOLANT,
    ..*<RepRapFirmware as Control>::TABLE
};

export_dialect!(rrf, Iso<RepRapFirmware>);
