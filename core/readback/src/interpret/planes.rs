//! Tilted planes.

use post_grammar::nc::NcValue;
use post_machine::diagnostic::Diagnostic;

use super::gathered::Gathered;
use super::state::Control;

/// A G code of a tilted plane (`G68.2 X Y Z I J K`, `G254`); `code` is ten times its number.
pub(super) fn begin(
    control: &mut Control,
    code: u16,
    words: &mut Gathered,
) -> Result<(), Box<Diagnostic>> {
    let _ = (code, words);
    Err(control.refuse("nc-plane", "tilted planes are not run"))
}

/// The axes turn to the plane in force: `G53.1`.
pub(super) fn turn(
    control: &mut Control,
    code: u16,
    words: &mut Gathered,
) -> Result<(), Box<Diagnostic>> {
    let _ = (code, words);
    Err(control.refuse("nc-plane", "tilted planes are not run"))
}

/// It ends: `G69`, `G255`, `CYCLE800()`.
pub(super) fn end(control: &mut Control) -> Result<(), Box<Diagnostic>> {
    control.frames.plane = None;
    control.frames_changed();
    Ok(())
}

/// `CYCLE800(…)` with arguments.
pub(super) fn call(
    control: &mut Control,
    name: &str,
    arguments: &[Option<NcValue>],
) -> Result<(), Box<Diagnostic>> {
    let _ = (name, arguments);
    Err(control.refuse("nc-plane", "tilted planes are not run"))
}
