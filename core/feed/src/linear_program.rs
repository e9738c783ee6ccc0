//! The linear program of the feedrate paper (eq. 25): the largest weighted sum of `q` under all bounds and rows, by an
//! interior-point method of our own that costs a linear time an iteration.
//!
//! - **Infeasible problems** are found, and named, by the backward pass of [`crate::reach`] before the first
//!   iteration, exactly and in linear time; its controllable sets are also the tightest upper bounds that are known, by
//!   which unknowns are scaled.
//! - **No limit is broken** by what the iteration leaves: one forward pass moves its answer into the controllable sets.
//! - **How good it is** is proven: the multipliers give an upper bound on what any plan can have, whether or not they
//!   have converged.

use crate::infeasible::Infeasible;
use crate::interior::{ConvexProgram, Cost, Inequality};
use crate::problem::Problem;
use crate::reach::ReachPlanner;

/// The gap to which the iteration goes, as a share of the objective.
const TOLERANCE: f64 = 1e-9;

/// An answer of the linear program.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// `q` at each sample. Keeps every limit up to rounding.
    pub q: Vec<f64>,
    /// `Σ weight * q`.
    pub objective: f64,
    /// What no plan can exceed, proven.
    pub bound: f64,
    /// Iterations of the interior-point method.
    pub iterations: usize,
}

impl Optimum {
    /// How much of the bound is missing at most, as a share of it.
    #[must_use]
    pub fn gap(&self) -> f64 {
        (self.bound - self.objective) / self.bound.abs().max(f64::MIN_POSITIVE)
    }
}

/// The plan with the largest `Σ weight * q`. With [`crate::Samples::squared_feed_weights`], or all 1 where the
/// parameter is the arc length, that is the paper's `Σ f²`.
///
/// # Errors
/// Which limit cannot be kept, and where.
///
/// # Panics
/// If there is not one weight a sample, or one is negative.
pub fn solve(problem: &Problem, weights: &[f64]) -> Result<Optimum, Infeasible> {
    assert_eq!(weights.len(), problem.upper.len(), "a weight a sample");
    assert!(weights.iter().all(|&weight| weight >= 0.0), "no weight is negative");
    problem.check()?;
    let mut reach = ReachPlanner::default();
    let mut plan = Vec::new();
    reach.solve_into(problem, &mut plan)?;
    let (low, high) = reach.sets();
    let scaled = Scaled::new(problem, weights, low, high);
    let start = scaled.start(&plan);
    let solution = scaled.program.minimise(&start, TOLERANCE);
    let mut q: Vec<f64> =
        solution.x.iter().zip(&scaled.scale).map(|(x, scale)| x * scale).collect();
    reach.settle(problem, &mut q);
    let value = |q: &[f64]| q.iter().zip(weights).map(|(q, weight)| q * weight).sum::<f64>();
    // Where the iteration stopped short of what reachability analysis has, the better one is the answer.
    let (objective, fallback) = (value(&q), value(&plan));
    let (q, objective) = if fallback > objective { (plan, fallback) } else { (q, objective) };
    let bound = scaled.constant - scaled.unit * scaled.program.bound(&solution.multipliers);
    Ok(Optimum { q, objective, bound: bound.max(objective), iterations: solution.iterations })
}

/// The program in unknowns `q / scale`, with rows and weights of the order of 1.
struct Scaled {
    program: ConvexProgram<2>,
    scale: Vec<f64>,
    /// What a weight of 1 stands for.
    unit: f64,
    /// Objective of the samples that are fixed.
    constant: f64,
}

impl Scaled {
    fn new(problem: &Problem, weights: &[f64], low: &[f64], high: &[f64]) -> Self {
        let count = high.len();
        let last = count - 1;
        let mut low = low.to_vec();
        let mut high = high.to_vec();
        (low[0], high[0]) = (problem.ends.start, problem.ends.start);
        (low[last], high[last]) = (problem.ends.end, problem.ends.end);
        // What has no room, or none but by rounding, is fixed.
        let fixed = |sample: usize| high[sample] - low[sample] <= 1e-11 * high[sample];
        let scale: Vec<f64> =
            (0..count).map(|sample| if high[sample] > 0.0 { high[sample] } else { 1.0 }).collect();
        let weighed = |sample: usize| weights[sample] * scale[sample];
        let free = (0..count).filter(|&sample| !fixed(sample));
        let unit = free.map(weighed).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let mut constant = 0.0;
        let mut program = ConvexProgram {
            cost: Cost::Linear,
            weights: Vec::with_capacity(count),
            lower: Vec::with_capacity(count),
            upper: Vec::with_capacity(count),
            offsets: Vec::with_capacity(count),
            rows: Vec::with_capacity(2 * problem.rows.len()),
        };
        for sample in 0..count {
            let still = fixed(sample);
            if still {
                constant += weights[sample] * high[sample];
            }
            program.weights.push(if still { 0.0 } else { weighed(sample) / unit });
            program.lower.push(if still { high[sample] } else { low[sample] } / scale[sample]);
            program.upper.push(high[sample] / scale[sample]);
        }
        program.offsets.push(0);
        for sample in 0..last {
            let place = [sample, sample + 1];
            for row in problem.rows_of(sample) {
                let mut a = [row.here * scale[sample], row.next * scale[sample + 1]];
                let mut shift = 0.0;
                for (a, sample) in a.iter_mut().zip(place) {
                    if fixed(sample) {
                        shift += *a * program.upper[sample];
                        *a = 0.0;
                    }
                }
                let size = a[0].abs().max(a[1].abs());
                // A row that no `q` of the sets can break is left out.
                if a[0].abs() + a[1].abs() + shift.abs() < 1.0 || size == 0.0 {
                    continue;
                }
                let most = |side: f64| (1.0 - side * shift) / size;
                for side in [1.0, -1.0] {
                    program
                        .rows
                        .push(Inequality { a: a.map(|a| side * a / size), most: most(side) });
                }
            }
            program.offsets.push(program.rows.len());
        }
        Self { program, scale, unit, constant }
    }

    /// Half as fast as reachability analysis is, which is well inside where the path is at rest at both ends.
    fn start(&self, plan: &[f64]) -> Vec<f64> {
        let each = plan.iter().zip(&self.scale).enumerate();
        each.map(|(sample, (q, scale))| {
            let (low, high) = (self.program.lower[sample], self.program.upper[sample]);
            let room = high - low;
            (0.5 * q / scale).clamp(low + 0.01 * room, high - 0.01 * room)
        })
        .collect()
    }
}
