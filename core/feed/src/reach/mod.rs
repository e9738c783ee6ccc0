//! Reachability analysis: the fastest plan in linear time, two passes.
//!
//! Backwards, the *controllable set* of each sample is found: the interval of `q` from which the rest of the path can
//! be followed without breaking a limit. Forwards, the largest `q` is taken at each sample that the one before allows and
//! that stays in the controllable set. So the plan keeps every limit at zero-inertia points too, and where limits are
//! not monotone: the forward pass cannot run into a place that has no way on (Pham and Pham, *A new approach to
//! time-optimal path parameterization based on reachability analysis*, 2018).
//!
//! Where every row is monotone (`here` and `next` have not the same sign) no plan is faster at any sample: the plans
//! that keep all limits are then closed under taking the larger `q` at each sample, so that one of them is the largest
//! everywhere, and both passes only ever cut what cannot belong to it.

mod blame;
mod step;
pub mod stream;

use crate::infeasible::Infeasible;
use crate::problem::{LimitRow, Problem};

pub use stream::{ReachStream, Settled};

/// Controllable sets, and the plan through them; its memory is used again from problem to problem.
#[derive(Clone, Debug, Default)]
pub struct ReachPlanner {
    /// Smallest `q` of each sample from which the rest of the path can be followed.
    low: Vec<f64>,
    /// The largest.
    high: Vec<f64>,
}

impl ReachPlanner {
    /// Finds the controllable sets of `problem`, which has passed [`Problem::check`] as those of [`Problem::new`] have.
    ///
    /// # Errors
    /// Where one is empty, or does not hold the speed that the plan begins with: which limit, and where.
    pub fn controllable(&mut self, problem: &Problem) -> Result<(), Infeasible> {
        self.backward(problem)?;
        let start = problem.ends.start;
        // A start that was itself the outcome of a pass may differ from the bound by rounding.
        let margin = 1e-12 * problem.upper[0];
        if start > self.high[0] + margin {
            return Err(blame::start(problem));
        }
        if start < self.low[0] - margin {
            return Err(blame::end(problem, 0, start, start));
        }
        Ok(())
    }

    /// Finds the controllable sets, whatever the plan begins with.
    pub(crate) fn backward(&mut self, problem: &Problem) -> Result<(), Infeasible> {
        let count = problem.upper.len();
        self.low.clear();
        self.low.resize(count, 0.0);
        self.high.clear();
        self.high.resize(count, 0.0);
        let last = count - 1;
        let end = problem.ends.end;
        if end > problem.upper[last] {
            return Err(Infeasible::OutOfReach {
                sample: last,
                source: problem.causes[last],
                needed: end,
                allowed: problem.upper[last],
                accelerating: None,
            });
        }
        (self.low[last], self.high[last]) = (end, end);
        for sample in (0..last).rev() {
            let rows = problem.rows_of(sample);
            let (low, high) = (self.low[sample + 1], self.high[sample + 1]);
            let Some((low, high)) = before(rows, problem.upper[sample], low, high) else {
                return Err(blame::end(problem, sample, low, high));
            };
            (self.low[sample], self.high[sample]) = (low, high);
        }
        Ok(())
    }

    /// The smallest and largest `q` of each sample from which the rest of the path can be followed, as
    /// [`ReachPlanner::controllable`] found them.
    #[must_use]
    pub fn sets(&self) -> (&[f64], &[f64]) {
        (&self.low, &self.high)
    }

    /// The fastest plan by reachability analysis, put into `plan`; for problems as of [`ReachPlanner::controllable`].
    ///
    /// Rows are kept up to rounding: 1e-12 of a limit.
    ///
    /// # Errors
    /// Which limit cannot be kept, and where.
    pub fn solve_into(&mut self, problem: &Problem, plan: &mut Vec<f64>) -> Result<(), Infeasible> {
        self.controllable(problem)?;
        self.forward(problem, problem.ends.start, plan);
        Ok(())
    }

    /// The fastest plan from `q` through the sets that were found.
    pub(crate) fn forward(&self, problem: &Problem, mut q: f64, plan: &mut Vec<f64>) {
        plan.clear();
        plan.push(q);
        for sample in 0..problem.steps.len() {
            let (low, high) = (self.low[sample + 1], self.high[sample + 1]);
            q = step::highest_after(problem.rows_of(sample), q, low, high);
            plan.push(q);
        }
    }

    /// The plan nearest to `wish` that a forward pass can have: each `q` is moved into what the one before allows and
    /// the controllable set. So a solution that breaks limits by an iteration's tolerance is made to keep them.
    ///
    /// Wants the sets that [`ReachPlanner::controllable`] found.
    pub(crate) fn settle(&self, problem: &Problem, wish: &mut [f64]) {
        wish[0] = problem.ends.start;
        for sample in 0..problem.steps.len() {
            let rows = problem.rows_of(sample);
            let (low, high) = (self.low[sample + 1], self.high[sample + 1]);
            let most = step::highest_after(rows, wish[sample], low, high);
            let (least, _) = step::lowest_after(rows, wish[sample]);
            let wished = wish[sample + 1].max(least.max(low));
            wish[sample + 1] = wished.min(most);
        }
    }
}

/// The fastest plan of `problem` by reachability analysis: `q` at each sample.
///
/// # Errors
/// Which limit cannot be kept, and where.
pub fn solve(problem: &Problem) -> Result<Vec<f64>, Infeasible> {
    problem.check()?;
    let mut plan = Vec::with_capacity(problem.upper.len());
    ReachPlanner::default().solve_into(problem, &mut plan)?;
    Ok(plan)
}

/// The controllable set of a sample, from that of the next.
#[inline]
fn before(rows: &[LimitRow], upper: f64, low: f64, high: f64) -> Option<(f64, f64)> {
    let highest = step::highest_before(rows, upper, low, high)?;
    let lowest = step::lowest_before(rows, upper, low, high)?;
    // A single point may come out turned round by rounding.
    Some((lowest.min(highest), highest))
}
