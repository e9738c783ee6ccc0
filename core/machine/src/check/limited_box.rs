//! The box of tips that limits between the axes leave of the travel of the linear axes.

use nalgebra::Vector3;

use super::probe::Probe;
use crate::dependent_limit::DependentLimit;
use crate::kinematics::{Joints, MAX_AXES};

/// Places of an axis that a limit names, by how many of them are looked at together.
const PLACES: [usize; 4] = [1, 2001, 101, 25];

/// The way to an end is narrowed down to this share of the step between two places.
const NARROW: f64 = 1e-6;

/// Least and largest tip, part frame, mm, while the rotary axes stand, and the limits that take something off it.
pub(super) struct LimitedBox {
    /// None: the limits leave nothing that was looked at.
    pub(super) ends: Option<[Vector3<f64>; 2]>,
    pub(super) limited_by: Vec<String>,
}

/// The search for the ends.
struct Search<'a> {
    probe: &'a Probe<'a>,
    limits: Vec<&'a DependentLimit>,
    /// Linear joints that limits name, and the others.
    named: Vec<usize>,
    others: Vec<usize>,
    /// How far the tip goes for a mm of each joint.
    ways: [Vector3<f64>; MAX_AXES],
}

impl LimitedBox {
    /// The rotary axes standing as in `at`, the linear ones of `linear` anywhere in their travel.
    pub(super) fn of(probe: &Probe<'_>, at: &Joints, linear: &[usize]) -> Self {
        let machine = probe.machine();
        let names = |limit: &DependentLimit, joint: usize| limit.joints().any(|own| own == joint);
        let limits: Vec<&DependentLimit> = machine.limits.iter().collect();
        let (named, others): (Vec<usize>, Vec<usize>) =
            linear.iter().partition(|joint| limits.iter().any(|limit| names(limit, **joint)));
        let stands = probe.chain().forward(at).tip;
        let mut ways = [Vector3::zeros(); MAX_AXES];
        for joint in linear {
            let mut moved = *at;
            moved[*joint] += 1.0;
            ways[*joint] = probe.chain().forward(&moved).tip - stands;
        }
        let search = Search { probe, limits, named, others, ways };
        search.ends(at, stands)
    }
}

impl Search<'_> {
    fn ends(&self, at: &Joints, stands: Vector3<f64>) -> LimitedBox {
        let count = self.named.len();
        let places = PLACES.get(count).copied().unwrap_or(9);
        let mut best: [Option<(f64, Joints)>; 6] = [None; 6];
        let mut passed = vec![false; self.limits.len()];
        for number in 0..places.pow(count as u32) {
            let mut joints = *at;
            let mut digits = number;
            for joint in &self.named {
                let [least, most] = self.probe.span(*joint);
                let share = (digits % places) as f64 / (places - 1).max(1) as f64;
                joints[*joint] = least + (most - least) * share;
                digits /= places;
            }
            let mut holds = true;
            for (limit, passed) in self.limits.iter().zip(&mut passed) {
                let own = limit.margin(&joints) >= 0.0;
                *passed |= !own;
                holds &= own;
            }
            if !holds {
                continue;
            }
            for (side, best) in best.iter_mut().enumerate() {
                let value = self.value(side, &joints);
                if best.is_none_or(|(known, _)| value > known) {
                    *best = Some((value, joints));
                }
            }
        }
        let all = self.limits.iter().zip(&passed).filter(|(_, passed)| **passed);
        let limited_by: Vec<String> = all.map(|(limit, _)| limit.text().to_owned()).collect();
        let mut ends = [stands; 2];
        for (side, best) in best.into_iter().enumerate() {
            let Some((_, mut joints)) = best else {
                return LimitedBox { ends: None, limited_by };
            };
            if !limited_by.is_empty() {
                self.narrow(side, &mut joints, places);
            }
            for joint in &self.others {
                let [least, most] = self.probe.span(*joint);
                let grows = self.rate(side, *joint) > 0.0;
                joints[*joint] = if grows { most } else { least };
            }
            ends[side % 2][side / 2] = self.probe.chain().forward(&joints).tip[side / 2];
        }
        LimitedBox { ends: Some(ends), limited_by }
    }

    /// How fast the tip goes towards a side, by a joint: sides are X-, X+, Y-, Y+, Z-, Z+.
    fn rate(&self, side: usize, joint: usize) -> f64 {
        let sign = if side.is_multiple_of(2) { -1.0 } else { 1.0 };
        sign * self.ways[joint][side / 2]
    }

    /// How far the joints that limits name bring the tip towards a side, mm.
    fn value(&self, side: usize, joints: &Joints) -> f64 {
        self.named.iter().map(|joint| self.rate(side, *joint) * joints[*joint]).sum()
    }

    /// Goes on towards a side as long as the limits hold, by ever shorter steps.
    fn narrow(&self, side: usize, joints: &mut Joints, places: usize) {
        let mut step = 1.0;
        while step > NARROW {
            let value = self.value(side, joints);
            let ways = 3usize.pow(self.named.len() as u32);
            let better = (0..ways).find_map(|way| {
                let mut next = *joints;
                let mut digits = way;
                for joint in &self.named {
                    let [least, most] = self.probe.span(*joint);
                    let by = (most - least) / (places - 1).max(1) as f64 * step;
                    next[*joint] =
                        (next[*joint] + by * (digits % 3) as f64 - by).clamp(least, most);
                    digits /= 3;
                }
                let farther = self.value(side, &next) > value;
                (farther && self.limits.iter().all(|limit| limit.margin(&next) >= 0.0))
                    .then_some(next)
            });
            match better {
                Some(next) => *joints = next,
                None => step /= 2.0,
            }
        }
    }
}
