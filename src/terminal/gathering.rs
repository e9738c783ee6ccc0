//! Jobs that run inside another program: what they would print is handed to whoever called.

use std::cell::RefCell;

use post_machine::diagnostic::Diagnostic;

thread_local! {
    /// What the job of this thread has said so far; none where findings are printed.
    static GATHERED: RefCell<Option<Vec<Diagnostic>>> = const { RefCell::new(None) };
}

/// Puts back what was there, whatever becomes of the job.
struct Before(Option<Vec<Diagnostic>>);

impl Drop for Before {
    fn drop(&mut self) {
        GATHERED.replace(self.0.take());
    }
}

/// Runs `job`: what it finds on this thread comes back instead of being printed, and it shows no progress.
pub fn gathered<T>(job: impl FnOnce() -> T) -> (T, Vec<Diagnostic>) {
    let before = Before(GATHERED.replace(Some(Vec::new())));
    let given = job();
    let found = GATHERED.take().unwrap_or_default();
    drop(before);
    (given, found)
}

/// Takes findings if they are gathered on this thread; false if they are to be printed.
pub fn gather(findings: &[Diagnostic]) -> bool {
    asked(|gathered| match gathered {
        Some(gathered) => {
            gathered.extend_from_slice(findings);
            true
        }
        None => false,
    })
}

/// The job of this thread runs inside another program.
pub fn is_gathering() -> bool {
    asked(|gathered| gathered.is_some())
}

/// At the end of the process, where a plugin that has ended it is named, the thread's own values are gone.
fn asked(ask: impl FnOnce(&mut Option<Vec<Diagnostic>>) -> bool) -> bool {
    GATHERED.try_with(|gathered| ask(&mut gathered.borrow_mut())).unwrap_or(false)
}
