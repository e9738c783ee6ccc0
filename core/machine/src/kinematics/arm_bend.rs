//! How far a tip strays from straight, as the arms that it is turned on tell, without a sine.

use nalgebra::Vector3;

use super::chain::{Chain, Joints};

/// Bounds on a point behind rotary joints, joint by joint.
pub(super) struct ArmBend {
    /// Where the arm begins, mm.
    place: Vector3<f64>,
    /// Length of the arm, mm.
    arm: f64,
    /// First derivative, mm.
    pub(super) slope: f64,
    /// Second derivative, mm.
    pub(super) bend: f64,
}

impl ArmBend {
    /// Of a point that is up to `arm` from `place`, mm, and goes at `slope` at most.
    pub(super) fn at(place: Vector3<f64>, arm: f64, slope: f64) -> Self {
        Self { place, arm, slope, bend: 0.0 }
    }

    /// Beyond a joint through `point` that turns by `w`, radians.
    #[inline]
    pub(super) fn pass(&mut self, point: Vector3<f64>, w: f64) {
        self.arm += (self.place - point).norm();
        self.place = point;
        self.bend += w * (w * self.arm + 2.0 * self.slope);
        self.slope += w * self.arm;
    }

    /// Beyond a joint that slides along `way` by up to `w` mm, from where it stands on `way`.
    #[inline]
    fn slide(&mut self, way: Vector3<f64>, w: f64) {
        self.place += way;
        self.arm += w;
        self.slope += w;
    }
}

impl Chain {
    /// A bound on the second derivative of the tip where all axes go linearly between two places, by their share of the way,
    /// mm: from the line between its ends the tip strays by an eighth of it at most.
    #[inline]
    pub fn bend_by_arms(&self, ends: [&Joints; 2]) -> f64 {
        self.bend_by_arms_within(0.0, ends)
    }

    /// [`Chain::bend_by_arms`] of all that moves with the tip within `radius` of it, mm.
    #[inline]
    pub fn bend_by_arms_within(&self, radius: f64, ends: [&Joints; 2]) -> f64 {
        let mut tip = ArmBend::at(self.tip(), radius, 0.0);
        for (index, joint) in self.joints().iter().enumerate().rev() {
            let step = (ends[1][index] - ends[0][index]).abs();
            match joint.rotary {
                true => tip.pass(joint.point, step),
                false => tip.slide(joint.direction * ends[0][index], step),
            }
        }
        tip.bend
    }
}

#[cfg(test)]
mod tests {
    use post_testkit::randomised;

    use super::super::chain::{Joint, MAX_AXES};
    use super::*;

    #[test]
    fn no_tip_strays_farther_than_its_arms_tell() {
        let (rounds, mut rng) = randomised(300, 5);
        let mut nearest: f64 = 0.0;
        for _ in rounds {
            let joints: Vec<Joint> = (0..5)
                .map(|_| Joint {
                    rotary: rng.pick(2) == 0,
                    direction: rng.direction(),
                    point: rng.point(300.0),
                })
                .collect();
            let chain = Chain::new(joints, rng.point(50.0), rng.point(400.0), rng.direction());
            let mut ends = [[0.0; MAX_AXES]; 2];
            for (index, joint) in chain.joints().iter().enumerate() {
                let (far, step) = if joint.rotary { (3.0, 0.2) } else { (200.0, 30.0) };
                ends[0][index] = rng.range(-far, far);
                ends[1][index] = ends[0][index] + rng.range(-step, step);
            }
            let tips = ends.map(|joints| chain.forward(&joints).tip);
            let bound = chain.bend_by_arms([&ends[0], &ends[1]]) / 8.0;
            for look in 1..16 {
                let t = f64::from(look) / 16.0;
                let joints = std::array::from_fn(|index| {
                    ends[0][index] + (ends[1][index] - ends[0][index]) * t
                });
                let off = chain.forward(&joints).tip - (tips[0] + (tips[1] - tips[0]) * t);
                assert!(off.norm() <= bound + 1e-9, "{} {bound}", off.norm());
                if bound > 0.0 {
                    nearest = nearest.max(off.norm() / bound);
                }
            }
        }
        assert!(nearest > 0.05, "{nearest}");
    }
}
