//! What the tests of `papers` share.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

pub use post_testkit::{Run, assert_contains, names, repository as root, run};
use serde_json::Value;
use tempfile::TempDir;

/// The package, and the command that it makes.
pub const PACKAGE: &str = "post-papers";
pub const BINARY: &str = env!("CARGO_BIN_EXE_papers");

/// The command, run in the repository's folder without the user's settings.
pub fn command() -> Command {
    command_as(BINARY)
}

/// Another program that runs the command, as [`command`] does.
pub fn command_as(program: &str) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root()).env_remove("POST_MACHINES").env_remove("POST_PLUGINS");
    command
}

pub fn papers<S: AsRef<OsStr>>(arguments: &[S]) -> Run {
    run(command().args(arguments), b"")
}

/// A folder with a file in it.
pub fn with_file(name: &str, text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), text).unwrap();
    folder
}

pub fn read_json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}
