//! Headers of C among files that are named by their endings alone: programs of Heidenhain end in `.h` as well.

use std::io::{self, Read};
use std::path::Path;

/// So much of a file is looked at, bytes.
const LOOKED_AT: u64 = 1 << 16;

/// How blocks of Klartext begin that have no number.
const BARE: [&str; 4] = ["BEGIN PGM", "END PGM", "BLK FORM", "TOOL CALL"];

/// The file at `path`, with this text, ends in `.h`, and no block of Klartext stands in it.
///
/// # Errors
/// It cannot be read.
pub fn is_header(path: &Path, text: impl Read) -> io::Result<bool> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("h")) {
        return Ok(false);
    }
    let mut begin = Vec::new();
    text.take(LOOKED_AT).read_to_end(&mut begin)?;
    Ok(!String::from_utf8_lossy(&begin).split(['\n', '\r']).any(is_block))
}

/// A line of Klartext: a number, a blank and a word, or a word that stands nowhere else.
fn is_block(line: &str) -> bool {
    let line = line.trim();
    let words = line.trim_start_matches(|letter: char| letter.is_ascii_digit());
    let numbered = words.len() < line.len()
        && words.starts_with([' ', '\t'])
        && words
            .trim_start()
            .starts_with(|letter: char| letter.is_ascii_uppercase() || ";*".contains(letter));
    numbered || BARE.iter().any(|bare| words.starts_with(bare))
}
