//! Axis values of a run of cuts on one branch, far from poles and from the ends of travel: nothing is to be chosen, and
//! each point goes on from the one before.

use std::f64::consts::{PI, TAU};

use post_machine::kinematics::Joints;
use post_machine::kinematics::batch::{
    LANES, Lanes, VectorColumn, groups, largest, least, set_vector, steps, vector, widely,
};

use super::ConfigurationStage;
use super::route::Route;
use super::trellis::{ArrivalKind, HELD, Trellis, pose};
use crate::accuracy::{Placer, RunColumns};
use crate::program::{MoveFeed, StraightMove};

/// Between two points of a run the tool axis turns by less, as a difference of unit vectors.
const LONGEST_CHORD: f64 = 0.5;

/// Least and largest of some numbers.
#[inline(always)]
fn ends(of: &[f64]) -> [f64; 2] {
    [least(of), largest(of)]
}

impl ConfigurationStage<'_> {
    /// Takes the axis values of a run: [`ConfigurationStage::take`] of its points, where each is decided at once. False
    /// on any doubt; nothing is changed yet.
    pub(crate) fn carries_on(&self, run: &mut RunColumns) -> bool {
        let ready = self.in_use
            && self.waiting.is_empty()
            && self.machine.control_point.along == 0.0
            && self.setting == Some(self.route.setting)
            && !self.route.has_chosen();
        if !ready {
            return false;
        }
        // The control point is the tip: a zero is added, whose sign counts.
        let RunColumns { tip, axis, count, .. } = run;
        widely(
            #[inline(always)]
            || add_zeros(tip, axis, *count),
        );
        self.route.carries_on(run)
    }

    /// The points of the run were taken; false, and nothing changed, if its last point is in doubt by itself.
    pub(crate) fn carry_on(&mut self, run: &RunColumns) -> bool {
        let taken = self.route.carry_on(run);
        self.moves += if taken { run.count as u64 } else { 0 };
        taken
    }
}

impl Route<'_> {
    fn carries_on(&self, run: &mut RunColumns) -> bool {
        self.anchored && !self.tries_positions && self.trellis.carries_on(run, self.present())
    }

    fn carry_on(&mut self, run: &RunColumns) -> bool {
        let setting = self.setting;
        let placer = &self.settings[setting].1;
        self.trellis.carry_on(run, setting, placer)
    }
}

impl Trellis {
    /// See [`Trellis::step`], which this is for many points.
    fn carries_on(&self, run: &mut RunColumns, placer: &Placer) -> bool {
        let ([layer], [state]) = (self.layers.as_slice(), self.states.as_slice()) else {
            return false;
        };
        let count = run.count;
        if state.branch == HELD || !self.axes.turns_freely() {
            return false;
        }
        set_vector(&mut run.axis, 0, layer.motion.axis);
        let mut chords = [0.0; LANES];
        let mut chord = longest_step(&run.axis, count, &mut chords);
        if chord >= LONGEST_CHORD {
            // A point that is turned to from afar goes by itself.
            run.end_before(|_, lane| chords[lane] >= LONGEST_CHORD);
            chord = largest(&chords[..run.count]);
        }
        let count = run.count;
        if count == 0 {
            return false;
        }
        let RunColumns { axis, at, latitudes, .. } = run;
        let lanes = |part: usize| axis[part].last_chunk();
        let (Some(i), Some(j), Some(k)) = (lanes(0), lanes(1), lanes(2)) else {
            return false;
        };
        let branch = usize::from(state.branch);
        if !placer.solver().angles_all(
            [i, j, k],
            branch,
            self.axes.axis_tolerance,
            count,
            at,
            latitudes,
        ) {
            return false;
        }
        run.arc = 1.02 * chord;
        let latitudes = &run.latitudes;
        let [[sine, _], cosines] = widely(
            #[inline(always)]
            || [ends(&latitudes.sines[..count]), ends(&latitudes.cosines[..count])],
        );
        if self.eased(sine) || !self.axes.all_far(sine, cosines, run.arc + 2.0 * self.freedom) {
            return false;
        }
        let way = 2.0 * run.arc;
        self.axes.turning.iter().all(|axis| {
            let joint = axis.joint;
            let angles = &mut run.at.joints[joint];
            go_on(angles, count, state.joints[joint]);
            run.angles[joint] = *angles;
            let Some([least, most]) = axis.travel else {
                return true;
            };
            let [low, high] = widely(
                #[inline(always)]
                || ends(&angles[..count]),
            );
            let way = if axis.first { 0.0 } else { way };
            let last = state.joints[joint];
            low >= least
                && high <= most
                && low.min(last) - least >= way
                && most - high.max(last) >= way
        })
    }

    /// Stands at the end of the run.
    fn carry_on(&mut self, run: &RunColumns, setting: usize, placer: &Placer) -> bool {
        let ([layer], [state]) = (self.layers.as_mut_slice(), self.states.as_mut_slice()) else {
            return false;
        };
        let motion = StraightMove {
            tip: vector(&run.tip, run.count),
            axis: vector(&run.axis, run.count),
            edge: nalgebra::Vector3::zeros(),
            pace: MoveFeed::PerMinute(run.feeds[run.count - 1]),
            chord: 0.0,
        };
        let last = run.count - 1;
        let before: Joints = match last.checked_sub(1) {
            Some(lane) => std::array::from_fn(|joint| run.angles[joint][lane]),
            None => state.joints,
        };
        // The last point by itself: it has the linear axes too.
        let solver = placer.solver();
        let target = pose(&motion);
        let Ok(branches) = solver.orient(&target, self.axes.axis_tolerance) else {
            return false;
        };
        let at = (&branches, state.branch);
        let joints = self.axes.carried_on(solver, &target, at, &before, 2.0 * run.arc);
        let Some(joints) = joints else {
            return false;
        };
        state.joints = joints;
        layer.line = run.lines[last];
        layer.motion = motion;
        layer.kind = ArrivalKind::Cut;
        layer.setting = setting;
        layer.latitude = branches.latitude();
        true
    }
}

/// Puts angles on the turns nearest to the angle before each: see [`super::solution::ChoiceAxes::carried`].
fn go_on(angles: &mut Lanes, count: usize, before: f64) {
    let jump = widely(
        #[inline(always)]
        || longest_jump(angles, count),
    );
    if (before - angles[0]).abs() <= PI && jump <= PI {
        return;
    }
    let mut last = before;
    for angle in &mut angles[..count] {
        let away = last - *angle;
        if away.abs() > PI {
            *angle += TAU * f64::round(away / TAU);
        }
        last = *angle;
    }
}

/// The largest difference of an angle from the one before.
#[inline(always)]
fn longest_jump(angles: &Lanes, count: usize) -> f64 {
    let mut jumps = [0.0; LANES];
    for lane in 1..LANES {
        jumps[lane] = (angles[lane - 1] - angles[lane]).abs();
    }
    largest(&jumps[..count])
}

/// The longest step from a place to the next, and all of them.
fn longest_step(of: &VectorColumn, count: usize, all: &mut Lanes) -> f64 {
    widely(
        #[inline(always)]
        || {
            steps(of, count, all);
            largest(&all[..count])
        },
    )
}

/// Adds axes of no length to tips.
#[inline(always)]
fn add_zeros(tips: &mut VectorColumn, axes: &VectorColumn, count: usize) {
    for (tips, axes) in tips.iter_mut().zip(axes) {
        for lane in 0..groups(count) {
            tips[lane + 1] += axes[lane + 1] * 0.0;
        }
    }
}
