//! `--report`: what a run came to, as one HTML file to look at.
//!
//! Tables and texts are packed as they come, into scratch files, and put together at the end: memory does not grow with the
//! program, and what does not fit is left out as a whole.

mod block_rows;
mod branch;
mod cl_points;
mod cl_window;
mod clearance_rows;
mod derived;
mod findings;
mod given_bodies;
mod machine;
mod made;
mod marks;
mod motion_rows;
mod old_path;
mod page_table;
mod parts;
mod path_rows;
mod predicted_lines;
mod predicted_parts;
mod predicted_rows;
mod segments;
pub mod solids;
mod told_by_prediction;

pub use block_rows::BlockRows;
pub use cl_window::ClWindow;
pub use clearance_rows::ClearanceRows;
pub use findings::warnings;
pub use machine::machine;
pub use made::{PageTexts, PostPage};
pub use motion_rows::{ExtraColumns, LineFacts, MotionRows};
pub use old_path::OldPath;
pub use parts::{PartText, Parts, excludes};
pub use predicted_lines::PredictedLines;
pub use predicted_parts::PredictedParts;
pub use told_by_prediction::{is_exceeded, predicted_facts, predicted_maxima};

use std::path::Path;

use post_machine::description::Machine;
use post_report::meta::{FORMAT, Meta, Names, TolerancesMeta};

use crate::files::PathArg;

/// The name of a file without its folders: the same job gives the same bytes wherever it lies.
pub fn name_of(file: &PathArg) -> String {
    let name = file.path().and_then(|path| path.file_name());
    name.map_or_else(|| "standard input".to_owned(), |name| name.to_string_lossy().into_owned())
}

/// A text that names a file, without the file's folders.
pub fn without_folder(text: &str, file: Option<&Path>) -> String {
    match file.and_then(|path| Some((path, path.file_name()?))) {
        Some((path, name)) => text.replace(&path.display().to_string(), &name.to_string_lossy()),
        None => text.to_owned(),
    }
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
        tolerances: TolerancesMeta {
            tip: accuracy.tolerance,
            axis: accuracy.axis_tolerance.to_degrees(),
            rapid: accuracy.rapid_tolerance,
        },
        machine: Some(self::machine(machine)),
        heads: machine.heads.iter().map(|head| self::machine(&head.machine)).collect(),
        ..Meta::default()
    }
}
