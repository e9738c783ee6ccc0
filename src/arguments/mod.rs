//! What several verbs take on the command line, and how its values are read.
//!
//! A flag becomes what it means to the core as it is parsed, and is not turned into text again.

pub mod flag_values;
mod making;
mod report;

use std::path::PathBuf;

use clap::Args;
use post_grammar::Units;
use post_machine::description::{Setting, Tcp};
use post_posting::program::{ToldSpindle, Unknown};
use post_readback::interpret::Limits;

use crate::files::PathArg;
use flag_values::{
    Msys, TcpWord, UnitsWord, UnknownWord, cl_word, feed, finite, length, point, positive, setting,
    spindle, word,
};

pub use making::MakingArguments;
pub use report::ReportArguments;

/// How a CL file is read.
#[derive(Clone, Debug, Default, Args)]
pub struct ReadingArguments {
    /// Units of the CL file's numbers, whatever it says.
    #[arg(
        long,
        value_parser = word::<UnitsWord, Units>(),
        value_name = "UNITS",
        help_heading = "Reading"
    )]
    pub units: Option<Units>,

    /// MSYS of NX: `keep` takes points and axes as written, `apply` takes them into its frame.
    #[arg(long, value_enum, default_value_t, value_name = "WHAT", help_heading = "Reading")]
    pub msys: Msys,

    /// What to do with words that have no effect: refuse the file for any (`error`), for those that post does not know
    /// (`known`), leave all out and say so (`warn`), or write them as comments (`pass`). What may be a move is refused
    /// whatever is said here.
    #[arg(
        long,
        value_parser = word::<UnknownWord, Unknown>(),
        default_value = "known",
        value_name = "WHAT",
        help_heading = "Reading"
    )]
    pub unknown: Unknown,

    /// Takes upon yourself what a word would have done, and leaves it out: a word that post does not know, or that
    /// changes where or whether metal is cut (`OFSETL`), `INSERT` (codes become remarks), `CUTTER` (several cutters are
    /// one tool), `FINI` (the file is whole), `DEEP` and the other kinds of cycles in pecks (without any, in one go),
    /// `MOVARC` (half turns go right-handed about their axis). What may be a move is never left out. Repeatable.
    #[arg(long, value_name = "WORD", value_parser = cl_word, help_heading = "Reading")]
    pub allow: Vec<String>,

    /// Number of the tool, for a CL file that loads none.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Reading")]
    pub tool: Option<u32>,

    /// Numbers tools from 1 in the order of their cutters, for a CL file that describes several and loads none.
    #[arg(long, conflicts_with = "tool", help_heading = "Reading")]
    pub tool_from_cutter: bool,

    /// Speed that the spindle is switched on at for each tool for which the CL file does not; `off`: it stands, and
    /// the tool cuts so.
    #[arg(long, value_name = "RPM", value_parser = spindle, help_heading = "Reading")]
    pub spindle: Option<ToldSpindle>,

    /// Feed of the cuts for which the CL file gives none, mm/min.
    #[arg(long, value_name = "MM_A_MINUTE", value_parser = feed, help_heading = "Reading")]
    pub feed: Option<f64>,
}

/// A CL file, how it is read, and the machine.
#[derive(Debug, Args)]
pub struct JobArguments {
    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE", required = true)]
    pub machine: Option<String>,

    /// The CL file, `-` for standard input.
    #[arg(value_name = "CL-FILE", required = true, value_parser = PathArg::parser())]
    pub input: Option<PathArg>,

    /// How the CL file is read.
    #[command(flatten)]
    pub reading: ReadingArguments,

    /// Where the part origin sits for this job, all axes at zero, machine frame, mm.
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        value_parser = point,
        help_heading = "Machine"
    )]
    pub mount: Option<[f64; 3]>,

    /// How the part is turned about its Z for this job, degrees, right-handed: counter-clockwise for who looks down on
    /// it, from the machine's X to the part's, all axes at zero. The work offset is not turned: words of the tip are
    /// written along the machine's axes.
    #[arg(
        long,
        value_name = "DEG",
        allow_hyphen_values = true,
        value_parser = finite,
        help_heading = "Machine"
    )]
    pub turn: Option<f64>,

    /// Length of every tool from the gauge point to the tip, mm, over what machine and CL file say.
    #[arg(
        long,
        value_name = "MM",
        allow_hyphen_values = true,
        value_parser = length,
        help_heading = "Machine"
    )]
    pub tool_length: Option<f64>,

    /// Sets a parameter of the machine (`Lm=312`) or any key (`accuracy.tolerance=0.001`).
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "Machine")]
    pub set: Vec<Setting>,

    /// Largest deviation of the tip in a cut, mm; short for --set accuracy.tolerance=…
    #[arg(long, value_name = "MM", value_parser = positive, help_heading = "Machine")]
    pub tolerance: Option<f64>,

    /// Who keeps the tip on its path; short for --set control.tcp=…
    #[arg(long, value_parser = word::<TcpWord, Tcp>(), value_name = "WHO", help_heading = "Machine")]
    pub tcp: Option<Tcp>,

    /// Posts in another dialect than the machine file names, with the options that it has for that one; short for
    /// --set control.dialect=… (`post plugin list`).
    #[arg(long, value_name = "NAME", help_heading = "Machine")]
    pub dialect: Option<String>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER", help_heading = "Machine")]
    pub machines: Vec<PathBuf>,

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more. Opening a library runs
    /// its code, so no folder is looked into that is not named here.
    #[arg(long, value_name = "FOLDER", help_heading = "Plugins")]
    pub plugins: Vec<PathBuf>,
}

impl JobArguments {
    /// The machine's name or file. Clap has seen to it that there is one: it is no `String`, since a further verb on
    /// the same command line takes its place.
    pub fn machine(&self) -> &str {
        self.machine.as_deref().unwrap_or_default()
    }

    /// The CL file; see [`JobArguments::machine`].
    pub fn input(&self) -> &PathArg {
        self.input.as_ref().unwrap_or(&PathArg::Standard)
    }

    /// What the flags set over the machine file: `--set` first, then the short ones, which win.
    pub fn settings(&self) -> Vec<Setting> {
        let mut settings = self.set.clone();
        settings.extend(self.mount.map(Setting::Mount));
        settings.extend(self.turn.map(Setting::Turn));
        settings.extend(self.tolerance.map(Setting::Tolerance));
        settings.extend(self.tcp.map(Setting::Tcp));
        settings.extend(self.dialect.clone().map(Setting::Dialect));
        settings
    }
}

/// An NC program that is read back, and the machine that runs it.
#[derive(Clone, Debug, Args)]
pub struct ProgramArguments {
    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE")]
    pub machine: String,

    /// Lengths of tools, work offsets and reference positions as the control's tables have them, a TOML file:
    /// `[work.G54]` with X, Y, Z (mm from where `mount` of the machine file has the part) and what rotary axes show there
    /// (degrees); `[length]` and `[radius]` by register, `[tool]` by tool number (mm); `[reference.1]` for G28, `[reference.2]`
    /// for G30 (machine coordinates).
    #[arg(long, value_name = "FILE", value_parser = PathArg::parser(), help_heading = "Reading")]
    pub offsets: Option<PathArg>,

    /// So many blocks are run once more, by loops, jumps and subprograms; more are refused.
    #[arg(long, value_name = "N", default_value_t = Limits::default().blocks, value_parser = clap::value_parser!(u64).range(1..), help_heading = "Reading")]
    pub most_blocks: u64,

    /// Length of every tool that --offsets does not name, from the gauge point to the tip, mm, over what the machine file
    /// says.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = length, help_heading = "Machine")]
    pub tool_length: Option<f64>,

    /// Where the part origin sits for this job, all axes at zero, machine frame, mm.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point, help_heading = "Machine")]
    pub mount: Option<[f64; 3]>,

    /// Sets a parameter of the machine (`Lm=312`) or any key (`control.tcp="post"`).
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "Machine")]
    pub set: Vec<Setting>,

    /// Reads another dialect than the machine file names; short for --set control.dialect=… (`post plugin list`).
    #[arg(long, value_name = "NAME", help_heading = "Machine")]
    pub dialect: Option<String>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER", help_heading = "Machine")]
    pub machines: Vec<PathBuf>,

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more. Opening a library runs
    /// its code, so no folder is looked into that is not named here.
    #[arg(long, value_name = "FOLDER", help_heading = "Plugins")]
    pub plugins: Vec<PathBuf>,
}

impl ProgramArguments {
    /// What the flags set over the machine file: `--set` first, then the short ones, which win.
    pub fn settings(&self) -> Vec<Setting> {
        let mut settings = self.set.clone();
        settings.extend(self.mount.map(Setting::Mount));
        settings.extend(self.dialect.clone().map(Setting::Dialect));
        settings
    }
}
