//! What a plugin is told before its first call, and the options that it declares.

use std::fmt;

use crate::field::{Codes, codes};
use crate::model::Tolerance;

/// What a dialect is told before the first event. Lives as long as the call.
#[derive(Clone, Copy, Debug, Default)]
pub struct Setup<'a> {
    /// Name of the program (the output file's stem).
    pub program: &'a str,
    /// Name of the machine.
    pub machine: &'a str,
    /// Units of all lengths and feeds of this program.
    pub units: Units,
    /// The control keeps the tip on its path (G43.4, TRAORI, M128): linear words are the tip in the part frame.
    pub tcp: bool,
    /// The spindle turns the part, and the tool stands: a lathe.
    pub turns_part: bool,
    /// The axis words of a move, in the order in which they are written.
    pub words: &'a [AxisWord<'a>],
    /// Options from the machine file, checked against [`OptionSpec`] and completed by the defaults.
    pub options: &'a [(&'a str, Value<'a>)],
    /// Name of the CL file, without its folder; empty if it has none (standard input).
    pub cl_file: &'a str,
    /// What the program is certified to keep; none where nothing is certified.
    pub accuracy: Option<Accuracy>,
    /// What is known of the whole program; none if the host has not looked ahead.
    pub ahead: Option<Ahead<'a>>,
}

/// What a program is certified to keep against the CL path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Tolerance of a cut.
    pub cut: Tolerance,
    /// Tolerance of a rapid's tip, mm.
    pub rapid: f64,
}

/// What a first pass over the CL file found.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<'a> {
    /// The tools in the order in which they are first used.
    pub tools: &'a [Tool<'a>],
    /// Least and largest tip, mm, part frame; none if there is no move.
    pub extents: Option<[[f64; 3]; 2]>,
    /// The program's time, seconds; none if not known.
    pub time: Option<f64>,
}

/// A tool of the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tool<'a> {
    /// Tool number.
    pub number: u32,
    /// Name of the tool, empty if not known.
    pub name: &'a str,
    /// Length from the gauge point to the tip, mm; none if not known.
    pub length: Option<f64>,
    /// Diameter of the cutter, mm; none if not known.
    pub diameter: Option<f64>,
    /// Radius of the cutter's corner, mm; none if not known.
    pub corner_radius: Option<f64>,
}

/// Where the rotary axes of a machine stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinematics {
    /// Rotary axes that carry the part.
    pub table: usize,
    /// Rotary axes that carry the tool.
    pub head: usize,
}

impl<'a> Setup<'a> {
    /// The machine's class: how many of its rotary words turn the part, and how many the tool.
    pub fn kinematics(&self) -> Kinematics {
        let count = |carries_part: bool| {
            let words = self.words.iter();
            words.filter(|word| word.rotary && word.carries_part == carries_part).count()
        };
        Kinematics { table: count(true), head: count(false) }
    }

    /// Tools are turned with in X and Z, the only axes that there are.
    pub fn turns_in_zx(&self) -> bool {
        let named = |name| self.words.iter().any(|word| word.name == name);
        let two = self.words.iter().all(|word| !word.rotary && matches!(word.name, "X" | "Z"));
        self.turns_part && two && named("X") && named("Z")
    }

    /// X is a diameter.
    pub fn has_diameters(&self) -> bool {
        self.words.iter().any(|word| word.name == "X" && word.diameter)
    }

    /// An option's value. Every declared option has one.
    pub fn option(&self, key: &str) -> Option<Value<'a>> {
        self.options.iter().find(|(name, _)| *name == key).map(|(_, value)| *value)
    }

    /// A flag that was declared.
    ///
    /// # Panics
    /// If it was not: the author's slip, which the host reports as such. So do the three below.
    pub fn flag(&self, key: &str) -> bool {
        match self.option(key) {
            Some(Value::Flag(flag)) => flag,
            _ => panic!("the flag `{key}` is not declared"),
        }
    }

    /// A whole number that was declared.
    pub fn integer(&self, key: &str) -> i64 {
        match self.option(key) {
            Some(Value::Integer(integer)) => integer,
            _ => panic!("the whole number `{key}` is not declared"),
        }
    }

    /// A number that was declared.
    pub fn number(&self, key: &str) -> f64 {
        match self.option(key) {
            Some(Value::Number(number)) => number,
            _ => panic!("the number `{key}` is not declared"),
        }
    }

    /// A text, lines or a choice that was declared.
    pub fn text(&self, key: &str) -> &'a str {
        match self.option(key) {
            Some(Value::Text(text)) => text,
            _ => panic!("the text `{key}` is not declared"),
        }
    }
}

/// One axis word.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisWord<'a> {
    /// Address: `X`, `C`, …
    pub name: &'a str,
    /// A rotary axis (degrees), else linear.
    pub rotary: bool,
    /// A rotary axis whose words lie within one turn: the control must take the shorter way.
    pub wrapped: bool,
    /// A rotary axis without ends whose word is a place within one turn, from 0 to 360, and by its sign the way there: under
    /// [`Capabilities::SIGN_IS_WAY`](crate::Capabilities::SIGN_IS_WAY).
    pub signed: bool,
    /// The linear axis along the spindle at all axes zero: moved last when the tool comes near, first when it goes.
    pub depth: bool,
    /// The axis carries the part, else the tool.
    pub carries_part: bool,
    /// Its word is a diameter: twice the position of the axis.
    pub diameter: bool,
    /// Least and largest position of the axis as the machine shows it, mm or degrees, whatever the units are;
    /// none for one without ends.
    pub travel: Option<[f64; 2]>,
}

codes! {
    /// Units of a program.
    #[derive(Default)]
    Units "UNITS" {
        /// mm, mm/min.
        #[default]
        Millimetre = 1 "MILLIMETRE",
        /// inch, inch/min.
        Inch = 2 "INCH",
    }
}

/// The value of an option.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// `true`, `false`.
    Flag(bool),
    /// A whole number.
    Integer(i64),
    /// A number.
    Number(f64),
    /// Text.
    Text(&'a str),
}

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flag(flag) => flag.fmt(f),
            Self::Integer(integer) => integer.fmt(f),
            Self::Number(number) => number.fmt(f),
            Self::Text(text) => write!(f, "\"{text}\""),
        }
    }
}

/// An option that a plugin accepts in `[control.<dialect>]` or `[accuracy.<model>]`.
#[derive(Clone, Copy, Debug)]
pub struct OptionSpec {
    /// Key of the option.
    pub key: &'static str,
    /// What it takes.
    pub kind: OptionKind,
    /// Value where the machine file does not give it.
    pub default: Value<'static>,
    /// One sentence: what it does, with its unit.
    pub help: &'static str,
}

impl OptionSpec {
    /// `true` or `false`.
    pub const fn flag(key: &'static str, default: bool, help: &'static str) -> Self {
        OptionSpec { key, kind: OptionKind::Flag, default: Value::Flag(default), help }
    }

    /// A whole number from `min` to `max`.
    pub const fn integer(
        key: &'static str,
        (min, max): (i64, i64),
        default: i64,
        help: &'static str,
    ) -> Self {
        OptionSpec {
            key,
            kind: OptionKind::Integer { min, max },
            default: Value::Integer(default),
            help,
        }
    }

    /// A number from `min` to `max`.
    pub const fn number(
        key: &'static str,
        (min, max): (f64, f64),
        default: f64,
        help: &'static str,
    ) -> Self {
        OptionSpec {
            key,
            kind: OptionKind::Number { min, max },
            default: Value::Number(default),
            help,
        }
    }

    /// Lines of the program.
    pub const fn lines(key: &'static str, default: &'static str, help: &'static str) -> Self {
        OptionSpec { key, kind: OptionKind::Lines, default: Value::Text(default), help }
    }

    /// Any text, of one line.
    pub const fn text(key: &'static str, default: &'static str, help: &'static str) -> Self {
        OptionSpec { key, kind: OptionKind::Text, default: Value::Text(default), help }
    }
}

/// What an option takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OptionKind {
    /// `true` or `false`.
    Flag,
    /// A whole number, both ends allowed.
    Integer {
        /// Least.
        min: i64,
        /// Largest.
        max: i64,
    },
    /// A number, both ends allowed.
    Number {
        /// Least.
        min: f64,
        /// Largest.
        max: f64,
    },
    /// Any text, of one line.
    Text,
    /// Lines of the program, letter for letter: the machine file gives a text or an array of them. They come as one
    /// text with line feeds between.
    Lines,
    /// One of these.
    Choice(&'static [&'static str]),
}
