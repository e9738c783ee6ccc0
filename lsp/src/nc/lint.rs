//! What is wrong with a program that runs on the chosen machine, what hits something among it.

use post_machine::diagnostic::Diagnostic;

use crate::background::Token;
use crate::document::Snapshot;
use crate::machine::library::Library;
use post_job::cancellable_text::CancellableText;
use post_job::failure::Failure;
use post_job::lint;
use post_job::nc_program::NcControl;
use post_job::plugin_finder;

/// All that is found of a program; of no meaning where the work was given up.
pub fn looked_over(
    of: &Snapshot,
    control: &NcControl,
    library: &Library,
    token: &Token,
) -> Vec<Diagnostic> {
    let text = CancellableText::new(of.text.as_bytes(), || token.is_given_up());
    let linted = plugin_finder::finder(&library.session, &library.plugins)
        .map_err(Failure::from)
        .and_then(|finder| lint::look_over(control, &finder, &of.name, Box::new(text), &[]));
    linted.map_or_else(Failure::findings, |linted| linted.findings)
}
