//! `--dialect`: a machine in another dialect than its file names, for one run.

use std::path::PathBuf;

use post_machine::description::{GivenOption, Setting};
use post_machine::diagnostic::Diagnostic;

use super::machine_files;
use crate::session::Session;

/// Says what of the machine file does not go over to the dialect that the command line names. The machine is looked at
/// once more, with the other `settings` alone; what is wrong with it is said where it is used.
pub fn say_what_is_left(
    session: &Session,
    dialect: Option<&str>,
    machine: &str,
    folders: &[PathBuf],
    settings: &[Setting],
) {
    let Some(dialect) = dialect else { return };
    let others = settings.iter();
    let others = others.filter(|setting| !matches!(setting, Setting::Dialect(_)));
    let others: Vec<Setting> = others.cloned().collect();
    let Ok(machine) = machine_files::load(session, machine, folders, &others) else {
        return;
    };
    let (own, options) = (&machine.control.dialect, &machine.control.options);
    if own == dialect {
        return;
    }
    let lines = "what the machine file writes in words of its own (clamps, retract, lines of codes) stays as it is: see \
                 that this control reads it";
    let message = match options.as_slice() {
        [] => format!("--dialect {dialect} is not the machine's own, which is {own}"),
        options => format!(
            "--dialect {dialect} is not the machine's own, which is {own}: its options are not carried over ({}); those \
             of [control.{dialect}] are used if there are any",
            keys(options)
        ),
    };
    session.findings(&[Diagnostic::warning("dialect", message).help(lines)]);
}

fn keys(options: &[GivenOption]) -> String {
    let keys: Vec<&str> = options.iter().map(|option| option.key.as_str()).collect();
    keys.join(", ")
}
