//! Klipper: X, Y and Z, and rotary axes that `MANUAL_STEPPER GCODE_AXIS` adds to G1.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{Control, Engine, Iso, MotionCodes, Printer, Table};
use post_plugin::{Capabilities, Event, Setup, VocabularyWord, export_dialect};

struct Klipper {
    printer: Printer,
}

impl Control for Klipper {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table { relies: RELIES, ..Table::PRINTER };

    fn table(setup: &Setup<'_>) -> &'static Table {
        if setup.flag("mill") { MILL } else { Self::TABLE }
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        Ok(Klipper { printer: Printer::open(setup, Some("Klipper"))? })
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
        Ok(Printer::write(event, engine, out))
    }

    fn capabilities(&self) -> Capabilities {
        Printer::LENGTHS
            | Capabilities::NO_PARK
            | self.printer.retract()
            | Capabilities::FEED_LONGEST_TURN
    }

    fn vocabulary(&self, engine: Vec<VocabularyWord>) -> Vec<VocabularyWord> {
        self.printer.vocabulary(engine)
    }
}

const RELIES: &[&str] = &[
    "the part origin is the zero of the words: SET_GCODE_OFFSET or G92 puts it there ahead of the program",
    "each rotary axis is a manual_stepper in degrees with GCODE_AXIS, LIMIT_VELOCITY and LIMIT_ACCEL",
    "max_velocity is no less than F: it would slow a block down",
];

/// Of a machine with a spindle, whose words are macros.
const MILL: &Table = &Table {
    codes: MotionCodes { stop: ["M0", "M1"], ..Table::PRINTER.codes },
    spindle: Printer::SPINDLE,
    coolant: Printer::COOLANT,
    ..*<Klipper as Control>::TABLE
};

export_dialect!(klipper, Iso<Klipper>);
