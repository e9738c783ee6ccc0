//! Threads that take jobs one after the other.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use post_machine::diagnostic::Diagnostic;
use post_posting::STACK;

use super::JobStudy;
use super::inputs::Inputs;
use super::journal::Journal;
use super::one_job::{self, JobResult};
use super::outcome::JobOutcome;
use crate::failure::Failure;
use crate::session::Session;
use crate::settings::ThreadSettings;

/// How often whoever waits is asked whether to go on.
const LOOK: Duration = Duration::from_millis(50);

/// The work is given up.
pub struct Cancelled;

/// How far the work has come.
#[derive(Clone, Copy, Debug, Default)]
pub struct Done {
    /// Jobs that are done.
    pub jobs: usize,
    /// Of them those that the journal knew.
    pub known: usize,
    /// Of them those that are not written.
    pub refused: usize,
}

/// Does the jobs with these numbers on so many threads (none: as many as the computer has), and hands back their outcomes
/// in the order of the numbers. `look` is asked all the while whether to go on; none if it gives up.
///
/// # Errors
/// The journal cannot be written, or no thread be started.
pub fn run(
    study: &JobStudy,
    inputs: &Inputs,
    numbers: &[usize],
    threads: Option<NonZeroUsize>,
    journal: Option<&Journal>,
    look: &mut dyn FnMut(Done) -> Result<(), Cancelled>,
) -> Result<Option<Vec<JobOutcome>>, Failure> {
    let threads = ThreadSettings { jobs: threads }.most().get().min(numbers.len());
    let next = AtomicUsize::new(0);
    let stop = Arc::new(AtomicBool::new(false));
    let mut outcomes: Vec<Option<JobOutcome>> = vec![None; numbers.len()];
    let mut done = Done::default();
    let mut fault = None;
    thread::scope(|scope| {
        let (send, receive) = mpsc::channel::<(usize, JobResult)>();
        for _ in 0..threads {
            let send = send.clone();
            let (next, stop) = (&next, &stop);
            let jobs = move || {
                // What a job would print beside its row is in the row; bars of several threads would cross each other.
                let session = Session::quiet();
                while !stop.load(Ordering::Relaxed) {
                    let place = next.fetch_add(1, Ordering::Relaxed);
                    let Some(number) = numbers.get(place) else {
                        return;
                    };
                    let job = &study.jobs[*number];
                    let Some(did) = one_job::run(&session, study, job, inputs, journal, stop)
                    else {
                        return;
                    };
                    if send.send((place, did)).is_err() {
                        return;
                    }
                }
            };
            let thread = thread::Builder::new().name("batch".to_owned()).stack_size(STACK);
            if let Err(error) = thread.spawn_scoped(scope, jobs) {
                let message = format!("no thread can be started: {error}");
                fault =
                    Some(Failure::from(Diagnostic::error("batch", message).help("fewer --jobs")));
                stop.store(true, Ordering::Relaxed);
            }
        }
        drop(send);
        loop {
            match receive.recv_timeout(LOOK) {
                Ok((place, did)) => {
                    done.jobs += 1;
                    done.known += usize::from(did.known);
                    done.refused += usize::from(did.outcome.state() != super::WRITTEN);
                    let added = match (journal, did.known) {
                        (Some(journal), false) => journal.add(&did.outcome),
                        _ => Ok(()),
                    };
                    if let Err(why) = added {
                        fault.get_or_insert(why.into());
                        stop.store(true, Ordering::Relaxed);
                    }
                    outcomes[place] = Some(did.outcome);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            if !stop.load(Ordering::Relaxed) && look(done).is_err() {
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
    match fault {
        Some(fault) => Err(fault),
        None => Ok(outcomes.into_iter().collect()),
    }
}
