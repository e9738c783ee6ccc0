//! Work that needs no Python: the interpreter's lock is released, and what goes wrong becomes an exception.

use std::any::Any;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use post_job::STACK;
use post_job::library::{Refusal, StopSignal};
use post_machine::diagnostic::Diagnostic;
use pyo3::prelude::*;

use crate::refusal;

/// So long nobody asks whether the user has pressed Ctrl-C: asking takes the interpreter's lock.
const BETWEEN: Duration = Duration::from_millis(50);

/// Does `job` while other threads run Python, and Ctrl-C ends it soon. Python tells its signals to the thread that waits
/// here alone, so that the job has one of its own: it asks a flag, wherever it works.
pub fn apart<T: Send>(
    py: Python<'_>,
    job: impl FnOnce(&StopSignal) -> Result<T, Refusal> + Send,
) -> PyResult<T> {
    let flag = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&flag);
    let stop: StopSignal = Arc::new(move || asked.load(Ordering::Relaxed));
    let (done, raised) = py.detach(|| {
        thread::scope(|scope| {
            let (ends, ended) = channel::<()>();
            let worker = thread::Builder::new().name("post".to_owned()).stack_size(STACK);
            let worker = worker.spawn_scoped(scope, || {
                // Whatever it ends by, whoever waits is told.
                let _ends = ends;
                job(&stop)
            })?;
            let mut raised = None;
            while ended.recv_timeout(BETWEEN) == Err(RecvTimeoutError::Timeout) {
                if raised.is_none() {
                    raised = Python::attach(|py| py.check_signals()).err();
                    flag.store(raised.is_some(), Ordering::Relaxed);
                }
            }
            Ok::<_, io::Error>((worker.join(), raised))
        })
    })?;
    match raised {
        Some(raised) => Err(raised),
        None => given(py, done),
    }
}

/// Does what is over at once, on this thread, while others run Python.
pub fn at_once<T: Send>(
    py: Python<'_>,
    job: impl FnOnce(&StopSignal) -> Result<T, Refusal> + Send,
) -> PyResult<T> {
    let stop: StopSignal = Arc::new(|| false);
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(|| job(&stop))));
    given(py, done)
}

/// What a job has given, or the exception that it has come to.
fn given<T>(py: Python<'_>, done: thread::Result<Result<T, Refusal>>) -> PyResult<T> {
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
    let message = format!("post itself is at fault: {}", text.unwrap_or("no reason given"));
    Diagnostic::error("internal", message)
        .help("report it with the file and the machine that it came with")
}

/// A job that dies of a fault of our own, for the tests.
#[pyfunction]
pub fn fail(py: Python<'_>) -> PyResult<()> {
    apart(py, |_| panic!("asked for"))
}
