//! Where the text of each event ends, as a library tells it: in memory that the host of its process sees too, if it has
//! one of its own.

#[cfg(unix)]
use crate::isolation::Progress;

/// The ends of the events of a batch.
#[derive(Debug, Default)]
pub(crate) struct Ends {
    own: Vec<u64>,
    #[cfg(unix)]
    pub(crate) progress: Option<Progress>,
}

impl Ends {
    /// Runs `call` with room for the ends of `count` events, none of them told yet; what it tells is in the answer of
    /// [`Ends::told`].
    pub(crate) fn tell<R>(&mut self, count: usize, call: impl FnOnce(&mut [u64]) -> R) -> R {
        self.own.clear();
        #[cfg(unix)]
        if let Some(room) = self.progress.as_mut().and_then(|progress| progress.room(count)) {
            let result = call(room);
            self.own.extend_from_slice(room);
            return result;
        }
        self.own.resize(count, u64::MAX);
        call(&mut self.own)
    }

    /// What was told by the last call.
    pub(crate) fn told(&self) -> &[u64] {
        &self.own
    }
}
