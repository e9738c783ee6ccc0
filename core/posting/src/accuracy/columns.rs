//! A run of cuts as columns: one number of all points side by side, so that a step of all points comes before the next
//! step. The operations are those of a single point in their order, so the bits are the same.
//!
//! What needs a choice, a point put in or a finding is a doubt: the run ends before that point, which goes its way as a
//! single point.

use nalgebra::Vector3;
use post_machine::axis_words::WordLanes;
use post_machine::kinematics::batch::{
    AxisBatch, Column, LANES, Lanes, Traces, VectorColumn, VectorLanes, set_vector, vector,
};
use post_machine::kinematics::lane_math::sincos_all;
use post_machine::kinematics::orientation::LatitudeLanes;
use post_machine::kinematics::{Joints, MAX_AXES, Pose, Turns};

use super::bound::DeviationBound;
use super::certificate::{self, chord_angle, larger};
use super::deviation::MoveTolerances;
use super::node::{PathNode, Placer};

/// Linear axes of a run are so far inside their travel, mm, and by what rounding the rotary words can move them, that
/// neither solving nor rounding takes one out of it.
const INSIDE: f64 = 0.1;

/// Up to this difference of two unit vectors [`chord_angle`] is a formula without a branch.
const SHORT_CHORD: f64 = 0.1;

/// A run of cuts at one feed, in the columns of all stages. Each is filled in by one stage and read by those after it.
#[derive(Debug)]
pub(crate) struct RunColumns {
    /// Points.
    pub count: usize,
    /// Lines of the CL file.
    pub lines: [u64; LANES],
    /// Feed of the tip against the part, mm/min.
    pub feed: f64,
    /// Wanted tip, mm, and tool axis, part frame.
    pub tip: VectorColumn,
    pub axis: VectorColumn,
    /// How far the wanted axes are from the poles.
    pub latitudes: LatitudeLanes,
    /// Largest angle that the tool axis goes between two points, radians.
    pub arc: f64,
    /// Axis values as printed, with their sines and cosines.
    pub at: AxisBatch,
    /// Rotary values as they are chosen, before anything is printed, by joint.
    pub angles: [Lanes; MAX_AXES],
    /// Axis values as printed, by joint.
    pub joints: [Column; MAX_AXES],
    /// Words by place.
    pub words: [Column; MAX_AXES],
    /// Where the chain stands at the printed words.
    pub reached_tip: VectorColumn,
    pub reached_axis: VectorColumn,
    /// How the tip goes with each rotary joint, mm a radian.
    pub rates: [VectorColumn; MAX_AXES],
    pub tip_error: Column,
    pub axis_error: Column,
    /// Certified deviations: tip, mm, and tool axis, radians.
    pub tip_bound: Lanes,
    pub axis_bound: Lanes,
    /// Way of the tip, mm.
    pub way: Lanes,
    /// The least time in which the linear axes follow, minutes, and the joint that asks for it.
    pub follow: Lanes,
    traces: Traces,
    printed: WordLanes,
    wanted: VectorLanes,
}

impl Default for RunColumns {
    fn default() -> Self {
        const EMPTY: Column = [0.0; LANES + 1];
        Self {
            count: 0,
            lines: [0; LANES],
            feed: 0.0,
            tip: [EMPTY; 3],
            axis: [EMPTY; 3],
            latitudes: LatitudeLanes::default(),
            arc: 0.0,
            at: AxisBatch::default(),
            angles: [[0.0; LANES]; MAX_AXES],
            joints: [EMPTY; MAX_AXES],
            words: [EMPTY; MAX_AXES],
            reached_tip: [EMPTY; 3],
            reached_axis: [EMPTY; 3],
            rates: [[EMPTY; 3]; MAX_AXES],
            tip_error: EMPTY,
            axis_error: EMPTY,
            tip_bound: [0.0; LANES],
            axis_bound: [0.0; LANES],
            way: [0.0; LANES],
            follow: [0.0; LANES],
            traces: Traces::default(),
            printed: [[0.0; LANES]; MAX_AXES],
            wanted: [[0.0; LANES]; 3],
        }
    }
}

impl RunColumns {
    /// Most points of a run.
    pub(crate) const MOST: usize = LANES;

    /// Takes over the node that the run begins at; false if that is not the point that the axis values were chosen from.
    pub(crate) fn begin(&mut self, before: &PathNode) -> bool {
        if vector(&self.axis, 0) != before.target.axis {
            return false;
        }
        set_vector(&mut self.tip, 0, before.target.tip);
        set_vector(&mut self.reached_tip, 0, before.tip);
        set_vector(&mut self.reached_axis, 0, before.trace.pose.axis);
        for joint in 0..MAX_AXES {
            self.joints[joint][0] = before.trace.joints[joint];
            self.words[joint][0] = before.words[joint];
            set_vector(&mut self.rates[joint], 0, before.trace.tip_rates[joint]);
        }
        self.tip_error[0] = before.tip_error;
        self.axis_error[0] = before.axis_error;
        true
    }

    /// The node of a point: 0 is the one before the run.
    pub(crate) fn node(&self, placer: &Placer, place: usize) -> PathNode {
        let mut node = PathNode {
            t: 1.0,
            target: Pose {
                tip: vector(&self.tip, place),
                axis: vector(&self.axis, place),
                edge: Vector3::zeros(),
            },
            ..PathNode::default()
        };
        for joint in 0..MAX_AXES {
            node.trace.joints[joint] = self.joints[joint][place];
            node.words[joint] = self.words[joint][place];
        }
        let chain = placer.solver().chain();
        node.trace.turns = match place.checked_sub(1) {
            Some(lane) => Turns::of_lane(&self.at, lane),
            None => chain.turns(&node.trace.joints),
        };
        chain.trace(&mut node.trace);
        node.tip = node.trace.pose.tip;
        node.tip_error = self.tip_error[place];
        node.axis_error = self.axis_error[place];
        node
    }

    /// Solves the points as they will be printed: [`Placer::settle`] of each. The run ends before a point whose
    /// forward product misses; false on any other doubt.
    pub(crate) fn settle(&mut self, placer: &Placer) -> bool {
        let solver = placer.solver();
        let chain = solver.chain();
        let point = placer.control_point();
        if point.along != 0.0 || point.radius != 0.0 || chain.edge().is_some() {
            return false;
        }
        let count = self.count;
        if !placer.words.print_rotary_all(&mut self.at, count, &mut self.printed) {
            return false;
        }
        for (index, joint) in chain.joints().iter().enumerate() {
            if joint.rotary {
                let AxisBatch { joints, sines, cosines } = &mut self.at;
                sincos_all(&joints[index], count, &mut sines[index], &mut cosines[index]);
            }
        }
        for part in 0..3 {
            self.wanted[part][..count].copy_from_slice(&self.tip[part][1..=count]);
        }
        let Some(kept) = placer.words.print_tip_all(&mut self.wanted, count, &mut self.printed)
        else {
            return false;
        };
        if !solver.place_all(&self.wanted, count, &mut self.at) {
            return false;
        }
        if !kept {
            placer.words.print_linear_all(&mut self.at, count, &mut self.printed);
        }
        if !self.inside(placer) {
            return false;
        }
        chain.trace_all(&self.at, count, &mut self.traces);
        self.take_over(placer);
        self.measure(placer)
    }

    /// All linear axes are well inside their travel.
    fn inside(&self, placer: &Placer) -> bool {
        let joints = placer.solver().chain().joints().iter().enumerate();
        let mut reach = placer.reach;
        for (index, _) in joints.filter(|(_, joint)| !joint.rotary) {
            let lanes = &self.at.joints[index][..self.count];
            reach += lanes.iter().fold(0.0, |most, value| larger(most, value.abs()));
        }
        let inside = INSIDE + 4.0 * placer.axis_rounding() * reach;
        placer.linear.iter().all(|limit| {
            let [least, most] = limit.travel;
            let lanes = &self.at.joints[limit.joint][..self.count];
            let low = lanes
                .iter()
                .fold(f64::INFINITY, |low, value| if *value < low { *value } else { low });
            let high = lanes.iter().fold(f64::NEG_INFINITY, |high, value| larger(high, *value));
            low > least + inside && high < most - inside
        })
    }

    /// Puts what was solved after the point before the run.
    fn take_over(&mut self, placer: &Placer) {
        let count = self.count;
        let joints = placer.solver().chain().joints();
        for (index, joint) in joints.iter().enumerate() {
            self.joints[index][1..=count].copy_from_slice(&self.at.joints[index][..count]);
            self.words[index][1..=count].copy_from_slice(&self.printed[index][..count]);
            for part in 0..3 {
                if joint.rotary {
                    let rates = &self.traces.tip_rates[index][part][..count];
                    self.rates[index][part][1..=count].copy_from_slice(rates);
                }
            }
        }
        for part in 0..3 {
            let (tip, axis) = (&self.traces.tip[part], &self.traces.axis[part]);
            self.reached_tip[part][1..=count].copy_from_slice(&tip[..count]);
            self.reached_axis[part][1..=count].copy_from_slice(&axis[..count]);
        }
    }

    /// How far tip and tool axis are off by rounding: see [`PathNode::measure`].
    fn measure(&mut self, placer: &Placer) -> bool {
        let mut chord: f64 = 0.0;
        let mut missed: f64 = 0.0;
        for place in 1..=self.count {
            let off = (vector(&self.reached_axis, place) - vector(&self.axis, place)).norm();
            chord = larger(chord, off);
            self.axis_error[place] = short_chord_angle(off);
            let off = (vector(&self.reached_tip, place) - vector(&self.tip, place)).norm();
            missed = larger(missed, off);
            self.tip_error[place] = off;
        }
        chord < SHORT_CHORD && missed <= placer.tip_rounding()
    }

    /// Certifies the blocks: [`super::NodeMove::whole`] of each. The run ends before the first that the cheap bound does
    /// not clear.
    pub(crate) fn certify(&mut self, placer: &Placer, tolerances: MoveTolerances, keeps: bool) {
        let count = self.count;
        let chain = placer.solver().chain();
        let [mut bend, mut turns, mut reach, mut far] = [[0.0; LANES]; 4];
        reach[..count].fill(placer.reach);
        far[..count].fill(1.0);
        for (index, joint) in chain.joints().iter().enumerate() {
            let joints = &self.joints[index];
            for lane in 0..count {
                let value = larger(joints[lane].abs(), joints[lane + 1].abs());
                if joint.rotary {
                    far[lane] = larger(far[lane], value);
                } else {
                    reach[lane] += value;
                }
            }
        }
        for (index, _) in chain.joints().iter().enumerate().rev().filter(|(_, it)| it.rotary) {
            let (joints, rates) = (&self.joints[index], &self.rates[index]);
            for lane in 0..count {
                // A joint that stands adds zeros.
                let angle = (joints[lane + 1] - joints[lane]).abs();
                let ends = (vector(rates, lane), vector(rates, lane + 1));
                certificate::pass(angle, ends, &mut bend[lane], &mut turns[lane]);
            }
        }
        let (mut over, mut chord): (f64, f64) = (0.0, 0.0);
        for lane in 0..count {
            let between = (vector(&self.axis, lane) - vector(&self.axis, lane + 1)).norm();
            let sweep = short_chord_angle(between);
            let bends = turns[lane] * turns[lane] + sweep * sweep;
            let ends = larger(self.axis_error[lane], self.axis_error[lane + 1]);
            let axis = certificate::deviation(ends, bends);
            let margin = Placer::margin_of(reach[lane], far[lane]);
            let ends = larger(self.tip_error[lane], self.tip_error[lane + 1]);
            let tip = certificate::deviation(ends, if keeps { 0.0 } else { bend[lane] });
            let bound = DeviationBound {
                tip: tip + 0.0 + margin.tip,
                axis: short_chord_angle(axis) + margin.axis,
            };
            (self.tip_bound[lane], self.axis_bound[lane]) = (bound.tip, bound.axis);
            over = larger(over, larger(bound.tip - tolerances.tip, bound.axis - tolerances.axis));
            chord = larger(chord, larger(axis, between));
        }
        if chord >= SHORT_CHORD {
            self.count = 0;
        }
        if over > 0.0 {
            self.end_before(|run, lane| !tolerances.hold(run.bound(lane)));
        }
        if placer.shown.is_empty() {
            return;
        }
        self.end_before(|run, lane| {
            let turn =
                |joint: &usize| (run.joints[*joint][lane + 1] - run.joints[*joint][lane]).abs();
            placer.shown.iter().any(|joint| turn(joint) > super::node::LONGEST)
        });
    }

    /// Fills in the ways of the tip. The run ends before a block that moves nothing, or the tip no more than `still` mm.
    pub(crate) fn measure_ways(&mut self, still: f64) {
        for lane in 0..self.count {
            let way = vector(&self.reached_tip, lane + 1) - vector(&self.reached_tip, lane);
            self.way[lane] = way.norm();
        }
        self.end_before(|run, lane| {
            // A word has changed wherever the tip moves so far: but that is what the block is judged by.
            let same = |word: &Column| word[lane] == word[lane + 1];
            run.way[lane] <= still || run.words.iter().all(same)
        });
    }

    /// The run ends before the first point that is in doubt.
    pub(crate) fn end_before(&mut self, doubt: impl Fn(&Self, usize) -> bool) {
        let first = (0..self.count).find(|lane| doubt(self, *lane));
        self.count = first.unwrap_or(self.count);
    }

    /// The certified deviation of a block.
    pub(crate) fn bound(&self, lane: usize) -> DeviationBound {
        DeviationBound { tip: self.tip_bound[lane], axis: self.axis_bound[lane] }
    }

    /// Axis values at the end of a block, as printed.
    pub(crate) fn joints_at(&self, lane: usize) -> Joints {
        std::array::from_fn(|joint| self.joints[joint][lane + 1])
    }

    /// Axis values at the start of a block, as printed.
    pub(crate) fn joints_before(&self, lane: usize) -> Joints {
        std::array::from_fn(|joint| self.joints[joint][lane])
    }

    /// Words of a block.
    pub(crate) fn words_at(&self, lane: usize) -> [f64; MAX_AXES] {
        std::array::from_fn(|place| self.words[place][lane + 1])
    }
}

/// [`chord_angle`] of a length below [`SHORT_CHORD`].
#[inline(always)]
fn short_chord_angle(length: f64) -> f64 {
    debug_assert!(length >= SHORT_CHORD || chord_angle(length) == certificate::short(length));
    certificate::short(length)
}
