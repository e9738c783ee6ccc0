//! By what the text of a program is known again: what tells of it carries that, and a text of another run does not fit.

use std::io::{self, Read};

use serde::Serialize;

use crate::files::PathArg;

/// A program, as its summary names it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ProgramDigest {
    /// Its file, without the folder; none on standard output.
    pub name: Option<String>,
    /// How long it is.
    pub bytes: u64,
    /// BLAKE3 of its bytes, 64 hexadecimal digits.
    pub hash: String,
}

impl ProgramDigest {
    /// Of the program at `target`, whose `text` is read from its start.
    ///
    /// # Errors
    /// The text cannot be read.
    pub fn of(target: &PathArg, mut text: impl Read) -> io::Result<Self> {
        let mut hasher = blake3::Hasher::new();
        let bytes = io::copy(&mut text, &mut hasher)?;
        let name = target.path().and_then(|path| path.file_name());
        Ok(Self {
            name: name.map(|name| name.to_string_lossy().into_owned()),
            bytes,
            hash: hasher.finalize().to_hex().to_string(),
        })
    }
}
