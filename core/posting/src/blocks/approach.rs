//! The way to a first position, from where the tool is retracted.

use nalgebra::Vector3;
use post_machine::axis_words;
use post_machine::description::Tcp;
use post_machine::kinematics::{Joints, Pose};
use post_machine::tilted_plane::ROUNDED;

use super::nominal::{AxisTravels, NominalTime};
use super::tool_alignment::ToolAlignment;
use super::{BlockKind, BlockReason, BlockSink, BlockStage, MotionBlock, PathLeg};
use crate::accuracy::{DeviationBound, PathNode, Placer};
use crate::program::{MoveFeed, StraightMove};
use crate::stream::StreamItem;

/// Least way in or down; a shorter one is left out, mm.
const LEAST: f64 = 1.0;

/// Distance along its line at which a tool stands that wins no height there, mm: as far as one that leans is drawn back
/// when it leaves the part.
const OUT: f64 = 100.0;

/// An axis that moves by a smaller share of the tool's way stands.
const STANDS: f64 = 1e-9;

/// A way is tried so often, each time half as long, where a chain that is solved by steps has no place at its end.
const TRIES: u32 = 8;

/// Angles that differ by less are the same, radians.
const SAME: f64 = 1e-9;

/// A slide leans from the coordinate that its word has under tool centre point control, or a tool from the slide of the depth,
/// mm a mm: more than the last bits of directions. Measured leans are far larger, and none of them may come in ahead.
const LEANS: f64 = 1e-9;

/// The word of a plane along its normal.
const DEPTH: usize = 2;

/// The axis that retracts the tool, and where it does.
struct RetractAxis {
    depth: usize,
    position: f64,
    /// The sense of the axis away from the part.
    up: f64,
}

impl BlockStage<'_> {
    /// The first position after the start, a tool change, or a turn of an index axis.
    pub(super) fn first(
        &mut self,
        leg: &PathLeg<'_>,
        node: &PathNode,
        kind: BlockKind,
        out: &mut BlockSink<'_>,
    ) {
        self.choose_across(leg.line, leg.placer, node);
        self.come_down(leg, node, kind, out);
        self.lowered = None;
    }

    /// From where the tool is retracted to a first position.
    fn come_down(
        &mut self,
        leg: &PathLeg<'_>,
        node: &PathNode,
        kind: BlockKind,
        out: &mut BlockSink<'_>,
    ) {
        if !self.comes_from_above(leg.placer, node) {
            return self.come(leg, node, kind, out);
        }
        let stops = self.stops_above(leg.placer, node);
        let mut last: Option<&PathNode> = None;
        for stop in &stops {
            let motion = StraightMove {
                tip: stop.target.tip,
                pace: MoveFeed::Rapid,
                chord: 0.0,
                ..*leg.motion
            };
            let over = PathLeg { motion: &motion, loose: true, reason: BlockReason::Above, ..*leg };
            match last {
                None => self.come(&over, stop, kind, out),
                Some(last) => self.cut(&over, last, stop, out),
            }
            last = Some(stop);
        }
        match last {
            Some(last) => {
                // Into a bore it is no rapid over the part.
                let loose = leg.loose && leg.placer.solver().places_tip();
                self.cut(&PathLeg { loose, ..*leg }, last, node, out);
            }
            // It is up there already.
            None => {
                let leg = PathLeg { reason: BlockReason::AtOnce, ..*leg };
                self.come(&leg, node, kind, out);
            }
        }
    }

    /// Moves from wherever the tool stands to `node`.
    fn come(&self, leg: &PathLeg<'_>, node: &PathNode, kind: BlockKind, out: &mut BlockSink<'_>) {
        // Two linear axes may stand beside the point.
        let missed = DeviationBound { tip: node.tip_error, axis: node.axis_error };
        let planar = leg.placer.solver().planar();
        let bound = if planar { missed } else { DeviationBound::default() };
        let block = self.block(leg, node, bound);
        out.push(StreamItem::Point(MotionBlock {
            kind,
            // The way is not known: the feed is that of a millimetre.
            way: 1.0,
            nominal: NominalTime::of(leg.motion.pace, 1.0, AxisTravels::default),
            ..block
        }));
    }

    /// No word moves the tool along its own line alone, as X and Y move it across: the words are those of a part that is
    /// turned, or of a plane whose Z is not the depth's word, or the tool leans, or the control begins to keep the tip
    /// with the very move. Else the words across the tool come first.
    pub(super) fn comes_from_above(&self, placer: &Placer, node: &PathNode) -> bool {
        let machine = self.machine;
        if machine.frame.leave.is_some() {
            return true;
        }
        let joints = &node.trace.joints;
        let Some(depth) = axis_words::depth(self.base) else {
            return false;
        };
        let way = placer.solver().chain().way_of(depth, joints);
        if let Some(normal) = self.plane_normal() {
            // Along it, and not into the part, it is the plane's own Z: the others come first where that is its word. In a
            // plane that leans they would move the depth too, past its end of travel and ahead of the tool's length.
            let along = way.cross(&normal).norm() <= ROUNDED && way.dot(&normal) > 0.0;
            let word = axis_words::coordinate(machine.axes[depth].word());
            return word != DEPTH || !along;
        }
        if machine.control.tcp == Tcp::Post {
            return self.arm && !self.comes_in_by_depth(node, &way);
        }
        // Ahead of a block that has the control keep the tip with a move, words are axis positions: the same where
        // nothing is turned.
        let mut axes = machine.axes.iter().zip(joints);
        let turned = axes.any(|(axis, joint)| {
            axis.joint.rotary && libm::fabs(axis.reading(*joint) * axis.unit()) > SAME
        });
        if turned && !self.tcp_still {
            return true;
        }
        // A slide that leans takes the tip aside, which words of the tip do not.
        let mut slides = machine.axes.iter().enumerate().filter(|(place, axis)| {
            let named = matches!(axis.word(), "X" | "Y" | "Z");
            !axis.joint.rotary && (named || *place == depth)
        });
        let leans = slides.any(|(place, axis)| {
            let mut aside = placer.solver().chain().way_of(place, joints);
            aside[axis_words::coordinate(axis.word())] = 0.0;
            aside.norm() > LEANS
        });
        // And so does the length of a tool that leans.
        leans
            || ToolAlignment::of(&node.target.axis, &way) != ToolAlignment::Along
            || node.trace.pose.axis.cross(&way).norm() > LEANS
    }

    /// The axis that retracts the tool, which goes along `way`, leads it in along its own line. The slide of an arm leads it
    /// wherever the arm points it.
    fn comes_in_by_depth(&self, node: &PathNode, way: &Vector3<f64>) -> bool {
        let line = node.trace.pose.axis;
        self.retract().is_some_and(|retract| {
            ToolAlignment::of(&line, way) == ToolAlignment::Along
                && retract.up * way.dot(&line) > 0.0
        })
    }

    /// Where the tool comes by to `node`, from the retract on: the place farthest out on its own line from which it goes
    /// straight in. Where another axis ends its travel before that is as high as the retract, or the line wins no height,
    /// the place over it comes first. None where the tool is up there already.
    pub(super) fn stops_above(&self, placer: &Placer, node: &PathNode) -> Vec<PathNode> {
        if let Some(distance) = self.machine.frame.leave {
            let out = self.out_by_leave(placer, node, distance);
            return out.into_iter().map(|(out, _)| out).collect();
        }
        let Some(retract) = self.retract() else {
            return Vec::new();
        };
        let chain = placer.solver().chain();
        let height = self.height_left(placer, &retract, &node.trace.joints);
        if height < LEAST {
            return Vec::new();
        }
        let line = self.line_of(node);
        let rates = self.rates(placer, node, &line);
        let rise = rates[retract.depth] * retract.up;
        let way = chain.way_of(retract.depth, &node.trace.joints);
        let rises = rise > 0.0 && ToolAlignment::of(&line, &way) != ToolAlignment::Across;
        let most = if rises { height / rise } else { OUT };
        let mut others = rates;
        if rises {
            others[retract.depth] = 0.0;
        }
        let travel = self.free_way(placer, node, &others, |end| self.kept_free(placer, end));
        let out = self.drawn_out(placer, node, &line, most.min(travel));
        let mut stops = Vec::new();
        if !rises || travel < most {
            let from = out.as_ref().unwrap_or(node);
            stops.extend(self.drawn_up(placer, &retract, from));
        }
        stops.extend(out);
        stops
    }

    /// The tool of `node` drawn back along its own axis by `distance` mm, or as far as travel lets it; and how far that is.
    /// None where that is nowhere.
    pub(super) fn out_by_leave(
        &self,
        placer: &Placer,
        node: &PathNode,
        distance: f64,
    ) -> Option<(PathNode, f64)> {
        let line = self.line_of(node);
        let rates = self.rates(placer, node, &line);
        let free = self.free_way(placer, node, &rates, |_| 0.0);
        // A last decimal stays, so that no rounded word passes the end.
        let way = distance.min(free - placer.last_decimal());
        let out = self.drawn_out(placer, node, &line, way)?;
        let way = (out.tip - node.tip).dot(&line);
        Some((out, way))
    }

    /// The axis that retracts the tool, and where it does ahead of the first position in hand; none where its position is
    /// not given.
    fn retract(&self) -> Option<RetractAxis> {
        let depth = axis_words::depth(self.base)?;
        let mut retract = self.machine.frame.retract.iter();
        let (_, position) = retract.find(|(joint, _)| *joint == depth)?;
        let axis = &self.machine.axes[depth];
        Some(RetractAxis {
            depth,
            position: self.lowered.unwrap_or(*position),
            up: libm::copysign(1.0, axis.joint.direction.dot(&self.machine.tool_axis)),
        })
    }

    /// The line of the tool at `node`, away from the part: in a plane its normal, which is the word Z alone. Unit vector,
    /// part frame.
    fn line_of(&self, node: &PathNode) -> Vector3<f64> {
        self.plane_normal().unwrap_or(node.trace.pose.axis)
    }

    /// How the linear axes go while the tool goes a mm along `line`, the rotary ones standing, mm.
    fn rates(&self, placer: &Placer, node: &PathNode, line: &Vector3<f64>) -> Joints {
        let solver = placer.solver();
        let joints = &node.trace.joints;
        let mut rates = Joints::default();
        let mut further = *joints;
        if solver.places_tip()
            && solver.place(node.tip + line, &mut further, &node.trace.turns).is_ok()
        {
            for (rate, (after, before)) in rates.iter_mut().zip(further.iter().zip(joints)) {
                *rate = after - before;
            }
        } else if let Some(depth) = axis_words::depth(self.base) {
            rates[depth] = solver.chain().way_of(depth, joints).dot(line);
        }
        rates
    }

    /// How far the tool can go before a linear axis is as near to its end of travel as `kept` says of the way there, mm.
    fn free_way(
        &self,
        placer: &Placer,
        node: &PathNode,
        rates: &Joints,
        kept: impl Fn(f64) -> f64,
    ) -> f64 {
        let limits = placer.linear_travel().filter_map(|(joint, [least, most])| {
            let (rate, stands) = (rates[joint], node.trace.joints[joint]);
            let end = if rate > 0.0 { most - stands } else { stands - least };
            (libm::fabs(rate) > STANDS).then(|| (end - kept(end)) / libm::fabs(rate))
        });
        limits.fold(f64::INFINITY, f64::min)
    }

    /// How far an axis stays from an end of travel that is `end` mm away: half of the way where there is less, and where
    /// the tool is not measured.
    fn kept_free(&self, placer: &Placer, end: f64) -> f64 {
        let measured = placer.solver().chain().tip() != self.machine.gauge;
        let room = if measured { self.machine.frame.room } else { f64::INFINITY };
        room.min(end / 2.0)
    }

    /// How far the retract leads up from `joints`, mm: no farther than the depth axis may come near to its end.
    fn height_left(&self, placer: &Placer, retract: &RetractAxis, joints: &Joints) -> f64 {
        let stands = joints[retract.depth];
        let to_retract = (retract.position - stands) * retract.up;
        let travel = self.machine.axes[retract.depth].travel;
        let end = travel.map_or(
            retract.position,
            |[least, most]| {
                if retract.up > 0.0 { most } else { least }
            },
        );
        let to_end = (end - stands) * retract.up;
        to_retract.min(to_end - self.kept_free(placer, to_end))
    }

    /// The tool of `node` drawn back along its line by `way` mm, or as far as there is a place for it.
    fn drawn_out(
        &self,
        placer: &Placer,
        node: &PathNode,
        line: &Vector3<f64>,
        way: f64,
    ) -> Option<PathNode> {
        let ways = (0..TRIES).map(|halved| way / f64::from(1 << halved));
        ways.take_while(|way| *way >= LEAST)
            .find_map(|way| self.stands_at(placer, node, node.tip + line * way))
    }

    /// The tool of `node` as high as the retract, by the depth axis alone.
    fn drawn_up(
        &self,
        placer: &Placer,
        retract: &RetractAxis,
        node: &PathNode,
    ) -> Option<PathNode> {
        let joints = &node.trace.joints;
        let height = self.height_left(placer, retract, joints);
        let way = placer.solver().chain().way_of(retract.depth, joints);
        (height >= LEAST)
            .then(|| self.stands_at(placer, node, node.tip + way * (retract.up * height)))
            .flatten()
    }

    /// The tool of `node` at another place, the rotary axes standing.
    fn stands_at(&self, placer: &Placer, node: &PathNode, tip: Vector3<f64>) -> Option<PathNode> {
        let target = Pose { tip, ..node.target };
        let joints = &node.trace.joints;
        let placed = match placer.solver().places_tip() {
            true => placer.settled(target, 1.0, joints),
            // The rotary axes are needed for the way.
            false => placer.place(target, 1.0, joints),
        };
        placed.ok()
    }
}
