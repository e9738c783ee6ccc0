//! A run of cuts as columns: one number of all points side by side, so that a step of all points comes before the next
//! step. The operations are those of a single point in their order, so the bits are the same.
//!
//! What needs a choice, a point put in or a finding is a doubt: the run ends before that point, which goes its way as a
//! single point.

use nalgebra::Vector3;
use post_machine::axis_words::WordLanes;
use post_machine::kinematics::batch::{
    AxisBatch, Column, LANES, Lanes, Traces, VectorColumn, VectorLanes, groups, largest, least,
    set_vector, steps, vector, widely,
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

/// A run of cuts, in the columns of all stages. Each is filled in by one stage and read by those after it.
#[derive(Debug)]
pub(crate) struct RunColumns {
    /// Points.
    pub count: usize,
    /// Lines of the CL file.
    pub lines: [u64; LANES],
    /// Feeds of the tip against the part, mm/min.
    pub feeds: Lanes,
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
            feeds: [0.0; LANES],
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
        placer.words.print_rotary_all(&mut self.at, count, &mut self.printed);
        for (index, joint) in chain.joints().iter().enumerate() {
            if joint.rotary {
                let AxisBatch { joints, sines, cosines } = &mut self.at;
                sincos_all(&joints[index], count, &mut sines[index], &mut cosines[index]);
            }
        }
        for part in 0..3 {
            self.wanted[part].copy_from_slice(&self.tip[part][1..]);
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

    /// Puts a point elsewhere: at `node`, the rotary axes as they stand.
    pub(crate) fn replace(&mut self, lane: usize, node: &PathNode) {
        for joint in 0..MAX_AXES {
            self.joints[joint][lane + 1] = node.trace.joints[joint];
            self.words[joint][lane + 1] = node.words[joint];
            set_vector(&mut self.rates[joint], lane + 1, node.trace.tip_rates[joint]);
        }
        set_vector(&mut self.reached_tip, lane + 1, node.tip);
        set_vector(&mut self.reached_axis, lane + 1, node.trace.pose.axis);
        self.tip_error[lane + 1] = node.tip_error;
        self.axis_error[lane + 1] = node.axis_error;
    }

    /// All linear axes are well inside their travel.
    fn inside(&self, placer: &Placer) -> bool {
        let joints = placer.solver().chain().joints();
        let mut ends = [[0.0; 2]; MAX_AXES];
        widely(
            #[inline(always)]
            || {
                for (joint, ends) in ends.iter_mut().enumerate().take(joints.len()) {
                    let lanes = &self.at.joints[joint][..self.count];
                    *ends = [least(lanes), largest(lanes)];
                }
            },
        );
        let mut reach = placer.reach;
        for (_, [low, high]) in joints.iter().zip(ends).filter(|(joint, _)| !joint.rotary) {
            reach += larger(larger(0.0, high), -low);
        }
        let inside = INSIDE + 4.0 * placer.axis_rounding() * reach;
        placer.linear.iter().all(|limit| {
            let ([least, most], [low, high]) = (limit.travel, ends[limit.joint]);
            low > least + inside && high < most - inside
        })
    }

    /// Puts what was solved after the point before the run.
    fn take_over(&mut self, placer: &Placer) {
        let joints = placer.solver().chain().joints();
        for (index, joint) in joints.iter().enumerate() {
            self.joints[index][1..].copy_from_slice(&self.at.joints[index]);
            self.words[index][1..].copy_from_slice(&self.printed[index]);
            for part in 0..3 {
                if joint.rotary {
                    self.rates[index][part][1..]
                        .copy_from_slice(&self.traces.tip_rates[index][part]);
                }
            }
        }
        for part in 0..3 {
            self.reached_tip[part][1..].copy_from_slice(&self.traces.tip[part]);
            self.reached_axis[part][1..].copy_from_slice(&self.traces.axis[part]);
        }
    }

    /// How far tip and tool axis are off by rounding: see [`PathNode::measure`].
    fn measure(&mut self, placer: &Placer) -> bool {
        let count = self.count;
        let Self { reached_axis, axis, axis_error, reached_tip, tip, tip_error, .. } = self;
        let [mut chords, mut off] = [[0.0; LANES]; 2];
        let [chord, missed] = widely(
            #[inline(always)]
            || {
                distances(reached_axis, axis, count, &mut chords);
                distances(reached_tip, tip, count, &mut off);
                for lane in 0..groups(count) {
                    axis_error[lane + 1] = short_chord_angle(chords[lane]);
                }
                [largest(&chords[..count]), largest(&off[..count])]
            },
        );
        tip_error[1..].copy_from_slice(&off);
        chord < SHORT_CHORD && missed <= placer.tip_rounding()
    }

    /// Certifies the blocks: [`super::NodeMove::whole`] of each. The run ends before the first that the cheap bound does
    /// not clear.
    pub(crate) fn certify(&mut self, placer: &Placer, tolerances: MoveTolerances, keeps: bool) {
        let mut sums = BendLanes::new(placer);
        let [over, chord] = widely(
            #[inline(always)]
            || {
                sums.pass(self, placer);
                if keeps {
                    sums.bend = [0.0; LANES];
                }
                sums.bound(self, tolerances)
            },
        );
        if chord >= SHORT_CHORD {
            self.count = 0;
        }
        if over > 0.0 {
            self.end_before(|run, lane| !tolerances.hold(run.bound(lane)));
        }
        if placer.vectors.is_some() {
            self.end_before(|run, lane| {
                placer.led_elsewhere(&run.joints_before(lane), &run.joints_at(lane))
            });
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
        let count = self.count;
        let Self { reached_tip, way, words, .. } = self;
        let shortest = widely(
            #[inline(always)]
            || {
                steps(reached_tip, count, way);
                least(&way[..count])
            },
        );
        let changes = |word: &Column| (0..count).all(|lane| word[lane] != word[lane + 1]);
        if shortest > still && words.iter().any(changes) {
            return;
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

    /// Words of the block before.
    pub(crate) fn words_before(&self, lane: usize) -> [f64; MAX_AXES] {
        std::array::from_fn(|place| self.words[place][lane])
    }

    /// Words of a block.
    pub(crate) fn words_at(&self, lane: usize) -> [f64; MAX_AXES] {
        std::array::from_fn(|place| self.words[place][lane + 1])
    }
}

/// [`chord_angle`] of a length below [`SHORT_CHORD`].
#[inline(always)]
fn short_chord_angle(length: f64) -> f64 {
    // What is no number is of a lane after the last.
    let short = length < SHORT_CHORD;
    debug_assert!(!short || chord_angle(length) == certificate::short(length));
    certificate::short(length)
}

/// What a block bends by, and how large the numbers are that say so, of each block of a run.
struct BendLanes {
    /// Bounds on the second derivative of the tip, mm.
    bend: Lanes,
    /// Angles that the rotary axes turn by, radians.
    turns: Lanes,
    /// Lengths that add up to the place of the tip, mm.
    reach: Lanes,
    /// The largest angle, radians, at least 1.
    far: Lanes,
}

impl BendLanes {
    fn new(placer: &Placer) -> Self {
        Self {
            bend: [0.0; LANES],
            turns: [0.0; LANES],
            reach: [placer.reach; LANES],
            far: [1.0; LANES],
        }
    }

    /// Takes the blocks through all joints: [`certificate::quick`].
    #[inline(always)]
    fn pass(&mut self, run: &RunColumns, placer: &Placer) {
        let count = run.count;
        let joints = placer.solver().chain().joints();
        for (joint, values) in joints.iter().zip(&run.joints) {
            if joint.rotary {
                go_far(values, count, &mut self.far);
            } else {
                add_reach(values, count, &mut self.reach);
            }
        }
        for (index, _) in joints.iter().enumerate().rev().filter(|(_, it)| it.rotary) {
            let (values, rates) = (&run.joints[index], &run.rates[index]);
            pass_joint(values, rates, count, &mut self.bend, &mut self.turns);
        }
    }

    /// Fills in the bounds: [`super::NodeMove::whole`]. Gives the most by which one is over the tolerances, and the largest
    /// difference of unit vectors that an angle was taken of.
    #[inline(always)]
    fn bound(&self, run: &mut RunColumns, tolerances: MoveTolerances) -> [f64; 2] {
        let count = run.count;
        let mut between = [0.0; LANES];
        steps(&run.axis, count, &mut between);
        let [mut over, mut chords] = [[0.0; LANES]; 2];
        let ends = ErrorColumns { tip: &run.tip_error, axis: &run.axis_error };
        let bounds = (&mut run.tip_bound, &mut run.axis_bound);
        self.bound_lanes(count, &ends, &between, bounds, &mut chords);
        let RunColumns { tip_bound, axis_bound, .. } = run;
        for lane in 0..groups(count) {
            let tip = tip_bound[lane] - tolerances.tip;
            over[lane] = larger(tip, axis_bound[lane] - tolerances.axis);
        }
        [largest(&over[..count]), largest(&chords[..count])]
    }

    /// Fills in the bounds of tip and tool axis, and the differences of unit vectors that an angle was taken of.
    #[inline(always)]
    fn bound_lanes(
        &self,
        count: usize,
        errors: &ErrorColumns<'_>,
        between: &Lanes,
        (tip_bounds, axis_bounds): (&mut Lanes, &mut Lanes),
        chords: &mut Lanes,
    ) {
        for lane in 0..groups(count) {
            let sweep = short_chord_angle(between[lane]);
            let bends = self.turns[lane] * self.turns[lane] + sweep * sweep;
            let ends = larger(errors.axis[lane], errors.axis[lane + 1]);
            let axis = certificate::deviation(ends, bends);
            let margin = Placer::margin_of(self.reach[lane], self.far[lane]);
            let ends = larger(errors.tip[lane], errors.tip[lane + 1]);
            let tip = certificate::deviation(ends, self.bend[lane]);
            tip_bounds[lane] = tip + 0.0 + margin.tip;
            axis_bounds[lane] = short_chord_angle(axis) + margin.axis;
            chords[lane] = larger(axis, between[lane]);
        }
    }
}

/// How far the ends of blocks are off by rounding.
struct ErrorColumns<'a> {
    tip: &'a Column,
    axis: &'a Column,
}

/// Angles at the ends of blocks are so large.
#[inline(always)]
fn go_far(angles: &Column, count: usize, far: &mut Lanes) {
    for lane in 0..groups(count) {
        far[lane] = larger(far[lane], larger(angles[lane].abs(), angles[lane + 1].abs()));
    }
}

/// A linear axis adds to the reach.
#[inline(always)]
fn add_reach(values: &Column, count: usize, reach: &mut Lanes) {
    for lane in 0..groups(count) {
        reach[lane] += larger(values[lane].abs(), values[lane + 1].abs());
    }
}

/// Takes blocks beyond a rotary joint: [`certificate::pass`].
#[inline(always)]
fn pass_joint(
    angles: &Column,
    rates: &VectorColumn,
    count: usize,
    bends: &mut Lanes,
    turns: &mut Lanes,
) {
    for lane in 0..groups(count) {
        // A joint that stands adds zeros.
        let angle = (angles[lane + 1] - angles[lane]).abs();
        let ends = (vector(rates, lane), vector(rates, lane + 1));
        let (mut bend, mut turn) = (bends[lane], turns[lane]);
        certificate::pass(angle, ends, &mut bend, &mut turn);
        (bends[lane], turns[lane]) = (bend, turn);
    }
}

/// Distances of the points of two columns, the first aside.
#[inline(always)]
fn distances(a: &VectorColumn, b: &VectorColumn, count: usize, out: &mut Lanes) {
    for (lane, distance) in out[..groups(count)].iter_mut().enumerate() {
        *distance = (vector(a, lane + 1) - vector(b, lane + 1)).norm();
    }
}
