//! One pass of a CL file over a machine. Programs that are written, first passes, dry runs and what an editor shows are
//! passes of this kind: plugins are opened, and posting begins, here alone.

use std::num::NonZeroUsize;
use std::sync::Arc;
use std::thread;

use post_grammar::{ClPiece, ClReader, GotoRun};
use post_host::{Finder, OpenedDialect, OpenedModel};
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_plugin::{DialectSession, ModelSession};
use post_posting::plan::PlanWatch;
use post_posting::preview::{self, FilePreview, PreviewPass};
use post_posting::program::{DefaultSpindle, ReadingOptions};
use post_posting::report::{PluginUse, PostingReport};
use post_posting::{Observer, PathShift, Post, PostingRequest, ProgramPreview, TextSink};

use super::clearance::{ChoiceBodies, without_stock};
use super::plugin_finder;
use crate::failure::Failure;
use crate::files::{ClInput, ClPieces, ClSource, FileFault, NullSink, PathArg, ReadAhead};
use crate::session::Session;
use crate::settings::{JobSettings, Msys};

/// What a dialect is told of the program that it is opened for.
#[derive(Clone, Copy)]
pub struct ProgramHead<'a> {
    /// What the program is called.
    pub name: &'a str,
    /// The CL file that it is made from; none: the axes move one by one, for no part.
    pub cl_file: Option<&'a PathArg>,
    /// What a first pass over the CL file found.
    pub preview: Option<&'a ProgramPreview>,
}

/// The plugins of a machine, opened for one program.
pub struct OpenedPlugins {
    /// Writes the program.
    pub dialect: OpenedDialect,
    /// Foresees deviations.
    pub model: OpenedModel,
    /// What the summary says of dialect and model.
    pub uses: [PluginUse; 2],
}

impl OpenedPlugins {
    /// Opens them.
    ///
    /// # Errors
    /// Why the dialect, or else the model, cannot be opened.
    pub fn open(
        finder: &Finder,
        machine: &Machine,
        head: ProgramHead<'_>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let ProgramHead { name, cl_file, preview } = head;
        let (dialect, dialect_use) =
            plugin_finder::dialect_knowing(finder, machine, name, cl_file, preview)?;
        let (model, model_use) = plugin_finder::model(finder, machine)?;
        Ok(Self { dialect, model, uses: [dialect_use, model_use] })
    }
}

/// Who takes part while a program is written.
#[derive(Default)]
pub struct PostingExtras<'s, 'w, 'o> {
    /// Moves the points of its path.
    pub shift: Option<&'s mut dyn PathShift>,
    /// Sees its plan.
    pub watch: Option<&'w mut dyn PlanWatch>,
    /// Sees its blocks.
    pub observer: Option<&'o mut dyn Observer>,
}

/// A pass that is ready to begin.
pub struct PostingPass<'a> {
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// How the CL file is read and what is asked for.
    pub request: PostingRequest,
    /// Threads that it is made on at most.
    pub threads: NonZeroUsize,
    /// Writes the program.
    pub dialect: &'a mut dyn DialectSession,
    /// Foresees deviations.
    pub model: &'a mut dyn ModelSession,
    /// Solutions are chosen with which bodies stay clear, whatever the machine file says.
    pub keeps_clear: bool,
}

impl PostingPass<'_> {
    /// Posts `input` and writes the program to `sink`: its report, if all is good, and every finding.
    ///
    /// # Errors
    /// What machine and dialect cannot do together, or a file that cannot be read.
    pub fn write(
        self,
        session: &Session,
        input: ClInput,
        sink: &mut dyn TextSink,
        beside: PostingExtras<'_, '_, '_>,
    ) -> Result<(Option<PostingReport>, Vec<Diagnostic>), Failure> {
        let Self { machine, request, threads, dialect, model, keeps_clear } = self;
        let opened = machine.with_part_anywhere();
        let machine = opened.as_ref().unwrap_or(machine);
        let mut told = Vec::new();
        let shortens = machine.clearance.shortens_ways();
        let chooses = keeps_clear || machine.clearance.choose || shortens;
        let mut bodies = match chooses {
            true => Some(ChoiceBodies::of(machine, &mut told)?),
            false => None,
        };
        if let Some(finding) = without_stock(machine) {
            return Err(finding.into());
        }
        let mut between = bodies.as_ref().filter(|_| shortens).map(ChoiceBodies::coarse);
        // Blocks are shown with the lines that they end on: whoever looks on waits for the text of each batch.
        let beside_text = threads > NonZeroUsize::MIN && beside.observer.is_none();
        let post = Post::new(machine, request, dialect, model, sink);
        let mut post = post.map_err(|finding| *finding)?;
        if let Some(bodies) = &mut bodies {
            post.keep_clear(bodies);
        }
        if let Some(bodies) = &mut between {
            post.go_across(bodies);
        }
        if let Some(shift) = beside.shift {
            post.shift(shift);
        }
        if let Some(watch) = beside.watch {
            post.watch_plan(watch);
        }
        if let Some(observer) = beside.observer {
            post.watch(observer);
        }
        if !beside_text {
            read(session, ClPieces::new(input, None), &mut post)?;
            return Ok(finished(post, told));
        }
        let ahead = ReadAhead::default();
        let pieces = ClPieces::new(input, Some(&ahead));
        let read_some = || ahead.read_some();
        thread::scope(|scope| {
            post.write_beside(scope, &read_some);
            read(session, pieces, &mut post)?;
            Ok(finished(post, told))
        })
    }

    /// Posts `input` and throws the text away, the texts of the machine file left out: what they ask for may not be known,
    /// and nobody reads them.
    ///
    /// # Errors
    /// As [`Self::write`].
    pub fn run_dry(
        self,
        session: &Session,
        input: ClInput,
        observer: Option<&mut dyn Observer>,
    ) -> Result<(Option<PostingReport>, Vec<Diagnostic>), Failure> {
        let Self { machine, request, threads, dialect, model, keeps_clear } = self;
        let machine = &machine.without_text();
        let beside = PostingExtras { observer, ..PostingExtras::default() };
        let pass = PostingPass { machine, request, threads, dialect, model, keeps_clear };
        pass.write(session, input, &mut NullSink, beside)
    }

    /// Says what posting would refuse before its first record.
    ///
    /// # Errors
    /// What machine and dialect cannot do together.
    pub fn check(self) -> Result<(), Failure> {
        let Self { machine, request, dialect, model, .. } = self;
        match Post::new(machine, request, dialect, model, &mut NullSink) {
            Ok(_) => Ok(()),
            Err(finding) => Err((*finding).into()),
        }
    }
}

/// The end of a pass, behind the findings `told`: a dialect that wrote nothing has made no program.
fn finished(post: Post<'_>, mut told: Vec<Diagnostic>) -> (Option<PostingReport>, Vec<Diagnostic>) {
    let (mut report, found) = post.finish();
    told.extend(found);
    if let Some(PostingReport { dialect, moves, nc_lines: 0, .. }) = &report {
        let message = format!("the dialect {dialect} wrote no line of a program of {moves} moves");
        told.push(Diagnostic::error("plugin", message));
        report = None;
    }
    (report, told)
}

/// Refuses a machine that posting would refuse before its first record: plugins that cannot be opened, options that they
/// do not take, and what machine and dialect cannot do together.
pub fn try_opening(machine: &Machine, finder: &Finder, length: f64) -> Result<(), Failure> {
    let head = ProgramHead { name: "CHECK", cl_file: None, preview: None };
    let mut opened = match OpenedPlugins::open(finder, machine, head) {
        Ok(opened) => opened,
        Err(_) => {
            // Here all that is wrong is of interest, with the one plugin and with the other.
            let faults = [
                plugin_finder::dialect(finder, machine, head.name, None).err(),
                plugin_finder::model(finder, machine).err(),
            ];
            return Err(faults.into_iter().flatten().flatten().collect::<Vec<_>>().into());
        }
    };
    let request = PostingRequest { tool_length: Some(length), ..PostingRequest::default() };
    let (dialect, model) = (&mut opened.dialect, &mut opened.model);
    let (threads, keeps_clear) = (NonZeroUsize::MIN, false);
    PostingPass { machine, request, threads, dialect, model, keeps_clear }.check()
}

/// How the CL file is posted.
pub fn posting_request(arguments: &JobSettings, input: &ClInput) -> PostingRequest {
    PostingRequest {
        reading: ReadingOptions {
            file: input.name.clone(),
            further: Arc::clone(&input.further),
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

/// [`posting_request`] for a dialect: where its control has no word for a spindle, cuts ask for none.
pub fn posting_request_to(
    arguments: &JobSettings,
    input: &ClInput,
    dialect: &mut OpenedDialect,
) -> PostingRequest {
    let mut request = posting_request(arguments, input);
    if request.reading.spindle == DefaultSpindle::Unknown && !plugin_finder::has_spindle(dialect) {
        request.reading.spindle = DefaultSpindle::Still;
    }
    request
}

/// What a first pass over the CL file finds out where the program depends on it.
pub fn file_preview(
    arguments: &JobSettings,
    source: &mut ClSource,
    machine: &Machine,
    dialect: &impl DialectSession,
) -> Result<Option<Arc<FilePreview>>, Failure> {
    if !preview::is_wanted(machine, dialect.capabilities()) {
        return Ok(None);
    }
    let input = source.open()?;
    let reading = posting_request(arguments, &input).reading;
    Ok(Some(first_pass(input, machine, reading)?))
}

/// The first pass over a CL file.
///
/// # Errors
/// It cannot be read. What is wrong with its records is said when its program is made.
pub fn first_pass(
    input: ClInput,
    machine: &Machine,
    reading: ReadingOptions,
) -> Result<Arc<FilePreview>, FileFault> {
    let mut pass = PreviewPass::new(machine, reading);
    let mut reader = ClReader::new(input.bytes);
    let mut run = GotoRun::default();
    loop {
        if pass.passes_gotos() {
            reader.skip_gotos();
        }
        match reader.next_piece(&mut run) {
            ClPiece::Gotos(text) => pass.gotos(&run, text),
            ClPiece::Record(record) => pass.record(&record),
            ClPiece::Unreadable(_) => {}
            ClPiece::End => return Ok(Arc::new(pass.finish())),
            ClPiece::Failed(error) => return Err(FileFault::Read { name: input.name, error }),
        }
    }
}

/// Takes a CL file to its end, or until there are so many faults that it is given up.
fn read(session: &Session, mut pieces: ClPieces<'_>, post: &mut Post<'_>) -> Result<(), FileFault> {
    let mut progress = session.progress(pieces.length);
    let mut run = GotoRun::default();
    while !post.gave_up() {
        let mut records = 1;
        match pieces.next(&mut run) {
            ClPiece::Gotos(text) => {
                post.gotos(&run, text);
                records = run.count() as u64;
            }
            ClPiece::Record(record) => post.record(&record),
            ClPiece::Unreadable(fault) => post.unreadable(&fault),
            ClPiece::Failed(error) => {
                return Err(FileFault::Read { name: pieces.name, error });
            }
            ClPiece::End => {
                post.ended(!pieces.ends_within_a_line());
                break;
            }
        }
        progress.some_records(records, || pieces.position());
    }
    progress.finish();
    Ok(())
}
