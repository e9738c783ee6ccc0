//! The verb that has no name: one CL file on one machine becomes one program.

mod summary;

use std::path::Path;

use clap::Args;
use post_machine::diagnostic::{Diagnostic, Severity};
use post_plugin::DialectSession;
use post_posting::{Job, Post};

use crate::arguments::JobArguments;
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClInput, FileFault, PathArg};
use crate::job::{self, plugin_finder};
use crate::terminal;

#[derive(Debug, Args)]
pub struct PostArguments {
    #[command(flatten)]
    job: JobArguments,

    /// The NC program, `-` for standard output. [default: beside the CL file, with the dialect's ending]
    #[arg(short, long, value_name = "FILE", value_parser = PathArg::parser())]
    output: Option<PathArg>,

    /// Writes the summary as JSON for programs to read; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = PathArg::parser())]
    summary: Option<PathArg>,

    /// No summary, warnings and errors alone.
    #[arg(short, long)]
    quiet: bool,

    /// Takes the error model's word where the certificate finds more, and only reports it. (The placement `fewest` asks
    /// no model.)
    #[arg(long, help_heading = "Plugins")]
    trust_model: bool,
}

/// Posts as the arguments say.
pub fn run(arguments: &PostArguments) -> Result<(), Failure> {
    let source = arguments.job.input();
    let machine = job::machine(&arguments.job, &[])?;
    job::say_what_is_left(&arguments.job);
    let finder = plugin_finder::finder(&arguments.job.plugins)?;
    let program = job::program_name(source, arguments.output.as_ref());
    let (mut dialect, dialect_use) =
        plugin_finder::dialect(&finder, &machine, &program, Some(source))?;
    let (mut model, model_use) = plugin_finder::model(&finder, &machine)?;
    let target = program_target(arguments, &dialect.format().extension)?;
    let summary = summary_file(arguments, &target)?;
    let input = ClInput::open(source)?;
    let mut file = AtomicFile::create(&target)?;
    let name = input.name.clone();
    let job = Job {
        trust_model: arguments.trust_model,
        ..job::posting(&arguments.job, &name)
    };
    let mut post = Post::new(&machine, job, &mut dialect, &mut model, &mut file)
        .map_err(|finding| *finding)?;
    job::read(input, &mut post)?;
    let (report, findings) = post.finish();
    let Some(mut report) = report else {
        return Err(findings.into());
    };
    report.plugins = vec![dialect_use, model_use];
    file.finish()?;
    debug_assert!(
        findings
            .iter()
            .all(|finding| finding.severity == Severity::Warning)
    );
    terminal::findings(&findings);
    if let Some(mut summary) = summary {
        summary.write_bytes(files::json(&report).as_bytes())?;
        summary.finish()?;
    }
    if !arguments.quiet {
        let text = summary::text(&report, &name, &target);
        // Standard output is for a program or for JSON, alone there.
        if [Some(&target), arguments.summary.as_ref()].contains(&Some(&PathArg::Standard)) {
            terminal::tell(&text);
        } else {
            terminal::print(&text);
        }
    }
    Ok(())
}

/// Where the program goes.
fn program_target(arguments: &PostArguments, extension: &str) -> Result<PathArg, Failure> {
    let source = arguments.job.input().path();
    let target = match (&arguments.output, source) {
        (Some(target), _) => target.clone(),
        (None, Some(source)) => source.with_extension(extension).into(),
        (None, None) => PathArg::Standard,
    };
    if let Some(source) = source
        && files::would_replace(&target, source)
    {
        return Err(Diagnostic::error(
            "output",
            format!(
                "the program would overwrite the CL file {}",
                source.display()
            ),
        )
        .help("name another file with -o")
        .into());
    }
    match target.path() {
        Some(path) if path.is_dir() => Err(FileFault::WriteFolder(path.to_owned()).into()),
        _ => Ok(target),
    }
}

/// The summary's file, opened before the work begins: a program without its summary would be half a result.
fn summary_file(
    arguments: &PostArguments,
    program: &PathArg,
) -> Result<Option<AtomicFile>, Failure> {
    let Some(target) = &arguments.summary else {
        return Ok(None);
    };
    let replaces =
        |other: Option<&Path>| other.is_some_and(|other| files::would_replace(target, other));
    if target != program && !replaces(arguments.job.input().path()) && !replaces(program.path()) {
        return Ok(Some(AtomicFile::create(target)?));
    }
    let message = match target.path() {
        None => "program and summary cannot both go to standard output".to_owned(),
        Some(path) => format!("the summary would overwrite {}", path.display()),
    };
    let finding = Diagnostic::error("output", message);
    Err(finding.help("name another file with --summary").into())
}
