//! The linear program by clarabel, a general interior-point solver that shares no line with ours.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};
use post_feed::Problem;

/// Why clarabel has no plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unsolved {
    /// There is none.
    Infeasible,
    /// It ended before it knew, as it does here and there on the border of what is feasible.
    Undecided,
}

/// `q` and objective.
pub fn solve(problem: &Problem, weights: &[f64]) -> Result<(Vec<f64>, f64), Unsolved> {
    let count = problem.upper.len();
    let scale = problem.upper.iter().copied().fold(0.0, f64::max);
    let (mut rows, mut columns, mut values, mut side) = (vec![], vec![], vec![], vec![]);
    let mut push = |entries: &[(usize, f64)], most: f64| {
        for &(column, value) in entries {
            rows.push(side.len());
            columns.push(column);
            values.push(value);
        }
        side.push(most);
    };
    push(&[(0, 1.0)], problem.ends.start / scale);
    push(&[(count - 1, 1.0)], problem.ends.end / scale);
    for (sample, upper) in problem.upper.iter().enumerate() {
        push(&[(sample, 1.0)], upper / scale);
        push(&[(sample, -1.0)], 0.0);
    }
    for interval in 0..problem.steps.len() {
        for row in problem.rows_of(interval) {
            let size = row.here.abs().max(row.next.abs());
            if size == 0.0 {
                continue;
            }
            let most = 1.0 / (size * scale);
            let [here, next] = [row.here / size, row.next / size];
            push(&[(interval, here), (interval + 1, next)], most);
            push(&[(interval, -here), (interval + 1, -next)], most);
        }
    }
    let cones = [ZeroConeT(2), NonnegativeConeT(side.len() - 2)];
    let matrix = CscMatrix::new_from_triplets(side.len(), count, rows, columns, values);
    let cost: Vec<f64> = weights.iter().map(|weight| -weight).collect();
    let settings = DefaultSettings {
        verbose: false,
        max_iter: 200,
        tol_gap_rel: 1e-9,
        tol_feas: 1e-9,
        ..DefaultSettings::default()
    };
    let none = CscMatrix::zeros((count, count));
    let mut solver = DefaultSolver::new(&none, &cost, &matrix, &side, &cones, settings).unwrap();
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {}
        // Stopped short of its tolerances, and near enough for ours.
        SolverStatus::MaxIterations | SolverStatus::InsufficientProgress
            if solver.info.gap_rel < 1e-7
                && solver.info.res_primal < 1e-8
                && solver.info.res_dual < 1e-8 => {}
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
            return Err(Unsolved::Infeasible);
        }
        SolverStatus::MaxIterations | SolverStatus::InsufficientProgress => {
            return Err(Unsolved::Undecided);
        }
        other => panic!("clarabel: {other:?}"),
    }
    let q: Vec<f64> = solver.solution.x.iter().map(|x| x * scale).collect();
    let objective = q.iter().zip(weights).map(|(q, weight)| q * weight).sum();
    Ok((q, objective))
}
