//! `post profile`: machines of real makers, where their numbers come from and what is not known of them.

use std::path::PathBuf;

use clap::Args;
use post_cli::terminal;
use post_job::failure::Failure;
use post_job::machine_files;
use post_job::session::Session;
use post_job::text_table::{NamedValues, TextTable};
use post_machine::description::{Machine, NumberOrigin, StatedNumber};
use post_machine::diagnostic::Diagnostic;

/// Lists the machines of real makers, or tells where the numbers of one come from.
///
/// Every number of the machine stands there with its source, or with what is to be measured: a file is as good as they are.
/// `[profile]` of the machine file says it (machines/README.md), in a file of your own too.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post profile
  post profile umc-750
  post machines --print umc-750 > ours.toml
  post profile ours.toml

Exit codes: 0 listed; 1 refused, the messages say why; 2 the command line is wrong.")]
pub struct ProfileArguments {
    /// The machine, by its name or its file.
    #[arg(value_name = "MACHINE")]
    machine: Option<String>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER")]
    machines: Vec<PathBuf>,
}

/// Width of the names.
const NAME: usize = 12;

/// Lists them, or tells of one.
pub fn run(session: &Session, arguments: &ProfileArguments) -> Result<(), Failure> {
    let named = &arguments.machines;
    let text = match &arguments.machine {
        None => list(session, named)?,
        Some(name) => {
            let machine = machine_files::load(session, name, named, &[])?;
            let numbers = machine_files::numbers(session, name, named)?;
            session.findings(&slips(&machine, &numbers));
            profile(&machine, &numbers)
        }
    };
    terminal::print(session, &text);
    Ok(())
}

/// The machines whose files name a maker.
fn list(session: &Session, named: &[PathBuf]) -> Result<String, Failure> {
    let heads = ["name", "maker", "model", "control", "dialect", "numbers looked up"];
    let mut table = TextTable::headed(heads.len(), heads);
    for listed in machine_files::list(session, named)? {
        let Ok(machine) = listed.machine else { continue };
        let profile = &machine.profile;
        if profile.maker.is_empty() {
            continue;
        }
        let numbers = machine_files::numbers(session, &listed.name, named)?;
        table.row([
            listed.name,
            profile.maker.clone(),
            profile.model.clone(),
            profile.control.clone(),
            machine.control.dialect.clone(),
            format!("{} of {}", known(&machine, &numbers), numbers.len()),
        ]);
    }
    Ok(table.text())
}

/// How many numbers have a source.
fn known(machine: &Machine, numbers: &[StatedNumber]) -> usize {
    let sources = numbers
        .iter()
        .filter(|number| matches!(machine.profile.origin(&number.key), NumberOrigin::Source(_)));
    sources.count()
}

/// All of one machine: what is not known of it ahead of its numbers.
fn profile(machine: &Machine, numbers: &[StatedNumber]) -> String {
    let profile = &machine.profile;
    let mut rows = NamedValues::default();
    let said = |text: &str| if text.is_empty() { "not said".to_owned() } else { text.to_owned() };
    rows.row("machine", &machine.name);
    rows.row("maker", said(&profile.maker));
    rows.row("model", said(&profile.model));
    rows.row("control", format_args!("{} ({})", said(&profile.control), machine.control.dialect));
    match profile.checked.as_slice() {
        [] => rows.row("checked", "nothing was checked at a machine"),
        checked => checked.iter().for_each(|line| rows.row("checked", line)),
    }
    for line in profile.not_known() {
        rows.row("not known", line);
    }
    let mut table = TextTable::headed(3, ["number", "value", "from"]);
    for StatedNumber { key, value } in numbers {
        let from = match profile.origin(key) {
            NumberOrigin::Source(source) => source,
            NumberOrigin::Unknown(_) => "not known",
            NumberOrigin::Unsaid => "not said",
        };
        table.row([key.clone(), value.clone(), from.to_owned()]);
    }
    format!("{}\n{}", rows.lines(NAME), table.text())
}

/// Keys of `[profile]` that name no number.
fn slips(machine: &Machine, numbers: &[StatedNumber]) -> Vec<Diagnostic> {
    let strangers = machine.profile.strangers(numbers).into_iter();
    strangers
        .map(|key| {
            let message = format!("[profile] tells where `{key}` comes from, and the file has no number of that key");
            Diagnostic::warning("machine-profile", message)
                .help("a key is that of a number, axis.X.travel, or of a table, axis.X; the list of the numbers follows")
        })
        .collect()
}
