//! Numbers of a servo from a measured log: least squares, and how well each is determined.
//!
//! The servo is run over the commanded positions of the log, and its numbers are changed until the sum of the squares
//! of its distances from the measured ones is least (Levenberg 1944, Marquardt 1963). Numbers that are above zero are
//! changed by factors: their logarithms are what is searched for. The derivatives are differences of runs. All runs go
//! through the log side by side and their differences are gathered block by block into a triangle (QR), so that memory
//! does not grow with the log and small singular values are not lost, as they are in the normal equations.
//!
//! What a log does not determine stays close to where it was, and is said: each number has a standard deviation from
//! the covariance `σ²·(JᵀJ)⁻¹`, and combinations that could be anything are listed. σ² is that of the errors that are
//! left, times the sum of their autocorrelation: what the model does not know comes back in every move, so that many
//! samples of a real log say no more than a few independent ones.

mod determined;
mod independence;
mod search;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, meant};
use post_machine::servo::Servo;

use search::FitSearch;

/// What a control has recorded of one axis.
#[derive(Clone, Copy, Debug)]
pub struct ServoLog<'a> {
    /// Time from one measured position to the next, s.
    pub period: f64,
    /// Commanded positions for each measured one: where a control makes more set-points than are recorded,
    /// its commands are no straight line between two of them.
    pub steps: usize,
    /// Commanded positions, mm or radians, the last of each `steps` at the time of the measured one. The axis is taken
    /// to stand still at the first of them before the log begins.
    pub commanded: &'a [f64],
    /// Measured positions, mm or radians.
    pub measured: &'a [f64],
    /// Positions at the beginning that are run through, but not compared: what the axis did before the log has died
    /// away by then.
    pub lead: usize,
}

/// A servo that has been adjusted to a log.
#[derive(Clone, Debug)]
pub struct ServoFit {
    /// The servo with its new numbers.
    pub servo: Servo,
    /// The numbers that were adjusted, as they were named.
    pub fitted: Vec<FittedNumber>,
    /// Combinations of them that the log does not determine.
    pub undetermined: Vec<UndeterminedDirection>,
    /// Root of the mean square of measured minus predicted, with the numbers as they were, mm or radians.
    pub before: f64,
    /// Root of the mean square with the new numbers, mm or radians.
    pub after: f64,
    /// Number of successive errors that say no more than one that is independent: 1 for noise; much more where the
    /// model lacks something that comes back in every move.
    pub hanging_together: f64,
    /// The search came to an end; else it was given up, and the numbers are the best that were met.
    pub converged: bool,
}

/// A number that was adjusted, in the unit of the machine file.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedNumber {
    /// The table below `[servo.X]` that it stands in, `loops.screw`; empty for `[servo.X]` itself.
    pub table: &'static str,
    /// Key in the machine file.
    pub name: &'static str,
    /// Value before the fit.
    pub before: f64,
    /// Value after the fit.
    pub value: f64,
    /// Standard deviation, in the same unit; infinite if the log says nothing of it.
    pub deviation: f64,
    /// The log determines it: the deviation is less than [`LARGEST_DEVIATION`] of it (of 1 for the shares of
    /// feed-forward).
    pub determined: bool,
    /// The other number that it can be exchanged for most easily, and the correlation of their errors, -1 to 1; none if
    /// there is no other.
    pub correlated: Option<(&'static str, f64)>,
}

/// A combination of numbers that could be larger or smaller without the log saying so.
#[derive(Clone, Debug, PartialEq)]
pub struct UndeterminedDirection {
    /// The numbers, and how each changes: by the factor `e^share` (feed-forward: by `share`), the largest share being
    /// 1.
    pub shares: Vec<(&'static str, f64)>,
    /// Standard deviation along it, in the same measure; infinite if the log says nothing of it.
    pub deviation: f64,
}

/// A number whose standard deviation is larger, as a share of itself, is not determined.
pub const LARGEST_DEVIATION: f64 = 0.5;

/// A number is known beforehand to within a factor of e to this, so that what the log says nothing of does not wander.
const KNOWN: f64 = 5.0;
/// Rounds of searches; errors that are left fall to a fraction in each, or it was the last.
const MOST_ROUNDS: usize = 30;

/// Adjusts the numbers of `servo` that are called `names` (keys of the machine file, `kv`) to `log`.
///
/// # Errors
/// A name that the servo does not have, a number that is zero and so has no factor, a log that is too short, or whose
/// two courses are not of one length.
pub fn fit(servo: &Servo, names: &[&str], log: ServoLog<'_>) -> Result<ServoFit, Box<Diagnostic>> {
    let search = FitSearch::new(servo, names, log)?;
    let before = search.squares(&search.start)?;
    // The more of the errors is explained, the less the numbers are drawn back to where they were.
    let compared = (log.measured.len() - log.lead) as f64;
    let mut spread = libm::sqrt(before / compared);
    let mut found = search.run(&search.start, spread / KNOWN)?;
    for _ in 0..MOST_ROUNDS {
        let [left, _] = search.spread(&found)?;
        let settled = left > 0.5 * spread;
        spread = left;
        found = search.run(&found.place, spread / KNOWN)?;
        if settled {
            break;
        }
    }
    Ok(search.told(&found, search.spread(&found)?, before))
}

/// The place in the chain of the axis that `name` is of, and the key in it: `X.kv`.
///
/// # Errors
/// A text of another form, an axis that the machine does not have, or that has no servo.
pub fn named<'n>(machine: &Machine, name: &'n str) -> Result<(usize, &'n str), Box<Diagnostic>> {
    let axes: Vec<&str> = machine
        .axes
        .iter()
        .filter(|axis| axis.servo.is_some())
        .map(|axis| axis.name.as_str())
        .collect();
    let found = name.split_once('.').and_then(|(axis, key)| {
        let place = machine.axes.iter().position(|own| own.name == axis)?;
        machine.axes[place].servo.as_ref().map(|_| (place, key))
    });
    found.ok_or_else(|| {
        let letter = name.split('.').next().unwrap_or_default();
        let help = if axes.is_empty() {
            "the machine has no [servo.X]".to_owned()
        } else {
            format!(
                "a number is named by its axis and its key, such as X.kv; {}",
                meant(letter, "servos are known of", &axes)
            )
        };
        let message = format!("{name} names no number of a servo of this machine");
        Diagnostic::error("fit", message).help(help).boxed()
    })
}
