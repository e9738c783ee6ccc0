//! The cutting edge of a disc: how far it strays because the tool turns, wherever the control point goes.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::curve::{Peak, peak};
use post_machine::kinematics::{Chain, Joints};
use post_posting::accuracy::certificate::{across, longest_around};

/// The circle across the tool axis on which a cutting edge of radius 1 mm lies.
#[derive(Clone, Debug)]
pub struct Rim {
    /// The chain with one and with the other of two directions across the tool axis.
    chains: [Chain; 2],
}

impl Rim {
    /// The rim of a tool whose axis is `axis` with all axes at zero, machine frame.
    pub fn new(chain: &Chain, axis: Vector3<f64>) -> Self {
        Self { chains: across(axis).map(|edge| chain.clone().with_edge(Some(edge))) }
    }

    /// How far a point of the rim strays at most from its chord, per mm of radius, while the axes go linearly
    /// between two sets of values (`|E|/R` of eq. 10 of the parabolic paper, by the chain itself).
    pub fn bow(&self, from: &Joints, to: &Joints) -> Peak {
        let bows = self.bows(from, to);
        peak(|t| {
            let [a, b] = bows(t);
            longest_around(a, b)
        })
    }

    /// How far a point of an edge of some `radius`, mm, strays at most from its own chord, mm, if the middle of the
    /// edge strays as `middle` says.
    pub fn strays(
        &self,
        radius: f64,
        (from, to): (&Joints, &Joints),
        middle: impl Fn(f64) -> Vector3<f64>,
    ) -> Peak {
        let bows = self.bows(from, to);
        peak(|t| {
            let middle = middle(t);
            let [a, b] = bows(t);
            let around = |share: f64| {
                let (sine, cosine) = libm::sincos(TAU * share);
                (middle + (a * cosine + b * sine) * radius).norm()
            };
            peak(around).size
        })
    }

    /// How the two directions stray from the straight line between their ends at a share of the move.
    fn bows(&self, from: &Joints, to: &Joints) -> impl Fn(f64) -> [Vector3<f64>; 2] {
        let edges =
            |joints: &Joints| self.chains.each_ref().map(|chain| chain.forward(joints).edge);
        let (first, last) = (edges(from), edges(to));
        let (from, to) = (*from, *to);
        move |t| {
            let joints: Joints =
                std::array::from_fn(|joint| from[joint] * (1.0 - t) + to[joint] * t);
            let at = edges(&joints);
            [0, 1].map(|edge| at[edge] - first[edge] * (1.0 - t) - last[edge] * t)
        }
    }

    /// Eq. 10 of the parabolic paper (Sha et al. 2022) per mm of radius: the root of the sum of the fourth powers of
    /// the turns, radians, over 8. It leaves out what two axes that turn together add to each other.
    pub fn formula(turns: impl Iterator<Item = f64>) -> f64 {
        let sum: f64 = turns.map(|turn| turn * turn * turn * turn).sum();
        libm::sqrt(sum) / 8.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use post_machine::kinematics::Joint;

    fn head() -> Chain {
        let turn = |direction| Joint { rotary: true, direction, point: Vector3::zeros() };
        Chain::new(
            vec![turn(Vector3::z()), turn(Vector3::x())],
            Vector3::zeros(),
            Vector3::new(0.0, 0.0, -312.0),
            Vector3::z(),
        )
    }

    fn joints(c: f64, a: f64) -> Joints {
        let mut joints = Joints::default();
        (joints[0], joints[1]) = (c, a);
        joints
    }

    /// One axis alone: the rim strays by 1 - cos(Δ/2), which is Δ²/8 but for the fourth power.
    #[test]
    fn one_axis_bows_the_rim_by_the_formula() {
        let rim = Rim::new(&head(), Vector3::z());
        for turn in [0.01, 0.05, 0.1] {
            let bow = rim.bow(&joints(0.3, 0.2), &joints(0.3, 0.2 + turn));
            assert!((bow.size - (1.0 - libm::cos(turn / 2.0))).abs() < 1e-12);
            assert!((bow.at - 0.5).abs() < 1e-3);
            let formula = Rim::formula([turn, 0.0].into_iter());
            assert!((bow.size / formula - 1.0).abs() < turn * turn / 10.0);
        }
    }

    /// The middle of the edge and the edge stray to the same side at one place of the circle: there it adds up.
    #[test]
    fn an_edge_strays_by_its_middle_and_its_bow() {
        let rim = Rim::new(&head(), Vector3::z());
        let (from, to) = (joints(0.0, 1.0), joints(0.0, 1.1));
        let bow = rim.bow(&from, &to).size;
        let flat = |_: f64| Vector3::zeros();
        let edge = rim.strays(25.0, (&from, &to), flat).size;
        assert!((edge - 25.0 * bow).abs() < 1e-9);
        let across = Vector3::new(0.0, libm::cos(1.05), libm::sin(1.05));
        let edge = rim.strays(25.0, (&from, &to), |_| across * 0.01).size;
        assert!((edge - 25.0 * bow - 0.01).abs() < 1e-6, "{edge} {bow}");
    }

    /// Tool upright: C and A together turn the rim by the cross term 2·ΔA·ΔC as well, which eq. 10 leaves out.
    #[test]
    fn two_axes_bow_it_by_more() {
        let rim = Rim::new(&head(), Vector3::z());
        let bow = rim.bow(&joints(0.0, -0.05), &joints(0.1, 0.05));
        let formula = Rim::formula([0.1, 0.1].into_iter());
        assert!(bow.size > 1.2 * formula, "{} {formula}", bow.size);
    }
}
