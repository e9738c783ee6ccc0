//! One CL file on one machine, gone over as often as it takes, its text thrown away.

use post_host::{Finder, OpenedDialect};
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Batch, DialectSession, Format, WriteFault};
use post_posting::report::Report;
use post_posting::{Output, Post, Watch};

use crate::arguments::JobArguments;
use crate::files::cl_input::{Input, one, standard};
use crate::job::plugin_finder as plugins;
use crate::verbs::post as posting;

/// Decimals that leave axis values as they are solved: a millionth of a micrometre.
const EXACT: u8 = 9;

/// A CL file and how it is looked at.
pub struct Job<'a> {
    arguments: &'a JobArguments,
    pub finder: Finder,
    /// Words are not rounded.
    exact: bool,
}

impl<'a> Job<'a> {
    /// Of the CL file and the machine of the command line.
    pub fn new(arguments: &'a JobArguments, exact: bool) -> Result<Self, Vec<Diagnostic>> {
        if arguments.input() == standard() {
            return Err(vec![
                Diagnostic::error("study", "a study goes over the CL file several times")
                    .help("give a file, not standard input"),
            ]);
        }
        Ok(Self {
            arguments,
            finder: plugins::finder(&arguments.plugins)?,
            exact,
        })
    }

    /// The machine with `more` set, every CL point of its cuts kept.
    pub fn machine(&self, more: &[Setting]) -> Result<Machine, Vec<Diagnostic>> {
        let mut settings = vec![Setting::Reduce(false)];
        settings.extend_from_slice(more);
        self.arguments.machine(&settings)
    }

    /// Posts the file, and throws the text away.
    pub fn pass(
        &self,
        machine: &Machine,
        watch: Option<&mut dyn Watch>,
    ) -> Result<(Report, Vec<Diagnostic>), Vec<Diagnostic>> {
        let path = self.arguments.input();
        let program = posting::program_name(path, None);
        let (dialect, _) = plugins::dialect(&self.finder, machine, &program)?;
        let (mut model, _) = plugins::model(&self.finder, machine)?;
        let input = Input::open(path)?;
        let job = posting::job(self.arguments, &input.name);
        let mut dialect = Rounding::new(dialect, self.exact);
        let mut nowhere = Nowhere;
        let mut post = Post::new(machine, job, &mut dialect, &mut model, &mut nowhere)
            .map_err(|finding| vec![*finding])?;
        if let Some(watch) = watch {
            post.watch(watch);
        }
        posting::read(input, &mut post)?;
        match post.finish() {
            (Some(report), findings) => Ok((report, findings)),
            (None, findings) => Err(findings),
        }
    }

    /// The CL file, as the user named it.
    pub fn name(&self) -> String {
        self.arguments.input().display().to_string()
    }

    /// What is said of a file without cuts.
    pub fn nothing(&self) -> Vec<Diagnostic> {
        one(
            "study",
            format!("{} has no cut between two positions", self.name()),
        )
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
    fn format(&self) -> &Format {
        &self.format
    }

    fn write_batch(
        &mut self,
        batch: &Batch,
        out: &mut Vec<u8>,
        ends: &mut Vec<usize>,
    ) -> Result<(), WriteFault> {
        self.dialect.write_batch(batch, out, ends)
    }
}

struct Nowhere;

impl Output for Nowhere {
    fn write(&mut self, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}
