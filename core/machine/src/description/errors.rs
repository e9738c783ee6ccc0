//! `[error.X]`: errors of an axis that depend on where it stands, as a measuring run finds them.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use nalgebra::{Rotation3, Vector3};
use post_grammar::text::excerpt;
use toml::Spanned;

use super::bounds::Bounds;
use super::build::Builder;
use super::error_rows::{ErrorRows, MM_PER_M, measured, parts};
use super::error_run;
use super::keys::axes_are;
use super::limits::MOST_ERROR_ROWS;
use super::quantity::KeyedNumber;
use super::table::{keys, words};
use super::{Axis, Machine, Tcp};
use crate::dependent_limit::SHOWN;
use crate::diagnostic::{Diagnostic, SourcePlace};
use crate::kinematics::{AxisErrors, acts_before};

const CODE: &str = "machine-errors";

keys! {
    /// Errors of an axis that depend on where it stands (ISO 230-1, 230-7): of the tool as seen from the part.
    ErrorFile {
        /// What the columns of `rows` are: first the axis by its name (mm or degrees, as the control shows it), then errors by
        /// theirs: `EXX`, `EYX`, `EZX` displace along X, Y, Z, `EAX`, `EBX`, `ECX` turn about them, the last letter being that
        /// of the axis. Those that are not there are none.
        columns: Vec<Spanned<String>>,
        /// What was measured, a row a place of the axis, rising: errors are interpolated linearly between, and are those of
        /// the first and last row beyond.
        rows: Vec<Spanned<Vec<KeyedNumber>>>,
        /// A file of comma-separated values in the place of both, as a measuring run writes it: lines about the run, then the
        /// columns, units behind their names (`EXX [µm]`, `EAX (arcsec)`), then a line a row, rising or falling. Decimals
        /// may have commas where semicolons keep cells apart. Of places that are come to from both sides the mean counts.
        file: Option<Spanned<String>>,
        /// Units of the errors.
        units: ErrorUnits = Bounds { default: Some("\"mm\""), ..Bounds::ANY },
        /// The point whose displacement was measured, mm, machine frame, all axes at zero: of a linear axis it goes with what
        /// that moves, default the gauge point; of a rotary one it stands, default its `point`.
        point: Option<[KeyedNumber; 3]>,
        /// Squareness: how the line of the axis is turned about X, Y and Z (A0, B0, C0), mm/m or µm/m; its direction as
        /// measured says the same.
        squareness: Option<[KeyedNumber; 3]>,
        /// By how much the tip may stray beside what was measured, mm: the certificate counts it on every block.
        uncertainty: Option<KeyedNumber> = Bounds::from_zero(CODE),
    }
}

words! {
    /// Units of errors.
    ErrorUnits = Mm {
        /// mm, and mm/m for turns.
        Mm "mm",
        /// Thousandths of them: µm, and µm/m (µrad) for turns.
        Micrometre "um",
    }
}

impl ErrorUnits {
    /// mm, or mm/m, in one of them.
    pub(super) fn in_mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Micrometre => 1e-3,
        }
    }
}

/// A file of errors that a machine file names, and what that says of it.
#[derive(Clone, Debug)]
pub struct ErrorTable {
    /// The file, as seen from the folder that the command works in.
    pub file: PathBuf,
    /// Where it is named.
    pub place: Option<SourcePlace>,
    units: ErrorUnits,
    /// What is known but for its rows.
    errors: AxisErrors,
}

impl Machine {
    /// Takes the errors that the text of a file has, one of [`Machine::error_tables`].
    ///
    /// # Errors
    /// What is wrong with it, and in which line; no text of it is shown.
    pub fn take_errors(&mut self, table: &ErrorTable, text: &str) -> Result<(), Box<Diagnostic>> {
        let axis = &self.axes[table.errors.joint];
        let name = table.file.display().to_string();
        let rows = error_run::read(text, axis, table.units).map_err(|fault| {
            let place = SourcePlace::new(&name, fault.line, "", 0..0);
            Diagnostic::error(CODE, fault.message).at(Some(place)).help(fault.help).boxed()
        })?;
        let ErrorRows { places, motions } = rows;
        let mut all = self.errors.to_vec();
        all.push(AxisErrors { places, motions, ..table.errors.clone() });
        self.errors = all.into();
        Ok(())
    }
}

impl Builder<'_> {
    /// The errors of the axes that have any, and the files of others; squareness turns the lines of `axes`.
    pub(super) fn axis_errors(
        &mut self,
        file: &BTreeMap<Spanned<String>, Spanned<ErrorFile>>,
        axes: &mut [Axis],
        gauge: Vector3<f64>,
    ) -> (Arc<[AxisErrors]>, Vec<ErrorTable>) {
        let (mut all, mut tables) = (Vec::new(), Vec::new());
        for (name, given) in file {
            let Some(place) = axes.iter().position(|axis| axis.name == *name.get_ref()) else {
                let text = excerpt(name.get_ref(), SHOWN);
                let message = format!("[error.{text}] is that of no axis; {}", axes_are(axes));
                self.fault(CODE, name.span(), message, "");
                continue;
            };
            let file = given.get_ref();
            if let Some(square) = &file.squareness {
                let turn = self.vector(square) * file.units.in_mm() * MM_PER_M;
                let joint = &mut axes[place].joint;
                joint.direction = Rotation3::new(turn) * joint.direction;
            }
            let axis = &axes[place];
            let default = if axis.joint.rotary { axis.joint.point } else { gauge };
            let errors = AxisErrors {
                joint: place,
                places: Vec::new(),
                motions: Vec::new(),
                point: file.point.as_ref().map_or(default, |point| self.vector(point)),
                before: acts_before(&axis.joint, axis.carries_part),
                endless: axis.joint.rotary && axis.travel.is_none(),
                uncertainty: self.checked(&file.uncertainty).unwrap_or(0.0),
            };
            let inline = !file.columns.is_empty() || !file.rows.is_empty();
            match &file.file {
                Some(named) if inline => {
                    let message = format!("the errors of {} stand here and in a file", axis.name);
                    self.fault(CODE, named.span(), message, "either columns and rows, or file");
                }
                Some(named) => tables.extend(self.error_table(named, file.units, errors)),
                None if inline || file.squareness.is_none() => {
                    if let Some(ErrorRows { places, motions }) =
                        self.error_rows(file, axis, given.span())
                    {
                        all.push(AxisErrors { places, motions, ..errors });
                    }
                }
                None => {}
            }
        }
        (all.into(), tables)
    }

    /// A file of errors. A machine file may be a stranger's: what it names is not any file of the user's.
    fn error_table(
        &mut self,
        named: &Spanned<String>,
        units: ErrorUnits,
        errors: AxisErrors,
    ) -> Option<ErrorTable> {
        let path = Path::new(named.get_ref());
        let ending = path.extension().unwrap_or_default();
        if !ending.eq_ignore_ascii_case("csv") {
            let text = excerpt(named.get_ref(), SHOWN);
            let message = format!("`{text}` is no name of a file of errors");
            self.fault(CODE, named.span(), message, "it ends in .csv");
            return None;
        }
        let place = self.sources.place(named.span());
        let folder = place.as_ref().and_then(|at| Path::new(&at.file).parent());
        let file = folder.unwrap_or_else(|| Path::new("")).join(path);
        Some(ErrorTable { file, place, units, errors })
    }

    /// Where an axis was measured, and the errors there.
    fn error_rows(
        &mut self,
        file: &ErrorFile,
        axis: &Axis,
        span: Range<usize>,
    ) -> Option<ErrorRows> {
        self.check_size("[error]", file.rows.iter().map(Spanned::span), MOST_ERROR_ROWS);
        let names: Vec<&str> = file.columns.iter().map(|name| name.get_ref().as_str()).collect();
        let rows: Vec<Vec<f64>> = file
            .rows
            .iter()
            .map(|row| row.get_ref().iter().map(|number| self.number(number)).collect())
            .collect();
        let found = parts(&names, axis)
            .and_then(|parts| measured(rows.into_iter(), &parts, axis, file.units));
        let fault = match found {
            Ok(rows) => return Some(rows),
            Err(fault) => fault,
        };
        let row = fault.row.and_then(|row| file.rows.get(row));
        let number = row.zip(fault.column).and_then(|(row, column)| row.get_ref().get(column));
        let column = fault.column.filter(|_| row.is_none()).and_then(|at| file.columns.get(at));
        let place = number
            .map(KeyedNumber::span)
            .or(row.map(Spanned::span))
            .or(column.map(Spanned::span))
            .unwrap_or(span);
        self.fault(CODE, place, fault.message, &fault.help);
        None
    }

    /// Errors are compensated in axis values: what cannot be is refused.
    pub(super) fn check_errors(&mut self, machine: &Machine, span: Range<usize>) {
        if machine.errors.is_empty() && machine.error_tables.is_empty() {
            return;
        }
        let tables = machine.error_tables.iter().map(|table| &table.errors);
        let all = machine.errors.iter().chain(tables);
        let uncertainty: f64 = all.map(|errors| errors.uncertainty).sum();
        let tolerance = machine.accuracy.tolerance;
        if uncertainty >= tolerance {
            let message = format!(
                "[error] uncertainties come to {uncertainty} mm together, and the tolerance is {tolerance} mm: nothing could be certified"
            );
            let help = "a larger [accuracy] tolerance, or better measurements";
            self.fault(CODE, span.clone(), message, help);
        }
        if machine.control.tcp == Tcp::Control {
            let message = "with tcp = \"control\" the control works the axes out, and [error] does not reach them";
            let help = "tcp = \"post\" writes axis positions with the errors taken out; or leave [error] out, for the control's own volumetric compensation";
            self.fault(CODE, span.clone(), message.to_owned(), help);
        }
        if machine.has_modes() {
            let message = "[error] does not reach what the control interpolates by itself in [mode.face] and [mode.wrap]".to_owned();
            let help = "leave [mode] out, so that each block is axis positions with the errors taken out; or leave [error] out";
            self.fault(CODE, span, message, help);
        }
    }
}
