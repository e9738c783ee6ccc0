//! An NC program that is read back: the machine that runs it, the words of its control, and what stands in its tables.

use std::fs::File;
use std::io::{self, Read as _, Seek, SeekFrom};

use post_host::Finder;
use post_machine::description::{Machine, Rapid};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Capabilities, DialectSession as _, VocabularyWord};
use post_readback::interpret::{Interpreter, Limits};
use post_readback::lexicon::Lexicon;
use post_readback::{FedRapids, Offsets, turns_the_spindle};

use super::{machine_files, plugin_finder, unused_options};
use crate::arguments::ProgramArguments;
use crate::failure::Failure;
use crate::files::{FileFault, PathArg};
use crate::session::Session;

/// Longest file of offsets that is read, bytes.
const MOST_OFFSETS: u64 = 1 << 20;

/// What is needed to run NC programs of a machine.
#[derive(Debug)]
pub struct NcControl {
    /// The machine.
    pub machine: Machine,
    /// The words of its control.
    pub lexicon: Lexicon,
    /// What stands in its tables.
    pub offsets: Offsets,
    /// How far a program may go.
    pub limits: Limits,
    /// Rapids may stand in its programs as feed moves at the highest feed of the axes; true: where the control keeps the
    /// tip alone.
    pub fed_rapids: Option<bool>,
}

impl NcControl {
    /// As the flags say.
    pub fn new(session: &Session, arguments: &ProgramArguments) -> Result<Self, Failure> {
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
        Ok(Self {
            lexicon: Lexicon::new(&spoken.words),
            fed_rapids: fed_rapids(&machine, spoken.rapids_pass),
            machine,
            offsets,
            limits: Limits { blocks: arguments.most_blocks, ..Limits::default() },
        })
    }

    /// The program in `file`, which messages call `name`, from where it stands.
    pub fn run(&self, name: &str, file: File) -> Result<Interpreter<File>, Failure> {
        let Self { machine, lexicon, offsets, limits, .. } = self;
        Interpreter::new(machine, lexicon, offsets, *limits, name, file)
            .map_err(|fault| Failure::from(*fault))
    }

    /// The same, its rapids at feed told from cuts. `again` gives the file from its beginning.
    pub fn run_with_rapids(
        &self,
        name: &str,
        mut again: impl FnMut() -> Result<File, Failure>,
    ) -> Result<FedRapids<Interpreter<File>>, Failure> {
        let Some(kept) = self.fed_rapids else {
            return Ok(FedRapids::none(self.run(name, again()?)?));
        };
        let turns = turns_the_spindle(&mut self.run(name, again()?)?);
        let program = self.run(name, again()?)?;
        Ok(FedRapids::new(program, &self.machine, kept, turns))
    }
}

/// What a dialect tells of the programs that its control reads.
pub struct Spoken {
    /// The words.
    pub words: Vec<VocabularyWord>,
    /// Largest F by time, 1/min.
    pub most_inverse_time: Option<f64>,
    /// Decimals of a feed a minute.
    pub feed_decimals: u8,
    /// A joint may pass its largest feed in a rapid under tool centre point control.
    pub rapids_pass: bool,
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
pub fn spoken(finder: &Finder, machine: &Machine) -> Result<Spoken, Failure> {
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
    Ok(Spoken {
        words,
        most_inverse_time: dialect.format().most_inverse_time,
        feed_decimals: dialect.format().feed,
        rapids_pass: dialect.capabilities().has(Capabilities::TCP_RAPIDS_PASS),
    })
}

/// The file of offsets.
pub fn offsets(session: &Session, source: &PathArg, machine: &Machine) -> Result<Offsets, Failure> {
    let (name, file) = open(session, source)?;
    let mut text = String::new();
    let read = file.take(MOST_OFFSETS + 1).read_to_string(&mut text);
    read.map_err(|error| FileFault::Read { name: name.clone(), error })?;
    Ok(Offsets::parse(&text, &name, machine)?)
}

/// Refuses a program and a CL file that are both standard input.
pub fn not_both_standard(
    program: &PathArg,
    against: Option<&PathArg>,
) -> Result<(), Box<Diagnostic>> {
    if program.path().is_none() && against.is_some_and(|file| file.path().is_none()) {
        let message = "program and CL file cannot both be standard input";
        return Err(Diagnostic::error("input", message).help("name one of them").boxed());
    }
    Ok(())
}

/// Opens a file that can be gone back in, with its name for messages: standard input and pipes are copied first.
pub fn open(session: &Session, source: &PathArg) -> Result<(String, File), FileFault> {
    open_as(session, "the NC program", source)
}

/// The same of another text, which messages call `what`.
pub fn open_as(
    session: &Session,
    what: &'static str,
    source: &PathArg,
) -> Result<(String, File), FileFault> {
    let (Some(path), Some(named)) = (source.absolute(), source.path()) else {
        let name = "standard input".to_owned();
        let copied = copied(&mut io::stdin().lock());
        return match copied {
            Ok(file) => Ok((name, file)),
            Err(error) => Err(FileFault::Read { name, error }),
        };
    };
    let fault = |error| FileFault::read(named, error);
    let mut file = File::open(path).map_err(fault)?;
    let metadata = file.metadata().map_err(fault)?;
    if metadata.is_dir() {
        return Err(FileFault::ReadFolder(named.to_owned()));
    }
    let name = named.display().to_string();
    if metadata.is_file() {
        session.read_files().note(what, path);
        return Ok((name, file));
    }
    Ok((name, copied(&mut file).map_err(fault)?))
}

/// The open file `name` once more, from its beginning: whoever read it before is done.
pub fn again(name: &str, file: &File) -> Result<File, FileFault> {
    let again = || -> io::Result<File> {
        let mut again = file.try_clone()?;
        again.seek(SeekFrom::Start(0))?;
        Ok(again)
    };
    again().map_err(|error| FileFault::Read { name: name.to_owned(), error })
}

/// The open file `name` from its beginning, to be read beside another reader that is not done yet: its place in the file is
/// its own.
pub fn reopened(name: &str, file: &File) -> Result<File, FileFault> {
    let copied = || -> io::Result<File> {
        let mut from = file.try_clone()?;
        let at = from.stream_position()?;
        from.seek(SeekFrom::Start(0))?;
        let copy = copied(&mut from);
        from.seek(SeekFrom::Start(at))?;
        copy
    };
    copied().map_err(|error| FileFault::Read { name: name.to_owned(), error })
}

/// What `input` gives, in a file without a name.
fn copied(input: &mut impl io::Read) -> io::Result<File> {
    let mut file = tempfile::tempfile()?;
    io::copy(input, &mut file)?;
    file.seek(SeekFrom::Start(0))?;
    Ok(file)
}
