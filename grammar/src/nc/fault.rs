//! What is wrong with a block, before it is known where the block stands.

use std::borrow::Cow;
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
        Self { span: None, message: message.into(), help: None }
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
        let (shown, span) = excerpt(text, span);
        let mut fault = SyntaxFault::new(&shown, span, self.message);
        fault.help = self.help;
        fault.line = line;
        fault
    }
}

/// Bytes of a long block that are shown.
const SHOWN: usize = 400;

/// The part of a long block in which `span` begins, and where that is in it.
fn excerpt(text: &str, span: Range<usize>) -> (Cow<'_, str>, Range<usize>) {
    if text.len() <= SHOWN {
        return (Cow::Borrowed(text), span);
    }
    let from = text.floor_char_boundary(span.start.saturating_sub(SHOWN / 2));
    let to = text.ceil_char_boundary((from + SHOWN).min(text.len()));
    let (mut shown, mut lead) = (String::new(), 0);
    if from > 0 {
        shown.push('…');
        lead = shown.len();
    }
    shown.push_str(&text[from..to]);
    let end = span.end.clamp(span.start, to);
    if to < text.len() {
        shown.push('…');
    }
    (Cow::Owned(shown), lead + span.start - from..lead + end - from)
}
