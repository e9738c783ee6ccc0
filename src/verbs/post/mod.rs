//! The main job: one CL file, one machine, one program.

mod summary;

use std::io;
use std::path::{Path, PathBuf};

use post_grammar::{ReadError, Reader, Units};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_plugin::DialectSession;
use post_posting::program::{Reading, Unknown};
use post_posting::{Job, Output, Post};

use crate::arguments::flag_values::UnitsArgument;
use crate::arguments::{JobArguments, Msys, PostArguments, UnknownArgument};
use crate::files::atomic_file::{Target, Whole};
use crate::files::cl_input::{Input, one, standard};
use crate::job::plugin_finder as plugins;
use crate::terminal::findings as render;
use crate::terminal::progress::Progress;

/// Posts as the arguments say.
pub fn run(arguments: &PostArguments) -> Result<(), Vec<Diagnostic>> {
    let input_path = arguments.job.input();
    let machine = arguments.job.machine(&[])?;
    let finder = plugins::finder(&arguments.job.plugins)?;
    let program = program_name(input_path, arguments.output.as_deref());
    let (mut dialect, dialect_use) = plugins::dialect(&finder, &machine, &program)?;
    let (mut model, model_use) = plugins::model(&finder, &machine)?;
    let path = target(input_path, arguments, &dialect.format().extension)?;
    let summary_file = summary_file(input_path, arguments, &path)?;
    let input = Input::open(input_path)?;
    let mut file = create(&path)?;
    let name = input.name.clone();
    let job = Job {
        trust_model: arguments.trust_model,
        ..job(&arguments.job, &name)
    };
    let mut post = Post::new(&machine, job, &mut dialect, &mut model, &mut file)
        .map_err(|finding| vec![*finding])?;
    read(input, &mut post)?;
    let (report, findings) = post.finish();
    let Some(mut report) = report else {
        return Err(findings);
    };
    report.plugins = vec![dialect_use, model_use];
    file.finish().map_err(|error| fault_at(&path, &error))?;
    debug_assert!(
        findings
            .iter()
            .all(|finding| finding.severity == Severity::Warning)
    );
    render::findings(&findings);
    if let Some((mut file, path)) = summary_file {
        let json = summary::json(&report);
        file.write(json.as_bytes())
            .map_err(io::Error::other)
            .and_then(|()| file.finish())
            .map_err(|error| fault_at(&path, &error))?;
    }
    if !arguments.quiet {
        let to_stderr =
            [Some(path.as_path()), arguments.summary.as_deref()].contains(&Some(standard()));
        summary::print(&report, &name, &path, to_stderr);
    }
    Ok(())
}

/// Reads a CL file to its end, or until there are so many faults that it is given up.
pub fn read(input: Input, post: &mut Post<'_>) -> Result<(), Vec<Diagnostic>> {
    let mut progress = Progress::new(input.length);
    let mut reader = Reader::new(input.bytes);
    while !post.gave_up() {
        match reader.next_record() {
            Ok(Some(record)) => post.record(&record),
            Ok(None) => break,
            Err(ReadError::Syntax(fault)) => post.unreadable(&fault),
            Err(ReadError::Io(error)) => {
                return Err(one("input", format!("{}: {error}", input.name)));
            }
        }
        progress.record(|| reader.bytes_read());
    }
    progress.finish();
    Ok(())
}

pub fn create(path: &Path) -> Result<Whole, Vec<Diagnostic>> {
    Whole::create(Target::of(path)).map_err(|error| fault_at(path, &error))
}

pub fn fault_at(path: &Path, error: &io::Error) -> Vec<Diagnostic> {
    if path == standard() {
        return one("output", format!("standard output: {error}"));
    }
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => one(
            "output",
            format!(
                "{}: there is no folder {}",
                path.display(),
                folder.display()
            ),
        ),
        _ => one("output", format!("{}: {error}", path.display())),
    }
}

/// The summary's file, opened before the work begins: a program without its summary would be half a result.
fn summary_file(
    input: &Path,
    arguments: &PostArguments,
    program: &Path,
) -> Result<Option<(Whole, PathBuf)>, Vec<Diagnostic>> {
    let Some(path) = &arguments.summary else {
        return Ok(None);
    };
    let target = Target::of(path);
    if target.is(input) || target.is(program) || path == program {
        return Err(vec![
            Diagnostic::error(
                "output",
                if path == standard() {
                    "program and summary cannot both go to standard output".to_owned()
                } else {
                    format!("the summary would overwrite {}", path.display())
                },
            )
            .help("name another file with --summary"),
        ]);
    }
    Ok(Some((create(path)?, path.clone())))
}

/// How a CL file is posted.
pub fn job(arguments: &JobArguments, file: &str) -> Job {
    Job {
        reading: Reading {
            file: file.to_owned(),
            units: arguments.units.map(|units| match units {
                UnitsArgument::Mm => Units::Millimetre,
                UnitsArgument::Inch => Units::Inch,
            }),
            tool: arguments.tool,
            apply_msys: arguments.msys == Msys::Apply,
            unknown: match arguments.unknown {
                UnknownArgument::Error => Unknown::Error,
                UnknownArgument::Warn => Unknown::Warn,
                UnknownArgument::Pass => Unknown::Pass,
            },
            ..Reading::default()
        },
        tool_length: arguments.tool_length,
        trust_model: false,
    }
}

/// The program is called after its file, or after the CL file.
pub fn program_name(input: &Path, output: Option<&Path>) -> String {
    [output, Some(input)]
        .into_iter()
        .flatten()
        .filter(|path| *path != standard())
        .find_map(Path::file_stem)
        .map_or_else(
            || "PROGRAM".to_owned(),
            |stem| stem.to_string_lossy().into_owned(),
        )
}

/// Where the program goes; `-` is standard output.
fn target(
    input: &Path,
    arguments: &PostArguments,
    extension: &str,
) -> Result<PathBuf, Vec<Diagnostic>> {
    let path = match &arguments.output {
        Some(path) => path.clone(),
        None if input == standard() => return Ok(standard().to_owned()),
        None => input.with_extension(extension),
    };
    if Target::of(&path).is(input) {
        return Err(vec![
            Diagnostic::error(
                "output",
                format!(
                    "the program would overwrite the CL file {}",
                    input.display()
                ),
            )
            .help("name another file with -o"),
        ]);
    }
    if path.is_dir() {
        return Err(one("output", format!("{} is a folder", path.display())));
    }
    Ok(path)
}
