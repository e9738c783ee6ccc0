//! Where the tip can go with the tool upright in the part.

use nalgebra::Vector3;
use serde::Serialize;

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
    /// Least tip, mm; none where rotary axes place the tip too.
    pub least: Option<[f64; 3]>,
    /// Largest tip, mm; none where rotary axes place the tip too.
    pub most: Option<[f64; 3]>,
    /// Axes that stand outside their travel with the tip on the part origin.
    pub origin_out: Vec<OutsideTravel>,
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
        let mut least = Vector3::repeat(f64::INFINITY);
        let mut most = Vector3::repeat(f64::NEG_INFINITY);
        // The tip is linear in the linear axes, so its extremes are at corners.
        for corner in 0..1usize << linear.len() {
            let mut joints = at_origin;
            for (bit, place) in linear.iter().enumerate() {
                joints[*place] = probe.span(*place)[corner >> bit & 1];
            }
            let tip = probe.chain().forward(&joints).tip;
            least = least.inf(&tip);
            most = most.sup(&tip);
        }
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
            least: probe.closed_form().then(|| least.into()),
            most: probe.closed_form().then(|| most.into()),
            origin_out,
        })
    }
}

/// Axis values with the tip on the part origin and the tool along `axis`, as posting may take them: the first of which
/// the linear ones are inside travel too, else the first.
fn first(probe: &Probe<'_>, axis: Vector3<f64>) -> Option<Joints> {
    let stands = probe.stands(axis);
    let inside = |joints: &&Joints| {
        let axes = probe.machine().axes.iter().zip(joints.iter());
        axes.filter(|(axis, _)| !axis.joint.rotary)
            .all(|(axis, value)| passed(axis.travel, *value, 1e-6).is_none())
    };
    let best = stands.iter().find(inside).or(stands.first());
    best.copied()
}
