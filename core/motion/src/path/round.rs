//! Points and directions between two others, on straight lines' next of kin: arcs and great circles.

use nalgebra::Vector3;
use post_machine::kinematics::batch::{LANES, groups};
use post_machine::kinematics::lane_math::{atan2_all, sincos_all};

/// Directions nearer than this are one: the sine of their angle.
const SAME: f64 = 1e-12;

/// The arm of a point from an axis, and its height along it.
pub fn arm_and_height(
    tip: Vector3<f64>,
    centre: Vector3<f64>,
    normal: Vector3<f64>,
) -> (Vector3<f64>, f64) {
    let offset = tip - centre;
    let height = normal.dot(&offset);
    (offset - normal * height, height)
}

/// The point at `t` on the way round an axis from one point to another.
pub fn on_arc(
    ends: [Vector3<f64>; 2],
    centre: Vector3<f64>,
    normal: Vector3<f64>,
    sweep: f64,
    t: f64,
) -> Vector3<f64> {
    let [(arm, low), (last, high)] = ends.map(|tip| arm_and_height(tip, centre, normal));
    let first = arm.norm();
    let radius = first + (last.norm() - first) * t;
    let (sine, cosine) = libm::sincos(sweep * t);
    let out = match first > 0.0 {
        true => arm / first,
        false => Vector3::zeros(),
    };
    let turned = out * cosine + normal.cross(&out) * sine;
    let error = ends[1] - (centre + turned_about(out, normal, sweep) * last.norm() + normal * high);
    // Ends of a program are rounded: the way ends where it says, the difference spread over it.
    centre + turned * radius + normal * (low + (high - low) * t) + error * t
}

/// The unit vector at `t` on the great circle from one to the other; of opposite ones about any direction across.
pub fn between(from: Vector3<f64>, to: Vector3<f64>, t: f64) -> Vector3<f64> {
    GreatCircle::new(from, to).at(t)
}

/// The shorter way from one unit vector to another; between opposite ones about any direction across.
#[derive(Clone, Copy, Debug)]
pub struct GreatCircle {
    from: Vector3<f64>,
    to: Vector3<f64>,
    /// What it turns about, unit vector; none where it goes as good as nowhere.
    about: Option<Vector3<f64>>,
    /// The whole turn, radians.
    pub angle: f64,
}

impl GreatCircle {
    /// The shorter way between two unit vectors.
    pub fn new(from: Vector3<f64>, to: Vector3<f64>) -> Self {
        let mut circle = Self { from, to, about: None, angle: 0.0 };
        if from == to {
            return circle;
        }
        let across = from.cross(&to);
        let sine = across.norm();
        circle.angle = libm::atan2(sine, from.dot(&to));
        circle.about = match sine < SAME {
            true if circle.angle < 1.0 => None,
            true => Some(any_across(from)),
            false => Some(across / sine),
        };
        circle
    }

    /// The unit vector at `t` from 0 to 1 of it.
    pub fn at(&self, t: f64) -> Vector3<f64> {
        match self.about {
            Some(about) => turned_about(self.from, about, self.angle * t),
            None if self.from == self.to => self.from,
            None => (self.from + (self.to - self.from) * t).normalize(),
        }
    }
}

/// Fills in where the great circle from each of `axes` to the next ends, all unit vectors: [`between`] at 1, for up to
/// [`LANES`] of them at once.
pub fn circle_ends(axes: &[Vector3<f64>], ends: &mut Vec<Vector3<f64>>) {
    ends.clear();
    for axes in axes.windows(2).collect::<Vec<_>>().chunks(LANES) {
        let count = axes.len();
        let [mut sine, mut cosine, mut angle] = [[0.0; LANES]; 3];
        let [mut sine_of, mut cosine_of] = [[0.0; LANES]; 2];
        for (lane, pair) in axes.iter().enumerate() {
            sine[lane] = pair[0].cross(&pair[1]).norm();
            cosine[lane] = pair[0].dot(&pair[1]);
        }
        for lanes in [&mut sine, &mut cosine] {
            let last = lanes[count - 1];
            lanes[count..groups(count)].fill(last);
        }
        atan2_all(&sine, &cosine, count, &mut angle);
        let last = angle[count - 1];
        angle[count..groups(count)].fill(last);
        sincos_all(&angle, count, &mut sine_of, &mut cosine_of);
        ends.extend(axes.iter().enumerate().map(|(lane, pair)| {
            let (from, to) = (pair[0], pair[1]);
            if from == to || sine[lane] < SAME {
                return between(from, to, 1.0);
            }
            let about = from.cross(&to) / sine[lane];
            turned_by(from, about, [sine_of[lane], cosine_of[lane]])
        }));
    }
}

/// A vector turned about the unit vector `k`, right-handed, radians.
fn turned_about(vector: Vector3<f64>, k: Vector3<f64>, angle: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(angle);
    turned_by(vector, k, [sine, cosine])
}

/// A vector turned about the unit vector `k` by the angle of this sine and cosine.
#[inline]
fn turned_by(vector: Vector3<f64>, k: Vector3<f64>, [sine, cosine]: [f64; 2]) -> Vector3<f64> {
    vector * cosine + k.cross(&vector) * sine
}

/// A unit vector across another.
fn any_across(vector: Vector3<f64>) -> Vector3<f64> {
    let least = vector.iamin();
    let mut other = Vector3::zeros();
    other[least] = 1.0;
    vector.cross(&other).normalize()
}
