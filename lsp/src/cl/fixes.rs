//! What a click puts right in a CL file: a word that was likely meant.

use std::ops::Range;

use post_grammar::{MajorWord, parse_record};
use post_machine::diagnostic::{Diagnostic, nearest};

use crate::document::Snapshot;
use crate::fixes::{Fix, meant, touching, written};

/// Lines in which faults are looked for at most.
const MOST_LINES: usize = 200;

/// The fixes for findings that touch a part of the text.
pub fn fixes(of: &Snapshot, part: &Range<usize>) -> Vec<Fix> {
    let first = of.lines.line_of(part.start);
    let last = of.lines.line_of(part.end).clamp(first, first + MOST_LINES);
    let found = super::findings_of_lines(of, first..=last);
    touching(of, part, found, |finding, span| {
        let word = meant(finding).map(str::to_owned).or_else(|| minor(of, finding, span))?;
        Some(written(&word, span, word.clone()))
    })
}

/// The minor word that was likely meant where a record has one that its major word does not know.
fn minor(of: &Snapshot, finding: &Diagnostic, span: &Range<usize>) -> Option<String> {
    let place = finding.place.as_ref()?;
    let (word, _) = place.text.split_once('/')?;
    let known = MajorWord::find(word.trim())?.minor_words();
    let written = &of.text[span.clone()];
    let near = nearest(written, known.iter().copied())?;
    // Only what makes a record that can be read is a fix.
    let mended = format!(
        "{}{near}{}",
        place.text.get(..place.span.start)?,
        place.text.get(place.span.end..)?
    );
    (near != written && parse_record(&mended).is_ok()).then(|| near.to_owned())
}
