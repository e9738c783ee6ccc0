//! Where the path cannot go on: another index position off the part, a rewind, or a fault that says what was tried.

use super::route::{DroppedPoint, Route};
use super::solution::{SolutionSummary, both};
use super::trellis::{ArrivalKind, TrellisState, pose};
use crate::accuracy::PlacementError;
use crate::program::{MoveFeed, StraightMove};
use crate::refusal;
use post_machine::dependent_limit::DependentLimit;
use post_machine::description::Positions;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::travel::{AT_END, passed};
use post_machine::kinematics::{Joints, Unreachable};

/// Positions of an index axis that are tried.
const MOST_POSITIONS: usize = 720;

impl Route<'_> {
    /// Finds a way where the newest point cannot be reached, or says why there is none.
    #[cold]
    pub(super) fn find_way(
        &mut self,
        line: u64,
        motion: &StraightMove,
        pushed: Result<SolutionSummary, Unreachable>,
    ) -> Result<(), DroppedPoint> {
        let kind = match (&pushed, self.trellis.layers.last()) {
            (Ok(_), Some(layer)) => layer.kind,
            _ => ArrivalKind::First,
        };
        if pushed.is_ok() {
            self.trellis.pop();
        }
        if self.try_positions(line, motion).map_err(DroppedPoint::Point)? {
            return Ok(());
        }
        if self.try_lattice(line, motion) {
            return Ok(());
        }
        let found = match pushed {
            Ok(found) => found,
            Err(unreachable) => {
                let refused = PlacementError::Unreachable(unreachable);
                return Err(DroppedPoint::Point(refusal::refused(self.machine, &refused).boxed()));
            }
        };
        if kind != ArrivalKind::Cut {
            let limit = self.passed_limit(motion);
            return Err(DroppedPoint::Point(limit.unwrap_or_else(|| self.over_travel(&found))));
        }
        if self.machine.rewind.is_some() && self.try_rewind(line, motion) {
            return Ok(());
        }
        let fault = self.no_way(motion, &found);
        // After the fault the path begins anew, so that what follows is checked too.
        self.settle_all();
        self.leave();
        Err(DroppedPoint::Path(fault))
    }

    /// Pushes a point if there is a way to stand at it.
    pub(super) fn goes_on(&mut self, line: u64, motion: &StraightMove) -> bool {
        let pushed = self.push(line, motion).is_ok();
        if pushed && !self.alive() {
            self.trellis.pop();
            return false;
        }
        pushed
    }

    /// Goes back to where the tool was last off the part, and puts a redundant axis on another of its
    /// positions there: the nearest with which the path comes through to this point.
    fn try_positions(&mut self, line: u64, motion: &StraightMove) -> Result<bool, Box<Diagnostic>> {
        let held = self.settings[self.setting].0;
        let alternatives = self.alternatives(held);
        if alternatives.is_empty() {
            return Ok(false);
        }
        // The points since the last rapid, this one last.
        let back = match motion.pace {
            MoveFeed::Rapid => self.trellis.layers.len(),
            _ => match self.last_off_part() {
                Some(layer) => layer,
                None if self.trellis.layers.is_empty() => 0,
                None => return Ok(false),
            },
        };
        let mut points = self.take_back(back);
        points.push((line, *motion));
        let before = self.setting;
        for other in alternatives {
            self.setting = self.setting_for(&other)?;
            let mut pushed = 0;
            for (line, motion) in &points {
                if !self.goes_on(*line, motion) {
                    break;
                }
                pushed += 1;
            }
            if pushed == points.len() {
                return Ok(true);
            }
            for _ in 0..pushed {
                self.trellis.pop();
            }
        }
        self.setting = before;
        for (line, motion) in &points[..points.len() - 1] {
            if !self.goes_on(*line, motion) {
                // Only a rewind had led to it.
                return Err(Diagnostic::error(
                    "index",
                    "no position of the redundant axes carries the pass to this line",
                )
                .help("retract before this line, so that the axis can be set anew")
                .boxed());
            }
        }
        Ok(false)
    }

    /// The last layer that is not settled and not come to in a cut.
    pub(super) fn last_off_part(&self) -> Option<usize> {
        let layers = &self.trellis.layers;
        let mut waiting = (usize::from(self.anchored)..layers.len()).rev();
        waiting.find(|layer| layers[*layer].kind != ArrivalKind::Cut)
    }

    /// Takes back the layers from `back` on: their lines and moves.
    pub(super) fn take_back(&mut self, back: usize) -> Vec<(u64, StraightMove)> {
        let mut points = Vec::new();
        while self.trellis.layers.len() > back {
            points.extend(self.trellis.pop().map(|layer| (layer.line, layer.motion)));
        }
        points.reverse();
        self.mark = 0;
        points
    }

    /// Other positions of the redundant axes than those at `held`, the nearest first.
    fn alternatives(&self, held: Joints) -> Vec<Joints> {
        let mut alternatives: Vec<Joints> = Vec::new();
        for joint in self.machine.redundant() {
            let axis = &self.machine.axes[joint];
            let Some(indexed) = &axis.indexed else {
                continue;
            };
            let inside = |value: &f64| passed(axis.travel, *value, AT_END).is_none();
            let values: Vec<f64> = match &indexed.positions {
                Positions::Any => continue,
                Positions::List(values) => values.clone(),
                Positions::Step { step, .. } => (1..MOST_POSITIONS / 2)
                    .flat_map(|count| [1.0, -1.0].map(|sign| sign * count as f64 * step))
                    .filter(|way| axis.travel.is_some() || way.abs() <= std::f64::consts::PI)
                    .map(|way| held[joint] + way)
                    .collect(),
            };
            for value in values.into_iter().filter(inside) {
                if (value - held[joint]).abs() > 1e-9 {
                    let mut other = held;
                    other[joint] = value;
                    alternatives.push(other);
                }
            }
        }
        alternatives.sort_by(|a, b| {
            let way = |other: &Joints| self.trellis.measure.approach(&held, other);
            way(a).total_cmp(&way(b))
        });
        alternatives
    }

    /// Adds to the point before the states that a rewind there can reach, and pushes the point again.
    pub(super) fn try_rewind(&mut self, line: u64, motion: &StraightMove) -> bool {
        let Some(rewind) = self.machine.rewind else {
            return false;
        };
        let Some(layer) = self.trellis.layers.last().cloned() else {
            return false;
        };
        let placer = self.settings[layer.setting].1.clone();
        let target = pose(&layer.motion);
        let along = self.machine.control_point.along;
        let Some(back) = layer.motion.drawn_back(&rewind, along) else {
            return false;
        };
        let reaches = |joints: &Joints| placer.settled(pose(&back), 1.0, joints).is_ok();
        let mut stands = Vec::new();
        let states: Vec<TrellisState> =
            self.trellis.states_of(self.trellis.layers.len() - 1).to_vec();
        let mut added = Vec::new();
        for (place, state) in states.iter().enumerate() {
            if !state.cost.is_way() || !reaches(&state.joints) {
                continue;
            }
            stands.clear();
            let axes = &self.trellis.axes;
            let found = axes.stands(placer.solver(), &target, &state.joints, &both, &mut stands);
            if found.is_err() {
                continue;
            }
            for stand in &stands {
                axes.turned(stand, &state.joints, &mut |joints| {
                    let turns = axes.largest_turn(&state.joints, joints) > 1e-6;
                    if turns && axes.within_limits(joints) {
                        added.push((place, stand.branch, *joints));
                    }
                });
            }
        }
        for (place, branch, joints) in added {
            if !reaches(&joints) {
                continue;
            }
            let state = &states[place];
            let hits = self.rewind_hits(&placer, &layer.motion, [&state.joints, &joints]);
            let chain = placer.solver().chain();
            let turn = self.trellis.measure.off_part(chain, &state.joints, &joints);
            self.rewound.push(state.joints);
            let index = self.trellis.states.len();
            self.trellis.states.push(TrellisState {
                cost: state.cost.and_rewind(turn).and_hits(hits),
                joints,
                from: state.from,
                root: if self.mark + 1 == self.trellis.layers.len() { index } else { state.root },
                branch,
                rewind: Some(self.rewound.len() - 1),
            });
            if let Some(layer) = self.trellis.layers.last_mut() {
                layer.count += 1;
            }
        }
        self.goes_on(line, motion)
    }

    fn over_travel(&self, found: &SolutionSummary) -> Box<Diagnostic> {
        let refused = match found.over {
            Some(over) => PlacementError::OverTravel { over, tried: found.solutions },
            None if !self.machine.solution.require.is_empty() => {
                return Diagnostic::error(
                    "over-travel",
                    "no solution stands on the side of zero that [solution] require asks for",
                )
                .help("another side, or another set-up of the part")
                .boxed();
            }
            None => PlacementError::Unreachable(Unreachable::Linear),
        };
        refusal::refused(self.machine, &refused).boxed()
    }

    /// The fault of a point at which every solution inside travel passes a limit that depends on other axes: that of the
    /// one which passes it least.
    fn passed_limit(&self, motion: &StraightMove) -> Option<Box<Diagnostic>> {
        let axes = &self.trellis.axes;
        let mut least: Option<(f64, &DependentLimit, Joints)> = None;
        let mut held = !axes.has_limits();
        if held {
            return None;
        }
        let last = self
            .trellis
            .best()
            .map_or(self.machine.solution.start, |index| self.trellis.states[index].joints);
        let mut stands = Vec::new();
        let placer = &self.settings[self.setting].1;
        axes.stands(placer.solver(), &pose(motion), &last, &both, &mut stands).ok()?;
        for stand in &stands {
            axes.turned(stand, &last, &mut |joints| {
                let mut passed = self.machine.limits.iter().filter(|limit| !limit.holds(joints));
                let Some(limit) = passed.next() else {
                    held = true;
                    return;
                };
                let by = limit.excess(joints);
                if least.as_ref().is_none_or(|(least, ..)| by < *least) {
                    least = Some((by, limit, *joints));
                }
            });
        }
        let (_, limit, joints) = least.filter(|_| !held)?;
        Some(refusal::beyond_limit(self.machine, limit, &joints, "").boxed())
    }

    /// The fault of a cut that cannot go on: what each solution would have asked for.
    fn no_way(&self, motion: &StraightMove, found: &SolutionSummary) -> Box<Diagnostic> {
        let placer = &self.settings[self.setting].1;
        let target = pose(motion);
        let Some(from) = self.trellis.best().map(|index| self.trellis.states[index]) else {
            return self.over_travel(found);
        };
        let start = self.trellis.layers.last().map_or(target.tip, |last| last.motion.tip);
        let meeting = placer.solver().meeting([start, target.tip], &from.joints);
        if let Some(meeting) = meeting.filter(|at| at.miss > self.machine.accuracy.tolerance) {
            let refused = PlacementError::Unreachable(Unreachable::Plane { miss: meeting.miss });
            return refusal::refused(self.machine, &refused).boxed();
        }
        if let Some(limit) = self.passed_limit(motion) {
            return limit;
        }
        let mut stands = Vec::new();
        let axes = &self.trellis.axes;
        let solved = axes.stands(placer.solver(), &target, &from.joints, &both, &mut stands);
        if solved.is_err() || stands.is_empty() {
            return self.over_travel(found);
        }
        if !placer.solver().surplus().is_empty() {
            let carried = stands.iter().filter_map(|stand| axes.carried(stand, &from.joints).ok());
            let turn = |joints: &Joints| axes.largest_turn(&from.joints, joints);
            let nearest = carried.min_by(|a, b| turn(a).total_cmp(&turn(b)));
            let surplus = placer.solver().surplus();
            return refusal::no_way_of_arm(self.machine, surplus, &from.joints, nearest).boxed();
        }
        let tried: Vec<_> = stands
            .iter()
            .map(|stand| {
                (axes.carried(stand, &from.joints), stand.branch == from.branch, stand.joints)
            })
            .collect();
        refusal::no_way(self.machine, &from.joints, &tried).boxed()
    }
}
