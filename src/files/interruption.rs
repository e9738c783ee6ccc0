//! Reading that whoever called may end: a job inside another program has no signals of its own.

use std::cell::RefCell;
use std::io::{self, Read};
use std::rc::Rc;

/// Says that the job shall end.
pub type Stop = Rc<dyn Fn() -> bool>;

thread_local! {
    /// Who is asked on this thread; nobody in the command.
    static STOP: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// Puts back what was there, whatever becomes of the job.
struct Before(Option<Stop>);

impl Drop for Before {
    fn drop(&mut self) {
        STOP.replace(self.0.take());
    }
}

/// Does a job that ends with a fault of reading its CL file once `stop` says so; it is asked as the file is read.
pub fn stoppable<T>(stop: Stop, job: impl FnOnce() -> T) -> T {
    let _before = Before(STOP.replace(Some(stop)));
    job()
}

/// What reads `bytes`, and asks on the way.
pub fn watched(bytes: Box<dyn Read>) -> Box<dyn Read> {
    match STOP.with_borrow(Clone::clone) {
        Some(stop) => Box::new(Stoppable { bytes, stop }),
        None => bytes,
    }
}

struct Stoppable {
    bytes: Box<dyn Read>,
    stop: Stop,
}

impl Read for Stoppable {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if (self.stop)() {
            return Err(io::Error::other("interrupted"));
        }
        self.bytes.read(into)
    }
}
