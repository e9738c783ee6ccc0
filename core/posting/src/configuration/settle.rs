//! Settling: the cheapest way through the trellis is walked back, eased close to poles, and handed out.

use super::backtrace::Backtrace;
use super::cost::PathCost;
use super::route::{ChosenPoint, Route};
use super::trellis::{HELD, Trellis, TrellisState};
use post_machine::description::Pole;
use post_machine::kinematics::Joints;
use post_machine::kinematics::POLE;

/// Values that differ by less are the same, radians.
pub(super) const SAME: f64 = 1e-9;

impl Route<'_> {
    /// Settles all points.
    pub(crate) fn settle_all(&mut self) {
        let last = self.trellis.layers.len().saturating_sub(1);
        self.settle(last);
    }

    /// Settles what is decided: everything where one state is left, else the older half of a full window.
    #[inline]
    pub(super) fn advance(&mut self) {
        let layers = &self.trellis.layers;
        let Some(layer) = layers.last() else {
            return;
        };
        let waiting = layers.len() - usize::from(self.anchored);
        let look_ahead = self.look_ahead();
        // The pass of an arm may be begun anew: one way that is left may be the wrong one.
        let begun_anew = self.tries_positions || self.present().solver().spins();
        if layer.count == 1 && !self.trellis.eased(layer.latitude.0) && !begun_anew {
            if self.anchored && layers.len() == 2 {
                self.settle_only();
            } else {
                self.settle_all();
            }
        } else if waiting >= look_ahead {
            let last = layers.len() - 1;
            self.settle(if self.mark > 0 { self.mark } else { last });
            self.set_mark();
        } else if self.mark == 0 && 2 * waiting >= look_ahead {
            self.set_mark();
        }
    }

    /// Settles the only point that waits, which has one state.
    #[inline]
    fn settle_only(&mut self) {
        let trellis = &mut self.trellis;
        let at = &trellis.layers[1];
        let (before, state) = (trellis.states[at.first].from, trellis.states[at.first]);
        let before = trellis.states[before];
        if before.rewind.is_some() || state.rewind.is_some() {
            self.settle_all();
            return;
        }
        self.chosen.push(ChosenPoint {
            line: at.line,
            motion: at.motion,
            setting: at.setting,
            arrives: true,
            joints: state.joints,
            rewind: None,
            changed: trellis
                .has_changed((before.branch, &before.joints), (state.branch, &state.joints)),
            eased: false,
        });
        trellis.layers.swap_remove(0);
        trellis.layers[0].first = 0;
        trellis.states.clear();
        trellis.states.push(TrellisState { cost: PathCost::NONE, from: 0, root: 0, ..state });
        self.mark = 0;
    }

    /// Marks the newest layer: from here on every state knows from which of its states it comes.
    fn set_mark(&mut self) {
        let last = self.trellis.layers.len() - 1;
        self.mark = last;
        let layer = &self.trellis.layers[last];
        for index in layer.first..layer.first + layer.count {
            self.trellis.states[index].root = index;
        }
    }

    /// Settles the points up to `upto`; the best way to the newest point decides.
    fn settle(&mut self, upto: usize) {
        let count = self.trellis.layers.len();
        if count <= usize::from(self.anchored) {
            return;
        }
        let mut way = std::mem::take(&mut self.way);
        let Some(mut best) = self.walk_back(&mut way) else {
            self.way = way;
            return;
        };
        self.ease(&mut way);
        let mut upto = upto;
        if !self.comes_through(&way, 1..count) && self.rebuild(Pole::Exact) {
            best = self.walk_back(&mut way).unwrap_or(best);
            // What lies after the newest point came from the way that is not taken.
            upto = count - 1;
        }
        if let Some(hit) = self.first_hit(&way) {
            best = self.keep_clear(&mut way, best, hit);
            upto = count - 1;
        }
        self.hand_out(&way, upto);
        let joints = way.joints(&self.trellis, upto);
        let branch = self.trellis.states[way.states[upto]].branch;
        self.drop_before(upto, joints, branch, best);
        self.way = way;
    }

    /// Walks the cheapest way back from its end; gives the state that it ends in.
    pub(super) fn walk_back(&self, way: &mut Backtrace) -> Option<usize> {
        let best = self.trellis.best()?;
        let count = self.trellis.layers.len();
        way.eased.clear();
        way.states.clear();
        way.states.resize(count, best);
        for layer in (1..count).rev() {
            way.states[layer - 1] = self.trellis.states[way.states[layer]].from;
        }
        Some(best)
    }

    /// Makes the trellis of the points that wait anew, with poles met in this way. It stays as it was, and false is said, where
    /// no way leads through it, or where the tool is drawn back on the way.
    pub(super) fn rebuild(&mut self, pole: Pole) -> bool {
        let layers = &self.trellis.layers;
        if self.trellis.states.iter().any(|state| state.rewind.is_some()) {
            return false;
        }
        let placer = &self.settings[layers[0].setting].1;
        let mut anew = Trellis::close_to_poles(self.machine, placer, pole);
        anew.axes.both_ways = self.judge.weighs;
        let begun = usize::from(self.anchored);
        anew.layers.extend(layers[..begun].iter().cloned());
        anew.states.extend(&self.trellis.states[..begun]);
        let before = std::mem::replace(&mut self.trellis, anew);
        let setting = self.setting;
        let mut hitting = false;
        let through = before.layers[begun..].iter().all(|at| {
            self.setting = at.setting;
            self.goes_through(at, &mut hitting)
        });
        self.setting = setting;
        let through = through && self.trellis.best().is_some();
        if !through {
            self.trellis = before;
        }
        through
    }

    fn hand_out(&mut self, way: &Backtrace, upto: usize) {
        let trellis = &self.trellis;
        let mut eased = way.eased.iter().peekable();
        let mut last: Option<(u8, Joints)> = None;
        for layer in 0..=upto {
            let state = &trellis.states[way.states[layer]];
            let turned = eased.next_if(|(place, _)| *place == layer);
            let joints = turned.map_or(state.joints, |(_, joints)| *joints);
            let before = state.rewind.map(|before| self.rewound[before]);
            let settled = layer == 0 && self.anchored;
            if !settled || before.is_some() {
                let at = &trellis.layers[layer];
                self.chosen.push(ChosenPoint {
                    line: at.line,
                    motion: at.motion,
                    setting: at.setting,
                    arrives: !settled,
                    joints: before.unwrap_or(joints),
                    rewind: before.map(|_| Box::new(joints)),
                    changed: last.is_some_and(|(branch, last)| {
                        trellis.has_changed((branch, &last), (state.branch, &joints))
                    }),
                    eased: turned.is_some() || (state.branch == HELD && at.latitude.0 > POLE),
                });
            }
            last = Some((state.branch, joints));
        }
    }

    /// Forgets what is settled; what does not come from it is no way any more.
    fn drop_before(&mut self, upto: usize, joints: Joints, branch: u8, best: usize) {
        let trellis = &mut self.trellis;
        let last = trellis.layers.len() - 1;
        let (base, root) = (trellis.states[best].cost, trellis.states[best].root);
        if upto < last {
            let newest = &trellis.layers[last];
            for state in &mut trellis.states[newest.first..newest.first + newest.count] {
                if state.root == root {
                    state.cost = state.cost.beyond(&base);
                } else {
                    state.cost = PathCost::NO_WAY;
                }
            }
        }
        // One state is left of the settled layer; those after it move up. A state that came from another one
        // of it leads nowhere: its cost is infinite where the ways end.
        let shift = trellis.layers[upto].first + trellis.layers[upto].count - 1;
        trellis.layers.drain(..upto);
        trellis.states.drain(..shift);
        for layer in &mut trellis.layers[1..] {
            layer.first -= shift;
        }
        for state in &mut trellis.states {
            state.from = state.from.saturating_sub(shift);
        }
        trellis.layers[0].first = 0;
        trellis.layers[0].count = 1;
        trellis.states[0] =
            TrellisState { cost: PathCost::NONE, joints, from: 0, root: 0, branch, rewind: None };
        self.anchored = true;
        self.mark = 0;
        if upto == last {
            self.rewound.clear();
        }
    }
}

impl Trellis {
    /// Did the path take another branch or another full turn?
    fn has_changed(&self, (a, before): (u8, &Joints), (b, after): (u8, &Joints)) -> bool {
        // Where joints are beyond what a pose needs, a branch is none of the inverse.
        (a != b && a != HELD && b != HELD && !self.measure.has_surplus())
            || self.axes.largest_turn(before, after) > std::f64::consts::PI + SAME
    }
}
