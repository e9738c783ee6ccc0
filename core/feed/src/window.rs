//! What of a path that comes in batches is not handed on yet.

use crate::infeasible::Infeasible;
use crate::problem::{LimitSource, Problem};

/// The samples that wait, as one problem.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleWindow {
    pub(crate) problem: Problem,
    /// Samples before it that were handed on.
    pub(crate) done: usize,
}

/// Where a batch begins in a window, and how its names are numbered there.
pub(crate) struct BatchJoint {
    steps: usize,
    /// The bound before, if another batch is before.
    bound: Option<(f64, LimitSource)>,
    /// The number that each name has in the window; none where they are the same.
    numbers: Vec<u16>,
}

impl BatchJoint {
    /// The number of the batch's limit in the window.
    pub(crate) fn limit(&self, limit: u16) -> u16 {
        let number = self.numbers.get(usize::from(limit));
        number.copied().unwrap_or(limit)
    }

    fn named(&self, source: LimitSource) -> LimitSource {
        LimitSource { limit: self.limit(source.limit), ..source }
    }
}

impl SampleWindow {
    /// Begins with a batch: its first sample is the last of the window, and the lower bound counts.
    pub(crate) fn begin(&mut self, batch: &Problem) -> Result<BatchJoint, Infeasible> {
        batch.check()?;
        let numbers = self.numbers(batch)?;
        let problem = &mut self.problem;
        let last = problem.upper.last().copied();
        let joint = BatchJoint {
            steps: problem.steps.len(),
            bound: last.zip(problem.causes.last().copied()),
            numbers,
        };
        let (bound, cause) = (batch.upper[0], joint.named(batch.causes[0]));
        match joint.bound {
            None => {
                problem.ends.start = batch.ends.start;
                problem.upper.push(bound);
                problem.causes.push(cause);
            }
            Some((before, _)) if bound < before => {
                problem.upper[joint.steps] = bound;
                problem.causes[joint.steps] = cause;
            }
            Some(_) => {}
        }
        Ok(joint)
    }

    /// Appends an interval of the batch and the sample after it.
    pub(crate) fn append(&mut self, batch: &Problem, interval: usize, joint: &BatchJoint) {
        let problem = &mut self.problem;
        problem.steps.push(batch.steps[interval]);
        problem.rows.extend_from_slice(batch.rows_of(interval));
        problem.upper.push(batch.upper[interval + 1]);
        let cause = joint.named(batch.causes[interval + 1]);
        problem.causes.push(cause);
    }

    /// Takes a batch out again of which nothing was handed on, nor of what was before it since.
    pub(crate) fn withdraw(&mut self, joint: &BatchJoint) {
        let problem = &mut self.problem;
        let stride = problem.stride();
        problem.steps.truncate(joint.steps);
        problem.rows.truncate(joint.steps * stride);
        let samples = joint.bound.map_or(0, |_| joint.steps + 1);
        problem.upper.truncate(samples);
        problem.causes.truncate(samples);
        if let Some((bound, cause)) = joint.bound {
            problem.upper[joint.steps] = bound;
            problem.causes[joint.steps] = cause;
        }
    }

    /// Drops the first samples, which were handed on.
    pub(crate) fn drop_first(&mut self, count: usize) {
        let problem = &mut self.problem;
        let stride = problem.stride();
        problem.upper.drain(..count);
        problem.causes.drain(..count);
        problem.steps.drain(..count);
        problem.rows.drain(..count * stride);
        self.done += count;
    }

    /// Forgets the path, and keeps names and memory.
    pub(crate) fn clear(&mut self) {
        let problem = &mut self.problem;
        problem.upper.clear();
        problem.causes.clear();
        problem.steps.clear();
        problem.rows.clear();
        self.done = 0;
    }

    /// The number that each name of a batch has here; none where they are the same.
    fn numbers(&mut self, batch: &Problem) -> Result<Vec<u16>, Infeasible> {
        let problem = &mut self.problem;
        if problem.names.is_empty() {
            problem.names.clone_from(&batch.names);
            problem.sources.clone_from(&batch.sources);
        }
        let mut numbers = Vec::new();
        if batch.names != problem.names {
            numbers.extend(batch.names.iter().map(|name| problem.number_of(name)));
        }
        let same = |(ours, theirs): (&LimitSource, &LimitSource)| {
            let limit = numbers.get(usize::from(theirs.limit));
            ours.axis == theirs.axis && ours.limit == *limit.unwrap_or(&theirs.limit)
        };
        let rows = problem.sources.iter().zip(&batch.sources);
        if batch.stride() == problem.stride() && rows.clone().all(same) {
            Ok(numbers)
        } else {
            Err(Infeasible::Shape)
        }
    }
}
