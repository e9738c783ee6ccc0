//! What is found wrong on the way, complete at birth: every finding that has a line gets its file and the line's
//! text when it is made.
//!
//! A limit that is passed by a thousand points is told once, with how often and how far it is passed.

use std::cell::RefCell;

use post_grammar::{Record, SyntaxFault};
use post_machine::diagnostic::{Diagnostic, Extreme, Place, Severity, unreadable};

use crate::source_buffer::SourceBuffer;

/// Faults of one run that are told, those found first; what comes after is most likely more of the same.
pub const MOST_FAULTS: usize = 20;

/// The findings of one run. Every stage may add to them.
#[derive(Debug)]
pub(crate) struct Findings {
    file: String,
    inner: RefCell<Inner>,
}

#[derive(Debug, Default)]
struct Inner {
    /// Text of the lines that a finding may still be made for.
    source: SourceBuffer,
    found: Vec<Diagnostic>,
    repeats: Vec<Repeat>,
    /// Faults, repeated ones counted once.
    faults: usize,
}

/// A limit that is passed again and again.
#[derive(Debug)]
struct Repeat {
    /// Its first finding.
    finding: usize,
    count: u64,
    extreme: Extreme,
    /// Where it is passed farthest.
    line: u64,
}

impl Findings {
    /// None yet, of a CL file by that name.
    pub(crate) fn new(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            inner: RefCell::default(),
        }
    }

    /// Name of the CL file, as in messages.
    pub(crate) fn file(&self) -> &str {
        &self.file
    }

    /// Keeps the text of a record as long as findings may be made for it: `settled` gives the line before which
    /// none will be.
    #[inline]
    pub(crate) fn read(&mut self, record: &Record<'_>, settled: impl FnOnce() -> Option<u64>) {
        let source = &mut self.inner.get_mut().source;
        source.keep(record.line, record.raw, settled);
    }

    /// A finding at a line of the CL file.
    #[cold]
    pub(crate) fn at(&self, line: u64, finding: Diagnostic) {
        let text = self.inner.borrow().source.text(line).unwrap_or_default();
        let place = Place {
            file: self.file.clone(),
            line,
            span: 0..text.len(),
            text,
        };
        self.add(finding.at(Some(place)));
    }

    /// A line of the CL file that cannot be read.
    pub(crate) fn unreadable(&self, fault: &SyntaxFault) {
        self.add(unreadable(&self.file, fault));
    }

    /// A finding that has its place, or has none.
    #[cold]
    pub(crate) fn add(&self, finding: Diagnostic) {
        let mut inner = self.inner.borrow_mut();
        if finding.severity == Severity::Error {
            if inner.repeated(&finding) || inner.faults >= MOST_FAULTS {
                return;
            }
            inner.faults += 1;
        }
        inner.found.push(finding);
    }

    /// Something is wrong: no program comes of it, but checking goes on.
    #[inline]
    pub(crate) fn failed(&self) -> bool {
        self.inner.borrow().faults > 0
    }

    /// So many faults that reading on would only repeat them.
    #[inline]
    pub(crate) fn too_many(&self) -> bool {
        self.inner.borrow().faults >= MOST_FAULTS
    }

    /// The warnings as sentences, in the order of the lines.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let inner = self.inner.borrow();
        let found = inner.found.iter();
        let mut warnings: Vec<&Diagnostic> = found
            .filter(|finding| finding.severity == Severity::Warning)
            .collect();
        warnings.sort_by_key(|finding| line_of(finding));
        warnings
            .into_iter()
            .map(|finding| match &finding.place {
                Some(place) => format!("line {}: {}", place.line, finding.message),
                None => finding.message.clone(),
            })
            .collect()
    }

    /// All findings in the order of the lines, those without a line last.
    pub(crate) fn sorted(mut self) -> Vec<Diagnostic> {
        let inner = self.inner.get_mut();
        inner.tell_repeats();
        let mut found = std::mem::take(&mut inner.found);
        found.sort_by_key(line_of);
        found
    }
}

/// Findings without a line come last.
fn line_of(finding: &Diagnostic) -> u64 {
    finding.place.as_ref().map_or(u64::MAX, |place| place.line)
}

impl Inner {
    /// A limit that was passed before: counted, and its largest value kept.
    fn repeated(&mut self, finding: &Diagnostic) -> bool {
        let Some(extreme) = &finding.extreme else {
            return false;
        };
        let line = finding.place.as_ref().map_or(0, |place| place.line);
        let known = self.repeats.iter_mut().find(|repeat| {
            let first = &self.found[repeat.finding];
            first.code == finding.code
                && first.extreme.as_ref().map(|extreme| extreme.key) == Some(extreme.key)
        });
        if let Some(repeat) = known {
            repeat.count += 1;
            if extreme.by > repeat.extreme.by {
                repeat.extreme = extreme.clone();
                repeat.line = line;
            }
            return true;
        }
        if self.faults >= MOST_FAULTS {
            return false;
        }
        self.repeats.push(Repeat {
            finding: self.found.len(),
            count: 1,
            extreme: extreme.clone(),
            line,
        });
        false
    }

    /// Adds to the first finding of a limit how often and how far it was passed.
    fn tell_repeats(&mut self) {
        for repeat in &self.repeats {
            if repeat.count > 1 {
                let finding = &mut self.found[repeat.finding];
                finding.message.push_str(&format!(
                    "; {} points pass it, the farthest with {} on line {}",
                    repeat.count, repeat.extreme.value, repeat.line
                ));
            }
        }
    }
}
