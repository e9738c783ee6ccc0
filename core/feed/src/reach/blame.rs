//! Which limit leaves no plan, and where: found by going on from an end as slowly as can be.

use super::step;
use crate::infeasible::Infeasible;
use crate::problem::{LimitRow, LimitSource, Problem};

/// A limit that is broken on the slowest way on from an end.
struct Broken {
    sample: usize,
    source: LimitSource,
    needed: f64,
    allowed: f64,
    /// The row that lets it not be slower.
    by: Option<LimitSource>,
}

/// The start is above what the path allows.
pub(super) fn start(problem: &Problem) -> Infeasible {
    let Some(broken) = slowest(problem, false) else {
        let start = problem.ends.start;
        return contradiction(problem, 0, start, start);
    };
    Infeasible::TooFastStart {
        sample: broken.sample,
        source: broken.source,
        needed: broken.needed,
        allowed: broken.allowed,
        braking: broken.by,
    }
}

/// The end cannot be reached, as was found when no `q` of `sample` was left for `low..=high` at the next.
pub(super) fn end(problem: &Problem, sample: usize, low: f64, high: f64) -> Infeasible {
    let Some(broken) = slowest(problem, true) else {
        return contradiction(problem, sample, low, high);
    };
    Infeasible::OutOfReach {
        sample: broken.sample,
        source: broken.source,
        needed: broken.needed,
        allowed: broken.allowed,
        accelerating: broken.by,
    }
}

/// Goes on with the hardest braking from the start, or `back` from the end with the hardest acceleration read
/// backwards, until a limit is broken.
fn slowest(problem: &Problem, back: bool) -> Option<Broken> {
    let last = problem.steps.len();
    let place = |index: usize| if back { last - index } else { index };
    let [mut q, goal] = if back {
        [problem.ends.end, problem.ends.start]
    } else {
        [problem.ends.start, problem.ends.end]
    };
    let mut by: Option<LimitSource> = None;
    let mut rows = Vec::new();
    for index in 0..=last {
        let sample = place(index);
        let (mut allowed, mut source) = (problem.upper[sample], problem.causes[sample]);
        if index == last && goal < allowed {
            // The other end is given: what lets it not be slower is to blame.
            (allowed, source) = (goal, by.unwrap_or(source));
        }
        rows.clear();
        if index < last {
            let interval = if back { sample - 1 } else { sample };
            let turned = |row: &LimitRow| LimitRow { here: row.next, next: row.here };
            let all = problem.rows_of(interval).iter();
            rows.extend(all.map(|row| if back { turned(row) } else { *row }));
            // Rows may forbid it whatever follows.
            let most = step::highest_before(&rows, allowed, 0.0, f64::INFINITY).unwrap_or(0.0);
            if most < allowed && q > most {
                let least = step::lowest_after(&rows, q).1;
                let row = least.unwrap_or_else(|| largest(&rows, q));
                (allowed, source) = (most, problem.sources[row]);
            }
        }
        if q > allowed * (1.0 + 1e-12) {
            return Some(Broken { sample, source, needed: q, allowed, by });
        }
        let (least, row) = step::lowest_after(&rows, q);
        q = least;
        by = row.map(|row| problem.sources[row]);
    }
    None
}

/// The row that `q` alone uses most of.
fn largest(rows: &[LimitRow], q: f64) -> usize {
    let use_of = |row: &LimitRow| row.value(q, 0.0).abs();
    let each = rows.iter().enumerate();
    let most = each.max_by(|(_, a), (_, b)| use_of(a).total_cmp(&use_of(b)));
    most.map_or(0, |(index, _)| index)
}

/// Names the row of an interval that is farthest from being kept, whatever `q` of the first sample and of `low..=high`
/// at the second: limits that are not monotone may leave nothing between each other.
fn contradiction(problem: &Problem, sample: usize, low: f64, high: f64) -> Infeasible {
    let least = |row: &LimitRow| {
        let corners = [(0.0, low), (0.0, high), (1.0, low), (1.0, high)];
        let values = corners.map(|(x, y)| row.value(x * problem.upper[sample], y));
        let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
        let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        lowest.max(-highest)
    };
    let rows = problem.rows_of(sample).iter().zip(&problem.sources);
    let worst = rows.max_by(|(a, _), (b, _)| least(a).total_cmp(&least(b)));
    Infeasible::Contradiction {
        sample,
        source: worst.map_or(problem.causes[sample], |(_, source)| *source),
    }
}
