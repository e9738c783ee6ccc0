//! The command line.

use std::path::{Path, PathBuf};

use clap::{Args, Parser, Subcommand, ValueEnum};
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use crate::check::CheckArguments;
use crate::input::standard;
use crate::machines;
use crate::new::NewArguments;
use crate::plugins::kit::PluginArguments;
use crate::study::StudyArguments;
use crate::values::{Point, TcpArgument, UnitsArgument, not_negative, point, positive};

/// Turns a cutter-location file (APT, CLSF, NCL) into the NC program of one machine.
///
/// The machine is a TOML file: its kinematic chain, its control and the tolerance that the program must
/// keep. Points are put in where the axes would stray from the path, and the deviation of every block of the
/// program is certified. Nothing is written unless the whole program is good.
#[derive(Debug, Parser)]
#[command(
    name = "post",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:
  post --machine ac-trunnion part.cls
  post --machine dmu50.toml part.ncl -o part.h --mount 0,0,120 --summary part.json
  post --machine disc-cutter --set Lm=250 blade.cls -o -
  post words part.cls
  post new my-mill --class table-table-ac --dialect linuxcnc
  post check my-mill.toml --svg reach.svg
  post study part.cls --machine ac-trunnion
  post plugin test target/release/libpost_mine.so

Exit codes: 0 the program is written; 1 refused, the messages say why; 2 the command line is wrong.",
    max_term_width = 100
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub post: PostArguments,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Prints every word of a CL file: how often, and what becomes of it; without a file every word that is known.
    ///
    /// used: it has its effect on the program; passed on: its text goes into the program; ignored: it says
    /// nothing to a machine; refused: it changes where the tool goes, and post does not know how; unknown:
    /// left out with a warning, unless --unknown says otherwise.
    Words {
        /// The CL file, `-` for standard input.
        file: Option<PathBuf>,
        /// Only words that are refused or unknown.
        #[arg(long, requires = "file")]
        unknown_only: bool,
    },
    /// Lists the machines that a bare name finds.
    Machines {
        /// A further folder of machine files.
        #[arg(long, value_name = "FOLDER")]
        machines: Vec<PathBuf>,
    },
    /// Prints the JSON Schema of machine files, by which an editor completes and checks them.
    Schema,
    Check(CheckArguments),
    New(NewArguments),
    Study(Box<StudyArguments>),
    Plugin(PluginArguments),
}

#[derive(Debug, Args)]
pub struct PostArguments {
    #[command(flatten)]
    pub job: JobArguments,

    /// The NC program, `-` for standard output. [default: beside the CL file, with the dialect's ending]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// Writes the summary as JSON for programs to read; `-` is standard output.
    #[arg(long, value_name = "FILE")]
    pub summary: Option<PathBuf>,

    /// No summary, warnings and errors alone.
    #[arg(short, long)]
    pub quiet: bool,

    /// Takes the error model's word where the certificate finds more, and only reports it. (The placement `fewest` asks
    /// no model.)
    #[arg(long, help_heading = "Plugins")]
    pub trust_model: bool,
}

/// A CL file, how it is read, and the machine.
#[derive(Debug, Args)]
pub struct JobArguments {
    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE", required = true)]
    pub machine: Option<String>,

    /// The CL file, `-` for standard input.
    #[arg(value_name = "CL-FILE", required = true)]
    pub input: Option<PathBuf>,

    /// Units of the CL file's numbers, whatever it says.
    #[arg(long, value_enum, value_name = "UNITS", help_heading = "Reading")]
    pub units: Option<UnitsArgument>,

    /// MSYS of NX: `keep` takes points and axes as written, `apply` takes them into its frame.
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "WHAT",
        help_heading = "Reading"
    )]
    pub msys: Msys,

    /// What to do with words that post does not know: refuse the file, leave them out and say so, or write
    /// them as comments.
    #[arg(
        long,
        value_enum,
        default_value_t,
        value_name = "WHAT",
        help_heading = "Reading"
    )]
    pub unknown: UnknownArgument,

    /// Number of the tool, for a CL file that loads none.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Reading")]
    pub tool: Option<u32>,

    /// Where the part origin sits for this job, all axes at zero, machine frame, mm.
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        value_parser = point,
        help_heading = "Machine"
    )]
    pub mount: Option<Point>,

    /// Length of every tool from the gauge point to the tip, mm, over what machine and CL file say.
    #[arg(
        long,
        value_name = "MM",
        allow_hyphen_values = true,
        value_parser = not_negative,
        help_heading = "Machine"
    )]
    pub tool_length: Option<f64>,

    /// Sets a parameter of the machine (`Lm=312`) or any key (`accuracy.tolerance=0.001`).
    #[arg(long, value_name = "NAME=VALUE", help_heading = "Machine")]
    pub set: Vec<String>,

    /// Largest deviation of the tip in a cut, mm; short for --set accuracy.tolerance=…
    #[arg(long, value_name = "MM", value_parser = positive, help_heading = "Machine")]
    pub tolerance: Option<f64>,

    /// Who keeps the tip on its path; short for --set control.tcp=…
    #[arg(long, value_enum, value_name = "WHO", help_heading = "Machine")]
    pub tcp: Option<TcpArgument>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER", help_heading = "Machine")]
    pub machines: Vec<PathBuf>,

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more. Opening a library runs
    /// its code, so no folder is looked into that is not named here.
    #[arg(long, value_name = "FOLDER", help_heading = "Plugins")]
    pub plugins: Vec<PathBuf>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, ValueEnum)]
pub enum Msys {
    #[default]
    Keep,
    Apply,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum UnknownArgument {
    Error,
    #[default]
    Warn,
    Pass,
}

impl JobArguments {
    /// The CL file.
    pub fn input(&self) -> &Path {
        self.input.as_deref().unwrap_or(standard())
    }

    /// The machine with all settings, and `more` after them.
    pub fn machine(&self, more: &[String]) -> Result<Machine, Vec<Diagnostic>> {
        let mut settings = self.settings();
        settings.extend_from_slice(more);
        let name = self.machine.as_deref().unwrap_or_default();
        machines::load(name, &self.machines, &settings)
    }

    /// What the short flags set, after what `--set` sets.
    fn settings(&self) -> Vec<String> {
        let mut settings = self.set.clone();
        if let Some(mount) = &self.mount {
            settings.push(mount.setting());
        }
        if let Some(tolerance) = self.tolerance {
            settings.push(format!("accuracy.tolerance={tolerance:?}"));
        }
        if let Some(tcp) = self.tcp {
            let who = match tcp {
                TcpArgument::Control => "control",
                TcpArgument::Post => "post",
            };
            settings.push(format!("control.tcp=\"{who}\""));
        }
        settings
    }
}
