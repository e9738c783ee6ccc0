//! `post completions`: what a shell completes.

use clap::builder::PossibleValuesParser;
use clap::{Args, Command};
use clap_complete::{Shell, generate};

use post_cli::terminal;
use post_job::failure::Failure;
use post_job::machine_files;
use post_job::session::Session;

/// Prints what a shell reads to complete the verbs and flags of post, and in bash, fish and zsh the names of machines.
///
/// The machines are those that `post machines` lists as it is printed; machine files are completed beside them.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post completions bash > ~/.local/share/bash-completion/completions/post
  post completions fish > ~/.config/fish/completions/post.fish
  post completions zsh > ~/.zfunc/_post")]
pub struct CompletionsArguments {
    /// The shell.
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Prints it.
pub fn run(
    session: &Session,
    arguments: &CompletionsArguments,
    command: Command,
) -> Result<(), Failure> {
    let names: Vec<String> =
        machine_files::known("", &[]).into_iter().map(|(name, _)| name).collect();
    let mut text = Vec::new();
    generate(arguments.shell, &mut with_machines(command, &names), "post", &mut text);
    let text = String::from_utf8_lossy(&text);
    terminal::print(session, &with_files(arguments.shell, &text, &names));
    Ok(())
}

/// The command with `names` as values of all that take a machine, in all its verbs.
fn with_machines(command: Command, names: &[String]) -> Command {
    let command = command.mut_args(|arg| match arg.get_value_names() {
        Some([name]) if name == "MACHINE" => {
            arg.value_parser(PossibleValuesParser::new(names.to_vec()))
        }
        _ => arg,
    });
    command.mut_subcommands(|verb| with_machines(verb, names))
}

/// What is generated takes the `names` for all there are: machine files are completed beside them.
fn with_files(shell: Shell, text: &str, names: &[String]) -> String {
    let listed = names.join(" ");
    match shell {
        Shell::Bash => text
            .replace(&format!("compgen -W \"{listed}\""), &format!("compgen -f -W \"{listed}\"")),
        Shell::Fish => {
            let first = names.first().map_or("", String::as_str);
            let ours = [" -f -a ", " -F -a "].map(|files| format!("{files}\"{first}\\t"));
            text.replace(&ours[0], &ours[1])
        }
        Shell::Zsh => {
            let ours = format!(
                "_post_machines() {{\n    _alternative 'machines:machine:({listed})' 'files:machine file:_files'\n}}\n\n_post() {{"
            );
            text.replace(&format!(":MACHINE:({listed})"), ":MACHINE:_post_machines").replacen(
                "_post() {",
                &ours,
                1,
            )
        }
        _ => text.to_owned(),
    }
}
