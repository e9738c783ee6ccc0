//! The verb that has no name: one CL file on one machine becomes one program, or several.

mod parts;
mod setup_sheet;
mod shown;
mod summary;

use std::ops::Range;

use clap::Args;
use post_host::Finder;
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::{Diagnostic, Severity};
use post_plugin::DialectSession;
use post_posting::LookedAhead;
use post_posting::report::Report;
use post_readback::interpret::Limits;
use post_readback::verify::Verification;
use serde::Serialize;

use crate::arguments::{JobArguments, ReportArguments};
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClSource, PathArg, Role};
use crate::job::compensate::{self, Compensation, Moved};
use crate::job::one_program::{Beside, OneProgram};
use crate::job::predict::{self, Against, Asked, Predicted, Prediction};
use crate::job::read_back::{self, Held, Reading};
use crate::job::report::{self, BlockRows, ClWindow, Made, PredictedLines, PredictedRows};
use crate::job::{self, plan_rounds, plugin_finder};
use crate::terminal;
use parts::Split;
use shown::ShownArguments;

const SETUP_SHEET: Role = Role {
    what: "setup sheet",
    remedy: "name another file with --setup-sheet",
};

const PREDICTION: Role = Role {
    what: "prediction",
    remedy: "name another file with --predict=",
};

#[derive(Debug, Args)]
pub struct PostArguments {
    #[command(flatten)]
    job: JobArguments,

    /// The NC program, `-` for standard output. [default: beside the CL file, with the dialect's ending]
    #[arg(short, long, value_name = "FILE", value_parser = PathArg::parser())]
    output: Option<PathArg>,

    /// Writes the summary as JSON for programs to read; `-` is standard output. Of several programs a list.
    #[arg(long, value_name = "FILE", value_parser = PathArg::parser())]
    summary: Option<PathArg>,

    /// Writes a sheet for whoever sets the machine up: tools, extents, times, options; as HTML if the file's name ends
    /// so, else as Markdown.
    #[arg(long, value_name = "FILE", value_parser = PathArg::parser())]
    setup_sheet: Option<PathArg>,

    /// Writes a program of its own for each operation, or for each tool: part-1.nc, part-2.nc, …
    #[arg(long, value_name = "WHERE", value_enum)]
    split: Option<Split>,

    /// The program's number (O1234); of several programs the first's. Short for --set
    /// control.DIALECT.program_number=…
    #[arg(long, value_name = "N")]
    number: Option<u32>,

    /// Reads each program back before it takes its name, runs it as the control does and holds it against the CL file
    /// (`post verify`): what strays from it is not written.
    #[arg(long)]
    verify: bool,

    /// Moves points of the path so that the tool, the servos in between, comes nearer to the path of the CL file; by no
    /// more than the machine file allows (`servo_compensation` under `[accuracy]`; words are rounded besides), and only
    /// where a prediction against the CL file says that it helps by a hundredth or more.
    /// Rapids, holes, tool axes and the ends of cuts stay. Arcs and splines go as moves then, and no
    /// CL point is left out. `--verify` grants the moves; `post verify` later is told so by `--tolerance`, the tolerance and
    /// the bound together. A point of the file takes 150 bytes of memory.
    #[arg(long)]
    compensate_servo: bool,

    /// Plans the feed: the fastest that keeps the feed of the CL file, velocity and acceleration of axes and tip, and what
    /// `[plan]` of the machine file limits besides (contour error of the servos, chord error of the interpolation); jerk too
    /// with its `solver = "jerk"`.
    /// Blocks are cut where their feed changes. `--set plan.contour_error=0.02` sets a limit for one run.
    #[arg(long)]
    plan: bool,

    /// Plans again where the servos are predicted (`post predict`) to leave the tool farther off its path than `[plan]
    /// contour_error`: more gently there, up to so many times, until the limit is kept or the rounds are used up. Tells the
    /// time of each round, and of the program without a plan. Each round posts and predicts the whole program.
    #[arg(long, value_name = "N", requires = "plan", value_parser = clap::value_parser!(u32).range(1..=100))]
    plan_rounds: Option<u32>,

    #[command(flatten)]
    shown: ShownArguments,

    #[command(flatten)]
    report: ReportArguments,

    /// Predicts what each program does on the machine (`post predict`): cycle time, true feed, axes, and how far the tool
    /// strays; with =FILE as JSON too, of several programs a list.
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, value_parser = PathArg::parser())]
    predict: Option<Option<PathArg>>,

    /// No summary, warnings and errors alone.
    #[arg(short, long)]
    quiet: bool,

    /// Takes the error model's word where the certificate finds more, and only reports it. (The placement `fewest` asks
    /// no model.)
    #[arg(long, help_heading = "Plugins")]
    trust_model: bool,
}

/// One program of a run.
struct Part {
    /// Lines of the CL file that it is made of; none: all.
    lines: Option<Range<u64>>,
    target: PathArg,
    machine: Machine,
}

/// Posts as the arguments say.
pub fn run(arguments: &PostArguments) -> Result<(), Failure> {
    let machine = numbered(arguments, arguments.number.map(i64::from))?;
    let finder = plugin_finder::finder(&arguments.job.plugins)?;
    job::say_what_is_left(&arguments.job, &machine, &finder);
    let looks_ahead =
        machine.program.looks_ahead || arguments.split.is_some() || arguments.setup_sheet.is_some();
    let twice = arguments.compensate_servo
        || arguments.plan_rounds.is_some()
        || looks_ahead
        || machine.control.planes
        || arguments.verify
        || arguments.report.report.is_some()
        || arguments.predict.is_some();
    let mut source = ClSource::new(arguments.job.input(), twice)?;
    let ahead = match looks_ahead {
        true => Some(job::look_ahead(
            &arguments.job,
            &machine,
            &finder,
            &mut source,
            None,
        )?),
        false => None,
    };
    let parts = the_parts(arguments, machine, &finder, ahead.as_ref())?;
    let places = arguments.shown.places(arguments.split, parts.len());
    let folders = places.folders()?;
    let mut targets: Vec<(Role, &PathArg)> = parts
        .iter()
        .map(|part| (Role::PROGRAM, &part.target))
        .collect();
    targets.extend(places.maps.iter().map(|map| (shown::MAP, map)));
    let pages = parts::each(&arguments.report.report, arguments.split, parts.len());
    targets.extend(pages.iter().map(|page| (Role::REPORT, page)));
    targets.extend(
        arguments
            .summary
            .iter()
            .map(|summary| (Role::SUMMARY, summary)),
    );
    targets.extend(
        arguments
            .setup_sheet
            .iter()
            .map(|sheet| (SETUP_SHEET, sheet)),
    );
    let prediction = arguments.predict.iter().flatten();
    targets.extend(prediction.map(|target| (PREDICTION, target)));
    // All are opened before the work begins: a program without its summary would be half a result.
    let mut files = AtomicFile::create(&targets)?;
    let mut reports = Vec::new();
    let mut verifications = Vec::new();
    let mut predictions = Vec::new();
    let mut compensations = Vec::new();
    let mut plans = Vec::new();
    let mut findings = Vec::new();
    let mut drawn = Vec::new();
    let (programs, others) = files.split_at_mut(parts.len());
    let (maps, others) = others.split_at_mut(places.maps.len());
    let mut maps = maps.iter_mut();
    let (pages, others) = others.split_at_mut(pages.len());
    let mut pages = pages.iter_mut();
    for (part, file) in parts.iter().zip(programs) {
        let mut program = OneProgram {
            arguments: &arguments.job,
            machine: &part.machine,
            finder: &finder,
            target: &part.target,
            lines: part.lines.clone(),
            trust_model: arguments.trust_model,
            plans: arguments.plan,
            tightening: None,
        };
        if let Some(most) = arguments.plan_rounds {
            let (tightening, found) =
                plan_rounds::plan(&program, most, ahead.as_ref(), &mut source)?;
            program.tightening = tightening;
            findings.extend(plan_rounds::warning(&found));
            plans.push(found);
        }
        let compensated = match arguments.compensate_servo {
            true => Some(compensate::compensate(
                &program,
                ahead.as_ref(),
                &mut source,
            )?),
            false => None,
        };
        let draws = !folders.is_empty();
        let page = pages.next();
        let mut rows = match page {
            Some(_) => {
                let input = source.open_beside()?;
                let settings =
                    read_back::course_settings(&arguments.job, &part.machine, &input.name);
                let cl = ClWindow::new(&part.machine, settings, input.bytes)?;
                let predicted = arguments.predict.is_some();
                Some(BlockRows::new(&part.machine, cl, predicted)?)
            }
            None => None,
        };
        let wrote = shown::show(&part.machine, &part.target, maps.next(), draws, |watch| {
            let files = (&mut source, &mut *file);
            let mut beside = Beside {
                watch,
                ..Beside::default()
            };
            if let Some(rows) = &mut rows {
                beside.observer = Some(rows);
            }
            write(program, compensated.as_ref(), ahead.as_ref(), files, beside)
        })?;
        let ((report, found), pictures) = wrote;
        drawn.extend(pictures);
        let moved = compensated.as_ref().is_some_and(|moved| moved.found.kept);
        compensations.extend(compensated.map(|moved| moved.found));
        // What is wrong with the file is found again in each of its parts.
        for finding in found {
            if !findings.contains(&finding) {
                findings.push(finding);
            }
        }
        match report {
            Some(report) => reports.push(report),
            None => return Err(findings.into()),
        }
        if arguments.verify {
            let held = read_back(arguments, part, moved, &finder, &mut source, file)?;
            if held.is_wrong() {
                findings.extend(held.findings);
                return Err(findings.into());
            }
            verifications.push(held.found);
        }
        let mut heard = None;
        if arguments.predict.is_some() {
            let lines = rows.as_mut().map(BlockRows::lines).transpose()?;
            if let Some(lines) = lines.flatten() {
                let period = part.machine.motion.period;
                heard = Some((
                    PredictedLines::new(&part.machine, period)?,
                    PredictedRows::new(&part.machine, lines)?,
                ));
            }
            let files = (&mut source, &mut *file);
            let predicted = predicted(arguments, part, &finder, files, heard.as_mut())?;
            findings.extend(predicted.findings);
            predictions.push(predicted.found);
        }
        if let (Some(page), Some(rows), Some(report)) = (page, rows, reports.last()) {
            let made = Made {
                machine: &part.machine,
                cl: report::name_of(arguments.job.input()),
                program: &part.target,
                report,
                verification: verifications.last(),
                prediction: predictions.last(),
                findings: &findings,
                job: match arguments.plan {
                    true => "plan",
                    false => "post",
                },
                facts: summary::facts(report, verifications.last()),
            };
            let rows = (rows, heard);
            made.write(rows, (&mut source, file), arguments.report.most(), page)?;
        }
    }
    let mut others = others.iter_mut();
    let mut next_if = |asked: bool| asked.then(|| others.next()).flatten();
    if let Some(file) = next_if(arguments.summary.is_some()) {
        let told: Vec<Told<'_>> = reports
            .iter()
            .enumerate()
            .map(|(index, report)| Told {
                report,
                verification: verifications.get(index),
                prediction: predictions.get(index),
                servo_compensation: compensations.get(index),
                plan_rounds: plans.get(index),
            })
            .collect();
        let json = match (arguments.split, told.as_slice()) {
            (None, [told]) => files::json(told),
            (_, told) => files::json(&told),
        };
        file.write_bytes(json.as_bytes())?;
    }
    let sheet_file = next_if(arguments.setup_sheet.is_some());
    if let (Some(sheet), Some(ahead), Some(file)) = (&arguments.setup_sheet, &ahead, sheet_file) {
        let programs: Vec<_> = parts
            .iter()
            .map(|part| &part.target)
            .zip(&reports)
            .collect();
        let text = setup_sheet::text(
            sheet,
            &parts[0].machine,
            arguments.job.input(),
            ahead,
            &programs,
        );
        file.write_bytes(text.as_bytes())?;
    }
    if let Some(file) = next_if(matches!(arguments.predict, Some(Some(_)))) {
        let json = match (arguments.split, predictions.as_slice()) {
            (None, [prediction]) => files::json(prediction),
            (_, predictions) => files::json(&predictions),
        };
        file.write_bytes(json.as_bytes())?;
    }
    // Standard output is for a program or for JSON, alone there.
    let taken = files.iter().any(AtomicFile::is_standard);
    for (folder, pictures) in folders.iter().zip(&drawn) {
        folder.add(pictures, &mut files)?;
    }
    AtomicFile::finish(files)?;
    for (folder, pictures) in folders.iter().zip(&drawn) {
        folder.tidy(pictures)?;
    }
    debug_assert!(
        findings
            .iter()
            .all(|finding| finding.severity == Severity::Warning)
    );
    terminal::findings(&findings);
    if !arguments.quiet {
        let name = arguments.job.input().path();
        let name = name.map_or("standard input".to_owned(), |path| {
            path.display().to_string()
        });
        for (index, (part, report)) in parts.iter().zip(&reports).enumerate() {
            let mut text = summary::text(report, verifications.get(index), &name, &part.target);
            if let Some(found) = compensations.get(index) {
                text.push_str(&compensate::text(found));
            }
            if let Some(found) = plans.get(index) {
                text.push_str(&plan_rounds::text(found));
            }
            if let Some(found) = predictions.get(index) {
                text.push('\n');
                text.push_str(&predict::text(found));
            }
            if taken {
                terminal::tell(&text);
            } else {
                terminal::print(&text);
            }
        }
    }
    Ok(())
}

/// Writes a program, its points moved where that helps; `beside` sees its plan and its blocks.
fn write(
    program: OneProgram<'_>,
    compensated: Option<&Compensation>,
    ahead: Option<&LookedAhead>,
    (source, file): (&mut ClSource, &mut AtomicFile),
    beside: Beside<'_, '_, '_>,
) -> Result<(Option<Report>, Vec<Diagnostic>), Failure> {
    let moved = compensated.and_then(|found| Some((&found.machine, found.moves.as_ref()?)));
    let Some((machine, moves)) = moved else {
        return program.write(ahead, source, file, beside);
    };
    let program = OneProgram { machine, ..program };
    let mut moved = Moved::new(moves);
    let beside = Beside {
        shift: Some(&mut moved),
        ..beside
    };
    program.write(ahead, source, file, beside)
}

/// The machine of the command line, its program so numbered if a number is given.
fn numbered(arguments: &PostArguments, number: Option<i64>) -> Result<Machine, Failure> {
    let machine = job::machine(&arguments.job, &[])?;
    let Some(number) = number else {
        return Ok(machine);
    };
    let dialect = machine.control.dialect;
    let setting = Setting::Written(format!("control.{dialect}.program_number={number}"));
    job::machine(&arguments.job, &[setting])
}

/// The programs of the run: one, or as many as the CL file has operations or tools.
fn the_parts(
    arguments: &PostArguments,
    machine: Machine,
    finder: &Finder,
    ahead: Option<&LookedAhead>,
) -> Result<Vec<Part>, Failure> {
    let source = arguments.job.input();
    let program = job::program_name(source, arguments.output.as_ref());
    let (dialect, _) = plugin_finder::dialect(finder, &machine, &program, Some(source))?;
    let extension = machine.program.extension.clone();
    let target = program_target(
        arguments,
        &extension.unwrap_or(dialect.format().extension.clone()),
    );
    let (Some(split), Some(ahead)) = (arguments.split, ahead) else {
        return Ok(vec![Part {
            lines: None,
            target,
            machine,
        }]);
    };
    if target == PathArg::Standard {
        return Err(Diagnostic::error(
            "split",
            "--split writes several programs, and standard output takes one",
        )
        .help("name a file with -o")
        .into());
    }
    let lines = parts::lines(split, ahead)?;
    let count = lines.len();
    // Programs of one number would take each other's place in the control.
    let number = plugin_finder::program_number(finder, &machine);
    lines
        .into_iter()
        .enumerate()
        .map(|(index, lines)| {
            Ok(Part {
                lines: Some(lines),
                target: parts::target(&target, index + 1, count),
                machine: numbered(arguments, number.map(|first| first + index as i64))?,
            })
        })
        .collect()
}

/// Reads a program back from the disk and holds it against the CL file; `moved` if its points were moved for the servos.
fn read_back(
    arguments: &PostArguments,
    part: &Part,
    moved: bool,
    finder: &Finder,
    source: &mut ClSource,
    file: &mut AtomicFile,
) -> Result<Held, Failure> {
    // What was moved on purpose is off the CL file by that.
    let accuracy = &part.machine.accuracy;
    let bound = accuracy.servo_compensation.filter(|_| moved);
    let moved = bound.map(|bound| accuracy.tolerance + bound);
    let reading = Reading {
        arguments: &arguments.job,
        machine: &part.machine,
        finder,
        offsets: None,
        limits: Limits::default(),
        tolerances: [moved, None],
        planned: arguments.plan,
        solutions: false,
        lines: part.lines.clone(),
    };
    let name = file.name().to_owned();
    let text = file.reread()?;
    read_back::verify(&reading, source, &name, text, &mut |_| {})
}

/// Predicts what a program does, read back from the disk.
fn predicted(
    arguments: &PostArguments,
    part: &Part,
    finder: &Finder,
    (source, file): (&mut ClSource, &mut AtomicFile),
    mut heard: Option<&mut (PredictedLines, PredictedRows<'_>)>,
) -> Result<Predicted, Failure> {
    let asked = Asked {
        arguments: &arguments.job,
        machine: &part.machine,
        finder,
        offsets: None,
        limits: Limits::default(),
        period: None,
        lines: part.lines.clone(),
    };
    let name = file.name().to_owned();
    let text = file.reread()?;
    predict::predict(&asked, Against::Cl(source), &name, text, &mut |sample| {
        if let Some((series, rows)) = &mut heard {
            series.take(sample, rows);
        }
        Ok(())
    })
}

/// What the summary tells as JSON.
#[derive(Serialize)]
struct Told<'a> {
    #[serde(flatten)]
    report: &'a Report,
    /// What reading the program back has found.
    #[serde(skip_serializing_if = "Option::is_none")]
    verification: Option<&'a Verification>,
    /// What is predicted of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    prediction: Option<&'a Prediction>,
    /// What moving points for the servos has done.
    #[serde(skip_serializing_if = "Option::is_none")]
    servo_compensation: Option<&'a compensate::Found>,
    /// What planning the feed in rounds has done.
    #[serde(skip_serializing_if = "Option::is_none")]
    plan_rounds: Option<&'a plan_rounds::Found>,
}

/// Where the program goes.
fn program_target(arguments: &PostArguments, extension: &str) -> PathArg {
    let beside = || {
        let source = arguments.job.input();
        source.map(|path| path.with_extension(extension))
    };
    arguments.output.clone().unwrap_or_else(beside)
}
