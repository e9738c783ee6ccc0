//! Bounds of derivatives by Chebyshev series.
//!
//! A value `f` over a piece of a move of half-width `h` is `Σ c_k·T_k(x)`, `x` from -1 to 1, and with
//! `|T_k'| ≤ k²`, `|T_k''| ≤ k²(k²-1)/3`, `|T_k'''| ≤ k²(k²-1)(k²-4)/15` (what they are at the ends of -1 to 1, by the inequality
//! of V. A. Markov the most that they are) the sums of `|c_k|` times these over `h`, `h²`, `h³` bound its derivatives. The
//! coefficients are those of the polynomial through the values at the extremes of `T_6`.

use post_machine::kinematics::{Joints, MAX_AXES, Unreachable};

use super::MoveLimits;
use crate::Move;
use crate::path::{Stance, Way};

/// Degree of the series.
const DEGREE: usize = 6;

/// Turn of all axes together, or of an arc, over a piece, radians: the sine of it falls below 1e-8 by the sixth term.
const PIECE: f64 = 0.5;

/// More pieces than this are made of no move.
const MOST: f64 = 1e4;

/// Cosines of the multiples of 30 degrees.
const COSINES: [f64; 12] = {
    let root = 0.866_025_403_784_438_6;
    [
        1.0, root, 0.5, 0.0, -0.5, -root, -1.0, -root, -0.5, 0.0, 0.5, root,
    ]
};

/// Values that are followed: one a place of the chain, and the tip's three.
const VALUES: usize = MAX_AXES + 3;

/// Their values at the places of a piece, from its beginning to its end.
type Samples = [[f64; VALUES]; DEGREE + 1];

/// Bounds along `task` where it is no straight one: of its axes or the coordinates that stand for them, of its tip, as
/// `wanted` says.
pub(super) fn over(
    task: &Move,
    coordinates: Option<&[Option<usize>; MAX_AXES]>,
    wanted: [bool; 2],
    found: &mut MoveLimits,
) -> Result<(), Unreachable> {
    let chain = task.solver.chain();
    let mut near = task.from.joints;
    let mut sample = |t: f64| -> Result<[f64; VALUES], Unreachable> {
        let Stance { joints, pose } =
            task.way
                .stance_at(&task.solver, [&task.from, &task.to], t, &near)?;
        near = joints;
        let mut values = [0.0; VALUES];
        values[..MAX_AXES].copy_from_slice(&joints);
        if let Some(coordinates) = coordinates {
            for (value, coordinate) in values.iter_mut().zip(coordinates) {
                if let Some(coordinate) = coordinate {
                    *value = pose.tip[*coordinate];
                }
            }
        }
        values[MAX_AXES..].copy_from_slice(pose.tip.as_slice());
        Ok(values)
    };
    let turned: f64 = chain
        .joints()
        .iter()
        .enumerate()
        .filter(|(_, joint)| joint.rotary)
        .map(|(place, _)| libm::fabs(task.to.joints[place] - task.from.joints[place]))
        .sum();
    let turned = match &task.way {
        Way::Arc { sweep, .. } => turned + libm::fabs(*sweep),
        _ => turned,
    };
    let mut last = sample(0.0)?;
    let mut run = |from: f64, to: f64, ends: [bool; 2]| -> Result<(), Unreachable> {
        let half = 0.5 * (to - from);
        let mut samples: Samples = [last; DEGREE + 1];
        for (place, values) in samples.iter_mut().enumerate().skip(1) {
            *values = sample(from + half * (1.0 - COSINES[place]))?;
        }
        last = samples[DEGREE];
        found.take(&series(&samples), half, wanted, ends);
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
    let Way::Spline(spline) = &task.way else {
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

/// Coefficients of the Chebyshev series through `samples`, from `T_0` on.
fn series(samples: &Samples) -> Samples {
    let mut series = [[0.0; VALUES]; DEGREE + 1];
    for (k, sums) in series.iter_mut().enumerate() {
        for (place, values) in samples.iter().enumerate() {
            // The place stands at -cos(place·30°); ends count half, and so do the first and last coefficient.
            let half = |at: usize| if at == 0 || at == DEGREE { 0.5 } else { 1.0 };
            let cosine = COSINES[(k * (DEGREE - place)) % 12];
            let weight = cosine * half(place) * half(k) * 2.0 / DEGREE as f64;
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
    }
    series
}

/// The largest magnitudes of the first three derivatives of `T_k` from -1 to 1: those at its ends.
fn steepest(k: usize) -> [f64; 3] {
    let square = (k * k) as f64;
    let second = square * (square - 1.0) / 3.0;
    [square, second, second * (square - 4.0).max(0.0) / 5.0]
}

impl MoveLimits {
    /// Takes a piece of half-width `half`; `at_ends`: it is the first, the last.
    fn take(&mut self, series: &Samples, half: f64, wanted: [bool; 2], at_ends: [bool; 2]) {
        let [axes, tip] = wanted;
        let scales = [half, half * half, half * half * half];
        let mut bounds = [[0.0; VALUES]; 3];
        let mut tips = [0.0; 3];
        let mut ends = [[0.0; VALUES]; 2];
        let mut bends = [[0.0; VALUES]; 2];
        for (k, coefficients) in series.iter().enumerate().skip(1) {
            let steep = steepest(k);
            for (place, coefficient) in coefficients.iter().enumerate() {
                for (bound, steep) in bounds.iter_mut().zip(steep) {
                    bound[place] += libm::fabs(*coefficient) * steep;
                }
                // T_k' is k² at 1 and -k² or k² at -1, T_k'' there the other way round.
                let sign = if k % 2 == 0 { -1.0 } else { 1.0 };
                ends[0][place] += sign * steep[0] * coefficient;
                ends[1][place] += steep[0] * coefficient;
                bends[0][place] -= sign * steep[1] * coefficient;
                bends[1][place] += steep[1] * coefficient;
            }
            let [x, y, z] = [0, 1, 2].map(|place| coefficients[MAX_AXES + place]);
            let length = (x * x + y * y + z * z).sqrt();
            for (tip, steep) in tips.iter_mut().zip(steep) {
                *tip += length * steep;
            }
        }
        if axes {
            let own = [&mut self.first, &mut self.second, &mut self.third];
            for ((own, bound), scale) in own.into_iter().zip(&bounds).zip(scales) {
                for (own, bound) in own.iter_mut().zip(bound) {
                    *own = own.max(bound / scale);
                }
            }
        }
        if tip {
            for ((own, bound), scale) in self.tip.iter_mut().zip(tips).zip(scales) {
                *own = own.max(bound / scale);
            }
        }
        for end in [0, 1].into_iter().filter(|end| at_ends[*end]) {
            if axes {
                let own: &mut Joints = &mut self.ends[end];
                for (own, value) in own.iter_mut().zip(&ends[end]) {
                    *own = value / half;
                }
                for (own, value) in self.bends[end].iter_mut().zip(&bends[end]) {
                    *own = value / (half * half);
                }
            }
            if tip {
                for place in 0..3 {
                    self.tip_ends[end][place] = ends[end][MAX_AXES + place] / half;
                }
            }
        }
    }
}
