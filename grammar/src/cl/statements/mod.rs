//! What follows a major word: items to a typed [`Statement`].
//!
//! A known word with wrong content is a fault. Where the first item is a word without a meaning here
//! (`COOLNT/SUPER`, `LOAD/WIRE`, `CUTTER/DISPLY`), the record comes through as [`Statement::Other`],
//! so that it is reported and not guessed at.

pub(super) mod along;
pub(super) mod drilling;
pub(super) mod geometry;
mod items;
pub(super) mod technology;
pub(super) mod tooling;

use super::line::{LineItem, LogicalLine};
use super::record::Statement;
use super::vocabulary::ArgumentForm;
use crate::fault::SyntaxFault;
use items::Items;

type Read<T> = Result<T, SyntaxFault>;

/// Reads the items of one word.
pub(super) type ReadItems = fn(&mut Items<'_, '_>) -> Read<Statement>;

/// Reads a line whose geometry stands in parentheses.
pub(super) type ReadGeometry = fn(&LogicalLine<'_>) -> Read<Statement>;

/// Takes the text after one word: its spelling in capitals, the text without blanks around it.
pub(super) type ReadTextStatement = fn(&'static str, String) -> Statement;

/// A directive. Only those that carry facts are typed; the rest is meant for one program and comes as it stands.
pub(super) fn directive(line: &LogicalLine<'_>) -> Read<Statement> {
    match line.word.as_ref() {
        "CUTTER" | "CSYS" | "CUTCOM_GEOMETRY_TYPE" => match statement(line)? {
            Statement::Other { .. } => Ok(other(line, true)),
            statement => Ok(statement),
        },
        _ => Ok(other(line, true)),
    }
}

/// A statement of its own.
pub(super) fn statement(line: &LogicalLine<'_>) -> Read<Statement> {
    let read = match line.known.map(|word| word.behind) {
        Some(ArgumentForm::Items(read)) => read,
        Some(ArgumentForm::Geometry(read)) => return read(line),
        _ => return Ok(other(line, false)),
    };
    if let Some(first) = line.items.first().filter(|_| !line.slash) {
        let message = format!("a `/` must stand between {} and what follows it", line.word);
        let span = line.word_span.end..first.start;
        return Err(SyntaxFault::new(line.text, span, message));
    }
    // CAMWorks leaves a comma out in CYCLE; anywhere else a blank between two numbers is a slip.
    if line.word != "CYCLE"
        && let Some(item) = line.items.iter().find(|item| item.comma_missing)
    {
        let span = item.start..item.start;
        return Err(SyntaxFault::new(line.text, span, "a comma is missing here"));
    }
    read(&mut Items { line, next: 0 })
}

fn other(line: &LogicalLine<'_>, directive: bool) -> Statement {
    Statement::Other {
        word: line.word.clone(),
        arguments: line.items.iter().map(LineItem::argument).collect(),
        directive,
    }
}
