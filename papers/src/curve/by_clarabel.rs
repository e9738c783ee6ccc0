//! The feedrate paper's linear program (eq. 25) by clarabel, an interior-point solver of others: the reference for our own.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver as _, NonnegativeConeT, SolverStatus, ZeroConeT,
};
use post_feed::problem::Row;
use post_feed::reach::Reach;
use post_feed::{Ends, Problem};

/// Iterations after which it is given up.
const MOST_ITERATIONS: u32 = 200;

/// A plan of it that breaks a limit by more, as a share of it, is none.
const MOST_BROKEN: f64 = 1e-6;

/// What it answers.
pub struct Answer {
    /// `q` at each sample; keeps rows to some 1e-8 of a limit.
    pub q: Vec<f64>,
    /// What no plan can exceed, by its multipliers.
    pub bound: f64,
    pub iterations: u32,
}

/// The plan with the largest `Σ weight * q`.
///
/// # Errors
/// The state that it ended in; or a limit is broken by the plan that it ended with.
pub fn solve(problem: &Problem, weights: &[f64]) -> Result<Answer, String> {
    let count = problem.upper.len();
    let stride = problem.stride();
    // Unknowns are shares of the largest `q` that can be there: speeds of the parameter differ by orders.
    let mut reach = Reach::default();
    let found = reach.controllable(problem);
    found.map_err(|fault| problem.describe(&fault))?;
    let high = reach.sets().1.iter();
    let unit: Vec<f64> = high.map(|&high| if high > 0.0 { high } else { 1.0 }).collect();
    let size = |interval: usize, row: &Row| {
        let [here, next] = [row.here * unit[interval], row.next * unit[interval + 1]];
        here.abs().max(next.abs())
    };
    let first_row = 2 + 2 * count;
    let Ends { start, end } = problem.ends;
    let mut side = vec![start / unit[0], end / unit[count - 1]];
    let bounds = problem.upper.iter().zip(&unit);
    side.extend(bounds.flat_map(|(upper, unit)| [upper / unit, 0.0]));
    for interval in 0..count - 1 {
        for row in problem.rows_of(interval) {
            let size = size(interval, row);
            side.extend([if size > 0.0 { 1.0 / size } else { 1.0 }; 2]);
        }
    }
    // Column by column: what each sample enters.
    let (mut starts, mut places, mut values) = (vec![0], Vec::new(), Vec::new());
    for (sample, unit_here) in unit.iter().enumerate() {
        let mut enter = |row: usize, value: f64| {
            if value != 0.0 {
                places.push(row);
                values.push(value);
            }
        };
        if sample == 0 {
            enter(0, 1.0);
        }
        if sample + 1 == count {
            enter(1, 1.0);
        }
        enter(2 + 2 * sample, 1.0);
        enter(3 + 2 * sample, -1.0);
        let before = sample.checked_sub(1).map(|interval| (interval, true));
        let behind = (sample + 1 < count).then_some((sample, false));
        for (interval, at_end) in before.into_iter().chain(behind) {
            for (place, row) in problem.rows_of(interval).iter().enumerate() {
                let value = unit_here * if at_end { row.next } else { row.here };
                if value != 0.0 {
                    let value = value / size(interval, row);
                    let at = first_row + 2 * (interval * stride + place);
                    enter(at, value);
                    enter(at + 1, -value);
                }
            }
        }
        starts.push(places.len());
    }
    let matrix = CscMatrix::new(side.len(), count, starts, places, values);
    let gains: Vec<f64> = weights.iter().zip(&unit).map(|(weight, unit)| weight * unit).collect();
    let most = gains.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let cost: Vec<f64> = gains.iter().map(|gain| -gain / most).collect();
    let settings = DefaultSettings {
        verbose: false,
        max_iter: MOST_ITERATIONS,
        tol_gap_rel: 1e-9,
        ..DefaultSettings::default()
    };
    let cones = [ZeroConeT(2), NonnegativeConeT(side.len() - 2)];
    let quadratic = CscMatrix::zeros((count, count));
    let made = DefaultSolver::new(&quadratic, &cost, &matrix, &side, &cones, settings);
    let mut solver = made.map_err(|error| error.to_string())?;
    solver.solve();
    let solution = &solver.solution;
    if !matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
        return Err(format!("{:?}", solution.status));
    }
    let each = solution.x.iter().zip(&unit);
    let q: Vec<f64> = each.map(|(x, unit)| (x * unit).max(0.0)).collect();
    let broken = problem.worst(&q).share - 1.0;
    if broken > MOST_BROKEN {
        return Err(format!("{:?}, a limit broken by {broken:.1e} of it", solution.status));
    }
    Ok(Answer { q, bound: -solution.obj_val_dual * most, iterations: solution.iterations })
}
