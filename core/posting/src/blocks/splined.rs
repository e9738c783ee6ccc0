//! Splines of the CL file that stay splines: one block, its control points and knots printed and certified.

use super::{
    AxisTravels, BlockKind, BlockReason, BlockSink, BlockStage, FollowTime, MotionBlock,
    NominalTime, PathLeg,
};
use crate::accuracy::{DeviationBound, PathNode, WordFrame};
use crate::configuration::pose;
use crate::curve::{CurveWords, PrintedCurve};
use crate::program::StraightMove;
use crate::program::spline::{cubics, over};
use nalgebra::Vector3;
use post_machine::kinematics::Joints;
use post_machine::kinematics::travel::{AT_END, passed};
use post_motion::path::BSpline;

/// The last knot as it is printed: any multiple of the knots is the same spline, and so they have three digits more.
const LAST_KNOT: f64 = 1000.0;

/// A spline as it is printed.
pub(super) struct SplineBlock {
    node: Box<PathNode>,
    curve: PrintedCurve,
    bound: DeviationBound,
}

/// Places between the ends by which a feed is planned: this many a knot span.
const PLACES: u32 = 16;

/// Places along a spline between its ends, mm, part frame.
fn places(printed: &BSpline, frame: &WordFrame<'_>) -> Vec<Vector3<f64>> {
    let mut places: Vec<Vector3<f64>> = cubics(printed)
        .flat_map(|[a, b, c, d]| {
            (1..=PLACES).map(move |place| {
                let t = f64::from(place) / f64::from(PLACES);
                let s = 1.0 - t;
                (a * s + b * (3.0 * t)) * (s * s) + (c * (3.0 * s) + d * t) * (t * t)
            })
        })
        .map(|place| frame.in_part(place))
        .collect();
    places.pop();
    places
}

impl BlockStage<'_> {
    /// Hands on the block along a spline of so many mm, with its line and the move to its end.
    pub(super) fn push_spline(
        &mut self,
        frame: &WordFrame<'_>,
        (line, motion): (u64, &StraightMove),
        spline: SplineBlock,
        way: f64,
        out: &mut BlockSink<'_>,
    ) {
        let leg = PathLeg {
            placer: frame.placer,
            line,
            motion,
            loose: false,
            reason: BlockReason::Point,
        };
        // Whatever its direction, no axis goes faster than the tool.
        let mut follow = FollowTime::default();
        for (joint, slide) in frame.slides() {
            let minutes = way * slide.norm() / self.machine.axes[*joint].max_feed;
            if minutes > follow.minutes {
                follow = FollowTime { minutes, joint: *joint };
            }
        }
        let block = MotionBlock {
            kind: BlockKind::Spline,
            way,
            nominal: NominalTime::of(motion.pace, way, AxisTravels::default),
            follow,
            ..self.block(&leg, &spline.node, spline.bound)
        };
        self.largest.keep(&leg, spline.bound);
        self.push_curve(block, spline.curve, out);
        self.spare = self.last.replace(spline.node);
        self.on_part = true;
    }

    /// The block along a spline of the control point, if that can be.
    pub(super) fn spline_block(
        &self,
        frame: &WordFrame<'_>,
        spline: &BSpline,
        end: &StraightMove,
    ) -> Option<SplineBlock> {
        let last = self.last.as_deref()?;
        // No dialect declares splines inside a tilted plane; how fast legs go along one is not known.
        if self.compensating || self.in_plane() || self.driven {
            return None;
        }
        let node = frame.placer.settled(pose(end), 1.0, &last.trace.joints).ok()?;
        let wanted = spline.clone().placed(|point| frame.point(point));
        let inner = &wanted.poles[1..wanted.poles.len() - 1];
        let mut words = last.words[..frame.placer.count()].to_vec();
        let mut points: Vec<Vector3<f64>> = vec![frame.placer.printed(last)?];
        for (point, _) in inner {
            let (printed, mm) = frame.placer.printed_point(*point)?;
            words
                .extend_from_slice(&frame.placer.with_point(last, printed)[..frame.placer.count()]);
            points.push(mm);
        }
        words.extend_from_slice(&node.words[..frame.placer.count()]);
        points.push(frame.placer.printed(&node)?);
        let knots = wanted.knots.iter();
        let knots: Option<Vec<f64>> =
            knots.map(|knot| frame.placer.printed_number(knot * LAST_KNOT)).collect();
        let printed = BSpline::unweighted(3, wanted.knots.clone(), points);
        let printed = over(printed, knots?)?;
        // Knot span by knot span both are cubics, whose difference lies in the hull of that of their control points.
        let off = cubics(&printed)
            .zip(cubics(&wanted))
            .flat_map(|(printed, wanted)| [0, 1, 2, 3].map(|at| (printed[at] - wanted[at]).norm()))
            .fold(0.0, f64::max);
        let farthest = last.axis_error.max(node.axis_error);
        let bound = self.kept_bound(frame, off, farthest, 0.0, [last, &node])?;
        // No axis goes beyond the hulls.
        let between: Vec<Joints> = cubics(&printed)
            .flat_map(|cubic| [cubic[1], cubic[2], cubic[3]])
            .map(|place| frame.joints(place))
            .collect();
        let inside = |joints: &Joints| {
            frame.slides().iter().all(|(joint, _)| {
                passed(self.machine.axes[*joint].travel, joints[*joint], AT_END).is_none()
            })
        };
        between.iter().all(inside).then(|| SplineBlock {
            curve: PrintedCurve {
                words: CurveWords::Spline {
                    degree: 3,
                    weights: vec![1.0; printed.poles.len()],
                    knots: printed.knots.clone(),
                    points: words,
                },
                between,
                way: match self.plans {
                    true => places(&printed, frame),
                    false => Vec::new(),
                },
            },
            bound,
            node: Box::new(node),
        })
    }
}
