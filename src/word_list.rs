//! `post words`: every word of a CL file, or every word that is known, and what becomes of it.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use post_grammar::{MajorWord, ReadError, Reader, Usage};
use post_machine::diagnostic::{Diagnostic, unreadable};

use crate::input::{Input, one};

/// Prints every word that is known, with its spellings.
pub fn print_all() {
    line(format!("{:<32} {:<10} {}", "word", "becomes", "meaning"));
    for word in MajorWord::all() {
        let spellings = word.spellings.join(" = ");
        let becomes = word.usage.name();
        line(format!("{spellings:<32} {becomes:<10} {}", word.meaning));
    }
}

fn line(text: String) {
    // A reader that has seen enough closes the pipe.
    let _ = writeln!(io::stdout(), "{}", text.trim_end());
}

/// Prints the words of a file.
pub fn print(path: &Path, unknown_only: bool) -> Result<(), Vec<Diagnostic>> {
    let input = Input::open(path)?;
    let name = input.name;
    let mut reader = Reader::new(input.bytes);
    let mut words: BTreeMap<String, (u64, u64, Usage)> = BTreeMap::new();
    let mut faults = Vec::new();
    loop {
        match reader.next_record() {
            Ok(None) => break,
            Ok(Some(record)) => {
                let word = record.statement.word();
                let usage = record.statement.usage();
                if let Some((count, _, known)) = words.get_mut(word) {
                    *count += 1;
                    // Of several forms the one without effect is told.
                    if matches!(usage, Usage::Unknown | Usage::Refused) {
                        *known = usage;
                    }
                } else {
                    words.insert(word.to_owned(), (1, record.line, usage));
                }
            }
            Err(ReadError::Io(error)) => return Err(one("input", format!("{name}: {error}"))),
            Err(ReadError::Syntax(fault)) => faults.push(unreadable(&name, &fault)),
        }
    }
    let mut rows: Vec<_> = words.into_iter().collect();
    rows.sort_by(|a, b| b.1.0.cmp(&a.1.0).then_with(|| a.0.cmp(&b.0)));
    line(format!(
        "{:<26} {:>9}  {:<10} {}",
        "word", "times", "becomes", "first on line"
    ));
    for (word, (count, first, usage)) in rows {
        if unknown_only && !matches!(usage, Usage::Unknown | Usage::Refused) {
            continue;
        }
        let becomes = usage.name();
        line(format!("{word:<26} {count:>9}  {becomes:<10} {first}"));
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults)
    }
}
