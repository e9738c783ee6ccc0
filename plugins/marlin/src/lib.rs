//! Marlin 2.1, with axes beside X, Y and Z that it is built with.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{Control, Engine, Iso, MotionCodes, Printer, Table};
use post_plugin::{Capabilities, Event, Meaning, Setup, VocabularyWord, export_dialect};

struct Marlin {
    printer: Printer,
}

impl Control for Marlin {
    const LEAVES_CUTS: bool = true;

    const TABLE: &'static Table = &Table {
        codes: MotionCodes { stop: ["M0", ""], ..Table::PRINTER.codes },
        relies: RELIES,
        words: &[OWN, Table::PRINTER.words[0]],
        ..Table::PRINTER
    };

    fn table(setup: &Setup<'_>) -> &'static Table {
        if setup.flag("mill") { MILL } else { Self::TABLE }
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        Ok(Marlin { printer: Printer::open(setup, Some("Marlin"))? })
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
        Printer::LENGTHS | Capabilities::NO_PARK | self.printer.retract()
    }

    fn vocabulary(&self, engine: Vec<VocabularyWord>) -> Vec<VocabularyWord> {
        self.printer.vocabulary(engine)
    }
}

const RELIES: &[&str] = &[
    "the part origin is the zero of the words: G92 or a G54 of the build puts it there ahead of the program",
    "rotary axes are built with AXIS4_ROTATES and AXIS4_NAME, so that F does not count them beside X, Y and Z",
    "M0 waits for the user (a build with HAS_RESUME_CONTINUE), and S of M3 is a speed (CUTTER_POWER_UNIT RPM)",
    "a block whose linear axes go less than 1 um counts as one of rotary axes alone",
];

/// Words that it reads and that are not written here.
const OWN: &[(&str, Meaning)] = &[("G4 S", Meaning::DwellSeconds)];

/// Of a machine with a spindle.
const MILL: &Table =
    &Table { spindle: Printer::SPINDLE, coolant: Printer::COOLANT, ..*<Marlin as Control>::TABLE };

export_dialect!(marlin, Iso<Marlin>);
