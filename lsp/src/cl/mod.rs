//! What is told of CL files.
//!
//! | file | does |
//! |---|---|
//! | `outline` | operations and tools, to go to and to fold |
//! | `posted` | the file posted on the chosen machine, its text thrown away: axis values and deviation by line |
//! | `hover` | what is said of a line |
//! | `completion` | what is offered while it is written |
//! | `fixes` | what a click puts right |

pub mod completion;
pub mod fixes;
pub mod hover;
pub mod outline;
mod posted;

use std::ops::{Range, RangeInclusive};

use post_grammar::{ClReader, MajorWord, ReadError, Statement, WordUsage};
use post_machine::diagnostic::{Diagnostic, SourcePlace, meant, unreadable};

use super::background::Token;
use super::document::Snapshot;
pub use posted::{Posted, post};

/// Endings of CL files.
pub const ENDINGS: &[&str] = &["cls", "clsf", "cl", "cldata", "apt", "ncl"];

/// Faults of a file that are told.
const MOST: usize = 100;

/// Records between two looks whether the work is given up.
pub const EVERY: u64 = 1024;

/// Lines that cannot be read, and where `words` is set words that post does not know; none if the work is given up.
pub fn findings(of: &Snapshot, words: bool, token: &Token) -> Option<Vec<Diagnostic>> {
    findings_in(of, 0..of.text.len(), words, || token.is_given_up())
}

/// The same of these lines alone, counted from 0.
fn findings_of_lines(of: &Snapshot, lines: RangeInclusive<usize>) -> Vec<Diagnostic> {
    let [first, last] = [lines.start(), lines.end()].map(|line| of.lines.span(&of.text, *line));
    findings_in(of, first.start..last.end, true, || false).unwrap_or_default()
}

/// The same of a part of the text that begins with a line.
fn findings_in(
    of: &Snapshot,
    part: Range<usize>,
    words: bool,
    is_given_up: impl Fn() -> bool,
) -> Option<Vec<Diagnostic>> {
    let before = of.lines.line_of(part.start) as u64;
    let mut reader = ClReader::new(of.text[part].as_bytes());
    let mut found = Vec::new();
    let mut records = 0_u64;
    while found.len() < MOST {
        records += 1;
        if records.is_multiple_of(EVERY) && is_given_up() {
            return None;
        }
        match reader.next_record() {
            Ok(Some(record)) if words => {
                if let Statement::Other { word, directive: false, .. } = &record.statement
                    && record.statement.usage() == WordUsage::Unknown
                {
                    let text = record.text();
                    let start = text.len() - text.trim_ascii_start().len();
                    let span = start..start + word.len();
                    let place = SourcePlace::new(&of.name, before + record.line, &text, span);
                    found.push(unknown(word).at(Some(place)));
                }
            }
            Ok(Some(_)) => {}
            Err(ReadError::Syntax(mut fault)) => {
                fault.line += before;
                found.push(unreadable(&of.name, &fault));
            }
            // A text in memory does not fail.
            Ok(None) | Err(ReadError::Io(_)) => break,
        }
    }
    Some(found)
}

/// A word that no row of the table has.
fn unknown(word: &str) -> Diagnostic {
    let names: Vec<&str> = MajorWord::all().iter().map(MajorWord::name).collect();
    let fault = Diagnostic::warning("unknown-word", format!("{word} is no word that post knows"));
    let help = meant(word, "`post words` lists", &names);
    match help.split_once("? ") {
        Some((question, _)) => fault.help(format!("{question}?")),
        None => fault.help("`post words` lists those that it knows; a file with it is refused, unless --allow leaves it out"),
    }
}
