//! Where the tool stands on a piece.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::{Curve, Piece};

/// Directions nearer than this are one: the sine of their angle.
const SAME: f64 = 1e-12;

/// Pieces of a spline whose chords are added up, for each span of its knots.
const CHORDS: u32 = 64;

impl Piece {
    /// The pose at `t` from 0 to 1.
    ///
    /// `along` is how far the point that is guided stands above the tip, mm (`[tool] control_point`): that point goes
    /// straight, and the tip follows from it.
    pub fn at(&self, t: f64, along: f64) -> Pose {
        let (from, to) = (&self.from, &self.to);
        let axis = between(from.axis, to.axis, t);
        let tip = match &self.curve {
            Curve::Straight if along == 0.0 => from.tip + (to.tip - from.tip) * t,
            Curve::Straight => {
                let [start, end] = [from, to].map(|pose| pose.tip + pose.axis * along);
                start + (end - start) * t - axis * along
            }
            Curve::Arc {
                centre,
                normal,
                sweep,
            } => on_arc([from.tip, to.tip], *centre, *normal, *sweep, t),
            Curve::Spline(way) => way.at(t),
        };
        let edge = match from.edge == Vector3::zeros() || to.edge == Vector3::zeros() {
            true => Vector3::zeros(),
            false => between(from.edge_across(), to.edge_across(), t),
        };
        Pose { tip, axis, edge }
    }

    /// Length of the tip's way, mm; of a spline and a spiral by their chords, too short by less than a thousandth.
    pub fn length(&self) -> f64 {
        let ends = [self.from.tip, self.to.tip];
        match &self.curve {
            Curve::Straight => (ends[1] - ends[0]).norm(),
            Curve::Arc {
                centre,
                normal,
                sweep,
            } => {
                let [from, to] = ends.map(|tip| split(tip, *centre, *normal));
                let rise = to.1 - from.1;
                let radius = 0.5 * (from.0.norm() + to.0.norm());
                libm::hypot(radius * sweep, rise)
            }
            Curve::Spline(way) => {
                let mut length = 0.0;
                for span in way.spans() {
                    let (low, high) = (way.knots[span], way.knots[span + 1]);
                    let mut last = way.point(low);
                    for piece in 1..=CHORDS {
                        let u = low + (high - low) * f64::from(piece) / f64::from(CHORDS);
                        let next = way.point(u);
                        length += (next - last).norm();
                        last = next;
                    }
                }
                length
            }
        }
    }

    /// The least and largest coordinates of the tip on it, mm. Of an arc the quarters count, of a spline its poles, between
    /// which it stays.
    pub fn extents(&self) -> [Vector3<f64>; 2] {
        let mut box_of = [
            self.from.tip.inf(&self.to.tip),
            self.from.tip.sup(&self.to.tip),
        ];
        let mut take = |tip: Vector3<f64>| {
            box_of = [box_of[0].inf(&tip), box_of[1].sup(&tip)];
        };
        match &self.curve {
            Curve::Straight => {}
            Curve::Arc { normal, sweep, .. } => {
                for place in self.quarters(*normal, *sweep) {
                    take(self.at(place, 0.0).tip);
                }
            }
            Curve::Spline(way) => way.poles.iter().for_each(|(pole, _)| take(*pole)),
        }
        box_of
    }

    /// The shares of an arc at which a coordinate turns back (of a spiral or helix: nearly).
    fn quarters(&self, normal: Vector3<f64>, sweep: f64) -> Vec<f64> {
        let Curve::Arc { centre, .. } = &self.curve else {
            return Vec::new();
        };
        let (arm, _) = split(self.from.tip, *centre, normal);
        let across = normal.cross(&arm);
        let mut places = Vec::new();
        for place in 0..3 {
            // arm·cos + across·sin is extreme where its slope is zero.
            let first = libm::atan2(across[place], arm[place]);
            let half = std::f64::consts::PI;
            let mut angle = first - half * libm::floor(first / half);
            while angle < sweep.min(std::f64::consts::TAU) {
                places.push(angle / sweep);
                angle += half;
            }
        }
        places
    }
}

/// The arm of a point from an axis, and its height along it.
fn split(tip: Vector3<f64>, centre: Vector3<f64>, normal: Vector3<f64>) -> (Vector3<f64>, f64) {
    let offset = tip - centre;
    let height = normal.dot(&offset);
    (offset - normal * height, height)
}

/// The point at `t` on the way round an axis from one point to another.
pub(crate) fn on_arc(
    ends: [Vector3<f64>; 2],
    centre: Vector3<f64>,
    normal: Vector3<f64>,
    sweep: f64,
    t: f64,
) -> Vector3<f64> {
    let [(arm, low), (last, high)] = ends.map(|tip| split(tip, centre, normal));
    let first = arm.norm();
    let radius = first + (last.norm() - first) * t;
    let (sine, cosine) = libm::sincos(sweep * t);
    let out = match first > 0.0 {
        true => arm / first,
        false => Vector3::zeros(),
    };
    let turned = out * cosine + normal.cross(&out) * sine;
    let error = ends[1] - (centre + around(out, normal, sweep) * last.norm() + normal * high);
    // Ends of a program are rounded: the way ends where it says, the difference spread over it.
    centre + turned * radius + normal * (low + (high - low) * t) + error * t
}

fn around(out: Vector3<f64>, normal: Vector3<f64>, sweep: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(sweep);
    out * cosine + normal.cross(&out) * sine
}

/// The unit vector at `t` on the great circle from one to the other; of opposite ones about any direction across.
pub(crate) fn between(from: Vector3<f64>, to: Vector3<f64>, t: f64) -> Vector3<f64> {
    if from == to {
        return from;
    }
    let across = from.cross(&to);
    let sine = across.norm();
    let angle = libm::atan2(sine, from.dot(&to));
    if sine < SAME {
        let straight = from + (to - from) * t;
        return match angle < 1.0 {
            true => straight.normalize(),
            false => turned_about(from, any_across(from), angle * t),
        };
    }
    turned_about(from, across / sine, angle * t)
}

fn turned_about(vector: Vector3<f64>, k: Vector3<f64>, angle: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(angle);
    vector * cosine + k.cross(&vector) * sine
}

/// A unit vector across another.
fn any_across(vector: Vector3<f64>) -> Vector3<f64> {
    let least = vector.iamin();
    let mut other = Vector3::zeros();
    other[least] = 1.0;
    vector.cross(&other).normalize()
}
