//! Curves that stay curves: an arc of the CL file becomes one block, or a few, where dialect, machine and tolerance
//! allow; else it goes by the moves that it was cut into.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use post_machine::description::ArcSplit;
use post_machine::kinematics::Joints;
use post_machine::kinematics::travel::{AT_END, passed};

use super::{
    AxisTravels, BlockKind, BlockReason, BlockSink, BlockStage, FollowTime, MotionBlock,
    NominalTime, PathLeg,
};
use crate::accuracy::{ArcDirection, DeviationBound, PathNode, PrintedArc, WordFrame};
use crate::configuration::{ChosenPoint, pose};
use crate::curve::{CurveBlock, CurveMove, CurveMoves, CurveShape, CurveWords, PrintedCurve};
use crate::program::{MoveFeed, PathArc, StraightMove};
use crate::stream::StreamItem;

/// Controls take an arc whose ends differ by more in their distance from the centre for a slip: mm.
const MISMATCH: f64 = 0.005;

/// A control may divide F by the way in the plane alone: a helix is no arc where that makes it faster by more.
const FASTER: f64 = 1.05;

/// An arc by its radius turns by no more than this in a block, radians (160°).
const BY_RADIUS: f64 = 2.792_526_803_190_927;

/// Words and places that differ by less are one, mm.
const SAME: f64 = 1e-7;

/// Largest turn, radians, of an arc after a helix that ended beside its words: a whole circle would be one of
/// nothing where its start lies ahead of its end.
const ALMOST_WHOLE: f64 = TAU - 0.01;

/// Shares of an arc that are as near to its ends are no places to cut it at.
const AT_ITS_END: f64 = 1e-6;

/// A block along an arc.
pub(super) struct ArcBlock {
    node: Box<PathNode>,
    pub(super) printed: PrintedArc,
    curve: PrintedCurve,
    /// The least time in which the axes keep up.
    minutes: FollowTime,
    /// How far it is from its path, mm.
    pub(super) off: f64,
    bound: DeviationBound,
    /// Share of the whole arc.
    share: f64,
}

impl ArcBlock {
    /// Adds what is proven of the block.
    pub(super) fn proven(self, bound: DeviationBound) -> Self {
        Self { bound, ..self }
    }
}

impl BlockStage<'_> {
    /// Goes along a curve: it is kept, or made by its moves.
    pub(super) fn go_along(
        &mut self,
        line: u64,
        curve: &CurveMoves<ChosenPoint>,
        out: &mut BlockSink<'_>,
    ) {
        let moves = curve.moves.iter().map(|next| match next {
            StreamItem::Point(chosen) => Some(chosen),
            _ => None,
        });
        let moves: Option<Vec<&ChosenPoint>> = moves.collect();
        if let Some(moves) = &moves
            && self.keep(line, &curve.curve, moves, out)
        {
            return;
        }
        self.take(&curve.moves, out);
        if moves.is_none() {
            // Something has come between.
            self.end_run(out);
        }
    }

    /// Makes blocks along the curve, if that can be.
    fn keep(
        &mut self,
        line: u64,
        curve: &CurveMove,
        moves: &[&ChosenPoint],
        out: &mut BlockSink<'_>,
    ) -> bool {
        let (Some(placer), Some(last)) = (self.placer.clone(), self.last.as_deref()) else {
            return false;
        };
        let still = |next: &&ChosenPoint| {
            let standing = self.planes.standing(next);
            next.arrives && next.rewind.is_none() && placer.stand(standing, &last.trace.joints)
        };
        if !moves.iter().all(still)
            || self.compensation_due
            || !self.machine.solution.exclusive.is_empty()
        {
            return false;
        }
        let Some(frame) = WordFrame::new(&placer, last) else {
            return false;
        };
        let lift = curve.end.axis * self.machine.control_point.along;
        match &curve.course {
            CurveShape::Arc(arc) => {
                let wanted = arc.placed(|point| point + lift, |direction| direction);
                let whole = StraightMove { tip: curve.end.tip + lift, ..curve.end };
                let Some(blocks) = self.arc_blocks(&frame, &wanted, &whole) else {
                    return false;
                };
                self.push_arc(&frame, line, &whole, blocks, out);
                true
            }
            CurveShape::Spline(spline) => {
                let lifted = spline.clone().placed(|point| point + lift);
                let end = StraightMove { tip: lifted.poles[lifted.poles.len() - 1].0, ..curve.end };
                let Some(block) = self.spline_block(&frame, &lifted, &end) else {
                    return false;
                };
                // Its chords are shorter by less than a thousandth of what they stray.
                let mut at = lifted.poles[0].0;
                let chords = moves.iter().map(|next| {
                    let from = std::mem::replace(&mut at, next.motion.tip);
                    (at - from).norm()
                });
                let way = chords.sum();
                self.push_spline(&frame, (line, &end), block, way, out);
                true
            }
        }
    }

    /// The blocks along an arc, as few as may be: whole, by halves, by quadrants.
    fn arc_blocks(
        &self,
        frame: &WordFrame<'_>,
        arc: &PathArc,
        end: &StraightMove,
    ) -> Option<Vec<ArcBlock>> {
        let normal = frame.direction(arc.axis);
        let axis = normal.iamax();
        let direction = ArcDirection { axis, sense: libm::copysign(1.0, normal[axis]) };
        if self.compensating && axis != 2 {
            return None;
        }
        let from = self.keeps.arcs.split;
        let splits = [ArcSplit::Full, ArcSplit::Half, ArcSplit::Quadrant];
        let finer = splits.into_iter().skip_while(|split| *split != from);
        finer
            .map(|split| self.cuts(frame, direction, arc, split))
            .find_map(|cuts| self.arc_pieces(frame, direction, arc, end, &cuts))
    }

    /// Shares of an arc at which its blocks end, 1 the last of them.
    fn cuts(
        &self,
        frame: &WordFrame<'_>,
        direction: ArcDirection,
        arc: &PathArc,
        split: ArcSplit,
    ) -> Vec<f64> {
        use std::f64::consts::{FRAC_PI_2, PI, TAU};
        let most: f64 = match split {
            ArcSplit::Full => TAU,
            _ => PI,
        };
        let most = match self.keeps.by_radius() {
            true => most.min(BY_RADIUS),
            false => most,
        };
        if split != ArcSplit::Quadrant {
            // What is a turn but for rounding is one.
            let count = libm::ceil(arc.sweep / most - AT_ITS_END).max(1.0);
            return (1..=count as u32).map(|piece| f64::from(piece) / count).collect();
        }
        let ArcDirection { axis, sense } = direction;
        let radial = frame.direction(arc.radial);
        let (x, y) = (radial[(axis + 1) % 3], radial[(axis + 2) % 3]);
        let from = sense * libm::atan2(y, x);
        let first = (libm::floor(from / FRAC_PI_2) + 1.0) * FRAC_PI_2 - from;
        let mut cuts: Vec<f64> = (0..5)
            .map(|quarter| (first + f64::from(quarter) * FRAC_PI_2) / arc.sweep)
            .filter(|share| *share > AT_ITS_END && *share < 1.0 - AT_ITS_END)
            .collect();
        cuts.push(1.0);
        cuts
    }

    /// The pieces of an arc between such shares as blocks; none if one of them cannot be.
    fn arc_pieces(
        &self,
        frame: &WordFrame<'_>,
        direction: ArcDirection,
        arc: &PathArc,
        end: &StraightMove,
        cuts: &[f64],
    ) -> Option<Vec<ArcBlock>> {
        let mut pieces: Vec<ArcBlock> = Vec::with_capacity(cuts.len());
        let mut from = 0.0;
        for &cut in cuts {
            let before = pieces.last().map(|piece| &*piece.node).or(self.last.as_deref())?;
            let tip = if cut == 1.0 { end.tip } else { arc.at(cut) };
            let target = pose(&StraightMove { tip, ..*end });
            let mut node = frame.placer.settled(target, 1.0, &before.trace.joints).ok()?;
            self.steady(frame.placer, before, &mut node);
            let wanted = arc
                .piece(from, cut)
                .placed(|point| frame.point(point), |direction| frame.direction(direction));
            let piece = self.arc_block(frame, direction, &wanted, [before, &node])?;
            pieces.push(ArcBlock { share: cut - from, ..piece });
            from = cut;
        }
        Some(pieces)
    }

    /// The block along an arc in the frame of the words, if it is within what dialect, machine and tolerance allow.
    fn arc_block(
        &self,
        frame: &WordFrame<'_>,
        direction: ArcDirection,
        wanted: &PathArc,
        ends: [&PathNode; 2],
    ) -> Option<ArcBlock> {
        let off = |printed: &PrintedArc| printed.deviation(wanted);
        let block = self.printed_arc(frame, direction, wanted.centre, ends, off)?;
        let farthest = ends[0].axis_error.max(ends[1].axis_error);
        let bound = self.kept_bound(frame, block.off, farthest, 0.0, ends)?;
        Some(block.proven(bound))
    }

    /// The block along an arc about `centre` (frame of the words, mm) as it is printed, if dialect and machine allow; how
    /// far it is from what is wanted `off` says.
    pub(super) fn printed_arc(
        &self,
        frame: &WordFrame<'_>,
        direction: ArcDirection,
        mut centre: Vector3<f64>,
        [from, node]: [&PathNode; 2],
        off: impl Fn(&PrintedArc) -> f64,
    ) -> Option<ArcBlock> {
        let mut ends = [frame.placer.printed(from)?, frame.placer.printed(node)?];
        let ArcDirection { axis, sense } = direction;
        // A helix may have ended beside its words: the next arc begins there, and one given by its turn turns as much as
        // words say.
        let stands = frame.point(from.tip);
        let beside = self.keeps.by_turn() && (stands - ends[0]).norm() > SAME;
        let by_turn = self.keeps.by_turn() && ends[0][axis] != ends[1][axis];
        let start = if beside { stands } else { ends[0] };
        if !by_turn {
            ends[0] = start;
        }
        centre[axis] = ends[0][axis];
        let (words, rounded) = frame.placer.printed_point(centre)?;
        let (centre, radius) = match self.keeps.by_radius() && !by_turn {
            false => (rounded, None),
            true => {
                // The length of a word is printed with the decimals of that word.
                let across = (axis + 1) % 3;
                let mut length = ends[0];
                let radii = PrintedArc::new(direction, ends, centre)?.radii;
                length[across] = radii[0].midpoint(radii[1]);
                let (word, printed) = frame.placer.printed_point(length)?;
                let centre = PrintedArc::centre_by_radius(direction, ends, printed[across])?;
                (centre, Some(word[across]))
            }
        };
        let mut printed = PrintedArc::new(direction, ends, centre)?;
        // What the words say it differs by, the control sees.
        let mismatch = printed.mismatch();
        if by_turn {
            printed = printed.by_turn(start);
        } else if beside && printed.turn > ALMOST_WHOLE {
            return None;
        }
        let (length, rise) = (printed.length(), printed.rise());
        if !self.keeps.about(axis, rise != 0.0, self.in_plane())
            || !printed.radii.iter().all(|radius| self.keeps.radius(*radius))
            || printed.mismatch().max(mismatch) > MISMATCH
            || libm::hypot(length, rise) > FASTER * length
        {
            return None;
        }
        let off = off(&printed);
        if off.is_infinite() {
            return None;
        }
        let between = self.arc_between(frame, &printed)?;
        let mut normal = [0.0; 3];
        normal[axis] = 1.0;
        let mut node = Box::new(*node);
        if by_turn {
            frame.placer.stray(&mut node, frame.joints(printed.at(1.0)));
        }
        let words = CurveWords::Arc {
            centre: words,
            normal,
            turn: sense * printed.turn.to_degrees(),
            radius,
        };
        Some(ArcBlock {
            node,
            printed,
            curve: PrintedCurve { words, between, way: self.way_of_arc(frame, &printed) },
            minutes: self.arc_follow(frame, &printed),
            off,
            bound: DeviationBound::default(),
            share: 1.0,
        })
    }

    /// What is proven of a block between two nodes that is `off` its path and has `chord` mm of the tolerance spent
    /// already, if that is within tolerance; the tool axis is off by `farthest` at most.
    pub(super) fn kept_bound(
        &self,
        frame: &WordFrame<'_>,
        off: f64,
        farthest: f64,
        chord: f64,
        [from, node]: [&PathNode; 2],
    ) -> Option<DeviationBound> {
        let accuracy = &self.machine.accuracy;
        let margin = frame.placer.margin(&from.trace.joints, &node.trace.joints);
        let bound = DeviationBound {
            tip: off + frame.placer.control_point().radius * farthest + margin.tip,
            axis: farthest + margin.axis,
        };
        let holds =
            bound.tip + chord <= accuracy.tolerance && bound.axis <= accuracy.axis_tolerance;
        holds.then_some(bound)
    }

    /// Places along an arc by which its feed is planned, none where no feed is: as many as its chords need to stay within a
    /// tenth of the tolerance.
    fn way_of_arc(&self, frame: &WordFrame<'_>, printed: &PrintedArc) -> Vec<Vector3<f64>> {
        if !self.plans {
            return Vec::new();
        }
        let radius = printed.radii[0].max(printed.radii[1]);
        let sagitta = (0.1 * self.machine.accuracy.tolerance).min(radius);
        let chord = 2.0 * libm::acos(1.0 - sagitta / radius);
        let count = libm::ceil(printed.turn / chord).clamp(2.0, 4096.0) as u32;
        (1..count)
            .map(|place| frame.in_part(printed.at(f64::from(place) / f64::from(count))))
            .collect()
    }

    /// Axis values where some axis turns back along an arc, in order; none where one leaves its travel.
    fn arc_between(&self, frame: &WordFrame<'_>, printed: &PrintedArc) -> Option<Vec<Joints>> {
        let slides = frame.slides().iter();
        let mut shares: Vec<f64> =
            slides.flat_map(|(_, slide)| printed.turns_back(*slide)).collect();
        shares.sort_by(f64::total_cmp);
        let between: Vec<Joints> =
            shares.into_iter().map(|share| frame.joints(printed.at(share))).collect();
        // What the two radii differ by moves the place where an axis turns back a little farther.
        let slack = printed.mismatch();
        let inside = |joints: &Joints| {
            frame.slides().iter().all(|(joint, _)| {
                let travel = self.machine.axes[*joint].travel;
                [-slack, slack]
                    .iter()
                    .all(|slack| passed(travel, joints[*joint] + slack, AT_END).is_none())
            })
        };
        between.iter().all(inside).then_some(between)
    }

    /// Hands on the blocks of an arc.
    fn push_arc(
        &mut self,
        frame: &WordFrame<'_>,
        line: u64,
        motion: &StraightMove,
        pieces: Vec<ArcBlock>,
        out: &mut BlockSink<'_>,
    ) {
        let count = pieces.len();
        for (place, piece) in pieces.into_iter().enumerate() {
            if self.compensating {
                self.check_compensation(frame.placer, line, &piece.node);
            }
            let leg = PathLeg {
                placer: frame.placer,
                line,
                motion,
                loose: false,
                reason: match place + 1 == count {
                    true => BlockReason::Point,
                    false => BlockReason::Stage,
                },
            };
            let node = self.push_piece(&leg, piece, out);
            self.spare = self.last.replace(node);
        }
        self.on_part = true;
    }

    /// Hands on a block along an arc; gives where it ends.
    pub(super) fn push_piece(
        &mut self,
        leg: &PathLeg<'_>,
        piece: ArcBlock,
        out: &mut BlockSink<'_>,
    ) -> Box<PathNode> {
        let way = libm::hypot(piece.printed.length(), piece.printed.rise());
        let nominal = NominalTime::of(leg.motion.pace, way, AxisTravels::default);
        let block = MotionBlock {
            kind: BlockKind::Arc,
            way,
            nominal: match leg.motion.pace {
                // The time is that of the whole arc.
                MoveFeed::InverseTime(_) => nominal.share(piece.share),
                _ => nominal,
            },
            follow: piece.minutes,
            ..self.block(leg, &piece.node, piece.bound)
        };
        self.largest.keep(leg, piece.bound);
        self.push_curve(block, piece.curve, out);
        piece.node
    }

    /// Hands on a block along a curve.
    pub(super) fn push_curve(
        &self,
        block: MotionBlock,
        printed: PrintedCurve,
        out: &mut BlockSink<'_>,
    ) {
        let (line, curve) = (block.line, Box::new(CurveBlock { block, printed }));
        out.push(StreamItem::Curve { line, curve });
    }

    /// The least time in which no axis passes its largest feed, also on a control that divides F by the way in the plane.
    fn arc_follow(&self, frame: &WordFrame<'_>, printed: &PrintedArc) -> FollowTime {
        let mut follow = FollowTime::default();
        let length = printed.length();
        let faster = libm::hypot(length, printed.rise()) / length;
        for (joint, slide) in frame.slides() {
            let minutes = faster * printed.fastest(*slide) / self.machine.axes[*joint].max_feed;
            if minutes > follow.minutes {
                follow = FollowTime { minutes, joint: *joint };
            }
        }
        if self.driven {
            self.drives_follow_arc(frame, printed, &mut follow);
        }
        follow
    }
}
