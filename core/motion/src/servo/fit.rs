//! Numbers of a servo from a measured log: least squares, and how well each is determined.
//!
//! The servo is run over the commanded positions of the log, and its numbers are changed until the sum of the squares of its
//! distances from the measured ones is least (Levenberg 1944, Marquardt 1963). Numbers that are above zero are changed by
//! factors: their logarithms are what is searched for. The derivatives are differences of runs. All runs go through the log
//! side by side and their differences are gathered block by block into a triangle (QR), so that memory does not grow with
//! the log and small singular values are not lost, as they are in the normal equations.
//!
//! What a log does not determine stays close to where it was, and is said: each number has a standard deviation from the
//! covariance `σ²·(JᵀJ)⁻¹`, and combinations that could be anything are listed. That takes the errors of the log for
//! independent from one sample to the next. Those of real logs are not (what the model does not know comes back in
//! every move), so that the true deviations are larger, rarely by more than a few times.

use nalgebra::{DMatrix, DVector};
use post_machine::diagnostic::{Diagnostic, meant};
use post_machine::servo::{Servo, StateSpace, stable};

use super::{Follower, Output};

/// What a control has recorded of one axis.
#[derive(Clone, Copy, Debug)]
pub struct Log<'a> {
    /// Time from one sample to the next, s.
    pub period: f64,
    /// Commanded positions, mm or radians. The axis is taken to stand still at the first of them before the log begins.
    pub commanded: &'a [f64],
    /// Measured ones at the same times, as many.
    pub measured: &'a [f64],
    /// So many at the beginning are run through, but not compared: what the axis did before the log has died away by then.
    pub lead: usize,
}

/// A servo that has been adjusted to a log.
#[derive(Clone, Debug)]
pub struct Fit {
    /// With its new numbers.
    pub servo: Servo,
    /// The numbers that were adjusted, as they were named.
    pub fitted: Vec<Fitted>,
    /// Combinations of them that the log does not determine.
    pub undetermined: Vec<Direction>,
    /// Root of the mean square of measured minus predicted, with the numbers as they were, mm or radians.
    pub before: f64,
    /// The same with the new ones.
    pub after: f64,
    /// The search came to an end; else it was given up, and the numbers are the best that were met.
    pub converged: bool,
}

/// A number that was adjusted, in the unit of the machine file.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Its key in the machine file.
    pub name: &'static str,
    /// As it was.
    pub before: f64,
    /// As it is now.
    pub value: f64,
    /// Its standard deviation, in the same unit; infinite if the log says nothing of it.
    pub deviation: f64,
    /// The log determines it: the deviation is less than [`LARGEST_DEVIATION`] of it (of 1 for the shares of feed-forward).
    pub determined: bool,
    /// The other number that it can be exchanged for most easily, and the correlation of their errors, -1 to 1; none if
    /// there is no other.
    pub correlated: Option<(&'static str, f64)>,
}

/// A combination of numbers that could be larger or smaller without the log saying so.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The numbers, and how each changes: by the factor `e^share` (feed-forward: by `share`), the largest share being 1.
    pub shares: Vec<(&'static str, f64)>,
    /// Standard deviation along it, in the same measure; infinite if the log says nothing of it.
    pub deviation: f64,
}

/// A number whose standard deviation is larger, as a share of itself, is not determined.
pub const LARGEST_DEVIATION: f64 = 0.5;

/// Fewer samples than this a number say nothing.
const LEAST_SAMPLES: usize = 4;
/// No log is finer, mm or radians: errors are not taken for smaller, so that a log without noise does not seem to determine
/// what only rounding does.
const FINEST: f64 = 1e-7;
/// A singular value that is smaller than this share of the largest is the error of the differences.
const SMALLEST: f64 = 1e-9;
/// Half of the difference by which derivatives are taken, as a share.
const STEP: f64 = 1e-4;
/// Longest change of a number in one step of the search: a factor of e.
const LONGEST: f64 = 1.0;
/// Steps of the search.
const MOST_STEPS: usize = 100;
/// A number is known beforehand to within a factor of e to this, so that what the log says nothing of does not wander.
const KNOWN: f64 = 5.0;
/// Samples of a block.
const BLOCK: usize = 256;
/// A share in a combination that is not told.
const SMALL_SHARE: f64 = 0.1;

/// Adjusts the numbers of `servo` that are called `names` (keys of the machine file, `kv`) to `log`.
///
/// # Errors
/// A name that the servo does not have, a number that is zero and so has no factor, a log that is too short, or whose two
/// courses are not of one length.
pub fn fit(servo: &Servo, names: &[&str], log: Log<'_>) -> Result<Fit, Box<Diagnostic>> {
    let search = Search::new(servo, names, log)?;
    let start = search.start.clone();
    let free = search.run(&start, 0.0)?;
    let spread = search.spread(&free.triangle);
    // Once more, with what was known before: directions that the noise alone has led along go back.
    let found = search.run(&start, spread / KNOWN)?;
    Ok(search.told(&found, search.spread(&found.triangle)))
}

/// What is searched for, and in what.
struct Search<'a> {
    servo: &'a Servo,
    log: Log<'a>,
    names: Vec<&'static str>,
    /// Searched for by its logarithm.
    by_factor: Vec<bool>,
    start: DVector<f64>,
}

/// Where the search stands.
struct Found {
    place: DVector<f64>,
    /// Triangle of the derivatives, and of the errors behind them.
    triangle: DMatrix<f64>,
    converged: bool,
}

impl<'a> Search<'a> {
    fn new(servo: &'a Servo, names: &[&str], log: Log<'a>) -> Result<Self, Box<Diagnostic>> {
        let fault = |message: String, help: String| {
            Err(Diagnostic::error("fit", message)
                .at(servo.place.clone())
                .help(help)
                .boxed())
        };
        let compared = log.commanded.len().saturating_sub(log.lead);
        if log.commanded.len() != log.measured.len() || compared < LEAST_SAMPLES * (names.len() + 1)
        {
            return fault(
                format!(
                    "a log of {} commanded and {} measured positions, {compared} of them compared, for {} numbers",
                    log.commanded.len(),
                    log.measured.len(),
                    names.len()
                ),
                "both have the same length, and at least four samples are compared for each number"
                    .to_owned(),
            );
        }
        let mut own = servo.clone();
        let mut search = Self {
            servo,
            log,
            names: Vec::new(),
            by_factor: Vec::new(),
            start: DVector::zeros(names.len()),
        };
        for (place, name) in names.iter().enumerate() {
            let known: Vec<&'static str> =
                own.parameters().iter().map(|number| number.name).collect();
            let mut all = own.parameters().into_iter();
            let Some(number) = all.find(|number| number.name == *name) else {
                let message = format!("this servo has no number called {name}");
                return fault(message, meant(name, "known are", &known));
            };
            if search.names.contains(&number.name) {
                let message = format!("{name} is to be fitted twice");
                return fault(message, "name it once".to_owned());
            }
            let by_factor = !number.name.ends_with("feed_forward");
            if by_factor && *number.value <= 0.0 {
                let message = format!("{name} is zero: there is nothing to begin with");
                let help = format!("give {name} a value in the machine file, or leave it out here");
                return fault(message, help);
            }
            search.start[place] = if by_factor {
                libm::log(*number.value)
            } else {
                *number.value
            };
            search.names.push(number.name);
            search.by_factor.push(by_factor);
        }
        Ok(search)
    }

    /// The servo with the numbers of `place`.
    fn servo_at(&self, place: &DVector<f64>) -> Servo {
        let mut servo = self.servo.clone();
        for (index, name) in self.names.iter().enumerate() {
            if let Some(number) = servo.parameter(name) {
                *number = self.value(place, index);
            }
        }
        servo
    }

    fn value(&self, place: &DVector<f64>, index: usize) -> f64 {
        if self.by_factor[index] {
            libm::exp(place[index])
        } else {
            place[index]
        }
    }

    fn follower(&self, place: &DVector<f64>) -> Result<Follower, Box<Diagnostic>> {
        let servo = self.servo_at(place);
        let mut follower = Follower::with(&servo, self.log.period, Output::Measured)?;
        follower.settle(self.log.commanded.first().copied().unwrap_or_default());
        Ok(follower)
    }

    /// It comes to rest.
    fn stable(&self, place: &DVector<f64>) -> bool {
        let poles = StateSpace::of(&self.servo_at(place)).poles();
        poles.is_some_and(|poles| stable(&poles))
    }

    /// Sum of the squares of measured minus predicted.
    fn squares(&self, place: &DVector<f64>) -> Result<f64, Box<Diagnostic>> {
        let mut follower = self.follower(place)?;
        let mut sum = 0.0;
        let Log {
            commanded,
            measured,
            lead,
            ..
        } = self.log;
        follower.run(
            commanded.len(),
            |index| commanded[index],
            |index, value| {
                if index >= lead {
                    let error = measured[index] - value;
                    sum += error * error;
                }
            },
        );
        Ok(sum)
    }

    /// The triangle R of `[J e] = Q·R`: J how the prediction changes with each number, e measured minus predicted.
    fn triangle(&self, place: &DVector<f64>) -> Result<DMatrix<f64>, Box<Diagnostic>> {
        let count = self.names.len();
        let mut followers = vec![self.follower(place)?];
        for index in 0..count {
            for sign in [1.0, -1.0] {
                let mut moved = place.clone();
                moved[index] += sign * STEP;
                followers.push(self.follower(&moved)?);
            }
        }
        let Log {
            commanded,
            measured,
            lead,
            ..
        } = self.log;
        let mut triangle = DMatrix::zeros(count + 1, count + 1);
        let mut predicted = vec![[0.0; BLOCK]; followers.len()];
        let starts = (0..commanded.len()).step_by(BLOCK);
        for start in starts {
            let length = BLOCK.min(commanded.len() - start);
            for (follower, predicted) in followers.iter_mut().zip(&mut predicted) {
                follower.run(
                    length,
                    |index| commanded[start + index],
                    |index, value| predicted[index] = value,
                );
            }
            let skipped = lead.saturating_sub(start).min(length);
            if skipped == length {
                continue;
            }
            let rows = length - skipped;
            let stacked = DMatrix::from_fn(rows + count + 1, count + 1, |row, column| {
                let Some(row) = row.checked_sub(count + 1) else {
                    return triangle[(row, column)];
                };
                let row = row + skipped;
                if column == count {
                    measured[start + row] - predicted[0][row]
                } else {
                    let [above, below] = [1, 2].map(|side| predicted[2 * column + side][row]);
                    (above - below) / (2.0 * STEP)
                }
            });
            triangle = stacked.qr().r();
        }
        Ok(triangle)
    }

    /// Standard deviation of the log's errors, mm or radians.
    fn spread(&self, triangle: &DMatrix<f64>) -> f64 {
        let count = self.names.len();
        let samples = self.log.commanded.len() - self.log.lead;
        let left = triangle.column(count).norm();
        (left / libm::sqrt((samples - count) as f64)).max(FINEST)
    }

    /// Searches from `start`. Each number is drawn back there with the strength `draw`.
    fn run(&self, start: &DVector<f64>, draw: f64) -> Result<Found, Box<Diagnostic>> {
        let count = self.names.len();
        let cost = |place: &DVector<f64>, squares: f64| {
            squares + draw * draw * (place - start).norm_squared()
        };
        let mut place = start.clone();
        let mut triangle = self.triangle(&place)?;
        let mut best = cost(&place, triangle.column(count).norm_squared());
        let mut damping = 1e-3;
        let mut converged = false;
        for _ in 0..MOST_STEPS {
            let mut moved = false;
            // More damping makes the step shorter and turns it towards the steepest descent: in the end one is good, or
            // none is long enough to count.
            while !moved && damping < 1e12 {
                let step = step(&triangle, &(start - &place), draw, damping);
                let next = self.inside(&(&place + &step));
                let gain = if self.stable(&next) {
                    best - cost(&next, self.squares(&next)?)
                } else {
                    f64::NEG_INFINITY
                };
                let length = (&next - &place).amax();
                if gain > 0.0 {
                    moved = true;
                    damping = (damping / 10.0).max(1e-12);
                    best -= gain;
                    place = next;
                    triangle = self.triangle(&place)?;
                    converged = gain <= 1e-10 * best || length < 1e-9;
                } else {
                    converged = length < 1e-7;
                    if converged {
                        break;
                    }
                    damping *= 10.0;
                }
            }
            if converged || !moved {
                break;
            }
        }
        Ok(Found {
            place,
            triangle,
            converged,
        })
    }

    /// Feed-forward stays from 0 to 2, as in the machine file.
    fn inside(&self, place: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(place.len(), |index, _| {
            if self.by_factor[index] {
                place[index]
            } else {
                place[index].clamp(0.0, 2.0)
            }
        })
    }

    fn told(&self, found: &Found, spread: f64) -> Fit {
        let count = self.names.len();
        let samples = (self.log.commanded.len() - self.log.lead) as f64;
        let derivatives = found.triangle.view((0, 0), (count, count)).into_owned();
        let decomposed = derivatives.svd(false, true);
        let largest = decomposed.singular_values.amax();
        let along: Vec<f64> = decomposed
            .singular_values
            .iter()
            .map(|value| {
                if *value > SMALLEST * largest {
                    spread / value
                } else {
                    f64::INFINITY
                }
            })
            .collect();
        let directions: Vec<DVector<f64>> = decomposed
            .v_t
            .iter()
            .flat_map(|rows| rows.row_iter().map(|row| row.transpose()))
            .collect();
        // Of an endless direction nothing is known but who is in it: its numbers are not known either.
        let covariance = |one: usize, other: usize| -> f64 {
            let parts = directions.iter().zip(&along);
            parts
                .filter(|(direction, _)| libm::fabs(direction[one] * direction[other]) > SMALLEST)
                .map(|(direction, along)| direction[one] * direction[other] * along * along)
                .sum()
        };
        let fitted = (0..count)
            .map(|index| {
                let deviation = libm::sqrt(covariance(index, index));
                let correlation = |other: usize| {
                    let both = covariance(index, index) * covariance(other, other);
                    let value = covariance(index, other) / libm::sqrt(both);
                    if value.is_finite() { value } else { 0.0 }
                };
                let others = (0..count).filter(|other| *other != index);
                let correlated = others
                    .map(|other| (self.names[other], correlation(other)))
                    .max_by(|one, other| libm::fabs(one.1).total_cmp(&libm::fabs(other.1)));
                let value = self.value(&found.place, index);
                Fitted {
                    name: self.names[index],
                    before: self.value(&self.start, index),
                    value,
                    deviation: if self.by_factor[index] {
                        deviation * value
                    } else {
                        deviation
                    },
                    determined: deviation <= LARGEST_DEVIATION,
                    correlated,
                }
            })
            .collect();
        let undetermined = directions
            .iter()
            .zip(&along)
            .filter(|(_, along)| **along > LARGEST_DEVIATION)
            .map(|(direction, along)| self.direction(direction, *along))
            .collect();
        let squares = self.squares(&self.start).unwrap_or(f64::NAN);
        Fit {
            servo: self.servo_at(&found.place),
            fitted,
            undetermined,
            before: libm::sqrt(squares / samples),
            after: found.triangle.column(count).norm() / libm::sqrt(samples),
            converged: found.converged,
        }
    }

    fn direction(&self, direction: &DVector<f64>, along: f64) -> Direction {
        // The largest share is 1.
        let largest = direction.iter().copied().fold(0.0, |largest: f64, share| {
            if libm::fabs(share) > libm::fabs(largest) {
                share
            } else {
                largest
            }
        });
        let shares = self.names.iter().zip(direction.iter());
        let shares = shares.map(|(name, share)| (*name, share / largest));
        Direction {
            shares: shares
                .filter(|(_, share)| libm::fabs(*share) > SMALL_SHARE)
                .collect(),
            deviation: along * libm::fabs(largest),
        }
    }
}

/// The step of Levenberg and Marquardt: least squares of what the derivatives leave of the errors, of what is drawn back,
/// and of the step itself, each number in the measure of its own effect.
fn step(triangle: &DMatrix<f64>, back: &DVector<f64>, draw: f64, damping: f64) -> DVector<f64> {
    let count = back.len();
    let mut matrix = DMatrix::zeros(3 * count, count);
    let mut wanted = DVector::zeros(3 * count);
    for column in 0..count {
        for row in 0..=column {
            matrix[(row, column)] = triangle[(row, column)];
        }
        wanted[column] = triangle[(column, count)];
        matrix[(count + column, column)] = draw;
        wanted[count + column] = draw * back[column];
        let size = triangle.column(column).norm().max(f64::MIN_POSITIVE);
        matrix[(2 * count + column, column)] = libm::sqrt(damping) * size;
    }
    let solved = matrix.svd(true, true).solve(&wanted, f64::MIN_POSITIVE);
    let step = solved.unwrap_or_else(|_| DVector::zeros(count));
    let length = step.amax();
    if length > LONGEST {
        step * (LONGEST / length)
    } else {
        step
    }
}
