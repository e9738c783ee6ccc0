//! Numbers of servos adjusted to a log: `--fit`.

use std::fmt::Write as _;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Short};
use post_motion::servo::fit::{self, FittedNumber};
use serde::Serialize;

use super::coarse;
use super::log::Log;
use super::overlay::{MOVES, UNKNOWN};
use crate::failure::Failure;

/// The servo of an axis, adjusted.
#[derive(Clone, Debug, Serialize)]
pub struct AxisFitted {
    /// Its name.
    pub name: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// Root of the mean square of measured minus predicted positions, with the numbers as they were.
    pub before: f64,
    /// The same with the new ones.
    pub after: f64,
    /// So many rows that follow one another say no more than one that is independent: 1 for noise, much more where the
    /// model of the servo lacks something.
    pub rows_alike: f64,
    /// What to write into the machine file: the numbers that are determined, each in its table.
    pub machine_file: String,
    /// The search came to an end; else the numbers are the best that were met.
    pub converged: bool,
    /// Its numbers.
    pub numbers: Vec<NumberFitted>,
    /// Combinations of them that could be larger or smaller without the log saying so: each number, and by which factor e
    /// to the share (of feed-forward: by which share) it changes.
    pub undetermined: Vec<Vec<(&'static str, f64)>>,
}

/// A number that was adjusted, in the unit of the machine file.
#[derive(Clone, Debug, Serialize)]
pub struct NumberFitted {
    /// Its key in the machine file.
    pub name: &'static str,
    /// As it was.
    pub before: f64,
    /// As it is now.
    pub value: f64,
    /// Its standard deviation (standard error), in the unit of the machine file; none if the log says nothing of it.
    pub deviation: Option<f64>,
    /// The log determines it.
    pub determined: bool,
    /// The number that it can be exchanged for most easily, and the correlation of their errors.
    pub correlated: Option<(&'static str, f64)>,
}

/// Adjusts what `names` names (`X.kv`) to `log`, axis by axis.
///
/// # Errors
/// A name that no servo has, an axis that the log does not have commanded and actual, and what [`fit::fit`] refuses.
pub fn fitted(machine: &Machine, log: &Log, names: &[String]) -> Result<Vec<AxisFitted>, Failure> {
    let mut axes: Vec<(usize, Vec<&str>)> = Vec::new();
    for name in names {
        let (place, key) = fit::named(machine, name).map_err(|fault| *fault)?;
        match axes.iter_mut().find(|(known, _)| *known == place) {
            Some((_, keys)) => keys.push(key),
            None => axes.push((place, vec![key])),
        }
    }
    let axes = axes.into_iter();
    axes.map(|(place, keys)| axis(machine, log, place, &keys)).collect()
}

fn axis(machine: &Machine, log: &Log, place: usize, keys: &[&str]) -> Result<AxisFitted, Failure> {
    let axis = &machine.axes[place];
    let Some(servo) = &axis.servo else {
        // `named` has refused it.
        let message = format!("axis {} has no servo", axis.name);
        return Err(Diagnostic::error("fit", message).into());
    };
    if !log.both().contains(&place) {
        let message =
            format!("--fit: the log does not have {} both commanded and actual", axis.name);
        let help = "--columns says which columns they are";
        return Err(Diagnostic::error("fit", message).help(help).into());
    }
    let steps = coarse::steps(machine, log);
    let rows = 0..log.commanded.joints.len();
    let commanded = rows.flat_map(|row| log.commanded.towards(row, steps));
    let commanded: Vec<f64> = commanded.map(|joints| joints[place]).collect();
    let measured = log.actual.joints.iter().map(|joints| joints[place]);
    let measured: Vec<f64> = measured.collect();
    let moves = (log.commanded.joints[1][place] - log.commanded.joints[0][place]).abs() > MOVES;
    let lead = if moves { UNKNOWN / log.commanded.period } else { 0.0 };
    let found = fit::fit(
        servo,
        keys,
        fit::ServoLog {
            period: log.commanded.period,
            steps,
            commanded: &commanded,
            measured: &measured,
            lead: lead as usize,
        },
    )
    .map_err(|fault| *fault)?;
    let numbers = found.fitted.iter().map(|number| NumberFitted {
        name: number.name,
        before: number.before,
        value: number.value,
        deviation: Some(number.deviation).filter(|deviation| deviation.is_finite()),
        determined: number.determined,
        correlated: number.correlated,
    });
    let undetermined = found.undetermined.iter();
    Ok(AxisFitted {
        name: axis.name.clone(),
        unit: axis.unit_name(),
        before: found.before / axis.unit(),
        after: found.after / axis.unit(),
        rows_alike: found.hanging_together,
        machine_file: lines(&axis.name, &found.fitted),
        converged: found.converged,
        numbers: numbers.collect(),
        undetermined: undetermined.map(|one| one.shares.clone()).collect(),
    })
}

/// `[servo.X.loops]` and its numbers, as many digits of each as it is known to; those that are not determined as remarks.
fn lines(axis: &str, fitted: &[FittedNumber]) -> String {
    let mut text = String::new();
    let mut tables: Vec<&str> = Vec::new();
    for number in fitted {
        if !tables.contains(&number.table) {
            tables.push(number.table);
        }
    }
    // A table ends where the next begins: what stands in none comes first.
    tables.sort_unstable();
    for table in tables {
        let dot = if table.is_empty() { "" } else { "." };
        // Writing to a String cannot fail.
        let _ = writeln!(text, "[servo.{axis}{dot}{table}]");
        for number in fitted.iter().filter(|number| number.table == table) {
            let FittedNumber { name, value, before, .. } = number;
            let _ = match number.determined {
                true => writeln!(
                    text,
                    "{name} = {}  # ± {}, was {}",
                    rounded(*value, number.deviation),
                    short(number.deviation),
                    Short(*before)
                ),
                false => {
                    writeln!(text, "# {name} = {}  # not determined by this log", Short(*before))
                }
            };
        }
    }
    text
}

/// A deviation, three digits of it.
pub(super) fn short(deviation: f64) -> String {
    let text = format!("{deviation:.2e}");
    text.parse::<f64>().map_or(text, |value| Short(value).to_string())
}

/// A number with two digits beyond the first of its deviation, and no more than nine.
pub(super) fn rounded(value: f64, deviation: f64) -> String {
    let digits = libm::floor(libm::log10(
        value.abs().max(f64::MIN_POSITIVE) / deviation.max(f64::MIN_POSITIVE),
    ));
    let digits = (digits + 2.0).clamp(3.0, 9.0) as usize;
    let text = format!("{value:.*e}", digits - 1);
    // Written as TOML has it, without an exponent where that is short.
    text.parse::<f64>().map_or(text, |value| Short(value).to_string())
}
