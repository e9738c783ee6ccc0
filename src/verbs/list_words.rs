//! `post words`: every word of a CL file, how often, and what becomes of it.

use std::collections::BTreeMap;
use std::io::{self, Write};

use clap::Args;
use post_grammar::{ReadError, Reader};
use post_machine::diagnostic::unreadable;
use post_posting::program::{Usage, usage};

use crate::failure::Failure;
use crate::files::{ClInput, FileFault, PathArg};

/// Prints every word of a CL file: how often, and what becomes of it.
///
/// used: it has its effect on the program; passed on: its text goes into the program; ignored: it says
/// nothing to a machine; refused: it changes where the tool goes, and post does not know how; unknown:
/// left out with a warning, unless --unknown says otherwise.
#[derive(Debug, Args)]
pub struct WordsArguments {
    /// The CL file, `-` for standard input.
    #[arg(value_parser = PathArg::parser())]
    file: PathArg,

    /// Only words that are refused or unknown.
    #[arg(long)]
    unknown_only: bool,
}

/// Prints the table.
pub fn run(arguments: &WordsArguments) -> Result<(), Failure> {
    let input = ClInput::open(&arguments.file)?;
    let name = input.name;
    let mut reader = Reader::new(input.bytes);
    let mut words: BTreeMap<String, (u64, u64, Usage)> = BTreeMap::new();
    let mut faults = Vec::new();
    loop {
        match reader.next_record() {
            Ok(None) => break,
            Ok(Some(record)) => {
                let word = record.statement.word();
                let usage = usage(&record.statement);
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
            Err(ReadError::Io(error)) => return Err(FileFault::Read { name, error }.into()),
            Err(ReadError::Syntax(fault)) => faults.push(unreadable(&name, &fault)),
        }
    }
    let mut rows: Vec<_> = words.into_iter().collect();
    rows.sort_by(|a, b| b.1.0.cmp(&a.1.0).then_with(|| a.0.cmp(&b.0)));
    let mut stdout = io::stdout().lock();
    let mut line = |text: String| {
        // A reader that has seen enough closes the pipe.
        let _ = writeln!(stdout, "{}", text.trim_end());
    };
    line(format!(
        "{:<26} {:>9}  {:<10} {}",
        "word", "times", "becomes", "first on line"
    ));
    for (word, (count, first, usage)) in rows {
        if arguments.unknown_only && !matches!(usage, Usage::Unknown | Usage::Refused) {
            continue;
        }
        let becomes = match usage {
            Usage::Used => "used",
            Usage::Passed => "passed on",
            Usage::Ignored => "ignored",
            Usage::Refused => "refused",
            Usage::Unknown => "unknown",
        };
        line(format!("{word:<26} {count:>9}  {becomes:<10} {first}"));
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(faults.into())
    }
}
