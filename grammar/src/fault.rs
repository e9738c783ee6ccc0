//! What is said when a text cannot be read.

use std::error::Error;
use std::fmt;
use std::io;
use std::ops::Range;

/// A text that cannot be read: where, what is wrong with it, and what would help.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxFault {
    /// Line of the file on which the text begins, counted from 1; 1 where the text is not from a file.
    pub line: u64,
    /// The text: of a cutter-location file the logical line, continued lines joined by one blank.
    pub text: String,
    /// The part of `text` that is wrong, in bytes; empty where something is missing.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What would help.
    pub help: Option<String>,
}

impl SyntaxFault {
    pub(crate) fn new(text: &str, span: Range<usize>, message: impl Into<String>) -> Self {
        Self { line: 1, text: text.to_owned(), span, message: message.into(), help: None }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for SyntaxFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)?;
        match &self.help {
            Some(help) => write!(f, " ({help})"),
            None => Ok(()),
        }
    }
}

impl Error for SyntaxFault {}

/// Why [`Reader::next_record`](crate::ClReader::next_record) has no record.
#[derive(Debug)]
pub enum ReadError {
    /// The input failed.
    Io(io::Error),
    /// A line that cannot be read; the next call goes on with the line after it.
    Syntax(Box<SyntaxFault>),
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::Syntax(fault) => fault.fmt(f),
        }
    }
}

impl Error for ReadError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            Self::Syntax(fault) => Some(fault),
        }
    }
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<SyntaxFault> for ReadError {
    fn from(fault: SyntaxFault) -> Self {
        Self::Syntax(Box::new(fault))
    }
}
