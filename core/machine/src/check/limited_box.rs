//! The box of tips that limits between the axes leave of the travel of the linear axes.
//!
//! Each end of the box is looked for by branch and bound: boxes of axis values are halved, the one that could lead the tip
//! farthest first; one in which a limit is proven to hold nowhere is given up. So the end lies between the farthest place that
//! was found and the farthest that is not ruled out, and both are told.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nalgebra::Vector3;

use super::probe::Probe;
use crate::dependent_limit::DependentLimit;
use crate::kinematics::{Joints, MAX_AXES};

/// An end is known if no more than this is not ruled out, mm.
const ENOUGH: f64 = 0.001;

/// Boxes that are halved for one end, at most.
const MOST_BOXES: usize = 20_000;

/// Halvings of the way from the middle of a box to its farthest corner, on which the last place is looked for.
const HALVINGS: u32 = 12;

/// Least and largest tip, part frame, mm, while the rotary axes stand, and the limits that take something off it.
pub(super) struct LimitedBox {
    /// None: the limits leave nothing that was looked at.
    pub(super) ends: Option<[Vector3<f64>; 2]>,
    /// By how much an end may lie farther out than the place that was found, mm; none where that is less than the program's
    /// digits.
    pub(super) open: Option<f64>,
    pub(super) limited_by: Vec<String>,
}

/// The search for the ends.
struct Search<'a> {
    limits: Vec<&'a DependentLimit>,
    /// Linear joints that limits name.
    named: Vec<usize>,
    /// How far the tip goes for a mm of each joint.
    ways: [Vector3<f64>; MAX_AXES],
}

/// Axis values between two places.
struct Region {
    least: Joints,
    most: Joints,
    /// How far the joints that limits name bring the tip towards the side at most, mm.
    farthest: f64,
}

/// The end towards a side.
struct End {
    /// The farthest place that was found, and how far that is, mm.
    found: Option<(f64, Joints)>,
    /// Nothing lies farther, mm.
    bound: f64,
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
        let [mut least, mut most] = [*at; 2];
        for joint in &named {
            [least[*joint], most[*joint]] = probe.span(*joint);
        }
        let passed = |limit: &&&DependentLimit| {
            let place = limit.passed_between([&least, &most]);
            place.is_some_and(|joints| !limit.holds(&joints))
        };
        let limited_by =
            limits.iter().filter(passed).map(|limit| limit.text().to_owned()).collect();
        let search = Search { limits, named, ways };
        let mut ends = [stands; 2];
        let mut open: f64 = 0.0;
        for side in 0..6 {
            let End { found, bound } = search.end(side, (least, most));
            let Some((value, mut joints)) = found else {
                return LimitedBox { ends: None, open: None, limited_by };
            };
            open = open.max(bound - value);
            for joint in &others {
                let [least, most] = probe.span(*joint);
                let grows = search.rate(side, *joint) > 0.0;
                joints[*joint] = if grows { most } else { least };
            }
            ends[side % 2][side / 2] = probe.chain().forward(&joints).tip[side / 2];
        }
        LimitedBox {
            ends: Some(ends),
            open: Some(open).filter(|open| *open > 2.0 * ENOUGH),
            limited_by,
        }
    }
}

impl Search<'_> {
    /// The end towards a side: sides are X-, X+, Y-, Y+, Z-, Z+.
    fn end(&self, side: usize, (least, most): (Joints, Joints)) -> End {
        let mut regions = BinaryHeap::from([self.region(side, least, most)]);
        let mut found: Option<(f64, Joints)> = None;
        for _ in 0..MOST_BOXES {
            let Some(region) = regions.pop() else {
                break;
            };
            if found.is_some_and(|(value, _)| region.farthest <= value + ENOUGH) {
                return End { found, bound: region.farthest };
            }
            let Region { least, most, farthest } = &region;
            if self.limits.iter().any(|limit| limit.is_out([least, most])) {
                continue;
            }
            if let Some(last) = self.last_on_the_way(side, &region) {
                let value = self.value(side, &last);
                if found.is_none_or(|(known, _)| value > known) {
                    found = Some((value, last));
                }
                if value >= *farthest {
                    continue;
                }
            }
            let width = |joint: &usize| most[*joint] - least[*joint];
            let widest = self.named.iter().max_by(|a, b| width(a).total_cmp(&width(b)));
            let Some(widest) = widest.filter(|widest| width(widest) > 0.0) else {
                continue;
            };
            let middle = 0.5 * (least[*widest] + most[*widest]);
            let (mut below, mut above) = (*most, *least);
            below[*widest] = middle;
            above[*widest] = middle;
            regions.push(self.region(side, *least, below));
            regions.push(self.region(side, above, *most));
        }
        let value = found.map_or(f64::NEG_INFINITY, |(value, _)| value);
        let bound = regions.peek().map_or(value, |region| region.farthest.max(value));
        End { found, bound }
    }

    fn region(&self, side: usize, least: Joints, most: Joints) -> Region {
        let far = |joint: &usize| {
            let rate = self.rate(side, *joint);
            (rate * least[*joint]).max(rate * most[*joint])
        };
        Region { least, most, farthest: self.named.iter().map(far).sum() }
    }

    /// The last place at which all limits hold on the way from the middle of a region to the corner that leads farthest;
    /// none where they do not hold in the middle.
    fn last_on_the_way(&self, side: usize, region: &Region) -> Option<Joints> {
        let [mut inside, mut outside] = [region.least; 2];
        for joint in &self.named {
            let [least, most] = [region.least[*joint], region.most[*joint]];
            inside[*joint] = 0.5 * (least + most);
            outside[*joint] = if self.rate(side, *joint) > 0.0 { most } else { least };
        }
        if self.hold(&outside) {
            return Some(outside);
        }
        if !self.hold(&inside) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = std::array::from_fn(|joint| 0.5 * (inside[joint] + outside[joint]));
            match self.hold(&middle) {
                true => inside = middle,
                false => outside = middle,
            }
        }
        Some(inside)
    }

    fn hold(&self, joints: &Joints) -> bool {
        self.limits.iter().all(|limit| limit.margin(joints) >= 0.0)
    }

    /// How fast the tip goes towards a side, by a joint.
    fn rate(&self, side: usize, joint: usize) -> f64 {
        let sign = if side.is_multiple_of(2) { -1.0 } else { 1.0 };
        sign * self.ways[joint][side / 2]
    }

    /// How far the joints that limits name bring the tip towards a side, mm.
    fn value(&self, side: usize, joints: &Joints) -> f64 {
        self.named.iter().map(|joint| self.rate(side, *joint) * joints[*joint]).sum()
    }
}

impl Ord for Region {
    fn cmp(&self, other: &Self) -> Ordering {
        self.farthest.total_cmp(&other.farthest)
    }
}

impl PartialOrd for Region {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Region {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Region {}
