//! Cutter-location files and the small languages of a machine file: text in, typed records out.
//!
//! A cutter-location file goes through [`Reader`], which splits it into logical lines in one reused buffer.
//! Plain `GOTO/` lines, nearly all of a file, are taken by a hand-written scanner; every other line, and any
//! `GOTO/` the scanner is not sure of, by the pest grammar `line.pest`, one line at a time.
//! The structural code of a machine ([`parse_chain`]) and the expressions in its file ([`parse_expression`])
//! have grammars of their own.

mod chain;
mod cl;
mod expression;
mod fault;

pub use chain::{Link, LinkKind, parse_chain};
pub use cl::*;
pub use expression::{EvaluationFault, Expression, parse_expression};
pub use fault::{ReadError, SyntaxFault};
