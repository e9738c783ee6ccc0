//! Cutter-location files: chunks of a file to logical lines, lines to typed records.

mod foreign;
mod line;
mod reader;
mod record;
mod scan;
mod statements;
mod vocabulary;

pub use line::parse_record;
pub use reader::Reader;
pub use record::*;
pub use vocabulary::{MajorWord, UnknownPath, Usage};
