//! Where a part can sit on a machine: mounts put to the proof by dry runs, and the search among them.

mod search;
mod trial;

use std::num::NonZeroUsize;

use crate::failure::Failure;
use crate::session::Session;
use crate::settings::JobSettings;
use search::Search;
use trial::Trials;

pub use search::{MountSearchResult, mount_text};
pub use trial::{PartMount, Trial};

/// What is to be small, once every axis stays inside travel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Least {
    /// The time of the program.
    #[default]
    Time,
    /// What its rotary axes turn in all.
    Rotary,
}

/// How a mount is searched.
#[derive(Clone, Copy, Debug)]
pub struct PlaceRequest {
    /// What is to be small.
    pub least: Least,
    /// Every linear axis stays this far from the ends of its travel, mm.
    pub margin: f64,
    /// The turn of the part about its Z is searched too, by steps of so many degrees.
    pub search_turn: Option<f64>,
    /// No more dry runs than this.
    pub runs: u32,
    /// Threads that work at most.
    pub threads: NonZeroUsize,
}

/// Finds the mount that keeps every axis of a job's machine inside travel and then costs least among those tried.
///
/// # Errors
/// None fits: which axis is short, by how much; or a file that cannot be read.
pub fn place(
    session: &Session,
    job: &JobSettings,
    request: &PlaceRequest,
) -> Result<MountSearchResult, Failure> {
    let mut trials = Trials::new(session, job, request)?;
    super::say_what_is_left(session, job, &trials.machine()?, trials.finder());
    Search::new(request, &mut trials)?.run()
}
