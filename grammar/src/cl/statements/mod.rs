//! What each major word means: items to a typed [`Statement`].
//!
//! A known word with wrong content is a fault. Where the first item is a word without a meaning here
//! (`COOLNT/SUPER`, `LOAD/WIRE`, `CUTTER/DISPLY`), the record comes through as [`Statement::Other`],
//! so that it is reported and not guessed at.

mod drilling;
mod geometry;
mod items;
mod technology;
mod tooling;

use crate::cl::line::{Item, Line};
use crate::cl::record::Statement;
use crate::fault::SyntaxFault;
use drilling::cycle;
use geometry::{circle, cntrl, from, godlta, gohome, goto, head, msys, multax, rotate, tlaxis};
use items::Items;
use technology::{coolnt, delay, fedrat, spindl, units};
use tooling::{cutcom, cutter, load, load_tool, select, select_tool, tldata};

type Read<T> = Result<T, SyntaxFault>;

/// A directive. Only the two that carry facts are typed; the rest is meant for one program and comes as it stands.
pub(crate) fn directive(line: &Line<'_>) -> Read<Statement> {
    match line.word.as_str() {
        "CUTTER" | "CSYS" => match statement(line)? {
            Statement::Other { .. } => Ok(other(line, true)),
            statement => Ok(statement),
        },
        _ => Ok(other(line, true)),
    }
}

/// A statement of its own.
pub(crate) fn statement(line: &Line<'_>) -> Read<Statement> {
    let Some(read) = reader(&line.word) else {
        return Ok(other(line, false));
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

fn other(line: &Line<'_>, directive: bool) -> Statement {
    Statement::Other {
        word: line.word.clone(),
        arguments: line.items.iter().map(Item::argument).collect(),
        directive,
    }
}

type Reader = fn(&mut Items<'_, '_>) -> Read<Statement>;

fn reader(word: &str) -> Option<Reader> {
    Some(match word {
        "GOTO" => goto,
        "GODLTA" => godlta,
        "FROM" => from,
        "HEAD" => head,
        "GOHOME" => gohome,
        "RAPID" => |items| items.nothing(Statement::Rapid),
        "FEDRAT" => fedrat,
        "SPINDL" => spindl,
        "COOLNT" => coolnt,
        "LOADTL" | "TURRET" | "TOOLNO" => load_tool,
        "LOAD" => load,
        "SELECT" => select,
        "SELCTL" => select_tool,
        "TLDATA" => tldata,
        "CUTTER" => cutter,
        "UNITS" | "UNIT" => units,
        "MULTAX" => multax,
        "MSYS" => msys,
        "CSYS" => |items| {
            Ok(Statement::Csys(
                items.array("CSYS/ and the 3 x 4 matrix, row by row")?,
            ))
        },
        "CIRCLE" => circle,
        "NURBS" => |items| items.nothing(Statement::Nurbs),
        "KNOT" => |items| Ok(Statement::Knot(items.numbers("KNOT/u,u,...")?)),
        "CNTRL" => cntrl,
        "CYCLE" => cycle,
        "CUTCOM" => cutcom,
        "ROTABL" | "ROTATE" => rotate,
        "TLAXIS" => tlaxis,
        "DELAY" | "DWELL" => delay,
        "STOP" => |items| items.nothing(Statement::Stop),
        "OPSTOP" => |items| items.nothing(Statement::OptionalStop),
        "END-OF-PATH" => |items| items.nothing(Statement::EndOfPath),
        "FINI" | "END" => |items| items.nothing(Statement::Fini),
        _ => return None,
    })
}
