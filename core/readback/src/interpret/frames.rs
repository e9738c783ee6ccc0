//! Shifts and turns of the program's coordinates.

use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::gathered::Gathered;
use super::state::Control;

/// `G52`, `G92`, `G92.1`, `G10`, `G68`, `G69` (two-dimensional turns): `code` is ten times the number.
pub(super) fn code(
    control: &mut Control,
    code: u16,
    meaning: Meaning,
    words: &mut Gathered,
) -> Result<(), Box<Diagnostic>> {
    let _ = (meaning, words);
    Err(control.refuse(
        "nc-frame",
        format!("G{} is not run", f64::from(code) / 10.0),
    ))
}

/// `TRANS X10`, `ATRANS`, `ROT`, `AROT`, `SCALE`, `MIRROR`: the words behind it. False if it is none of these.
pub(super) fn name(
    control: &mut Control,
    name: &str,
    words: &mut Gathered,
) -> Result<bool, Box<Diagnostic>> {
    let _ = (control, name, words);
    Ok(false)
}
