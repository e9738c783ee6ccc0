//! The CL file: a file, a pipe, or standard input.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use post_machine::diagnostic::Diagnostic;

/// The name of standard input and output.
pub fn standard() -> &'static Path {
    Path::new("-")
}

/// Input and what is known of it.
pub struct Input {
    /// As the user named it.
    pub name: String,
    /// What it holds.
    pub bytes: Box<dyn Read>,
    /// How long it is, if it is a file.
    pub length: Option<u64>,
}

impl Input {
    /// Opens a CL file; `-` is standard input.
    pub fn open(path: &Path) -> Result<Self, Vec<Diagnostic>> {
        if path == standard() {
            return Ok(Self {
                name: "standard input".to_owned(),
                bytes: Box::new(io::stdin().lock()),
                length: None,
            });
        }
        let fault = |error: io::Error| one("input", format!("{}: {error}", path.display()));
        let file = File::open(path).map_err(fault)?;
        let metadata = file.metadata().map_err(fault)?;
        if metadata.is_dir() {
            return Err(one(
                "input",
                format!("{} is a folder, not a CL file", path.display()),
            ));
        }
        Ok(Self {
            name: path.display().to_string(),
            bytes: Box::new(file),
            length: metadata.is_file().then_some(metadata.len()),
        })
    }
}

/// One error without a place.
pub fn one(code: &'static str, message: String) -> Vec<Diagnostic> {
    vec![Diagnostic::error(code, message)]
}
