//! Programs of a job: made, read back, predicted.

use std::num::NonZeroUsize;
use std::ops::Range;

use post_host::Finder;
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_plugin::DialectSession as _;
use post_posting::plan::PlanWatch;
use post_posting::report::PostingReport;
use post_posting::{Observer, ProgramPreview, TextSink};
use post_readback::interpret::Limits;
use post_readback::verify::Verification;

use crate::JobMachine;
use crate::clearance::{self, ClearanceFound, Heard, Hearer};
use crate::compensate::{self, ServoCompensation, ShiftedPath};
use crate::failure::Failure;
use crate::files::{AtomicFile, ClSource, FileFault, PathArg};
use crate::nc_program::{ProgramText, Reread};
use crate::one_program::OneProgram;
use crate::operations::ProgramLines;
use crate::plan_rounds;
use crate::plan_worth;
use crate::plugin_finder;
use crate::posting_pass::PostingExtras;
use crate::predict::{self, PredictReference, Predicted, Prediction, PredictionSetup, Sample};
use crate::program_digest::ProgramDigest;
use crate::read_back::{self, ReadingSetup, Unwatched, VerifiedProgram};
use crate::report::{
    self, BlockRows, ClWindow, ClearanceRows, PageTexts, PostPage, PredictedParts,
};
use crate::session::Session;
use crate::settings::{JobSettings, MakingSettings, ThreadSettings};
use crate::summary::{self, SummaryJson};
use crate::verify::VerifySummary;

/// What a job sets over the machine file so that its program is numbered so.
fn number_setting(
    session: &Session,
    arguments: &JobSettings,
    number: Option<i64>,
) -> Result<Option<Setting>, Failure> {
    let Some(number) = number else {
        return Ok(None);
    };
    let dialect = super::machine(session, arguments, &[])?.control.dialect;
    Ok(Some(Setting::Written(format!("control.{dialect}.program_number={number}"))))
}

/// The machine of the command line, its program so numbered if a number is given.
pub fn numbered(
    session: &Session,
    arguments: &JobSettings,
    number: Option<i64>,
) -> Result<Machine, Failure> {
    let setting = number_setting(session, arguments, number)?;
    super::machine(session, arguments, setting.as_slice())
}

/// Where a program goes: to `output`, else beside the CL file, with the ending of the machine or of its dialect.
///
/// # Errors
/// Its dialect cannot be opened.
pub fn target(
    arguments: &JobSettings,
    output: Option<&PathArg>,
    machine: &Machine,
    finder: &Finder,
) -> Result<PathArg, Failure> {
    let source = &arguments.input;
    let program = super::program_name(source, output);
    let (dialect, _) = plugin_finder::dialect(finder, machine, &program, Some(source))?;
    let extension = machine.program.extension.clone();
    let extension = extension.unwrap_or(dialect.format().extension.clone());
    let beside = || source.map(|path| path.with_extension(&extension));
    Ok(output.cloned().unwrap_or_else(beside))
}

/// One program of a run.
#[derive(Clone, Debug)]
pub struct ProgramPart {
    /// Lines of the CL file that it is made of; none: all.
    pub lines: Option<ProgramLines>,
    /// Where it goes.
    pub target: PathArg,
    /// The machine with its settings.
    pub machine: Machine,
}

impl ProgramPart {
    fn ranges(&self) -> Option<Vec<Range<u64>>> {
        self.lines.as_ref().map(|lines| lines.ranges.clone())
    }
}

/// The text of a program in the making, that can be read again.
pub trait ProgramSink: TextSink {
    /// What messages call it.
    fn name(&self) -> String;

    /// What was written, from its beginning; nothing more may be written then.
    ///
    /// # Errors
    /// It cannot be read.
    fn reread(&mut self) -> Result<Box<dyn Reread + '_>, Failure>;
}

/// The text of a program that is read again.
pub struct ProgramInput<'i> {
    /// The program, as messages call it.
    pub name: String,
    /// All of it, from its beginning.
    pub text: ProgramText<'i>,
}

impl ProgramSink for AtomicFile {
    fn name(&self) -> String {
        Self::name(self).to_owned()
    }

    fn reread(&mut self) -> Result<Box<dyn Reread + '_>, Failure> {
        Ok(Box::new(Self::reread(self)?))
    }
}

/// What is wanted of a program beside its text.
#[derive(Default)]
pub struct ProgramRequest<'w, 'o, 'p> {
    /// It is read back and held against the CL file.
    pub verify: bool,
    /// It is read back, and it is proven that nothing hits anything.
    pub clearance: bool,
    /// What it does is predicted.
    pub predict: bool,
    /// A summary tells of it, and names it by its length and hash; a page does so always.
    pub summary: bool,
    /// Sees its plan.
    pub watch: Option<&'w mut dyn PlanWatch>,
    /// Sees its blocks, if no page does.
    pub observer: Option<&'o mut dyn Observer>,
    /// A page to look at, and its largest size, bytes.
    pub page: Option<(&'p mut AtomicFile, u64)>,
}

/// What came of a program that is made.
pub struct ProgramOutcome {
    /// What making it came to.
    pub report: PostingReport,
    /// By what its text is known again, where something tells of it.
    pub program: Option<ProgramDigest>,
    /// Its points were moved for the servos.
    pub moved: bool,
    /// What planning in rounds has done.
    pub plan_rounds: Option<plan_rounds::PlanRoundsSummary>,
    /// What moving points for the servos has done.
    pub compensation: Option<compensate::CompensationSummary>,
    /// What reading it back found.
    pub verification: Option<Verification>,
    /// What was proven of it: nothing hits anything.
    pub clearance: Option<ClearanceFound>,
    /// What is predicted of it.
    pub prediction: Option<Prediction>,
}

impl ProgramOutcome {
    /// Its summary counts warnings besides those of posting.
    fn warns(&mut self, findings: &[Diagnostic]) {
        let warnings = findings.iter().filter(|finding| finding.severity == Severity::Warning);
        self.report.warnings.extend(warnings.map(|warning| warning.message.clone()));
    }

    /// What its summary tells.
    pub fn told(&self) -> SummaryJson<'_> {
        SummaryJson {
            report: &self.report,
            program: self.program.as_ref(),
            // One that does not hold is refused before anything is told of it.
            verification: self.verification.as_ref().map(|found| VerifySummary::of(found, &[])),
            clearance: self.clearance.as_ref().map(ClearanceFound::summary),
            prediction: self.prediction.as_ref(),
            servo_compensation: self.compensation.as_ref(),
            plan_rounds: self.plan_rounds.as_ref(),
        }
    }
}

/// What programs of a job are made with.
pub struct ProgramMaker<'a> {
    /// The run.
    pub session: &'a Session,
    /// What the job is.
    pub job: &'a JobSettings,
    /// How its programs are made.
    pub making: &'a MakingSettings,
    /// Its plugins.
    pub finder: Finder,
    /// What a first pass over the CL file has found, where that was made.
    pub ahead: Option<ProgramPreview>,
    /// Threads that work at most.
    pub threads: NonZeroUsize,
    /// Solutions are chosen with which bodies stay clear, whatever the machine file says.
    pub keeps_clear: bool,
}

impl<'a> ProgramMaker<'a> {
    /// Opens what programs are made with, and the machine; what of its file has no effect is said.
    ///
    /// # Errors
    /// The machine or a folder of plugins cannot be used.
    pub fn open(
        session: &'a Session,
        job: &'a JobSettings,
        making: &'a MakingSettings,
    ) -> Result<(Self, Machine), Failure> {
        let setting = number_setting(session, job, making.number.map(i64::from))?;
        let JobMachine { machine, finder } = JobMachine::load(session, job, setting.as_slice())?;
        Ok((Self::new(session, job, making, finder), machine))
    }

    /// Of plugins that are found already.
    pub fn new(
        session: &'a Session,
        job: &'a JobSettings,
        making: &'a MakingSettings,
        finder: Finder,
    ) -> Self {
        let threads = ThreadSettings::default().most();
        Self { session, job, making, finder, ahead: None, threads, keeps_clear: false }
    }

    /// Makes the first pass over the CL file where texts of the machine ask for what it finds.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn look_ahead_where_needed(
        &mut self,
        machine: &Machine,
        source: &mut ClSource,
    ) -> Result<(), Failure> {
        match machine.program.looks_ahead {
            true => self.look_ahead(machine, source, None),
            false => Ok(()),
        }
    }

    /// Makes the first pass over the CL file, or over these lines of it.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn look_ahead(
        &mut self,
        machine: &Machine,
        source: &mut ClSource,
        lines: Option<&ProgramLines>,
    ) -> Result<(), Failure> {
        let lines = lines.map(|lines| lines.ranges.clone());
        let Self { session, job, finder, .. } = self;
        let found = super::look_ahead(session, job, machine, finder, source, lines)?;
        self.ahead = Some(found);
        Ok(())
    }

    /// Plans a program in rounds and moves its points, where that is asked for. Where the plan itself is `shown`, it is
    /// written whatever it gains.
    ///
    /// # Errors
    /// The machine file does not allow it, or the program cannot be made.
    pub fn prepare<'p>(
        &'p self,
        part: &'p ProgramPart,
        source: &mut ClSource,
        shown: bool,
    ) -> Result<PreparedProgram<'p>, Failure> {
        let program = OneProgram {
            session: self.session,
            arguments: self.job,
            machine: &part.machine,
            finder: &self.finder,
            target: &part.target,
            lines: part.lines.clone(),
            trust_model: self.making.trust_model,
            plans: self.making.plan,
            threads: self.threads,
            tightening: None,
            keeps_clear: self.keeps_clear,
        };
        PreparedProgram::new(program, self.making, self.ahead.as_ref(), source, shown)
    }

    /// Writes a program, and finds out what else is wanted of it; what the user should know goes to `findings`.
    ///
    /// # Errors
    /// All that is wrong with it, the findings among it, or a file that cannot be read or written.
    pub fn make(
        &self,
        part: &ProgramPart,
        ready: PreparedProgram<'_>,
        source: &mut ClSource,
        text: &mut dyn ProgramSink,
        wanted: ProgramRequest<'_, '_, '_>,
        findings: &mut Vec<Diagnostic>,
    ) -> Result<ProgramOutcome, Failure> {
        let ProgramRequest { verify, clearance, predict, summary, watch, observer, page } = wanted;
        let clearance = clearance || part.machine.clearance.shortens_ways();
        let mut rows = match &page {
            Some(_) => Some(self.rows(part, source, predict)?),
            None => None,
        };
        let observer: Option<&mut dyn Observer> = match (&mut rows, observer) {
            (Some(rows), _) => Some(rows),
            (None, Some(observer)) => Some(observer),
            (None, None) => None,
        };
        let beside = PostingExtras { watch, observer, ..PostingExtras::default() };
        let mut outcome = self.write(ready, source, text, beside, findings)?;
        if summary || page.is_some() {
            let digest = ProgramDigest::of(&part.target, text.reread()?);
            let unreadable = |error| FileFault::Read { name: text.name(), error };
            outcome.program = Some(digest.map_err(unreadable)?);
        }
        if verify {
            let program = ProgramInput { name: text.name(), text: text.reread()? };
            let held = self.read_back(part, outcome.moved, source, program)?;
            if held.is_wrong() {
                findings.extend(held.findings);
                return Err(std::mem::take(findings).into());
            }
            outcome.verification = Some(held.found);
        }
        let mut near = match (&page, clearance) {
            (Some(_), true) => Some(ClearanceRows::new(clearance::cuts_stock(&part.machine))?),
            _ => None,
        };
        if clearance {
            let program = ProgramInput { name: text.name(), text: text.reread()? };
            let mut hear = near.as_mut().map(|near| |heard: &Heard| near.hear(heard));
            let hear = hear.as_mut().map(|hear| hear as &mut Hearer<'_>);
            let mut proven = self.prove(part, outcome.moved, source, program, hear)?;
            outcome.warns(&proven.findings);
            findings.append(&mut proven.findings);
            if findings.iter().any(|finding| finding.severity == Severity::Error) {
                return Err(std::mem::take(findings).into());
            }
            outcome.clearance = Some(proven);
        }
        let mut heard = None;
        if predict {
            if let Some(rows) = &mut rows {
                heard = PredictedParts::of(&part.machine, rows)?;
            }
            let program = ProgramInput { name: text.name(), text: text.reread()? };
            let predicted = self.predict(part, None, source, heard.as_mut(), program)?;
            outcome.warns(&predicted.findings);
            findings.extend(predicted.findings);
            outcome.prediction = Some(predicted.found);
        }
        if let (Some((file, most)), Some(rows)) = (page, rows) {
            let input = self.page(part, &outcome, findings);
            let name = text.name();
            let texts = PageTexts { source, name: &name, text: &mut text.reread()? };
            input.write(rows, near, heard, texts, most, file)?;
        }
        source.refuse_written()?;
        Ok(outcome)
    }

    /// Writes a program alone; what the user should know goes to `findings`.
    ///
    /// # Errors
    /// All that is wrong with it, the findings among it, or a file that cannot be read or written.
    pub fn write(
        &self,
        ready: PreparedProgram<'_>,
        source: &mut ClSource,
        text: &mut dyn TextSink,
        beside: PostingExtras<'_, '_, '_>,
        findings: &mut Vec<Diagnostic>,
    ) -> Result<ProgramOutcome, Failure> {
        findings.extend(ready.warning());
        let (report, found) = ready.write(self.ahead.as_ref(), source, text, beside)?;
        let moved = ready.is_moved();
        let (plan_rounds, compensation) = ready.found();
        // What is wrong with the file is found again in each of its parts.
        for finding in found {
            if !findings.contains(&finding) {
                findings.push(finding);
            }
        }
        let Some(report) = report else {
            return Err(std::mem::take(findings).into());
        };
        Ok(ProgramOutcome {
            report,
            program: None,
            moved,
            plan_rounds,
            compensation,
            verification: None,
            clearance: None,
            prediction: None,
        })
    }

    /// What a page is told of a program.
    fn page<'p>(
        &'p self,
        part: &'p ProgramPart,
        outcome: &'p ProgramOutcome,
        findings: &'p [Diagnostic],
    ) -> PostPage<'p> {
        PostPage {
            session: self.session,
            threads: self.threads,
            machine: &part.machine,
            cl: report::name_of(&self.job.input),
            program: &part.target,
            report: &outcome.report,
            verification: outcome.verification.as_ref(),
            clearance: outcome.clearance.as_ref().map(ClearanceFound::summary),
            left: outcome.clearance.as_ref().map_or(&[], |proven| &proven.left),
            prediction: outcome.prediction.as_ref(),
            findings,
            job: match self.making.plan {
                true => "plan",
                false => "post",
            },
            facts: summary::facts(&outcome.told()),
        }
    }

    /// The rows of the page of a program.
    ///
    /// # Errors
    /// The CL file cannot be read, or there is no place for them.
    pub fn rows<'p>(
        &self,
        part: &'p ProgramPart,
        source: &ClSource,
        predicted: bool,
    ) -> Result<BlockRows<'p>, Failure> {
        let cl = ClWindow::of(self.job, &part.machine, source)?;
        BlockRows::new(&part.machine, cl, predicted)
    }

    /// Reads a program back and holds it against the CL file; `moved` if its points were moved for the servos.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read_back(
        &self,
        part: &ProgramPart,
        moved: bool,
        source: &mut ClSource,
        program: ProgramInput<'_>,
    ) -> Result<VerifiedProgram, Failure> {
        let ProgramInput { name, text } = program;
        read_back::verify(&self.reading(part, moved), source, &name, text, &mut Unwatched)
    }

    /// Reads a program back and proves that nothing hits anything; who `hear`s is told of motions.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn prove(
        &self,
        part: &ProgramPart,
        moved: bool,
        source: &mut ClSource,
        program: ProgramInput<'_>,
        hear: Option<&mut Hearer<'_>>,
    ) -> Result<ClearanceFound, Failure> {
        let ProgramInput { name, text } = program;
        clearance::of_job(&self.reading(part, moved), source, &name, text, hear)
    }

    /// What a program is read back with; `moved` if its points were moved for the servos.
    fn reading<'p>(&'p self, part: &'p ProgramPart, moved: bool) -> ReadingSetup<'p> {
        // What was moved on purpose is off the CL file by that.
        let accuracy = &part.machine.accuracy;
        let bound = accuracy.servo_compensation.filter(|_| moved);
        let moved = bound.map(|bound| accuracy.tolerance + bound);
        ReadingSetup {
            session: self.session,
            arguments: self.job,
            machine: &part.machine,
            finder: &self.finder,
            offsets: None,
            limits: Limits::default(),
            tolerances: [moved, None],
            planned: self.making.plan,
            solutions: false,
            any_coolant: false,
            // It was written in this run, or lines of the user's have another.
            any_work_offset: true,
            own: true,
            lines: part.ranges(),
            threads: self.threads,
        }
    }

    /// Predicts what a program does, for the page too if `heard` is given; `period` between set-points, s, over the machine file's.
    ///
    /// # Errors
    /// A file that cannot be read, or a machine that cannot be used.
    pub fn predict(
        &self,
        part: &ProgramPart,
        period: Option<f64>,
        source: &mut ClSource,
        mut heard: Option<&mut PredictedParts>,
        program: ProgramInput<'_>,
    ) -> Result<Predicted, Failure> {
        let asked = PredictionSetup {
            session: self.session,
            arguments: self.job,
            machine: &part.machine,
            finder: &self.finder,
            offsets: None,
            limits: Limits::default(),
            period,
            lines: part.ranges(),
            threads: self.threads,
        };
        let ProgramInput { name, text } = program;
        let against = PredictReference::Cl(source);
        predict::predict(&asked, against, &name, text, &mut |sample: &Sample| {
            if let Some(heard) = &mut heard {
                heard.take(sample);
            }
            Ok(())
        })
    }
}

/// A program that is ready to be written: its feed planned in rounds, its points moved, where that is asked for.
pub struct PreparedProgram<'a> {
    program: OneProgram<'a>,
    plan_rounds: Option<plan_rounds::PlanRoundsSummary>,
    /// Its plan is left out, and why.
    unplanned: Option<Diagnostic>,
    compensation: Option<ServoCompensation>,
}

impl<'a> PreparedProgram<'a> {
    /// Does what comes before. Where the plan itself is `shown`, it is written whatever it gains.
    ///
    /// # Errors
    /// The machine file does not allow it, or the program cannot be made.
    pub fn new(
        mut program: OneProgram<'a>,
        making: &MakingSettings,
        ahead: Option<&ProgramPreview>,
        source: &mut ClSource,
        shown: bool,
    ) -> Result<Self, Failure> {
        let mut rounds = None;
        if let Some(most) = making.plan_rounds {
            let (tightening, found) = plan_rounds::plan(&program, most, ahead, source)?;
            program.tightening = tightening;
            rounds = Some(found);
        }
        let mut unplanned = None;
        if program.plans && rounds.is_none() && !shown {
            unplanned = plan_worth::gains_nothing(&program, ahead, source)?;
            program.plans = unplanned.is_none();
        }
        let compensation = match making.compensate_servo {
            true => Some(compensate::compensate(&program, ahead, source)?),
            false => None,
        };
        Ok(Self { program, plan_rounds: rounds, unplanned, compensation })
    }

    /// What the user should know of the plan.
    pub fn warning(&self) -> Option<Diagnostic> {
        let rounds = self.plan_rounds.as_ref();
        let unplanned = || self.unplanned.clone();
        rounds.and_then(plan_rounds::warning).or_else(unplanned)
    }

    /// Its points are moved.
    pub fn is_moved(&self) -> bool {
        let compensation = self.compensation.as_ref();
        compensation.is_some_and(|moved| moved.found.kept)
    }

    /// What planning in rounds and moving points have done.
    pub fn found(
        self,
    ) -> (Option<plan_rounds::PlanRoundsSummary>, Option<compensate::CompensationSummary>) {
        let compensation = self.compensation.map(|moved| moved.found);
        (self.plan_rounds, compensation)
    }

    /// Writes it, its points moved where that helps; `beside` sees its plan and its blocks.
    ///
    /// # Errors
    /// A file that cannot be read, or a machine that cannot be used.
    pub fn write(
        &self,
        ahead: Option<&ProgramPreview>,
        source: &mut ClSource,
        file: &mut dyn TextSink,
        beside: PostingExtras<'_, '_, '_>,
    ) -> Result<(Option<PostingReport>, Vec<Diagnostic>), Failure> {
        let program = self.program.clone();
        let compensation = self.compensation.as_ref();
        let moved = compensation.and_then(|found| Some((&found.machine, found.moves.as_ref()?)));
        let Some((machine, moves)) = moved else {
            return program.write(ahead, source, file, beside);
        };
        let program = OneProgram { machine, ..program };
        let mut moved = ShiftedPath::new(moves);
        let beside = PostingExtras { shift: Some(&mut moved), ..beside };
        program.write(ahead, source, file, beside)
    }
}
