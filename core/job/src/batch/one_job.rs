//! One job, from its line to its row.

use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Severity};
use post_posting::TextSink;
use post_posting::report::PostingReport;

use super::JobStudy;
use super::columns::{self, WrittenProgram};
use super::inputs::{ClText, Inputs};
use super::job_line::JobLine;
use super::journal::Journal;
use super::key;
use super::outcome::{FAILED, JobOutcome, REFUSED, WRITTEN};
use super::travel;
use crate::cancellable_text::CancellableText;
use crate::failure::Failure;
use crate::files::{ClSource, HeldText};
use crate::making::{ProgramInput, ProgramMaker, ProgramPart};
use crate::plugin_finder;
use crate::posting_pass::PostingExtras;
use crate::session::Session;
use crate::settings::{JobSettings, MakingSettings};
use crate::{machine_files, operations, unused_options};

/// What came of a job, and whether the journal knew it.
pub struct JobResult {
    /// Its row.
    pub outcome: JobOutcome,
    /// The journal knew it.
    pub known: bool,
}

/// Does a job, whatever comes; none if it was given up.
pub fn run(
    session: &Session,
    study: &JobStudy,
    job: &JobLine,
    inputs: &Inputs,
    journal: Option<&Journal>,
    stop: &Arc<AtomicBool>,
) -> Option<JobResult> {
    // What a job had in its hands is dropped with it: nothing of it is seen again.
    let did =
        catch_unwind(AssertUnwindSafe(|| attempt(session, study, job, inputs, journal, stop)));
    if stop.load(Ordering::Relaxed) {
        return None;
    }
    Some(told(did))
}

/// A row of whatever came of a job.
pub fn told(did: std::thread::Result<Result<JobResult, Failure>>) -> JobResult {
    let new = |outcome| JobResult { outcome, known: false };
    match did {
        Ok(Ok(did)) => did,
        Ok(Err(Failure::Refused(findings))) => new(JobOutcome::not_written(REFUSED, &findings)),
        Ok(Err(failure)) => {
            let state = match &failure {
                Failure::File(fault) if !fault.is_of_input() => FAILED,
                _ => REFUSED,
            };
            new(JobOutcome::not_written(state, &failure.findings()))
        }
        Err(panic) => {
            let told = panic.downcast_ref::<String>().map(String::as_str);
            let told = told.or_else(|| panic.downcast_ref::<&str>().copied());
            let message = format!("post itself failed: {}", told.unwrap_or("it does not say why"));
            let finding = Diagnostic::error("panic", message);
            new(JobOutcome::not_written(FAILED, &[finding]))
        }
    }
}

/// A job with all that it reads.
struct PreparedJob {
    arguments: JobSettings,
    machine: Machine,
    cl: Arc<ClText>,
    key: Option<String>,
}

impl PreparedJob {
    fn new(
        session: &Session,
        study: &JobStudy,
        job: &JobLine,
        inputs: &Inputs,
    ) -> Result<Self, Failure> {
        let arguments = job
            .settings(&study.options.reading)
            .map_err(|fault| Diagnostic::error("job", fault))?;
        let cl = match arguments.reading.then.is_empty() {
            true => inputs.cl(session, &job.file)?,
            false => inputs.all_cl(session, &arguments)?,
        };
        let texts = inputs.machine(&arguments.machine);
        let mut machine = texts.load(&arguments.over.settings())?;
        machine_files::equip(session, &mut machine)?;
        Ok(Self {
            // Of a plugin that cannot be opened posting tells more.
            key: key::key(study, job, &cl, &texts, &machine).ok(),
            arguments,
            machine,
            cl,
        })
    }
}

/// What the journal knows of a job.
pub fn known(
    session: &Session,
    study: &JobStudy,
    job: &JobLine,
    inputs: &Inputs,
    journal: &Journal,
) -> Option<JobOutcome> {
    // What is wrong with the job is found again when it is done.
    let prepared = catch_unwind(AssertUnwindSafe(|| PreparedJob::new(session, study, job, inputs)));
    journal.known(prepared.ok()?.ok()?.key.as_ref()?)
}

/// Does a job, or takes from the journal what came of it before.
fn attempt(
    session: &Session,
    study: &JobStudy,
    job: &JobLine,
    inputs: &Inputs,
    journal: Option<&Journal>,
    stop: &Arc<AtomicBool>,
) -> Result<JobResult, Failure> {
    let PreparedJob { arguments, machine, cl, key } =
        PreparedJob::new(session, study, job, inputs)?;
    let known = journal.zip(key.as_ref()).and_then(|(journal, key)| journal.known(key));
    if let Some(outcome) = known {
        return Ok(JobResult { outcome, known: true });
    }
    let begun = std::time::Instant::now();
    let target = arguments.input.map(|path| path.with_extension("nc"));
    let part = ProgramPart { lines: None, target, machine };
    let mut one = OneJob { session, study, arguments: &arguments, part, cl: &cl, stop };
    one.part.lines = operations::chosen(&arguments, &mut one.source())?;
    let mut outcome = match one.make() {
        Ok(outcome) => outcome,
        Err(Failure::Refused(findings)) => JobOutcome::not_written(REFUSED, &findings),
        Err(failure) => return Err(failure),
    };
    outcome.key = key;
    if let Some(key) = outcome.key.clone() {
        outcome.text("key", key);
    }
    outcome.number("compute_time_s", begun.elapsed().as_secs_f64());
    Ok(JobResult { outcome, known: false })
}

/// A job whose machine is loaded.
struct OneJob<'a> {
    session: &'a Session,
    study: &'a JobStudy,
    arguments: &'a JobSettings,
    part: ProgramPart,
    cl: &'a ClText,
    stop: &'a Arc<AtomicBool>,
}

impl OneJob<'_> {
    /// Posts, and reads back and predicts where that is asked for.
    fn make(&self) -> Result<JobOutcome, Failure> {
        let options = &self.study.options;
        let part = &self.part;
        let wrong = |findings: &[Diagnostic]| {
            findings.iter().any(|finding| finding.severity == Severity::Error)
        };
        let making = MakingSettings {
            plan: options.plan,
            trust_model: options.trust_model,
            ..MakingSettings::default()
        };
        let finder = self.study.finder.clone();
        let mut maker = ProgramMaker::new(self.session, self.arguments, &making, finder);
        // The jobs are side by side already.
        maker.threads = NonZeroUsize::MIN;
        maker.keeps_clear = options.clearance;
        let mut source = self.source();
        let mut findings = unused_options::found(&part.machine, &maker.finder);
        maker.look_ahead_where_needed(&part.machine, &mut source)?;
        let clearance = options.clearance || part.machine.clearance.shortens_ways();
        let mut text = HashedText::new(options.verify || clearance || options.predict);
        // Results are compared: a plan that is asked for is made, whatever it gains.
        let ready = maker.prepare(part, &mut source, true)?;
        let beside = PostingExtras::default();
        let made = maker.write(ready, &mut source, &mut text, beside, &mut findings)?;
        let mut outcome = JobOutcome::default();
        self.tell(&made.report, &text, &mut outcome);
        let name = plugin_finder::cl_name(&part.target);
        if options.verify {
            let program = ProgramInput { name: name.clone(), text: Box::new(self.reread(&text)) };
            let held = maker.read_back(part, made.moved, &mut source, program)?;
            outcome.tell(&columns::verified(), &held.found);
            findings.extend(held.findings);
            if wrong(&findings) {
                return Ok(outcome.refused(&findings));
            }
        }
        if clearance {
            let program = ProgramInput { name: name.clone(), text: Box::new(self.reread(&text)) };
            let proven = maker.prove(part, made.moved, &mut source, program, None)?;
            if options.clearance {
                outcome.tell(&columns::proven(), &proven.summary());
            }
            findings.extend(proven.findings);
            if wrong(&findings) {
                return Ok(outcome.refused(&findings));
            }
        }
        if options.predict {
            let program = ProgramInput { name, text: Box::new(self.reread(&text)) };
            let predicted = maker.predict(part, None, &mut source, None, program)?;
            outcome.tell(&columns::predicted(), &predicted.found);
            findings.extend(predicted.findings);
        }
        debug_assert!(findings.iter().all(|finding| finding.severity == Severity::Warning));
        outcome.text("state", WRITTEN);
        outcome.text("codes", "");
        outcome.warnings(&findings);
        Ok(outcome)
    }

    fn source(&self) -> ClSource {
        let text = HeldText {
            bytes: Arc::clone(&self.cl.bytes),
            further: Arc::clone(&self.cl.further),
            stop: Arc::clone(self.stop),
        };
        ClSource::of_held(self.session, &self.arguments.input, text)
    }

    fn reread<'t>(&self, text: &'t HashedText) -> CancellableText<'t> {
        let stop = Arc::clone(self.stop);
        let text = text.kept.as_deref().unwrap_or_default();
        CancellableText::new(text, move || stop.load(Ordering::Relaxed))
    }

    /// What the program came to.
    fn tell(&self, report: &PostingReport, text: &HashedText, outcome: &mut JobOutcome) {
        let written = WrittenProgram {
            report,
            bytes: text.bytes,
            hash: text.hasher.finalize().to_hex().to_string(),
            left: travel::tell(&self.part.machine, report, outcome),
        };
        outcome.tell(&columns::program(), &written);
        outcome.tell(&columns::text(), &written);
    }
}

/// Takes the text of a program: its length and its hash, and if it is read back the text itself.
struct HashedText {
    bytes: u64,
    hasher: blake3::Hasher,
    kept: Option<Vec<u8>>,
}

impl HashedText {
    fn new(keeps: bool) -> Self {
        Self { bytes: 0, hasher: blake3::Hasher::new(), kept: keeps.then(Vec::new) }
    }
}

impl TextSink for HashedText {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        self.bytes += text.len() as u64;
        self.hasher.update(text);
        if let Some(kept) = &mut self.kept {
            kept.extend_from_slice(text);
        }
        Ok(())
    }
}
