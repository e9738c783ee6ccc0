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

    /// A text, or a choice, that was declared.
    pub fn text(&self, key: &str) -> &'a str {
        match self.option(key) {
            Some(Value::Text(text)) => text,
            _ => panic!("the text `{key}` is not declared"),
        }
    }
}

/// One axis word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AxisWord<'a> {
    /// Its address: `X`, `C`, …
    pub name: &'a str,
    /// A rotary axis (degrees), else linear.
    pub rotary: bool,
    /// A rotary axis whose words lie within one turn: the control must take the shorter way.
    pub wrapped: bool,
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

impl OptionSpec {
    /// `true` or `false`.
    pub const fn flag(key: &'static str, default: bool, help: &'static str) -> Self {
        OptionSpec {
            key,
            kind: OptionKind::Flag,
            default: Value::Flag(default),
            help,
        }
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

    /// Any text.
    pub const fn text(key: &'static str, default: &'static str, help: &'static str) -> Self {
        OptionSpec {
            key,
            kind: OptionKind::Text,
            default: Value::Text(default),
            help,
        }
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
    /// Any text.
    Text,
    /// One of these.
    Choice(&'static [&'static str]),
}
