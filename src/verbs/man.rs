//! `post man`: manual pages.

use std::fs;
use std::path::PathBuf;

use clap::{Args, Command};
use clap_mangen::Man;

use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files;
use post_job::files::{FileFault, PathArg, Role};
use post_job::session::Session;

/// What a page is to the files of a run.
const PAGE: Role = Role { what: "manual page", remedy: "name another folder" };

/// Writes the manual pages into a folder: post.1 and one for each verb, post-check.1, …
#[derive(Debug, Args)]
pub struct ManArguments {
    /// The folder; it is made if it is not there.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Writes them.
pub fn run(
    session: &Session,
    arguments: &ManArguments,
    mut command: Command,
) -> Result<(), Failure> {
    command.build();
    let mut pages = Vec::new();
    collect(&command, &mut pages);
    fs::create_dir_all(&arguments.folder)
        .map_err(|error| FileFault::write_named(&arguments.folder.display().to_string(), error))?;
    let mut texts = Vec::new();
    for command in pages {
        // It has no date: the same pages are the same bytes.
        let page = Man::new(command);
        let name = page.get_filename();
        let target = PathArg::from(arguments.folder.join(&name));
        let mut text = Vec::new();
        page.render(&mut text).map_err(|error| FileFault::write_named(&name, error))?;
        texts.push((target, String::from_utf8_lossy(&text).into_owned()));
    }
    let written: Vec<_> =
        texts.iter().map(|(target, text)| (PAGE, target, text.as_str())).collect();
    files::write(session, &written)?;
    terminal::print(session, &format!("{} manual pages\n", written.len()));
    Ok(())
}

/// A command and all below it.
fn collect(command: &Command, pages: &mut Vec<Command>) {
    pages.push(command.clone());
    for verb in command.get_subcommands() {
        if verb.get_name() != "help" && !verb.is_hide_set() {
            collect(verb, pages);
        }
    }
}
