//! Where paths that part come together again.

use std::collections::{BTreeMap, VecDeque};

use super::steps::{PathPosition, PathStep};

/// So many steps of either path are looked through.
pub(super) const LOOK: usize = 3000;

/// Steps of each path up to where they meet: the pair with the fewest, the place where both are now left out. None if
/// they do not meet as far as is looked. `here` is where each stands.
pub(super) fn meeting(
    here: [&PathPosition; 2],
    old: &VecDeque<PathStep>,
    new: &VecDeque<PathStep>,
    near: f64,
) -> Option<[usize; 2]> {
    let cell = |spot: &PathPosition| -> [i64; 3] {
        let tip = spot.pose.tip;
        [tip.x, tip.y, tip.z].map(|part| libm::floor(part / near) as i64)
    };
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    let spots = |here, steps| spots(here, steps);
    for (index, spot) in spots(here[1], new).enumerate() {
        cells.entry(cell(spot)).or_default().push(index);
    }
    let mut best: Option<[usize; 2]> = None;
    for (index, spot) in spots(here[0], old).enumerate() {
        if best.is_some_and(|[old, new]| index > old + new) {
            break;
        }
        let [x, y, z] = cell(spot);
        for around in 0..27 {
            let around = [x + around % 3 - 1, y + around / 3 % 3 - 1, z + around / 9 - 1];
            for other in cells.get(&around).into_iter().flatten() {
                let fewer = best.is_none_or(|[old, new]| index + other < old + new);
                if index + other > 0 && fewer && go_on_alike([old, new], [index, *other], near) {
                    best = Some([index, *other]);
                }
            }
        }
    }
    best
}

/// Where a path stands and the ends of its steps.
fn spots<'a>(
    here: &'a PathPosition,
    steps: &'a VecDeque<PathStep>,
) -> impl Iterator<Item = &'a PathPosition> {
    std::iter::once(here).chain(steps.iter().map(|step| &step.to))
}

/// Both are close, and what follows is of one kind and goes the same way.
fn go_on_alike(steps: [&VecDeque<PathStep>; 2], from: [usize; 2], near: f64) -> bool {
    let spot = |side: usize| match from[side] {
        0 => steps[side].front().map(|step| &step.from),
        behind => steps[side].get(behind - 1).map(|step| &step.to),
    };
    let (Some(old), Some(new)) = (spot(0), spot(1)) else {
        return false;
    };
    if old.distance(new) > near {
        return false;
    }
    match (steps[0].get(from[0]), steps[1].get(from[1])) {
        (Some(old), Some(new)) => {
            let ways = [old, new].map(|step| step.to.pose.tip - step.from.pose.tip);
            let [a, b] = ways.map(|way| way.try_normalize(1e-9));
            let alike = match (a, b) {
                (Some(a), Some(b)) => a.dot(&b) > 0.9,
                (a, b) => a.is_none() == b.is_none(),
            };
            old.is_like(new) && alike
        }
        // The end of both.
        (None, None) => true,
        _ => false,
    }
}
