//! A pass of a robot that the usual search does not come through: all that the arm can do, in small steps.
//!
//! The usual search follows the ways of standing that are nearest where the tool comes to the part, and the turn about the
//! tool stands still or gives way by as little as it can. A pass that winds the arm up so, or takes it into the end of an
//! axis, may still be gone with that turn led along early. So the pass is begun anew, where the tool came to the part: at each
//! of its points the states are all branches and full turns at all turns about the tool, [`SPINS`] of them, and between two
//! points those go on from one another whose joints are near. The cheapest way through is found as any other.

use std::ops::Range;

use super::route::Route;
use super::solution::{AxisSolution, ChoiceAxes};
use super::surplus::{ALONG, HEADING};
use super::trellis::{ArrivalKind, CutChecker, CutEnd, Trellis, TrellisState, pose};
use crate::accuracy::Placer;
use crate::program::{MoveFeed, StraightMove};
use post_machine::kinematics::{Joints, Pose, Solver};

/// Turns about the tool, all around: every 5°.
const SPINS: usize = 72;

/// States of a point that are followed.
pub(super) const MOST_OF_LATTICE: usize = 4096;

/// No joint turns farther from one point to the next, radians.
const FARTHEST: f64 = 0.7;

/// Up to such a turn on one branch a cut is taken to come through, radians.
const NEAR: f64 = 0.2;

/// Nearer to the end of an axis a cut is tried, radians.
const SURE: f64 = 0.05;

/// States that a stand is tried from where it has to be tried.
const MOST_TRIED: usize = 3;

impl ChoiceAxes {
    /// Adds the stands of the lattice at `pose`, the joints in front of the arm as `last` has them.
    pub(super) fn lattice(
        &self,
        solver: &Solver,
        pose: &Pose,
        last: &Joints,
        stands: &mut Vec<AxisSolution>,
    ) {
        let found = solver.all_around(pose, last, self.axis_tolerance, SPINS);
        // What cannot stand there is no stand; why, is told by the usual search.
        let _ = self.keep_inside(solver, found, stands);
    }
}

/// A way on to a stand of the lattice.
struct WayOn {
    from: usize,
    joints: Joints,
    /// The largest turn of a joint, radians.
    turn: f64,
}

impl Trellis {
    /// Continues the states in a cut on the lattice: each stand from the state that is cheapest to come from.
    pub(super) fn lattice_on(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        before: Range<usize>,
        judge: &mut dyn CutChecker,
    ) {
        let Some(last) = self.layers.last() else {
            return;
        };
        let (from_pose, target) = (pose(&last.motion), pose(motion));
        let solver = placer.solver();
        let arm = solver.before_arm();
        let mut fronts: Vec<Joints> = Vec::new();
        for state in &self.states[before.clone()] {
            if !fronts.iter().any(|known| known[..arm] == state.joints[..arm]) {
                fronts.push(state.joints);
            }
        }
        let mut stands = Vec::new();
        for joints in &fronts {
            self.axes.lattice(solver, &target, joints, &mut stands);
        }
        for stand in &stands {
            let mut ways: Vec<WayOn> = Vec::new();
            for from in before.clone() {
                let state = &self.states[from];
                let alike = state.branch & !(ALONG | HEADING) == stand.branch
                    && state.joints[..arm] == stand.joints[..arm];
                if !alike || !state.cost.is_way() {
                    continue;
                }
                let Ok(joints) = self.axes.carried(stand, &state.joints) else {
                    continue;
                };
                let turn = self.axes.largest_turn(&state.joints, &joints);
                if turn <= FARTHEST && self.axes.reaches(&joints) {
                    ways.push(WayOn { from, joints, turn });
                }
            }
            self.cheapest(placer, motion, [&from_pose, &target], (ways, stand.branch), judge);
        }
    }

    /// Adds the cheapest way on to each set of full turns that comes through.
    fn cheapest(
        &mut self,
        placer: &Placer,
        motion: &StraightMove,
        [from_pose, target]: [&Pose; 2],
        (ways, branch): (Vec<WayOn>, u8),
        judge: &mut dyn CutChecker,
    ) {
        let mut ways: Vec<(TrellisState, f64)> = ways
            .iter()
            .map(|way| (self.after(way.from, way.joints, branch, 0), way.turn))
            .collect();
        ways.sort_by(|(a, _), (b, _)| a.cost.order(&b.cost));
        let first = self.states.len();
        let mut tried = 0;
        for (mut state, turn) in ways {
            let known = |known: &TrellisState| known.joints == state.joints;
            if self.states[first..].iter().any(known) {
                continue;
            }
            let stood = self.states[state.from].joints;
            // Between two points an axis can go farther than at both of them.
            if turn > NEAR || self.axes.near_end(&stood, &state.joints, turn.max(SURE)) {
                tried += 1;
                let ends = [(from_pose, &stood), (target, &state.joints)];
                let [from, to] = ends.map(|(pose, joints)| CutEnd { pose, joints });
                if tried > MOST_TRIED || !judge.passes(placer, motion, from, to) {
                    continue;
                }
            }
            let hits = judge.hits(placer, ArrivalKind::Cut, &stood, &state.joints);
            state.cost = state.cost.and_hits(hits);
            self.states.push(state);
        }
    }
}

impl Route<'_> {
    /// Goes back to where the tool came to the part, and looks for the pass anew on the lattice, up to this point; off the part
    /// for this point alone. False, and nothing changed, where there is no such way, or the machine is no arm whose tool may
    /// turn about itself.
    pub(super) fn try_lattice(&mut self, line: u64, motion: &StraightMove) -> bool {
        let layers = self.trellis.layers.len();
        let begins = motion.pace == MoveFeed::Rapid || layers == 0;
        if self.trellis.wide || self.machine.rewind.is_some() || !self.present().solver().spins() {
            return false;
        }
        // Off the part a stand in between may be inside travel, where those of the usual search are not.
        let back = if begins { Some(layers) } else { self.last_off_part() };
        let Some(back) = back else {
            return false;
        };
        let mut points = self.take_back(back);
        points.push((line, *motion));
        self.trellis.wide = true;
        if points.iter().all(|(line, motion)| self.goes_on(*line, motion)) {
            return true;
        }
        self.take_back(back);
        self.trellis.wide = false;
        points.pop();
        // So they went before.
        points.iter().all(|(line, motion)| self.goes_on(*line, motion));
        false
    }
}
