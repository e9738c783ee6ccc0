//! Work that a thread of its own does ahead of whoever takes it, in its order.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::{self, Scope};

use post_posting::STACK;

/// Batches that are made and not taken yet, at most.
const ON_THE_WAY: usize = 4;

/// Makes batches in order.
pub trait Maker: Send {
    /// What it makes.
    type Batch: Default + Send;

    /// Makes the next batch in the place of what was there, of `most` things or a few more, at least one; false if nothing
    /// follows.
    fn make(&mut self, batch: &mut Self::Batch, most: usize) -> bool;
}

/// A maker at work.
pub enum Work<'s, M: Maker> {
    /// Where it is taken, one thing at a time: nothing is made that is not taken.
    Here(&'s mut M),
    /// On a thread, ahead of whoever takes it.
    Beside {
        /// What it has made, or what a panic had to say.
        made: Receiver<Made<M>>,
        /// Batches that are taken, to be filled again.
        taken: Sender<M::Batch>,
    },
}

/// What comes from the thread.
type Made<M> = Result<<M as Maker>::Batch, Box<dyn Any + Send>>;

impl<'s, M: Maker> Work<'s, M> {
    /// On a thread of `scope` that makes `most` things at a time, or where it is taken if none are said.
    pub fn start<'e>(scope: &'s Scope<'s, 'e>, maker: &'s mut M, most: Option<usize>) -> Self
    where
        M::Batch: 's,
    {
        match most {
            Some(most) => Self::beside(scope, maker, most),
            None => Self::Here(maker),
        }
    }

    /// On a thread of `scope` that makes `most` things at a time; here, where none can be started.
    fn beside<'e>(scope: &'s Scope<'s, 'e>, maker: &'s mut M, most: usize) -> Self
    where
        M::Batch: 's,
    {
        let (send, made) = sync_channel::<Made<M>>(ON_THE_WAY);
        let (taken, empty) = channel::<M::Batch>();
        let (hand, handed) = channel::<&'s mut M>();
        let thread = thread::Builder::new().name("ahead".to_owned()).stack_size(STACK);
        let started = thread.spawn_scoped(scope, move || {
            let Ok(maker) = handed.recv() else {
                return;
            };
            let all = AssertUnwindSafe(|| make_all(maker, most, &send, &empty));
            if let Err(payload) = catch_unwind(all) {
                // Whoever waits for more has to know; nobody may wait any more.
                let _ = send.send(Err(payload));
            }
        });
        if started.is_err() {
            return Self::Here(maker);
        }
        // The thread waits for it.
        let _ = hand.send(maker);
        Self::Beside { made, taken }
    }

    /// The next batch, in the place of one that is taken; false if nothing follows.
    pub fn next(&mut self, batch: &mut M::Batch) -> bool {
        let (made, taken) = match self {
            Self::Here(maker) => return maker.make(batch, 1),
            Self::Beside { made, taken } => (made, taken),
        };
        match made.recv() {
            Ok(Ok(next)) => {
                // The thread may have made its last.
                let _ = taken.send(std::mem::replace(batch, next));
                true
            }
            Ok(Err(payload)) => resume_unwind(payload),
            Err(_) => false,
        }
    }
}

/// Makes batches until nothing follows, or nobody takes them any more.
fn make_all<M: Maker>(
    maker: &mut M,
    most: usize,
    send: &SyncSender<Made<M>>,
    empty: &Receiver<M::Batch>,
) {
    loop {
        let mut batch = empty.try_recv().unwrap_or_default();
        if !maker.make(&mut batch, most) || send.send(Ok(batch)).is_err() {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts up to a number, and panics where it is told to.
    struct Counting {
        next: u32,
        last: u32,
        panics_at: u32,
    }

    impl Maker for Counting {
        type Batch = Vec<u32>;

        fn make(&mut self, batch: &mut Vec<u32>, most: usize) -> bool {
            batch.clear();
            while batch.len() < most && self.next < self.last {
                assert_ne!(self.next, self.panics_at, "the maker is out of its mind");
                batch.push(self.next);
                self.next += 1;
            }
            !batch.is_empty()
        }
    }

    /// What is taken of a maker, up to so many batches; and how far it has come.
    fn taken(maker: &mut Counting, beside: Option<usize>, batches: usize) -> Vec<u32> {
        thread::scope(|scope| {
            let mut work = Work::start(scope, maker, beside);
            let (mut taken, mut batch) = (Vec::new(), Vec::new());
            for _ in 0..batches {
                if !work.next(&mut batch) {
                    break;
                }
                taken.extend_from_slice(&batch);
            }
            taken
        })
    }

    #[test]
    fn what_is_made_beside_comes_in_its_order() {
        for beside in [None, Some(1), Some(7), Some(5000)] {
            let mut maker = Counting { next: 0, last: 1000, panics_at: u32::MAX };
            assert!(taken(&mut maker, beside, usize::MAX).into_iter().eq(0..1000), "{beside:?}");
        }
    }

    /// Here nothing is made that is not taken; beside only so much.
    #[test]
    fn who_takes_no_more_ends_it() {
        let mut maker = Counting { next: 0, last: u32::MAX, panics_at: u32::MAX };
        assert_eq!(taken(&mut maker, None, 3), [0, 1, 2]);
        assert_eq!(maker.next, 3);
        let mut maker = Counting { next: 0, last: u32::MAX, panics_at: u32::MAX };
        assert_eq!(taken(&mut maker, Some(10), 1).len(), 10);
        assert!(maker.next <= 10 * (2 + ON_THE_WAY as u32), "{}", maker.next);
    }

    #[test]
    #[should_panic(expected = "the maker is out of its mind")]
    fn a_panic_beside_is_a_panic() {
        let mut maker = Counting { next: 0, last: 1000, panics_at: 500 };
        taken(&mut maker, Some(10), usize::MAX);
    }
}
