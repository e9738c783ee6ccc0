//! Values of flags: words that stand for one of a few things, numbers, points.

use std::convert::Infallible;

use clap::ValueEnum;
use clap::builder::{EnumValueParser, TypedValueParser};
use post_grammar::Units;
use post_machine::description::{OutputUnits, Setting, Tcp};
use post_posting::program::{ToldSpindle, Unknown, limits};

/// `--units`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum UnitsWord {
    Mm,
    Inch,
}

/// `--tcp`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TcpWord {
    Control,
    Post,
}

/// `--unknown`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum UnknownWord {
    Error,
    Known,
    Warn,
    Pass,
}

/// `--msys`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Msys {
    #[default]
    Keep,
    Apply,
}

/// Reads one of the words `W`, and takes it for what it means.
pub fn word<W, T>() -> impl TypedValueParser<Value = T>
where
    W: ValueEnum + Clone + Send + Sync + 'static,
    T: From<W> + Clone + Send + Sync + 'static,
{
    EnumValueParser::<W>::new().map(T::from)
}

impl From<UnitsWord> for Units {
    fn from(word: UnitsWord) -> Self {
        match word {
            UnitsWord::Mm => Self::Millimetre,
            UnitsWord::Inch => Self::Inch,
        }
    }
}

impl From<UnitsWord> for OutputUnits {
    fn from(word: UnitsWord) -> Self {
        match word {
            UnitsWord::Mm => Self::Mm,
            UnitsWord::Inch => Self::Inch,
        }
    }
}

impl From<TcpWord> for Tcp {
    fn from(word: TcpWord) -> Self {
        match word {
            TcpWord::Control => Self::Control,
            TcpWord::Post => Self::Post,
        }
    }
}

impl From<UnknownWord> for Unknown {
    fn from(word: UnknownWord) -> Self {
        match word {
            UnknownWord::Error => Self::Error,
            UnknownWord::Known => Self::Known,
            UnknownWord::Warn => Self::Warn,
            UnknownWord::Pass => Self::Pass,
        }
    }
}

/// `NAME=VALUE`; what it means to the machine file is the loader's business.
pub fn setting(text: &str) -> Result<Setting, Infallible> {
    Ok(Setting::Written(text.to_owned()))
}

/// A word of CL files, in capitals.
pub fn cl_word(text: &str) -> Result<String, String> {
    let sign = |byte: u8| byte.is_ascii_alphanumeric() || b"_-.".contains(&byte);
    if text.starts_with(|first: char| first.is_ascii_alphabetic()) && text.bytes().all(sign) {
        Ok(text.to_ascii_uppercase())
    } else {
        Err(format!("`{text}` is no word of a CL file"))
    }
}

/// Revolutions a minute, or `off`.
pub fn spindle(text: &str) -> Result<ToldSpindle, String> {
    if text.eq_ignore_ascii_case("off") {
        return Ok(ToldSpindle::Still);
    }
    match positive(text) {
        Ok(rpm) => Ok(ToldSpindle::On(rpm)),
        Err(message) => Err(format!("{message}; a speed or `off` is meant")),
    }
}

/// `X,Y,Z`.
pub fn point(text: &str) -> Result<[f64; 3], String> {
    let numbers = text
        .split(',')
        .map(|number| finite(number.trim()))
        .collect::<Result<Vec<f64>, String>>()?;
    numbers.try_into().map_err(|numbers: Vec<f64>| {
        format!("three numbers are needed, X,Y,Z; there are {}", numbers.len())
    })
}

/// A number that is neither infinite nor no number.
pub fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("`{text}` is no number")),
    }
}

/// A number from zero up.
pub fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        number if number >= 0.0 => Ok(number),
        number => Err(format!("{number} is below zero")),
    }
}

/// A feed, mm/min.
pub fn feed(text: &str) -> Result<f64, String> {
    let feed = positive(text)?;
    let [least, most] = limits::FEEDS;
    if (least..=most).contains(&feed) {
        Ok(feed)
    } else {
        Err(format!("{feed:e} is no feed: the largest is {most:e} mm/min"))
    }
}

/// A length from zero up, mm.
pub fn length(text: &str) -> Result<f64, String> {
    match not_negative(text)? {
        length if length <= limits::MOST_COORDINATE => Ok(length),
        length => Err(format!(
            "{length:e} mm is no length of a tool: the largest is {:e} mm",
            limits::MOST_COORDINATE
        )),
    }
}

/// A time between two set-points, s: no control is faster, and none so slow.
pub fn period(text: &str) -> Result<f64, String> {
    match finite(text)? {
        number if (1e-5..=1.0).contains(&number) => Ok(number),
        number => Err(format!(
            "{number} s between two set-points; from 0.00001 to 1 s is possible, and controls have 0.0005 to 0.02 s"
        )),
    }
}

/// A number above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        number if number > 0.0 => Ok(number),
        number => Err(format!("{number} is not above zero")),
    }
}
