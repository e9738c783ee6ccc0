//! A program of a machine's control held against a CL file, for whoever asks.

use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::Arc;
use std::thread;

use post_host::Finder;
use post_machine::axis_words::unit_length;
use post_machine::description::{InverseTime, Machine, Rapid, TextPlace};
use post_machine::diagnostic::{Diagnostic, Severity, SourceFiles, SourcePlace};
use post_plugin::{Lengths, Meaning};
use post_posting::program::{DefaultSpindle, UnknownWordPolicy};
use post_readback::course::cl::{ClCourse, ClSettings, ClTool};
use post_readback::course::{Course, CourseWindow};
use post_readback::interpret::Limits;
use post_readback::verify::{
    BlockReport, CutBounds, CutPath, OwnStops, Verification, Verifier, VerifyRules,
};
use post_readback::{BlockEffect, MOST_FAULTS, Offsets, ProgramRun};

use super::nc_program::{self, DialectVocabulary, NcControl};
use super::plugin_finder;
use super::unsaid::Unsaid;
use crate::beside::Work;
use crate::blocks_ahead::{RunBlocks, TOGETHER};
use crate::failure::Failure;
use crate::files::{ClInput, ClSource, FileFault, ReadPosition, Watched};
use crate::nc_program::{ProgramText, RunningProgram};
use crate::session::Session;
use crate::settings::{JobSettings, Msys};

/// What a program is read with.
pub struct ReadingSetup<'a> {
    /// The run.
    pub session: &'a Session,
    /// What the job is.
    pub arguments: &'a JobSettings,
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// Its plugins.
    pub finder: &'a Finder,
    /// What stands in the control's tables; none: as the machine file, the command line and the CL file say.
    pub offsets: Option<Offsets>,
    /// What a program may ask for.
    pub limits: Limits,
    /// Largest deviations that are other than the machine file's: mm, radians.
    pub tolerances: [Option<f64>; 2],
    /// The feed was planned: it may be below that of the CL file.
    pub planned: bool,
    /// Which coolant flows is the program's own business.
    pub any_coolant: bool,
    /// Which work offset it cuts in, where the CL file names none, is the program's own business.
    pub any_work_offset: bool,
    /// The program was posted for this machine file, in this run.
    pub own: bool,
    /// Each line is told with the solution of the machine that it ends in.
    pub solutions: bool,
    /// Lines of the CL file that the program is made of; none: all.
    pub lines: Option<Vec<Range<u64>>>,
    /// Threads that it is read on at most.
    pub threads: NonZeroUsize,
}

impl ReadingSetup<'_> {
    /// The program is run on a thread beside this one.
    fn runs_beside(&self) -> bool {
        self.threads > NonZeroUsize::MIN
    }

    /// The control that runs the program; `tools` are those of the CL file.
    ///
    /// # Errors
    /// The dialect cannot be opened, or tells no vocabulary.
    pub fn control(&self, tools: &[ClTool]) -> Result<NcControl, Failure> {
        let spoken = nc_program::spoken(self.finder, self.machine)?;
        let offsets = match &self.offsets {
            Some(offsets) => Offsets {
                // Of tools whose length stands in no table.
                length: offsets.length.or(self.arguments.over.tool_length),
                ..offsets.clone()
            },
            None => offsets(self.arguments, self.machine, tools),
        };
        Ok(NcControl::of(self.machine, spoken, offsets, self.limits))
    }
}

/// What came of it.
pub struct VerifiedProgram {
    /// What was found.
    pub found: Verification,
    /// Of all that is wrong a message: faults at lines of the program, what could not be read of either side; and what was
    /// taken for granted.
    pub findings: Vec<Diagnostic>,
    /// Blocks that were run.
    pub blocks: u64,
    /// The files that it was held against.
    pub files: SourceFiles,
}

impl VerifiedProgram {
    /// The program does not do what it should, or that is not known.
    pub fn is_wrong(&self) -> bool {
        let mut findings = self.findings.iter();
        findings.any(|finding| finding.severity == Severity::Error)
    }
}

/// The work offset that posting writes where the CL file names none: the dialect's option, as the machine file has it or as
/// it is by default. None where lines of the machine file name one, its words of CL files may, or the operator chooses it.
fn work_offset(finder: &Finder, machine: &Machine, spoken: &DialectVocabulary) -> Option<String> {
    let offsets = spoken.words.iter().filter(|word| word.meaning == Meaning::WorkOffset);
    let offsets: Vec<&str> = offsets.map(|word| word.word.as_ref()).collect();
    let mut lines = machine.program.own_words();
    if !machine.word_rules.is_empty() || lines.any(|word| offsets.contains(&word.as_str())) {
        return None;
    }
    plugin_finder::work_offset(finder, machine)
}

/// How the CL file is meant, as posting was told.
pub fn course_settings(arguments: &JobSettings, machine: &Machine, input: &ClInput) -> ClSettings {
    ClSettings {
        units: arguments.reading.units,
        apply_msys: arguments.reading.msys == Msys::Apply,
        tool: arguments.reading.tool,
        tool_from_cutter: arguments.reading.tool_from_cutter,
        feed: arguments.reading.feed,
        spindle: match arguments.reading.spindle {
            Some(DefaultSpindle::On(rpm)) => Some(rpm),
            _ => None,
        },
        allowed: arguments.reading.allow.clone(),
        unknown_left_out: matches!(
            arguments.reading.unknown,
            UnknownWordPolicy::Warn | UnknownWordPolicy::Pass
        ),
        further: Arc::clone(&input.further),
        ..ClSettings::of(machine, &input.name)
    }
}

/// What stands in the control's tables as posting counts: `--tool-length`, else the machine file, else the CL file.
pub fn offsets(arguments: &JobSettings, machine: &Machine, tools: &[ClTool]) -> Offsets {
    let mut offsets = Offsets { length: arguments.over.tool_length, ..Offsets::default() };
    if arguments.over.tool_length.is_some() {
        return offsets;
    }
    if machine.tool_table.as_ref().is_some_and(|file| file.by_register) {
        offsets.lengths.clone_from(&machine.tools);
        for tool in tools {
            let held = machine.tools.iter().find(|(register, _)| *register == tool.register);
            offsets.tools.extend(held.map(|(_, length)| (tool.number, *length)));
        }
        return offsets;
    }
    for (number, length) in &machine.tools {
        let known = tools.iter().find(|tool| tool.number == *number);
        let register = known.map_or(*number, |tool| tool.register);
        offsets.tools.push((*number, *length));
        offsets.lengths.push((register, *length));
    }
    for tool in tools {
        let told = machine.tools.iter().any(|(number, _)| *number == tool.number);
        if let (Some(length), false) = (tool.length, told) {
            offsets.tools.push((tool.number, length));
            offsets.lengths.push((tool.register, length));
        }
    }
    offsets
}

/// The last place of a feed a minute, mm/min.
fn feed_place(machine: &Machine, decimals: u8) -> f64 {
    unit_length(machine.control.units) * libm::pow(0.1, f64::from(decimals))
}

/// The last place of an F by time, 1/min; zero where the dialect writes none.
fn time_place(machine: &Machine, decimals: Option<u8>) -> f64 {
    let unit = match machine.control.inverse_time {
        InverseTime::Minutes => 1.0,
        InverseTime::Seconds => 60.0,
    };
    decimals.map_or(0.0, |decimals| unit * libm::pow(0.1, f64::from(decimals)))
}

/// Holds the program `name` from `input` against the CL file.
///
/// # Errors
/// A file that cannot be read, or a machine or dialect that cannot be used.
pub fn verify(
    reading: &ReadingSetup<'_>,
    source: &mut ClSource,
    name: &str,
    input: ProgramText<'_>,
    watch: &mut dyn VerifyWatch,
) -> Result<VerifiedProgram, Failure> {
    let ReadingSetup { arguments, machine, .. } = reading;
    // What the tools are called and how long they are stands anywhere in the CL file.
    let first = source.open()?;
    let files = first.files();
    let settings = course_settings(arguments, machine, &first);
    let mut course = ClCourse::new(settings.clone(), first.bytes);
    let along = machine.control_point.along;
    let (bounds, mut findings) = CutBounds::of(&mut course, along);
    let tools = course.tools().to_vec();
    let own_lines = course.own_lines().map(str::to_owned).collect();
    let again = ClCourse::new(settings.clone(), source.open_beside()?.bytes);
    let course = ClCourse::new(settings, source.open()?.bytes);
    let against = VerifyReference {
        course: CourseWindow::new(course, reading.lines.clone()),
        files,
        tools,
        own_lines,
        cut_path: Some(CutPath::when_asked(bounds, Box::new(again), along)),
    };
    let held = hold(reading, against, name, input, watch)?;
    // It is read more than once: what another pass tells too, and what it alone has met, such as a disk that fails.
    let told = findings.len();
    let news = held.findings.into_iter().filter(|finding| !findings[..told].contains(finding));
    let news: Vec<Diagnostic> = news.collect();
    findings.extend(news);
    Ok(VerifiedProgram { findings, ..held })
}

/// Who looks on while a program is held against a course.
pub trait VerifyWatch {
    /// What the program did next, before it is judged.
    fn done(&mut self, _done: &BlockEffect) {}

    /// Lines are told with their deviations; else they may be told without.
    fn wants_lines(&self) -> bool {
        true
    }

    /// A line of the program is judged; all that it did was told before.
    fn line(&mut self, line: &BlockReport);

    /// The program strays too often, and nothing more of it is judged: whether it is to be run on all the same.
    fn runs_on(&mut self) -> bool {
        false
    }
}

/// Nobody looks on.
pub struct Unwatched;

impl VerifyWatch for Unwatched {
    fn wants_lines(&self) -> bool {
        false
    }

    fn line(&mut self, _line: &BlockReport) {}
}

impl<F: FnMut(&BlockReport)> VerifyWatch for F {
    fn line(&mut self, line: &BlockReport) {
        self(line);
    }
}

/// What a program is held against.
pub struct VerifyReference<C> {
    /// The path.
    pub course: C,
    /// The files that it comes from, as messages call them.
    pub files: SourceFiles,
    /// Its tools.
    pub tools: Vec<ClTool>,
    /// Its texts that are lines of the program.
    pub own_lines: Vec<String>,
    /// Where all of it cuts, for how near rapids come; none: nothing is said of that.
    pub cut_path: Option<CutPath>,
}

/// A program that is run from its beginning.
struct RunFromStart<'i> {
    blocks: ProgramRun<RunningProgram<'i>>,
    /// The byte that is read next, and how many there are.
    position: ReadPosition,
    length: u64,
}

impl<'i> RunFromStart<'i> {
    /// The program as far as it was run.
    fn into_blocks(self) -> ProgramRun<RunningProgram<'i>> {
        self.blocks
    }
}

/// The program `name` in `input`, from its beginning.
fn running<'i>(
    control: &NcControl,
    name: &str,
    input: &'i mut ProgramText<'_>,
) -> Result<RunFromStart<'i>, Failure> {
    let watched = Watched::new(input);
    let (watched, length) =
        watched.map_err(|error| FileFault::Read { name: name.to_owned(), error })?;
    let position = watched.position();
    let blocks = control.run(name, BufReader::new(watched)).map_err(|fault| *fault)?;
    Ok(RunFromStart { blocks, position, length })
}

/// Holds the program `name` from `input` against any course.
///
/// # Errors
/// A file that cannot be read, or a machine or dialect that cannot be used.
pub fn hold<C: Course>(
    reading: &ReadingSetup<'_>,
    against: VerifyReference<C>,
    name: &str,
    mut input: ProgramText<'_>,
    watch: &mut dyn VerifyWatch,
) -> Result<VerifiedProgram, Failure> {
    let machine = reading.machine;
    let VerifyReference { course, files, tools, own_lines, cut_path } = against;
    let mut control = reading.control(&tools)?;
    control.own_lines = own_lines;
    let rules = VerifyRules {
        rows: watch.wants_lines(),
        files: files.clone(),
        ..rules(reading, &control, &tools)
    };
    let own = rules.own;
    let mut verifier = Verifier::new(&control.machine, rules, course);
    if let Some(cut_path) = cut_path {
        verifier = verifier.near(cut_path);
    }
    let unreadable = |error| FileFault::Read { name: name.to_owned(), error };
    let mut blocks = 0;
    let mut run = running(&control, name, &mut input)?;
    thread::scope(|scope| {
        let mut work =
            Work::start(scope, &mut run.blocks, reading.runs_beside().then_some(TOGETHER));
        let mut progress = reading.session.progress(Some(run.length));
        let mut batch = RunBlocks::default();
        while !verifier.found().gave_up && work.next(&mut batch) {
            reading.session.go_on().map_err(unreadable)?;
            for done in batch.iter() {
                progress.record(|| run.position.get());
                blocks += 1;
                for done in done {
                    watch.done(done);
                    verifier.take(done, &mut |line| watch.line(line));
                }
                if verifier.found().gave_up {
                    break;
                }
            }
        }
        progress.finish();
        Ok::<(), FileFault>(())
    })?;
    if verifier.found().gave_up && reading.runs_beside() {
        // It was run farther than it was judged.
        drop(run);
        run = running(&control, name, &mut input)?;
        while blocks > 0 && run.blocks.block().is_some() {
            blocks -= 1;
        }
    }
    let mut run = run.into_blocks();
    let mut findings = run.faults().to_vec();
    let report = run.program().report();
    findings.extend(report.notes.iter().cloned());
    let whole = !verifier.found().gave_up && run.faults().len() < MOST_FAULTS;
    let unsaid = Unsaid {
        name,
        report,
        spoken: &control.spoken,
        own,
        last_line: whole.then(|| run.program().stand().0),
    };
    findings.extend(unsaid.findings(reading.finder, machine));
    findings.extend(nc_program::unknown_words(name, report, machine));
    let blocks = report.blocks;
    let found = verifier.finish(&mut |line| watch.line(line));
    if found.gave_up && watch.runs_on() {
        while let Some(done) = run.block() {
            done.iter().for_each(|done| watch.done(done));
        }
    }
    drop(run);
    findings.extend(found.course_faults.iter().cloned());
    findings.extend(noticed(name, &found));
    let wanted = found.faults.iter().filter_map(|fault| fault.nc_line).collect();
    let texts = lines_of(&mut input, wanted).map_err(unreadable)?;
    for fault in &found.faults {
        let text = fault.nc_line.and_then(|line| texts.iter().find(|(known, _)| *known == line));
        let text = text.map_or("", |(_, text)| text.as_str());
        findings.push(fault.diagnostic(name, text, &files));
    }
    Ok(VerifiedProgram { found, findings, blocks, files })
}

/// What of the program `name` is worth a look, without being wrong.
fn noticed(name: &str, found: &Verification) -> Vec<Diagnostic> {
    let counted = |message: &str, count: u64| match count {
        1 => message.to_owned(),
        count => format!("{message}; so in {count} places"),
    };
    let at = |line| Some(SourcePlace::new(name, line, "", 0..0));
    let near = found.nearest_rapid.iter().map(|(line, message)| {
        Diagnostic::warning("rapid", counted(message, found.near_rapids)).at(at(*line))
    });
    let left = found.left_on.iter().map(|left| {
        Diagnostic::warning(left.code, counted(&left.message, left.count)).at(at(left.line))
    });
    near.chain(left).chain(found.part_place.clone()).collect()
}

/// Stops and waits in lines of the user's own.
fn own_stops(machine: &Machine, control: &NcControl) -> OwnStops {
    let mut own = OwnStops::default();
    let lines = control.own_lines.iter().flat_map(|line| line.split_whitespace());
    let words = machine.program.own_words().chain(lines.map(str::to_uppercase));
    for word in words {
        match control.lexicon.meaning_of(&word) {
            Some(Meaning::Stop) => own.stop = true,
            Some(Meaning::OptionalStop) => own.optional = true,
            Some(Meaning::Dwell) => own.dwell = true,
            None if word == "STOP" => own.stop = true,
            _ => {}
        }
    }
    own
}

/// What a program is held to.
fn rules(reading: &ReadingSetup<'_>, control: &NcControl, tools: &[ClTool]) -> VerifyRules {
    let NcControl { machine, spoken, lexicon, offsets, .. } = control;
    let length_from = lexicon.lengths();
    let [tolerance, axis_tolerance] = reading.tolerances;
    let standard = VerifyRules::of(machine);
    VerifyRules {
        tolerance: tolerance.unwrap_or(standard.tolerance),
        axis_tolerance: axis_tolerance.unwrap_or(standard.axis_tolerance),
        length_from,
        work_offsets: reading.offsets.as_ref().is_some_and(|offsets| !offsets.work.is_empty()),
        // What stands in the control's tables is one thing, how long the tools are another.
        lengths: (length_from != Lengths::WorkOffset).then(|| {
            match reading.arguments.over.tool_length {
                Some(length) => Offsets { length: Some(length), ..Offsets::default() },
                None => offsets.clone(),
            }
        }),
        radius_registers: lexicon.has_radius_registers(),
        work_offset: match reading.any_work_offset {
            true => None,
            false => work_offset(reading.finder, machine, spoken),
        },
        first_preset: plugin_finder::integer(reading.finder, machine, "preset")
            .and_then(|row| u32::try_from(row).ok())
            .map_or(1, |row| row.max(1)),
        solutions: reading.solutions,
        planned: reading.planned,
        coolants: !reading.any_coolant,
        // A retract by lines of the user's own leads where they say.
        own: reading.own && machine.program.text(TextPlace::Retract).is_none(),
        own_stops: own_stops(machine, control),
        feed_place: feed_place(machine, spoken.feed_decimals),
        rapid_feed: spoken.rapid_feed.map(|feed| feed * unit_length(machine.control.units)),
        time_place: time_place(machine, spoken.inverse_time_decimals),
        linear_rapids: machine.rapid(spoken.rapids_pass()) == Rapid::Linear,
        least_minutes: spoken.most_inverse_time.map_or(0.0, |most| 1.0 / most),
        tool_registers: tools.iter().map(|tool| (tool.number, tool.register)).collect(),
        ..standard
    }
}

/// The texts of the lines that are wanted, in their order.
pub(crate) fn lines_of(
    input: &mut (impl Read + Seek),
    mut wanted: Vec<u64>,
) -> std::io::Result<Vec<(u64, String)>> {
    wanted.sort_unstable();
    wanted.dedup();
    let Some(last) = wanted.last().copied() else {
        return Ok(Vec::new());
    };
    input.seek(SeekFrom::Start(0))?;
    let mut input = BufReader::new(input);
    let mut texts = Vec::new();
    let mut bytes = Vec::new();
    for line in 1..=last {
        bytes.clear();
        if input.read_until(b'\n', &mut bytes)? == 0 {
            break;
        }
        if wanted.binary_search(&line).is_ok() {
            let text = String::from_utf8_lossy(&bytes);
            texts.push((line, text.trim_end().to_owned()));
        }
    }
    Ok(texts)
}
