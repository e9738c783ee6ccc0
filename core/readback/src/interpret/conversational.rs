//! Blocks of the conversational form.

use post_grammar::nc::NcBlock;
use post_machine::diagnostic::Diagnostic;

use super::state::Control;

/// mm/min in one unit of F.
pub(super) fn feed_unit(control: &Control) -> f64 {
    // In an inch program F is in tenths of an inch a minute.
    if control.modal.unit == 1.0 {
        1.0
    } else {
        control.modal.unit / 10.0
    }
}

/// Runs a block.
pub(super) fn run(control: &mut Control, block: &NcBlock) -> Result<(), Box<Diagnostic>> {
    let _ = block;
    Err(control.refuse("nc-conversational", "conversational blocks are not run"))
}
