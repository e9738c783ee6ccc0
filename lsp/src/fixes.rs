//! What a click puts right.

use std::ops::Range;

use post_machine::diagnostic::Diagnostic;

use super::document::Snapshot;
use super::findings;

/// A change of the text.
pub struct Fix {
    /// What it does.
    pub title: String,
    /// The finding that it puts right.
    pub finding: Diagnostic,
    /// The change.
    pub change: Change,
}

/// Bytes of a text, and what comes in their place.
pub struct Change {
    /// The bytes that go.
    pub span: Range<usize>,
    /// What comes.
    pub text: String,
}

/// The fixes that `fix` finds for those `found` that touch a part of the text: what each does, and the change.
pub fn touching(
    of: &Snapshot,
    part: &Range<usize>,
    found: Vec<Diagnostic>,
    fix: impl Fn(&Diagnostic, &Range<usize>) -> Option<(String, Change)>,
) -> Vec<Fix> {
    let fixed = found.into_iter().filter_map(|finding| {
        let here = finding.place.as_ref().filter(|place| place.file == of.name)?;
        let span = findings::span(here, of)?;
        let touches = part.start <= span.end && span.start <= part.end;
        let (title, change) = touches.then(|| fix(&finding, &span))??;
        Some(Fix { title, finding, change })
    });
    fixed.collect()
}

/// The word that a finding takes to be meant.
pub fn meant(finding: &Diagnostic) -> Option<&str> {
    let help = finding.help.as_deref()?;
    Some(help.strip_prefix("did you mean `")?.split_once('`')?.0)
}

/// Another word in the place of what is underlined.
pub fn written(meant: &str, span: &Range<usize>, text: String) -> (String, Change) {
    (format!("Write `{meant}`"), Change { span: span.clone(), text })
}
