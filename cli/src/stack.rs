//! Room for deep calls, whatever the shell has limited the stack to (`ulimit -s`): a parser that finds too little of it takes
//! a good file for a wrong one.

/// Runs `job` on this thread, or on one with more room if this one has less.
#[cfg(unix)]
pub(crate) fn with_room<R: Send>(job: impl FnOnce() -> R + Send) -> R {
    use std::panic::resume_unwind;
    use std::thread;

    use post_posting::STACK;
    use rustix::process::{Resource, getrlimit};

    let room = getrlimit(Resource::Stack).current.unwrap_or(u64::MAX);
    if room >= STACK as u64 {
        return job();
    }
    let (mut job, mut done) = (Some(job), None);
    let panicked = thread::scope(|scope| {
        let run = || done = job.take().map(|job| job());
        let builder = thread::Builder::new().name("main".to_owned()).stack_size(STACK);
        builder.spawn_scoped(scope, run).ok().and_then(|thread| thread.join().err())
    });
    if let Some(payload) = panicked {
        resume_unwind(payload);
    }
    match (done, job) {
        (Some(done), _) => done,
        // No thread could be started.
        (None, Some(job)) => job(),
        (None, None) => unreachable!("a job that was taken is done"),
    }
}

/// Other systems write the first thread's stack into the file of the program.
#[cfg(not(unix))]
pub(crate) fn with_room<R>(job: impl FnOnce() -> R) -> R {
    job()
}
