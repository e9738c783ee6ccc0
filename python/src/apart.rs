//! Work that needs no Python: the interpreter's lock is released, and what goes wrong becomes an exception.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use post_job::library::{Refusal, StopSignal};
use post_machine::diagnostic::Diagnostic;
use pyo3::prelude::*;

use crate::refusal;

/// So long nobody asks whether the user has pressed Ctrl-C: asking takes the interpreter's lock.
const BETWEEN: Duration = Duration::from_millis(50);

/// When Python was asked last whether to go on, and what it said against it.
struct InterruptCheck {
    last: Instant,
    raised: Option<PyErr>,
}

impl InterruptCheck {
    fn is_stopped(&mut self) -> bool {
        if self.raised.is_none() && self.last.elapsed() >= BETWEEN {
            self.last = Instant::now();
            self.raised = Python::attach(|py| py.check_signals()).err();
        }
        self.raised.is_some()
    }
}

fn locked(asking: &Mutex<InterruptCheck>) -> std::sync::MutexGuard<'_, InterruptCheck> {
    asking.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does `job` while other threads run Python. Ctrl-C ends it at the next piece of its CL file that is read.
pub fn apart<T: Send>(
    py: Python<'_>,
    job: impl FnOnce(&StopSignal) -> Result<T, Refusal> + Send,
) -> PyResult<T> {
    let (done, raised) = py.detach(|| {
        let asking = Arc::new(Mutex::new(InterruptCheck { last: Instant::now(), raised: None }));
        let asked = Arc::clone(&asking);
        let stop: StopSignal = Arc::new(move || locked(&asked).is_stopped());
        let done = catch_unwind(AssertUnwindSafe(|| job(&stop)));
        (done, locked(&asking).raised.take())
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
    apart(py, |_| panic!("asked for"))
}
