//! Where the tip can go with the tool upright in the part.

use nalgebra::Vector3;
use serde::Serialize;

use super::limited_box::LimitedBox;
use super::pointing::AxisReadout;
use super::probe::Probe;
use crate::kinematics::Joints;
use crate::kinematics::travel::passed;

/// The box of tips, part frame.
#[derive(Clone, Debug, Serialize)]
pub struct Volume {
    /// Tool axis, part frame: +Z if it can be made, else that of the axes at rest.
    pub axis: [f64; 3],
    /// Where the rotary axes stand for it.
    pub rotary: Vec<AxisReadout>,
    /// Least tip, mm; none where rotary axes place the tip too, or limits between the axes leave nothing.
    pub least: Option<[f64; 3]>,
    /// Largest tip, mm; none where the least is none.
    pub most: Option<[f64; 3]>,
    /// Limits between the axes that take something off what the travel alone would leave: `[[limit]]` as it is written, and
    /// legs by their names.
    pub limited_by: Vec<String>,
    /// By how much an end may lie farther out than is told, mm, where limits leave that open; none where nothing is.
    pub open_mm: Option<f64>,
    /// Axes that stand outside their travel with the tip on the part origin.
    pub origin_out: Vec<OutsideTravel>,
    /// What says of the limits between the axes that do not hold with the tip on the part origin.
    pub origin_beyond: Vec<String>,
}

/// A value outside travel.
#[derive(Clone, Debug, Serialize)]
pub struct OutsideTravel {
    /// Address of the axis.
    pub axis: String,
    /// Reading that is asked for.
    pub value: f64,
    /// Least and largest reading.
    pub travel: [f64; 2],
}

impl Volume {
    /// None if the linear axes cannot be solved there.
    pub(super) fn of(probe: &Probe<'_>) -> Option<Self> {
        let upright = first(probe, Vector3::z());
        let (axis, at_origin) = match upright {
            Some(joints) => (Vector3::z(), joints),
            None => {
                let axis = probe.chain().forward(probe.home()).axis;
                (axis, first(probe, axis)?)
            }
        };
        let machine = probe.machine();
        let linear: Vec<usize> =
            (0..machine.axes.len()).filter(|place| !machine.axes[*place].joint.rotary).collect();
        let LimitedBox { ends, open, limited_by } = LimitedBox::of(probe, &at_origin, &linear);
        let [least, most] = [0, 1].map(|end| {
            let ends = ends.filter(|_| probe.closed_form())?;
            Some(ends[end].into())
        });
        let beyond = machine.limits.iter().filter(|limit| !limit.holds(&at_origin));
        let origin_beyond = beyond.map(|limit| limit.told(machine, &at_origin)).collect();
        let origin_out = linear
            .iter()
            .filter_map(|place| {
                let axis = &machine.axes[*place];
                let [least, most] = axis.travel?;
                let value = at_origin[*place];
                passed(axis.travel, value, 1e-6).map(|_| OutsideTravel {
                    axis: axis.name.clone(),
                    value: axis.reading(value),
                    travel: [axis.reading(least), axis.reading(most)],
                })
            })
            .collect();
        let rotary = machine
            .axes
            .iter()
            .zip(at_origin)
            .filter(|(axis, _)| axis.joint.rotary)
            .map(|(axis, value)| AxisReadout {
                axis: axis.name.clone(),
                value: axis.reading(value),
            })
            .collect();
        Some(Self {
            axis: axis.into(),
            rotary,
            least,
            most,
            open_mm: open.filter(|_| probe.closed_form()),
            limited_by: if probe.closed_form() { limited_by } else { Vec::new() },
            origin_out,
            origin_beyond,
        })
    }
}

/// Axis values with the tip on the part origin and the tool along `axis`, as posting may take them: the first of which
/// the linear ones are inside travel too, and what must hold between the axes holds, else the first.
fn first(probe: &Probe<'_>, axis: Vector3<f64>) -> Option<Joints> {
    let stands = probe.stands(axis);
    let inside = |joints: &&Joints| {
        let axes = probe.machine().axes.iter().zip(joints.iter());
        axes.filter(|(axis, _)| !axis.joint.rotary)
            .all(|(axis, value)| passed(axis.travel, *value, 1e-6).is_none())
            && probe.machine().limits.iter().all(|limit| limit.holds(joints))
    };
    let best = stands.iter().find(inside).or(stands.first());
    best.copied()
}
