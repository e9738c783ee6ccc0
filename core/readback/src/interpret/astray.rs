//! What is said where a program leads to no block that could be run.

use post_machine::diagnostic::Diagnostic;

pub(super) type FlowResult<T> = Result<T, Box<Diagnostic>>;

/// What leads the program on is wrong.
pub(super) fn fault(message: &str) -> Box<Diagnostic> {
    Diagnostic::error("nc-flow", message).boxed()
}

/// A place that nothing stands at is gone to.
pub(super) fn no_target(name: &str) -> Box<Diagnostic> {
    fault(&format!("`{name}` is gone to, and it does not stand in this file"))
}

/// A program in another file is called.
pub(super) fn elsewhere(name: &str) -> Box<Diagnostic> {
    Diagnostic::error(
        "nc-subprogram",
        format!(
            "`{name}` is called, and it does not stand in this file: what it does is not known"
        ),
    )
    .help("put it into this file, or write its blocks in the place of the call")
    .boxed()
}
