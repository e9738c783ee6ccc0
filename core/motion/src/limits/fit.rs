//! Bounds of derivatives by Chebyshev series.
//!
//! A value `f` over a piece of a move of half-width `h` is `Σ c_k·T_k(x)`, `x` from -1 to 1, and with
//! `|T_k'| ≤ k²`, `|T_k''| ≤ k²(k²-1)/3`, `|T_k'''| ≤ k²(k²-1)(k²-4)/15` (what they are at the ends of -1 to 1, by the inequality
//! of V. A. Markov the most that they are) the sums of `|c_k|` times these over `h`, `h²`, `h³` bound its derivatives. The
//! coefficients are those of the polynomial through the values at the extremes of `T_6`.

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, MAX_AXES, Pose, Unreachable};

use super::MoveLimits;
use crate::Move;
use crate::path::{Curve, Stance};

/// Degree of the series.
const DEGREE: usize = 6;

/// Turn of all axes together, or of an arc, over a piece, radians: the sine of it falls below 1e-8 by the sixth term.
const PIECE: f64 = 0.5;

/// More pieces than this are made of no move.
const MOST: f64 = 1e4;

/// Cosines of the multiples of 30 degrees.
const COSINES: [f64; 12] = {
    let root = 0.866_025_403_784_438_6;
    [1.0, root, 0.5, 0.0, -0.5, -root, -1.0, -root, -0.5, 0.0, 0.5, root]
};

/// How much the value at each of the first four places has of each coefficient; those after the middle have as much, of
/// the odd ones with the other sign.
const WEIGHTS: [[f64; DEGREE / 2 + 1]; DEGREE + 1] = {
    let mut weights = [[0.0; DEGREE / 2 + 1]; DEGREE + 1];
    let mut k = 0;
    while k <= DEGREE {
        let mut place = 0;
        while place <= DEGREE / 2 {
            // The place stands at -cos(place·30°); ends count half, and so does the last coefficient.
            let end = if place == 0 { 0.5 } else { 1.0 };
            let last = if k == DEGREE { 0.5 } else { 1.0 };
            weights[k][place] =
                COSINES[(k * (DEGREE - place)) % 12] * end * last * 2.0 / DEGREE as f64;
            place += 1;
        }
        k += 1;
    }
    weights
};

/// The largest magnitudes of the first three derivatives of each `T_k` from -1 to 1: those at its ends.
const STEEPEST: [[f64; 3]; DEGREE + 1] = {
    let mut steepest = [[0.0; 3]; DEGREE + 1];
    let mut k = 1;
    while k <= DEGREE {
        let square = (k * k) as f64;
        let second = square * (square - 1.0) / 3.0;
        steepest[k] = [square, second, if k > 2 { second * (square - 4.0) / 5.0 } else { 0.0 }];
        k += 1;
    }
    steepest
};

/// N values at the places of a piece, from its beginning to its end.
type ChebyshevSamples<const N: usize> = [[f64; N]; DEGREE + 1];

/// Coefficients of N Chebyshev series, from that of `T_0` on.
type ChebyshevSeries<const N: usize> = [[f64; N]; DEGREE + 1];

/// Bounds along `task` where it is no straight one: of its axes or the coordinates that stand for them, of its tip, as
/// `wanted` says.
pub(super) fn over(
    task: &Move,
    coordinates: Option<&[Option<usize>; MAX_AXES]>,
    wanted: [bool; 2],
    found: &mut MoveLimits,
) -> Result<(), Unreachable> {
    let chain = task.solver.chain();
    let posed = coordinates.is_some() || wanted[1];
    let values = |stance: &Stance| -> (Joints, [f64; 3]) {
        let mut values = stance.joints;
        for (value, coordinate) in values.iter_mut().zip(coordinates.into_iter().flatten()) {
            if let Some(coordinate) = coordinate {
                *value = stance.pose.tip[*coordinate];
            }
        }
        (values, stance.pose.tip.into())
    };
    let turned: f64 = chain
        .joints()
        .iter()
        .enumerate()
        .filter(|(_, joint)| joint.rotary)
        .map(|(place, _)| libm::fabs(task.to.joints[place] - task.from.joints[place]))
        .sum();
    let turned = turned + task.way.curve().turn();
    let [start] = stances(task, &[0.0], &task.from.joints, posed)?;
    let mut near = start.joints;
    let mut last = values(&start);
    let mut run = |from: f64, to: f64, ends: [bool; 2]| -> Result<(), Unreachable> {
        let half = 0.5 * (to - from);
        let (mut axes, mut tips): (ChebyshevSamples<MAX_AXES>, ChebyshevSamples<3>) =
            Default::default();
        (axes[0], tips[0]) = last;
        let shares: [f64; DEGREE] =
            std::array::from_fn(|place| from + half * (1.0 - COSINES[place + 1]));
        let stances = stances(task, &shares, &near, posed)?;
        near = stances[DEGREE - 1].joints;
        for (place, stance) in stances.iter().enumerate() {
            (axes[place + 1], tips[place + 1]) = values(stance);
        }
        last = (axes[DEGREE], tips[DEGREE]);
        if wanted[0] {
            found.take_axes(&series(&axes), half, ends);
        }
        if wanted[1] {
            found.take_tip(&series(&tips), half, ends);
        }
        Ok(())
    };
    let split = |from: f64, to: f64, run: &mut dyn FnMut(f64, f64) -> Result<(), Unreachable>| {
        let count = (turned * (to - from) / PIECE).ceil().clamp(1.0, MOST);
        let mut begins = from;
        for piece in 1..=count as u32 {
            let ends = from + (to - from) * f64::from(piece) / count;
            run(begins, ends)?;
            begins = ends;
        }
        Ok(())
    };
    let mut each = |begins: f64, ends: f64| run(begins, ends, [begins == 0.0, ends == 1.0]);
    let Curve::Spline(spline) = task.way.curve() else {
        return split(0.0, 1.0, &mut each);
    };
    // A spline is a polynomial (or a quotient of two) from knot to knot.
    let [first, last] = spline.range();
    let share = |knot: f64| (knot - first) / (last - first);
    for span in spline.spans() {
        let [from, to] = [span, span + 1].map(|place| share(spline.knots[place]));
        let middle = 0.5 * (from + to);
        split(from, middle, &mut each)?;
        split(middle, to, &mut each)?;
    }
    Ok(())
}

/// Where the axes stand at each of `shares` of the way, one after the other, the first `near` those values; the tool
/// too, where the stances are to be `posed`.
fn stances<const N: usize>(
    task: &Move,
    shares: &[f64; N],
    near: &Joints,
    posed: bool,
) -> Result<[Stance; N], Unreachable> {
    let ends = [&task.from, &task.to];
    if posed {
        return task.way.stances_at(&task.solver, ends, shares, near);
    }
    let mut stances = [Stance { joints: *near, pose: Pose::default() }; N];
    let mut near = *near;
    for (stance, share) in stances.iter_mut().zip(shares) {
        near = task.way.joints_at(&task.solver, ends, *share, &near)?;
        stance.joints = near;
    }
    Ok(stances)
}

/// Coefficients of the Chebyshev series through `samples`; that of `T_0`, which has no derivative, is left out.
fn series<const N: usize>(samples: &ChebyshevSamples<N>) -> ChebyshevSeries<N> {
    const MIDDLE: usize = DEGREE / 2;
    let mut series = [[0.0; N]; DEGREE + 1];
    for place in 0..=MIDDLE {
        let (first, last) = (&samples[place], &samples[DEGREE - place]);
        let mut halves = [[0.0; N]; 2];
        for value in 0..N {
            halves[1][value] = first[value] - last[value];
            halves[0][value] = match place {
                MIDDLE => first[value],
                _ => first[value] + last[value],
            };
        }
        for (k, sums) in series.iter_mut().enumerate().skip(1) {
            let weight = WEIGHTS[k][place];
            for (sum, value) in sums.iter_mut().zip(&halves[k % 2]) {
                *sum += weight * value;
            }
        }
    }
    series
}

/// First and second derivatives of N series where the piece begins and ends; `half`: its half-width.
fn at_ends<const N: usize>(series: &ChebyshevSeries<N>, half: f64) -> [[[f64; N]; 2]; 2] {
    let [mut first, mut second] = [[[0.0; N]; 2]; 2];
    for (k, coefficients) in series.iter().enumerate().skip(1) {
        // T_k' is k² at 1 and -k² or k² at -1, T_k'' there the other way round.
        let sign = if k % 2 == 0 { -1.0 } else { 1.0 };
        let steep = STEEPEST[k][0] / half;
        let bend = STEEPEST[k][1] / (half * half);
        for (place, coefficient) in coefficients.iter().enumerate() {
            first[0][place] += sign * steep * coefficient;
            first[1][place] += steep * coefficient;
            second[0][place] -= sign * bend * coefficient;
            second[1][place] += bend * coefficient;
        }
    }
    [first, second]
}

impl MoveLimits {
    /// Takes what the axes do on a piece of half-width `half`; `ends`: it is the first, the last.
    fn take_axes(&mut self, series: &ChebyshevSeries<MAX_AXES>, half: f64, ends: [bool; 2]) {
        let mut bounds = [[0.0; MAX_AXES]; 3];
        for (coefficients, steepest) in series.iter().zip(&STEEPEST).skip(1) {
            for (bounds, steep) in bounds.iter_mut().zip(steepest) {
                for (bound, coefficient) in bounds.iter_mut().zip(coefficients) {
                    *bound += libm::fabs(*coefficient) * steep;
                }
            }
        }
        let scales = [half, half * half, half * half * half].map(f64::recip);
        let own = [&mut self.first, &mut self.second, &mut self.third];
        for ((own, bounds), scale) in own.into_iter().zip(&bounds).zip(scales) {
            for (own, bound) in own.iter_mut().zip(bounds) {
                *own = own.max(bound * scale);
            }
        }
        if ends != [false; 2] {
            let [first, second] = at_ends(series, half);
            for end in [0, 1].into_iter().filter(|end| ends[*end]) {
                (self.ends[end], self.bends[end]) = (first[end], second[end]);
            }
        }
    }

    /// Likewise, what the tip does.
    fn take_tip(&mut self, series: &ChebyshevSeries<3>, half: f64, ends: [bool; 2]) {
        let mut bounds = [0.0; 3];
        for (coefficients, steepest) in series.iter().zip(&STEEPEST).skip(1) {
            let length = Vector3::from(*coefficients).norm();
            for (bound, steep) in bounds.iter_mut().zip(steepest) {
                *bound += length * steep;
            }
        }
        let scales = [half, half * half, half * half * half].map(f64::recip);
        for ((own, bound), scale) in self.tip.iter_mut().zip(bounds).zip(scales) {
            *own = own.max(bound * scale);
        }
        let [first, _] = at_ends(series, half);
        for end in [0, 1].into_iter().filter(|end| ends[*end]) {
            self.tip_ends[end] = first[end].into();
        }
    }
}
