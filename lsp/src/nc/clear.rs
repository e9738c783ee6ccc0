//! Whether anything hits anything while a program runs on the chosen machine.

use post_machine::diagnostic::Diagnostic;

use crate::background::Token;
use crate::document::Snapshot;
use post_job::cancellable_text::CancellableText;
use post_job::cl_facts::ClFacts;
use post_job::clearance;
use post_job::failure::Failure;
use post_job::nc_program::NcControl;

/// What is not clear, or not proven to be; of no meaning where the work was given up.
pub fn not_clear(of: &Snapshot, control: &NcControl, token: &Token) -> Vec<Diagnostic> {
    let text = CancellableText::new(of.text.as_bytes(), || token.is_given_up());
    let proven = clearance::prove(control, &of.name, Box::new(text), &ClFacts::default(), None);
    proven.map_or_else(Failure::findings, |proven| proven.findings)
}
