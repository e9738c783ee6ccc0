//! The search for the numbers that fit best.

use nalgebra::{DMatrix, DVector};
use post_machine::diagnostic::{Diagnostic, meant};
use post_machine::servo::{Servo, StateSpace, stable};

use super::ServoLog;
use super::independence::hanging_together;
use crate::servo::{Follower, ServoOutput};

/// Fewer samples than this a number say nothing.
const LEAST_SAMPLES: usize = 4;
/// No log is finer, mm or radians: errors are not taken for smaller, so that a log without noise does not seem to
/// determine what only rounding does.
const FINEST: f64 = 1e-7;
/// Half of the difference by which derivatives are taken, as a share.
const STEP: f64 = 1e-4;
/// A course that differs by more, mm or radians, has left all bounds.
const LARGEST: f64 = 1e100;
/// Longest change of a number in one step of the search: a factor of e.
const LONGEST: f64 = 1.0;
/// Steps of the search.
const MOST_STEPS: usize = 100;
/// Samples of a block.
const BLOCK: usize = 256;

/// What is searched for, and in what.
pub(super) struct FitSearch<'a> {
    servo: &'a Servo,
    pub(super) log: ServoLog<'a>,
    pub(super) names: Vec<&'static str>,
    pub(super) tables: Vec<&'static str>,
    /// Searched for by its logarithm.
    pub(super) by_factor: Vec<bool>,
    pub(super) start: DVector<f64>,
}

/// Where the search stands.
pub(super) struct SearchState {
    pub(super) place: DVector<f64>,
    /// Triangle of the derivatives, and of the errors after them.
    pub(super) triangle: DMatrix<f64>,
    pub(super) converged: bool,
}

impl<'a> FitSearch<'a> {
    pub(super) fn new(
        servo: &'a Servo,
        names: &[&str],
        log: ServoLog<'a>,
    ) -> Result<Self, Box<Diagnostic>> {
        let fault = |message: String, help: String| {
            Err(Diagnostic::error("fit", message).at(servo.place.clone()).help(help).boxed())
        };
        let compared = log.measured.len().saturating_sub(log.lead);
        if log.commanded.len() != log.steps * log.measured.len()
            || compared < LEAST_SAMPLES * (names.len() + 1)
        {
            return fault(
                format!(
                    "a log of {} commanded and {} measured positions, {compared} of them compared, for {} numbers",
                    log.commanded.len(),
                    log.measured.len(),
                    names.len()
                ),
                "each measured position has its commanded ones, and at least four are compared for each number"
                    .to_owned(),
            );
        }
        let mut courses = log.commanded.iter().chain(log.measured);
        if names.is_empty() || !courses.all(|value| value.is_finite()) {
            return fault(
                "there is nothing to fit, or the log holds what is no number".to_owned(),
                "name one number at least, such as X.kv; positions are finite numbers".to_owned(),
            );
        }
        let mut own = servo.clone();
        let mut search = Self {
            servo,
            log,
            names: Vec::new(),
            tables: Vec::new(),
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
            search.start[place] = if by_factor { libm::log(*number.value) } else { *number.value };
            search.names.push(number.name);
            search.tables.push(number.table);
            search.by_factor.push(by_factor);
        }
        Ok(search)
    }

    /// The servo with the numbers of `place`.
    pub(super) fn servo_at(&self, place: &DVector<f64>) -> Servo {
        let mut servo = self.servo.clone();
        for (index, name) in self.names.iter().enumerate() {
            if let Some(number) = servo.parameter(name) {
                *number = self.value(place, index);
            }
        }
        servo
    }

    pub(super) fn value(&self, place: &DVector<f64>, index: usize) -> f64 {
        if self.by_factor[index] { libm::exp(place[index]) } else { place[index] }
    }

    fn follower(&self, place: &DVector<f64>) -> Result<Follower, Box<Diagnostic>> {
        let servo = self.servo_at(place);
        let mut follower =
            Follower::with(&servo, self.log.period / self.log.steps as f64, ServoOutput::Measured)?;
        follower.settle(self.log.commanded.first().copied().unwrap_or_default());
        Ok(follower)
    }

    /// Whether the servo comes to rest.
    fn stable(&self, place: &DVector<f64>) -> bool {
        let poles = StateSpace::of(&self.servo_at(place)).poles();
        poles.is_some_and(|poles| stable(&poles))
    }

    /// Measured minus predicted, of what is compared.
    pub(super) fn errors(&self, place: &DVector<f64>) -> Result<Vec<f64>, Box<Diagnostic>> {
        let mut follower = self.follower(place)?;
        let ServoLog { steps, commanded, measured, lead, .. } = self.log;
        let mut errors = Vec::with_capacity(measured.len() - lead);
        follower.run(
            commanded.len(),
            |index| commanded[index],
            |index, value| {
                let row = index / steps;
                if row >= lead && (index + 1) % steps == 0 {
                    errors.push(measured[row] - value);
                }
            },
        );
        Ok(errors)
    }

    /// Sum of their squares.
    pub(super) fn squares(&self, place: &DVector<f64>) -> Result<f64, Box<Diagnostic>> {
        let errors = self.errors(place)?;
        Ok(errors.iter().map(|error| error * error).sum())
    }

    /// The triangle R of `[J e] = Q·R`: J how the prediction changes with each number, e measured minus predicted. None
    /// where a run close by leaves all bounds.
    fn triangle(&self, place: &DVector<f64>) -> Result<Option<DMatrix<f64>>, Box<Diagnostic>> {
        let count = self.names.len();
        let mut followers = vec![self.follower(place)?];
        for index in 0..count {
            for sign in [1.0, -1.0] {
                let mut moved = place.clone();
                moved[index] += sign * STEP;
                followers.push(self.follower(&moved)?);
            }
        }
        let ServoLog { steps, commanded, measured, lead, .. } = self.log;
        let mut triangle = DMatrix::zeros(count + 1, count + 1);
        let mut predicted = vec![[0.0; BLOCK]; followers.len()];
        let starts = (0..measured.len()).step_by(BLOCK);
        for start in starts {
            let length = BLOCK.min(measured.len() - start);
            for (follower, predicted) in followers.iter_mut().zip(&mut predicted) {
                // The last of the steps to a row is the one that stays.
                follower.run(
                    length * steps,
                    |index| commanded[start * steps + index],
                    |index, value| predicted[index / steps] = value,
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
            if !stacked.iter().all(|part| libm::fabs(*part) < LARGEST) {
                return Ok(None);
            }
            triangle = stacked.qr().r();
        }
        Ok(Some(triangle))
    }

    /// Standard deviation of the log's errors, mm or radians, that which independent errors would have that say as
    /// little; and how many of them say no more than one that is independent.
    pub(super) fn spread(&self, found: &SearchState) -> Result<[f64; 2], Box<Diagnostic>> {
        let count = self.names.len();
        let errors = self.errors(&found.place)?;
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        let spread = libm::sqrt(squares / (errors.len() - count) as f64);
        let together = hanging_together(&errors);
        Ok([(spread * libm::sqrt(together)).max(FINEST), together])
    }

    /// Searches from `from`. Each number is drawn back to where it was at first with the strength `draw`.
    pub(super) fn run(
        &self,
        from: &DVector<f64>,
        draw: f64,
    ) -> Result<SearchState, Box<Diagnostic>> {
        let count = self.names.len();
        let cost = |place: &DVector<f64>, squares: f64| {
            squares + draw * draw * (place - &self.start).norm_squared()
        };
        let mut place = from.clone();
        let Some(mut triangle) = self.triangle(&place)? else {
            let message = "this servo does not follow the log: its positions are no numbers";
            return Err(Diagnostic::error("fit", message)
                .at(self.servo.place.clone())
                .help("begin with numbers that are closer to those of the machine")
                .boxed());
        };
        let mut best = cost(&place, triangle.column(count).norm_squared());
        let mut damping = 1e-3;
        let mut converged = false;
        for _ in 0..MOST_STEPS {
            let mut moved = false;
            // More damping makes the step shorter and turns it towards the steepest descent: in the end one is good, or
            // none is long enough to count.
            while !moved && damping < 1e12 {
                let step = step(&triangle, &(&self.start - &place), draw, damping);
                let next = self.inside(&(&place + &step));
                let gain = if self.stable(&next) {
                    best - cost(&next, self.squares(&next)?)
                } else {
                    f64::NEG_INFINITY
                };
                let length = (&next - &place).amax();
                let there = if gain > 0.0 { self.triangle(&next)? } else { None };
                if let Some(there) = there {
                    moved = true;
                    damping = (damping / 10.0).max(1e-12);
                    best -= gain;
                    place = next;
                    triangle = there;
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
        Ok(SearchState { place, triangle, converged })
    }

    /// Feed-forward stays from 0 to 2, as in the machine file.
    fn inside(&self, place: &DVector<f64>) -> DVector<f64> {
        DVector::from_fn(place.len(), |index, _| {
            if self.by_factor[index] { place[index] } else { place[index].clamp(0.0, 2.0) }
        })
    }
}

/// The step of Levenberg and Marquardt: least squares of what the derivatives leave of the errors, of what is drawn
/// back, and of the step itself, each number in the measure of its own effect.
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
    if length > LONGEST { step * (LONGEST / length) } else { step }
}
