//! `post view`: the report of a run, opened.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use post_machine::diagnostic::Diagnostic;

use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files::FileFault;

/// Runs the rest of the command line, writes its report to a temporary folder, and opens it.
///
/// The rest is any command line of `post`, `verify`, `predict`, `diff` or `convert`. A program that it would write beside the
/// CL file goes into the folder of temporary files too, unless -o says where. The report stays there until somebody deletes
/// it; its name is printed.
#[derive(Debug, Args)]
#[command(
    disable_help_flag = true,
    after_help = "Examples:
  post view part.cls --machine ac-trunnion
  post view --no-open verify part.nc -m dmu50 --against part.cls
  post view predict part.nc -m ac-trunnion --against part.cls"
)]
pub struct ViewArguments {
    /// Writes the report and names it, and does not open it; ahead of the rest.
    #[arg(long)]
    no_open: bool,

    /// Print help
    #[arg(short, long, action = clap::ArgAction::Help)]
    help: Option<bool>,

    /// What is done, as without `view`.
    #[arg(value_name = "COMMAND", required = true, num_args = 1.., trailing_var_arg = true, allow_hyphen_values = true)]
    rest: Vec<OsString>,
}

/// Verbs that write a report themselves.
const WITH_A_REPORT: [&str; 4] = ["convert", "diff", "predict", "verify"];

/// A command line with a report, and where that goes.
pub struct View {
    /// The command line.
    pub line: Vec<OsString>,
    report: PathBuf,
    opens: bool,
}

impl View {
    /// Of the arguments.
    ///
    /// # Errors
    /// There is no place for the report.
    pub fn new(arguments: &ViewArguments) -> Result<Self, Failure> {
        let waiting = post_job::disk::temp_dir();
        let folder = tempfile::Builder::new().prefix("post-view-").tempdir_in(&waiting);
        let folder = folder.map_err(|error| FileFault::NoWaiting {
            name: "the report".to_owned(),
            folder: waiting,
            error,
        })?;
        let folder = folder.keep();
        let report = folder.join("report.html");
        let mut line: Vec<OsString> = vec!["post".into()];
        line.extend(arguments.rest.iter().cloned());
        let verb = arguments.rest.first().and_then(|first| first.to_str());
        let verb = verb.filter(|verb| WITH_A_REPORT.contains(verb));
        let has = |flags: [&str; 2]| {
            let mut rest = arguments.rest.iter();
            rest.any(|word| {
                flags.iter().any(|flag| {
                    let long = format!("{flag}=");
                    word == OsStr::new(flag) || word.to_string_lossy().starts_with(&long)
                })
            })
        };
        if matches!(verb, None | Some("convert")) && !has(["-o", "--output"]) {
            line.push("--output".into());
            line.push(folder.join("program.nc").into());
        }
        line.push("--report".into());
        line.push(report.clone().into());
        Ok(Self { line, report, opens: !arguments.no_open })
    }

    /// Names the report, and opens it; there is none where the run was refused.
    ///
    /// # Errors
    /// Nothing opens it.
    pub fn show(&self) -> Result<(), Failure> {
        if !self.report.is_file() {
            // Nobody shall find an empty folder.
            if let Some(folder) = self.report.parent() {
                let _ = std::fs::remove_dir_all(folder);
            }
            return Ok(());
        }
        terminal::tell(&format!("{}\n", self.report.display()));
        match self.opens {
            true => open(&self.report),
            false => Ok(()),
        }
    }
}

/// Opens a file as the platform opens files of its kind.
fn open(path: &Path) -> Result<(), Failure> {
    let (opener, first): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("cmd", &["/C", "start", ""])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(opener);
    command.args(first).arg(path);
    command.stdin(Stdio::null()).stdout(Stdio::null());
    let why = match command.stderr(Stdio::null()).status() {
        Ok(status) if status.success() => return Ok(()),
        Ok(status) => format!("{opener} ended with {status}"),
        Err(error) => format!("{opener} cannot be started: {error}"),
    };
    let message = format!("{} is written, but nothing opens it: {why}", path.display());
    Err(Diagnostic::error("view", message)
        .help("open it in a browser; --no-open only names it")
        .into())
}
