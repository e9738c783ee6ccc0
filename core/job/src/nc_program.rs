//! An NC program that is read back: the machine that runs it, the words of its control, and what stands in its tables.

use std::io::{self, Read, Seek, SeekFrom};

use post_host::Finder;
use post_machine::description::{Machine, Rapid};
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_plugin::{Capabilities, DialectSession as _, Language, VocabularyWord};
use post_readback::interpret::{Interpreter, Limits, ReadReport};
use post_readback::lexicon::Lexicon;
use post_readback::{FedRapids, MOST_FAULTS, Offsets, ProgramRun, turns_the_spindle};

use super::{machine_files, other_language, plugin_finder, unused_options};
use crate::disk::{self, File};
use crate::failure::Failure;
use crate::files::{FileFault, PathArg};
use crate::session::{Session, Stoppable};
use crate::settings::ProgramSettings;

/// A text that can be gone back in.
pub trait Reread: Read + Seek + Send {}

impl<T: Read + Seek + Send> Reread for T {}

/// A text that can be gone back in, whatever it is read from.
pub type ProgramText<'i> = Box<dyn Reread + 'i>;

/// A program while it runs: what it is read from is no part of the type, so that there is one interpreter in the binary.
pub type RunningProgram<'i> = Interpreter<ProgramText<'i>>;

/// What a program is called among the files of a run.
const WHAT: &str = "the NC program";

/// Longest file of offsets that is read, bytes.
const MOST_OFFSETS: u64 = 1 << 20;

/// A control that runs NC programs of a machine.
#[derive(Debug)]
pub struct NcControl {
    /// The machine, as its file says.
    pub machine: Machine,
    /// What its dialect tells of them.
    pub spoken: DialectVocabulary,
    /// Its words.
    pub lexicon: Lexicon,
    /// What stands in its tables.
    pub offsets: Offsets,
    /// Lines of the CL file that go into programs letter for letter.
    pub own_lines: Vec<String>,
    limits: Limits,
}

impl NcControl {
    /// That of a machine, with `offsets` in its tables; `limits` say how far a program may go.
    pub fn of(
        machine: &Machine,
        spoken: DialectVocabulary,
        offsets: Offsets,
        limits: Limits,
    ) -> Self {
        let lexicon = Lexicon::new(spoken.language, spoken.writes, &spoken.words);
        Self { machine: machine.clone(), spoken, lexicon, offsets, own_lines: Vec::new(), limits }
    }

    /// As the flags say.
    pub fn new(session: &Session, arguments: &ProgramSettings) -> Result<Self, Failure> {
        let machine = machine_files::load(
            session,
            &arguments.machine,
            &arguments.machines,
            &arguments.settings(),
        )?;
        let finder = plugin_finder::finder(session, &arguments.plugins)?;
        unused_options::warn(session, &machine, &finder);
        let mut offsets = match &arguments.offsets {
            Some(file) => offsets(session, file, &machine)?,
            None => Offsets::default(),
        };
        offsets.length = arguments.tool_length;
        let spoken = spoken(&finder, &machine)?;
        let limits = Limits { blocks: arguments.most_blocks, ..Limits::default() };
        Ok(Self::of(&machine, spoken, offsets, limits))
    }

    /// The program in `input`, which messages call `name`, from where it stands.
    ///
    /// # Errors
    /// The machine cannot be solved.
    pub fn run<'i>(
        &self,
        name: &str,
        input: impl Read + Seek + Send + 'i,
    ) -> Result<ProgramRun<RunningProgram<'i>>, Box<Diagnostic>> {
        self.program(name, input).map(ProgramRun::new)
    }

    fn program<'i>(
        &self,
        name: &str,
        input: impl Read + Seek + Send + 'i,
    ) -> Result<RunningProgram<'i>, Box<Diagnostic>> {
        let Self { machine, lexicon, offsets, own_lines, limits, .. } = self;
        let mut input = input;
        other_language::refuse(&self.machine, self.spoken.language, name, &mut input)?;
        let input: ProgramText<'i> = Box::new(input);
        let program = Interpreter::new(machine, lexicon, offsets, *limits, name, input)?;
        Ok(program.declaring(own_lines.iter().map(String::as_str)))
    }

    /// The program in `input`, which messages call `name`, from its beginning, its rapids at feed told from cuts.
    ///
    /// # Errors
    /// It cannot be read again, or the machine not be solved.
    pub fn program_with_rapids<'i>(
        &self,
        name: &str,
        mut input: ProgramText<'i>,
    ) -> Result<FedRapids<RunningProgram<'i>>, Failure> {
        let Some(kept) = fed_rapids(&self.machine, self.spoken.rapids_pass()) else {
            return Ok(FedRapids::none(self.program(name, input).map_err(|fault| *fault)?));
        };
        let turns = turns_the_spindle(&mut self.program(name, &mut input).map_err(|fault| *fault)?);
        let again = input.rewind();
        again.map_err(|error| FileFault::Read { name: name.to_owned(), error })?;
        let program = self.program(name, input).map_err(|fault| *fault)?;
        Ok(FedRapids::new(program, &self.machine, kept, turns))
    }
}

/// What is told behind the faults of a program that was given up.
pub fn given_up() -> Diagnostic {
    let message = format!("{MOST_FAULTS} blocks were refused; the rest of the program is not read");
    Diagnostic::error("nc-refused", message)
}

/// Words of the program `name` that are not known, and stand in no line of the file of its `machine`: warnings.
pub fn unknown_words(
    name: &str,
    report: &ReadReport,
    machine: &Machine,
) -> impl Iterator<Item = Diagnostic> {
    let declared = machine.declared_lines();
    let unknown = report.unknown.iter().filter(move |(word, ..)| !declared.has_word(word));
    unknown.take(MOST_FAULTS).map(move |(word, count, line)| {
        let message = format!("{word} is not known and is taken to move nothing; {count} times");
        let place = SourcePlace::new(name, *line, "", 0..0);
        Diagnostic::warning("nc-unknown", message).at(Some(place))
    })
}

/// What a dialect tells of the programs that its control reads.
#[derive(Debug)]
pub struct DialectVocabulary {
    /// The words.
    pub words: Vec<VocabularyWord>,
    /// The language that they belong to.
    pub language: Language,
    /// What the dialect declares to write.
    pub writes: Capabilities,
    /// Largest F by time, 1/min.
    pub most_inverse_time: Option<f64>,
    /// F of rapids where G0 goes at F, program units a minute.
    pub rapid_feed: Option<f64>,
    /// Decimals of a feed a minute.
    pub feed_decimals: u8,
    /// Decimals of a feed by time, if it writes any.
    pub inverse_time_decimals: Option<u8>,
}

impl DialectVocabulary {
    /// A joint may pass its largest feed in a rapid under tool centre point control.
    pub fn rapids_pass(&self) -> bool {
        self.writes.has(Capabilities::TCP_RAPIDS_PASS)
    }
}

/// Whether rapids stand at feed in programs of a machine, and whether only where the control keeps the tip: which of them
/// does, a program says for itself.
fn fed_rapids(machine: &Machine, passes: bool) -> Option<bool> {
    let known = machine.axes.iter().all(|axis| axis.max_feed.is_finite());
    match machine.control.rapid {
        Some(Rapid::Linear) => Some(false),
        Some(Rapid::Rapid) => None,
        None => (passes && known).then_some(true),
    }
}

/// What the dialect of a machine tells.
pub fn spoken(finder: &Finder, machine: &Machine) -> Result<DialectVocabulary, Failure> {
    let (mut dialect, _) = plugin_finder::dialect(finder, machine, "READ", None)?;
    let words = dialect.vocabulary().map_err(|fault| Diagnostic::error("plugin", fault))?;
    if words.is_empty() {
        let message = format!(
            "dialect {} tells no vocabulary, so that its programs cannot be read back",
            machine.control.dialect
        );
        let help = "a dialect of your own tells it by `vocabulary` (docs/src/plugin-author)";
        return Err(Diagnostic::error("vocabulary", message).help(help).into());
    }
    Ok(DialectVocabulary {
        words,
        language: dialect.format().language,
        writes: dialect.capabilities(),
        most_inverse_time: dialect.format().most_inverse_time,
        rapid_feed: dialect.format().rapid_feed,
        feed_decimals: dialect.format().feed,
        inverse_time_decimals: dialect.format().inverse_time,
    })
}

/// The file of offsets.
pub fn offsets(session: &Session, source: &PathArg, machine: &Machine) -> Result<Offsets, Failure> {
    let (name, file) = open_table(session, WHAT, source)?;
    let mut text = String::new();
    let read = file.take(MOST_OFFSETS + 1).read_to_string(&mut text);
    read.map_err(|error| FileFault::Read { name: name.clone(), error })?;
    Ok(Offsets::parse(&text, &name, machine)?)
}

/// Refuses two inputs, called `what` together, that are both standard input.
pub fn not_both_standard(
    what: &str,
    program: &PathArg,
    against: Option<&PathArg>,
) -> Result<(), Box<Diagnostic>> {
    if program.path().is_none() && against.is_some_and(|file| file.path().is_none()) {
        let message = format!("{what} cannot both be standard input");
        return Err(Diagnostic::error("input", message).help("name one of them").boxed());
    }
    Ok(())
}

/// An NC program that is read as often as it takes: standard input and pipes are copied first.
#[derive(Debug)]
pub struct ProgramFile {
    /// What messages call it.
    pub name: String,
    file: File,
    session: Session,
}

impl ProgramFile {
    /// Opens a program.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn open(session: &Session, source: &PathArg) -> Result<Self, FileFault> {
        let (name, file) = open_as(session, WHAT, source)?;
        Ok(Self { name, file, session: session.clone() })
    }

    /// Its text from the beginning: whoever read it before is done.
    ///
    /// # Errors
    /// It cannot be read again.
    pub fn text(&self) -> Result<Stoppable<File>, FileFault> {
        let again = || -> io::Result<Stoppable<File>> {
            let mut again = self.file.try_clone()?;
            again.seek(SeekFrom::Start(0))?;
            Ok(self.session.stoppable(again))
        };
        again().map_err(|error| FileFault::Read { name: self.name.clone(), error })
    }
}

/// Opens a text that can be gone back in and that messages call `what`, with its name: standard input and pipes are
/// copied first.
pub fn open_as(
    session: &Session,
    what: &'static str,
    source: &PathArg,
) -> Result<(String, File), FileFault> {
    open_within(session, what, source, u64::MAX)
}

/// As [`open_as`], a table of at most [`disk::MOST_TABLE`] bytes; of what has no end no more is copied.
pub fn open_table(
    session: &Session,
    what: &'static str,
    source: &PathArg,
) -> Result<(String, File), FileFault> {
    let (name, mut file) = open_within(session, what, source, disk::MOST_TABLE + 1)?;
    let error = match file.seek(SeekFrom::End(0)) {
        Ok(length) if length > disk::MOST_TABLE => disk::too_large(),
        Ok(_) => match file.seek(SeekFrom::Start(0)) {
            Ok(_) => return Ok((name, file)),
            Err(error) => error,
        },
        Err(error) => error,
    };
    Err(FileFault::Read { name, error })
}

/// As [`open_as`]; of what is copied, `most` bytes.
fn open_within(
    session: &Session,
    what: &'static str,
    source: &PathArg,
    most: u64,
) -> Result<(String, File), FileFault> {
    let (Some(path), Some(named)) = (source.absolute(), source.path()) else {
        let name = "standard input".to_owned();
        let copied = copied(&mut io::stdin().lock().take(most));
        return match copied {
            Ok(file) => Ok((name, file)),
            Err(error) => Err(FileFault::Read { name, error }),
        };
    };
    let fault = |error| FileFault::read(named, error);
    let file = disk::open(path).map_err(fault)?;
    let metadata = file.metadata().map_err(fault)?;
    if metadata.is_dir() {
        return Err(FileFault::ReadFolder(named.to_owned()));
    }
    let name = named.display().to_string();
    if metadata.is_file() {
        session.read_files().note(what, path);
        return Ok((name, file));
    }
    Ok((name, copied(&mut file.take(most)).map_err(fault)?))
}

/// What `input` gives, in a file without a name.
fn copied(input: &mut impl io::Read) -> io::Result<File> {
    let mut file = disk::unnamed()?;
    io::copy(input, &mut file)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(file)
}
