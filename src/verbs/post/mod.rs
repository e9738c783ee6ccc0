//! The verb that has no name: one CL file on one machine becomes one program, or several.

mod parts;
mod setup_sheet;
mod shown;

use std::io::Read;

use clap::Args;
use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Severity};
use post_posting::LookedAhead;

use crate::arguments::{JobArguments, MakingArguments, ReportArguments};
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClSource, PathArg, Role};
use crate::job::making::{self, Part, Ready};
use crate::job::one_program::{Beside, OneProgram};
use crate::job::report::{self, BlockRows, ClWindow, Made, PredictedParts};
use crate::job::summary::{self, Told};
use crate::job::{self, compensate, plan_rounds, plugin_finder, predict};
use crate::session::Session;
use crate::terminal;
use parts::Split;
use shown::ShownArguments;

const SETUP_SHEET: Role =
    Role { what: "setup sheet", remedy: "name another file with --setup-sheet" };

const PREDICTION: Role = Role { what: "prediction", remedy: "name another file with --predict=" };

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

    /// Reads each program back before it takes its name, runs it as the control does and holds it against the CL file
    /// (`post verify`): what strays from it is not written.
    #[arg(long)]
    verify: bool,

    #[command(flatten)]
    making: MakingArguments,

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
}

/// Posts as the arguments say.
pub fn run(session: &Session, arguments: &PostArguments) -> Result<(), Failure> {
    let making = &arguments.making;
    let machine = making::numbered(session, &arguments.job, making.number.map(i64::from))?;
    let finder = plugin_finder::finder(session, &arguments.job.plugins)?;
    job::say_what_is_left(session, &arguments.job, &machine, &finder);
    let looks_ahead =
        machine.program.looks_ahead || arguments.split.is_some() || arguments.setup_sheet.is_some();
    let twice = making.compensate_servo
        || making.plan
        || looks_ahead
        || machine.control.planes
        || arguments.verify
        || arguments.report.report.is_some()
        || arguments.predict.is_some();
    let mut source = ClSource::new(session, arguments.job.input(), twice)?;
    let ahead = match looks_ahead {
        true => {
            Some(job::look_ahead(session, &arguments.job, &machine, &finder, &mut source, None)?)
        }
        false => None,
    };
    let parts = the_parts(session, arguments, machine, &finder, ahead.as_ref())?;
    let places = arguments.shown.places(arguments.split, parts.len());
    let folders = places.folders(session)?;
    let mut targets: Vec<(Role, &PathArg)> =
        parts.iter().map(|part| (Role::PROGRAM, &part.target)).collect();
    targets.extend(places.maps.iter().map(|map| (shown::MAP, map)));
    let pages = parts::each(&arguments.report.report, arguments.split, parts.len());
    targets.extend(pages.iter().map(|page| (Role::REPORT, page)));
    targets.extend(arguments.summary.iter().map(|summary| (Role::SUMMARY, summary)));
    targets.extend(arguments.setup_sheet.iter().map(|sheet| (SETUP_SHEET, sheet)));
    let prediction = arguments.predict.iter().flatten();
    targets.extend(prediction.map(|target| (PREDICTION, target)));
    // All are opened before the work begins: a program without its summary would be half a result.
    let mut files = AtomicFile::create(session, &targets)?;
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
        let program = OneProgram {
            session,
            arguments: &arguments.job,
            machine: &part.machine,
            finder: &finder,
            target: &part.target,
            lines: part.lines.clone(),
            trust_model: making.trust_model,
            plans: making.plan,
            tightening: None,
        };
        let shown = !folders.is_empty() || !places.maps.is_empty();
        let ready = Ready::new(program, making, ahead.as_ref(), &mut source, shown)?;
        findings.extend(ready.warning());
        let draws = !folders.is_empty();
        let page = pages.next();
        let mut rows = match page {
            Some(_) => {
                let cl = ClWindow::of(&arguments.job, &part.machine, &source)?;
                let predicted = arguments.predict.is_some();
                Some(BlockRows::new(&part.machine, cl, predicted)?)
            }
            None => None,
        };
        let wrote = shown::show(&part.machine, &part.target, maps.next(), draws, |watch| {
            let files = (&mut source, &mut *file);
            let mut beside = Beside { watch, ..Beside::default() };
            if let Some(rows) = &mut rows {
                beside.observer = Some(rows);
            }
            ready.write(ahead.as_ref(), files.0, files.1, beside)
        })?;
        let ((report, found), pictures) = wrote;
        drawn.extend(pictures);
        let moved = ready.is_moved();
        let (planned, compensated) = ready.found();
        plans.extend(planned);
        compensations.extend(compensated);
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
            let text = (file.name().to_owned(), file.reread()?);
            let how = (moved, making.plan);
            let held = part.read_back(session, &arguments.job, &finder, how, &mut source, text)?;
            if held.is_wrong() {
                findings.extend(held.findings);
                return Err(findings.into());
            }
            verifications.push(held.found);
        }
        let mut heard = None;
        if arguments.predict.is_some() {
            if let Some(rows) = &mut rows {
                heard = PredictedParts::of(&part.machine, rows)?;
            }
            let text = (file.name().to_owned(), file.reread()?);
            let told = (&mut source, heard.as_mut());
            let predicted = part.predict(session, &arguments.job, &finder, None, told, text)?;
            findings.extend(predicted.findings);
            predictions.push(predicted.found);
        }
        if let (Some(page), Some(rows), Some(report)) = (page, rows, reports.last()) {
            let made = Made {
                session,
                machine: &part.machine,
                cl: report::name_of(arguments.job.input()),
                program: &part.target,
                report,
                verification: verifications.last(),
                prediction: predictions.last(),
                findings: &findings,
                job: match making.plan {
                    true => "plan",
                    false => "post",
                },
                facts: summary::facts(report, verifications.last()),
            };
            let rows = (rows, heard);
            let name = file.name().to_owned();
            let text = (&mut source, name.as_str(), &mut file.reread()? as &mut dyn Read);
            made.write(rows, text, arguments.report.most(), page)?;
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
        let programs: Vec<_> = parts.iter().map(|part| &part.target).zip(&reports).collect();
        let text =
            setup_sheet::text(sheet, &parts[0].machine, arguments.job.input(), ahead, &programs);
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
    AtomicFile::finish(session, files)?;
    for (folder, pictures) in folders.iter().zip(&drawn) {
        folder.tidy(pictures)?;
    }
    debug_assert!(findings.iter().all(|finding| finding.severity == Severity::Warning));
    session.findings(&findings);
    if !arguments.quiet {
        let name = arguments.job.input().path();
        let name = name.map_or("standard input".to_owned(), |path| path.display().to_string());
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
                terminal::print(session, &text);
            }
        }
    }
    Ok(())
}

/// The programs of the run: one, or as many as the CL file has operations or tools.
fn the_parts(
    session: &Session,
    arguments: &PostArguments,
    machine: Machine,
    finder: &Finder,
    ahead: Option<&LookedAhead>,
) -> Result<Vec<Part>, Failure> {
    let target = making::target(&arguments.job, arguments.output.as_ref(), &machine, finder)?;
    let (Some(split), Some(ahead)) = (arguments.split, ahead) else {
        return Ok(vec![Part { lines: None, target, machine }]);
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
            let number = number.map(|first| first + index as i64);
            Ok(Part {
                lines: Some(lines),
                target: parts::target(&target, index + 1, count),
                machine: making::numbered(session, &arguments.job, number)?,
            })
        })
        .collect()
}
