//! One CL file on one machine, posted as often as it takes, its text thrown away.

use std::io::Seek as _;
use std::num::NonZeroUsize;

use post_host::{Finder, OpenedDialect};
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Batch, Capabilities, DialectSession, Format, WriteFault};
use post_posting::Observer;
use post_posting::program::DefaultSpindle;
use post_posting::report::PostingReport;
use post_readback::interpret::Limits;

use super::clearance::{self, ClearanceFound};
use super::one_program::OneProgram;
use super::plugin_finder;
use super::posting_pass::{self, OpenedPlugins, PostingExtras, PostingPass, ProgramHead};
use super::read_back::ReadingSetup;
use crate::failure::Failure;
use crate::files::{ClSource, FileFault, Scratch};
use crate::operations;
use crate::session::Session;
use crate::settings::JobSettings;

/// Decimals that leave axis values as they are solved: a millionth of a micrometre.
const EXACT: u8 = 9;

/// What messages call a program that is tried.
const TRIED: &str = "the program that is tried";

/// A CL file and how it is looked at.
pub struct DryRun<'a> {
    session: Session,
    arguments: &'a JobSettings,
    /// The CL file, as the user named it.
    pub name: String,
    /// Finds the plugins that the machine asks for.
    pub finder: Finder,
    /// Words are not rounded.
    exact: bool,
    /// Threads that a pass is made on at most.
    pub threads: NonZeroUsize,
    /// Solutions are chosen with which bodies stay clear.
    pub keeps_clear: bool,
}

impl<'a> DryRun<'a> {
    /// Of the CL file and the machine of the command line, for the verb of that name of a command.
    pub fn new(
        session: &'a Session,
        verb: &'static str,
        command: &str,
        arguments: &'a JobSettings,
        exact: bool,
    ) -> Result<Self, Failure> {
        let Some(path) = arguments.input.path() else {
            let message = format!("{command} {verb} goes over the CL file several times");
            return Err(Diagnostic::error(verb, message)
                .help("give a file, not standard input")
                .into());
        };
        Ok(Self {
            session: session.clone(),
            arguments,
            name: path.display().to_string(),
            finder: plugin_finder::finder(session, &arguments.over.plugins)?,
            exact,
            threads: NonZeroUsize::MIN,
            keeps_clear: false,
        })
    }

    /// The same for one thread of several.
    pub fn of_one_thread(&self) -> DryRun<'a> {
        DryRun {
            session: self.session.unseen(),
            name: self.name.clone(),
            finder: self.finder.clone(),
            threads: NonZeroUsize::MIN,
            ..*self
        }
    }

    /// The machine of the command line with `more` set.
    pub fn machine(&self, more: &[Setting]) -> Result<Machine, Failure> {
        super::machine(&self.session, self.arguments, more)
    }

    /// Posts the file, and throws the text away.
    pub fn pass(
        &self,
        machine: &Machine,
        watch: Option<&mut dyn Observer>,
    ) -> Result<(PostingReport, Vec<Diagnostic>), Failure> {
        let source = &self.arguments.input;
        let program = super::program_name(source, None);
        let head = ProgramHead { name: &program, cl_file: Some(source), preview: None };
        let OpenedPlugins { dialect, mut model, .. } =
            OpenedPlugins::open(&self.finder, machine, head)?;
        let mut cl = ClSource::of_job(&self.session, self.arguments, true)?;
        let chosen = operations::chosen(self.arguments, &mut cl)?;
        let input = cl.open()?;
        let mut request = posting_pass::posting_request(self.arguments, &input);
        request.lines = chosen.map(|lines| lines.ranges);
        if request.reading.spindle == DefaultSpindle::Unknown {
            // Nothing is written: how fast the spindle turns is nobody's business.
            request.reading.spindle = DefaultSpindle::Still;
        }
        request.holes_as_moves = true;
        let mut dialect = Rounding::new(dialect, self.exact);
        let pass = PostingPass {
            machine,
            request,
            threads: self.threads,
            dialect: &mut dialect,
            model: &mut model,
            keeps_clear: self.keeps_clear,
        };
        match pass.run_dry(&self.session, input, watch)? {
            (Some(report), findings) => Ok((report, findings)),
            (None, findings) => Err(findings.into()),
        }
    }
}

impl DryRun<'_> {
    /// Writes the program, reads it back, and proves that nothing hits anything while it runs.
    ///
    /// # Errors
    /// Why it cannot be made or read.
    pub fn prove(&self, machine: &Machine) -> Result<ClearanceFound, Failure> {
        let mut arguments = self.arguments.clone();
        // How fast the spindle turns is nobody's business.
        arguments.reading.spindle.get_or_insert(DefaultSpindle::Still);
        let machine = &machine.without_text();
        let mut source = ClSource::of_job(&self.session, &arguments, true)?;
        let lines = operations::chosen(&arguments, &mut source)?;
        let ranges = lines.as_ref().map(|lines| lines.ranges.clone());
        let mut text = Scratch::new(TRIED)?;
        let program = OneProgram {
            session: &self.session,
            arguments: &arguments,
            machine,
            finder: &self.finder,
            target: &arguments.input,
            lines,
            trust_model: false,
            plans: false,
            threads: self.threads,
            tightening: None,
            keeps_clear: self.keeps_clear,
        };
        let beside = PostingExtras::default();
        if let (None, findings) = program.write(None, &mut source, &mut text, beside)? {
            return Err(findings.into());
        }
        let reading = ReadingSetup {
            session: &self.session,
            arguments: &arguments,
            machine,
            finder: &self.finder,
            offsets: None,
            limits: Limits::default(),
            tolerances: [None, None],
            planned: false,
            any_coolant: false,
            any_work_offset: true,
            own: true,
            solutions: false,
            lines: ranges,
            threads: self.threads,
        };
        let mut text = text.reread()?;
        let again = text.rewind();
        again.map_err(|error| FileFault::Read { name: TRIED.to_owned(), error })?;
        clearance::of_job(&reading, &mut source, TRIED, Box::new(text), None)
    }
}

/// A dialect, and the decimals that the words are rounded to.
struct Rounding {
    dialect: OpenedDialect,
    format: Format,
}

impl Rounding {
    fn new(dialect: OpenedDialect, exact: bool) -> Self {
        let mut format = dialect.format().clone();
        if exact {
            format.words.fill(EXACT);
        }
        Self { dialect, format }
    }
}

impl DialectSession for Rounding {
    /// What stands between the moves; the moves are looked at as such, whatever the dialect makes of them, and cuts may come
    /// by runs.
    fn capabilities(&self) -> Capabilities {
        const BETWEEN: Capabilities = Capabilities::WORK_OFFSET
            .and(Capabilities::OFFSETS)
            .and(Capabilities::SUBPROGRAM)
            .and(Capabilities::SURFACE_SPEED)
            .and(Capabilities::SMOOTHING)
            .and(Capabilities::SIGN_IS_WAY)
            .and(Capabilities::CUTS);
        Capabilities::from_bits(self.dialect.capabilities().bits() & BETWEEN.bits())
    }

    fn format(&self) -> &Format {
        &self.format
    }

    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut String,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        self.dialect.write_batch(batch, out, ends)
    }
}
