//! The census of words that had no effect: counted, so that nothing is dropped in silence.

use std::collections::BTreeMap;

use post_grammar::{MajorWord, WordUsage};
use post_machine::diagnostic::{Diagnostic, SourcePlace, nearest};

use super::limits::MOST_WORDS;

/// What to do with a word that is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnknownWordPolicy {
    /// Refuse the file.
    Error,
    /// Leave out those that a program is known to do without, and say so; refuse the file for the others.
    #[default]
    Known,
    /// Leave it out and say so.
    Warn,
    /// Write it into the program as a comment.
    Pass,
}

/// Counts of words by name.
#[derive(Debug, Default)]
pub(crate) struct WordCensus {
    counts: BTreeMap<String, WordCount>,
    /// Words that the user took upon himself, by what was done instead of carrying them out.
    allowed: BTreeMap<(String, &'static str), WordCount>,
}

#[derive(Debug)]
struct WordCount {
    usage: WordUsage,
    count: u64,
    /// Where it was met first.
    first: SourcePlace,
}

impl WordCensus {
    /// Counts a word; `place` is asked for its first occurrence alone. False if it is one word too many.
    #[must_use]
    pub(crate) fn count(
        &mut self,
        word: &str,
        usage: WordUsage,
        place: impl FnOnce() -> SourcePlace,
    ) -> bool {
        if let Some(count) = self.counts.get_mut(word) {
            count.count += 1;
            return true;
        }
        if self.counts.len() >= MOST_WORDS && MajorWord::find(word).is_none() {
            return false;
        }
        let count = WordCount { usage, count: 1, first: place() };
        self.counts.insert(word.to_owned(), count);
        true
    }

    /// Counts a word at `place` that is not carried out because the user allows it; `instead` is what is done.
    pub(crate) fn allow(&mut self, word: &str, instead: &'static str, place: SourcePlace) {
        let count = self.allowed.entry((word.to_owned(), instead));
        let count =
            count.or_insert(WordCount { usage: WordUsage::Refused, count: 0, first: place });
        count.count += 1;
    }

    /// A warning for each word that the user took upon himself.
    pub(crate) fn allowed(&self) -> impl Iterator<Item = Diagnostic> {
        self.allowed.iter().map(|((word, instead), count)| {
            let message = format!("{word}, met {}, {instead}, as --allow says", times(count.count));
            Diagnostic::warning("allowed-word", message).at(Some(count.first.clone()))
        })
    }

    /// Words that say nothing to a machine, and how often.
    pub(crate) fn ignored(&self) -> impl Iterator<Item = (&str, u64)> {
        self.counts
            .iter()
            .filter(|(_, count)| count.usage == WordUsage::Ignored)
            .map(|(word, count)| (word.as_str(), count.count))
    }

    /// A finding for each word that is not known.
    pub(crate) fn unknown(&self, policy: UnknownWordPolicy) -> impl Iterator<Item = Diagnostic> {
        self.counts
            .iter()
            .filter(|(_, count)| count.usage == WordUsage::Unknown)
            .map(move |(word, count)| {
                let what = if MajorWord::find(word).is_some() {
                    "is not supported"
                } else {
                    "is not a word that post knows"
                };
                let message = format!("{word} {what}: met {}", times(count.count));
                let finding = match policy {
                    UnknownWordPolicy::Known if MajorWord::find(word).is_some() => {
                        Diagnostic::warning("unknown-word", format!("{message}; left out"))
                    }
                    UnknownWordPolicy::Error | UnknownWordPolicy::Known => Diagnostic::error("unknown-word", message).help(
                        "--allow leaves it out, --unknown=warn all of its kind, --unknown=pass writes them as comments",
                    ),
                    UnknownWordPolicy::Warn => {
                        Diagnostic::warning("unknown-word", format!("{message}; left out"))
                    }
                    UnknownWordPolicy::Pass => Diagnostic::warning(
                        "unknown-word",
                        format!("{message}; written as a comment"),
                    ),
                };
                let finding = finding.at(Some(count.first.clone()));
                match (finding.help.clone(), known(word)) {
                    (None, Some(meant)) => finding.help(format!("did you mean {meant}?")),
                    (Some(help), Some(meant)) => {
                        finding.help(format!("did you mean {meant}? {help}"))
                    }
                    _ => finding,
                }
            })
    }

    /// A warning for each word of `--allow` that is not known and that the file does not have: a slip.
    pub(crate) fn slips(&self, allowed: &[String]) -> impl Iterator<Item = Diagnostic> {
        let slip = |word: &&String| {
            MajorWord::find(word).is_none()
                && !self.counts.contains_key(*word)
                && !self.allowed.keys().any(|(met, _)| met == *word)
        };
        allowed.iter().filter(slip).map(|word| {
            let warning = Diagnostic::warning(
                "allowed-word",
                format!("--allow {word}: the file has no such word, and post knows none"),
            );
            match known(word) {
                Some(meant) => warning.help(format!("did you mean {meant}?")),
                None => warning,
            }
        })
    }
}

/// The word of CL files that `word` was most likely meant to be.
fn known(word: &str) -> Option<&'static str> {
    // Of one that is known another word of the record is not.
    if MajorWord::find(word).is_some() {
        return None;
    }
    nearest(word, MajorWord::all().iter().flat_map(|row| row.spellings.iter().copied()))
}

fn times(count: u64) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        count => format!("{count} times"),
    }
}
