//! A CL file on a machine: the program, and what can be asked of it.

use std::ffi::{OsStr, OsString};
use std::io::{Cursor, Read};
use std::path::Path;

use clap::Parser;
use post_host::Finder;
use post_machine::diagnostic::Diagnostic;
use post_posting::report::Report;
use post_posting::{LookedAhead, Observer, Output};

use super::blocks::BlockArrays;
use super::{Blocks, MachineTold, Refused, Stop, quietly};
use crate::arguments::{JobArguments, MakingArguments};
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClSource, PathArg, Role};
use crate::job::making::{self, Part, Ready};
use crate::job::one_program::{Beside, OneProgram};
use crate::job::report::{self, BlockRows, ClWindow, Made, PredictedParts};
use crate::job::summary::{self, Told};
use crate::job::{self, compensate, plan_rounds, plugin_finder, read_back};
use crate::session::Session;

/// An option of the command without its hyphens, and its value if it has one.
pub type OptionTold = (String, Option<String>);

/// The options of the command that a job takes.
#[derive(Debug, Parser)]
#[command(name = "post", disable_help_flag = true)]
struct JobLine {
    #[command(flatten)]
    job: JobArguments,

    #[command(flatten)]
    making: MakingArguments,

    #[arg(long, value_parser = PathArg::parser())]
    output: Option<PathArg>,
}

/// The text of a program in memory.
#[derive(Default)]
struct Text(Vec<u8>);

impl Output for Text {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        self.0.extend_from_slice(text);
        Ok(())
    }
}

/// What a program is made of.
struct Bench {
    part: Part,
    finder: Finder,
    source: ClSource,
    ahead: Option<LookedAhead>,
}

/// What making a program came to.
struct Came {
    text: Vec<u8>,
    report: Report,
    findings: Vec<Diagnostic>,
    moved: bool,
    plan_rounds: Option<plan_rounds::Found>,
    compensation: Option<compensate::Found>,
}

/// A program that is good.
#[derive(Debug)]
pub struct MadeProgram {
    line: JobLine,
    part: Part,
    text: Vec<u8>,
    summary: String,
    findings: Vec<Diagnostic>,
    moved: bool,
    blocks: Option<Blocks>,
}

/// What reading back or predicting a program has found.
#[derive(Clone, Debug)]
pub struct Found {
    /// As JSON, the bytes that the command writes.
    pub json: String,
    /// Warnings.
    pub findings: Vec<Diagnostic>,
}

/// What a report shall tell besides.
#[derive(Clone, Copy, Debug)]
pub struct ReportTold {
    /// What reading the program back finds.
    pub verify: bool,
    /// What is predicted of it.
    pub predict: bool,
    /// Largest size, MB.
    pub most_megabytes: u64,
}

impl JobLine {
    /// The command line that the machine and the options would be.
    fn new(machine: &MachineTold, input: &Path, options: &[OptionTold]) -> Result<Self, Failure> {
        let joined = |flag: &str, value: &OsStr| {
            let mut text = OsString::from(flag);
            text.push(value);
            text
        };
        let mut line = vec![OsString::from("post")];
        line.push(format!("--machine={}", machine.name).into());
        for (key, value) in &machine.set {
            line.push(format!("--set={key}={value}").into());
        }
        if let Some([x, y, z]) = machine.mount {
            line.push(format!("--mount={x:?},{y:?},{z:?}").into());
        }
        if let Some(turn) = machine.turn {
            line.push(format!("--turn={turn:?}").into());
        }
        if let Some(length) = machine.tool_length {
            line.push(format!("--tool-length={length:?}").into());
        }
        for folder in &machine.machines {
            line.push(joined("--machines=", folder.as_os_str()));
        }
        for folder in &machine.plugins {
            line.push(joined("--plugins=", folder.as_os_str()));
        }
        for (key, value) in options {
            line.push(match value {
                // Nor standard output to be written.
                Some(value) if key == "output" && value == "-" => "--output=./-".into(),
                Some(value) => format!("--{key}={value}").into(),
                None => format!("--{key}").into(),
            });
        }
        line.push("--".into());
        // Standard input is not ours to read.
        line.push(match input.as_os_str() == "-" {
            true => "./-".into(),
            false => input.into(),
        });
        Self::try_parse_from(line).map_err(Failure::Usage)
    }

    /// Opens what the program is made of.
    fn bench(&self, session: &Session) -> Result<Bench, Failure> {
        let arguments = &self.job;
        let machine = making::numbered(session, arguments, self.making.number.map(i64::from))?;
        let finder = plugin_finder::finder(session, &arguments.plugins)?;
        job::say_what_is_left(session, arguments, &machine, &finder);
        let mut source = ClSource::new(session, arguments.input(), true)?;
        let ahead = match machine.program.looks_ahead {
            true => {
                Some(job::look_ahead(session, arguments, &machine, &finder, &mut source, None)?)
            }
            false => None,
        };
        let target = making::target(arguments, self.output.as_ref(), &machine, &finder)?;
        Ok(Bench { part: Part { lines: None, target, machine }, finder, source, ahead })
    }

    /// Makes it; `observer` sees its blocks.
    fn make(
        &self,
        session: &Session,
        bench: &mut Bench,
        observer: Option<&mut dyn Observer>,
    ) -> Result<Came, Failure> {
        let Bench { part, finder, source, ahead } = bench;
        let program = OneProgram {
            session,
            arguments: &self.job,
            machine: &part.machine,
            finder,
            target: &part.target,
            lines: None,
            trust_model: self.making.trust_model,
            plans: self.making.plan,
            tightening: None,
        };
        let ready = Ready::new(program, &self.making, ahead.as_ref(), source, false)?;
        let mut findings: Vec<Diagnostic> = ready.warning().into_iter().collect();
        let mut text = Text::default();
        let beside = Beside { observer, ..Beside::default() };
        let (report, found) = ready.write(ahead.as_ref(), source, &mut text, beside)?;
        for finding in found {
            if !findings.contains(&finding) {
                findings.push(finding);
            }
        }
        let Some(report) = report else {
            return Err(findings.into());
        };
        let moved = ready.is_moved();
        let (plan_rounds, compensation) = ready.found();
        Ok(Came { text: text.0, report, findings, moved, plan_rounds, compensation })
    }
}

impl MadeProgram {
    /// Posts the CL file `input`. The program is written where the option `output` says, whole or not at all; without it
    /// nothing is written.
    ///
    /// # Errors
    /// Why it is refused.
    pub(super) fn post(
        stop: &Stop,
        machine: &MachineTold,
        input: &Path,
        options: &[OptionTold],
        keep_blocks: bool,
    ) -> Result<Self, Refused> {
        let made = quietly(stop, |session| {
            let line = JobLine::new(machine, input, options)?;
            let mut bench = line.bench(session)?;
            let targets = line.output.as_ref().map(|target| (Role::PROGRAM, target));
            let targets: Vec<_> = targets.into_iter().collect();
            let mut files = AtomicFile::create(session, &targets)?;
            let machine = bench.part.machine.clone();
            let mut columns = keep_blocks.then(|| BlockArrays::new(&machine));
            let observer = columns.as_mut().map(|columns| columns as &mut dyn Observer);
            let came = line.make(session, &mut bench, observer)?;
            for file in &mut files {
                file.write_bytes(&came.text)?;
            }
            AtomicFile::finish(session, files)?;
            let summary = files::json(&Told {
                report: &came.report,
                verification: None,
                prediction: None,
                servo_compensation: came.compensation.as_ref(),
                plan_rounds: came.plan_rounds.as_ref(),
            });
            let blocks = columns.map(BlockArrays::finish);
            Ok((line, bench.part, came, summary, blocks))
        });
        let ((line, part, came, summary, blocks), mut findings) = made?;
        findings.extend(came.findings);
        Ok(Self { line, part, text: came.text, summary, findings, moved: came.moved, blocks })
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
        self.line.making.plan
    }

    /// Reads it back and holds it against the CL file, as `post verify` does.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn verify(&self, stop: &Stop) -> Result<Found, Refused> {
        let held = quietly(stop, |session| {
            let finder = plugin_finder::finder(session, &self.line.job.plugins)?;
            let mut source = ClSource::new(session, self.line.job.input(), true)?;
            let held = self.held(session, &finder, &mut source, &self.text)?;
            Ok((files::json(&held.found), held.findings))
        });
        let ((json, found), mut findings) = held?;
        findings.extend(found);
        Ok(Found { json, findings })
    }

    fn held(
        &self,
        session: &Session,
        finder: &Finder,
        source: &mut ClSource,
        text: &[u8],
    ) -> Result<read_back::Held, Failure> {
        let how = (self.moved, self.is_planned());
        let text = (self.name(), Cursor::new(text));
        let held = self.part.read_back(session, &self.line.job, finder, how, source, text)?;
        match held.is_wrong() {
            true => Err(held.findings.into()),
            false => Ok(held),
        }
    }

    /// Predicts what it does on its machine, as `post predict` with the CL file does; `period` between set-points, s, over
    /// the machine file's.
    ///
    /// # Errors
    /// The machine cannot be predicted.
    pub fn predict(&self, stop: &Stop, period: Option<f64>) -> Result<Found, Refused> {
        let predicted = quietly(stop, |session| {
            let finder = plugin_finder::finder(session, &self.line.job.plugins)?;
            let mut source = ClSource::new(session, self.line.job.input(), true)?;
            let text = (self.name(), Cursor::new(&self.text));
            let told = (&mut source, None);
            let job = &self.line.job;
            let predicted = self.part.predict(session, job, &finder, period, told, text)?;
            Ok((files::json(&predicted.found), predicted.findings))
        });
        let ((json, found), mut findings) = predicted?;
        findings.extend(found);
        Ok(Found { json, findings })
    }

    /// Writes a page to look at, the bytes that `--report` writes. The program is made once more for it.
    ///
    /// # Errors
    /// The page cannot be written, or what it shall tell is refused.
    pub fn report(&self, stop: &Stop, page: &Path, told: ReportTold) -> Result<(), Refused> {
        let written = quietly(stop, |session| {
            let mut bench = self.line.bench(session)?;
            let page = PathArg::from(match page.as_os_str() == "-" {
                true => Path::new("./-").to_owned(),
                false => page.to_owned(),
            });
            let mut files = AtomicFile::create(session, &[(Role::REPORT, &page)])?;
            let machine = &self.part.machine;
            let cl = ClWindow::of(&self.line.job, machine, &bench.source)?;
            let mut rows = BlockRows::new(machine, cl, told.predict)?;
            let mut came = self.line.make(session, &mut bench, Some(&mut rows))?;
            let (finder, source) = (&bench.finder, &mut bench.source);
            let held = match told.verify {
                true => Some(self.held(session, finder, source, &came.text)?.found),
                false => None,
            };
            let mut heard = None;
            let mut prediction = None;
            if told.predict {
                heard = PredictedParts::of(machine, &mut rows)?;
                let text = (self.name(), Cursor::new(&came.text));
                let with = (&mut *source, heard.as_mut());
                let job = &self.line.job;
                let predicted = self.part.predict(session, job, finder, None, with, text)?;
                came.findings.extend(predicted.findings);
                prediction = Some(predicted.found);
            }
            let made = Made {
                session,
                machine,
                cl: report::name_of(self.line.job.input()),
                program: &self.part.target,
                report: &came.report,
                verification: held.as_ref(),
                prediction: prediction.as_ref(),
                findings: &came.findings,
                job: match self.is_planned() {
                    true => "plan",
                    false => "post",
                },
                facts: summary::facts(&came.report, held.as_ref()),
            };
            let most = told.most_megabytes.saturating_mul(1_000_000);
            let name = self.name();
            let mut text = came.text.as_slice();
            if let Some(file) = files.first_mut() {
                let text: &mut dyn Read = &mut text;
                let texts = (&mut *source, name.as_str(), text);
                made.write((rows, heard), texts, most, file)?;
            }
            Ok(AtomicFile::finish(session, files)?)
        });
        written.map(|_| ())
    }
}
