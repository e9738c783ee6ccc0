//! `post machines`: the machines that a bare name finds, and the file of one.

use std::path::PathBuf;

use clap::Args;
use post_machine::check::MachineClass;
use post_machine::description::Machine;

use post_cli::terminal;
use post_job as job;
use post_job::failure::Failure;
use post_job::machine_files::{self, ListedMachine};
use post_job::session::Session;
use post_job::text_table::TextTable;

/// Lists the machines that a bare name finds: class, axes, dialect and file.
///
/// Axes stand in the order of the chain, from the workpiece to the tool; a prime marks one that carries the workpiece
/// (ISO 841).
#[derive(Debug, Args)]
pub struct MachinesArguments {
    /// Prints the file of one machine, as a start for one of your own: `post machines --print vmc > mine.toml`.
    #[arg(long, value_name = "NAME")]
    print: Option<String>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER")]
    machines: Vec<PathBuf>,
}

/// Lists them, or prints one.
pub fn run(session: &Session, arguments: &MachinesArguments) -> Result<(), Failure> {
    if let Some(name) = &arguments.print {
        let text = machine_files::text(session, name, &arguments.machines)?;
        // Line ends as everywhere in what is printed.
        terminal::print(session, &text.replace("\r\n", "\n"));
        return Ok(());
    }
    let mut table = TextTable::headed(5, ["name", "axes", "dialect", "from", "class"]);
    for listed in machine_files::list(session, &arguments.machines)? {
        table.row(row(listed));
    }
    terminal::print(session, &table.text());
    Ok(())
}

/// Name, axes, dialect, file and class.
fn row(listed: ListedMachine) -> [String; 5] {
    let from = job::origin(listed.path.as_deref());
    match listed.machine {
        Ok(machine) => [
            listed.name,
            axes(&machine),
            machine.control.dialect.clone(),
            from,
            MachineClass::of(&machine).name,
        ],
        Err(failure) => {
            let findings = failure.findings();
            let why = findings.first().map(|finding| finding.message.as_str());
            let why = format!("cannot be loaded: {}", why.unwrap_or_default());
            [listed.name, "-".to_owned(), "-".to_owned(), from, why]
        }
    }
}

/// `C' A' Y X Z`.
fn axes(machine: &Machine) -> String {
    let names = machine.axes.iter().map(|axis| {
        let prime = if axis.carries_part { "'" } else { "" };
        format!("{}{prime}", axis.name)
    });
    names.collect::<Vec<_>>().join(" ")
}
