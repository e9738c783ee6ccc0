//! Studies: many CL files on many machines with many settings, a job and a row of the results each.
//!
//! | part | what it is |
//! |---|---|
//! | [`JobLine`] | what a job is made of, as a line of JSON |
//! | [`Grid`] | values of flags, laid over jobs: every one with every other |
//! | [`Inputs`] | texts of CL files and machines, read once, and handed on to other computers by content |
//! | [`JobStudy`] | the jobs, what is asked of each, and the columns of the results |
//! | [`JobOutcome`] | what came of one job: values by the names of the columns |
//! | [`Journal`] | outcomes by content, so that what was done is not done again |
//! | [`StudyTable`] | rows as columns; [`StudyTable::bytes`] is a file of it |
//!
//! A job that is refused is a row. So is one that panics. The results hold no clock and no order of threads: the same jobs
//! give the same bytes, however many work on them, wherever.

mod columns;
mod grid;
mod inputs;
mod job_file_line;
mod job_line;
mod journal;
mod key;
mod map_picture;
mod one_job;
mod outcome;
mod study;
mod table;
mod travel;
mod workers;

pub use grid::{Grid, MOST_JOBS, values};
pub use inputs::Inputs;
pub use job_line::{JobLine, ValueText};
pub use journal::Journal;
pub use map_picture::MapAxes;
pub use one_job::{known, told};
pub use outcome::{FAILED, JobOutcome, REFUSED, WRITTEN};
pub use study::{JobStudy, Shard};
pub use table::{StudyColumn, StudyTable, StudyValues};
pub use workers::{Cancelled, Done, run};
