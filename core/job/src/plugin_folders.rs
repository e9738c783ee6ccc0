//! The folders in which libraries are looked for. Opening a library runs its code, so nothing about them is guessed: a
//! slip would take another plugin in silence.

use std::env;
use std::io;
use std::path::{Path, PathBuf};

use post_machine::diagnostic::Diagnostic;

use crate::disk;
use crate::session::Session;

/// Where further folders are named.
const VARIABLE: &str = "POST_PLUGINS";

/// The folders that the user `named`, and those of the environment. Each can be read.
pub fn named(session: &Session, named: &[PathBuf]) -> Result<Vec<PathBuf>, Vec<Diagnostic>> {
    let mut folders = Vec::new();
    let mut faults = Vec::new();
    let mut warnings = Vec::new();
    let variable = env::var_os(VARIABLE).filter(|folders| !folders.is_empty());
    let in_variable = variable.iter().flat_map(env::split_paths);
    let command_line = named.iter().map(|folder| ("--plugins", folder.clone()));
    for (source, folder) in command_line.chain(in_variable.map(|folder| (VARIABLE, folder))) {
        let told = format!("{source} {}", folder.display());
        match fault_of(source, &folder) {
            Some(finding) => faults.push(finding),
            None if anybody_writes(&folder) => warnings.push(
                Diagnostic::warning(
                    "plugin",
                    format!("{told}: everybody may write to this folder, and a plugin in it runs with your rights"),
                )
                .help("take the right to write from others (chmod o-w)"),
            ),
            None => {}
        }
        folders.push(folder);
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    session.findings(&warnings);
    Ok(folders)
}

/// Why a folder is not looked into.
fn fault_of(source: &str, folder: &Path) -> Option<Diagnostic> {
    let fault = |message: String| Diagnostic::error("plugin", message);
    if folder.as_os_str().is_empty() {
        let help = "an empty entry would mean the folder in which post is run; take it out";
        return Some(fault(format!("{source} has an empty entry")).help(help));
    }
    let told = format!("{source} {}", folder.display());
    if source == VARIABLE && folder.is_relative() {
        let help = "name the folder from the root: else it is another one wherever post is run";
        return Some(
            fault(format!("{told}: a folder in this variable must not be relative")).help(help),
        );
    }
    let error = disk::read_dir(folder).err()?;
    Some(fault(match error.kind() {
        io::ErrorKind::NotFound => format!("{told}: no such folder"),
        _ => format!("{told}: it cannot be read: {error}"),
    }))
}

#[cfg(unix)]
fn anybody_writes(folder: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    std::fs::metadata(folder).is_ok_and(|data| data.permissions().mode() & 0o002 != 0)
}

/// Other systems keep lists of rights.
#[cfg(not(unix))]
fn anybody_writes(_: &Path) -> bool {
    false
}
