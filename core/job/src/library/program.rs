//! A CL file on a machine: the program, and what can be asked of it.

use std::io::Cursor;
use std::path::Path;

use post_machine::diagnostic::Diagnostic;
use post_posting::{Observer, TextSink};

use super::blocks::BlockArrays;
use super::{Blocks, MachineSelection, NamedOption, Refusal, StopSignal, quietly};
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClSource, PathArg, Role};
use crate::job_file::{self, JobFile, JobProgram};
use crate::making::{self, ProgramInput, ProgramMaker, ProgramPart, ProgramRequest, ProgramSink};
use crate::nc_program::Reread;
use crate::operations;
use crate::plugin_finder;
use crate::session::Session;
use crate::settings::{
    JobSettings, MakingSettings, OutputSettings, ReadingSettings, ThreadSettings, tell,
};
use crate::verify::VerifySummary;

/// A program that is asked for.
#[derive(Clone, Debug)]
struct Request {
    job: JobSettings,
    making: MakingSettings,
    threads: ThreadSettings,
    /// Where it is, or would be, written; none: beside its CL file.
    output: Option<PathArg>,
    /// It is written.
    writes: bool,
    /// It is read back before it is written.
    verify: bool,
    /// It is proven to hit nothing before it is written.
    clearance: bool,
}

/// A file, and never a standard stream: those are not ours.
pub(super) fn file(path: &Path) -> PathArg {
    PathArg::from(match path.as_os_str() == "-" {
        true => Path::new("./-").to_owned(),
        false => path.to_owned(),
    })
}

/// The text of a program in memory.
struct Text {
    name: String,
    bytes: Vec<u8>,
}

impl TextSink for Text {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        self.bytes.extend_from_slice(text);
        Ok(())
    }
}

impl ProgramSink for Text {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn reread(&mut self) -> Result<Box<dyn Reread + '_>, Failure> {
        Ok(Box::new(Cursor::new(&self.bytes)))
    }
}

/// A program that is good.
#[derive(Debug)]
pub struct MadeProgram {
    request: Request,
    part: ProgramPart,
    text: Vec<u8>,
    summary: String,
    findings: Vec<Diagnostic>,
    moved: bool,
    blocks: Option<Blocks>,
}

/// What reading back or predicting a program has found.
#[derive(Clone, Debug)]
pub struct ProgramFindings {
    /// As JSON, the bytes that the command writes.
    pub json: String,
    /// Warnings.
    pub findings: Vec<Diagnostic>,
}

impl ProgramFindings {
    /// What a job has given, and what it has said on the way.
    pub(super) fn of(((json, found), said): ((String, Vec<Diagnostic>), Vec<Diagnostic>)) -> Self {
        Self { json, findings: said.into_iter().chain(found).collect() }
    }
}

/// What a report shall tell besides.
#[derive(Clone, Copy, Debug)]
pub struct ReportOptions {
    /// What reading the program back finds.
    pub verify: bool,
    /// How near its bodies come to one another.
    pub clearance: bool,
    /// What is predicted of it.
    pub predict: bool,
    /// Largest size, MB.
    pub most_megabytes: u64,
}

impl Request {
    fn new(
        machine: &MachineSelection,
        input: &Path,
        output: Option<&Path>,
        options: &[NamedOption],
    ) -> Result<Self, Failure> {
        let mut reading = ReadingSettings::default();
        let mut over = machine.over.clone();
        let mut making = MakingSettings::default();
        let mut threads = ThreadSettings::default();
        tell(options, &mut [&mut reading, &mut over, &mut making, &mut threads])?;
        let job = JobSettings {
            machine: machine.name.clone(),
            input: file(input),
            reading,
            over,
            mark: None,
        };
        Ok(Self {
            job,
            making,
            threads,
            writes: output.is_some(),
            output: output.map(file),
            verify: false,
            clearance: false,
        })
    }

    /// A program of a job file, with `options` over what that says; it is written if `writes` says so.
    fn of_job(
        session: &Session,
        file: &JobFile,
        program: &JobProgram,
        options: &[NamedOption],
        writes: bool,
    ) -> Result<Self, Failure> {
        let mut keys = program.keys()?;
        let mut threads = ThreadSettings::default();
        tell(options, &mut [&mut keys.reading, &mut keys.over, &mut keys.making, &mut threads])?;
        let mark = options.is_empty().then(|| file.mark.clone());
        let job = program.settings(&keys, mark);
        let output = match writes {
            true => Some(program.target(session)?),
            false => keys.outputs.output.clone(),
        };
        let OutputSettings { verify, clearance, .. } = keys.outputs;
        Ok(Self { job, making: keys.making, threads, output, writes, verify, clearance })
    }

    /// Opens what the program is made with: the program as a part of its file, and the file.
    fn open<'a>(
        &'a self,
        session: &'a Session,
    ) -> Result<(ProgramMaker<'a>, ProgramPart, ClSource), Failure> {
        let (mut maker, machine) = ProgramMaker::open(session, &self.job, &self.making)?;
        maker.threads = self.threads.most();
        maker.keeps_clear = self.clearance;
        let mut source = ClSource::of_job(session, &self.job, true)?;
        maker.look_ahead_where_needed(&machine, &mut source)?;
        let target = making::target(&self.job, self.output.as_ref(), &machine, &maker.finder)?;
        let lines = operations::chosen(&self.job, &mut source)?;
        Ok((maker, ProgramPart { lines, target, machine }, source))
    }

    /// What a program that is made is asked with.
    fn maker<'a>(&'a self, session: &'a Session) -> Result<ProgramMaker<'a>, Failure> {
        let finder = plugin_finder::finder(session, &self.job.over.plugins)?;
        let mut maker = ProgramMaker::new(session, &self.job, &self.making, finder);
        maker.threads = self.threads.most();
        Ok(maker)
    }
}

/// A text for a program in the making.
fn text(part: &ProgramPart) -> Text {
    let path = part.target.path();
    let name = path.map(|path| path.display().to_string()).unwrap_or_default();
    Text { name, bytes: Vec::new() }
}

impl MadeProgram {
    /// Posts the CL file `input`. The program is written to `output`, whole or not at all; without it
    /// nothing is written.
    ///
    /// # Errors
    /// Why it is refused.
    pub(super) fn post(
        stop: &StopSignal,
        machine: &MachineSelection,
        input: &Path,
        output: Option<&Path>,
        options: &[NamedOption],
        keep_blocks: bool,
    ) -> Result<Self, Refusal> {
        Self::make(stop, keep_blocks, |_| Request::new(machine, input, output, options))
    }

    /// Posts the programs of the job file `path`, with `options` over what it says. They are written where it says if
    /// `writes` says so.
    ///
    /// # Errors
    /// Why the first of them that is refused is.
    pub fn of_job_file(
        stop: &StopSignal,
        path: &Path,
        writes: bool,
        options: &[NamedOption],
        keep_blocks: bool,
    ) -> Result<Vec<Self>, Refusal> {
        let (job, _) = quietly(stop, |session| job_file::read(session, path))?;
        let programs = job.programs.iter().map(|program| {
            Self::make(stop, keep_blocks, |session| {
                job_file::refuse_channels(&job)?;
                session.read_files().note("the job file", path);
                Request::of_job(session, &job, program, options, writes)
            })
        });
        programs.collect()
    }

    fn make(
        stop: &StopSignal,
        keep_blocks: bool,
        request: impl FnOnce(&Session) -> Result<Request, Failure>,
    ) -> Result<Self, Refusal> {
        let made = quietly(stop, |session| {
            let request = request(session)?;
            let (maker, part, mut source) = request.open(session)?;
            let target = request.output.as_ref().filter(|_| request.writes);
            let targets: Vec<_> =
                target.map(|target| (Role::PROGRAM, target)).into_iter().collect();
            let mut files = AtomicFile::create(session, &targets)?;
            let mut columns = keep_blocks.then(|| BlockArrays::new(&part.machine));
            let observer = columns.as_mut().map(|columns| columns as &mut dyn Observer);
            let Request { verify, clearance, .. } = request;
            let wanted =
                ProgramRequest { verify, clearance, observer, summary: true, ..Default::default() };
            let mut text = text(&part);
            let mut findings = Vec::new();
            let ready = maker.prepare(&part, &mut source, false)?;
            let outcome =
                maker.make(&part, ready, &mut source, &mut text, wanted, &mut findings)?;
            for file in &mut files {
                file.write_bytes(&text.bytes)?;
            }
            AtomicFile::finish(session, files)?;
            let blocks = columns.map(BlockArrays::finish);
            let (summary, moved) = (files::json(&outcome.told()), outcome.moved);
            drop(maker);
            Ok(Self { request, part, text: text.bytes, summary, findings, moved, blocks })
        });
        let (mut made, mut findings) = made?;
        findings.append(&mut made.findings);
        Ok(Self { findings, ..made })
    }

    /// Its text.
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// What messages call it: where it is, or would be, written.
    pub fn name(&self) -> String {
        let path = self.part.target.path();
        path.map(|path| path.display().to_string()).unwrap_or_default()
    }

    /// Its summary, the bytes that `--summary` writes.
    pub fn summary(&self) -> &str {
        &self.summary
    }

    /// What the user should know.
    pub fn findings(&self) -> &[Diagnostic] {
        &self.findings
    }

    /// Its blocks, if they were kept.
    pub fn blocks(&self) -> Option<&Blocks> {
        self.blocks.as_ref()
    }

    /// Its feed is planned.
    pub fn is_planned(&self) -> bool {
        self.request.making.plan
    }

    /// It, to be read by a run.
    fn program(&self, session: &Session) -> ProgramInput<'_> {
        let text = Box::new(session.stoppable(Cursor::new(&self.text)));
        ProgramInput { name: self.name(), text }
    }

    /// Reads it back and holds it against the CL file, as `post verify` does.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn verify(&self, stop: &StopSignal) -> Result<ProgramFindings, Refusal> {
        let held = quietly(stop, |session| {
            let maker = self.request.maker(session)?;
            let mut source = ClSource::of_job(session, &self.request.job, true)?;
            let program = self.program(session);
            let held = maker.read_back(&self.part, self.moved, &mut source, program)?;
            match held.is_wrong() {
                true => Err(held.findings.into()),
                false => {
                    let json = files::json(&VerifySummary::of(&held.found, &held.findings));
                    Ok((json, held.findings))
                }
            }
        });
        held.map(ProgramFindings::of)
    }

    /// Proves that nothing hits anything while it runs, as `post clearance` does with the CL file: what a summary tells of
    /// it.
    ///
    /// # Errors
    /// What is not clear.
    pub fn clearance(&self, stop: &StopSignal) -> Result<ProgramFindings, Refusal> {
        let proven = quietly(stop, |session| {
            let maker = self.request.maker(session)?;
            let mut source = ClSource::of_job(session, &self.request.job, true)?;
            let program = self.program(session);
            let proven = maker.prove(&self.part, self.moved, &mut source, program, None)?;
            match proven.is_wrong() {
                true => Err(proven.findings.into()),
                false => Ok((files::json(&proven.summary()), proven.findings)),
            }
        });
        proven.map(ProgramFindings::of)
    }

    /// Predicts what it does on its machine, as `post predict` with the CL file does; `period` between set-points, s, over
    /// the machine file's.
    ///
    /// # Errors
    /// The machine cannot be predicted.
    pub fn predict(
        &self,
        stop: &StopSignal,
        period: Option<f64>,
    ) -> Result<ProgramFindings, Refusal> {
        let predicted = quietly(stop, |session| {
            let maker = self.request.maker(session)?;
            let mut source = ClSource::of_job(session, &self.request.job, true)?;
            let program = self.program(session);
            let predicted = maker.predict(&self.part, period, &mut source, None, program)?;
            Ok((files::json(&predicted.found), predicted.findings))
        });
        predicted.map(ProgramFindings::of)
    }

    /// Writes a page to look at, the bytes that `--report` writes. The program is made once more for it.
    ///
    /// # Errors
    /// The page cannot be written, or what it shall tell is refused.
    pub fn report(
        &self,
        stop: &StopSignal,
        page: &Path,
        told: ReportOptions,
    ) -> Result<(), Refusal> {
        let written = quietly(stop, |session| {
            let (maker, part, mut source) = self.request.open(session)?;
            let mut files = AtomicFile::create(session, &[(Role::REPORT, &file(page))])?;
            let most = told.most_megabytes.saturating_mul(1_000_000);
            let ReportOptions { verify, clearance, predict, .. } = told;
            let page = files.first_mut().map(|file| (file, most));
            let wanted =
                ProgramRequest { verify, clearance, predict, page, ..ProgramRequest::default() };
            let ready = maker.prepare(&part, &mut source, false)?;
            let (mut text, mut findings) = (text(&part), Vec::new());
            maker.make(&part, ready, &mut source, &mut text, wanted, &mut findings)?;
            Ok(AtomicFile::finish(session, files)?)
        });
        written.map(|_| ())
    }
}
