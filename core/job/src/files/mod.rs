//! Files: CL files read, texts written whole or not at all, and never over a file that is read.
//!
//! Several texts of a run take their names together or not at all. Whatever reads a file of the user's notes it in
//! [`ReadFiles`] of its session; whatever is written goes through [`AtomicFile`].

#[cfg(not(target_family = "wasm"))]
mod abandoned;
mod atomic_file;
pub mod chart;
mod cl_input;
mod cl_source;
mod file_fault;
mod file_id;
mod joined;
mod json_rows;
#[cfg(not(target_family = "wasm"))]
mod naming;
#[cfg(target_family = "wasm")]
#[path = "memory/naming.rs"]
mod naming;
mod outcome;
mod own_folder;
pub mod parquet;
mod path_arg;
mod plan_view;
mod read_ahead;
mod read_files;
mod rights;
mod scale;
mod scratch;
mod seen_files;
pub mod standard;
pub mod svg;
pub mod table_cells;
mod target;
#[cfg(not(target_family = "wasm"))]
mod temporary;
#[cfg(target_family = "wasm")]
#[path = "memory/temporary.rs"]
mod temporary;
mod watched;

use crate::disk;
use crate::session::Session;
use target::{Target, refuse_losses};

pub use atomic_file::{AtomicFile, NullSink};
pub use cl_input::ClInput;
pub use cl_source::{ClSource, HeldText};
pub use file_fault::FileFault;
pub use joined::JoinedFiles;
pub use json_rows::JsonRows;
pub use outcome::TextOutcomes;
pub use own_folder::{FolderMark, OwnFolder};
pub use path_arg::PathArg;
pub use plan_view::PlanView;
pub use read_ahead::{ClPieces, ReadAhead};
pub use read_files::ReadFiles;
pub use scale::step as round_step;
pub use scratch::Scratch;
pub use target::Role;
pub use temporary::{Temporary, delete_on_signals, delete_temporary_files};
pub use watched::{ReadPosition, Watched};

/// Writes texts whole: all of them, or none. Standard output is taken if one of them went there.
pub fn write(session: &Session, texts: &[(Role, &PathArg, &str)]) -> Result<bool, FileFault> {
    let targets: Vec<(Role, &PathArg)> =
        texts.iter().map(|(role, target, _)| (*role, *target)).collect();
    let mut files = AtomicFile::create(session, &targets)?;
    for (file, (_, _, text)) in files.iter_mut().zip(texts) {
        file.write_bytes(text.as_bytes())?;
    }
    let taken = files.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, files)?;
    Ok(taken)
}

/// Writes bytes whole, or not at all.
pub fn write_bytes(
    session: &Session,
    role: Role,
    target: &PathArg,
    bytes: &[u8],
) -> Result<(), FileFault> {
    let mut files = AtomicFile::create(session, &[(role, target)])?;
    for file in &mut files {
        file.write_bytes(bytes)?;
    }
    AtomicFile::finish(session, files)
}

/// Refuses targets that are files which the run reads, or one another, or that cannot be written to.
pub fn check_targets(session: &Session, targets: &[(Role, &PathArg)]) -> Result<(), FileFault> {
    let targets = targets.iter();
    let targets: Vec<Target> =
        targets.map(|(role, named)| Target::find(*role, named)).collect::<Result<_, _>>()?;
    refuse_losses(session, &targets.iter().collect::<Vec<_>>())
}

/// Deletes the file that a text would replace, if there is one; of a link the link alone.
pub fn remove(session: &Session, role: Role, named: &PathArg) -> Result<(), FileFault> {
    let target = Target::find(role, named)?;
    refuse_losses(session, &[&target])?;
    match named.absolute() {
        Some(path) if target.replaces => {
            disk::remove_file(path).map_err(|error| FileFault::write(named, error))
        }
        _ => Ok(()),
    }
}

/// A value as JSON, for programs to read.
pub fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).unwrap_or_default();
    text.push('\n');
    text
}

/// A value as JSON on one line.
pub fn json_line(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
