//! `post convert`: an NC program moved to another machine.

use std::path::PathBuf;

use clap::Args;
use post_machine::description::{Machine, Setting, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_posting::program::DefaultSpindle;
use post_posting::report::PostingReport;
use post_readback::course::CourseFacts;
use post_readback::course::cl::{ClCourse, ClSettings};
use post_readback::course::program::{Chords, ProgramCourse};
use post_readback::interpret::Limits;
use post_readback::verify::{BlockReport, CutPath};

use crate::arguments::Flags;
use crate::arguments::flag_values::file;
use crate::arguments::flag_values::{
    TcpWord, feed, length, point, positive, setting, spindle, word,
};
use crate::terminal;
use post_job::failure::Failure;
use post_job::files::{AtomicFile, ClSource, PathArg, Role};
use post_job::nc_program::{self, NcControl};
use post_job::nc_to_cl::{self, Tools};
use post_job::one_program::{Beside, OneProgram};
use post_job::read_back::{self, Against, Held, Reading};
use post_job::report::{self, BlockRows, ClWindow, Made};
use post_job::session::Session;
use post_job::settings::{
    JobSettings, MachineSettings, ProgramSettings, ReadingSettings, ReportSettings,
};
use post_job::text::{clock, number, table};
use post_job::{self as job, plugin_finder};

/// Moves an NC program to another machine.
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

    /// No summary, warnings and errors alone.
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

    /// Who keeps the tip on its path on the second machine.
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

/// Of the tolerance so much is left for the CL file's chords: the rest is what posting may use.
const CHORDS: f64 = 0.1;

/// The path that the new program is held against has chords so much finer than the CL file's.
const FINER: f64 = 0.1;

/// Converts as the arguments say.
pub fn run(session: &Session, arguments: &ConvertArguments) -> Result<(), Failure> {
    let from = NcControl::new(session, &arguments.first())?;
    let (name, input) = nc_program::open(session, &arguments.input)?;
    let run = || from.program_with_rapids(&name, &input);
    let job = arguments.second();
    let asked = job::machine(session, &job, &[])?;
    for machine in [&from.machine, &asked] {
        if machine.turn != 0.0 {
            let message = format!(
                "on {} the part sits turned by {}° about its Z: the paths of the two programs have no frame in common",
                machine.name,
                number(machine.turn.to_degrees(), 3)
            );
            return Err(Diagnostic::error("convert", message)
                .help("--from-set workpiece.turn=0 or --set workpiece.turn=0, and the part clamped along the machine's axes")
                .into());
        }
    }
    let [tolerance, axis_tolerance] = [asked.accuracy.tolerance, asked.accuracy.axis_tolerance];
    let left = 1.0 - CHORDS;
    let more = [
        Setting::Tolerance(tolerance * left),
        Setting::Number {
            name: "accuracy.axis_tolerance".to_owned(),
            value: axis_tolerance.to_degrees() * left,
        },
    ];
    let machine = job::machine(session, &job, &more)?;
    let finder = plugin_finder::finder(session, &job.over.plugins)?;
    job::say_what_is_left(session, &job, &machine, &finder);

    let mut targets = vec![(Role::PROGRAM, &arguments.output)];
    targets.extend(arguments.cl.iter().map(|cl| (Role::CL, cl)));
    targets.extend(arguments.report.0.report.iter().map(|page| (Role::REPORT, page)));
    let mut files = AtomicFile::create(session, &targets)?;
    let page = arguments.report.0.report.as_ref().and_then(|_| files.pop());
    let (program, cl_file) = files.split_at_mut(1);
    let program = &mut program[0];

    let chords = Chords::within(tolerance * CHORDS, axis_tolerance * CHORDS);
    let part = arguments.input.stem().unwrap_or_default();
    let mut course = ProgramCourse::new(run()?, chords);
    let (mut source, written) = ClSource::of_text(session, format!("{name} as CL file"), |copy| {
        nc_to_cl::write(
            &mut course,
            &part,
            chords.tip,
            Tools { length: arguments.tool_length, edges: from.lexicon.tools_have_edges() },
            &mut |text| {
                copy(text)?;
                match cl_file.first_mut() {
                    Some(file) => file.write_bytes(text),
                    None => Ok(()),
                }
            },
        )
    })?;
    let mut notes = written.notes;
    notes.extend(nc_to_cl::fed(course.program().left()));
    notes.extend(course.program().program().report().notes.iter().cloned());
    if !written.faults.is_empty() {
        notes.extend(written.faults);
        return Err(notes.into());
    }

    let ahead = match machine.program.looks_ahead {
        true => Some(job::look_ahead(session, &job, &machine, &finder, &mut source, None)?),
        false => None,
    };
    let one = OneProgram {
        session,
        arguments: &job,
        machine: &machine,
        finder: &finder,
        target: &arguments.output,
        lines: None,
        trust_model: false,
        plans: false,
        tightening: None,
    };
    let mut rows = match page {
        Some(page) => {
            let input = source.open_beside()?;
            let settings = ClSettings::of(&machine, &input.name);
            let cl = ClWindow::new(&machine, settings, input.bytes)?;
            Some((page, BlockRows::new(&machine, cl, false)?))
        }
        None => None,
    };
    let mut beside = Beside::default();
    if let Some((_, rows)) = &mut rows {
        beside.observer = Some(rows);
    }
    let (report, findings) = one.write(ahead.as_ref(), &mut source, program, beside)?;
    notes.extend(findings);
    let Some(report) = report else {
        return Err(notes.into());
    };

    let finer = Chords { tip: chords.tip * FINER, axis: chords.axis * FINER, ..chords };
    let mut read = ClCourse::new(ClSettings::of(&machine, &name), source.open()?.bytes);
    let (facts, _) = CourseFacts::of(&mut read);
    let again = ClCourse::new(ClSettings::of(&machine, &name), source.open()?.bytes);
    let (cut_path, _) = CutPath::of(&mut { again }, machine.control_point.along);
    let against = Against {
        course: ProgramCourse::new(run()?, finer),
        name: name.clone(),
        tools: read.tools().to_vec(),
        cut_path: Some(cut_path),
    };
    let reading = Reading {
        session,
        arguments: &job,
        machine: &machine,
        finder: &finder,
        offsets: None,
        limits: Limits::default(),
        tolerances: [Some(tolerance), Some(axis_tolerance)],
        planned: false,
        solutions: false,
        any_coolant: false,
        any_work_offset: false,
        own: false,
        lines: None,
    };
    let told = program.name().to_owned();
    let text = program.reread()?;
    let held = read_back::hold(&reading, against, &told, text, &mut |_: &BlockReport| {})?;
    if held.is_wrong() {
        notes.extend(held.findings);
        return Err(notes.into());
    }
    notes.extend(held.findings.iter().cloned());
    if let Some((mut page, rows)) = rows {
        // The same job gives the same page wherever its files lie.
        let [name, target] = [&arguments.input, &arguments.output].map(report::name_of);
        let summed = summary(&name, &from.machine, (&machine, &target), &report, &held, &facts);
        let made = Made {
            session,
            machine: &machine,
            cl: format!("{} as CL file", report::name_of(&arguments.input)),
            program: &arguments.output,
            report: &report,
            verification: Some(&held.found),
            prediction: None,
            findings: &notes,
            job: "convert",
            facts: summed,
        };
        let (named, mut text) = (program.name().to_owned(), program.reread()?);
        made.write(
            (rows, None),
            (&mut source, &named, &mut text),
            arguments.report.0.most(),
            &mut page,
        )?;
        files.push(page);
    }
    let taken = files.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, files)?;
    session.findings(&notes);
    if !arguments.quiet {
        let text = summary(&name, &from.machine, (&machine, &told), &report, &held, &facts);
        let text = table(&text, 2);
        if taken {
            terminal::tell(&text);
        } else {
            terminal::print(session, &text);
        }
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
        }
    }
}

/// What was done, as a table.
fn summary(
    name: &str,
    from: &Machine,
    (to, target): (&Machine, &str),
    report: &PostingReport,
    held: &Held,
    facts: &CourseFacts,
) -> Vec<[String; 2]> {
    let found = &held.found;
    let mut rows: Vec<[String; 2]> = Vec::new();
    let mut row = |name: &str, value: String| rows.push([name.to_owned(), value]);
    row("from", format!("{name}, {} ({})", from.name, from.control.dialect));
    row("to", format!("{target}, {} ({})", to.name, to.control.dialect));
    row(
        "path",
        format!(
            "{} pieces at feed ({} arcs, {} splines), {} rapids, {} holes",
            facts.cuts, facts.arcs, facts.splines, facts.rapids, facts.holes
        ),
    );
    row("program", format!("{} blocks, {} points put in", report.blocks, report.points_added));
    row(
        "tip",
        format!(
            "within {} mm of the first program's path, tolerance {} mm",
            number(found.tip.value, 6),
            number(report.tolerance_mm / (1.0 - CHORDS), 6)
        ),
    );
    row("tool axis", format!("within {}°", number(found.axis.value, 5)));
    row("time", clock(report.time_s));
    rows
}
