//! Columns and rows of a table of errors, whether they stand in the machine file or in one of a measuring run.

use post_grammar::text::excerpt;

use super::{Axis, ErrorUnits};
use crate::dependent_limit::SHOWN;
use crate::kinematics::SmallMotion;

/// A turn of one mm/m, radians.
pub(super) const MM_PER_M: f64 = 1e-3;

/// Largest error that is taken for one, mm, and mm/m for turns: more is a slip of the unit.
const MOST: [f64; 2] = [5.0, 20.0];

/// Largest change of an error from place to place that is taken for one, mm a mm of travel, at levers of these lengths, mm: of
/// the tip about what turns a little, and about a rotary axis. What is steeper is a slip of the place, and no control or
/// search could follow it.
const STEEPEST: f64 = 0.02;
const LEVERS: [f64; 2] = [1000.0, 100.0];

/// What is wrong with a table, and where: counted from zero.
#[derive(Debug)]
pub(super) struct RowFault {
    pub row: Option<usize>,
    pub column: Option<usize>,
    pub message: String,
    pub help: String,
}

/// Where an axis was measured, its values rising, and its errors there.
#[derive(Debug, Default)]
pub(super) struct ErrorRows {
    pub places: Vec<f64>,
    pub motions: Vec<SmallMotion>,
}

/// What the columns behind the first are: places among EX, EY, EZ, EA, EB and EC of an axis.
pub(super) fn parts(names: &[&str], axis: &Axis) -> Result<Vec<usize>, RowFault> {
    let own = axis.name.as_str();
    let mut parts = Vec::new();
    for (column, name) in names.iter().enumerate() {
        let letter = name.strip_prefix('E').and_then(|rest| rest.strip_suffix(own));
        let part =
            letter.filter(|letter| letter.len() == 1).and_then(|letter| "XYZABC".find(letter));
        let fits = match (column, part) {
            (0, _) => *name == own,
            (_, Some(part)) => !parts.contains(&part),
            (_, None) => false,
        };
        if !fits {
            return Err(RowFault {
                row: None,
                column: Some(column),
                message: format!("`{}` is no column of the errors of {own}", excerpt(name, SHOWN)),
                help: format!(
                    "first {own}, then some of EX{own}, EY{own}, EZ{own}, EA{own}, EB{own}, EC{own}, each once"
                ),
            });
        }
        parts.extend(part.filter(|_| column > 0));
    }
    Ok(parts)
}

/// What rows of numbers say, each the reading of an axis and its errors in the order of `parts`.
pub(super) fn measured(
    rows: impl Iterator<Item = Vec<f64>>,
    parts: &[usize],
    axis: &Axis,
    units: ErrorUnits,
) -> Result<ErrorRows, RowFault> {
    let mut found = ErrorRows::default();
    for (row, numbers) in rows.enumerate() {
        let fault = |column: Option<usize>, message: String, help: &str| RowFault {
            row: Some(row),
            column,
            message,
            help: help.to_owned(),
        };
        if numbers.len() != parts.len() + 1 {
            let message = format!(
                "a row of the errors of {} has {} numbers, and there are {} columns",
                axis.name,
                numbers.len(),
                parts.len() + 1
            );
            return Err(fault(None, message, "a number for each column"));
        }
        let mut motion = SmallMotion::default();
        for (column, (part, number)) in parts.iter().zip(&numbers[1..]).enumerate() {
            let value = number * units.in_mm();
            let turns = *part > 2;
            if libm::fabs(value) > MOST[usize::from(turns)] {
                let unit = if turns { "mm/m" } else { "mm" };
                let message =
                    format!("an error of {} is {value:.3} {unit}: is the unit another?", axis.name);
                let help = "units = \"um\" for µm and µm/m; else mm and mm/m";
                return Err(fault(Some(column + 1), message, help));
            }
            match turns {
                false => motion.displacement[*part] = value,
                true => motion.turn[*part - 3] = value * MM_PER_M,
            }
        }
        let place = numbers[0] * axis.unit() - axis.zero;
        if found.places.last().is_some_and(|last| *last >= place) {
            let message = format!("the places of the errors of {} do not rise", axis.name);
            return Err(fault(Some(0), message, "a row a place, from the least to the largest"));
        }
        if let Some((last, before)) = found.places.last().zip(found.motions.last()) {
            let way = (place - last) * if axis.joint.rotary { LEVERS[1] } else { 1.0 };
            let change = (motion.displacement - before.displacement).amax()
                + (motion.turn - before.turn).amax() * LEVERS[0];
            if change > STEEPEST * way {
                let message = format!(
                    "the errors of {} change by {change:.4} mm between {} and {}: more than {STEEPEST} mm a mm is none of a machine",
                    axis.name,
                    axis.reading(*last),
                    numbers[0]
                );
                return Err(fault(Some(0), message, "a place that is misspelt, or another unit"));
            }
        }
        found.places.push(place);
        found.motions.push(motion);
    }
    if found.places.is_empty() {
        return Err(RowFault {
            row: None,
            column: None,
            message: format!("the errors of {} have no rows", axis.name),
            help: "columns = [\"X\", \"EXX\"], rows = [[0, 0.001], [100, 0.004]]".to_owned(),
        });
    }
    Ok(found)
}
