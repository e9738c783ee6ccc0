//! Where a leading edge points that is headed along the direction of travel: the CL file says nothing of it but its ways.
//!
//! Along one way of the course the edge points along that; where ways follow one another by less than a corner it may lie
//! anywhere between the two directions, as it turns steadily from one to the next. At a corner it is turned on the spot, and
//! how is the program's own business.

use nalgebra::Vector3;

use super::Verifier;
use super::place::{PlaceDistance, ShareSpan, ToolPlace, angle_of};
use super::track::Element;
use crate::Motion;
use crate::course::Course;

/// A way of the course that makes a smaller angle with the tool axis (its sine) leads straight in or out, and has no direction
/// for an edge.
const STRAIGHT_IN: f64 = 0.05;

/// A motion of the program whose way does so: rounded, and on a way of the course that has a direction all the same.
const NEARLY_STRAIGHT_IN: f64 = 0.08;

/// Pieces of one way that are looked through for the next.
const MOST_PIECES: usize = 4096;

/// Directions that differ by this more are a corner, radians: what rounding does to the largest angle that is none.
const ROUNDED: f64 = 1e-6;

impl<C: Course> Verifier<'_, C> {
    /// The edge must point along the ways of the course that a cut may stand on, from where it `begun` to where it is now.
    pub(super) fn look_where_the_edge_points(
        &mut self,
        motion: &Motion,
        places: &[ToolPlace],
        begun: &[ShareSpan],
    ) {
        let headed =
            self.machine.heads_edge() && places.windows(2).any(|ends| travels(&ends[0], &ends[1]));
        let stands = |reach: &[ShareSpan]| reach.iter().position(|span| !span.is_empty());
        let last = self.reach.iter().rposition(|span| !span.is_empty());
        let (true, Some(first), Some(last)) = (headed, stands(begun), last) else {
            return;
        };
        let ways = self.ways_about(first, last);
        if ways.is_empty() {
            return;
        }
        let corner = self.machine.solution.corner + ROUNDED;
        if ways.windows(2).any(|pair| self.stands_at_corner([&pair[0], &pair[1]], corner, places)) {
            return;
        }
        let ends = places.windows(2).filter(|ends| travels(&ends[0], &ends[1])).flatten();
        let off = ends.map(|place| off_ways(place, &ways, corner));
        let farther = |worst: WayDistance, next: WayDistance| match next.angle > worst.angle {
            true => next,
            false => worst,
        };
        let WayDistance { angle: off, line: cl_line } =
            off.fold(WayDistance { angle: 0.0, line: ways[0].line }, farther);
        if off <= angle_of(self.bound.axis) {
            let apart = PlaceDistance { point: 0.0, axis: off };
            return self.note_deviation(apart, motion.line, cl_line);
        }
        let [by, allowed] = [off, self.rules.axis_tolerance].map(f64::to_degrees);
        let message = format!(
            "the leading edge points {by:.3}° off the direction of travel; allowed are {allowed:.3}°"
        );
        self.found.axis.take(by, motion.line, cl_line);
        self.fault("deviation", message, Some(motion), Some(cl_line), Some(by));
    }

    /// Whether all places are those of a corner between two ways: the tool turns there, and what it goes meanwhile is no
    /// direction.
    fn stands_at_corner(
        &self,
        [before, behind]: [&TravelWay; 2],
        corner: f64,
        places: &[ToolPlace],
    ) -> bool {
        let turn = angle_of((before.direction - behind.direction).norm());
        let near = |place: &ToolPlace| (place.point - behind.from).norm() <= self.bound.point;
        turn > corner && places.iter().all(near)
    }

    /// The ways of the elements from `first` to `last`, that before them and that behind them which lead elsewhere: a way on
    /// which the tool axis turns is cut into pieces of one direction.
    fn ways_about(&mut self, first: usize, last: usize) -> Vec<TravelWay> {
        let mut ways: Vec<TravelWay> = Vec::new();
        for index in first..=last + MOST_PIECES {
            let Some(element) = self.track.get(index) else {
                break;
            };
            let way = TravelWay::of(element);
            let elsewhere =
                way.is_none_or(|way| ways.last().is_none_or(|last| last.is_apart(&way)));
            ways.extend(way.filter(|_| elsewhere));
            if index > last && elsewhere {
                break;
            }
        }
        let kept = self.track.kept().iter().take(first).rev().filter_map(TravelWay::of);
        let behind = kept.chain(self.ways_behind.into_iter().rev().flatten());
        let before =
            ways.first().and_then(|way| behind.into_iter().find(|other| other.is_apart(way)));
        before.into_iter().chain(ways).collect()
    }

    /// Keeps the way of an element that is left behind.
    pub(super) fn leave_way(&mut self, element: &Element) {
        let Some(way) = TravelWay::of(element) else {
            self.ways_behind = [None; 2];
            return;
        };
        if self.ways_behind[1].is_none_or(|last| last.is_apart(&way)) {
            self.ways_behind = [self.ways_behind[1], Some(way)];
        }
    }
}

/// A way of the course with a direction across the tool.
#[derive(Clone, Copy, Debug)]
pub(super) struct TravelWay {
    /// Line of the CL file.
    line: u64,
    /// That direction, of length one, part frame.
    direction: Vector3<f64>,
    /// Where it begins, mm, part frame.
    from: Vector3<f64>,
}

impl TravelWay {
    /// Whether it has another direction.
    fn is_apart(&self, other: &Self) -> bool {
        (self.direction - other.direction).norm() > ROUNDED
    }

    /// That of a cut; none of anything else.
    fn of(element: &Element) -> Option<Self> {
        let way = element.to.point - element.from.point;
        laid(way, &element.from.axis, STRAIGHT_IN).filter(|_| element.is_cut())?;
        // Not laid across the tool: that turns on the way.
        let direction = way.normalize();
        Some(Self { line: element.line, direction, from: element.from.point })
    }
}

/// How far an edge points off the ways of the course.
#[derive(Clone, Copy)]
struct WayDistance {
    /// Radians.
    angle: f64,
    /// Line of the CL file that asks for the way.
    line: u64,
}

/// Whether the tool goes from one place to another with a direction across it.
fn travels(from: &ToolPlace, to: &ToolPlace) -> bool {
    let edges = from.has_edge() && to.has_edge();
    edges && laid(to.point - from.point, &to.axis, NEARLY_STRAIGHT_IN).is_some()
}

/// The part of a way across a tool axis, of length one; none where they make an angle of a sine below `least`.
fn laid(way: Vector3<f64>, axis: &Vector3<f64>, least: f64) -> Option<Vector3<f64>> {
    (way - axis * axis.dot(&way)).try_normalize(least * way.norm().max(1e-9))
}

/// How far the edge at a place is off the nearest way, or off all directions from one to the next.
fn off_ways(place: &ToolPlace, ways: &[TravelWay], corner: f64) -> WayDistance {
    let laid = |way: &Vector3<f64>| laid(*way, &place.axis, 1e-6).unwrap_or(*way);
    let apart = |one: &Vector3<f64>, other: &Vector3<f64>| angle_of((one - other).norm());
    let off = |[one, other]: [Vector3<f64>; 2]| {
        let (one, other) = (laid(&one), laid(&other));
        let turn = apart(&one, &other);
        let detour = apart(&place.edge, &one) + apart(&place.edge, &other) - turn;
        (turn <= corner).then_some(0.5 * detour.max(0.0))
    };
    let alone = ways.iter().map(|way| (apart(&place.edge, &laid(&way.direction)), way.line));
    let pairs = ways.windows(2).flat_map(|pair| {
        let [one, other] = [pair[0].direction, pair[1].direction];
        // Chords of one curve: at its ends it points half a chord's turn farther than they.
        let curve = pair[0].line == pair[1].line;
        let ends = [[one * 1.5 - other * 0.5, one], [other, other * 1.5 - one * 0.5]];
        let ends = ends.into_iter().filter(move |_| curve);
        std::iter::once([one, other]).chain(ends).map(|pair_of| (pair_of, pair[0].line))
    });
    let between = pairs.filter_map(|(pair, line)| Some((off(pair)?, line)));
    let all = alone.chain(between).map(|(angle, line)| WayDistance { angle, line });
    let nearest = all.min_by(|one, other| one.angle.total_cmp(&other.angle));
    nearest.unwrap_or(WayDistance { angle: 0.0, line: 0 })
}
