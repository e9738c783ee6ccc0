//! The functions of the contract, as messages name them.

/// What of a library is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    /// No function: what runs as the system opens the library.
    Opening,
    Loaded,
    Describe,
    Open,
    Format,
    Vocabulary,
    ReliesOn,
    Write,
    Fit,
    Value,
    LastError,
    Close,
}

/// Each with its name.
const NAMES: [(Function, &str); 12] = [
    (Function::Opening, "opening"),
    (Function::Loaded, "loaded"),
    (Function::Describe, "describe"),
    (Function::Open, "open"),
    (Function::Format, "format"),
    (Function::Vocabulary, "vocabulary"),
    (Function::ReliesOn, "relies_on"),
    (Function::Write, "write"),
    (Function::Fit, "fit"),
    (Function::Value, "value"),
    (Function::LastError, "last_error"),
    (Function::Close, "close"),
];

impl Function {
    /// Its name in the contract.
    #[cfg(unix)]
    pub(crate) fn name(self) -> &'static str {
        NAMES[self as usize].1
    }

    /// The number by which another process knows it: from 1, 0 is none.
    pub(crate) fn number(self) -> u64 {
        self as u64 + 1
    }

    #[cfg(unix)]
    pub(crate) fn from_number(number: u64) -> Option<Self> {
        NAMES.iter().map(|(function, _)| *function).find(|function| function.number() == number)
    }
}
