//! `post words`: every word of a CL file, or every word that is known, and what becomes of it.

use std::collections::BTreeMap;

use clap::Args;
use post_grammar::{ClReader, MajorWord, ReadError, WordUsage};
use post_machine::diagnostic::{Diagnostic, unreadable};
use post_posting::MOST_FAULTS;
use post_posting::program::limits::MOST_WORDS;

use post_cli::arguments::flag_values::file;
use post_cli::terminal::print;
use post_job::failure::Failure;
use post_job::files::{ClInput, FileFault, PathArg};
use post_job::session::Session;

/// Lists the words of a CL file, how often each occurs and what becomes of it; without a file, all known words.
///
/// used: it has its effect on the program; passed on: its text goes into the program; ignored: it says
/// nothing to a machine; refused: it changes where or whether metal is cut, and post does not know how: [cl.words] in
/// the machine file gives its lines, --allow leaves it out unless it moves the tool; unknown: post does without those
/// that `post words` has, with a warning, and refuses a file with others, unless --allow or --unknown says otherwise.
#[derive(Debug, Args)]
pub struct WordsArguments {
    /// The CL file, `-` for standard input.
    #[arg(value_parser = file())]
    file: Option<PathArg>,

    /// Only words that are refused or unknown.
    #[arg(long, requires = "file")]
    unknown_only: bool,
}

/// Prints the table.
pub fn run(session: &Session, arguments: &WordsArguments) -> Result<(), Failure> {
    let Some(file) = &arguments.file else {
        print_all(session);
        return Ok(());
    };
    let input = ClInput::open(session, file)?;
    let name = input.name;
    let mut reader = ClReader::new(input.bytes);
    let mut words: BTreeMap<String, (u64, u64, WordUsage)> = BTreeMap::new();
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
                    if matches!(usage, WordUsage::Unknown | WordUsage::Refused) {
                        *known = usage;
                    }
                } else if words.len() == MOST_WORDS {
                    let message = format!("more than {MOST_WORDS} different words");
                    let fault = Diagnostic::error("words", message);
                    return Err(fault.help("is this a cutter-location file?").into());
                } else {
                    words.insert(word.to_owned(), (1, record.line, usage));
                }
            }
            Err(ReadError::Io(error)) => return Err(FileFault::Read { name, error }.into()),
            Err(ReadError::Syntax(fault)) => {
                if faults.len() < MOST_FAULTS {
                    faults.push(unreadable(&name, &fault));
                }
            }
        }
    }
    let mut rows: Vec<_> = words.into_iter().collect();
    rows.sort_by(|a, b| b.1.0.cmp(&a.1.0).then_with(|| a.0.cmp(&b.0)));
    let mut text = String::new();
    line(
        &mut text,
        &format!("{:<26} {:>9}  {:<10} {}", "word", "times", "becomes", "first on line"),
    );
    for (word, (count, first, usage)) in rows {
        if arguments.unknown_only && !matches!(usage, WordUsage::Unknown | WordUsage::Refused) {
            continue;
        }
        let becomes = usage.name();
        line(&mut text, &format!("{word:<26} {count:>9}  {becomes:<10} {first}"));
    }
    print(session, &text);
    if faults.is_empty() { Ok(()) } else { Err(faults.into()) }
}

/// Prints every word that is known, with its spellings.
fn print_all(session: &Session) {
    let mut text = String::new();
    line(&mut text, &format!("{:<32} {:<10} {}", "word", "becomes", "meaning"));
    for word in MajorWord::all() {
        let spellings = word.spellings.join(" = ");
        let becomes = word.usage.name();
        line(&mut text, &format!("{spellings:<32} {becomes:<10} {}", word.meaning));
    }
    print(session, &text);
}

fn line(text: &mut String, line: &str) {
    text.push_str(line.trim_end());
    text.push('\n');
}
