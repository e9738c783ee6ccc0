//! Reachability analysis with bounded look-ahead: a path of any length in the memory of four look-aheads.
//!
//! A window's controllable sets are found as if the path ended at rest where the window ends. From every such set the
//! tool can stop within the window, and standing still keeps every row: so the speed that one window hands on lies in
//! the sets of the next, whatever follows, and **no limit is ever broken for want of look-ahead**; too short a
//! look-ahead costs speed alone. It costs nothing where the sets found from rest at the window's end and those found
//! from any speed there have met before the samples that are handed on: the true sets lie between the two. Then the
//! plan is that of the whole path, bit by bit, and [`Stream::all_certain`] says so.

use super::{Reach, step};
use crate::infeasible::Infeasible;
use crate::problem::{Ends, Problem};

/// Look-aheads that a window is long: all but one of them are handed on at once, so that the sets of few samples are
/// found twice.
const WINDOW: usize = 4;

/// Plans a path that comes in batches, and hands on `q` sample by sample as soon as the look-ahead allows.
///
/// ```
/// use post_feed::problem::{Problem, Row};
/// use post_feed::reach::Stream;
///
/// // |q[i + 1] - q[i]| <= 2 * 50 mm/s² * 0.5 mm, q <= (20 mm/s)².
/// let row = Row { here: -1.0 / 50.0, next: 1.0 / 50.0 };
/// let batch = Problem::from_rows(vec![0.5; 100], vec![400.0; 101], 1, vec![row; 100]);
/// let mut stream = Stream::new(1, 32);
/// let mut plan = Vec::new();
/// stream.push(&batch, &mut |q| plan.push(q))?;
/// stream.finish(0.0, &mut |q| plan.push(q))?;
/// assert_eq!(plan.len(), 101);
/// assert_eq!(plan[..4], [0.0, 50.0, 100.0, 150.0]);
/// assert!(stream.all_certain());
/// # Ok::<(), post_feed::Infeasible>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stream {
    lookahead: usize,
    /// The samples that are not handed on yet; begins with the speed that was reached.
    window: Problem,
    reach: Reach,
    done: usize,
    uncertain: usize,
}

impl Stream {
    /// A stream of problems with `stride` rows an interval, which looks ahead `lookahead` samples or more.
    #[must_use]
    pub fn new(stride: usize, lookahead: usize) -> Self {
        let lookahead = lookahead.max(1);
        let mut window = Problem::default();
        window.upper.reserve(WINDOW * lookahead + 1);
        window.rows.reserve(WINDOW * lookahead * stride);
        window.sources.resize(stride, Default::default());
        Self {
            lookahead,
            window,
            reach: Reach::default(),
            done: 0,
            uncertain: 0,
        }
    }

    /// Whether what was handed on so far is the plan of the whole path, whatever follows.
    #[must_use]
    pub fn all_certain(&self) -> bool {
        self.uncertain == 0
    }

    /// Samples handed on whose controllable set depended on what lies behind the look-ahead.
    #[must_use]
    pub fn uncertain(&self) -> usize {
        self.uncertain
    }

    /// Takes the next batch, whose first sample is the last of the batch before (its bound is the lower of the two),
    /// and hands on `q` of each sample that is settled, in order. `ends.start` counts in the first batch alone,
    /// `ends.end` nowhere: [`Stream::finish`] is told the end. A batch has passed [`Problem::check`], as those of
    /// [`Problem::new`] have.
    ///
    /// # Errors
    /// A start that is too fast; sample numbers count from the beginning of the path.
    ///
    /// # Panics
    /// If the batch has another number of rows an interval.
    pub fn push(&mut self, batch: &Problem, sink: &mut impl FnMut(f64)) -> Result<(), Infeasible> {
        let window = &mut self.window;
        assert_eq!(batch.stride(), window.stride(), "rows of an interval");
        if let Some(joint) = window.upper.last_mut() {
            if batch.upper[0] < *joint {
                *joint = batch.upper[0];
                let last = window.causes.len() - 1;
                window.causes[last] = batch.causes[0];
            }
        } else {
            window.names.clone_from(&batch.names);
            window.sources.clone_from(&batch.sources);
            window.ends.start = batch.ends.start;
            window.upper.push(batch.upper[0]);
            window.causes.push(batch.causes[0]);
        }
        for interval in 0..batch.steps.len() {
            if self.window.steps.len() >= WINDOW * self.lookahead {
                self.advance((WINDOW - 1) * self.lookahead, 0.0, sink)?;
            }
            let window = &mut self.window;
            window.steps.push(batch.steps[interval]);
            window.rows.extend_from_slice(batch.rows_of(interval));
            window.upper.push(batch.upper[interval + 1]);
            window.causes.push(batch.causes[interval + 1]);
        }
        Ok(())
    }

    /// Hands on the rest of the path, which ends with `end`; another path may follow then.
    ///
    /// # Errors
    /// A start that is too fast, an end that cannot be reached from where the look-ahead had left the plan.
    pub fn finish(&mut self, end: f64, sink: &mut impl FnMut(f64)) -> Result<(), Infeasible> {
        if self.window.upper.is_empty() {
            return Ok(());
        }
        self.advance(self.window.steps.len(), end, sink)?;
        sink(self.window.ends.start);
        self.window.upper.clear();
        self.window.causes.clear();
        self.done = 0;
        Ok(())
    }

    /// Plans the window as if it ended with `end`, hands on its first `count` samples and drops them.
    fn advance(
        &mut self,
        count: usize,
        end: f64,
        sink: &mut impl FnMut(f64),
    ) -> Result<(), Infeasible> {
        let window = &mut self.window;
        window.ends.end = end;
        let found = self.reach.controllable(window);
        found.map_err(|fault| fault.shifted(self.done))?;
        let (_, high) = self.reach.sets();
        let last = window.steps.len();
        if count < last {
            // How far back from the window's end it matters with which speed the path goes on there.
            let mut free = window.upper[last];
            let mut met = last;
            while met > 0 && free != high[met] {
                met -= 1;
                let rows = window.rows_of(met);
                free = step::highest_before(rows, window.upper[met], 0.0, free).unwrap_or(f64::NAN);
            }
            self.uncertain += count.saturating_sub(met);
        }
        let mut q = window.ends.start;
        for (sample, &high) in high[1..=count].iter().enumerate() {
            sink(q);
            let low = self.reach.low[sample + 1];
            q = step::highest_after(window.rows_of(sample), q, low, high);
        }
        window.ends = Ends { start: q, end };
        let stride = window.stride();
        window.upper.drain(..count);
        window.causes.drain(..count);
        window.steps.drain(..count);
        window.rows.drain(..count * stride);
        self.done += count;
        Ok(())
    }
}
