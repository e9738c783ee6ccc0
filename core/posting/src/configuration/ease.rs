//! Close to poles the cheapest way is eased: the pole joint is held, turned early or turned evenly, as far as the tolerance
//! of the tool axis goes.

use super::backtrace::Backtrace;
use super::cycle_time::PathClock;
use super::route::Route;
use super::settle::SAME;
use super::taut::{TubePoint, taut};
use super::trellis::{self, ArrivalKind, CutChecker, CutEnd, HELD, Trellis, TrellisState, pose};
use post_machine::kinematics::Joints;

/// Shares of the room close to a pole that are tried under the rule `cycle-time`; with none, points on the pole alone are
/// turned to.
const SHARES: [f64; 5] = [1.0, 0.5, 0.25, 0.1, 0.0];

/// A time is less if it is so by this share.
const SOONER: f64 = 1e-9;

impl Route<'_> {
    /// Pulls the pole joint taut wherever the tolerance leaves it room; under the rule `cycle-time` as taut as takes least
    /// time.
    pub(super) fn ease(&mut self, way: &mut Backtrace) {
        let Some(pole) = self.pole_joint() else {
            return;
        };
        let mut at = usize::from(self.anchored);
        while let Some(run) = self.roomy(way, at) {
            if self.trellis.measure.drives().is_some() {
                self.ease_fastest(way, run.clone(), pole);
            } else {
                self.ease_run(way, run.clone(), pole, 1.0);
                // The point after the run is reached from it.
                let end = (run.end + 1).min(self.trellis.layers.len());
                if !self.comes_through(way, run.start.max(1)..end) {
                    way.eased.retain(|(layer, _)| *layer < run.start);
                }
            }
            at = run.end;
        }
    }

    /// The joint that has room close to a pole.
    fn pole_joint(&self) -> Option<usize> {
        let first = self.trellis.layers.first()?;
        self.settings[first.setting].1.solver().pole_joint()
    }

    /// The next points from `at` where the tolerance leaves the pole joint room.
    fn roomy(&self, way: &Backtrace, at: usize) -> Option<std::ops::Range<usize>> {
        let layers = &self.trellis.layers;
        let roomy = |layer: &usize| {
            let state = &self.trellis.states[way.states[*layer]];
            self.trellis.eased(layers[*layer].latitude.0) && state.rewind.is_none()
        };
        let start = (at..layers.len()).find(roomy)?;
        let end = (start..layers.len()).find(|layer| !roomy(layer));
        Some(start..end.unwrap_or(layers.len()))
    }

    /// Pulls the pole joint taut over a run of points, in so much of the room that the tolerance leaves it (0 to 1).
    fn ease_run(&self, way: &mut Backtrace, run: std::ops::Range<usize>, pole: usize, share: f64) {
        let trellis = &self.trellis;
        let layers = &trellis.layers;
        let state = |way: &Backtrace, layer: usize| trellis.states[way.states[layer]];
        // The point after the run, if there is one, is where the string must arrive.
        let behind = (run.end < layers.len()).then_some(run.end);
        let gates: Vec<TubePoint> = run
            .clone()
            .chain(behind)
            .map(|layer| TubePoint {
                time: match layers[layer].kind {
                    ArrivalKind::Cut => Some(minutes(trellis, layer)),
                    ArrivalKind::First | ArrivalKind::Rapid => None,
                },
                range: if layer < run.end {
                    self.room(layer, &state(way, layer), pole, share)
                } else {
                    let state = state(way, layer);
                    let value = match state.rewind {
                        Some(before) => self.rewound[before][pole],
                        None => state.joints[pole],
                    };
                    [value, value]
                },
            })
            .collect();
        let start = match run.start {
            0 => self.near[pole],
            first => way.joints(trellis, first - 1)[pole],
        };
        let values = taut(Some(start), &gates);
        for (layer, value) in run.zip(values) {
            if let Some(joints) = self.turned_to(way, layer, pole, value) {
                way.eased.push((layer, joints));
            }
        }
    }

    /// Eases a run of points in that share of the room which takes least time, none at all among them.
    fn ease_fastest(&mut self, way: &mut Backtrace, run: std::ops::Range<usize>, pole: usize) {
        let before = way.eased.len();
        let mut least = self.seconds(way, &run).unwrap_or(f64::INFINITY);
        let mut best = None;
        for share in SHARES {
            self.ease_run(way, run.clone(), pole, share);
            if let Some(seconds) = self.seconds(way, &run)
                && seconds < least * (1.0 - SOONER)
            {
                least = seconds;
                best = Some(share);
            }
            way.eased.truncate(before);
        }
        if let Some(share) = best {
            self.ease_run(way, run, pole, share);
        }
    }

    /// How long the machine takes about over a run of points and to the next two after it, with the points put in that this
    /// needs, s; none where it does not come through.
    fn seconds(&mut self, way: &Backtrace, run: &std::ops::Range<usize>) -> Option<f64> {
        let (trellis, judge) = (&self.trellis, &mut self.judge);
        let drives = trellis.measure.drives()?;
        let count = trellis.layers.len();
        let first = run.start.saturating_sub(2);
        let mut clock = PathClock::new(drives, way.joints(trellis, first));
        let mut pieces = Vec::new();
        for layer in first + 1..count.min(run.end + 2) {
            let [before, at] = [layer - 1, layer].map(|layer| &trellis.layers[layer]);
            let state = &trellis.states[way.states[layer]];
            let from = way.joints(trellis, layer - 1);
            let to = match state.rewind {
                Some(before) => self.rewound[before],
                None => way.joints(trellis, layer),
            };
            if at.kind != ArrivalKind::Cut {
                let placer = &self.settings[at.setting].1;
                clock.rapid(placer.solver().chain(), &to);
                continue;
            }
            let asked = trellis.asked_for(layer);
            let through = judge.pieces(
                &self.settings[at.setting].1,
                &at.motion,
                CutEnd { pose: &pose(&before.motion), joints: &from },
                CutEnd { pose: &pose(&at.motion), joints: &to },
                &mut pieces,
            );
            if !through && layer >= run.start && layer <= run.end {
                return None;
            }
            let mut last = 0.0;
            for (share, joints) in &pieces {
                clock.cuts(joints, (share - last) * asked);
                last = *share;
            }
        }
        Some(clock.seconds)
    }

    /// A share of what the tolerance leaves the pole joint at a point.
    fn room(&self, layer: usize, state: &TrellisState, pole: usize, share: f64) -> [f64; 2] {
        let [least, most] = self.trellis.axes.travel(pole);
        if state.branch == HELD {
            return [least, most];
        }
        let sine = self.trellis.layers[layer].latitude.0;
        let half = share * self.trellis.freedom / sine.max(1e-12);
        let value = state.joints[pole];
        [(value - half).max(least), (value + half).min(most)]
    }

    /// Where the axes stand with the pole joint at `value`; none if it stands there, or the others cannot follow.
    fn turned_to(&self, way: &Backtrace, layer: usize, pole: usize, value: f64) -> Option<Joints> {
        let trellis = &self.trellis;
        let joints = trellis.states[way.states[layer]].joints;
        if (value - joints[pole]).abs() < SAME {
            return None;
        }
        let at = &trellis.layers[layer];
        let solver = self.settings[at.setting].1.solver();
        let mut last = match layer {
            0 => joints,
            layer => way.joints(trellis, layer - 1),
        };
        let turned = value - last[pole];
        last[pole] = value;
        // The others come as near as they can, on the turns where they are.
        let stand = trellis.axes.held(solver, &pose(&at.motion), &last, turned)?;
        Some(stand.joints)
    }

    /// Can the cuts that lead to these points be made as the way has it? Only those are tried that the trellis did not
    /// try: from and to points that are eased or held.
    pub(super) fn comes_through(
        &mut self,
        way: &Backtrace,
        points: std::ops::Range<usize>,
    ) -> bool {
        if self.trellis.freedom == 0.0 {
            return true;
        }
        let (trellis, judge) = (&self.trellis, &mut self.judge);
        let turned = |layer: usize| {
            let place = way.eased.binary_search_by_key(&layer, |(layer, _)| *layer);
            // What was handed out may have been eased.
            let out = layer == 0 && trellis.eased(trellis.layers[0].latitude.0);
            out || place.is_ok() || trellis.states[way.states[layer]].branch == HELD
        };
        judge.strict = true;
        let mut points = points;
        let good = points.all(|layer| {
            let [before, at] = [layer - 1, layer].map(|layer| &trellis.layers[layer]);
            if at.kind != ArrivalKind::Cut || !(turned(layer - 1) || turned(layer)) {
                return true;
            }
            let from = way.joints(trellis, layer - 1);
            let to = match trellis.states[way.states[layer]].rewind {
                Some(before) => self.rewound[before],
                None => way.joints(trellis, layer),
            };
            // Nothing turns and the axis hardly sweeps: the tip goes straight, and the tool axis is off by no more than
            // at the ends.
            let sweep = (at.motion.axis - before.motion.axis).norm();
            if sweep <= 2.0 * trellis.freedom && trellis.axes.largest_turn(&from, &to) == 0.0 {
                return true;
            }
            judge.passes(
                &self.settings[at.setting].1,
                &at.motion,
                CutEnd { pose: &pose(&before.motion), joints: &from },
                CutEnd { pose: &pose(&at.motion), joints: &to },
            )
        });
        judge.strict = false;
        good
    }
}

/// Time of a cut, minutes.
fn minutes(trellis: &Trellis, layer: usize) -> f64 {
    let motion = &trellis.layers[layer].motion;
    let way = layer
        .checked_sub(1)
        .map_or(0.0, |before| (motion.tip - trellis.layers[before].motion.tip).norm());
    trellis::minutes(motion, way)
}
