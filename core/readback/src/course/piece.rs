//! Where the tool stands on a piece.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;
use post_motion::path::{arm_and_height, between, on_arc};

use super::{Curve, Piece};

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
            Curve::Arc { centre, normal, sweep } => {
                on_arc([from.tip, to.tip], *centre, *normal, *sweep, t)
            }
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
            Curve::Arc { centre, normal, sweep } => {
                let [from, to] = ends.map(|tip| arm_and_height(tip, *centre, *normal));
                let rise = to.1 - from.1;
                let radius = 0.5 * (from.0.norm() + to.0.norm());
                libm::hypot(radius * sweep, rise)
            }
            Curve::Spline(way) => way.length(),
        }
    }

    /// The least and largest coordinates of the tip on it, mm. Of an arc the quarters count, of a spline its poles, between
    /// which it stays.
    pub fn extents(&self) -> [Vector3<f64>; 2] {
        let mut box_of = [self.from.tip.inf(&self.to.tip), self.from.tip.sup(&self.to.tip)];
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
        let (arm, _) = arm_and_height(self.from.tip, *centre, normal);
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
