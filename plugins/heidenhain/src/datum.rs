//! Where coordinates count from: presets, tilted planes.

use post_plugin::{NumberStyle, Setup, Units};

use crate::cycles::{CycleParameter, block};
use crate::{Heidenhain, SIGNED};

/// What the options say of datums and planes.
pub(crate) struct Datum {
    /// `TRANS DATUM` in the place of cycle 7.
    trans: bool,
    /// How the rotary axes come to a plane: they stand there already.
    positioning: String,
    /// Program units in a millimetre.
    scale: f64,
    /// A plane's origin is in force.
    shifted: bool,
}

impl Datum {
    pub(crate) fn new(setup: &Setup<'_>) -> Self {
        Datum {
            trans: setup.text("datum_shift") == "TRANS DATUM",
            positioning: setup.text("plane").to_owned(),
            scale: match setup.units {
                Units::Millimetre => 1.0,
                Units::Inch => 1.0 / 25.4,
            },
            shifted: false,
        }
    }

    /// A length in program units.
    pub(crate) fn length(&self, millimetres: f64) -> f64 {
        millimetres * self.scale
    }
}

impl Heidenhain {
    /// A row of the preset table; the second block goes on with the first and has no number.
    pub(crate) fn preset_row(&mut self, row: i64, out: &mut String) {
        let name = if self.german { "BEZUGSPUNKT SETZEN" } else { "DATUM SETTING" };
        let words = block(
            &format!("CYCL DEF 247 {name}"),
            &[CycleParameter::new(339, row as f64, "DATUM NUMBER")],
        );
        self.block.line(&words, out);
    }

    /// The n-th work offset: that of the program's start is the first.
    pub(crate) fn preset(&mut self, number: u32, out: &mut String) {
        self.preset_row(i64::from(number) + self.preset.max(1) - 1, out);
    }

    /// A datum shift, mm.
    fn shift(&mut self, origin: [f64; 3], out: &mut String) {
        let origin = origin.map(|length| self.datum.length(length));
        let axes = ["X", "Y", "Z"];
        if self.datum.trans {
            self.block.word("TRANS DATUM AXIS");
            for (axis, length) in axes.into_iter().zip(origin) {
                self.block.number(axis, length, 4, SIGNED);
            }
            self.block.end(out);
            return;
        }
        let name = if self.german { "NULLPUNKT" } else { "DATUM SHIFT" };
        self.block.line(&format!("CYCL DEF 7.0 {name}"), out);
        for (axis, (place, length)) in axes.into_iter().zip((1..).zip(origin)) {
            self.block.word(&format!("CYCL DEF 7.{place}"));
            self.block.number(axis, length, 4, SIGNED).end(out);
        }
    }

    /// A tilted plane: its origin, mm, then its angles about the fixed axes Z, Y, X.
    pub(crate) fn tilt(&mut self, origin: [f64; 3], [c, b, a]: [f64; 3], out: &mut String) {
        if origin != [0.0; 3] {
            self.shift(origin, out);
            self.datum.shifted = true;
        }
        let style = NumberStyle { trim: true, ..SIGNED };
        self.block.word("PLANE SPATIAL");
        self.block.number("SPA", a, 4, style).number("SPB", b, 4, style);
        self.block.number("SPC", c, 4, style);
        // An axis that the tool leaves free would else go to zero, and the coordinates turn in its place.
        let upright = a == 0.0 && b == 0.0 && c != 0.0;
        match upright && !self.datum.positioning.contains(" ROT") {
            true => self.block.line(&format!("{} TABLE ROT", self.datum.positioning), out),
            false => self.block.line(&self.datum.positioning, out),
        };
        self.tilted = true;
    }

    /// Out of it in the order in which it was entered.
    pub(crate) fn upright(&mut self, out: &mut String) {
        self.block.line("PLANE RESET STAY", out);
        if std::mem::take(&mut self.datum.shifted) {
            self.shift([0.0; 3], out);
        }
        self.tilted = false;
    }
}
