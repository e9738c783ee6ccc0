//! `--report`: what a run came to, as one HTML file to look at.
//!
//! Tables and texts are packed as they come, into scratch files, and put together at the end: memory does not grow with the
//! program, and what does not fit is left out as a whole.

mod block_rows;
mod cl_window;
mod findings;
mod machine;
mod made;
mod parts;
mod path_rows;

pub use block_rows::BlockRows;
pub use cl_window::ClWindow;
pub use findings::warnings;
pub use machine::machine;
pub use made::Made;
pub use parts::{Parts, excludes};

use post_machine::description::Machine;
use post_report::meta::{FORMAT, Meta, Names, Tolerances};

use crate::files::PathArg;

/// The name of a file without its folders: the same job gives the same bytes wherever it lies.
pub fn name_of(file: &PathArg) -> String {
    let name = file.path().and_then(|path| path.file_name());
    name.map_or_else(
        || "standard input".to_owned(),
        |name| name.to_string_lossy().into_owned(),
    )
}

/// What every report says of its job.
pub fn about(job: &'static str, machine: &Machine, title: String, names: Names) -> Meta {
    let accuracy = &machine.accuracy;
    Meta {
        format: FORMAT,
        by: format!("post {}", env!("CARGO_PKG_VERSION")),
        job,
        title,
        names,
        tolerances: Tolerances {
            tip: accuracy.tolerance,
            axis: accuracy.axis_tolerance.to_degrees(),
            rapid: accuracy.rapid_tolerance,
        },
        machine: Some(self::machine(machine)),
        ..Meta::default()
    }
}
