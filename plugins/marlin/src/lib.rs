//! Marlin 2.1, with axes beside X, Y and Z that it is built with.
//!
//! What it assumes about the control stands in `docs/src/plugin-author/controls.md`.

use post_iso::{Control, Engine, Iso, MotionCodes, Printer, Table};
use post_plugin::{AxisWord, Capabilities, Event, Meaning, Setup, VocabularyWord, export_dialect};

/// Marlin counts whole steps, and none of a way that is shorter than one: those of the finest printers, mm.
const STEP: f64 = 0.002;

struct Marlin {
    printer: Printer,
    /// Of each word whether its axis turns; none of what an extruder pushes out.
    turns: Vec<Option<bool>>,
    /// Words of the last place.
    at: Vec<f64>,
}

impl Marlin {
    /// Whether F of a cut to `words` would count degrees, though the linear axes move.
    fn counts_degrees(&self, words: &[f64]) -> bool {
        let mut most = [0.0_f64; 2];
        for ((to, from), turns) in words.iter().zip(&self.at).zip(&self.turns) {
            if let Some(turns) = turns {
                let most = &mut most[usize::from(*turns)];
                *most = most.max((to - from).abs());
            }
        }
        let [slides, turns] = most;
        turns > 0.0 && slides > 0.0 && slides < STEP
    }
}

impl Control for Marlin {
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
        let printer = Printer::open(setup, Some("Marlin"))?;
        let turns = |word: &AxisWord<'_>| (word.name != "E").then_some(word.rotary);
        let turns = setup.words.iter().map(turns).collect();
        Ok(Marlin { printer, turns, at: Vec::new() })
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
        if let Event::Linear { words, .. } = event
            && self.counts_degrees(words)
        {
            return Err(format!(
                "the linear axes go less than {STEP} mm while others turn: Marlin counts whole steps, and F would be degrees \
                 a minute: another way of the part on the machine, or another firmware"
            ));
        }
        if let Event::Position { words, .. }
        | Event::Rapid { words, .. }
        | Event::Linear { words, .. } = event
        {
            self.at.clear();
            self.at.extend_from_slice(words);
        }
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
const OWN: &[(&str, Meaning)] = &[("G4 S", Meaning::DwellSeconds), ("M1", Meaning::Stop)];

/// Of a machine with a spindle.
const MILL: &Table =
    &Table { spindle: Printer::SPINDLE, coolant: Printer::COOLANT, ..*<Marlin as Control>::TABLE };

export_dialect!(marlin, Iso<Marlin>);
