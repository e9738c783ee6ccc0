//! An NC program of whatever origin is looked over: what is wrong, or likely to be, for whom has no CL file.
//!
//! | file | looks for, or tells |
//! |---|---|
//! | `watch` | spindle, coolant, tool length, feed and arcs at each motion |
//! | `depths` | rapids that go lower than anything was cut before |
//! | `passes` | rapids that go on as the cuts beside them do, and contours that begin with a rapid |
//! | `stray` | points far beside their neighbours |
//! | `summary`, `sarif` | what was found, for programs to read |

mod depths;
mod passes;
mod sarif;
mod stray;
mod summary;
mod watch;

use std::io::Seek as _;

use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Severity, SourcePlace};
use post_readback::interpret::ReadReport;
use post_readback::{BlockEffect, MOST_FAULTS, ProgramRun};

use crate::cl_facts::ClFacts;
use crate::clearance::{self, ClearanceFound, PairRow};
use crate::failure::Failure;
use crate::files::FileFault;
use crate::nc_program::{self, NcControl, ProgramText};
use crate::predict::cycle_time;
use crate::read::ProgramSurvey;
use crate::read::beyond_travel::BeyondTravel;
use crate::read_back::lines_of;
use crate::unsaid::Unsaid;
use depths::CutDepths;
use watch::LintWatch;

pub use sarif::{CodeText, sarif};
pub use summary::{FindingSummary, LintSummary};

/// One rapid of so many has a feed beside it by mistake; where more have, the post-processor writes it so.
const FEW: u64 = 3;

/// What was found of a program.
pub struct LintedProgram<'m> {
    /// What is wrong with it, and what may be: in the order of its lines.
    pub findings: Vec<Diagnostic>,
    /// Codes of findings that are not told, and how many of each there were.
    pub ignored: Vec<(&'static str, u64)>,
    /// What the program did.
    pub survey: ProgramSurvey<'m>,
    /// What was read.
    pub report: ReadReport,
    /// Each of its blocks was understood.
    pub whole: bool,
    /// How long it takes, s, where that was predicted.
    pub predicted: Option<f64>,
}

impl LintedProgram<'_> {
    /// Time at the feeds that the program states, of rapids at the largest feeds of the axes, and of waits, s.
    pub fn seconds(&self) -> f64 {
        60.0 * self.survey.minutes.iter().sum::<f64>() + self.survey.waits
    }

    /// Something is wrong; where it is `strict`, or may be.
    pub fn is_wrong(&self, strict: bool) -> bool {
        self.findings.iter().any(|finding| strict || finding.severity == Severity::Error)
    }

    /// Predicts how long the program `name` in `text` takes, if each of its blocks was understood; why that is not known
    /// is a warning, unless its code is `ignored`.
    ///
    /// # Errors
    /// The program cannot be read again.
    pub fn predict(
        &mut self,
        control: &NcControl,
        name: &str,
        mut text: ProgramText<'_>,
        ignored: &[String],
    ) -> Result<(), Failure> {
        if !self.whole {
            return Ok(());
        }
        let why = match cycle_time(control, name, Box::new(&mut text)) {
            Ok(seconds) => {
                self.predicted = seconds;
                return Ok(());
            }
            // It was read to its end before: what fails now is the disk, or the run shall end.
            Err(Failure::Refused(why)) if why.iter().all(|why| why.code != "nc-file") => why,
            Err(failure) => return Err(failure),
        };
        let unreadable = |error| FileFault::Read { name: name.to_owned(), error };
        text.rewind().map_err(unreadable)?;
        let Some(why) = why.into_iter().next() else { return Ok(()) };
        if is_ignored(&control.machine, ignored, why.code) {
            match self.ignored.iter_mut().find(|(code, _)| *code == why.code) {
                Some((_, count)) => *count += 1,
                None => self.ignored.push((why.code, 1)),
            }
            return Ok(());
        }
        let message = format!("how long it takes is not predicted: {}", why.message);
        self.findings.push(Diagnostic { severity: Severity::Warning, message, ..why });
        in_order(&mut self.findings);
        show_lines(&mut self.findings, name, &mut text).map_err(unreadable)?;
        Ok(())
    }
}

/// Findings of a code are not told of programs of a machine.
fn is_ignored(machine: &Machine, ignored: &[String], code: &str) -> bool {
    ignored.iter().chain(&machine.lint_ignored).any(|ignored| ignored == code)
}

/// The findings by their lines.
fn in_order(findings: &mut [Diagnostic]) {
    findings.sort_by_key(|finding| finding.place.as_ref().map_or(0, |place| place.line));
}

/// Looks over the program `name` in `text`; findings of the codes in `ignored`, and of those that the machine file names,
/// are only counted.
///
/// # Errors
/// The program cannot be read again, or the machine cannot be solved.
pub fn look_over<'m>(
    control: &'m NcControl,
    finder: &Finder,
    name: &str,
    mut text: ProgramText<'_>,
    ignored: &[String],
) -> Result<LintedProgram<'m>, Failure> {
    let machine = &control.machine;
    let unreadable = |error| FileFault::Read { name: name.to_owned(), error };
    let clear = match clearance::is_described(machine) {
        true => {
            let text = Box::new(&mut text);
            Some(clearance::prove(control, name, text, &ClFacts::default(), None)?)
        }
        false => None,
    };
    let undrawn = clear.as_ref().and_then(|clear| undrawn(machine, clear));
    // What no two bodies tell is not known, and no fault of the program.
    let clear = clear.filter(|clear| !clear.pairs.is_empty());
    let mut before: Vec<Diagnostic> = Vec::new();
    let depths = match clear.as_ref().is_some_and(|clear| clear.pairs.iter().any(PairRow::is_cut)) {
        // Bodies tell it better.
        true => None,
        false => {
            let mut depths = CutDepths::default();
            text.rewind().map_err(unreadable)?;
            let gather = |done: Option<&BlockEffect>| done.map_or((), |done| depths.gather(done));
            before = run(control, name, &mut text, gather)?.faults;
            Some(depths)
        }
    };
    text.rewind().map_err(unreadable)?;
    let mut watch = LintWatch::new(control, depths);
    let mut beyond = BeyondTravel::new(machine);
    let mut survey = ProgramSurvey::new(machine);
    let ran = run(control, name, &mut text, |done| {
        let Some(done) = done else {
            return watch.miss();
        };
        watch.take(done);
        beyond.take(machine, done);
        survey.take(done);
    })?;
    let RanProgram { report, faults, last_line } = ran;
    if let Some(cut) = watch.unfed() {
        let places = faults.iter().filter_map(|fault| fault.place.as_ref());
        let ahead = places.map(|place| place.line).filter(|line| *line < cut).collect();
        text.rewind().map_err(unreadable)?;
        let missed = lines_of(&mut text, ahead).map_err(unreadable)?;
        if !missed.iter().any(|(_, line)| line.contains(['F', 'f'])) {
            watch.tell_unfed();
        }
    }
    let whole = faults.is_empty();
    // Of what is no program nothing is left out: nothing would be wrong with it.
    let foreign = report.blocks <= faults.len() as u64;
    let mut found = faults;
    found.extend(report.notes.iter().cloned());
    let unsaid = Unsaid { name, report: &report, spoken: &control.spoken, own: false, last_line };
    found.extend(unsaid.findings(finder, machine));
    found.extend(unsaid.change());
    found.extend(unsaid.left_in_force());
    found.extend(nc_program::unknown_words(name, &report, machine));
    found.extend(beyond.findings(name));
    found.extend(beyond.part_place(machine, name));
    found.extend(watch.finish(name, &report));
    // Where G0 goes at F each may have one.
    if control.spoken.rapid_feed.is_none() {
        found.extend(fed_rapid(name, &report, &survey));
    }
    found.extend(undrawn);
    before.extend(clear.map(|clear| clear.findings).unwrap_or_default());
    // What cannot be read of it was told, but for a disk that fails in one of the passes.
    let told = found.len();
    before.retain(|finding| !found[..told].contains(finding));
    found.append(&mut before);
    let (findings, ignored) = left_out(found, |finding| {
        let kept = foreign && finding.severity == Severity::Error;
        !kept && is_ignored(machine, ignored, finding.code)
    });
    let mut findings = told_once(findings);
    in_order(&mut findings);
    text.rewind().map_err(unreadable)?;
    show_lines(&mut findings, name, &mut text).map_err(unreadable)?;
    Ok(LintedProgram { findings, ignored, survey, report, whole, predicted: None })
}

/// The findings whose codes are not ignored, and how many there are of each code that is.
fn left_out(
    found: Vec<Diagnostic>,
    is_ignored: impl Fn(&Diagnostic) -> bool,
) -> (Vec<Diagnostic>, Vec<(&'static str, u64)>) {
    let (left_out, findings): (Vec<_>, Vec<_>) = found.into_iter().partition(is_ignored);
    let mut counts: Vec<(&'static str, u64)> = Vec::new();
    for finding in left_out {
        match counts.iter_mut().find(|(code, _)| *code == finding.code) {
            Some((_, count)) => *count += 1,
            None => counts.push((finding.code, 1)),
        }
    }
    (findings, counts)
}

/// Of cutters that are not drawn nothing is proven against the stock.
fn undrawn(machine: &Machine, clear: &ClearanceFound) -> Option<Diagnostic> {
    let lacks = clear.lacks.iter().filter(|lacks| lacks.starts_with("cutter "));
    let cutters: Vec<&str> = lacks.map(String::as_str).collect();
    let held = clear.pairs.iter().any(PairRow::is_cut);
    if machine.stocks.is_empty() || cutters.is_empty() && held {
        return None;
    }
    let which = match cutters.is_empty() {
        true => String::new(),
        false => format!(": {}", cutters.join(", ")),
    };
    let message = match held {
        true => {
            format!("no rapid is proven against the stock of cutters that are not drawn{which}")
        }
        false => format!(
            "no rapid is proven against the stock, as no cutter is drawn, and where none may go is guessed{which}"
        ),
    };
    let help = "cutter = [[z, r], …] under [tools.N] of the machine file";
    Some(Diagnostic::warning("clearance-body", message).help(help))
}

/// A rapid in whose block a feed stands, where few have one.
fn fed_rapid(name: &str, report: &ReadReport, survey: &ProgramSurvey<'_>) -> Option<Diagnostic> {
    let (line, count) = report.fed_rapids?;
    if count * FEW > survey.motions[0] {
        return None;
    }
    let message = match count {
        1 => "a rapid says a feed, and others say none: is it a cut?".to_owned(),
        count => format!("{count} rapids say a feed, and others say none: are they cuts?"),
    };
    let place = Some(SourcePlace::new(name, line, "", 0..0));
    Some(Diagnostic::warning("rapid", message).help("G1 where something is cut").at(place))
}

/// The findings, those that say the same as one that names the first of them.
fn told_once(findings: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut once: Vec<(Diagnostic, u64)> = Vec::new();
    for finding in findings {
        let same = |(known, _): &&mut (Diagnostic, u64)| {
            known.code == finding.code && known.message == finding.message
        };
        match once.iter_mut().find(same) {
            Some((_, count)) => *count += 1,
            None => once.push((finding, 1)),
        }
    }
    let told = once.into_iter().map(|(mut finding, count)| {
        if count > 1 {
            finding.message.push_str(&format!("; so in {count} blocks"));
        }
        finding
    });
    told.collect()
}

/// A program that was run to its end.
struct RanProgram {
    report: ReadReport,
    /// What of it cannot be understood.
    faults: Vec<Diagnostic>,
    /// Its last line; none where it was given up.
    last_line: Option<u64>,
}

/// Runs the program `name` from its beginning, past what cannot be understood; `take` is told what it does, and nothing of
/// a block that is not understood.
fn run(
    control: &NcControl,
    name: &str,
    text: &mut ProgramText<'_>,
    mut take: impl FnMut(Option<&BlockEffect>),
) -> Result<RanProgram, Failure> {
    let mut run = ProgramRun::new(control.program_with_rapids(name, Box::new(text))?);
    let mut missed = 0;
    while let Some(done) = run.block() {
        done.iter().for_each(|done| take(Some(done)));
        if std::mem::replace(&mut missed, run.faults().len()) < run.faults().len() {
            take(None);
        }
    }
    let program = run.program().program();
    let (report, (line, _)) = (program.report().clone(), program.stand());
    let mut faults = run.into_faults();
    let given_up = faults.len() == MOST_FAULTS;
    if given_up {
        faults.push(nc_program::given_up());
    }
    Ok(RanProgram { report, faults, last_line: (!given_up).then_some(line) })
}

/// Puts the texts of the lines into findings that have none.
fn show_lines(
    findings: &mut [Diagnostic],
    name: &str,
    text: &mut ProgramText<'_>,
) -> std::io::Result<()> {
    let places = findings.iter_mut().filter_map(|finding| finding.place.as_mut());
    let mut bare: Vec<&mut SourcePlace> =
        places.filter(|place| place.file == name && place.text.is_empty()).collect();
    let texts = lines_of(text, bare.iter().map(|place| place.line).collect())?;
    for place in &mut bare {
        if let Ok(at) = texts.binary_search_by_key(&place.line, |(line, _)| *line) {
            let text = &texts[at].1;
            **place = SourcePlace::new(name, place.line, text, 0..text.len());
        }
    }
    Ok(())
}
