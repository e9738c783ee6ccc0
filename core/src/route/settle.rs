//! Settling: the cheapest way through the lattice is walked back, eased close to poles, and handed out.

use super::lattice::{HELD, Kind, Lattice, State, pose};
use super::pole::{Gate, taut};
use super::{Chosen, Route};
use crate::kinematics::Joints;
use crate::program::{Motion, Pace};

/// A pole joint is eased where the tolerance leaves it more than this, radians (5°): elsewhere little would be
/// gained, and the points stay exact.
const WORTH: f64 = 0.087_266_462_599_716_48;

/// Values that differ by less are the same, radians.
const SAME: f64 = 1e-9;

/// One point of the way that was walked back.
struct Stop {
    layer: usize,
    state: State,
    joints: Joints,
}

impl Route<'_> {
    /// Settles all points.
    pub(crate) fn settle_all(&mut self) {
        let last = self.lattice.layers.len().saturating_sub(1);
        self.settle(last);
    }

    /// Settles what is decided: everything where one state is left, else the older half of a full window.
    #[inline]
    pub(super) fn advance(&mut self) {
        let layers = &self.lattice.layers;
        let Some(layer) = layers.last() else {
            return;
        };
        let waiting = layers.len() - usize::from(self.anchored);
        let look_ahead = self.machine.solution.look_ahead;
        if layer.count == 1 && !self.eased(layer.latitude.0) {
            self.settle_all();
        } else if waiting >= look_ahead {
            let last = layers.len() - 1;
            self.settle(if self.mark > 0 { self.mark } else { last });
            self.set_mark();
        } else if self.mark == 0 && 2 * waiting >= look_ahead {
            self.set_mark();
        }
    }

    /// From here on every state knows which state of the newest layer it comes from.
    fn set_mark(&mut self) {
        let last = self.lattice.layers.len() - 1;
        self.mark = last;
        let layer = &self.lattice.layers[last];
        for index in layer.first..layer.first + layer.count {
            self.lattice.states[index].root = index;
        }
    }

    /// So close to the pole that its joint has room.
    fn eased(&self, sine: f64) -> bool {
        sine * WORTH < self.lattice.freedom || sine <= self.lattice.cone
    }

    /// Settles the points up to `upto`, the best way to the newest point decides.
    fn settle(&mut self, upto: usize) {
        let Some(best) = self.lattice.best() else {
            return;
        };
        let begin = usize::from(self.anchored);
        if self.lattice.layers.len() <= begin {
            return;
        }
        let mut stops: Vec<Stop> = Vec::with_capacity(self.lattice.layers.len());
        let mut index = best;
        for layer in (0..self.lattice.layers.len()).rev() {
            let state = self.lattice.states[index];
            stops.push(Stop {
                layer,
                state,
                joints: state.joints,
            });
            index = state.from;
        }
        stops.reverse();
        self.ease(&mut stops);
        self.hand_out(&stops[..=upto]);
        self.drop_before(upto, &stops[upto], best);
    }

    /// Pulls the pole joint taut wherever the tolerance leaves it room.
    fn ease(&self, stops: &mut [Stop]) {
        let lattice = &self.lattice;
        let Some(pole) = self.settings[lattice.layers[stops[0].layer].setting]
            .1
            .solver()
            .pole_joint()
        else {
            return;
        };
        let roomy = |stop: &Stop| {
            stop.state.rewind.is_none() && self.eased(lattice.layers[stop.layer].latitude.0)
        };
        let first = usize::from(self.anchored);
        let mut at = first;
        while at < stops.len() {
            if !roomy(&stops[at]) {
                at += 1;
                continue;
            }
            let end = (at..stops.len())
                .find(|index| !roomy(&stops[*index]))
                .unwrap_or(stops.len());
            // The point behind the run, if there is one, is where the string must arrive.
            let gates: Vec<Gate> = (at..end)
                .chain((end < stops.len()).then_some(end))
                .map(|index| {
                    let stop = &stops[index];
                    let layer = &lattice.layers[stop.layer];
                    Gate {
                        time: match layer.kind {
                            Kind::Cut => Some(minutes(lattice, stop.layer)),
                            Kind::First | Kind::Rapid => None,
                        },
                        range: if index < end {
                            self.room(lattice, stop, pole)
                        } else {
                            let value = match stop.state.rewind {
                                Some(before) => self.rewound[before][pole],
                                None => stop.joints[pole],
                            };
                            [value, value]
                        },
                    }
                })
                .collect();
            let start = (at > 0).then(|| stops[at - 1].joints[pole]);
            let values = taut(start.or(Some(self.near[pole])), &gates);
            for (index, value) in (at..end).zip(values) {
                self.turn_to(stops, index, pole, value);
            }
            at = end;
        }
    }

    /// What the tolerance leaves the pole joint at a point.
    fn room(&self, lattice: &Lattice, stop: &Stop, pole: usize) -> [f64; 2] {
        let [least, most] = lattice.axes.travel(pole);
        if stop.state.branch == HELD {
            return [least, most];
        }
        let sine = lattice.layers[stop.layer].latitude.0;
        let half = lattice.freedom / sine.max(1e-12);
        let value = stop.joints[pole];
        [(value - half).max(least), (value + half).min(most)]
    }

    /// Puts the pole joint of a stop at `value`, the others behind it.
    fn turn_to(&self, stops: &mut [Stop], index: usize, pole: usize, value: f64) {
        let before = (index > 0).then(|| stops[index - 1].joints);
        let stop = &mut stops[index];
        if (value - stop.joints[pole]).abs() < SAME {
            return;
        }
        let layer = &self.lattice.layers[stop.layer];
        let solver = self.settings[layer.setting].1.solver();
        let mut last = before.unwrap_or(stop.joints);
        last[pole] = value;
        // The others come as near as they can, on the turns where they are.
        let held = self.lattice.axes.held(solver, &pose(&layer.motion), &last);
        if let Some(stand) = held {
            stop.joints = stand.joints;
        }
    }

    fn hand_out(&mut self, stops: &[Stop]) {
        for (index, stop) in stops.iter().enumerate() {
            let settled = index == 0 && self.anchored;
            let before = stop.state.rewind.map(|before| self.rewound[before]);
            if settled && before.is_none() {
                continue;
            }
            let layer = &self.lattice.layers[stop.layer];
            let last = index.checked_sub(1).map(|last| &stops[last]);
            self.chosen.push(Chosen {
                line: layer.line,
                motion: layer.motion,
                setting: layer.setting,
                arrives: !settled,
                joints: before.unwrap_or(stop.joints),
                rewind: before.map(|_| stop.joints),
                changed: last.is_some_and(|last| self.has_changed(last, stop)),
                eased: stop.joints != stop.state.joints || stop.state.branch == HELD,
            });
        }
    }

    /// Did the path take another branch or another full turn here?
    fn has_changed(&self, before: &Stop, stop: &Stop) -> bool {
        let (a, b) = (before.state.branch, stop.state.branch);
        (a != b && a != HELD && b != HELD)
            || self.lattice.axes.largest_turn(&before.joints, &stop.joints)
                > std::f64::consts::PI + SAME
    }

    /// Forgets what is settled; what does not come from it is no way any more.
    fn drop_before(&mut self, upto: usize, stop: &Stop, best: usize) {
        let lattice = &mut self.lattice;
        let last = lattice.layers.len() - 1;
        let (base, root) = (lattice.states[best].cost, lattice.states[best].root);
        if upto < last {
            let newest = &lattice.layers[last];
            for state in &mut lattice.states[newest.first..newest.first + newest.count] {
                if state.root == root {
                    state.cost -= base;
                } else {
                    state.cost = f64::INFINITY;
                }
            }
        }
        // One state is left of the settled layer; those behind it move up. A state that came from another one
        // of it leads nowhere: its cost is infinite where the ways end.
        let shift = lattice.layers[upto].first + lattice.layers[upto].count - 1;
        lattice.layers.drain(..upto);
        lattice.states.drain(..shift);
        for layer in &mut lattice.layers[1..] {
            layer.first -= shift;
        }
        for state in &mut lattice.states {
            state.from = state.from.saturating_sub(shift);
        }
        lattice.layers[0].first = 0;
        lattice.layers[0].count = 1;
        lattice.states[0] = State {
            cost: 0.0,
            joints: stop.joints,
            from: 0,
            root: 0,
            branch: stop.state.branch,
            rewind: None,
        };
        self.anchored = true;
        self.mark = 0;
        if upto == last {
            self.rewound.clear();
        }
    }
}

/// Time of a cut, minutes.
fn minutes(lattice: &Lattice, layer: usize) -> f64 {
    let motion = &lattice.layers[layer].motion;
    let way = layer.checked_sub(1).map_or(0.0, |before| {
        distance(&lattice.layers[before].motion, motion)
    });
    match motion.pace {
        Pace::PerMinute(feed) => way / feed,
        Pace::InverseTime(feed) => 1.0 / feed,
        Pace::Rapid => 0.0,
    }
}

fn distance(from: &Motion, to: &Motion) -> f64 {
    (to.tip - from.tip).norm()
}
