//! The verb that has no name: one CL file on one machine becomes one program.

mod summary;

use clap::Args;
use post_machine::diagnostic::Severity;
use post_plugin::DialectSession;
use post_posting::{Job, Post};

use crate::arguments::JobArguments;
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClInput, PathArg, Role};
use crate::job::{self, plugin_finder};
use crate::terminal;

const SUMMARY: Role = Role {
    what: "summary",
    remedy: "name another file with --summary",
};

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
    let finder = plugin_finder::finder(&arguments.job.plugins)?;
    job::say_what_is_left(&arguments.job, &machine, &finder);
    let program = job::program_name(source, arguments.output.as_ref());
    let (mut dialect, dialect_use) =
        plugin_finder::dialect(&finder, &machine, &program, Some(source))?;
    let (mut model, model_use) = plugin_finder::model(&finder, &machine)?;
    let target = program_target(arguments, &dialect.format().extension);
    let input = ClInput::open(source)?;
    let mut targets = vec![(Role::PROGRAM, &target)];
    targets.extend(arguments.summary.iter().map(|summary| (SUMMARY, summary)));
    // Both are opened before the work begins: a program without its summary would be half a result.
    let mut files = AtomicFile::create(&targets)?;
    let name = input.name.clone();
    let posting = job::posting(&arguments.job, &name);
    let job = Job {
        trust_model: arguments.trust_model,
        ahead: job::ahead(source, &machine, &dialect, &posting)?,
        ..posting
    };
    let mut post = Post::new(&machine, job, &mut dialect, &mut model, &mut files[0])
        .map_err(|finding| *finding)?;
    job::read(input, &mut post)?;
    let (report, findings) = post.finish();
    let Some(mut report) = report else {
        return Err(findings.into());
    };
    report.plugins = vec![dialect_use, model_use];
    if let Some(summary) = files.get_mut(1) {
        summary.write_bytes(files::json(&report).as_bytes())?;
    }
    // Standard output is for a program or for JSON, alone there.
    let taken = files.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(files)?;
    debug_assert!(
        findings
            .iter()
            .all(|finding| finding.severity == Severity::Warning)
    );
    terminal::findings(&findings);
    if !arguments.quiet {
        let text = summary::text(&report, &name, &target);
        if taken {
            terminal::tell(&text);
        } else {
            terminal::print(&text);
        }
    }
    Ok(())
}

/// Where the program goes.
fn program_target(arguments: &PostArguments, extension: &str) -> PathArg {
    let beside = || {
        let source = arguments.job.input();
        source.map(|path| path.with_extension(extension))
    };
    arguments.output.clone().unwrap_or_else(beside)
}
