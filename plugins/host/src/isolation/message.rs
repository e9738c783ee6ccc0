//! What the two processes tell each other.

use post_plugin::raw::PostFormat;
use post_plugin::{Curve, Deviation, OptionSpec, Tolerance};

use super::wire::Wire;
use crate::function::Function;
use crate::{GivenValue, ProgramSetup, Reason};

/// What a library's process is asked. A batch follows [`Request::Write`] as [`post_plugin::Batch::put_bytes`] has it.
#[derive(Debug)]
pub(crate) enum Request {
    /// Open the dialect; the answer is [`DialectOpened`].
    Dialect(Box<ProgramSetup>),
    /// Open the error model; the answer is `Result<(), String>`.
    Model(Vec<(String, GivenValue)>),
    /// The answer is [`Written`].
    Write,
    /// The answer is `Result<Vec<(String, u32)>, String>`.
    Vocabulary,
    /// The answer is `Result<Vec<String>, String>`.
    ReliesOn,
    /// The answers are [`Fitted`].
    Fit(Tolerance),
    /// The answer is `Result<Vec<Deviation>, String>`.
    Value(Box<Curve>, Vec<f64>),
    /// Close what is open; the answer is empty.
    Close,
}

/// Its format, or the sentence with which it could not tell that; or the sentence with which it refuses.
pub(crate) type DialectOpened = Result<Result<PostFormat, String>, String>;

/// What a library is.
#[derive(Debug)]
pub(crate) struct Description {
    pub(crate) version: String,
    pub(crate) about: String,
    pub(crate) is_model: bool,
    pub(crate) hash: String,
    pub(crate) options: Vec<OptionSpec>,
}

/// What a dialect wrote of a batch.
#[derive(Debug)]
pub(crate) struct Written {
    pub(crate) text: String,
    /// Where the text of each event ends.
    pub(crate) ends: Vec<u64>,
    /// Which event could not be written, and why.
    pub(crate) fault: Option<(u64, String)>,
}

/// What an error model wants or answers.
#[derive(Debug)]
pub(crate) enum Fitted {
    /// The deviations at these places, which are sent to it.
    Wants(Vec<f64>),
    Answers(Result<Box<Curve>, String>),
}

impl Wire for Request {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Request::Dialect(setup) => {
                0_u8.put(to);
                setup.put(to);
            }
            Request::Model(options) => {
                1_u8.put(to);
                options.put(to);
            }
            Request::Write => 2_u8.put(to),
            Request::Vocabulary => 3_u8.put(to),
            Request::ReliesOn => 4_u8.put(to),
            Request::Fit(tolerance) => (5_u8, *tolerance).put(to),
            Request::Value(curve, places) => {
                6_u8.put(to);
                curve.put(to);
                places.put(to);
            }
            Request::Close => 7_u8.put(to),
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(match u8::take(from)? {
            0 => Request::Dialect(Wire::take(from)?),
            1 => Request::Model(Wire::take(from)?),
            2 => Request::Write,
            3 => Request::Vocabulary,
            4 => Request::ReliesOn,
            5 => Request::Fit(Wire::take(from)?),
            6 => Request::Value(Wire::take(from)?, Wire::take(from)?),
            7 => Request::Close,
            _ => return None,
        })
    }
}

impl Request {
    /// The function of the contract that it is about; the library may be in another one that goes with it.
    pub(crate) fn function(&self) -> Function {
        match self {
            Request::Dialect(_) | Request::Model(_) => Function::Open,
            Request::Write => Function::Write,
            Request::Vocabulary => Function::Vocabulary,
            Request::ReliesOn => Function::ReliesOn,
            Request::Fit(_) => Function::Fit,
            Request::Value(..) => Function::Value,
            Request::Close => Function::Close,
        }
    }
}

impl Wire for Description {
    fn put(&self, to: &mut Vec<u8>) {
        self.version.put(to);
        self.about.put(to);
        self.is_model.put(to);
        self.hash.put(to);
        self.options.put(to);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let (version, about) = Wire::take(from)?;
        let (is_model, hash) = Wire::take(from)?;
        Some(Description { version, about, is_model, hash, options: Wire::take(from)? })
    }
}

impl Wire for Written {
    fn put(&self, to: &mut Vec<u8>) {
        self.text.put(to);
        self.ends.put(to);
        self.fault.put(to);
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        let (text, ends) = Wire::take(from)?;
        Some(Written { text, ends, fault: Wire::take(from)? })
    }
}

impl Wire for Fitted {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Fitted::Wants(places) => {
                true.put(to);
                places.put(to);
            }
            Fitted::Answers(answer) => {
                false.put(to);
                answer.put(to);
            }
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(match bool::take(from)? {
            true => Fitted::Wants(Wire::take(from)?),
            false => Fitted::Answers(Wire::take(from)?),
        })
    }
}

/// Why a library cannot be opened. What only the host finds out crosses as a sentence.
impl Wire for Reason {
    fn put(&self, to: &mut Vec<u8>) {
        match self {
            Reason::Open { message } => (0_u8, message.clone()).put(to),
            Reason::NoProcess { message } => (9_u8, message.clone()).put(to),
            Reason::NoSymbol { symbol } => (1_u8, symbol.clone()).put(to),
            Reason::NotAPlugin => 2_u8.put(to),
            Reason::OtherContract { found, wanted } => (3_u8, (*found, *wanted)).put(to),
            Reason::OtherLayout { found, wanted } => (4_u8, (*found, *wanted)).put(to),
            Reason::Size { of, found, wanted, most } => {
                (5_u8, (*of, (*found, (*wanted, *most)))).put(to)
            }
            Reason::Null { what } => (6_u8, *what).put(to),
            Reason::NotAligned { what } => (7_u8, *what).put(to),
            Reason::Nonsense { message } | Reason::Refused { message } => {
                (8_u8, message.clone()).put(to)
            }
            Reason::NotFound { .. } => (8_u8, "it was not found".to_owned()).put(to),
            Reason::FileName { pattern } => (8_u8, pattern.clone()).put(to),
            Reason::OtherKind { found, .. } => (8_u8, (*found).to_owned()).put(to),
            Reason::Option(fault) => (8_u8, fault.to_string()).put(to),
        }
    }

    fn take(from: &mut &[u8]) -> Option<Self> {
        Some(match u8::take(from)? {
            0 => Reason::Open { message: Wire::take(from)? },
            1 => Reason::NoSymbol { symbol: Wire::take(from)? },
            2 => Reason::NotAPlugin,
            3 => Reason::OtherContract { found: Wire::take(from)?, wanted: Wire::take(from)? },
            4 => Reason::OtherLayout { found: Wire::take(from)?, wanted: Wire::take(from)? },
            5 => Reason::Size {
                of: Wire::take(from)?,
                found: Wire::take(from)?,
                wanted: Wire::take(from)?,
                most: Wire::take(from)?,
            },
            6 => Reason::Null { what: Wire::take(from)? },
            7 => Reason::NotAligned { what: Wire::take(from)? },
            8 => Reason::Nonsense { message: Wire::take(from)? },
            9 => Reason::NoProcess { message: Wire::take(from)? },
            _ => return None,
        })
    }
}

/// The deviations that an error model wants.
pub(crate) type Deviations = Vec<Deviation>;
