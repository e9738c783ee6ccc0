//! Runs of points as the fewest arcs and lines that stay within the tolerance of the path, each certified. The rotary axes
//! stand along them; a leg in which one turns stays as it is.
//!
//! From each point the piece that reaches farthest is taken. Where every part of a piece that is near enough is near
//! enough itself, no choice has fewer.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;
use post_machine::description::ArcSplit;

use super::along::ArcBlock;
use super::{BlockSink, BlockStage, NominalTime, PathLeg};
use crate::accuracy::{
    ArcDirection, DeviationBound, PathNode, PrintedArc, RunPosition, WordFrame, arc_fit,
};

/// Largest bulge (tangent of a quarter of the angle) of an arc: 340°, half a turn and a quarter.
const BULGES: [f64; 3] = [11.430_052_302_761_343, 1.000_001, 0.414_213_562_373_095_1];

/// Largest bulge of an arc that is printed by its radius: 160°.
const BULGE_BY_RADIUS: f64 = 0.839_099_631_177_28;

/// An angle so near to the end of a quadrant is there, radians.
const AT_QUADRANT: f64 = 1e-6;

/// A piece of a run: the leg after it, and how it goes.
enum FittedPiece {
    Line(DeviationBound),
    Arc(Box<ArcBlock>),
}

/// A run in the frame of the words.
struct WordFrameRun<'r> {
    frame: WordFrame<'r>,
    legs: &'r [PathLeg<'r>],
    nodes: &'r [PathNode],
    /// Where the CL file wants the points, and where they are printed, mm.
    wanted: Vec<Vector3<f64>>,
    printed: Vec<Vector3<f64>>,
    /// What pieces may be off, mm.
    tolerance: f64,
}

impl BlockStage<'_> {
    /// Goes along a run by arcs and lines.
    pub(super) fn fit(
        &mut self,
        legs: &[PathLeg<'_>],
        nodes: &[PathNode],
        out: &mut BlockSink<'_>,
    ) {
        let mut at = 0;
        while at < legs.len() {
            // Legs along which nothing turns.
            let still =
                |node: &&PathNode| !self.kinds.turning(&nodes[at].trace.joints, &node.trace.joints);
            let count = nodes[at + 1..].iter().take_while(still).count();
            let (legs, nodes) = (&legs[at..], &nodes[at..]);
            match self.laid(&legs[..count], &nodes[..=count]) {
                Some(laid) => {
                    self.fit_laid(&laid, out);
                    at += count;
                }
                None => {
                    let turns = |pair: &&[PathNode]| {
                        self.kinds.turning(&pair[0].trace.joints, &pair[1].trace.joints)
                    };
                    let count = match count {
                        0 => nodes.windows(2).take_while(turns).count(),
                        count => count,
                    };
                    self.go_straight(&legs[..count], &nodes[..=count], out);
                    at += count;
                }
            }
        }
    }

    fn laid<'r>(&self, legs: &'r [PathLeg<'r>], nodes: &'r [PathNode]) -> Option<WordFrameRun<'r>> {
        let first = legs.first()?;
        let placer = first.placer;
        let frame = WordFrame::new(placer, &nodes[0])?;
        let printed = nodes.iter().map(|node| placer.printed(node));
        let margin = placer.margin(&nodes[0].trace.joints, &nodes[0].trace.joints);
        let edge = placer.control_point().radius * self.machine.accuracy.axis_tolerance;
        Some(WordFrameRun {
            legs,
            nodes,
            wanted: nodes.iter().map(|node| frame.point(node.target.tip)).collect(),
            printed: printed.collect::<Option<_>>()?,
            tolerance: self.machine.accuracy.tolerance - first.motion.chord - margin.tip - edge,
            frame,
        })
    }

    fn fit_laid(&mut self, laid: &WordFrameRun<'_>, out: &mut BlockSink<'_>) {
        let mut at = 0;
        while at < laid.legs.len() {
            let line = farthest(at, laid.legs.len(), |end| self.line(laid, at, end));
            let reach = line.as_ref().map_or(at + 1, |(reach, _)| *reach);
            let arc = farthest(reach, laid.legs.len(), |end| {
                self.fitted_arc(laid, at, end).map(|arc| FittedPiece::Arc(Box::new(arc)))
            });
            let Some((end, piece)) = arc.or(line) else {
                let ends = [&laid.nodes[at], &laid.nodes[at + 1]];
                self.cut(&laid.legs[at], ends[0], ends[1], out);
                at += 1;
                continue;
            };
            self.counts.points_dropped += (end - at - 1) as u64;
            let leg = &laid.legs[end - 1];
            match piece {
                FittedPiece::Arc(arc) => {
                    self.push_piece(leg, *arc, out);
                }
                FittedPiece::Line(bound) => {
                    let ends = [&laid.nodes[at], &laid.nodes[end]];
                    let due = (at..end).map(|leg| {
                        self.nominal(&laid.legs[leg], &laid.nodes[leg], &laid.nodes[leg + 1])
                    });
                    let due: Vec<NominalTime> = due.collect();
                    let nominal = NominalTime::between(
                        &due,
                        RunPosition { leg: 0, t: 0.0 },
                        RunPosition { leg: due.len() - 1, t: 1.0 },
                    );
                    self.push(leg, ends, nominal, bound, out);
                }
            }
            at = end;
        }
    }

    /// A straight block over the legs from `at` to `end`.
    fn line(&self, laid: &WordFrameRun<'_>, at: usize, end: usize) -> Option<FittedPiece> {
        let off = arc_fit::off_line([laid.printed[at], laid.printed[end]], &laid.wanted[at..=end]);
        self.bound_of(laid, at, end, off).map(FittedPiece::Line)
    }

    /// What is proven of a piece that is `off` its path, if that is within tolerance. The tool axis may be that of any of
    /// its points.
    fn bound_of(
        &self,
        laid: &WordFrameRun<'_>,
        at: usize,
        end: usize,
        off: f64,
    ) -> Option<DeviationBound> {
        let nodes = &laid.nodes[at..=end];
        let farthest = nodes.iter().map(|node| node.axis_error).fold(0.0, f64::max);
        let chord = laid.legs[at].motion.chord;
        self.kept_bound(&laid.frame, off, farthest, chord, [&nodes[0], &nodes[nodes.len() - 1]])
    }

    /// An arc over the legs from `at` to `end`, in the first plane that has one.
    fn fitted_arc(&self, laid: &WordFrameRun<'_>, at: usize, end: usize) -> Option<ArcBlock> {
        let split = match self.keeps.arcs.split {
            ArcSplit::Full => 0,
            ArcSplit::Half => 1,
            ArcSplit::Quadrant => 2,
        };
        let most = match self.keeps.by_radius() {
            true => BULGES[split].min(BULGE_BY_RADIUS),
            false => BULGES[split],
        };
        let ends = [laid.printed[at], laid.printed[end]];
        let wanted = &laid.wanted[at..=end];
        [2, 1, 0].into_iter().find_map(|axis| {
            let rise = ends[1][axis] - ends[0][axis];
            // Where a helix ends that is given by its turn, no leg begins.
            let helix = rise != 0.0;
            if helix && self.keeps.by_turn() || !self.keeps.about(axis, helix, self.in_plane()) {
                return None;
            }
            // The corners of the path, and the middles of its legs.
            let middles = wanted.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0);
            let inner = wanted[1..wanted.len() - 1].iter().copied();
            let points = inner.chain(middles);
            let [least, largest] = arc_fit::bulges(axis, ends, points, laid.tolerance, most)?;
            let (sense, centre) = arc_fit::by_bulge(axis, ends, least.midpoint(largest))?;
            let whole = |printed: &PrintedArc| printed.off_path(wanted, laid.tolerance);
            let ends = [&laid.nodes[at], &laid.nodes[end]];
            let direction = ArcDirection { axis, sense };
            let block = self.printed_arc(&laid.frame, direction, centre, ends, whole)?;
            if split == 2 && crosses(&block.printed) {
                return None;
            }
            let bound = self.bound_of(laid, at, end, block.off)?;
            Some(block.proven(bound))
        })
    }
}

/// Does an arc lead over from one quadrant of its plane to the next?
fn crosses(printed: &PrintedArc) -> bool {
    let from = printed.sense * printed.from + AT_QUADRANT;
    let next = (libm::floor(from / FRAC_PI_2) + 1.0) * FRAC_PI_2;
    from + printed.turn - 2.0 * AT_QUADRANT > next
}

/// The farthest end above `at` and up to `last` that a piece reaches, if every nearer one can be reached too.
fn farthest<P>(at: usize, last: usize, piece: impl Fn(usize) -> Option<P>) -> Option<(usize, P)> {
    let mut good = None;
    let (mut low, mut high, mut step) = (at, last + 1, 1);
    while low < last && high > last {
        let end = (low + step).min(last);
        match piece(end) {
            Some(found) => {
                good = Some((end, found));
                (low, step) = (end, step * 2);
            }
            None => high = end,
        }
    }
    while high - low > 1 && low < last {
        let middle = low.midpoint(high);
        match piece(middle) {
            Some(found) => {
                good = Some((middle, found));
                low = middle;
            }
            None => high = middle,
        }
    }
    good
}
