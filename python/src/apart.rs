//! Work that needs no Python: the interpreter's lock is released, and what goes wrong becomes an exception.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;
use std::time::{Duration, Instant};

use post_command::library::{Refused, stoppable};
use post_machine::diagnostic::Diagnostic;
use pyo3::prelude::*;

use crate::refusal;

/// So long nobody asks whether the user has pressed Ctrl-C: asking takes the interpreter's lock.
const BETWEEN: Duration = Duration::from_millis(50);

/// Does `job` while other threads run Python. Ctrl-C ends it at the next piece of its CL file that is read.
pub fn apart<T: Send>(
    py: Python<'_>,
    job: impl FnOnce() -> Result<T, Refused> + Send,
) -> PyResult<T> {
    let (done, raised) = py.detach(|| {
        let raised = Rc::new(RefCell::new(None));
        let (noted, asked) = (Rc::clone(&raised), Cell::new(Instant::now()));
        let stop = move || {
            if noted.borrow().is_some() {
                return true;
            }
            if asked.get().elapsed() < BETWEEN {
                return false;
            }
            asked.set(Instant::now());
            let signals = Python::attach(|py| py.check_signals());
            *noted.borrow_mut() = signals.err();
            noted.borrow().is_some()
        };
        let job = AssertUnwindSafe(|| stoppable(Rc::new(stop), job));
        (catch_unwind(job), raised.take())
    });
    match (raised, done) {
        (Some(raised), _) => Err(raised),
        (None, Ok(Ok(given))) => Ok(given),
        (None, Ok(Err(refused))) => Err(refusal::raised(py, &refused)),
        (None, Err(panic)) => Err(refusal::raised(py, &[broken(&*panic)])),
    }
}

/// A fault of our own.
fn broken(panic: &(dyn Any + Send)) -> Diagnostic {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let message = format!("post itself is at fault: {}", text.unwrap_or("no reason given"));
    Diagnostic::error("internal", message)
        .help("report it with the file and the machine that it came with")
}

/// A job that dies of a fault of our own, for the tests.
#[pyfunction]
pub fn fail(py: Python<'_>) -> PyResult<()> {
    apart(py, || panic!("asked for"))
}
