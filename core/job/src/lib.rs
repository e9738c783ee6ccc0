//! A job as the flags mean it: a CL file, a machine with its settings, and the plugins that the machine asks for.

pub mod axes;
pub mod batch;
pub mod columns;
pub mod compensate;
mod dry_run;
pub mod failure;
pub mod files;
pub mod library;
mod look_ahead;
pub mod machine_files;
pub mod machine_schema;
pub mod making;
pub mod nc_program;
pub mod nc_to_cl;
pub mod one_program;
pub mod other_dialect;
pub mod plan;
pub mod plan_rounds;
mod plan_worth;
pub mod plugin_finder;
mod plugin_folders;
pub mod posted;
pub mod predict;
pub mod read_back;
pub mod report;
mod rounds;
pub mod session;
pub mod settings;
pub mod summary;
pub mod text;
pub mod unused_options;

use std::path::Path;
use std::sync::Arc;

use post_grammar::text::as_remark;
use post_grammar::{ClReader, ReadError};
use post_host::Finder;
use post_machine::check::Check;
use post_machine::description::{Machine, Setting};
use post_plugin::{Capabilities, DialectSession};
use post_posting::preview::{FilePreview, PreviewPass};
use post_posting::program::ReadingOptions;
use post_posting::{Post, PostingRequest};

use crate::failure::Failure;
use crate::files::{ClInput, ClSource, FileFault, NullSink, PathArg};
use crate::session::Session;
use crate::settings::JobSettings;
use crate::settings::Msys;
pub use dry_run::DryRun;
pub use look_ahead::look_ahead;

/// The machine with all settings of the command line, and `more` after them.
pub fn machine(
    session: &Session,
    arguments: &JobSettings,
    more: &[Setting],
) -> Result<Machine, Failure> {
    let mut settings = arguments.over.settings();
    settings.extend_from_slice(more);
    machine_files::load(session, &arguments.machine, &arguments.over.machines, &settings)
}

/// Says once what of the machine file has no effect: what `--dialect` leaves behind, and options that no plugin takes.
pub fn say_what_is_left(
    session: &Session,
    arguments: &JobSettings,
    machine: &Machine,
    finder: &Finder,
) {
    unused_options::warn(session, machine, finder);
    other_dialect::say_what_is_left(
        session,
        arguments.over.dialect.as_deref(),
        &arguments.machine,
        &arguments.over.machines,
        &arguments.over.settings(),
    );
}

/// Where a machine or a plugin comes from: its file, or the command itself.
pub fn origin(path: Option<&Path>) -> String {
    path.map_or_else(|| "built in".to_owned(), |path| path.display().to_string())
}

/// What can be derived from a machine with a tool of `length` mm. A chain that cannot be solved is mostly refused as
/// its file is loaded.
pub fn derive(machine: &Machine, length: f64) -> Result<Check, Failure> {
    Check::of(machine, length).map_err(|lack| machine.unsolvable(&lack).into())
}

/// Refuses a machine that posting would refuse before its first record: plugins that cannot be opened, options that they
/// do not take, and what machine and dialect cannot do together.
pub fn try_opening(machine: &Machine, finder: &Finder, length: f64) -> Result<(), Failure> {
    let (mut dialect, mut model) = match (
        plugin_finder::dialect(finder, machine, "CHECK", None),
        plugin_finder::model(finder, machine),
    ) {
        (Ok((dialect, _)), Ok((model, _))) => (dialect, model),
        (dialect, model) => {
            let faults = [dialect.err(), model.err()];
            return Err(faults.into_iter().flatten().flatten().collect::<Vec<_>>().into());
        }
    };
    let job = PostingRequest { tool_length: Some(length), ..PostingRequest::default() };
    match Post::new(machine, job, &mut dialect, &mut model, &mut NullSink) {
        Ok(_) => Ok(()),
        Err(finding) => Err((*finding).into()),
    }
}

/// How the CL file that is called `file` in messages is posted.
pub fn posting(arguments: &JobSettings, file: &str) -> PostingRequest {
    PostingRequest {
        reading: ReadingOptions {
            file: file.to_owned(),
            units: arguments.reading.units,
            tool: arguments.reading.tool,
            apply_msys: arguments.reading.msys == Msys::Apply,
            unknown: arguments.reading.unknown,
            spindle: arguments.reading.spindle.unwrap_or_default(),
            feed: arguments.reading.feed,
            tool_from_cutter: arguments.reading.tool_from_cutter,
            allowed: arguments.reading.allow.clone(),
            ..ReadingOptions::default()
        },
        tool_length: arguments.over.tool_length,
        ..PostingRequest::default()
    }
}

/// What a first pass over the CL file finds out where the program depends on it: `[control] planes`, and a dialect that
/// writes them.
pub fn ahead(
    arguments: &JobSettings,
    source: &mut ClSource,
    machine: &Machine,
    dialect: &impl DialectSession,
) -> Result<Option<Arc<FilePreview>>, Failure> {
    if !machine.control.planes || !dialect.capabilities().has(Capabilities::PLANE) {
        return Ok(None);
    }
    let input = source.open()?;
    let reading = posting(arguments, &input.name).reading;
    let mut pass = PreviewPass::new(machine, reading);
    let mut reader = ClReader::new(input.bytes);
    loop {
        match reader.next_record() {
            Ok(Some(record)) => pass.record(&record),
            Ok(None) => return Ok(Some(Arc::new(pass.finish()))),
            // The program is not made then, and says why.
            Err(ReadError::Syntax(_)) => {}
            Err(ReadError::Io(error)) => {
                return Err(FileFault::Read { name: input.name, error }.into());
            }
        }
    }
}

/// The program is called after its file, or after the CL file.
pub fn program_name(source: &PathArg, target: Option<&PathArg>) -> String {
    target
        .and_then(PathArg::stem)
        .or_else(|| source.stem())
        .map_or_else(|| "PROGRAM".to_owned(), as_remark)
}

/// Reads a CL file to its end, or until there are so many faults that it is given up.
pub fn read(session: &Session, input: ClInput, post: &mut Post<'_>) -> Result<(), FileFault> {
    let mut progress = session.progress(input.length);
    let mut reader = ClReader::new(input.bytes);
    while !post.gave_up() {
        match reader.next_record() {
            Ok(Some(record)) => post.record(&record),
            Ok(None) => {
                post.ended(!reader.ends_within_a_line());
                break;
            }
            Err(ReadError::Syntax(fault)) => post.unreadable(&fault),
            Err(ReadError::Io(error)) => {
                return Err(FileFault::Read { name: input.name, error });
            }
        }
        progress.record(|| reader.bytes_read());
    }
    progress.finish();
    Ok(())
}
