//! `post lint`: what is wrong with an NC program, or may be, without a CL file.

mod headers;
mod lint_text;

use clap::Args;
use post_cli::arguments::ProgramArguments;
use post_cli::arguments::flag_values::file;
use post_cli::failure::CommandFault;
use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files::{self, AtomicFile, PathArg, Role};
use post_job::lint::{self, CodeText, LintSummary};
use post_job::nc_program::{NcControl, ProgramFile};
use post_job::plugin_finder;
use post_job::session::Session;
use post_machine::diagnostic::{Diagnostic, Severity, nearest};

use crate::codes::codes;

/// Looks over NC programs of whatever origin: what is wrong, and what may be.
///
/// No CL file is needed. Told is what the control would refuse or what is not understood; axes beyond their travel or
/// their largest feed; cuts while the spindle stands or without a feed; a tool without its length, or with that of
/// another; coolant that is gone in the middle of a tool's work; rapids that go where nothing was cut before; modes that
/// the program relies on or leaves behind; and, with bodies in the machine file, all that `post clearance` tells.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post lint part.nc --machine ac-trunnion
  post lint *.nc -m vmc --ignore coolant --ignore register --strict
  post lint part.h -m dmu50 --offsets control.toml --sarif lint.sarif
  post lint part.nc -m vmc --set 'lint.ignore=[\"coolant\"]' --json -
  post explain rapid

Exit codes: 0 nothing is wrong, but for warnings; 1 something is, with --strict warnings too;
2 the command line is wrong, or a program, the machine file or a result cannot be read or
written: programs that can be read are looked over all the same.")]
pub struct LintArguments {
    #[command(flatten)]
    program: ProgramArguments,

    /// The NC programs, `-` for standard input.
    #[arg(value_name = "NC-FILE", value_parser = file(), required = true)]
    inputs: Vec<PathArg>,

    /// Does not tell findings of this code, as it stands in brackets: `coolant` of `warning[coolant]`. Repeatable; how many
    /// there are is said. `[lint] ignore` of the machine file says so of all programs of a machine.
    #[arg(long, value_name = "CODE")]
    ignore: Vec<String>,

    /// Counts warnings as errors.
    #[arg(long)]
    strict: bool,

    /// Leaves out files that end in .h and hold no block of Klartext: headers of C, where files are named by their endings
    /// (the hook for pre-commit). Which they are is said.
    #[arg(long)]
    skip_headers: bool,

    /// Writes what was found as JSON, of several programs a list; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    json: Option<PathArg>,

    /// Writes what was found as SARIF 2.1.0, which code hosts and editors show at the lines; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    sarif: Option<PathArg>,
}

/// The group of codes whose sense is that of this verb.
const GROUP: &str = "Looking a program over";

/// What SARIF is written to.
const SARIF: Role = Role { what: "SARIF", remedy: "name another file with --sarif" };

/// Does as the arguments say.
///
/// # Errors
/// What is wrong with the programs; or what kept some of them from being looked over.
pub fn run(session: &Session, arguments: &LintArguments) -> Result<(), CommandFault> {
    let looked = look(session, arguments).map_err(CommandFault::NotLooked)?;
    let LookedOver { findings, unread } = looked;
    let wrong = |finding: &Diagnostic| arguments.strict || finding.severity == Severity::Error;
    if !unread.is_empty() {
        let all: Vec<Diagnostic> = findings.into_iter().chain(unread).collect();
        return Err(CommandFault::NotLooked(all.into()));
    }
    let (errors, warnings): (Vec<_>, Vec<_>) = findings.into_iter().partition(wrong);
    session.findings(&warnings);
    if errors.is_empty() { Ok(()) } else { Err(CommandFault::Job(errors.into())) }
}

/// What was found of all programs.
#[derive(Default)]
struct LookedOver {
    /// Of those that were looked over.
    findings: Vec<Diagnostic>,
    /// Why others were not.
    unread: Vec<Diagnostic>,
}

fn look(session: &Session, arguments: &LintArguments) -> Result<LookedOver, Failure> {
    let settings = arguments.program.settings();
    let control = NcControl::new(session, &settings)?;
    let finder = plugin_finder::finder(session, &settings.plugins)?;
    for code in &arguments.ignore {
        known(code, "--ignore")?;
    }
    for code in &control.machine.lint_ignored {
        known(code, "[lint] ignore of the machine file")?;
    }
    let inputs = arguments.inputs.iter();
    let programs: Vec<_> = inputs.map(|input| (input, ProgramFile::open(session, input))).collect();
    let mut targets: Vec<(Role, &PathArg)> = Vec::new();
    targets.extend(arguments.json.iter().map(|target| (Role::JSON, target)));
    targets.extend(arguments.sarif.iter().map(|target| (SARIF, target)));
    let mut written = AtomicFile::create(session, &targets)?;
    if written.is_empty() {
        // What was found is all that it is for.
        session.texts().note_printed();
    }
    let (mut text, mut summaries, mut found) = (String::new(), Vec::new(), LookedOver::default());
    let machine = &control.machine;
    let mut headers = Vec::new();
    for (input, program) in programs {
        if let (true, Some(path), Ok(program)) = (arguments.skip_headers, input.path(), &program)
            && headers::is_header(path, program.text()?).is_ok_and(|is_header| is_header)
        {
            headers.push(program.name.clone());
            continue;
        }
        let ignored = &arguments.ignore;
        let linted = program.map_err(Failure::from).and_then(|program| {
            let (name, source) = (&program.name, Box::new(program.text()?));
            let mut linted = lint::look_over(&control, &finder, name, source, ignored)?;
            linted.predict(&control, name, Box::new(program.text()?), ignored)?;
            Ok((program.name, linted))
        });
        let (name, linted) = match linted {
            Ok(linted) => linted,
            // Another program may be read, but for a run that shall end.
            Err(failure) if session.go_on().is_err() => return Err(failure),
            Err(failure) => {
                let why = failure.findings();
                let name = input.path().map_or("-".into(), |path| path.to_string_lossy());
                summaries.push(LintSummary::unread(&name, &machine.name, &why));
                found.unread.extend(why);
                continue;
            }
        };
        if !text.is_empty() {
            text.push('\n');
        }
        text.push_str(&lint_text::text(machine, &name, &linted));
        summaries.push(LintSummary::new(&name, &machine.name, &linted));
        found.findings.extend(linted.findings);
    }
    if text.is_empty() && headers.is_empty() {
        // Of nothing that was looked over nothing is written.
        return Err(found.unread.into());
    }
    if !headers.is_empty() {
        text.push_str(&lint_text::left_out(&headers));
    }
    let mut texts = Vec::new();
    texts.extend(arguments.json.as_ref().map(|_| match summaries.as_slice() {
        [one] => files::json(one),
        all => files::json(&all),
    }));
    texts.extend(arguments.sarif.as_ref().map(|_| {
        let LookedOver { findings, unread } = &found;
        lint::sarif(findings, unread, env!("CARGO_PKG_VERSION"), &described)
    }));
    for (file, text) in written.iter_mut().zip(&texts) {
        file.write_bytes(text.as_bytes())?;
    }
    let printed = written.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, written)?;
    if !text.is_empty() {
        terminal::print_beside(session, &text, printed);
    }
    Ok(found)
}

/// What a code means here, and what helps.
fn described(name: &str) -> Option<CodeText> {
    let groups = codes();
    let of = |own: bool| {
        let groups = groups.iter().filter(move |group| !own || group.title == GROUP);
        groups.flat_map(|group| &group.codes).find(|code| code.name == name)
    };
    let code = of(true).or_else(|| of(false))?;
    Some(CodeText { meaning: code.meaning, remedy: code.remedy })
}

/// Refuses a code that no message has.
fn known(code: &str, said_by: &str) -> Result<(), Failure> {
    let all = codes();
    let mut names = all.iter().flat_map(|group| &group.codes).map(|code| code.name);
    if names.any(|name| name == code) {
        return Ok(());
    }
    let names = all.iter().flat_map(|group| &group.codes).map(|code| code.name);
    let help = match nearest(code, names) {
        Some(near) => format!("a similar code exists: {near}"),
        None => "`post explain` lists all codes".to_owned(),
    };
    let message = format!("no message has the code {code}, which {said_by} names");
    Err(Diagnostic::error("option", message).help(help).into())
}
