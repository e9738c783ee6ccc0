//! The main job: one CL file, one machine, one program.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use post_core::diagnostic::{Diagnostic, Severity};
use post_core::program::{Reading, Unknown};
use post_core::report::Report;
use post_core::{Job, Post};
use post_grammar::{ReadError, Reader, Units};
use post_plugin::DialectSession;

use crate::arguments::{Msys, PostArguments, UnitsArgument, UnknownArgument};
use crate::output::{self, Program};
use crate::progress::Progress;
use crate::{machines, plugins, render, summary};

/// Posts as the arguments say.
pub fn run(arguments: &PostArguments) -> Result<(), Vec<Diagnostic>> {
    let input_path = arguments.input.as_deref().unwrap_or(Path::new("-"));
    let machine = machines::load(arguments)?;
    let finder = plugins::finder(arguments)?;
    let program = program_name(input_path, arguments.output.as_deref());
    let (mut dialect, dialect_use) = plugins::dialect(&finder, &machine, &program)?;
    let (mut model, model_use) = plugins::model(&finder, &machine)?;
    let target = target(input_path, arguments, &dialect.format().extension)?;
    let input = Input::open(input_path)?;
    let mut file = Program::create(target.as_deref()).map_err(|error| {
        let place = target.as_deref().unwrap_or(Path::new("standard output"));
        one("output", format!("{}: {error}", place.display()))
    })?;
    let mut progress = Progress::new(input.length);
    let mut reader = Reader::new(input.bytes);
    let mut post = Post::new(
        &machine,
        job(arguments, &input.name),
        &mut dialect,
        &mut model,
        &mut file,
    )
    .map_err(|finding| vec![*finding])?;
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
    let (report, findings) = post.finish();
    let Some(mut report) = report else {
        return Err(findings);
    };
    report.plugins = vec![dialect_use, model_use];
    file.finish().map_err(|error| {
        let place = target.as_deref().unwrap_or(Path::new("standard output"));
        one("output", format!("{}: {error}", place.display()))
    })?;
    debug_assert!(
        findings
            .iter()
            .all(|finding| finding.severity == Severity::Warning)
    );
    render::findings(&findings);
    tell(arguments, &report, target.as_deref(), &input.name)
}

/// The summary, for people and for programs.
fn tell(
    arguments: &PostArguments,
    report: &Report,
    target: Option<&Path>,
    input: &str,
) -> Result<(), Vec<Diagnostic>> {
    if let Some(path) = &arguments.summary {
        let json = summary::json(report);
        output::write_whole(path, json.as_bytes())
            .map_err(|error| one("summary", format!("{}: {error}", path.display())))?;
    }
    if !arguments.quiet {
        summary::print(report, input, target);
    }
    Ok(())
}

/// Input and what is known of it.
struct Input {
    name: String,
    bytes: Box<dyn Read>,
    length: Option<u64>,
}

impl Input {
    fn open(path: &Path) -> Result<Self, Vec<Diagnostic>> {
        if path == Path::new("-") {
            return Ok(Self {
                name: "standard input".to_owned(),
                bytes: Box::new(io::stdin().lock()),
                length: None,
            });
        }
        let fault = |error: io::Error| one("input", format!("{}: {error}", path.display()));
        let file = File::open(path).map_err(fault)?;
        let metadata = file.metadata().map_err(fault)?;
        if metadata.is_dir() {
            return Err(one(
                "input",
                format!("{} is a folder, not a CL file", path.display()),
            ));
        }
        Ok(Self {
            name: path.display().to_string(),
            bytes: Box::new(file),
            length: metadata.is_file().then_some(metadata.len()),
        })
    }
}

fn job(arguments: &PostArguments, file: &str) -> Job {
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
        trust_model: arguments.trust_model,
    }
}

/// The program is called after its file, or after the CL file.
fn program_name(input: &Path, output: Option<&Path>) -> String {
    [output, Some(input)]
        .into_iter()
        .flatten()
        .filter(|path| *path != Path::new("-"))
        .find_map(Path::file_stem)
        .map_or_else(
            || "PROGRAM".to_owned(),
            |stem| stem.to_string_lossy().into_owned(),
        )
}

/// Where the program goes; none is standard output.
fn target(
    input: &Path,
    arguments: &PostArguments,
    extension: &str,
) -> Result<Option<PathBuf>, Vec<Diagnostic>> {
    let standard = Path::new("-");
    let target = match &arguments.output {
        Some(path) if path == standard => return Ok(None),
        Some(path) => path.clone(),
        None if input == standard => return Ok(None),
        None => input.with_extension(extension),
    };
    let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    };
    if same(&target, input) {
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
    if target.is_dir() {
        return Err(one("output", format!("{} is a folder", target.display())));
    }
    Ok(Some(target))
}

fn one(code: &'static str, message: String) -> Vec<Diagnostic> {
    vec![Diagnostic::error(code, message)]
}
