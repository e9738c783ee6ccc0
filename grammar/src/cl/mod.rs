//! Cutter-location files: chunks of a file to logical lines, lines to typed records.

pub(crate) mod foreign;
mod goto_run;
mod layout;
pub(crate) mod line;
mod minor_words;
mod piece;
mod reader;
mod record;
pub(crate) mod scan;
mod statements;
mod vocabulary;

pub use goto_run::GotoRun;
pub use line::parse_record;
pub use piece::{ClBatch, ClPiece};
pub use reader::{ClReader, NEXT_FILE};
pub use record::*;
pub use vocabulary::{MajorWord, UnknownPath, WordUsage};
