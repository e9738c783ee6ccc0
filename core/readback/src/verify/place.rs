//! Tip and directions of a tool as points whose distances count, and where a straight piece is near enough to one.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

/// Where the tool is: the guided point in mm, tool axis and leading edge as unit vectors, all in the part frame.
///
/// Between two places all three go straight. Chords of directions are shorter than their arcs; pieces are cut so short
/// that this makes no difference (see [`super::chop`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ToolPlace {
    pub point: Vector3<f64>,
    pub axis: Vector3<f64>,
    /// Zero for a tool that turns.
    pub edge: Vector3<f64>,
}

/// How far two places may be apart, and still be one.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaceBound {
    /// mm.
    pub point: f64,
    /// Bound of directions, as the length of a difference of unit vectors.
    pub axis: f64,
}

/// How far two places are apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PlaceDistance {
    /// mm.
    pub point: f64,
    /// Radians.
    pub axis: f64,
}

/// Shares of a straight piece, from the first to the last; empty where the first is larger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ShareSpan {
    pub from: f64,
    pub to: f64,
}

/// A difference that is shorter than this has no direction: mm, or of unit vectors.
const SHORT: f64 = 1e-12;

impl ToolPlace {
    /// Place of the point `along` mm above the tip, towards the holder.
    #[inline]
    pub fn new(pose: &Pose, along: f64) -> Self {
        Self { point: pose.tip + pose.axis * along, axis: pose.axis, edge: pose.edge_across() }
    }

    pub fn between(&self, other: &Self, share: f64) -> Self {
        let mix = |a: Vector3<f64>, b: Vector3<f64>| a + (b - a) * share;
        Self {
            point: mix(self.point, other.point),
            axis: mix(self.axis, other.axis),
            edge: mix(self.edge, other.edge),
        }
    }

    pub fn apart(&self, other: &Self) -> PlaceDistance {
        let chord = (self.axis - other.axis).norm();
        PlaceDistance {
            point: (self.point - other.point).norm(),
            axis: angle_of(chord.max(self.edge_chord(other))),
        }
    }

    #[inline]
    pub fn within(&self, other: &Self, bound: &PlaceBound) -> bool {
        (self.point - other.point).norm() <= bound.point
            && (self.axis - other.axis).norm() <= bound.axis
            && self.edge_chord(other) <= bound.axis
    }

    /// A course that says nothing of an edge is kept by any.
    fn edge_chord(&self, other: &Self) -> f64 {
        match self.has_edge() && other.has_edge() {
            true => (self.edge - other.edge).norm(),
            false => 0.0,
        }
    }

    #[inline]
    pub fn has_edge(&self) -> bool {
        self.edge != Vector3::zeros()
    }
}

impl PlaceBound {
    pub fn times(&self, factor: f64) -> Self {
        Self {
            point: self.point * factor,
            // Directions differ by 2 at most; all of them are free then.
            axis: self.axis * factor,
        }
    }

    /// A bound of `point` mm and `angle` radians.
    pub fn new(point: f64, angle: f64) -> Self {
        Self { point, axis: 2.0 * libm::sin(0.5 * angle.min(std::f64::consts::PI)) }
    }
}

impl PlaceDistance {
    /// Whether two places so far apart are one within `bound`, which has chords of directions.
    pub fn is_within(&self, bound: &PlaceBound) -> bool {
        self.point <= bound.point && PlaceBound::new(1.0, self.axis).axis <= bound.axis
    }

    pub fn larger(&self, other: &Self) -> Self {
        Self { point: self.point.max(other.point), axis: self.axis.max(other.axis) }
    }

    pub fn smaller(&self, other: &Self) -> Self {
        Self { point: self.point.min(other.point), axis: self.axis.min(other.axis) }
    }
}

impl ShareSpan {
    pub const EMPTY: Self = Self { from: 1.0, to: 0.0 };
    pub const WHOLE: Self = Self { from: 0.0, to: 1.0 };

    pub fn is_empty(&self) -> bool {
        self.from > self.to
    }

    pub fn meet(&self, other: &Self) -> Self {
        Self { from: self.from.max(other.from), to: self.to.min(other.to) }
    }
}

/// The angle between unit vectors whose difference has this length, radians.
pub(super) fn angle_of(chord: f64) -> f64 {
    2.0 * libm::asin((0.5 * chord).min(1.0))
}

/// The shares of the straight piece from `a` to `b` that are within `bound` of `place`: one span, for balls are convex.
#[inline]
pub(super) fn free(
    place: &ToolPlace,
    a: &ToolPlace,
    b: &ToolPlace,
    bound: &PlaceBound,
) -> ShareSpan {
    let mut span = ShareSpan::WHOLE;
    narrow(&mut span, a.point - place.point, b.point - a.point, bound.point);
    // Most pieces keep their tool axis, and lie on one that is kept.
    if !span.is_empty() && (a.axis != place.axis || b.axis != a.axis) {
        narrow(&mut span, a.axis - place.axis, b.axis - a.axis, bound.axis);
    }
    if !span.is_empty() && place.has_edge() && a.has_edge() {
        narrow(&mut span, a.edge - place.edge, b.edge - a.edge, bound.axis);
    }
    span
}

/// Leaves of `span` where `offset + way * share` is no longer than `most`.
#[inline]
fn narrow(span: &mut ShareSpan, offset: Vector3<f64>, way: Vector3<f64>, most: f64) {
    let square = way.norm_squared();
    if square < SHORT * SHORT {
        if offset.norm_squared() > most * most {
            *span = ShareSpan::EMPTY;
        }
        return;
    }
    let nearest = -offset.dot(&way) / square;
    let rest = most * most - (offset + way * nearest).norm_squared();
    if rest < 0.0 {
        *span = ShareSpan::EMPTY;
        return;
    }
    let half = (rest / square).sqrt();
    *span = span.meet(&ShareSpan { from: nearest - half, to: nearest + half });
}

/// How near the piece from `a` to `b` comes to `place` on `span` of it: point and directions each for itself.
#[inline]
pub(super) fn nearest(
    place: &ToolPlace,
    a: &ToolPlace,
    b: &ToolPlace,
    span: &ShareSpan,
) -> PlaceDistance {
    let point = nearest_point(place, a, b, span);
    let mut chord = match a.axis == place.axis && b.axis == a.axis {
        true => 0.0,
        false => least(a.axis - place.axis, b.axis - a.axis, span),
    };
    if place.has_edge() && a.has_edge() {
        chord = chord.max(least(a.edge - place.edge, b.edge - a.edge, span));
    }
    PlaceDistance { point, axis: angle_of(chord) }
}

/// How near the points of the piece from `a` to `b` come to that of `place` on `span` of it, mm.
#[inline]
pub(super) fn nearest_point(
    place: &ToolPlace,
    a: &ToolPlace,
    b: &ToolPlace,
    span: &ShareSpan,
) -> f64 {
    least(a.point - place.point, b.point - a.point, span)
}

/// The least length of `offset + way * share` on `span`.
#[inline]
fn least(offset: Vector3<f64>, way: Vector3<f64>, span: &ShareSpan) -> f64 {
    let square = way.norm_squared();
    let share = match square < SHORT * SHORT {
        true => span.from,
        false => (-offset.dot(&way) / square).clamp(span.from, span.to),
    };
    (offset + way * share).norm()
}

/// Length of the straight pieces between places, mm.
pub(super) fn way_of(places: &[ToolPlace]) -> f64 {
    places.windows(2).map(|ends| (ends[1].point - ends[0].point).norm()).sum()
}
