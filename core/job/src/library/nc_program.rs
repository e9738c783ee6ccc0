//! An NC program of whatever origin on a machine: what it does, and what is wrong with it.

use std::path::Path;

use post_machine::diagnostic::{Diagnostic, Severity};
use post_readback::interpret::Limits;

use super::program::file;
use super::{LoadedMachine, NamedOption, ProgramFindings, Refusal, StopSignal, quietly};
use crate::failure::Failure;
use crate::files::{self, PathArg};
use crate::lint::{self, LintSummary};
use crate::nc_program::{NcControl, ProgramFile};
use crate::plugin_finder;
use crate::predict::{self, PredictRequest};
use crate::read::{self, ReadRequest, ReadSummary};
use crate::settings::{
    JobSettings, ProgramSettings, ReadingSettings, ReportSettings, ThreadSettings, tell,
};
use crate::verify::{self, VerifyRequest, VerifySummary};

/// Where more of what a program does is written.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadTargets<'a> {
    /// The table of its motions.
    pub csv: Option<&'a Path>,
    /// Its path as a CL file.
    pub cl: Option<&'a Path>,
}

/// How a program is held against a CL file.
#[derive(Clone, Copy, Debug, Default)]
pub struct VerifyOptions {
    /// Largest deviation of the tool axis over the machine file's, degrees.
    pub axis_tolerance: Option<f64>,
    /// The program was posted for this machine file.
    pub posted: bool,
    /// The feed was planned: it may be below that of the CL file.
    pub planned: bool,
    /// It is proven besides that nothing hits anything.
    pub clearance: bool,
}

impl LoadedMachine {
    /// Reads the NC program `program` as its control does, as `post read`: what it makes the machine do.
    ///
    /// # Errors
    /// A block that is not understood, or an axis beyond its travel.
    pub fn read(
        &self,
        stop: &StopSignal,
        program: &Path,
        targets: ReadTargets<'_>,
        options: &[NamedOption],
    ) -> Result<ProgramFindings, Refusal> {
        let done = quietly(stop, |session| {
            let control = NcControl::new(session, &self.program_settings(options)?)?;
            let input = file(program);
            let [csv, cl] = [targets.csv, targets.cl].map(|target| target.map(file));
            let done = read::read(session, &control, &ReadRequest { input, csv, cl })?;
            let mut findings = done.report.notes.clone();
            findings.extend(done.refused.iter().cloned());
            let name = program.display().to_string();
            right(files::json(&ReadSummary::new(&name, &control.machine, &done)), findings)
        });
        done.map(ProgramFindings::of)
    }

    /// Holds the NC program `program` against the CL file `against`, as `post verify`.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn verify(
        &self,
        stop: &StopSignal,
        program: &Path,
        against: &Path,
        verified: VerifyOptions,
        options: &[NamedOption],
    ) -> Result<ProgramFindings, Refusal> {
        let done = quietly(stop, |session| {
            let (job, offsets, threads) = self.job_settings(file(against), options)?;
            let request = VerifyRequest {
                job,
                program: file(program),
                offsets,
                most_blocks: Limits::default().blocks,
                axis_tolerance: verified.axis_tolerance.map(f64::to_radians),
                planned: verified.planned,
                posted: verified.posted,
                any_coolant: false,
                any_work_offset: false,
                clearance: verified.clearance,
                map: None,
                summary: None,
                report: ReportSettings::default(),
                threads,
            };
            let done = verify::verify(session, &request)?;
            let held = done.held;
            let clearance = done.clearance.as_ref().map(|proven| proven.summary());
            let told =
                VerifySummary { clearance, ..VerifySummary::of(&held.found, &held.findings) };
            right(files::json(&told), held.findings.clone())
        });
        done.map(ProgramFindings::of)
    }

    /// Predicts what the NC program `program` does on this machine, as `post predict`; `against` is the CL file that it was
    /// made from, `period` the time between set-points, s, over the machine file's.
    ///
    /// # Errors
    /// A block that is not understood, or a machine that cannot be predicted.
    pub fn predict(
        &self,
        stop: &StopSignal,
        program: &Path,
        against: Option<&Path>,
        period: Option<f64>,
        options: &[NamedOption],
    ) -> Result<ProgramFindings, Refusal> {
        let done = quietly(stop, |session| {
            let input = against.map(file);
            let (job, offsets, threads) =
                self.job_settings(input.clone().unwrap_or(PathArg::Standard), options)?;
            let request = PredictRequest {
                job,
                program: file(program),
                against: input,
                offsets,
                most_blocks: Limits::default().blocks,
                period,
                measured: None,
                csv: None,
                summary: None,
                pictures: None,
                report: ReportSettings::default(),
                threads,
            };
            let done = predict::predict_program(session, &request)?;
            Ok((files::json(&done.found), done.findings))
        });
        done.map(ProgramFindings::of)
    }

    /// Looks over the NC program `program`, as `post lint`; findings of the codes in `ignored` are only counted.
    ///
    /// # Errors
    /// Something is wrong with it; where it is `strict`, or may be.
    pub fn lint(
        &self,
        stop: &StopSignal,
        program: &Path,
        ignored: &[String],
        strict: bool,
        options: &[NamedOption],
    ) -> Result<ProgramFindings, Refusal> {
        let done = quietly(stop, |session| {
            let settings = self.program_settings(options)?;
            let control = NcControl::new(session, &settings)?;
            let finder = plugin_finder::finder(session, &settings.plugins)?;
            let program = ProgramFile::open(session, &file(program))?;
            let name = &program.name;
            let text = Box::new(program.text()?);
            let mut linted = lint::look_over(&control, &finder, name, text, ignored)?;
            linted.predict(&control, name, Box::new(program.text()?), ignored)?;
            if linted.is_wrong(strict) {
                return Err(linted.findings.into());
            }
            let json = files::json(&LintSummary::new(name, &control.machine.name, &linted));
            Ok((json, linted.findings))
        });
        done.map(ProgramFindings::of)
    }

    /// What a program is read with: this machine, and `options` over what was set as it was loaded.
    fn program_settings(&self, options: &[NamedOption]) -> Result<ProgramSettings, Failure> {
        let told = self.told();
        let mut settings = ProgramSettings {
            machine: told.name.clone(),
            set: told.over.settings(),
            tool_length: told.over.tool_length,
            machines: told.over.machines.clone(),
            plugins: told.over.plugins.clone(),
            ..ProgramSettings::default()
        };
        tell(options, &mut [&mut settings])?;
        Ok(settings)
    }

    /// The job of a program that is held against `input`, the file of offsets, and how many threads work.
    fn job_settings(
        &self,
        input: PathArg,
        options: &[NamedOption],
    ) -> Result<(JobSettings, Option<PathArg>, ThreadSettings), Failure> {
        let told = self.told();
        let (mut reading, mut over) = (ReadingSettings::default(), told.over.clone());
        let (mut threads, mut program) = (ThreadSettings::default(), ProgramSettings::default());
        let (own, others): (Vec<_>, Vec<_>) =
            options.iter().cloned().partition(|(name, _)| name == "offsets");
        tell(&own, &mut [&mut program])?;
        tell(&others, &mut [&mut reading, &mut over, &mut threads])?;
        let machine = told.name.clone();
        let job = JobSettings { machine, input, reading, over, mark: None };
        Ok((job, program.offsets, threads))
    }
}

/// What was found, unless something is wrong.
fn right(json: String, findings: Vec<Diagnostic>) -> Result<(String, Vec<Diagnostic>), Failure> {
    match findings.iter().any(|finding| finding.severity == Severity::Error) {
        true => Err(findings.into()),
        false => Ok((json, findings)),
    }
}
