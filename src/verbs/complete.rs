//! `post completions`: what a shell completes.

use clap::{Args, Command};
use clap_complete::{Shell, generate};

use post_cli::terminal;
use post_job::failure::Failure;
use post_job::session::Session;

/// Prints what a shell reads to complete the verbs and flags of post.
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
    mut command: Command,
) -> Result<(), Failure> {
    let mut text = Vec::new();
    generate(arguments.shell, &mut command, "post", &mut text);
    terminal::print(session, &String::from_utf8_lossy(&text));
    Ok(())
}
