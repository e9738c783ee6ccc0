//! Goes along both paths of an operation at once, never back.
//!
//! From a pair of places the walk goes on to the end of a step of one path or of both, whichever leaves the two nearest to
//! one another: along two straight pieces, gone along evenly, the distance is nowhere larger than at their ends, so what
//! is told is never below the Fréchet distance. Where the paths part it is looked for where they meet again; what stands
//! between on one side alone was left out or added, and if both go there, they are gone along by their lengths.

use std::collections::VecDeque;

use super::meet::{LOOK, meeting};
use super::outline::{OperationOutline, Pairs};
use super::steps::{PathPosition, PathStep, PathSteps};
use super::tally::{Difference, OperationTally, StepEnd};
use super::{DiffRules, PathPair, WhichProgram};
use crate::{BlockRunner, MotionKind};

/// Compares operation by operation.
pub(super) fn all<P: BlockRunner>(
    rules: &DiffRules,
    pairs: Pairs,
    mut old: PathSteps<P>,
    mut new: PathSteps<P>,
    listen: &mut dyn FnMut(&PathPair),
) -> Difference {
    // Two controls retract and approach each in its own way, one with the length in force and one without.
    let whole = rules.one_control;
    let lengths = pairs.lengths;
    let mut difference = Difference::new(pairs.unknown);
    for (index, [one, other]) in pairs.pairs.into_iter().enumerate() {
        let mut tally = OperationTally::new(rules, index, [one.as_ref(), other.as_ref()], listen);
        let there = |part: &Option<OperationOutline>| part.as_ref().map(|part| part.number);
        if let Some(number) = there(&one) {
            old.go_to(number);
        }
        if let Some(number) = there(&other) {
            new.go_to(number);
        }
        let mut walk = Walk {
            rules,
            tally: &mut tally,
            old: OperationPath::new(&mut old, one.is_some(), whole, lengths),
            new: OperationPath::new(&mut new, other.is_some(), whole, lengths),
            rest: 0,
        };
        walk.through();
        let sides = [walk.old.sums(), walk.new.sums()];
        difference.operations.push(tally.finish(sides));
    }
    difference.sum_up(rules);
    difference
}

/// One of the paths of an operation, and where on it the walk stands.
struct OperationPath<'a, P> {
    source: &'a mut PathSteps<P>,
    there: bool,
    /// All motions count.
    whole: bool,
    /// Both programs compensate lengths.
    lengths: bool,
    /// Share of the first step that is behind.
    share: f64,
    /// Steps were left out: how the tool comes to the next place is the machine's business.
    jumped: bool,
    events: Vec<super::steps::StepEvent>,
}

impl<'a, P: BlockRunner> OperationPath<'a, P> {
    fn new(source: &'a mut PathSteps<P>, there: bool, whole: bool, lengths: bool) -> Self {
        Self { source, there, whole, lengths, share: 0.0, jumped: false, events: Vec::new() }
    }

    /// It says something of this control alone: a position of the machine, or of a tool whose length is not in force.
    fn is_own(&self, step: &PathStep) -> bool {
        let bare = self.lengths && step.state.length == 0.0;
        step.machine || bare && step.kind == MotionKind::Rapid
    }

    /// Steps that are ready, as many as asked for or all of the operation. Between two controls what says something of one
    /// of them alone is left out.
    fn fill(&mut self, count: usize) {
        if !self.there {
            return;
        }
        if self.whole {
            self.source.fill(count);
            return;
        }
        loop {
            let known = self.source.steps.len();
            self.source.fill(count.max(known + 1));
            let fresh = self.source.steps.split_off(known);
            let mut jumped = self.jumped;
            for mut step in fresh {
                if self.is_own(&step) {
                    jumped = true;
                    continue;
                }
                if std::mem::take(&mut jumped) {
                    step.from = step.to;
                    step.length = 0.0;
                    step.arrives = true;
                }
                self.source.steps.push_back(step);
            }
            self.jumped = jumped;
            if self.source.steps.len() >= count || self.source.ended {
                return;
            }
        }
    }

    fn steps(&self) -> &VecDeque<PathStep> {
        &self.source.steps
    }

    fn front(&self) -> Option<&PathStep> {
        match self.there {
            true => self.source.steps.front(),
            false => None,
        }
    }

    /// Where the walk stands.
    fn here(&self) -> Option<PathPosition> {
        let step = self.front()?;
        Some(step.from.towards(&step.to, self.share))
    }

    /// On to a share of the first step.
    fn go(&mut self, share: f64) {
        self.share = share;
        if share >= 1.0 {
            self.source.steps.pop_front();
            self.share = 0.0;
        }
    }

    /// It has come where it arrives.
    fn drop_arrival(&mut self) {
        if self.front().is_some_and(|step| step.arrives) {
            self.go(1.0);
        }
    }

    /// Way that is left of the first `count` steps, mm.
    fn way(&self, count: usize) -> f64 {
        let all: f64 = self.steps().iter().take(count).map(|step| step.length).sum();
        let behind = self.front().map_or(0.0, |step| step.length * self.share);
        if count == 0 { 0.0 } else { all - behind }
    }

    fn sums(&mut self) -> (f64, Vec<super::steps::StepEvent>) {
        if !self.there {
            return (0.0, Vec::new());
        }
        self.events.append(&mut self.source.events);
        (self.source.minutes, std::mem::take(&mut self.events))
    }
}

struct Walk<'w, 't, 'a, P> {
    rules: &'w DiffRules,
    tally: &'w mut OperationTally<'t>,
    old: OperationPath<'a, P>,
    new: OperationPath<'a, P>,
    /// Steps before a meeting is looked for again.
    rest: usize,
}

impl<P: BlockRunner> Walk<'_, '_, '_, P> {
    fn through(&mut self) {
        loop {
            self.old.fill(2);
            self.new.fill(2);
            match (self.old.front().is_some(), self.new.front().is_some()) {
                (false, false) => return,
                (true, false) => self.alone(WhichProgram::Old, 1),
                (false, true) => self.alone(WhichProgram::New, 1),
                (true, true) if self.arrived() => {}
                (true, true) => self.together(),
            }
        }
    }

    /// One of the controls comes to a place by a way of its own: so does the other, by whatever rapids. True if steps were
    /// left behind by that.
    fn arrived(&mut self) -> bool {
        let arrives = |path: &OperationPath<'_, P>| path.front().is_some_and(|step| step.arrives);
        let (path, place) = match (arrives(&self.old), arrives(&self.new)) {
            (true, false) => (&mut self.new, self.old.front()),
            (false, true) => (&mut self.old, self.new.front()),
            _ => return false,
        };
        let Some(place) = place.map(|step| step.to) else {
            return false;
        };
        let Some(step) = path.front() else {
            return false;
        };
        let there = step.to.distance(&place) <= self.rules.apart;
        if !step.may_be_rapid() {
            return false;
        }
        path.go(1.0);
        if there {
            self.old.drop_arrival();
            self.new.drop_arrival();
        }
        true
    }

    /// Goes over steps of one path alone.
    fn alone(&mut self, of: WhichProgram, count: usize) {
        let path = match of {
            WhichProgram::Old => &mut self.old,
            WhichProgram::New => &mut self.new,
        };
        for _ in 0..count {
            let Some(step) = path.front() else {
                return;
            };
            self.tally.alone(of, step, path.share);
            path.go(1.0);
        }
    }

    /// Goes on along both, to the end of a step of one at least.
    fn together(&mut self) {
        let (Some(old), Some(new)) = (self.old.front(), self.new.front()) else {
            return;
        };
        let shares = next_places([old, new], [self.old.share, self.new.share]);
        let places = [old.from.towards(&old.to, shares[0]), new.from.towards(&new.to, shares[1])];
        self.rest = self.rest.saturating_sub(1);
        if self.rest == 0 && places[0].distance(&places[1]) > self.rules.apart {
            self.parted();
            return;
        }
        self.step(shares);
    }

    /// Goes to these shares of the first steps, and tells what is different there.
    fn step(&mut self, shares: [f64; 2]) {
        let (Some(old), Some(new)) = (self.old.front(), self.new.front()) else {
            return;
        };
        let place = |step: &PathStep, from: f64, to: f64| StepEnd {
            spot: step.from.towards(&step.to, to),
            way: step.length * (to - from),
        };
        let places = [place(old, self.old.share, shares[0]), place(new, self.new.share, shares[1])];
        self.tally.both([old, new], places);
        self.old.go(shares[0]);
        self.new.go(shares[1]);
    }

    /// The paths go different ways from here.
    fn parted(&mut self) {
        self.old.fill(LOOK);
        self.new.fill(LOOK);
        let (Some(old), Some(new)) = (self.old.here(), self.new.here()) else {
            return;
        };
        let near = self.rules.apart / 2.0;
        let met = meeting([&old, &new], self.old.steps(), self.new.steps(), near);
        match met {
            Some([0, new]) => self.alone(WhichProgram::New, new),
            Some([old, 0]) => self.alone(WhichProgram::Old, old),
            Some(counts) => self.around(counts),
            None => {
                let counts = [self.old.steps().len(), self.new.steps().len()];
                let whole = self.old.source.ended && self.new.source.ended;
                match whole && counts[0] < LOOK && counts[1] < LOOK {
                    true => self.around(counts),
                    // Somewhere else all along: gone along as it comes, and looked again later.
                    false => self.rest = LOOK / 2,
                }
            }
        }
    }

    /// Goes along so many steps of each, up to where they meet. Ways of the same kind and length are one that was moved;
    /// others have nothing in common but their ends.
    fn around(&mut self, counts: [usize; 2]) {
        let ways = [self.old.way(counts[0]), self.new.way(counts[1])];
        let longer = ways[0].max(ways[1]);
        let kinds = [kinds(self.old.steps(), counts[0]), kinds(self.new.steps(), counts[1])];
        let moved = kinds[0] == kinds[1]
            && libm::fabs(ways[0] - ways[1]) <= ALIKE * longer + self.rules.apart;
        if !moved {
            self.tally.part();
        }
        self.by_length(counts);
        if !moved {
            self.tally.met();
        }
    }

    /// Goes along so many steps of each, at equal shares of their ways.
    fn by_length(&mut self, [mut old, mut new]: [usize; 2]) {
        let ways = [self.old.way(old), self.new.way(new)].map(|way| way.max(1e-12));
        while old > 0 && new > 0 {
            let left = [self.old.way(1), self.new.way(1)];
            let shares = [left[0] / ways[0], left[1] / ways[1]];
            let least = shares[0].min(shares[1]);
            let ends = shares.map(|share| share - least <= 1e-12);
            let to = |path: &OperationPath<'_, P>, side: usize| match ends[side] {
                true => 1.0,
                false => {
                    let length = path.front().map_or(1.0, |step| step.length).max(1e-12);
                    (path.share + least * ways[side] / length).min(1.0)
                }
            };
            let shares = [to(&self.old, 0), to(&self.new, 1)];
            self.step(shares);
            old -= usize::from(shares[0] >= 1.0);
            new -= usize::from(shares[1] >= 1.0);
        }
        self.alone(WhichProgram::Old, old);
        self.alone(WhichProgram::New, new);
    }
}

/// Ways whose lengths differ by no more than this share may be one that was moved.
const ALIKE: f64 = 0.02;

/// The kinds of motion of so many steps, each where it begins.
fn kinds(steps: &VecDeque<PathStep>, count: usize) -> Vec<MotionKind> {
    let mut kinds: Vec<MotionKind> = steps
        .iter()
        .take(count)
        .map(|step| match step.fast {
            true => MotionKind::Rapid,
            false => step.kind,
        })
        .collect();
    kinds.dedup();
    kinds
}

/// The shares of two steps that are gone to next: one of them at least to its end, the two as near as can be.
fn next_places(steps: [&PathStep; 2], behind: [f64; 2]) -> [f64; 2] {
    let [old, new] = steps;
    let both = old.to.distance(&new.to);
    // Steps that stand still are over at once.
    if old.length <= 0.0 || new.length <= 0.0 {
        let over = |step: &PathStep, share: f64| if step.length <= 0.0 { 1.0 } else { share };
        return match old.length <= 0.0 && new.length <= 0.0 {
            true => [1.0, 1.0],
            false
                if both <= old.to.distance(&new.from) && old.length <= 0.0 && behind[1] == 0.0 =>
            {
                [1.0, 1.0]
            }
            false
                if both <= new.to.distance(&old.from) && new.length <= 0.0 && behind[0] == 0.0 =>
            {
                [1.0, 1.0]
            }
            false => [over(old, behind[0]), over(new, behind[1])],
        };
    }
    let on_new = nearest(new, behind[1], &old.to);
    let on_old = nearest(old, behind[0], &new.to);
    let old_ends = old.to.distance(&new.from.towards(&new.to, on_new));
    let new_ends = new.to.distance(&old.from.towards(&old.to, on_old));
    if both <= old_ends.min(new_ends) + 1e-9 {
        [1.0, 1.0]
    } else if old_ends <= new_ends {
        [1.0, on_new]
    } else {
        [on_old, 1.0]
    }
}

/// The share of a step from `behind` on that is nearest to a place.
fn nearest(step: &PathStep, behind: f64, place: &PathPosition) -> f64 {
    let way = step.to.pose.tip - step.from.pose.tip;
    let square = way.norm_squared();
    let share = match square > 0.0 {
        true => (place.pose.tip - step.from.pose.tip).dot(&way) / square,
        // It turns alone: by the share of the turn.
        false => {
            let whole = step.from.apart(&step.to)[1].max(1e-12);
            step.from.apart(place)[1] / whole
        }
    };
    share.clamp(behind, 1.0)
}
