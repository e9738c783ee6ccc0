//! Blocks of the conversational form.

use post_grammar::nc::NcBlock;
use post_machine::diagnostic::Diagnostic;

use super::state::Control;

/// Runs a block.
pub(super) fn run(control: &mut Control, block: &NcBlock) -> Result<(), Box<Diagnostic>> {
    let _ = block;
    Err(control.refuse("nc-conversational", "conversational blocks are not run"))
}
