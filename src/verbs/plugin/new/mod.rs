//! `post plugin new`: a folder with a dialect or an error model to start from, which builds as it stands.

mod starter;

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use post_machine::diagnostic::Diagnostic;

use post_cli::terminal::print;
use post_job::failure::Failure;
use post_job::plugin_finder::built_in;
use post_job::session::Session;
use starter::{Starter, StarterFile, StarterLanguage};

/// Longest name: it stands in file names, in a symbol and in machine files.
const LONGEST: usize = 40;

/// Crates of `post` that are called `post_…` too.
const CRATES: [&str; 3] = ["iso", "kit", "plugin"];

/// Writes a folder with a dialect, or an error model, that builds as it stands: source, a test, a machine and a CL file
/// to post.
///
/// The folder carries what it is built with, so it may stand anywhere, and nothing has to be fetched.
#[derive(Debug, Args)]
#[command(
    group(ArgGroup::new("form").required(true).args(["rust", "c", "iso"])),
    after_help = "Examples:
  post plugin new mine --iso
  post plugin new work/mine --c
  post plugin new bow --model --rust

Exit codes: 0 the folder is written; 1 refused, the messages say why; 2 the command line is wrong."
)]
pub struct NewPluginArguments {
    /// Name of the plugin, with a folder in front if it shall not stand here: writes the folder NAME.
    #[arg(value_name = "NAME")]
    name: PathBuf,

    /// In Rust, event by event: for a control that is like no other.
    #[arg(long)]
    rust: bool,

    /// In Rust, as a table of the G-code family: for most controls.
    #[arg(long)]
    iso: bool,

    /// In C, or what else can export a constant.
    #[arg(long)]
    c: bool,

    /// An error model in place of a dialect: with --rust or --c.
    #[arg(long, conflicts_with = "iso")]
    model: bool,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &NewPluginArguments) -> Result<(), Failure> {
    let folder = &arguments.name;
    let name = name(folder)?;
    let language = match (arguments.rust, arguments.iso) {
        (true, _) => StarterLanguage::Rust,
        (_, true) => StarterLanguage::Iso,
        _ => StarterLanguage::C,
    };
    let form = Starter { language, model: arguments.model };
    let Some(files) = starter::files(form, name) else {
        let message = "this `post` was built without the source of an error model in Rust";
        let help = "begin with `--model --c`, or with the model that the book shows";
        return Err(Diagnostic::error("new", message).help(help).into());
    };
    if let Err(error) = fs::create_dir(folder) {
        return Err(no_folder(folder, &error).into());
    }
    if let Err((path, error)) = write(folder, &files) {
        // It was made here, a moment ago.
        let _ = fs::remove_dir_all(folder);
        let message = format!("{} cannot be written: {error}", path.display());
        return Err(Diagnostic::error("new", message).into());
    }
    let commands = starter::commands(form, name).join("\n  ");
    print(
        session,
        &format!(
            "{}: {} to start from; its README.md says what is what. In it:\n  {commands}\n",
            folder.display(),
            form.what()
        ),
    );
    Ok(())
}

/// The name of the plugin, which becomes that of a crate, of a file, of a symbol and of a table of machine files.
fn name(folder: &Path) -> Result<&str, Failure> {
    let refused = |message: String, help: &str| {
        let finding = Diagnostic::error("new", message);
        Err(finding.help(help).into())
    };
    let shown = folder.display();
    let Some(name) = folder.file_name().and_then(|name| name.to_str()) else {
        return refused(format!("{shown} is no name"), "name it after the control or the model");
    };
    let plain = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
    let begins = name.starts_with(|letter: char| letter.is_ascii_lowercase());
    if !begins || !name.bytes().all(plain) || name.len() > LONGEST {
        return refused(
            format!("`{name}` cannot be the name of a plugin"),
            &format!(
                "it begins with a letter, has small letters, digits and _ alone, and at most {LONGEST} of them"
            ),
        );
    }
    if CRATES.contains(&name) {
        return refused(
            format!("post_{name} is a crate that plugins are built with"),
            "choose another name",
        );
    }
    if [built_in(true), built_in(false)].concat().contains(&name) {
        return refused(
            format!("`{name}` is built in"),
            "choose another name: a machine file that says it would mean either",
        );
    }
    Ok(name)
}

fn no_folder(folder: &Path, error: &io::Error) -> Diagnostic {
    let shown = folder.display();
    match error.kind() {
        io::ErrorKind::AlreadyExists => {
            let finding = Diagnostic::error("new", format!("{shown} is there already"));
            finding.help("nothing is replaced: choose another name, or take it away")
        }
        io::ErrorKind::NotFound => {
            let parent = folder.parent().unwrap_or(folder).display();
            Diagnostic::error("new", format!("there is no folder {parent}"))
        }
        _ => Diagnostic::error("new", format!("{shown} cannot be made: {error}")),
    }
}

fn write(folder: &Path, files: &[StarterFile]) -> Result<(), (PathBuf, io::Error)> {
    for file in files {
        let path = folder.join(&file.path);
        write_file(&path, &file.text).map_err(|error| (path, error))?;
    }
    Ok(())
}

fn write_file(path: &Path, text: &str) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    fs::File::create_new(path)?.write_all(text.as_bytes())
}
