//! Cycles become the motions that the control makes of them.

use post_grammar::nc::NcValue;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::gathered::Gathered;
use super::state::Control;

/// The cycle in force.
#[derive(Clone, Debug, Default)]
pub(super) struct Cycles {}

impl Cycles {
    /// Axis words make holes.
    #[inline]
    pub fn in_force(&self) -> bool {
        false
    }
}

/// A block that begins a cycle by its G code (`code` is ten times the number, `meaning` its sense), or says a further hole
/// of the one in force (`code` is 0): `words` are those of the block. Marks the words that it uses in `words.used`.
pub(super) fn hole(
    control: &mut Control,
    code: u16,
    meaning: Option<Meaning>,
    words: &mut Gathered,
) -> Result<(), Box<Diagnostic>> {
    let _ = (code, meaning, words);
    Err(control.refuse("nc-cycle", "cycles are not run"))
}

/// No cycle any more: G80, MCALL alone, or a motion word.
pub(super) fn end(control: &mut Control) {
    control.cycles = Cycles::default();
}

/// `CYCLE81(…)`: called where the tool stands, or in force behind each motion where `modal` (MCALL).
pub(super) fn call(
    control: &mut Control,
    name: &str,
    meaning: Meaning,
    arguments: &[Option<NcValue>],
    modal: bool,
) -> Result<(), Box<Diagnostic>> {
    let _ = (name, meaning, arguments, modal);
    Err(control.refuse("nc-cycle", "cycles are not run"))
}

/// A motion block has come to its end: a cycle that is called at each point (MCALL, M89) is run there.
pub(super) fn at_point(control: &mut Control) -> Result<(), Box<Diagnostic>> {
    let _ = control;
    Ok(())
}
