//! Legs of the smooth curve become samples of the path as the planner's limits see it.

use std::rc::Rc;

use nalgebra::Vector3;
use post_feed::fit::{self, CurveSample};
use post_feed::jerk::PathBatch;
use post_feed::limits::Limit;
use post_feed::{EndSpeeds, Infeasible, Problem, Samples};
use post_machine::kinematics::{JointDerivatives, Joints, MAX_AXES, ORDERS, Unreachable};

use super::limits::SampledAxes;
use crate::accuracy::Placer;

/// Axes of the chain, and the coordinates of the tip after them.
pub(super) const MOST: usize = MAX_AXES + 3;

/// Samples that are handed to the solver together.
const BATCH: usize = 128;

/// First to third derivative of each axis.
pub(super) type AxisDerivatives = [[f64; 3]; MOST];

/// The path at one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathDerivatives {
    /// First to third derivative of the control point, mm, part frame.
    pub tip: [[f64; 3]; 3],
    /// Derivatives of each axis, mm or radians.
    pub axes: AxisDerivatives,
    /// How each axis moves the control point.
    rates: [[f64; 3]; MOST],
    /// Where that is, mm, part frame.
    at: [f64; 3],
    /// All of it that the chain knows.
    course: JointDerivatives,
}

/// A sample as observers see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct WatchedSample {
    /// The control point and its derivatives.
    pub tip: [[f64; 3]; ORDERS],
    pub course: JointDerivatives,
}

impl PathDerivatives {
    /// Makes the path at a sample of the control point with its derivatives (mm, part frame), and of the axes that follow it.
    fn new(tip: &[[f64; 3]; ORDERS], course: JointDerivatives, sampled: SampledAxes) -> Self {
        let mut place = Self {
            tip: [tip[1], tip[2], tip[3]],
            axes: [[0.0; 3]; MOST],
            rates: [[0.0; 3]; MOST],
            at: tip[0],
            course,
        };
        let count = sampled.of_chain;
        for axis in 0..count {
            place.axes[axis] = [1, 2, 3].map(|order: usize| course.joints[order][axis]);
            place.rates[axis] = course.rates[axis].into();
        }
        if sampled.programmed {
            for (coordinate, axis) in place.axes[count..count + 3].iter_mut().enumerate() {
                *axis = [1, 2, 3].map(|order: usize| tip[order][coordinate]);
            }
        }
        place
    }

    /// Appends it as a sample, without what its block says.
    fn put(&self, at: f64, sampled: SampledAxes, samples: &mut Samples) {
        let count = sampled.count();
        samples.push(at, self.tip, &self.axes[..count]);
        samples.push_rates(&self.rates[..count]);
    }

    /// Makes the sample that observers see.
    pub(super) fn stand(&self) -> WatchedSample {
        let [first, second, third] = self.tip;
        WatchedSample { tip: [self.at, first, second, third], course: self.course }
    }

    /// Speed of the control point for that of the parameter.
    pub(super) fn stretch(&self) -> f64 {
        self.tip[0].iter().map(|part| part * part).sum::<f64>().sqrt()
    }
}

impl SampledAxes {
    /// Appends a sample of a path: its parameter, the point that the axes lead and its derivatives (mm, part frame), and the
    /// axes with theirs, as [`super::limits()`] take them.
    pub fn push(
        self,
        samples: &mut Samples,
        parameter: f64,
        tip: &[[f64; 3]; ORDERS],
        course: &JointDerivatives,
    ) {
        PathDerivatives::new(tip, *course, self).put(parameter, self, samples);
    }
}

/// What a block says of its samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleBlock {
    /// The feed of the control point that the CL file asks for, mm/s.
    pub feed: f64,
    /// Length of the block, in units of the parameter.
    pub length: f64,
    /// The share of the contour error that it may have.
    pub share: f64,
}

/// Makes batches of samples.
#[derive(Debug)]
pub(super) struct Sampler {
    placer: Rc<Placer>,
    /// Places of the rotary axes that the curve has coordinates of.
    rotary: Vec<usize>,
    /// Where the other axes stand.
    held: Joints,
    axes: SampledAxes,
    samples: Samples,
    problem: Problem,
    /// The last sample, which the next batch begins with.
    last: Option<(PathDerivatives, SampleBlock)>,
    at: f64,
    /// What a corner at its first sample allows.
    corner: Option<f64>,
}

impl Sampler {
    pub(super) fn new(placer: Rc<Placer>, axes: SampledAxes, held: &Joints) -> Self {
        let joints = placer.solver().chain().joints().iter().enumerate();
        let rotary = joints.filter(|(_, joint)| joint.rotary).map(|(place, _)| place);
        Self {
            rotary: rotary.collect(),
            placer,
            held: *held,
            axes,
            // The curve is a quintic.
            samples: Samples { smooth: true, ..Samples::default() },
            problem: Problem::default(),
            last: None,
            at: 0.0,
            corner: None,
        }
    }

    /// Coordinates of the curve: the control point, and the rotary axes.
    pub(super) fn dimensions(&self) -> usize {
        3 + self.rotary.len()
    }

    /// A stance as a point of the curve.
    pub(super) fn point(&self, tip: Vector3<f64>, joints: &Joints) -> fit::FitPoint {
        let mut point = [0.0; fit::MOST];
        point[..3].copy_from_slice(tip.as_slice());
        for (coordinate, place) in point[3..].iter_mut().zip(&self.rotary) {
            *coordinate = joints[*place];
        }
        point
    }

    /// Axes of each sample.
    pub(super) fn count(&self) -> usize {
        self.axes.count()
    }

    /// The path at a sample of the curve.
    ///
    /// # Errors
    /// The linear axes cannot follow.
    pub(super) fn place(&self, sample: &CurveSample) -> Result<PathDerivatives, Unreachable> {
        let mut course = JointDerivatives::default();
        course.joints[0] = self.held;
        for order in 0..ORDERS {
            for (coordinate, place) in self.rotary.iter().enumerate() {
                course.joints[order][*place] = sample.values[order][3 + coordinate];
            }
        }
        let tip = sample.values.map(|value| Vector3::new(value[0], value[1], value[2]));
        self.placer.solver().course(&tip, &mut course)?;
        Ok(PathDerivatives::new(&tip.map(Into::into), course, self.axes))
    }

    /// The last sample; none where the path begins.
    pub(super) fn last(&self) -> Option<&PathDerivatives> {
        self.last.as_ref().map(|(place, _)| place)
    }

    /// The path goes on from a corner with its own derivatives, and no faster than `q` there.
    pub(super) fn corner(&mut self, place: &PathDerivatives, said: SampleBlock, q: f64) {
        self.samples.clear();
        self.put(place, said);
        self.corner = Some(q);
    }

    /// What a block says holds from the last sample on.
    pub(super) fn enter(&mut self, said: SampleBlock) {
        if let Some((_, last)) = &mut self.last {
            *last = said;
        }
        if let Some(feed) = self.samples.feeds.last_mut() {
            *feed = said.feed;
        }
        if let Some(length) = self.samples.blocks.last_mut() {
            *length = said.length;
        }
        if let Some(share) = self.samples.contour_share.last_mut() {
            *share = share.min(said.share);
        }
    }

    /// The path goes on by `way` to this sample, or begins there.
    pub(super) fn push(&mut self, place: &PathDerivatives, said: SampleBlock, way: f64) {
        self.at += way;
        self.put(place, said);
    }

    fn put(&mut self, place: &PathDerivatives, said: SampleBlock) {
        place.put(self.at, self.axes, &mut self.samples);
        self.samples.feeds.push(said.feed);
        self.samples.blocks.push(said.length);
        self.samples.contour_share.push(said.share);
        self.last = Some((*place, said));
    }

    /// Whether there are so many that the solver should have them.
    pub(super) fn is_full(&self) -> bool {
        self.samples.len() > BATCH
    }

    /// The samples gathered so far as a problem, and a new batch that begins with the last of them; none where there is
    /// no way between them.
    ///
    /// # Errors
    /// What no limit bounds, or is not a number.
    pub(super) fn batch<'b>(
        &'b mut self,
        limits: &'b [&'b dyn Limit],
    ) -> Result<Option<PathBatch<'b>>, Infeasible> {
        if self.samples.len() < 2 {
            return Ok(None);
        }
        let found = self.problem.refill(&self.samples, limits, EndSpeeds::default());
        let corner = self.corner.take();
        if let Some(q) = corner {
            self.problem.lower(0, q, super::CORNER);
        }
        found.map(|()| {
            Some(PathBatch {
                samples: &self.samples,
                limits,
                problem: &self.problem,
                corner: corner.is_some(),
            })
        })
    }

    /// The batch was taken: the next begins with its last sample.
    pub(super) fn next(&mut self) {
        self.samples.clear();
        self.at = 0.0;
        if let Some((place, said)) = self.last {
            self.put(&place, said);
        }
    }

    /// The path ends.
    pub(super) fn end(&mut self) {
        self.samples.clear();
        self.last = None;
        self.corner = None;
        self.at = 0.0;
    }
}
