//! Observers that are shown cuts before anything is done about them.

use crate::accuracy::NodeMove;

/// Observers of cuts, whatever they borrow.
pub(crate) trait Audience {
    /// A cut between two CL points, before any point is put in.
    fn cut(&self, line: u64, cut: &NodeMove<'_>);
}
