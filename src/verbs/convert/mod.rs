//! `post convert`: an NC program moved to another machine.

use std::path::PathBuf;

use clap::Args;
use post_machine::description::{Setting, Tcp};
use post_posting::program::DefaultSpindle;
use post_readback::interpret::Limits;

use crate::flag_words::TcpWord;
use post_cli::arguments::Flags;
use post_cli::arguments::flag_values::file;
use post_cli::arguments::flag_values::{feed, length, point, positive, setting, spindle, word};
use post_cli::terminal;
use post_job::convert::{ConvertRequest, convert};
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::session::Session;
use post_job::settings::{
    JobSettings, MachineSettings, ProgramSettings, ReadingSettings, ReportSettings,
};

/// Converts an NC program for another machine.
///
/// The program is run on the machine --from, as its control runs it. What the tool does against the part is written as a
/// CL file, with tools, speeds, feeds of the tip, curves, cycles and remarks, and posted on the machine --to. The new
/// program is then run as well, and held against the path of the first: it takes its name only if the tool goes the same
/// way within the tolerance.
///
/// What the first program does for its own machine alone stays behind: ways in machine coordinates and the turn of rotary
/// axes on the way to the next approach are made anew, as the machine --to retracts and approaches.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post convert boat.ngc --from xyzac-trt --to xyzbc-trt -o boat-b.ngc
  post convert part.h --from dmu50 --offsets control.toml --to ac-trunnion -o part.nc --cl part.cls

Exit codes: 0 the program is written, and makes the tool go the way of the first; 1 refused, the messages say why;
2 the command line is wrong.")]
pub struct ConvertArguments {
    /// The NC program, `-` for standard input.
    #[arg(value_name = "NC-FILE", value_parser = file())]
    input: PathArg,

    /// The machine that it was made for: a TOML file, or a name (`post machines`).
    #[arg(long, value_name = "MACHINE")]
    from: String,

    /// The machine that it shall run on.
    #[arg(long, value_name = "MACHINE")]
    to: String,

    /// The new program, `-` for standard output.
    #[arg(short, long, value_name = "FILE", value_parser = file())]
    output: PathArg,

    /// Writes the CL file too that stands between the two programs.
    #[arg(long, value_name = "FILE", value_parser = file())]
    cl: Option<PathArg>,

    #[command(flatten)]
    report: Flags<ReportSettings>,

    /// Prints no summary, only warnings and errors.
    #[arg(short, long)]
    quiet: bool,

    /// Lengths of tools, work offsets and reference positions of the first machine's control: see `post read`.
    #[arg(long, value_name = "FILE", value_parser = file(), help_heading = "First machine")]
    offsets: Option<PathArg>,

    /// Length of every tool that --offsets does not name, from the gauge point to the tip, mm.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = length, help_heading = "First machine")]
    tool_length: Option<f64>,

    /// Where the part origin sits on the first machine, all axes at zero, machine frame, mm.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point, help_heading = "First machine")]
    from_mount: Option<[f64; 3]>,

    /// Sets a parameter of the first machine, or any key.
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "First machine")]
    from_set: Vec<Setting>,

    /// Reads another dialect than the first machine's file names.
    #[arg(long, value_name = "NAME", help_heading = "First machine")]
    from_dialect: Option<String>,

    /// So many blocks are run once more, by loops, jumps and subprograms; more are refused.
    #[arg(long, value_name = "N", default_value_t = Limits::default().blocks, value_parser = clap::value_parser!(u64).range(1..), help_heading = "First machine")]
    most_blocks: u64,

    /// Where the part origin sits on the second machine, all axes at zero, machine frame, mm.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point, help_heading = "Second machine")]
    mount: Option<[f64; 3]>,

    /// Sets a parameter of the second machine, or any key.
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, help_heading = "Second machine")]
    set: Vec<Setting>,

    /// Posts in another dialect than the second machine's file names.
    #[arg(long, value_name = "NAME", help_heading = "Second machine")]
    dialect: Option<String>,

    /// Who keeps the tip on its path on the second machine, the control by RTCP (TCP, TCPM) or the post.
    #[arg(long, value_parser = word::<TcpWord, Tcp>(), value_name = "WHO", help_heading = "Second machine")]
    tcp: Option<Tcp>,

    /// Largest deviation of the tip in a cut from the first program's path, mm.
    #[arg(long, value_name = "MM", value_parser = positive, help_heading = "Second machine")]
    tolerance: Option<f64>,

    /// Speed that the spindle is switched on at for each tool for which the first program does not; `off`: it stands.
    #[arg(long, value_name = "RPM", value_parser = spindle, help_heading = "Second machine")]
    spindle: Option<DefaultSpindle>,

    /// Feed of the cuts for which the first program has none, mm/min.
    #[arg(long, value_name = "MM_A_MINUTE", value_parser = feed, help_heading = "Second machine")]
    feed: Option<f64>,

    /// Number of the tool, for a program that loads none.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Second machine")]
    tool: Option<u32>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER", help_heading = "Machines and plugins")]
    machines: Vec<PathBuf>,

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more.
    #[arg(long, value_name = "FOLDER", help_heading = "Machines and plugins")]
    plugins: Vec<PathBuf>,
}

/// Converts as the arguments say.
pub fn run(session: &Session, arguments: &ConvertArguments) -> Result<(), Failure> {
    let request = ConvertRequest {
        from: arguments.first(),
        to: arguments.second(),
        output: arguments.output.clone(),
        cl: arguments.cl.clone(),
        report: arguments.report.0.clone(),
    };
    let converted = convert(session, &request)?;
    session.findings(&converted.findings);
    if !arguments.quiet {
        let text = converted.summary(converted.names.clone()).table();
        terminal::print_beside(session, &text, converted.printed);
    }
    Ok(())
}

impl ConvertArguments {
    /// How the first program is read.
    fn first(&self) -> ProgramSettings {
        ProgramSettings {
            machine: self.from.clone(),
            offsets: self.offsets.clone(),
            most_blocks: self.most_blocks,
            tool_length: self.tool_length,
            tools: None,
            mount: self.from_mount,
            set: self.from_set.clone(),
            dialect: self.from_dialect.clone(),
            machines: self.machines.clone(),
            plugins: self.plugins.clone(),
        }
    }

    /// How its path is posted.
    fn second(&self) -> JobSettings {
        JobSettings {
            machine: self.to.clone(),
            input: self.input.clone(),
            reading: ReadingSettings {
                tool: self.tool,
                spindle: self.spindle,
                feed: self.feed,
                ..ReadingSettings::default()
            },
            over: MachineSettings {
                mount: self.mount,
                set: self.set.clone(),
                tolerance: self.tolerance,
                tcp: self.tcp,
                dialect: self.dialect.clone(),
                machines: self.machines.clone(),
                plugins: self.plugins.clone(),
                ..MachineSettings::default()
            },
            mark: None,
        }
    }
}
