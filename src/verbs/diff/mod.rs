//! `post diff`: what two NC programs make the machine do differently.

mod diff_picture;
mod diff_text;

use clap::{Args, ValueEnum};

use post_cli::arguments::flag_values::file;
use post_cli::arguments::{Flags, ProgramArguments, flag_values};
use post_cli::terminal;
use post_job::diff::{self, DiffRequest, DiffResult, DiffTolerances};
use post_job::failure::Failure;
use post_job::files::{self, AtomicFile, PathArg, Role};
use post_job::session::Session;
use post_job::settings::{ProgramSettings, ReportSettings};

/// Compares what two NC programs make the machine do, not their text.
///
/// Both are read back and their paths gone along together in the part frame, operation by operation: position of the tip,
/// tool axis, feed, what holds (tool, spindle, coolant, compensation), waits and stops, time, and ways that one of them
/// goes alone. Remarks, numbers of blocks, repeated words, where blocks end, and whether the control or the words keep the
/// tip make no difference. On one machine rotary axes, registers and positions of the machine count too; with
/// --machine-new only what the part sees. Distances are never told below the Fréchet distance of the paths.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post diff old.nc new.nc --machine ac-trunnion
  post diff old.nc new.h --machine ac-trunnion --machine-new dmu50 --tool-length 120
  post diff old.nc new.nc --machine vmc --json - --svg difference.svg
  post diff old.nc new.nc --machine vmc --cuts

Exit codes, as those of diff: 0 the machine does the same (with --cuts: cuts the same); 1 it does not, or a program is refused, the messages say
why; 2 the command line is wrong.")]
pub struct DiffArguments {
    /// The program as it was.
    #[arg(value_name = "OLD", value_parser = file())]
    old: PathArg,

    /// The program as it is.
    #[arg(value_name = "NEW", value_parser = file())]
    new: PathArg,

    #[command(flatten)]
    program: ProgramArguments,

    /// The machine of the new program, if it is another.
    #[arg(long, value_name = "MACHINE", help_heading = "New program")]
    machine_new: Option<String>,

    /// The dialect of the new program, if it is another than the machine file names.
    #[arg(long, value_name = "NAME", help_heading = "New program")]
    dialect_new: Option<String>,

    /// What stands in the control's tables for the new program, if it is something else.
    #[arg(long, value_name = "FILE", value_parser = file(), help_heading = "New program")]
    offsets_new: Option<PathArg>,

    /// Length of every tool of the new program, if it is another, mm.
    #[arg(long, value_name = "MM", value_parser = flag_values::not_negative, help_heading = "New program")]
    tool_length_new: Option<f64>,

    /// Where the part origin sits for the new program, if it is elsewhere.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = flag_values::point, help_heading = "New program")]
    mount_new: Option<[f64; 3]>,

    /// Positions that differ by no more are the same, mm.
    #[arg(long, value_name = "MM", default_value_t = post_readback::diff::SAME, value_parser = flag_values::positive)]
    tolerance: f64,

    /// Tool axes and rotary axes that differ by no more are the same, degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = post_readback::diff::SAME, value_parser = flag_values::positive)]
    axis_tolerance: f64,

    /// Feeds that differ by no more are the same, percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * post_readback::diff::SAME_FEED, value_parser = flag_values::positive)]
    feed_tolerance: f64,

    /// Makes no difference: `coolant`, which of them flows and whether; `tools`, their numbers, names and registers. Repeatable.
    #[arg(long, value_name = "WHAT", value_enum)]
    ignore: Vec<Ignored>,

    /// Tells differences of cuts alone, whatever retracts, approaches and other rapids do, waits, stops, tool changes and
    /// time. How many others there are is said.
    #[arg(long)]
    cuts: bool,

    /// Writes the result as JSON, with all digits; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    json: Option<PathArg>,

    #[command(flatten)]
    report: Flags<ReportSettings>,

    /// Draws both paths, how far they are apart along the way, and their feeds.
    #[arg(long, value_name = "FILE", value_parser = file())]
    svg: Option<PathArg>,
}

/// What need not be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Ignored {
    /// Which coolant flows, and whether.
    Coolant,
    /// Numbers, names and registers of tools.
    Tools,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &DiffArguments) -> Result<(), Failure> {
    let request = arguments.request();
    let compared = diff::compare(session, &request)?;
    let DiffResult { sides, rules, found, along, findings } = &compared;
    let names = sides.each_ref().map(|side| side.program.name.as_str());
    let machines = sides.each_ref().map(|side| side.control.machine.name.as_str());
    let picture = diff_picture::draw(names, found, along);
    let json = files::json(found);
    let mut texts = Vec::new();
    if let Some(target) = &arguments.json {
        texts.push((Role::JSON, target, json.as_str()));
    }
    if let Some(target) = &arguments.svg {
        texts.push((Role::PICTURE, target, picture.as_str()));
    }
    let mut targets: Vec<(Role, &PathArg)> =
        texts.iter().map(|(role, target, _)| (*role, *target)).collect();
    targets.extend(arguments.report.0.report.iter().map(|page| (Role::REPORT, page)));
    let mut written = AtomicFile::create(session, &targets)?;
    for (file, (_, _, text)) in written.iter_mut().zip(&texts) {
        file.write_bytes(text.as_bytes())?;
    }
    if let (Some(_), Some(page)) = (&arguments.report.0.report, written.last_mut()) {
        let names = request.programs.each_ref();
        compared.write_page(session, names, arguments.report.0.most(), page)?;
    }
    let taken = written.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, written)?;
    session.findings(findings);
    let text = diff_text::text(names, machines, rules, found);
    terminal::print_beside(session, &text, taken);
    match found.same {
        true => Ok(()),
        false => Err(Failure::Different),
    }
}

impl DiffArguments {
    fn request(&self) -> DiffRequest {
        DiffRequest {
            programs: [self.old.clone(), self.new.clone()],
            settings: [self.program.settings(), self.of_new()],
            other_machine: self.machine_new.is_some(),
            tolerances: DiffTolerances {
                tip: self.tolerance,
                axis: self.axis_tolerance.to_radians(),
                feed: self.feed_tolerance / 100.0,
            },
            any_coolant: self.ignore.contains(&Ignored::Coolant),
            any_tool: self.ignore.contains(&Ignored::Tools),
            cuts: self.cuts,
        }
    }

    /// The flags of the new program.
    fn of_new(&self) -> ProgramSettings {
        let mut program = self.program.settings();
        if let Some(machine) = &self.machine_new {
            program.machine.clone_from(machine);
            // What was set is a key of the other machine, and its dialect the other's.
            program.set.clear();
            program.dialect = None;
            program.mount = None;
        }
        program.offsets = self.offsets_new.clone().or(program.offsets);
        program.dialect = self.dialect_new.clone().or(program.dialect);
        program.tool_length = self.tool_length_new.or(program.tool_length);
        program.mount = self.mount_new.or(program.mount);
        program
    }
}
