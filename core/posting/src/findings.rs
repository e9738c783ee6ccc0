//! What is found wrong on the way, complete where it is made: every finding that has a line gets its file and the line's
//! text when it is made.
//!
//! What is found a thousand times is reported once, where it was found first, with how often; of a limit that is passed also
//! how far.

use std::cell::RefCell;
use std::rc::Rc;

use post_grammar::{GotoRun, Record, SyntaxFault};
use post_machine::diagnostic::{
    Diagnostic, LimitExcess, Severity, SourceFiles, SourcePlace, unreadable,
};

use crate::source_buffer::SourceBuffer;

/// Faults of one run that are reported, those found first; what comes after is most likely more of the same.
pub const MOST_FAULTS: usize = 20;

/// Warnings of one run that are reported; of the others how many there are.
pub const MOST_WARNINGS: usize = 100;

/// Points at which one limit is passed before reading stops: the farthest of this many is as good as any.
const MOST_BEYOND: u64 = 100_000;

/// Faults of one kind without such a limit before reading stops: each may have taken a search.
const MOST_ALIKE: u64 = 200;

/// The findings of one run. Every stage has a handle, and may add to them.
#[derive(Clone, Debug)]
pub(crate) struct Findings {
    files: Rc<SourceFiles>,
    inner: Rc<RefCell<FindingList>>,
}

#[derive(Debug, Default)]
struct FindingList {
    /// Text of the lines that a finding may still be made for.
    source: SourceBuffer,
    found: Vec<Diagnostic>,
    /// One for each of `found`.
    repeats: Vec<Repeat>,
    /// Faults, repeated ones counted once.
    faults: usize,
    /// Warnings beyond those that are reported.
    untold: u64,
    /// Some fault was found so often that reading stops.
    enough: bool,
}

/// How often something was found.
#[derive(Debug)]
struct Repeat {
    kind: FindingKind,
    count: u64,
    /// Where it was found last.
    last: u64,
    /// How far a limit is passed, and where it is passed farthest.
    extreme: Option<(LimitExcess, u64)>,
}

/// Findings of one kind are reported once: of the same limit, or whose sentences differ in their numbers alone.
#[derive(Debug, PartialEq, Eq)]
struct FindingKind {
    severity: Severity,
    code: &'static str,
    /// Key of a limit; none for all other findings.
    key: Option<u64>,
    /// Sentence of a finding that is no limit, each number in it as one sign.
    sentence: String,
}

impl Repeat {
    /// Of a finding that was found once.
    fn first(finding: &Diagnostic) -> Self {
        let line = finding.place.as_ref().map_or(0, |place| place.line);
        Self {
            kind: FindingKind::of(finding),
            count: 1,
            last: line,
            extreme: finding.extreme.clone().map(|extreme| (extreme, line)),
        }
    }

    /// Number of times that it may be found.
    fn most(&self) -> u64 {
        match self.extreme {
            Some(_) => MOST_BEYOND,
            None => MOST_ALIKE,
        }
    }
}

impl FindingKind {
    fn of(finding: &Diagnostic) -> Self {
        let key = finding.extreme.as_ref().map(|extreme| extreme.key);
        Self {
            severity: finding.severity,
            code: finding.code,
            key,
            sentence: match key {
                Some(_) => String::new(),
                None => without_numbers(&finding.message),
            },
        }
    }
}

/// A sentence with a sign in the place of each number.
pub fn without_numbers(sentence: &str) -> String {
    let mut bare = String::new();
    let mut within = false;
    for character in sentence.chars() {
        let digit = character.is_ascii_digit();
        // A sign before a number and a point in it are the number's.
        if digit && !within {
            while bare.ends_with(['-', '.']) {
                bare.pop();
            }
            if !bare.ends_with('#') {
                bare.push('#');
            }
        } else if !digit {
            bare.push(character);
        }
        within = digit;
    }
    bare
}

impl Findings {
    /// None yet, of these CL files.
    pub(crate) fn new(files: SourceFiles) -> Self {
        Self { files: Rc::new(files), inner: Rc::default() }
    }

    /// Name of the CL file, of several the first, as in messages.
    pub(crate) fn file(&self) -> &str {
        self.files.first()
    }

    /// Keeps the text of a record as long as findings may be made for it: `settled` gives the line before which
    /// none will be.
    #[inline]
    pub(crate) fn read(&self, record: &Record<'_>, settled: impl FnOnce() -> Option<u64>) {
        let source = &mut self.inner.borrow_mut().source;
        source.keep(record.line, record.raw, settled);
    }

    /// [`Findings::read`] of the records of a run, whose text this is.
    pub(crate) fn read_run(
        &self,
        run: &GotoRun,
        text: &[u8],
        settled: impl FnOnce() -> Option<u64>,
    ) {
        self.inner.borrow_mut().source.keep_run(run, text, settled);
    }

    /// The CL files.
    pub(crate) fn files(&self) -> &SourceFiles {
        &self.files
    }

    /// The text of a line of the CL file; empty if no finding was to be made for it any more.
    pub(crate) fn text(&self, line: u64) -> String {
        self.inner.borrow().source.text(line).unwrap_or_default()
    }

    /// A finding at a line of the CL file.
    #[cold]
    pub(crate) fn at(&self, line: u64, finding: Diagnostic) {
        self.add(self.placed(line, finding));
    }

    /// A finding with its place at a line of the CL file.
    pub(crate) fn placed(&self, line: u64, finding: Diagnostic) -> Diagnostic {
        // A file without a record ends on its first line.
        let line = line.max(1);
        let text = self.text(line);
        let place = SourcePlace::new(self.file(), line, &text, 0..text.len());
        finding.at(Some(place))
    }

    /// A line of the CL file that cannot be read.
    pub(crate) fn unreadable(&self, fault: &SyntaxFault) {
        self.add(unreadable(self.file(), fault));
    }

    /// A finding that has its place, or has none.
    #[cold]
    pub(crate) fn add(&self, finding: Diagnostic) {
        let mut inner = self.inner.borrow_mut();
        if inner.repeated(&finding) {
            return;
        }
        if finding.severity == Severity::Error {
            if inner.faults >= MOST_FAULTS {
                return;
            }
            inner.faults += 1;
        } else if inner.found.len() >= MOST_WARNINGS + inner.faults {
            inner.untold += 1;
            return;
        }
        inner.repeats.push(Repeat::first(&finding));
        inner.found.push(finding);
    }

    /// Different findings so far, for [`Findings::insert`].
    #[inline]
    pub(crate) fn count(&self) -> usize {
        self.inner.borrow().found.len()
    }

    /// Adds a fault as if it had been added when there were `before` findings: what hangs on the order is what it would
    /// be then. It is unlike all others.
    #[cold]
    pub(crate) fn insert(&self, before: usize, fault: Diagnostic) {
        self.inner.borrow_mut().insert(before, fault);
    }

    /// Something is wrong: no program comes of it, but checking goes on.
    #[inline]
    pub(crate) fn failed(&self) -> bool {
        self.inner.borrow().faults > 0
    }

    /// Whether there are so many faults that reading on would only repeat them.
    #[inline]
    pub(crate) fn too_many(&self) -> bool {
        let inner = self.inner.borrow();
        inner.faults >= MOST_FAULTS || inner.enough
    }

    /// The warnings as sentences, in the order of the lines.
    pub(crate) fn warnings(&self) -> Vec<String> {
        let inner = self.inner.borrow();
        let mut warnings = inner.told(&self.files);
        warnings.retain(|finding| finding.severity == Severity::Warning);
        warnings.sort_by_key(line_of);
        warnings
            .into_iter()
            .map(|finding| match &finding.place {
                Some(place) => {
                    format!("line {}: {}", self.files.line(place.line), finding.message)
                }
                None => finding.message,
            })
            .collect()
    }

    /// All findings in the order of the lines, those without a line last.
    pub(crate) fn sorted(self) -> Vec<Diagnostic> {
        let mut found = self.inner.borrow().told(&self.files);
        found.sort_by_key(line_of);
        found.iter_mut().for_each(|finding| self.files.place(finding));
        found
    }
}

/// Findings without a line come last.
fn line_of(finding: &Diagnostic) -> u64 {
    finding.place.as_ref().map_or(u64::MAX, |place| place.line)
}

impl FindingList {
    /// See [`Findings::insert`].
    fn insert(&mut self, before: usize, fault: Diagnostic) {
        let is_fault = |finding: &Diagnostic| finding.severity == Severity::Error;
        if self.found[..before].iter().filter(|finding| is_fault(finding)).count() >= MOST_FAULTS {
            return;
        }
        self.repeats.insert(before, Repeat::first(&fault));
        self.found.insert(before, fault);
        match self.faults >= MOST_FAULTS {
            // The last of the others came as one too many.
            true => {
                if let Some(last) = self.found.iter().rposition(is_fault) {
                    self.repeats.remove(last);
                    self.found.remove(last);
                }
            }
            false => self.faults += 1,
        }
    }

    /// What was found before: counted, and of a limit its largest value kept.
    fn repeated(&mut self, finding: &Diagnostic) -> bool {
        let kind = FindingKind::of(finding);
        let Some(repeat) = self.repeats.iter_mut().find(|repeat| repeat.kind == kind) else {
            return false;
        };
        let line = finding.place.as_ref().map_or(0, |place| place.line);
        repeat.count += 1;
        repeat.last = repeat.last.max(line);
        self.enough |= finding.severity == Severity::Error && repeat.count >= repeat.most();
        if let (Some(extreme), Some((farthest, at))) = (&finding.extreme, &mut repeat.extreme)
            && extreme.by > farthest.by
        {
            *farthest = extreme.clone();
            *at = line;
        }
        true
    }

    /// What was found, each with how often.
    fn told(&self, files: &SourceFiles) -> Vec<Diagnostic> {
        let told = |(finding, repeat): (&Diagnostic, &Repeat)| {
            let mut finding = finding.clone();
            if let Some((extreme, _)) = &repeat.extreme
                && !extreme.remedy.is_empty()
            {
                let help = finding.help.take().unwrap_or_default();
                finding.help = Some(format!("{}; {help}", extreme.remedy));
            }
            let more = match (&repeat.extreme, repeat.count - 1) {
                (_, 0) => return finding,
                (Some((extreme, line)), _) => format!(
                    "; {} points pass it, the farthest with {} on line {}",
                    repeat.count,
                    extreme.value,
                    files.line(*line)
                ),
                (None, 1) if repeat.last > 0 => {
                    format!("; one more like it, on line {}", files.line(repeat.last))
                }
                (None, more) if repeat.last > 0 => {
                    format!("; {more} more like it, the last on line {}", files.line(repeat.last))
                }
                (None, more) => format!("; {more} more like it"),
            };
            finding.message.push_str(&more);
            if finding.severity == Severity::Error && repeat.count >= repeat.most() {
                finding.message.push_str("; reading stopped there");
            }
            finding
        };
        let mut all: Vec<Diagnostic> = self.found.iter().zip(&self.repeats).map(told).collect();
        if self.untold > 0 {
            let message = format!("… and {} more warnings", self.untold);
            all.push(Diagnostic::warning("more", message));
        }
        all
    }
}
