//! One logical line of a cutter-location file to a [`Statement`], by pest.

use super::record::{Argument, Statement};
use super::statements;
use super::vocabulary::{self, ArgumentForm, MajorWord};
use crate::fault::SyntaxFault;
use crate::text::excerpt;
use pest::Parser;
use pest::error::InputLocation;
use pest::iterators::Pair;
use pest_derive::Parser;
use std::borrow::Cow;
use std::ops::Range;

#[derive(Parser)]
#[grammar = "cl/line.pest"]
struct ClGrammar;

/// Whether a line's text is free: then a `$` at its end is text, not a continuation, and `$$` in it is no comment.
///
/// Says of a line's beginning what the grammar says of the whole line, for the reader must know before it joins lines.
pub fn is_free_text(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    if let Some(comment) = line.strip_prefix(b"$$") {
        return !comment.trim_ascii_start().starts_with(b"->");
    }
    let end = line
        .iter()
        .position(|&byte| !(byte.is_ascii_alphanumeric() || byte == b'_'))
        .unwrap_or(line.len());
    let (word, rest) = line.split_at(end);
    let rest = rest.trim_ascii_start();
    if word.eq_ignore_ascii_case(b"TOOL") {
        return rest.len() >= 4 && rest[..4].eq_ignore_ascii_case(b"PATH");
    }
    std::str::from_utf8(word).is_ok_and(is_text_word) && !is_directive(word, rest)
}

/// Whether any text may follow the word.
fn is_text_word(word: &str) -> bool {
    let known = MajorWord::find(word);
    known.is_some_and(|known| matches!(known.behind, ArgumentForm::Text(_)))
}

/// `REMARK ->`, the form of a directive that is no comment to APT.
fn is_directive(word: &[u8], rest: &[u8]) -> bool {
    word.eq_ignore_ascii_case(b"REMARK") && rest.starts_with(b"->")
}

/// Longest major word, in bytes. Anything longer is no word, and each unknown word is counted by its name.
pub(super) const LONGEST_WORD: usize = 64;

/// Characters of an item that a message shows.
pub(crate) const SHOWN: usize = 60;

/// One item after the slash.
pub(crate) struct LineItem<'t> {
    /// Text as written; empty where two commas follow each other.
    pub text: &'t str,
    /// Where in the line it begins, in bytes.
    pub start: usize,
    /// Value of the item, if it is a number.
    pub value: Option<f64>,
    /// Only blanks part it from the item before.
    pub comma_missing: bool,
}

impl LineItem<'_> {
    pub fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    pub fn argument(&self) -> Argument {
        match self.value {
            Some(value) => Argument::Number(value),
            None => Argument::Word(self.text.to_owned()),
        }
    }
}

/// A statement taken apart, before anyone looks at what it means.
pub(crate) struct LogicalLine<'t> {
    /// The whole line.
    pub text: &'t str,
    /// The major word in capitals.
    pub word: Cow<'static, str>,
    /// Row of the vocabulary, if the word has one.
    pub known: Option<&'static MajorWord>,
    /// Bytes of the text at which the word stands.
    pub word_span: Range<usize>,
    /// A slash follows it.
    pub slash: bool,
    /// What follows.
    pub items: Vec<LineItem<'t>>,
}

/// Reads one logical line: a record without line ends, its continuations joined.
///
/// [`Reader`](crate::ClReader) gives the same for every line of a file; this is for a single one.
pub fn parse_record(text: &str) -> Result<Statement, SyntaxFault> {
    if let Some(at) = text.bytes().position(is_control) {
        let byte = text.as_bytes()[at];
        return Err(
            SyntaxFault::new(text, at..at + 1, format!("byte 0x{byte:02X} is not text"))
                .help("a cutter-location file is plain text; one saved as UTF-16 has to be saved as UTF-8"),
        );
    }
    let mut pairs = ClGrammar::parse(Rule::line, text).map_err(|error| {
        let at = match error.location {
            InputLocation::Pos(at) => at,
            InputLocation::Span((at, _)) => at,
        };
        unreadable(text, at)
    })?;
    let inner = pairs.next().and_then(|line| line.into_inner().next()).expect("a line has content");
    match inner.as_rule() {
        Rule::comment => Ok(Statement::Remark(trimmed(inner))),
        Rule::tool_path => {
            let mut parts = inner.into_inner().map(trimmed);
            Ok(Statement::ToolPath { name: parts.next().unwrap_or_default(), tool: parts.next() })
        }
        Rule::free_text => Ok(free_text(inner)),
        Rule::directive => {
            let remark = text.trim_start();
            let remark = remark.strip_prefix("$$").unwrap_or_else(|| &remark["REMARK".len()..]);
            let statement = inner.into_inner().next().expect("a directive holds a statement");
            let read = line(text, statement).and_then(|line| statements::directive(&line));
            Ok(read.unwrap_or_else(|_| Statement::Remark(remark.trim().to_owned())))
        }
        Rule::drive => statements::statement(&driven(text, inner)),
        _ => statements::statement(&line(text, inner)?),
    }
}

/// A line that moves the tool along a curve, with all that follows its first word as one item.
fn driven<'t>(text: &'t str, drive: Pair<'t, Rule>) -> LogicalLine<'t> {
    let word = drive.into_inner().next().map_or(0..0, |word| {
        let span = word.as_span();
        span.start()..span.end()
    });
    let known = vocabulary::find(&text[word.clone()]);
    let behind = text[word.end..].trim();
    LogicalLine {
        text,
        word: match known {
            Some((spelling, _)) => Cow::Borrowed(spelling),
            None => Cow::Owned(excerpt(&text[word.clone()], LONGEST_WORD).to_ascii_uppercase()),
        },
        known: known.map(|(_, word)| word),
        items: vec![LineItem {
            text: behind,
            start: text.len() - text[word.end..].trim_start().len(),
            value: None,
            comma_missing: false,
        }],
        word_span: word,
        slash: true,
    }
}

/// The value of a text that is a number as a whole, and one that a double holds.
pub(crate) fn number_of(text: &str) -> Option<f64> {
    let digits = text.trim_start_matches(['+', '-', '.']);
    if !digits.starts_with(|first: char| first.is_ascii_digit()) {
        return None;
    }
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

/// A byte that no text holds. Tabs are blanks.
fn is_control(byte: u8) -> bool {
    (byte < b' ' && byte != b'\t') || byte == 0x7F
}

/// The fault of a line that is no statement at all; pest could not go on at `at`.
fn unreadable(text: &str, at: usize) -> SyntaxFault {
    let next = text[at..].chars().next().map_or(0, char::len_utf8);
    let begin = text.len() - text.trim_start().len();
    if at <= begin {
        return SyntaxFault::new(text, at..at + next, "a record begins with a word")
            .help("a line that goes on with the record before it must follow a `$`");
    }
    SyntaxFault::new(text, at..at + next, "a `/` or the end of the line must follow the word")
}

fn trimmed(pair: Pair<'_, Rule>) -> String {
    let pair = match pair.as_rule() {
        Rule::comment => pair.into_inner().next().expect("a comment has a text"),
        _ => pair,
    };
    pair.as_str().trim().to_owned()
}

fn free_text(pair: Pair<'_, Rule>) -> Statement {
    let mut parts = pair.into_inner();
    let word = parts.next().map_or("", |word| word.as_str());
    let text = parts.next().map(trimmed).unwrap_or_default();
    match vocabulary::find(word) {
        Some((spelling, known)) if let ArgumentForm::Text(read) = known.behind => {
            read(spelling, text)
        }
        _ => unreachable!(
            "`free_word` of line.pest and the words of the table with a text are the same"
        ),
    }
}

/// Collects the items of a statement; a number that a double cannot hold is a fault.
fn line<'t>(text: &'t str, statement: Pair<'t, Rule>) -> Result<LogicalLine<'t>, SyntaxFault> {
    let mut line = LogicalLine {
        text,
        word: Cow::Borrowed(""),
        known: None,
        word_span: 0..0,
        slash: false,
        items: Vec::new(),
    };
    // Whether an item is due: at the beginning and after a comma.
    let mut due = true;
    for pair in statement.into_inner() {
        let span = pair.as_span();
        match pair.as_rule() {
            Rule::word if pair.as_str().len() > LONGEST_WORD => {
                let message = format!(
                    "a word of {} characters: none has more than {LONGEST_WORD}",
                    pair.as_str().len()
                );
                let fault = SyntaxFault::new(text, span.start()..span.end(), message);
                return Err(fault.help("is this a cutter-location file?"));
            }
            Rule::word => {
                match vocabulary::find(pair.as_str()) {
                    Some((spelling, known)) => {
                        line.word = Cow::Borrowed(spelling);
                        line.known = Some(known);
                    }
                    None => line.word = Cow::Owned(pair.as_str().to_ascii_uppercase()),
                }
                line.word_span = span.start()..span.end();
            }
            Rule::slash => line.slash = true,
            Rule::comma => {
                if due {
                    line.items.push(LineItem {
                        text: "",
                        start: span.start(),
                        value: None,
                        comma_missing: false,
                    });
                }
                due = true;
            }
            rule => {
                let value = match rule {
                    Rule::number => Some(number(text, &pair)?),
                    _ => None,
                };
                line.items.push(LineItem {
                    text: pair.as_str(),
                    start: span.start(),
                    value,
                    comma_missing: !due,
                });
                due = false;
            }
        }
    }
    Ok(line)
}

fn number(text: &str, pair: &Pair<'_, Rule>) -> Result<f64, SyntaxFault> {
    match pair.as_str().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => {
            let span = pair.as_span();
            let shown = excerpt(pair.as_str(), SHOWN);
            let message = format!("{shown} is beyond any number a program can hold");
            Err(SyntaxFault::new(text, span.start()..span.end(), message))
        }
    }
}
