//! Work that needs no Python: the interpreter's lock is released, and what goes wrong becomes an exception.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use post_command::library::Refused;
use post_machine::diagnostic::Diagnostic;
use pyo3::prelude::*;

use crate::refusal;

/// Does `job` while other threads run Python.
pub fn apart<T: Send>(
    py: Python<'_>,
    job: impl FnOnce() -> Result<T, Refused> + Send,
) -> PyResult<T> {
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(job)));
    match done {
        Ok(Ok(given)) => Ok(given),
        Ok(Err(refused)) => Err(refusal::raised(py, &refused)),
        Err(panic) => Err(refusal::raised(py, &[broken(&*panic)])),
    }
}

/// A fault of our own.
fn broken(panic: &(dyn Any + Send)) -> Diagnostic {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let message = format!(
        "post itself is at fault: {}",
        text.unwrap_or("no reason given")
    );
    Diagnostic::error("internal", message)
        .help("report it with the file and the machine that it came with")
}
