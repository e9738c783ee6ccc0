//! One CL file on one machine, posted as often as it takes, its text thrown away.

use std::num::NonZeroUsize;

use post_host::{Finder, OpenedDialect};
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Batch, Capabilities, DialectSession, Format, WriteFault};
use post_posting::Observer;
use post_posting::program::DefaultSpindle;
use post_posting::report::PostingReport;

use super::plugin_finder;
use super::posting_pass::{self, OpenedPlugins, PostingPass, ProgramHead};
use crate::failure::Failure;
use crate::files::ClSource;
use crate::operations;
use crate::session::Session;
use crate::settings::JobSettings;

/// Decimals that leave axis values as they are solved: a millionth of a micrometre.
const EXACT: u8 = 9;

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
        };
        match pass.run_dry(&self.session, input, watch)? {
            (Some(report), findings) => Ok((report, findings)),
            (None, findings) => Err(findings.into()),
        }
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
