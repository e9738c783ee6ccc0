//! Where the lines of the axes are, from axis values at which a ball was found: touch probe and R-test.
//!
//! A ball stands still in the part frame, at a place that nobody needs to know. Each reading has axis values and, of an
//! R-test, how far the ball was off the tip. By the forward product each reading says where the ball is; numbers of the
//! machine are those with which all readings of a ball say the same (Gauss-Newton; each ball's place is the mean of what
//! its readings say, which is the best there is). Standard errors follow from what is left over: `σ² (JᵀJ)⁻¹`.

mod outlier;
mod unknown;

use nalgebra::{DMatrix, DVector, Vector3};

pub use outlier::Outlier;
pub use unknown::{CalibratedLine, Unknown};

use self::outlier::Residuals;
use crate::description::{Machine, Setting};
use crate::kinematics::chain::turn;
use crate::kinematics::{Chain, Joints};

/// A singular value that is smaller than this share of the largest tells of nothing but rounding.
const SMALLEST: f64 = 1e-5;
/// A share in a combination that is not told.
const SMALL_SHARE: f64 = 0.1;
/// Steps after which no better numbers are looked for.
const MOST_STEPS: usize = 50;

/// By how much readings are off their ball with values of the unknowns.
type OffBalls<'o, E> = dyn FnMut(&[f64]) -> Result<DVector<f64>, E> + 'o;

/// Values of the unknowns, and by how much readings are off their ball with them.
struct Trial {
    values: Vec<f64>,
    off: DVector<f64>,
}

/// One finding of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallReading {
    /// Which ball.
    pub ball: usize,
    /// Axis values, mm and radians.
    pub joints: Joints,
    /// Tool length, from the gauge point to the tip, mm.
    pub length: f64,
    /// From the tip to the middle of the ball, along the axes of the machine frame, mm; zero where the tip was
    /// brought to the ball.
    pub off: Vector3<f64>,
}

/// A number that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibratedNumber {
    /// Its name: `C.point X`, a parameter.
    pub name: String,
    /// What the machine file says, in its units.
    pub before: f64,
    /// What the readings say.
    pub value: f64,
    /// Standard error of it.
    pub deviation: f64,
}

/// What the readings say.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The numbers.
    pub numbers: Vec<CalibratedNumber>,
    /// How far readings were off their ball, mm: root of the mean square of all coordinates, with the numbers of the
    /// machine file.
    pub before: f64,
    /// Likewise with those found.
    pub after: f64,
    /// Standard deviation of a coordinate of a reading, mm.
    pub spread: f64,
    /// The settings that make the machine so.
    pub settings: Vec<Setting>,
    /// Readings that do not go with the others, worst first; the numbers are of all readings, these among them.
    pub outliers: Vec<Outlier>,
    /// What the other readings say, where there are such; none if they do not determine the numbers.
    pub without: Option<Box<Calibration>>,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum CalibrationFault<E> {
    /// The machine with other numbers is none.
    Machine(E),
    /// There are fewer coordinates than numbers and places of balls.
    TooFew {
        /// Numbers that the readings have.
        have: usize,
        /// Numbers that are looked for, the balls' places among them.
        want: usize,
    },
    /// The readings do not tell these numbers from one another, or nothing of a single one.
    Undetermined(Vec<Vec<String>>),
    /// No numbers are better than those before, and yet these are not the best.
    Lost,
}

/// Finds the numbers `unknowns` of a machine, which `load` makes with settings over its file.
///
/// # Errors
/// Numbers that the readings do not determine, and a machine that cannot be with what they say.
pub fn calibrate<E>(
    unknowns: &[Unknown],
    readings: &[BallReading],
    load: &mut dyn FnMut(&[Setting]) -> Result<Machine, E>,
) -> Result<Calibration, CalibrationFault<E>> {
    let mut found = fitted(unknowns, readings, load)?;
    if !found.outliers.is_empty() {
        let bad = |place: &usize| found.outliers.iter().any(|outlier| outlier.reading == *place);
        let others = readings.iter().enumerate().filter(|(place, _)| !bad(place));
        let others: Vec<BallReading> = others.map(|(_, reading)| *reading).collect();
        match fitted(unknowns, &others, load) {
            Ok(without) => found.without = Some(Box::new(without)),
            Err(CalibrationFault::Machine(error)) => return Err(CalibrationFault::Machine(error)),
            Err(_) => {}
        }
    }
    Ok(found)
}

/// The numbers with which all of `readings` go best.
fn fitted<E>(
    unknowns: &[Unknown],
    readings: &[BallReading],
    load: &mut dyn FnMut(&[Setting]) -> Result<Machine, E>,
) -> Result<Calibration, CalibrationFault<E>> {
    let start: Vec<f64> = unknowns.iter().flat_map(Unknown::values).collect();
    let balls = readings.iter().map(|reading| reading.ball + 1).max().unwrap_or_default();
    let (have, want) = (3 * readings.len(), start.len() + 3 * balls);
    if have <= want {
        return Err(CalibrationFault::TooFew { have, want });
    }
    let mut errors = |values: &[f64]| -> Result<DVector<f64>, CalibrationFault<E>> {
        let machine = load(&unknown::settings(unknowns, values));
        Ok(off_their_ball(&machine.map_err(CalibrationFault::Machine)?, readings, balls))
    };
    let steps: Vec<f64> = unknowns.iter().flat_map(Unknown::steps).collect();
    let first = errors(&start)?;
    let (mut values, mut left) = (start.clone(), first.clone());
    let mut derivatives = differences(&values, &steps, &mut errors)?;
    for _ in 0..MOST_STEPS {
        let step = determined_step(unknowns, &derivatives, &left)?;
        let Some(next) = shorter(&values, &step, &left, &mut errors)? else {
            break;
        };
        let gained = left.norm_squared() - next.off.norm_squared();
        let done = gained <= 1e-12 * left.norm_squared();
        (values, left) = (next.values, next.off);
        derivatives = differences(&values, &steps, &mut errors)?;
        if done {
            break;
        }
    }
    let rest = determined_step(unknowns, &derivatives, &left)?;
    let moved = (&derivatives * &rest).norm_squared();
    if moved > 1e-6 * left.norm_squared() && moved > 1e-16 * have as f64 {
        return Err(CalibrationFault::Lost);
    }
    let spread = left.norm() / libm::sqrt((have - want) as f64);
    let inverse = derivatives.clone().svd(false, true);
    let deviation = |index: usize| {
        let parts = inverse
            .v_t
            .iter()
            .flat_map(|rows| rows.column(index).iter().copied().collect::<Vec<_>>());
        let squares = parts.zip(inverse.singular_values.iter());
        spread * libm::sqrt(squares.map(|(part, value)| (part / value) * (part / value)).sum())
    };
    let names = unknowns.iter().flat_map(Unknown::names);
    let numbers = names.enumerate().map(|(index, name)| CalibratedNumber {
        name,
        before: start[index],
        value: values[index],
        deviation: deviation(index),
    });
    let of_balls: Vec<usize> = readings.iter().map(|reading| reading.ball).collect();
    let residuals = Residuals { derivatives: &derivatives, off: &left, balls: &of_balls };
    let mean = |errors: &DVector<f64>| errors.norm() / libm::sqrt(have as f64);
    Ok(Calibration {
        numbers: numbers.collect(),
        before: mean(&first),
        after: mean(&left),
        spread,
        settings: unknown::settings(unknowns, &values),
        outliers: residuals.outliers(),
        without: None,
    })
}

/// By how much what each reading says of its ball is off the mean of what all say, mm, part frame.
fn off_their_ball(machine: &Machine, readings: &[BallReading], balls: usize) -> DVector<f64> {
    let joints = machine.axes.iter().map(|axis| axis.joint).collect();
    let mut chain = Chain::new(joints, machine.mount, machine.gauge, machine.tool_axis);
    let mut length = 0.0;
    let mut said = Vec::with_capacity(readings.len());
    let mut means = vec![(Vector3::zeros(), 0.0); balls];
    for reading in readings {
        if reading.length.to_bits() != f64::to_bits(length) {
            length = reading.length;
            let tip = machine.gauge - machine.tool_axis * length;
            chain = Chain::new(chain.joints().to_vec(), machine.mount, tip, machine.tool_axis);
        }
        let turns = chain.turns(&reading.joints);
        let mut off = reading.off;
        let carrying = machine.axes.iter().take_while(|axis| axis.carries_part).count();
        for (index, joint) in chain.joints().iter().enumerate().take(carrying).rev() {
            if joint.rotary {
                let (sine, cosine) = turns.of(index);
                off = turn(off, joint.direction, sine, cosine);
            }
        }
        let place = chain.pose(&reading.joints, &turns).tip + off;
        let (sum, count) = &mut means[reading.ball];
        *sum += place;
        *count += 1.0;
        said.push(place);
    }
    let off = readings.iter().zip(&said).flat_map(|(reading, place)| {
        let (sum, count) = means[reading.ball];
        let off: [f64; 3] = (place - sum / count).into();
        off
    });
    DVector::from_iterator(3 * readings.len(), off)
}

/// How the errors change with each value, by central differences.
fn differences<E>(
    values: &[f64],
    steps: &[f64],
    errors: &mut OffBalls<'_, E>,
) -> Result<DMatrix<f64>, E> {
    let mut columns = Vec::with_capacity(values.len());
    for (index, step) in steps.iter().enumerate() {
        let mut at = |value: f64| {
            let mut moved = values.to_vec();
            moved[index] = value;
            errors(&moved)
        };
        let (more, less) = (at(values[index] + step)?, at(values[index] - step)?);
        columns.push((more - less) / (2.0 * step));
    }
    Ok(DMatrix::from_columns(&columns))
}

/// The step of Gauss and Newton, where every combination of the numbers moves the errors.
fn determined_step<E>(
    unknowns: &[Unknown],
    derivatives: &DMatrix<f64>,
    errors: &DVector<f64>,
) -> Result<DVector<f64>, CalibrationFault<E>> {
    // Columns of one length, so that millimetres and slopes are weighed by what they move.
    let lengths: Vec<f64> = derivatives.column_iter().map(|column| column.norm()).collect();
    let longest = lengths.iter().fold(0.0, |one: f64, other| one.max(*other));
    let names: Vec<String> = unknowns.iter().flat_map(Unknown::names).collect();
    let still = |length: &f64| *length <= 1e-9 * longest || *length == 0.0;
    let alone: Vec<Vec<String>> = (lengths.iter().zip(&names))
        .filter(|(length, _)| still(length))
        .map(|(_, name)| vec![name.clone()])
        .collect();
    if !alone.is_empty() {
        return Err(CalibrationFault::Undetermined(alone));
    }
    let mut scaled = derivatives.clone();
    for (mut column, length) in scaled.column_iter_mut().zip(&lengths) {
        column /= *length;
    }
    let decomposed = scaled.svd(true, true);
    let largest = decomposed.singular_values.amax();
    let directions = decomposed.v_t.iter().flat_map(|rows| rows.row_iter());
    let together: Vec<Vec<String>> = directions
        .zip(decomposed.singular_values.iter())
        .filter(|(_, value)| **value < SMALLEST * largest)
        .map(|(direction, _)| {
            let parts = direction.iter().zip(&names);
            let parts = parts.filter(|(part, _)| libm::fabs(**part) > SMALL_SHARE);
            parts.map(|(_, name)| name.clone()).collect()
        })
        .collect();
    if !together.is_empty() {
        return Err(CalibrationFault::Undetermined(together));
    }
    let solved = decomposed.solve(&-errors, 0.0).map_err(|_| CalibrationFault::Lost)?;
    Ok(DVector::from_iterator(
        lengths.len(),
        solved.iter().zip(&lengths).map(|(part, length)| part / length),
    ))
}

/// The values by the step, or by a shorter one, with which the errors are smaller; none if there are none.
fn shorter<E>(
    values: &[f64],
    step: &DVector<f64>,
    errors: &DVector<f64>,
    of: &mut OffBalls<'_, E>,
) -> Result<Option<Trial>, E> {
    let mut share = 1.0;
    for _ in 0..10 {
        let next: Vec<f64> =
            values.iter().zip(step.iter()).map(|(value, step)| value + share * step).collect();
        let less = of(&next)?;
        if less.norm_squared() < errors.norm_squared() {
            return Ok(Some(Trial { values: next, off: less }));
        }
        share /= 4.0;
    }
    Ok(None)
}
