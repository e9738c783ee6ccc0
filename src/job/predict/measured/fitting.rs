//! Numbers of servos adjusted to a log: `--fit`.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_motion::servo::fit;
use serde::Serialize;

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
    /// Its standard deviation; none if the log says nothing of it.
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
    axes.map(|(place, keys)| axis(machine, log, place, &keys))
        .collect()
}

fn axis(machine: &Machine, log: &Log, place: usize, keys: &[&str]) -> Result<AxisFitted, Failure> {
    let axis = &machine.axes[place];
    let Some(servo) = &axis.servo else {
        // `named` has refused it.
        let message = format!("axis {} has no servo", axis.name);
        return Err(Diagnostic::error("fit", message).into());
    };
    if !log.both().contains(&place) {
        let message = format!(
            "--fit: the log does not have {} both commanded and actual",
            axis.name
        );
        let help = "--columns says which columns they are";
        return Err(Diagnostic::error("fit", message).help(help).into());
    }
    let [commanded, measured] = [&log.commanded, &log.actual].map(|track| {
        let values = track.joints.iter().map(|joints| joints[place]);
        values.collect::<Vec<f64>>()
    });
    let moves = (commanded[1] - commanded[0]).abs() > MOVES;
    let lead = if moves {
        UNKNOWN / log.commanded.period
    } else {
        0.0
    };
    let found = fit::fit(
        servo,
        keys,
        fit::Log {
            period: log.commanded.period,
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
        unit: if axis.joint.rotary { "deg" } else { "mm" },
        before: found.before / axis.unit(),
        after: found.after / axis.unit(),
        converged: found.converged,
        numbers: numbers.collect(),
        undetermined: undetermined.map(|one| one.shares.clone()).collect(),
    })
}
