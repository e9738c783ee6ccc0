//! What is said to the user: where, what, how much, and what would help.

mod nearest;
mod short;
mod source_files;

use std::ops::Range;

use post_grammar::SyntaxFault;
use post_grammar::text::excerpt;

/// Longest sentence of a finding, in bytes: what a file holds is cut before it fills a terminal.
const LONGEST_SENTENCE: usize = 1500;

/// Longest piece of a line that is kept for a message, bytes: the part around what is wrong.
const SHOWN: usize = 200;

pub use nearest::{meant, nearest};
pub use short::Short;
pub use source_files::{FurtherFile, SourceFiles};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The program is written; the user should know.
    Warning,
    /// No program is written.
    Error,
}

/// One finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// A stable name for programs to read, `over-travel`.
    pub code: &'static str,
    /// Where, if it has a place.
    pub place: Option<SourcePlace>,
    /// What, with the value and the limit.
    pub message: String,
    /// What would help.
    pub help: Option<String>,
    /// How far the limit is passed, for findings that come by the thousand and are told once.
    pub extreme: Option<LimitExcess>,
}

/// How far a limit is passed.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitExcess {
    /// Findings with the same code and key are about the same limit.
    pub key: u64,
    /// Amount by which it is passed; the largest is told.
    pub by: f64,
    /// The value, as told.
    pub value: String,
    /// What would bring this value inside, said before the other help; empty if nothing that simple does.
    pub remedy: String,
}

/// A place in a text file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourcePlace {
    /// The file as the user named it.
    pub file: String,
    /// Line, counted from 1.
    pub line: u64,
    /// The line's text; of a long one the part around `span`.
    pub text: String,
    /// Bytes of the line before `text`.
    pub offset: usize,
    /// What to underline, bytes of `text`.
    pub span: Range<usize>,
}

impl Diagnostic {
    /// An error without a place.
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            code,
            place: None,
            message: cut(message.into()),
            help: None,
            extreme: None,
        }
    }

    /// A warning without a place.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, message) }
    }

    /// Adds what would help.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(cut(help.into()));
        self
    }

    /// Adds how far the limit is passed.
    pub fn extreme(mut self, extreme: LimitExcess) -> Self {
        self.extreme = Some(extreme);
        self
    }

    /// Boxes the finding, for results that are mostly good.
    pub fn boxed(self) -> Box<Self> {
        Box::new(self)
    }

    /// Adds where it is.
    pub fn at(mut self, place: Option<SourcePlace>) -> Self {
        self.place = place;
        self
    }
}

impl SourcePlace {
    /// The place `span` (bytes of `text`) in a line; of a long line what surrounds it, at character borders.
    pub fn new(file: &str, line: u64, text: &str, span: Range<usize>) -> Self {
        let border = |mut at: usize| {
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let end = border(span.end.min(text.len()));
        let start = border(span.start.min(end));
        let (from, to) = if text.len() > SHOWN {
            let from = border(start.saturating_sub(SHOWN / 4));
            (from, border((from + SHOWN).min(text.len())))
        } else {
            (0, text.len())
        };
        Self {
            file: file.to_owned(),
            line,
            text: text[from..to].to_owned(),
            offset: from,
            span: start - from..end.min(to) - from,
        }
    }
}

fn cut(sentence: String) -> String {
    if sentence.len() <= LONGEST_SENTENCE {
        return sentence;
    }
    excerpt(&sentence, LONGEST_SENTENCE).into_owned()
}

/// A line of the CL file `file` that cannot be read.
pub fn unreadable(file: &str, fault: &SyntaxFault) -> Diagnostic {
    let place = SourcePlace::new(file, fault.line, &fault.text, fault.span.clone());
    let diagnostic = Diagnostic::error("syntax", fault.message.clone()).at(Some(place));
    match &fault.help {
        Some(help) => diagnostic.help(help.as_str()),
        None => diagnostic,
    }
}
