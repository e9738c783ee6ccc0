//! Reachability analysis with bounded look-ahead: a path of any length in the memory of four look-aheads.
//!
//! A window's controllable sets are found as if the path ended at rest where the window ends. From every such set the
//! tool can stop within the window, and standing still keeps every row: so the speed that one window hands on lies in
//! the sets of the next, whatever follows, and **no limit is ever broken for want of look-ahead**; too short a
//! look-ahead costs speed alone. It costs nothing where the sets found from rest at the window's end and those found
//! from any speed there have met before the samples that are handed on: the true sets lie between the two. Then the
//! plan is that of the whole path, bit by bit, and [`ReachStream::all_certain`] says so.

use super::{ReachPlanner, step};
use crate::infeasible::Infeasible;
use crate::problem::{EndSpeeds, LimitSource, LimitUsage, Problem};
use crate::window::SampleWindow;

/// Look-aheads that a window is long: all but one of them are handed on at once, so that the sets of few samples are
/// found twice.
const WINDOW: usize = 4;

/// A sample whose speed is settled.
#[derive(Clone, Copy, Debug)]
pub struct Settled<'a> {
    /// Number of the sample, counted from the beginning of the path.
    pub sample: usize,
    /// The squared speed of the parameter there, `(ds/dt)²`.
    pub q: f64,
    window: &'a Problem,
    /// Number of the sample in the window.
    place: usize,
    /// `q` of the samples before and after, where they are in the window.
    neighbours: [Option<f64>; 2],
    /// What the interval before the window used most.
    arrived: LimitUsage,
}

impl Settled<'_> {
    /// The limit that is used most here: the sample's bound, and the rows of both intervals that it ends. It is found
    /// when it is asked for, and costs what reading the rows of two intervals costs.
    #[must_use]
    pub fn active(&self) -> LimitUsage {
        let [before, behind] = self.neighbours;
        let mut usage = self.window.used(self.place, self.q, before, behind);
        if self.place == 0 {
            usage.raise(self.arrived.share, self.sample, self.arrived.source);
        }
        LimitUsage { sample: self.sample, ..usage }
    }
}

/// Plans a path that comes in batches, and hands on `q` sample by sample as soon as the look-ahead allows.
///
/// **Corners.** Batches may meet at a corner: the first ends with the derivatives before it, the next begins at the same
/// sample with those after it, so that each interval's rows are of one side. The speed there is one, and its bound the
/// lower of the two batches'; what a corner itself allows the caller puts into one of them by [`Problem::lower`].
///
/// **Faults.** A batch that is refused leaves nothing in the stream: another may take its place.
///
/// ```
/// use post_feed::problem::{Problem, LimitRow};
/// use post_feed::reach::ReachStream;
///
/// // |q[i + 1] - q[i]| <= 2 * 50 mm/s² * 0.5 mm, q <= (20 mm/s)².
/// let row = LimitRow { here: -1.0 / 50.0, next: 1.0 / 50.0 };
/// let batch = Problem::from_rows(vec![0.5; 100], vec![400.0; 101], 1, vec![row; 100]);
/// let mut stream = ReachStream::new(1, 32);
/// let mut plan = Vec::new();
/// stream.push(&batch, &mut |sample| plan.push(sample.q))?;
/// stream.finish(0.0, &mut |sample| plan.push(sample.q))?;
/// assert_eq!(plan.len(), 101);
/// assert_eq!(plan[..4], [0.0, 50.0, 100.0, 150.0]);
/// assert!(stream.all_certain());
/// # Ok::<(), post_feed::Infeasible>(())
/// ```
#[derive(Clone, Debug)]
pub struct ReachStream {
    stride: usize,
    lookahead: usize,
    /// The samples that are not handed on yet; begins with the speed that was reached.
    window: SampleWindow,
    reach: ReachPlanner,
    arrived: LimitUsage,
    uncertain: usize,
}

impl ReachStream {
    /// A stream of problems with `stride` rows an interval, which looks ahead `lookahead` samples or more.
    #[must_use]
    pub fn new(stride: usize, lookahead: usize) -> Self {
        let lookahead = lookahead.max(1);
        let mut window = SampleWindow::default();
        window.problem.upper.reserve(WINDOW * lookahead + 1);
        window.problem.rows.reserve(WINDOW * lookahead * stride);
        Self {
            stride,
            lookahead,
            window,
            reach: ReachPlanner::default(),
            arrived: LimitUsage::default(),
            uncertain: 0,
        }
    }

    /// Whether what was handed on so far is the plan of the whole path, whatever follows.
    #[must_use]
    pub fn all_certain(&self) -> bool {
        self.uncertain == 0
    }

    /// Samples handed on whose controllable set depended on what lies after the look-ahead.
    #[must_use]
    pub fn uncertain(&self) -> usize {
        self.uncertain
    }

    /// Samples that are not handed on yet: never more than four look-aheads and one.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.window.problem.upper.len()
    }

    /// Takes the next batch, whose first sample is the last of the batch before (its bound is the lower of the two),
    /// and hands on each sample that is settled, in order. `ends.start` counts in the first batch alone, `ends.end`
    /// nowhere: [`ReachStream::finish`] is told the end.
    ///
    /// # Errors
    /// As [`Problem::check`], with the samples of the batch, and [`Infeasible::Shape`] where it has other rows an
    /// interval than the first: the batch is not taken, another may follow in its place. A start that is too fast for what
    /// lies ahead, with samples counted from the beginning of the path: nothing of the path was handed on, and the
    /// batch is not taken; [`ReachStream::clear`] begins anew.
    pub fn push(
        &mut self,
        batch: &Problem,
        sink: &mut impl FnMut(Settled<'_>),
    ) -> Result<(), Infeasible> {
        if batch.stride() != self.stride {
            return Err(Infeasible::Shape);
        }
        let joint = self.window.begin(batch)?;
        let done = self.window.done;
        for interval in 0..batch.steps.len() {
            if self.window.problem.steps.len() >= WINDOW * self.lookahead
                && let Err(fault) = self.advance((WINDOW - 1) * self.lookahead, 0.0, sink)
            {
                if self.window.done == done {
                    self.window.withdraw(&joint);
                }
                return Err(fault);
            }
            self.window.append(batch, interval, &joint);
        }
        Ok(())
    }

    /// Hands on the rest of the path, which ends with `end`; another path may follow then.
    ///
    /// # Errors
    /// A start that is too fast, an end that cannot be reached from where the look-ahead had left the plan. Nothing is
    /// handed on then, and the path may go on, or be finished with another end: at rest it always can be, if its start
    /// is not too fast.
    pub fn finish(
        &mut self,
        end: f64,
        sink: &mut impl FnMut(Settled<'_>),
    ) -> Result<(), Infeasible> {
        if self.window.problem.upper.is_empty() {
            return Ok(());
        }
        if !(end >= 0.0 && end.is_finite()) {
            return Err(Infeasible::Shape);
        }
        self.advance(self.window.problem.steps.len(), end, sink)?;
        sink(Settled {
            sample: self.window.done,
            q: self.window.problem.ends.start,
            window: &self.window.problem,
            place: 0,
            neighbours: [None, None],
            arrived: self.arrived,
        });
        self.clear();
        Ok(())
    }

    /// Forgets what was not handed on: the next batch begins another path.
    pub fn clear(&mut self) {
        self.window.clear();
        self.arrived = LimitUsage::default();
    }

    /// The name of where a bound or row comes from, as reports print it. Batches may have lowered bounds for different
    /// reasons: the stream numbers all their names.
    #[must_use]
    pub fn name(&self, source: LimitSource) -> String {
        self.window.problem.name(source)
    }

    /// Plans the window as if it ended with `end`, hands on its first `count` samples and drops them.
    fn advance(
        &mut self,
        count: usize,
        end: f64,
        sink: &mut impl FnMut(Settled<'_>),
    ) -> Result<(), Infeasible> {
        let done = self.window.done;
        let window = &mut self.window.problem;
        window.ends.end = end;
        let found = self.reach.controllable(window);
        found.map_err(|fault| fault.shifted(done))?;
        let (low, high) = self.reach.sets();
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
        let mut before = None;
        let mut q = window.ends.start;
        for place in 0..count {
            let behind =
                step::highest_after(window.rows_of(place), q, low[place + 1], high[place + 1]);
            sink(Settled {
                sample: done + place,
                q,
                window,
                place,
                neighbours: [before, Some(behind)],
                arrived: self.arrived,
            });
            before = Some(q);
            q = behind;
        }
        if let Some(before) = before {
            self.arrived = window.used_between(count - 1, before, q);
        }
        window.ends = EndSpeeds { start: q, end };
        self.window.drop_first(count);
        Ok(())
    }
}
