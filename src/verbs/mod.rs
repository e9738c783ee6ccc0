//! The verbs of the command, a file or a folder each. No verb uses another: what two of them need lies in the rooms
//! below, `job`, `files`, `terminal` and `arguments`.

mod batch;
mod calibrate;
mod check;
mod clearance;
mod complete;
mod convert;
mod diff;
mod explain;
mod late;
mod lint;
mod list_machines;
mod list_words;
mod lsp;
mod man;
mod new;
mod place;
mod plugin;
mod post;
mod predict;
mod print_schema;
mod profile;
mod read;
mod tools;
mod verify;
mod view;

use std::ffi::OsString;
use std::path::Path;

use clap::error::ErrorKind;
use clap::{ArgMatches, Args, Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use post_machine::diagnostic::nearest;

use crate::isolation::{IsolationArguments, OpensPlugins};
use crate::job_lines::{self, PlainWords, ProgramWords};
use batch::BatchArguments;
use calibrate::CalibrateArguments;
use check::CheckArguments;
use clearance::ClearanceArguments;
use complete::CompletionsArguments;
use convert::ConvertArguments;
use diff::DiffArguments;
use explain::ExplainArguments;
use late::Late;
use lint::LintArguments;
use list_machines::MachinesArguments;
use list_words::WordsArguments;
use lsp::LspArguments;
use man::ManArguments;
use new::NewArguments;
use place::PlaceArguments;
use plugin::PluginArguments;
use post::PostArguments;
use post_cli::failure::CommandFault;
use post_job::disk;
use post_job::session::Session;
use predict::PredictArguments;
use print_schema::SchemaArguments;
use profile::ProfileArguments;
use read::ReadArguments;
use tools::ToolsArguments;
use verify::VerifyArguments;
use view::{View, ViewArguments};

/// A post-processor for five-axis machines: turns a CL file (APT, CLSF, NCL) into the NC program of one machine.
///
/// The machine is a TOML file: its kinematic chain, its control and the tolerance that the program must
/// keep. Points are put in where the axes would stray from the path, and the deviation of every block of the
/// program is certified. Nothing is written unless the whole program is good.
#[derive(Debug, Parser)]
#[command(
    name = "post",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:
  post --machine ac-trunnion part.cls
  post --machine dmu50.toml part.ncl -o part.h --mount 0,0,120 --summary part.json
  post --machine disc-cutter --set Lm=250 disc-blade.cls -o -
  post --machine vmc part.cls --tools tool.tbl --save-job part.job.toml
  post part.job.toml
  post words part.cls
  post profile umc-750
  post new my-mill --class table-table-ac --dialect linuxcnc
  post check my-mill.toml --svg reach.svg
  post convert part.h --from dmu50 --to ac-trunnion -o part.nc
  post place part.cls --machine dmu50 --svg travel.svg
  post batch *.cls --machine dmu50 --machine ac-trunnion -o results.parquet
  post read part.nc --machine ac-trunnion --csv motions.csv
  post verify part.nc --machine dmu50 --against part.cls --map map.json
  post clearance part.nc --machine dmu50-with-vise.toml --cl part.cls
  post lint part.nc --machine ac-trunnion
  post diff old.nc new.nc --machine ac-trunnion
  post predict part.nc --machine ac-trunnion --pictures prediction
  post tools tool.tbl --against part.cls
  post view part.cls --machine ac-trunnion
  post explain over-travel
  post plugin show fanuc
  post plugin new mine --iso
  post plugin test target/release/libpost_mine.so

Exit codes: 0 the program is written; 1 refused, the messages say why, and what was written nevertheless;
2 the command line is wrong; 128 and a signal's number: interrupted, or (141) whoever reads the program
from standard output went away before its end.",
    max_term_width = 100
)]
pub struct CommandLine<const LATE: bool = true> {
    #[command(flatten)]
    post: Nameless,
    #[command(flatten)]
    isolation: IsolationArguments,
    #[command(subcommand)]
    verb: Option<Verb<LATE>>,
}

/// The arguments of the verb that has no name; none where there is a verb, whose arguments are others.
#[derive(Debug)]
struct Nameless(Option<PostArguments>);

impl Args for Nameless {
    fn augment_args(command: Command) -> Command {
        PostArguments::augment_args(command)
    }

    fn augment_args_for_update(command: Command) -> Command {
        PostArguments::augment_args_for_update(command)
    }
}

impl FromArgMatches for Nameless {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        match matches.subcommand_name() {
            Some(_) => Ok(Self(None)),
            None => PostArguments::from_arg_matches(matches).map(|post| Self(Some(post))),
        }
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

#[derive(Debug, Subcommand)]
enum Verb<const LATE: bool> {
    Words(Late<WordsArguments, LATE>),
    Machines(Late<MachinesArguments, LATE>),
    Profile(Late<ProfileArguments, LATE>),
    Schema(Late<SchemaArguments, LATE>),
    Batch(Late<Box<OpensPlugins<BatchArguments>>, LATE>),
    Calibrate(Late<CalibrateArguments, LATE>),
    Check(Late<OpensPlugins<CheckArguments>, LATE>),
    Clearance(Late<Box<OpensPlugins<ClearanceArguments>>, LATE>),
    Convert(Late<Box<OpensPlugins<ConvertArguments>>, LATE>),
    Diff(Late<Box<OpensPlugins<DiffArguments>>, LATE>),
    Lint(Late<Box<OpensPlugins<LintArguments>>, LATE>),
    New(Late<NewArguments, LATE>),
    Place(Late<Box<OpensPlugins<PlaceArguments>>, LATE>),
    Predict(Late<Box<OpensPlugins<PredictArguments>>, LATE>),
    Verify(Late<Box<OpensPlugins<VerifyArguments>>, LATE>),
    Plugin(Late<PluginArguments, LATE>),
    Read(Late<Box<OpensPlugins<ReadArguments>>, LATE>),
    Tools(Late<ToolsArguments, LATE>),
    View(Late<ViewArguments, LATE>),
    Lsp(Late<OpensPlugins<LspArguments>, LATE>),
    Explain(Late<ExplainArguments, LATE>),
    Completions(Late<CompletionsArguments, LATE>),
    Man(Late<ManArguments, LATE>),
}

/// The command line with all its verbs made.
pub type AllVerbs = CommandLine<false>;

impl CommandLine {
    /// What `words` say, the name of the command first. A fault is told as the command line with all verbs tells it.
    ///
    /// # Errors
    /// A wrong command line; help and version, which are no faults.
    pub fn read(words: &[OsString]) -> Result<Self, clap::Error> {
        Self::parsed(words, false).map_err(|fault| match fault.kind() {
            ErrorKind::DisplayVersion => fault,
            _ => AllVerbs::try_parse_from(words).err().unwrap_or(fault),
        })
    }

    /// What the words of a job say, and those of the user behind them, which win.
    fn of_job(line: &ProgramWords) -> Result<Self, clap::Error> {
        let mut all = Self::parsed(&line.words, true)?;
        let Some(PlainWords { words, mark }) = &line.plain else {
            return Ok(all);
        };
        let plain = Self::parsed(words, true)?;
        let made = |line: &Self| line.post.0.as_ref().map(PostArguments::what_is_made);
        // What is made in another way is not what the job file says.
        if made(&all) == made(&plain) {
            all.post.0 = all.post.0.map(|post| post.marked(mark.clone()));
        }
        Ok(all)
    }

    fn parsed(words: &[OsString], overriding: bool) -> Result<Self, clap::Error> {
        let mut command = Self::command().args_override_self(overriding);
        let matches = command.try_get_matches_from_mut(words)?;
        Self::from_arg_matches(&matches).map_err(|fault| fault.format(&mut command))
    }

    /// Does what the command line says.
    pub fn run(self, session: &Session) -> Result<(), CommandFault> {
        self.isolation.apply(session);
        let done = match self.verb {
            None => self.post.0.map_or(Ok(()), |post| post::run(session, &post)),
            Some(Verb::Words(Late(arguments))) => list_words::run(session, &arguments),
            Some(Verb::Machines(Late(arguments))) => list_machines::run(session, &arguments),
            Some(Verb::Profile(Late(arguments))) => profile::run(session, &arguments),
            Some(Verb::Schema(Late(arguments))) => print_schema::run(session, &arguments),
            Some(Verb::Batch(Late(verb))) => batch::run(session, verb.applied(session)),
            Some(Verb::Calibrate(Late(arguments))) => calibrate::run(session, &arguments),
            Some(Verb::Check(Late(verb))) => check::run(session, verb.applied(session)),
            Some(Verb::Clearance(Late(verb))) => clearance::run(session, verb.applied(session)),
            Some(Verb::Convert(Late(verb))) => convert::run(session, verb.applied(session)),
            Some(Verb::Diff(Late(verb))) => diff::run(session, verb.applied(session)),
            Some(Verb::Lint(Late(verb))) => return lint::run(session, verb.applied(session)),
            Some(Verb::New(Late(arguments))) => new::run(session, &arguments),
            Some(Verb::Place(Late(verb))) => place::run(session, verb.applied(session)),
            Some(Verb::Predict(Late(verb))) => predict::run(session, verb.applied(session)),
            Some(Verb::Verify(Late(verb))) => verify::run(session, verb.applied(session)),
            Some(Verb::Plugin(Late(arguments))) => plugin::run(session, &arguments),
            Some(Verb::Read(Late(verb))) => read::run(session, verb.applied(session)),
            Some(Verb::Tools(Late(arguments))) => return tools::run(session, &arguments),
            Some(Verb::View(Late(arguments))) => return view(session, &arguments),
            Some(Verb::Explain(Late(arguments))) => return explain::run(session, &arguments),
            Some(Verb::Lsp(Late(verb))) => lsp::run(session, verb.applied(session)),
            Some(Verb::Completions(Late(arguments))) => {
                complete::run(session, &arguments, AllVerbs::command())
            }
            Some(Verb::Man(Late(arguments))) => man::run(session, &arguments, AllVerbs::command()),
        };
        Ok(done?)
    }
}

/// Runs the command line of these words, or those of the programs of the job that they name; `said` tells what is wrong
/// with a line that is none.
///
/// # Errors
/// The first that is refused.
pub fn run(
    session: &Session,
    words: &[OsString],
    said: impl Fn(clap::Error) -> clap::Error,
) -> Result<(), CommandFault> {
    let verbs = || {
        let command = CommandLine::<true>::command();
        command.get_subcommands().map(|verb| verb.get_name().to_owned()).collect::<Vec<_>>()
    };
    let Some(lines) = job_lines::lines(session, words, &verbs)? else {
        let line = CommandLine::read(words).map_err(|fault| CommandFault::Usage(said(fault)))?;
        return line.run(session);
    };
    if lines.iter().any(|line| line.channel) {
        let each = lines.iter().map(|line| CommandLine::of_job(line).map(|line| line.post.0));
        let each: Vec<_> = each.collect::<Result<_, _>>().map_err(CommandFault::Usage)?;
        let each: Vec<_> = each.into_iter().flatten().collect();
        return Ok(post::run_channels(session, &each)?);
    }
    for line in lines {
        CommandLine::of_job(&line).map_err(CommandFault::Usage)?.run(session)?;
    }
    Ok(())
}

/// Runs another command line with a report, and opens that.
fn view(session: &Session, arguments: &ViewArguments) -> Result<(), CommandFault> {
    let view = View::new(arguments)?;
    let done = run(session, &view.line, |fault| fault);
    // A program that is not as it should be is worth a look too.
    let shown = view.show();
    done.and(Ok(shown?))
}

/// What is said to a command line that begins with a verb that `papers` has now.
pub fn moved() -> Option<clap::Error> {
    let first = std::env::args_os().nth(1)?;
    let verb = ["study", "plan"].into_iter().find(|verb| first == *verb)?;
    let message = format!("`post {verb}` is `papers {verb}` now");
    let fault = || AllVerbs::command().error(ErrorKind::InvalidSubcommand, message);
    (!disk::exists(Path::new(verb))).then(fault)
}

/// What is wrong with a command line that begins with a misspelt verb: clap takes it for a CL file, and complains of what
/// follows.
pub fn misspelt() -> Option<clap::Error> {
    let first = std::env::args_os().nth(1)?;
    let first = first.to_str()?;
    // Of a flag, clap itself says what is wrong.
    if first.starts_with('-') {
        return None;
    }
    let mut command = AllVerbs::command();
    let verbs: Vec<String> =
        command.get_subcommands().map(|verb| verb.get_name().to_owned()).collect();
    if verbs.iter().any(|verb| verb == first) || disk::exists(Path::new(first)) {
        return None;
    }
    let meant = nearest(first, verbs.iter().map(String::as_str))?;
    let message = format!(
        "there is no verb '{first}', and no file\n\n  tip: a similar verb exists: '{meant}'"
    );
    Some(command.error(ErrorKind::InvalidSubcommand, message))
}
