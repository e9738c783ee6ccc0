//! What is wrong with a block, before it is known where the block stands.

use std::ops::Range;

use crate::fault::SyntaxFault;

/// A part of a block that cannot be read.
#[derive(Debug)]
pub(super) struct Unreadable {
    /// Where in the block, in bytes; none: the block as a whole.
    span: Option<Range<usize>>,
    message: String,
    help: Option<String>,
}

impl Unreadable {
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self {
            span: None,
            message: message.into(),
            help: None,
        }
    }

    /// The place, if none is known yet.
    pub(super) fn at(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The fault of the block `text`, which begins on `line`.
    pub(super) fn fault(self, text: &str, line: u64) -> SyntaxFault {
        let whole = text.len() - text.trim_start().len()..text.trim_end().len();
        let span = self.span.unwrap_or(whole);
        let mut fault = SyntaxFault::new(text, span, self.message);
        fault.help = self.help;
        fault.line = line;
        fault
    }
}
