//! What limits that depend on other axes leave of the travel.

use std::collections::VecDeque;

use serde::Serialize;

use super::pointing::AxisReadout;
use super::probe::Probe;
use crate::dependent_limit::DependentLimit;
use crate::kinematics::Joints;

/// Places of an axis at which a limit is looked at, over its travel.
const PLACES: u32 = 2000;

/// Halvings between a place where a limit holds and one where it does not.
const HALVINGS: u32 = 40;

/// Boxes of axis values in which a place where a limit holds is looked for, at most.
const MOST_BOXES: usize = 20_000;

/// A limit, and what it leaves of the travel of one axis while another goes over its own.
#[derive(Clone, Debug, Serialize)]
pub struct LimitReport {
    /// The limit as the machine file has it.
    pub keep: String,
    /// The axis whose room is told: the first linear one that the limit names, else the first.
    pub axis: String,
    /// `mm` or `deg`.
    pub unit: &'static str,
    /// Its room.
    pub rooms: Vec<LimitRoom>,
}

/// What a limit leaves of the travel of an axis.
#[derive(Clone, Debug, Serialize)]
pub struct LimitRoom {
    /// Where another axis stands; those that are not told are at rest.
    pub with: Option<AxisReadout>,
    /// Least and largest reading at which it holds; none: it holds nowhere.
    pub room: Option<[f64; 2]>,
}

/// The limits of a machine, and what looks wrong with them.
pub(super) fn told(probe: &Probe<'_>) -> (Vec<LimitReport>, Vec<String>) {
    let mut warnings = Vec::new();
    let limits = &probe.machine().limits;
    let formulas = limits.iter().filter(|limit| limit.leg().is_none());
    let reports = formulas.map(|limit| report(probe, limit, &mut warnings)).collect();
    (reports, warnings)
}

fn report(probe: &Probe<'_>, limit: &DependentLimit, warnings: &mut Vec<String>) -> LimitReport {
    let axes = &probe.machine().axes;
    let mut named: Vec<usize> = Vec::new();
    for joint in limit.joints() {
        if !named.contains(&joint) {
            named.push(joint);
        }
    }
    let first = named.iter().copied().find(|joint| !axes[*joint].joint.rotary);
    let own = first.or(named.first().copied()).unwrap_or_default();
    let mut rooms = Vec::new();
    for other in named.iter().copied().filter(|joint| *joint != own) {
        let [least, most] = probe.span(other);
        let home = probe.home()[other];
        let mut values = vec![least, home, most];
        values.dedup();
        for value in values {
            let mut joints = *probe.home();
            joints[other] = value;
            let axis = &axes[other];
            let with = AxisReadout { axis: axis.name.clone(), value: axis.reading(value) };
            rooms.push(LimitRoom { with: Some(with), room: room(probe, limit, own, joints) });
        }
    }
    if rooms.is_empty() {
        rooms.push(LimitRoom { with: None, room: room(probe, limit, own, *probe.home()) });
    }
    let ends: [Joints; 2] = [0, 1].map(|end| {
        let mut joints = *probe.home();
        named.iter().for_each(|joint| joints[*joint] = probe.span(*joint)[end]);
        joints
    });
    if limit.least_margin([&ends[0], &ends[1]]) >= 0.0 {
        warnings.push(format!(
            "[[limit]] `{}` holds everywhere inside travel: it limits nothing; is a sign or a side wrong?",
            limit.text()
        ));
    } else if rooms.iter().all(|room| room.room.is_none())
        && let Some(nowhere) = holds_nowhere(limit, &named, ends)
    {
        warnings.push(format!(
            "[[limit]] `{}` holds {nowhere}; is a sign or a side wrong?",
            limit.text()
        ));
    }
    LimitReport {
        keep: limit.text().to_owned(),
        axis: axes[own].name.clone(),
        unit: axes[own].unit_name(),
        rooms,
    }
}

/// Where a limit holds nowhere, the axes of `named` between their values in `ends`, as far as that is known; none if there is
/// a place where it holds.
fn holds_nowhere(
    limit: &DependentLimit,
    named: &[usize],
    ends: [Joints; 2],
) -> Option<&'static str> {
    let mut boxes = VecDeque::from([ends]);
    for _ in 0..MOST_BOXES {
        let Some([least, most]) = boxes.pop_front() else {
            return Some("nowhere inside travel");
        };
        let middle: Joints = std::array::from_fn(|joint| 0.5 * (least[joint] + most[joint]));
        if limit.margin(&middle) >= 0.0 {
            return None;
        }
        if limit.is_out([&least, &most]) {
            continue;
        }
        // Of angles the whole turn counts as the whole travel of a slide.
        let share = |joint: &usize| {
            let whole = ends[1][*joint] - ends[0][*joint];
            (most[*joint] - least[*joint]) / whole.max(f64::MIN_POSITIVE)
        };
        let widest = named.iter().max_by(|a, b| share(a).total_cmp(&share(b)));
        let Some(widest) = widest.filter(|joint| share(joint) > 0.0) else {
            continue;
        };
        let (mut below, mut above) = (most, least);
        below[*widest] = middle[*widest];
        above[*widest] = middle[*widest];
        boxes.extend([[least, below], [above, most]]);
    }
    Some("nowhere that was looked at inside travel")
}

/// Least and largest reading of an axis inside its travel at which a limit holds, the others as in `joints`.
fn room(probe: &Probe<'_>, limit: &DependentLimit, own: usize, joints: Joints) -> Option<[f64; 2]> {
    let axis = &probe.machine().axes[own];
    let [least, most] = probe.span(own);
    let holds = |value: f64| {
        let mut joints = joints;
        joints[own] = value;
        limit.margin(&joints) >= 0.0
    };
    let place = |index: u32| least + (most - least) * f64::from(index) / f64::from(PLACES);
    let first = (0..=PLACES).find(|index| holds(place(*index)))?;
    let last = (0..=PLACES).rev().find(|index| holds(place(*index)))?;
    let end = |inside: u32, outside: Option<u32>| {
        let mut inside = place(inside);
        let Some(mut outside) = outside.map(place) else {
            return axis.reading(inside);
        };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            match holds(middle) {
                true => inside = middle,
                false => outside = middle,
            }
        }
        axis.reading(inside)
    };
    Some([end(first, first.checked_sub(1)), end(last, Some(last + 1).filter(|at| *at <= PLACES))])
}
