//! NC programs: bytes of a file to blocks, nothing interpreted.
//!
//! Three notations: words after letters as ISO 6983 has them, with what the controls have added to it (names with `=`,
//! calls with parentheses, expressions, labels, loops), Heidenhain's conversational form, and statements of robots.

mod block;
mod conversational;
mod expression;
mod fault;
mod layout;
mod lines;
mod number;
mod pairs;
mod reader;
mod remarks;
mod run;
mod scan;
mod search;
mod statements;
mod tree;
mod words;

pub use block::*;
pub use expression::*;
pub use lines::NcMark;
pub use reader::{NcReader, parse_block};
pub use run::{NcRun, NcRunRule};
pub use search::NcTarget;
