//! Chains with more joints than a pose needs: a tool that turns in a robot's flange, a rail, a positioner.
//!
//! What is beyond the pose stands still in a cut as long as the others reach it inside their travel; else it gives way, and
//! what would pass its travel stands at its end. Where the tool comes to the part, it is tried all over its travel.

use std::f64::consts::TAU;

use super::metric::ARM;
use super::solution::{AxisSolution, ChoiceAxes, RotaryAxis, SolutionSummary};
use super::trellis::{ArrivalKind, CutChecker, CutEnd, Trellis, TrellisState, pose};
use crate::accuracy::Placer;
use crate::program::StraightMove;
use post_machine::kinematics::{Joint, Joints, Pose, Solver, Unreachable};

/// Steps in which a turn that is free is tried, radians: 30°.
const TURN: f64 = TAU / 12.0;

/// Steps of the turn to either side.
const MOST_TURNS: usize = 6;

/// Places along the travel of a rail that are tried.
const PLACES: usize = 8;

/// Solutions that are followed, those nearest to where the axes stand.
const MOST_STANDS: usize = 160;

/// An axis that stands at the end of its travel stands so far inside of it, radians or mm: between two points it may go a
/// little farther than at both.
const INSIDE: f64 = 2e-3;

/// Of more states than this nothing goes on off the part but by solutions that all come to.
const MOST_CONTINUED: usize = 8;

/// Up to such a turn a cut is taken to come through, away from the ends of travel, radians.
const SURE: f64 = 0.05;

/// Set in the branch of states whose rails, or else a positioner, go along with the tool.
pub(super) const ALONG: u8 = 1 << 6;

/// Set in the branch of states whose tool keeps its heading against the part.
pub(super) const HEADING: u8 = 1 << 5;

impl ChoiceAxes {
    /// The stands at `pose`, its surplus joints as `last` has them and elsewhere in their travel.
    pub(super) fn surplus_stands(
        &self,
        solver: &Solver,
        pose: &Pose,
        last: &Joints,
        stands: &mut Vec<AxisSolution>,
    ) -> Result<SolutionSummary, Unreachable> {
        let spin = solver.surplus().last().filter(|_| solver.spins());
        let values: Vec<(usize, [Vec<f64>; 2])> = solver
            .surplus()
            .iter()
            .filter(|joint| Some(*joint) != spin)
            .map(|joint| (*joint, self.values(solver, *joint, last)))
            .collect();
        let all = self.first_solutions(solver, pose, last, &values)?;
        let mut found = all.clone();
        for (joint, sides) in &values {
            for side in sides {
                // Each from those beside it: a search from so near comes to the same branch.
                let mut front = all.clone();
                for value in side {
                    for joints in &mut front {
                        joints[*joint] = *value;
                    }
                    if spin.is_some() {
                        let there =
                            front.first().map(|at| solver.inverse(pose, at, self.axis_tolerance));
                        found.extend(there.into_iter().flatten().flatten());
                        continue;
                    }
                    front.retain_mut(|joints| {
                        let tolerance = self.axis_tolerance;
                        let next = solver.search_holding(pose, joints, solver.surplus(), tolerance);
                        next.map(|next| *joints = next).is_ok()
                    });
                    found.extend(&front);
                }
            }
        }
        found.extend(solver.search_holding(pose, last, solver.surplus(), self.axis_tolerance));
        let measure = |joints: &Joints| {
            let axes = solver.chain().joints().iter().enumerate();
            let way = |(joint, axis): (usize, &Joint)| {
                let way = joints[joint] - last[joint];
                libm::fabs(if axis.rotary { libm::remainder(way, TAU) } else { way / ARM })
            };
            axes.map(way).sum::<f64>()
        };
        found.sort_by(|a, b| measure(a).total_cmp(&measure(b)));
        found.truncate(MOST_STANDS);
        self.keep_inside(solver, found, stands)
    }

    /// The solutions at `pose` from which the others are come to.
    fn first_solutions(
        &self,
        solver: &Solver,
        pose: &Pose,
        last: &Joints,
        values: &[(usize, [Vec<f64>; 2])],
    ) -> Result<Vec<Joints>, Unreachable> {
        let first = solver.inverse(pose, last, self.axis_tolerance);
        if first.is_ok() {
            return first;
        }
        // A rail may stand where the arm does not reach the part.
        let slides = |joint: &usize| !solver.chain().joints()[*joint].rotary;
        for (joint, [below, above]) in values.iter().filter(|(joint, _)| slides(joint)) {
            let mut places: Vec<f64> = below.iter().chain(above).copied().collect();
            places.sort_by(|a, b| {
                libm::fabs(a - last[*joint]).total_cmp(&libm::fabs(b - last[*joint]))
            });
            for place in places {
                let mut start = *last;
                start[*joint] = place;
                let there = solver.inverse(pose, &start, self.axis_tolerance);
                if there.is_ok() {
                    return there;
                }
            }
        }
        first
    }

    /// Values of a surplus joint below and above where `last` has it, the nearest first.
    fn values(&self, solver: &Solver, joint: usize, last: &Joints) -> [Vec<f64>; 2] {
        let at = last[joint];
        let (step, most, travel) = if solver.chain().joints()[joint].rotary {
            (TURN, MOST_TURNS, Some(self.travel(joint)))
        } else {
            let travel = self.linear.iter().find(|limit| limit.joint == joint);
            let travel = travel.map(|limit| limit.travel);
            (travel.map_or(0.0, |[least, most]| (most - least) / PLACES as f64), PLACES, travel)
        };
        let [least, most_value] = travel.unwrap_or([at, at]);
        [-1.0, 1.0].map(|side| {
            let values = (1..=most).map(|count| at + side * step * count as f64);
            values.filter(|value| *value >= least && *value <= most_value).collect()
        })
    }

    /// Of solutions those that the axes can stand at.
    pub(super) fn keep_inside(
        &self,
        solver: &Solver,
        found: Vec<Joints>,
        stands: &mut Vec<AxisSolution>,
    ) -> Result<SolutionSummary, Unreachable> {
        let mut summary = SolutionSummary::by_search(found.len());
        for mut joints in found {
            for (joint, axis) in solver.chain().joints().iter().enumerate() {
                if axis.rotary && self.turning.iter().any(|turning| turning.joint == joint) {
                    joints[joint] = libm::remainder(joints[joint], TAU);
                }
            }
            let over = self.at_rest(&mut joints).err().or_else(|| self.beyond(&joints));
            match over {
                None => {
                    let branch = solver.branch_of_arm(&joints);
                    stands.push(AxisSolution { joints, branch, free: 0 });
                }
                Some(over) => self.keep_least(&mut summary.over, over),
            }
        }
        Ok(summary)
    }

    /// Adds to `stands` those that go on from where the axes stand at `from`, off the part.
    pub(super) fn rapid_on(
        &self,
        solver: &Solver,
        pose: &Pose,
        from: &Joints,
        stands: &mut Vec<AxisSolution>,
    ) {
        let next = solver.search_holding(pose, from, solver.surplus(), self.axis_tolerance);
        if let Ok(next) = next {
            // What cannot stand there is no stand; nobody asks why, as others are at hand.
            let _ = self.keep_inside(solver, vec![next], stands);
        }
    }

    /// The ways on in a cut to `pose` from where the axes stand at `from`: the surplus joints stand still, or one of them
    /// gives way, or all do.
    pub(super) fn surplus_next(&self, solver: &Solver, pose: &Pose, from: &Joints) -> Vec<Joints> {
        let surplus = solver.surplus();
        let search = |start: &Joints, holding: &[usize]| {
            solver.search_holding(pose, start, holding, self.axis_tolerance).ok()
        };
        let held = search(from, surplus);
        let mut next: Vec<Joints> = held.filter(|held| self.reaches(held)).into_iter().collect();
        if next.first().is_some_and(|next| self.sure(solver, from, next)) {
            return next;
        }
        // What would pass its travel stands at its end, and what comes near to it where it is.
        let ended = held.and_then(|held| {
            self.passed(&held).or_else(|| {
                let ends = |axis: &&RotaryAxis| axis.ends_towards(from, &held, SURE);
                let axis = self.turning.iter().find(ends)?;
                Some((axis.joint, from[axis.joint]))
            })
        });
        let mut start = *from;
        if let Some((joint, value)) = ended {
            start[joint] = value;
        }
        let ends = |joint: usize| ended.is_some_and(|(ended, _)| ended == joint);
        for gives in surplus {
            let mut holding: Vec<usize> =
                surplus.iter().copied().filter(|joint| joint != gives).collect();
            holding.extend(ended.map(|(joint, _)| joint));
            next.extend(search(&start, &holding).filter(|next| self.reaches(next)));
        }
        if next.is_empty() {
            let holding: Vec<usize> =
                (0..solver.chain().joints().len()).filter(|joint| ends(*joint)).collect();
            next.extend(search(&start, &holding).filter(|next| self.reaches(next)));
        }
        next
    }

    /// The way on in a cut to `pose` on which rails, or else a positioner, go along with the tool, as little as they can.
    pub(super) fn along_next(&self, solver: &Solver, pose: &Pose, from: &Joints) -> Option<Joints> {
        let turns = |joint: &usize| solver.chain().joints()[*joint].rotary;
        let surplus = solver.surplus();
        let mut holding: Vec<usize> = surplus.iter().copied().filter(turns).collect();
        if holding.len() == surplus.len() {
            // Of a tool that turns the last is the turn about it.
            let spins = usize::from(solver.chain().edge().is_none());
            holding.drain(..surplus.len().saturating_sub(spins));
            if holding.len() == surplus.len() {
                return None;
            }
        }
        let next = solver.search_holding(pose, from, &holding, self.axis_tolerance).ok()?;
        self.reaches(&next).then_some(next)
    }

    /// The way on in a cut to `pose` on which the tool keeps its heading against the part.
    pub(super) fn heading_next(
        &self,
        solver: &Solver,
        pose: &Pose,
        from: &Joints,
    ) -> Option<Joints> {
        let next = solver.search_heading(pose, from, self.axis_tolerance)?;
        self.reaches(&next).then_some(next)
    }

    /// Nothing between two points of a cut can be in the way: no axis turns far, none is near an end of its travel.
    pub(super) fn sure(&self, solver: &Solver, from: &Joints, to: &Joints) -> bool {
        let turn = solver.largest_turn(from, to);
        turn < SURE && !self.near_end(from, to, turn.max(SURE))
    }

    /// The axis that stands beyond its travel, and where its travel ends.
    fn passed(&self, joints: &Joints) -> Option<(usize, f64)> {
        let turning = self.turning.iter().filter_map(|axis| Some((axis.joint, axis.travel?)));
        let sliding = self.linear.iter().map(|limit| (limit.joint, limit.travel));
        turning.chain(sliding).find_map(|(joint, [least, most])| {
            let value = joints[joint];
            if value < least {
                Some((joint, least + INSIDE))
            } else if value > most {
                Some((joint, most - INSIDE))
            } else {
                None
            }
        })
    }
}

impl Trellis {
    /// Adds the stands that go on from the cheapest states, off the part, with the joints beyond what a pose needs where
    /// they are.
    pub(super) fn rapids_on(
        &self,
        placer: &Placer,
        target: &Pose,
        before: std::ops::Range<usize>,
        stands: &mut Vec<AxisSolution>,
    ) {
        let mut states: Vec<&TrellisState> =
            self.states[before].iter().filter(|state| state.cost.is_way()).collect();
        states.sort_by(|a, b| a.cost.order(&b.cost));
        for state in states.into_iter().take(MOST_CONTINUED) {
            self.axes.rapid_on(placer.solver(), target, &state.joints, stands);
        }
    }

    /// Continues each state in a cut of a chain that has joints beyond what a pose needs.
    pub(super) fn surplus_on(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        before: std::ops::Range<usize>,
        judge: &mut dyn CutChecker,
    ) {
        let first = self.states.len();
        let Some(last) = self.layers.last() else {
            return;
        };
        let begins = last.kind != ArrivalKind::Cut;
        let (from_pose, target) = (pose(&last.motion), &pose(motion));
        let solver = placer.solver();
        let mut next: Vec<(Joints, u8)> = Vec::new();
        for index in before {
            let state = self.states[index];
            if !state.cost.is_way() {
                continue;
            }
            let way = state.branch & (ALONG | HEADING);
            if begins || way == ALONG {
                let goes = self.axes.along_next(solver, target, &state.joints);
                next.extend(goes.map(|joints| (joints, ALONG)));
            }
            if begins || way == HEADING {
                let goes = self.axes.heading_next(solver, target, &state.joints);
                next.extend(goes.map(|joints| (joints, HEADING)));
            }
            if begins || next.is_empty() {
                let others = self.axes.surplus_next(solver, target, &state.joints);
                next.extend(others.into_iter().map(|joints| (joints, way)));
            }
            for (mut joints, branch) in next.drain(..) {
                if self.axes.stand_still(&state.joints, &mut joints)
                    && (self.axes.sure(solver, &state.joints, &joints)
                        || judge.passes(
                            placer,
                            motion,
                            CutEnd { pose: &from_pose, joints: &state.joints },
                            CutEnd { pose: target, joints: &joints },
                        ))
                {
                    let hits = judge.hits(placer, ArrivalKind::Cut, &state.joints, &joints);
                    let branch = branch | solver.branch_of_arm(&joints);
                    let new = self.after(index, joints, branch, hits);
                    self.keep(first, new);
                }
            }
        }
    }
}
