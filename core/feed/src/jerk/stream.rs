//! Plans with jerk limits for a path of any length, in the memory of four look-aheads.
//!
//! A window is planned as if the path ended at rest where the window ends; all but its last look-ahead is handed on, and
//! the next window goes on from there with speed and acceleration. The rest of the window's plan is kept: it is a way to
//! a stop that keeps every limit. Should the next window not find its plan from the state that it was left with, that
//! way is followed farther, at worst to the stop, from where there always is a plan. So **no limit is ever broken for
//! want of look-ahead**; too short a look-ahead costs speed alone.

use super::rounds::{NonstopSection, PlanWork, ROOM, SectionPlan};
use super::spline::StartState;
use super::stop_plan::StopPlan;
use super::{IntervalLaw, JerkSettings, of_limits};
use crate::infeasible::Infeasible;
use crate::limits::{Channel, Limit};
use crate::problem::{LimitSource, LimitUsage, Problem};
use crate::reach::ReachPlanner;
use crate::samples::Samples;
use crate::window::SampleWindow;

/// Look-aheads that a window is long.
const WINDOW: usize = 4;

/// Intervals that a plan needs between two stops: as many are left after the stop at a window's end.
const RESERVE: usize = 4;

/// A part of a path.
#[derive(Clone, Copy)]
pub struct PathBatch<'a> {
    /// Samples of the part; the first is the last of the batch before, with the derivatives after it.
    pub samples: &'a Samples,
    /// What it keeps.
    pub limits: &'a [&'a dyn Limit],
    /// Made of both, with [`crate::limits::Collocation::Throughout`]; bounds may be lowered.
    pub problem: &'a Problem,
    /// Whether derivatives jump where it begins, so that no acceleration along the path can be kept there.
    pub corner: bool,
}

/// An interval whose feed is settled.
#[derive(Clone, Copy, Debug)]
pub struct SettledInterval<'a> {
    /// The number of its first sample, counted from the beginning of the path.
    pub sample: usize,
    /// Length of the interval, in units of the parameter.
    pub step: f64,
    /// `q` over it.
    pub piece: IntervalLaw,
    bounds: [(f64, LimitSource); 2],
    channels: &'a [(u16, Channel)],
}

impl SettledInterval<'_> {
    /// The limit that is used most at its ends and halfway. It is found when it is asked for.
    #[must_use]
    pub fn active(&self) -> LimitUsage {
        let mut usage = LimitUsage::default();
        for (share, (bound, source)) in [0.0, 1.0].into_iter().zip(self.bounds) {
            if bound > 0.0 {
                usage.raise(self.piece.at(share, self.step)[0] / bound, self.sample, source);
            }
        }
        // At rest itself the parameter's third derivative is a product of 0 and infinity.
        for share in [1e-9, 0.5, 1.0 - 1e-9] {
            let q = self.piece.at(share, self.step);
            for &(limit, channel) in self.channels {
                let axis = channel.axis;
                let used = channel.used(share, self.step, q).abs();
                usage.raise(used, self.sample, LimitSource { limit, axis });
            }
        }
        usage
    }
}

/// Plans a path that comes in batches under jerk limits, and hands on its feed interval by interval as soon as the
/// look-ahead allows.
///
/// **The look-ahead** should hold the way to a stop from the highest feed.
///
/// **Corners.** At a corner between two batches the speed is one, at most the lower bound of the two, and the
/// acceleration along the path is 0: what the axes have before it and after it is then bounded by the rows of both
/// sides. The speed there is an unknown as any other, so a corner never makes a path infeasible.
///
/// **Short pieces.** Between two stops there must be four intervals, between a stop and a corner two; between two
/// corners the speed can change from three on.
#[derive(Clone, Debug)]
pub struct JerkStream {
    lookahead: usize,
    settings: JerkSettings,
    window: SampleWindow,
    /// Channels of the intervals that wait, each with the number of its limit, and where those of each begin.
    channels: Vec<(u16, Channel)>,
    offsets: Vec<usize>,
    /// Whether each sample that waits is a corner.
    corners: Vec<bool>,
    state: StartState,
    /// The way to a stop that goes on from the state; empty at rest.
    ahead: StopPlan,
    reach: ReachPlanner,
    fast: Vec<f64>,
    work: PlanWork,
    retries: usize,
}

impl JerkStream {
    /// A stream that looks ahead `lookahead` samples or more, at least four.
    #[must_use]
    pub fn new(lookahead: usize, settings: JerkSettings) -> Self {
        Self {
            lookahead: lookahead.max(RESERVE),
            settings,
            window: SampleWindow::default(),
            channels: Vec::new(),
            offsets: vec![0],
            corners: Vec::new(),
            state: StartState::default(),
            ahead: StopPlan::default(),
            reach: ReachPlanner::default(),
            fast: Vec::new(),
            work: PlanWork::default(),
            retries: 0,
        }
    }

    /// Samples that are not handed on yet: never more than four look-aheads and five.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.window.problem.upper.len()
    }

    /// Rounds of the convex-concave procedure so far, and iterations of the interior-point method in all of them.
    #[must_use]
    pub fn work(&self) -> [usize; 2] {
        [self.work.rounds, self.work.iterations]
    }

    /// How often a window found no plan from the state that it was left with, so that the one before was followed
    /// farther.
    #[must_use]
    pub fn retries(&self) -> usize {
        self.retries
    }

    /// The name of where a limit comes from, as reports print it.
    #[must_use]
    pub fn name(&self, source: LimitSource) -> String {
        self.window.problem.name(source)
    }

    /// Takes the next batch and hands on the intervals that are settled, in order. `problem.ends.start` counts in the
    /// first batch alone, with no acceleration; `ends.end` nowhere: [`JerkStream::finish`] is told the end.
    ///
    /// # Errors
    /// As [`Problem::check`], with the samples of the batch, and [`Infeasible::Shape`] where it is not of one path with
    /// those before: the batch is not taken, another may follow in its place. As [`super::solve`], with samples counted
    /// from the beginning of the path, where a stretch cannot be planned from rest or from the start: the batch is not
    /// taken if nothing was handed on since; [`JerkStream::clear`] begins anew.
    pub fn push(
        &mut self,
        batch: PathBatch<'_>,
        sink: &mut impl FnMut(SettledInterval<'_>),
    ) -> Result<(), Infeasible> {
        let problem = batch.problem;
        if problem.upper.len() != batch.samples.len() {
            return Err(Infeasible::Shape);
        }
        let begins = self.window.problem.upper.is_empty();
        let joint = self.window.begin(problem)?;
        if begins {
            self.state = StartState::even(problem.ends.start);
            self.corners.push(false);
        }
        let (done, first) = (self.window.done, self.corners.len() - 1);
        let smooth = self.corners[first];
        self.corners[first] |= batch.corner && !begins;
        for interval in 0..problem.steps.len() {
            while self.window.problem.steps.len() >= WINDOW * self.lookahead + RESERVE {
                if let Err(fault) = self.advance(sink) {
                    if self.window.done == done {
                        self.window.withdraw(&joint);
                        self.offsets.truncate(first + 1);
                        self.channels.truncate(self.offsets[first]);
                        self.corners.truncate(if begins { 0 } else { first + 1 });
                        if let Some(corner) = self.corners.get_mut(first) {
                            *corner = smooth;
                        }
                    }
                    return Err(fault);
                }
            }
            self.window.append(problem, interval, &joint);
            let channels = &mut self.channels;
            of_limits(batch.samples, batch.limits, interval, &mut |limit, channel| {
                channels.push((joint.limit(limit), channel));
            });
            self.offsets.push(self.channels.len());
            self.corners.push(false);
        }
        Ok(())
    }

    /// Hands on the rest of the path, which ends with `end` and no acceleration; another path may follow then.
    ///
    /// # Errors
    /// As [`super::solve`], where the rest cannot be planned from rest, or not to this end. Part of it may have been
    /// handed on, up to a stop; it may be finished with another end, or [`JerkStream::clear`] begins anew.
    pub fn finish(
        &mut self,
        end: f64,
        sink: &mut impl FnMut(SettledInterval<'_>),
    ) -> Result<(), Infeasible> {
        if !(end >= 0.0 && end.is_finite()) {
            return Err(Infeasible::Shape);
        }
        while !self.window.problem.steps.is_empty() {
            let last = self.window.problem.steps.len();
            match self.stop().filter(|&stop| stop < last) {
                Some(stop) => self.settle(stop, 0.0, stop, sink)?,
                None => self.settle(last, end, last, sink)?,
            }
        }
        self.clear();
        Ok(())
    }

    /// Forgets what was not handed on: the next batch begins another path.
    pub fn clear(&mut self) {
        self.window.clear();
        self.channels.clear();
        self.offsets.truncate(1);
        self.corners.clear();
        self.state = StartState::default();
        self.ahead = StopPlan::default();
    }

    /// The first stop ahead.
    fn stop(&self) -> Option<usize> {
        let ahead = self.window.problem.upper.iter().skip(1);
        Some(1 + ahead.into_iter().position(|&upper| upper == 0.0)?)
    }

    /// Hands on part of a full window.
    fn advance(&mut self, sink: &mut impl FnMut(SettledInterval<'_>)) -> Result<(), Infeasible> {
        if let Some(stop) = self.stop() {
            return self.settle(stop, 0.0, stop, sink);
        }
        // A stop that does not belong to the path must not have a corner next to it.
        let corner = |at: usize| self.corners[at - 1] || self.corners[at + 1];
        let mut last = self.window.problem.steps.len() - RESERVE;
        while last > 1 && corner(last) {
            last -= 1;
        }
        self.settle(last, 0.0, last.min((WINDOW - 1) * self.lookahead), sink)
    }

    /// Plans the window's first `last` intervals with `end` after them, and hands `count` of them on; or, if there is
    /// no plan, the next part of the plan before.
    fn settle(
        &mut self,
        last: usize,
        end: f64,
        count: usize,
        sink: &mut impl FnMut(SettledInterval<'_>),
    ) -> Result<(), Infeasible> {
        match self.plan(last, end) {
            Ok(planned) => {
                self.ahead = StopPlan::new(planned);
                self.hand_on(count, sink);
                if count == last {
                    self.state = StartState::even(end);
                }
            }
            Err(fault) => {
                if self.ahead.len() == 0 {
                    return Err(fault.shifted(self.window.done));
                }
                self.retries += 1;
                self.hand_on(self.ahead.next_part(), sink);
            }
        }
        Ok(())
    }

    /// Hands on the first intervals of the plan ahead.
    fn hand_on(&mut self, count: usize, sink: &mut impl FnMut(SettledInterval<'_>)) {
        let Problem { steps, upper, causes, .. } = &self.window.problem;
        for (place, &piece) in self.ahead.law.pieces[..count].iter().enumerate() {
            sink(SettledInterval {
                sample: self.window.done + place,
                step: steps[place],
                piece,
                bounds: [place, place + 1].map(|at| (upper[at], causes[at])),
                channels: &self.channels[self.offsets[place]..self.offsets[place + 1]],
            });
        }
        self.ahead.drop_first(count);
        self.state = self.ahead.state();
        self.window.drop_first(count);
        let first = self.offsets[count];
        self.channels.drain(..first);
        self.offsets.drain(..count);
        self.offsets.iter_mut().for_each(|offset| *offset -= first);
        self.corners.drain(..count);
    }

    /// Plans the window's first `last` intervals from the state.
    fn plan(&mut self, last: usize, end: f64) -> Result<SectionPlan, Infeasible> {
        let mut part = self.window.problem.part(0, last);
        part.ends.end = end;
        self.reach.backward(&part)?;
        let most = self.reach.sets().1[0];
        let mut fast = std::mem::take(&mut self.fast);
        self.reach.forward(&part, self.state.q.min(most), &mut fast);
        let mut work = self.work;
        let stretch = NonstopSection {
            channels: &|interval, sink| {
                let channels = self.offsets[interval]..self.offsets[interval + 1];
                for &(limit, channel) in &self.channels[channels] {
                    sink(limit, channel);
                }
            },
            steps: &part.steps,
            upper: &part.upper,
            causes: &part.causes,
            fast: &fast,
            corners: &self.corners[..=last],
            start: self.state,
            end,
            room: ROOM,
        };
        let mut plan = |tangents: Option<&[f64]>| stretch.plan(self.settings, tangents, &mut work);
        let planned = if self.ahead.len() == 0 {
            plan(None)
        } else {
            let middles = stretch.middles();
            let guess = plan(Some(&self.ahead.guess(&middles)));
            guess.or_else(|_| plan(Some(&self.ahead.known(&middles))))
        };
        self.work = work;
        self.fast = fast;
        planned
    }
}
