//! What a plugin is told before its first call, and the options that it declares.

/// What a dialect is told before the first event. Lives as long as the call.
#[derive(Clone, Copy, Debug)]
pub struct Setup<'a> {
    /// Name of the program (the output file's stem).
    pub program: &'a str,
    /// Name of the machine.
    pub machine: &'a str,
    /// Units of all lengths and feeds of this program.
    pub units: Units,
    /// The control keeps the tip on its path (G43.4, TRAORI, M128): linear words are the tip in the part frame.
    pub tcp: bool,
    /// The axis words of a move, in the order in which they are written.
    pub words: &'a [AxisWord<'a>],
    /// Options from the machine file, checked against [`OptionSpec`] and completed by the defaults.
    pub options: &'a [(&'a str, Value<'a>)],
}

impl<'a> Setup<'a> {
    /// An option's value. Every declared option has one.
    pub fn option(&self, key: &str) -> Option<Value<'a>> {
        self.options
            .iter()
            .find(|(name, _)| *name == key)
            .map(|(_, value)| *value)
    }
}

/// One axis word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisWord<'a> {
    /// Its address: `X`, `C`, …
    pub name: &'a str,
    /// A rotary axis (degrees), else linear.
    pub rotary: bool,
    /// The linear axis along the spindle at all axes zero: moved last when the tool comes near, first when it goes.
    pub depth: bool,
}

/// Units of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// mm, mm/min.
    Millimetre,
    /// inch, inch/min.
    Inch,
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

/// An option that a plugin accepts in `[control.<dialect>]` or `[accuracy.<model>]`.
#[derive(Clone, Copy, Debug)]
pub struct OptionSpec {
    /// Its key.
    pub key: &'static str,
    /// What it takes.
    pub kind: OptionKind,
    /// Its value where the machine file does not give it.
    pub default: Value<'static>,
    /// One sentence: what it does, with its unit.
    pub help: &'static str,
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
    /// Any text.
    Text,
    /// One of these.
    Choice(&'static [&'static str]),
}
