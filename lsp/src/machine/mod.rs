//! What is told of machine files.
//!
//! | file | does |
//! |---|---|
//! | `library` | where the machines are that a file extends; texts that are open come before the disk |
//! | `tree` | keys and values of a TOML text, each with its place |
//! | `meaning` | what a key means, from the schema |
//! | `cursor` | what could be written at a place |
//! | `completion`, `hover`, `hints` | what is offered, explained, and shown beside the text |
//! | `parameters` | where a parameter is defined and used, through `extends` |
//! | `fixes`, `lenses` | what a click does |

pub mod completion;
mod cursor;
pub mod fixes;
pub mod hints;
pub mod hover;
pub mod lenses;
pub mod library;
mod meaning;
pub mod parameters;
mod tree;

use post_machine::check::Check;
use post_machine::description::{Machine, Source};
use post_machine::diagnostic::Diagnostic;

use super::document::Snapshot;
use library::Library;
use post_job::{self as job, machine_files, plugin_finder, unused_options};

/// A TOML text is a machine file: above its first table it has a chain, or extends another machine.
pub fn is_machine(text: &str) -> bool {
    let top = text.lines().map(str::trim_ascii_start).take_while(|line| !line.starts_with('['));
    let mut keys = top.filter_map(|line| Some(line.split_once('=')?.0.trim_ascii_end()));
    keys.any(|key| matches!(key, "chain" | "extends"))
}

/// The machine of a text; or everything that is wrong with it.
pub fn load(of: &Snapshot, library: &Library) -> Result<Machine, Vec<Diagnostic>> {
    examine(of, library)?.machine
}

fn examine(
    of: &Snapshot,
    library: &Library,
) -> Result<post_machine::description::MachineReading, Vec<Diagnostic>> {
    let source = Source { name: of.name.clone(), text: of.text.clone() };
    let read = |path: &std::path::Path| library.read(path);
    machine_files::examine(source, &library.machines, &[], &read)
        .map_err(post_job::failure::Failure::findings)
}

/// What is found at once: what the loader says, what the plugins say of their options, and options that nothing takes.
pub fn findings(of: &Snapshot, library: &Library) -> Vec<Diagnostic> {
    let machine = match load(of, library) {
        Ok(machine) => machine,
        Err(faults) => return faults,
    };
    let finder = match plugin_finder::finder(&library.session, &library.plugins) {
        Ok(finder) => finder,
        Err(faults) => return faults,
    };
    let mut found = unused_options::found(&machine, &finder);
    if let Err(refused) = job::try_opening(&machine, &finder, 0.0) {
        found.extend(refused.findings());
    }
    found
}

/// What `post check` warns of, which takes longer.
pub fn derived(of: &Snapshot, library: &Library) -> Vec<Diagnostic> {
    let machine = load(of, library).ok();
    let check = machine.and_then(|machine| Check::of(&machine, 0.0).ok());
    check.map_or_else(Vec::new, |check| check.findings())
}
