//! A block of Heidenhain's conversational form, by its grammar.

use super::block::NcBlock;
use super::fault::Unreadable;

/// Reads the block `code`, in capitals and without remarks; `original` is the same as it was written.
pub(super) fn parse(code: &str, original: &str, block: &mut NcBlock) -> Result<(), Unreadable> {
    let _ = (code, original, block);
    Err(Unreadable::new("not yet"))
}

/// The block defines a cycle, whose parameters may stand in lines of their own.
pub(super) fn defines_cycle(code: &str) -> bool {
    let body = code
        .trim_start()
        .trim_start_matches(|each: char| each.is_ascii_digit());
    body.len() < code.trim_start().len() && body.trim_start().starts_with("CYCL DEF")
}

/// A line that gives a parameter and has no number: `Q200=+2`.
pub(super) fn gives_parameter(line: &[u8]) -> bool {
    let [b'Q' | b'q', digits @ ..] = line.trim_ascii_start() else {
        return false;
    };
    let count = digits
        .iter()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    count > 0 && digits[count..].trim_ascii_start().starts_with(b"=")
}
