//! Where the lines of a machine's axes are, from a table of readings of a ball.

mod points;

use std::io::Read as _;
use std::path::PathBuf;

use post_machine::calibrate::{
    CalibratedLine, CalibratedNumber, Calibration, CalibrationFault, Unknown, calibrate,
};
use post_machine::check::number;
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::{Diagnostic, meant};

use crate::failure::Failure;
use crate::files::{FileFault, PathArg};
use crate::machine_files;
use crate::nc_program::open_table;
use crate::session::Session;

/// What is to be found.
#[derive(Clone, Debug)]
pub struct CalibrationRequest {
    /// The machine, by its name or its file.
    pub machine: String,
    /// Further folders of machine files.
    pub machines: Vec<PathBuf>,
    /// Settings over the machine file.
    pub settings: Vec<Setting>,
    /// The table of readings.
    pub points: PathArg,
    /// What is looked for: `C.point`, `C.rotary`, `Y.linear`, parameters; empty: the lines of all rotary axes.
    pub fit: Vec<String>,
    /// Length of the tool where the table does not say, mm.
    pub length: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct CalibrationFound {
    /// Readings that there were.
    pub readings: usize,
    /// What they say.
    pub calibration: Calibration,
    /// Lines of the table that do not go with the others, in the order of the calibration's outliers.
    pub outliers: Vec<u64>,
    /// Lines of a machine file that extends this one.
    pub lines: String,
    /// Readings that do not go with the others.
    pub findings: Vec<Diagnostic>,
}

/// Finds the numbers of the request.
///
/// # Errors
/// A file that cannot be read, and numbers that the readings do not determine.
pub fn find(session: &Session, request: &CalibrationRequest) -> Result<CalibrationFound, Failure> {
    let CalibrationRequest { machine: name, machines, settings, .. } = request;
    let mut load =
        |more: &[Setting]| machine_files::load(session, name, machines, &[settings, more].concat());
    let machine = load(&[])?;
    let unknowns = unknowns(session, request, &machine)?;
    let (file, text) = text(session, &request.points)?;
    let table = points::read(&machine, request.length, &file, &text)?;
    let found = calibrate(&unknowns, &table.readings, &mut load);
    let calibration = found.map_err(|fault| refusal(&file, fault))?;
    let errors = (!machine.errors.is_empty() || !machine.error_tables.is_empty()).then(|| {
        let message = "[error] tables of the machine file are not counted: the readings are taken for those of the axes as they are drawn";
        Diagnostic::warning("calibrate", message.to_owned())
            .help("measure first and calibrate, then measure the errors that are left")
    });
    let outliers: Vec<u64> =
        calibration.outliers.iter().map(|outlier| table.lines[outlier.reading]).collect();
    let told = calibration.outliers.iter().zip(&outliers).map(|(outlier, line)| {
        let message = format!(
            "{file}, line {line}: this reading is {} mm from where the others say the ball is, {} sigma",
            number(outlier.off, 4),
            number(outlier.sigma, 1)
        );
        Diagnostic::warning("calibrate", message).help(
            "look at it, measure it again, or leave it out: one bad reading draws all numbers; it is among those that the lines below are of",
        )
    });
    let findings = told.chain(errors).collect();
    Ok(CalibrationFound {
        readings: table.readings.len(),
        lines: lines(name, &unknowns, &calibration),
        calibration,
        outliers,
        findings,
    })
}

/// The table's name and text.
fn text(session: &Session, points: &PathArg) -> Result<(String, String), Failure> {
    let (name, mut file) = open_table(session, "the table of readings", points)?;
    let mut bytes = Vec::new();
    let read = file.read_to_end(&mut bytes);
    read.map_err(|error| FileFault::Read { name: name.clone(), error })?;
    Ok((name, String::from_utf8_lossy(&bytes).into_owned()))
}

/// What is looked for.
fn unknowns(
    session: &Session,
    request: &CalibrationRequest,
    machine: &Machine,
) -> Result<Vec<Unknown>, Failure> {
    if request.fit.is_empty() {
        return Ok(Unknown::usual(machine));
    }
    let numbers = machine_files::numbers(session, &request.machine, &request.machines)?;
    let parameters = || {
        let stated = numbers.iter();
        stated.filter_map(|stated| Some((stated.key.strip_prefix("parameters.")?, &stated.value)))
    };
    let mut found: Vec<Unknown> = Vec::new();
    for wanted in &request.fit {
        let line = machine.axes.iter().find_map(|axis| {
            let rotary = axis.joint.rotary;
            let which = match wanted.strip_prefix(axis.name.as_str())? {
                ".point" if rotary => CalibratedLine::Point,
                ".rotary" if rotary => CalibratedLine::Direction,
                ".linear" if !rotary => CalibratedLine::Direction,
                _ => return None,
            };
            Some(Unknown::of_axis(axis, which))
        });
        let parameter = || {
            let (name, value) = parameters().find(|(name, _)| name == wanted)?;
            Some(Unknown::Parameter { name: name.to_owned(), value: value.parse().ok()? })
        };
        let Some(unknown) = line.or_else(parameter) else {
            return Err(unknown_name(machine, wanted, parameters().map(|(name, _)| name)).into());
        };
        if found.contains(&unknown) {
            let message = format!("--fit names {wanted} twice");
            return Err(Diagnostic::error("calibrate", message).into());
        }
        found.push(unknown);
    }
    Ok(found)
}

/// A name of `--fit` that is none.
fn unknown_name<'p>(
    machine: &Machine,
    wanted: &str,
    parameters: impl Iterator<Item = &'p str>,
) -> Diagnostic {
    let lines = machine.axes.iter().flat_map(|axis| match axis.joint.rotary {
        true => vec![format!("{}.point", axis.name), format!("{}.rotary", axis.name)],
        false => vec![format!("{}.linear", axis.name)],
    });
    let known: Vec<String> = lines.chain(parameters.map(str::to_owned)).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let message = format!("--fit {wanted}: no line of an axis, and no parameter that is a number");
    Diagnostic::error("calibrate", message).help(meant(wanted, "there are", &known))
}

/// Why nothing was found.
fn refusal(file: &str, fault: CalibrationFault<Failure>) -> Failure {
    let error = |message: String, help: &str| Diagnostic::error("calibrate", message).help(help);
    let finding = match fault {
        CalibrationFault::Machine(failure) => return failure,
        CalibrationFault::TooFew { have, want } => error(
            format!("{file}: {have} measured coordinates, and {want} numbers are looked for"),
            "more readings, with other rotary axes turned; or fewer numbers, named by --fit",
        ),
        CalibrationFault::Lost => error(
            format!("{file}: no numbers go with these readings"),
            "is it this machine, are signs and columns right? post check tells what each axis does",
        ),
        CalibrationFault::Undetermined(groups) => {
            let each = groups.iter().map(|group| group.join(" with "));
            let each: Vec<String> = each.collect();
            error(
                format!("{file}: these readings do not determine {}", each.join("; ")),
                "readings at other angles, with a longer tool or the ball farther out; or leave numbers out: --fit names those that are looked for",
            )
        }
    };
    finding.into()
}

/// Lines of a machine file: numbers to a tenth of their standard errors.
fn lines(name: &str, unknowns: &[Unknown], calibration: &Calibration) -> String {
    let mut text = format!("extends = {name:?}\n");
    let mut numbers = calibration.numbers.iter();
    let mut parameters = String::new();
    for unknown in unknowns {
        match unknown {
            Unknown::Parameter { name, .. } => {
                let found = numbers.next().map(rounded).unwrap_or_default();
                parameters.push_str(&format!("{name} = {found}\n"));
            }
            Unknown::Line { key, vector, free } => {
                let mut cells = [0, 1, 2].map(|place| number(vector[place], 9));
                for place in free {
                    cells[*place] = numbers.next().map(rounded).unwrap_or_default();
                }
                text.push_str(&format!("{key} = [{}]\n", cells.join(", ")));
            }
        }
    }
    if !parameters.is_empty() {
        text.push_str(&format!("\n[parameters]\n{parameters}"));
    }
    text
}

/// A number to a tenth of its standard error, and never rounder than nine decimals tell.
fn rounded(found: &CalibratedNumber) -> String {
    let digits = (1.0 - libm::log10(found.deviation.max(1e-9))).clamp(3.0, 9.0);
    number(found.value, libm::ceil(digits) as usize)
}
