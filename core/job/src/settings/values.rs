//! Values of settings: as they are told, and how each kind of them is read.

use std::fmt;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use post_grammar::Units;
use post_machine::description::{Setting, Tcp};
use post_posting::program::{DefaultSpindle, UnknownWordPolicy, limits};

use super::groups::{Msys, Split};
use crate::files::PathArg;

/// A value as a user, a file or another program tells it.
#[derive(Clone, Debug, PartialEq)]
pub enum SettingValue {
    /// True or not.
    Yes(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A text, numbers as they are written among them.
    Text(String),
    /// A file or a folder.
    Path(PathBuf),
    /// Several of them.
    List(Vec<Self>),
}

impl From<&str> for SettingValue {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl fmt::Display for SettingValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Yes(yes) => write!(f, "{yes}"),
            Self::Whole(number) => write!(f, "{number}"),
            Self::Number(number) => write!(f, "{number:?}"),
            Self::Text(text) => f.write_str(text),
            Self::Path(path) => write!(f, "{}", path.display()),
            Self::List(values) => {
                let texts: Vec<String> = values.iter().map(Self::to_string).collect();
                f.write_str(&texts.join(","))
            }
        }
    }
}

impl SettingValue {
    /// Whether it says yes.
    ///
    /// # Errors
    /// It is something else.
    pub fn yes(&self) -> Result<bool, String> {
        match self {
            Self::Yes(yes) => Ok(*yes),
            other => Err(format!("`{other}` is neither true nor false")),
        }
    }
}

/// What values there are of a setting.
#[derive(Clone, Copy, Debug)]
pub enum SettingForm {
    /// It is told or not.
    Flag,
    /// Texts, some of which are refused.
    Text,
    /// One of these words.
    Words(fn() -> Vec<&'static str>),
    /// Whole numbers, both ends among them.
    Whole {
        /// The least of them.
        least: u64,
        /// The largest.
        most: u64,
    },
    /// Files or folders.
    Path,
    /// It is told, with or without a file.
    PathIfAny,
}

/// What values there are, and how one is read; an error says why it is none.
pub struct SettingReader<T> {
    /// What values there are.
    pub form: SettingForm,
    /// Reads one; an error says why it is none.
    pub read: fn(&SettingValue) -> Result<T, String>,
}

impl<T> SettingReader<T> {
    /// Of texts and numbers.
    pub const fn text(read: fn(&SettingValue) -> Result<T, String>) -> Self {
        Self { form: SettingForm::Text, read }
    }
}

/// A reader of one of a few words.
macro_rules! words {
    ($(#[doc = $doc:literal])* $name:ident: $type:ty { $($word:literal => $meaning:expr),* }) => {
        $(#[doc = $doc])*
        pub const $name: SettingReader<$type> = SettingReader {
            form: SettingForm::Words(|| vec![$($word),*]),
            read: |value| match value.to_string().as_str() {
                $($word => Ok($meaning),)*
                other => Err(not_one_of(other, &[$($word),*])),
            },
        };
    };
}

fn not_one_of(text: &str, words: &[&str]) -> String {
    match words {
        [one, other] => format!("`{text}` is neither {one} nor {other}"),
        words => format!("`{text}` is none of {}", words.join(", ")),
    }
}

words!(#[doc = "Units of a CL file."]
    UNITS: Units { "mm" => Units::Millimetre, "inch" => Units::Inch });

words!(#[doc = "Whether points and axes are taken into the frame of MSYS."]
    MSYS: Msys { "keep" => Msys::Keep, "apply" => Msys::Apply });

words!(#[doc = "Where one CL file becomes several programs."]
    SPLIT: Split { "operations" => Split::Operations, "tools" => Split::Tools });

words!(#[doc = "What becomes of words without effect."]
UNKNOWN: UnknownWordPolicy {
    "error" => UnknownWordPolicy::Error, "known" => UnknownWordPolicy::Known, "warn" => UnknownWordPolicy::Warn, "pass" => UnknownWordPolicy::Pass
});

words!(#[doc = "Who keeps the tip on its path."]
    TCP: Tcp { "control" => Tcp::Control, "post" => Tcp::Post });

/// Number of a tool.
pub const TOOL: SettingReader<u32> = whole32(1, u32::MAX, |value| whole(value, 1, u32::MAX.into()));

/// Number of a program.
pub const PROGRAM_NUMBER: SettingReader<u32> =
    whole32(0, u32::MAX, |value| whole(value, 0, u32::MAX.into()));

/// How often a program is planned again.
pub const ROUNDS: SettingReader<u32> = whole32(1, 100, |value| whole(value, 1, 100));

/// How many threads work at a time.
pub const JOBS: SettingReader<NonZeroUsize> = SettingReader {
    form: SettingForm::Whole { least: 1, most: u32::MAX as u64 },
    read: |value| {
        let count: usize = whole(value, 1, u32::MAX.into())?;
        NonZeroUsize::new(count).ok_or_else(|| format!("{value} is not in 1..={}", u32::MAX))
    },
};

/// How many of something, at least one.
pub const COUNT: SettingReader<u64> = SettingReader {
    form: SettingForm::Whole { least: 1, most: u64::MAX },
    read: |value| whole(value, 1, u64::MAX),
};

/// A setting of the machine file, `NAME=VALUE`; what it means is the loader's business.
pub const SETTING: SettingReader<Setting> =
    SettingReader::text(|value| Ok(Setting::Written(value.to_string())));

/// Any text.
pub const NAME: SettingReader<String> = SettingReader::text(|value| Ok(value.to_string()));

/// A word of CL files, in capitals.
pub const CL_WORD: SettingReader<String> = SettingReader::text(cl_word);

/// Revolutions a minute, or `off`.
pub const SPINDLE: SettingReader<DefaultSpindle> = SettingReader::text(spindle);

/// A feed, mm/min.
pub const FEED: SettingReader<f64> = SettingReader::text(feed);

/// A length of a tool, mm.
pub const LENGTH: SettingReader<f64> = SettingReader::text(length);

/// An angle, degrees.
pub const ANGLE: SettingReader<f64> = SettingReader::text(finite);

/// A tolerance, above zero.
pub const TOLERANCE: SettingReader<f64> = SettingReader::text(positive);

/// Three coordinates, mm.
pub const POINT: SettingReader<[f64; 3]> = SettingReader::text(point);

/// A file, `-` for the standard streams.
pub const FILE: SettingReader<PathArg> =
    SettingReader { form: SettingForm::Path, read: |value| Ok(PathArg::from(path(value))) };

/// A file, or none where it is only asked for.
pub const FILE_IF_ANY: SettingReader<Option<PathArg>> = SettingReader {
    form: SettingForm::PathIfAny,
    read: |value| match value {
        SettingValue::Yes(true) => Ok(None),
        SettingValue::Yes(false) => Err("left out, it is not asked for".to_owned()),
        value => Ok(Some(PathArg::from(path(value)))),
    },
};

/// A folder.
pub const FOLDER: SettingReader<PathBuf> =
    SettingReader { form: SettingForm::Path, read: |value| Ok(path(value)) };

const fn whole32(
    least: u32,
    most: u32,
    read: fn(&SettingValue) -> Result<u32, String>,
) -> SettingReader<u32> {
    SettingReader { form: SettingForm::Whole { least: least as u64, most: most as u64 }, read }
}

fn path(value: &SettingValue) -> PathBuf {
    match value {
        SettingValue::Path(path) => path.clone(),
        other => other.to_string().into(),
    }
}

/// A whole number from `least` to `most`.
fn whole<N: TryFrom<u64>>(value: &SettingValue, least: u64, most: u64) -> Result<N, String> {
    let text = value.to_string();
    let beyond = || format!("{text} is not in {least}..={most}");
    match text.parse::<i128>() {
        Ok(number) => {
            let number =
                u64::try_from(number).ok().filter(|number| (least..=most).contains(number));
            let number = number.and_then(|number| N::try_from(number).ok());
            number.ok_or_else(beyond)
        }
        Err(error) => Err(error.to_string()),
    }
}

/// A word of CL files, in capitals.
fn cl_word(value: &SettingValue) -> Result<String, String> {
    let text = value.to_string();
    let sign = |byte: u8| byte.is_ascii_alphanumeric() || b"_-.".contains(&byte);
    if text.starts_with(|first: char| first.is_ascii_alphabetic()) && text.bytes().all(sign) {
        Ok(text.to_ascii_uppercase())
    } else {
        Err(format!("`{text}` is no word of a CL file"))
    }
}

/// Revolutions a minute, or `off`.
pub fn spindle(value: &SettingValue) -> Result<DefaultSpindle, String> {
    if value.to_string().eq_ignore_ascii_case("off") {
        return Ok(DefaultSpindle::Still);
    }
    match positive(value) {
        Ok(rpm) => Ok(DefaultSpindle::On(rpm)),
        Err(message) => Err(format!("{message}; a speed or `off` is meant")),
    }
}

/// Three coordinates: `X,Y,Z`, or a list.
pub fn point(value: &SettingValue) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> = match value {
        SettingValue::List(values) => values.iter().map(finite).collect::<Result<_, _>>()?,
        other => {
            let text = other.to_string();
            let numbers = text.split(',').map(|number| finite(&SettingValue::from(number.trim())));
            numbers.collect::<Result<_, _>>()?
        }
    };
    numbers.try_into().map_err(|numbers: Vec<f64>| {
        format!("three numbers are needed, X,Y,Z; there are {}", numbers.len())
    })
}

/// A number that is neither infinite nor no number.
pub fn finite(value: &SettingValue) -> Result<f64, String> {
    let number = match value {
        SettingValue::Number(number) => Some(*number),
        SettingValue::Whole(number) => Some(*number as f64),
        SettingValue::Text(text) => text.parse().ok(),
        _ => None,
    };
    match number {
        Some(number) if number.is_finite() => Ok(number),
        _ => Err(format!("`{value}` is no number")),
    }
}

/// A number from zero up.
pub fn not_negative(value: &SettingValue) -> Result<f64, String> {
    match finite(value)? {
        number if number >= 0.0 => Ok(number),
        number => Err(format!("{number} is below zero")),
    }
}

/// A feed, mm/min.
pub fn feed(value: &SettingValue) -> Result<f64, String> {
    let feed = positive(value)?;
    let [least, most] = limits::FEEDS;
    if (least..=most).contains(&feed) {
        Ok(feed)
    } else {
        Err(format!("{feed:e} is no feed: the largest is {most:e} mm/min"))
    }
}

/// A length from zero up, mm.
pub fn length(value: &SettingValue) -> Result<f64, String> {
    match not_negative(value)? {
        length if length <= limits::MOST_COORDINATE => Ok(length),
        length => Err(format!(
            "{length:e} mm is no length of a tool: the largest is {:e} mm",
            limits::MOST_COORDINATE
        )),
    }
}

/// A time between two set-points, s: no control is faster, and none so slow.
pub fn period(value: &SettingValue) -> Result<f64, String> {
    match finite(value)? {
        number if (1e-5..=1.0).contains(&number) => Ok(number),
        number => Err(format!(
            "{number} s between two set-points; from 0.00001 to 1 s is possible, and controls have 0.0005 to 0.02 s"
        )),
    }
}

/// A number above zero.
pub fn positive(value: &SettingValue) -> Result<f64, String> {
    match finite(value)? {
        number if number > 0.0 => Ok(number),
        number => Err(format!("{number} is not above zero")),
    }
}
