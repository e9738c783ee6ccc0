//! The chain of a machine, as the page draws and moves it.

use post_machine::description::{Axis, Machine};
use post_report::meta::{AxisMeta, MachineMeta};

/// What the page must know of it.
pub fn machine(machine: &Machine) -> MachineMeta {
    let mount = machine.mount;
    MachineMeta {
        name: machine.name.clone(),
        unit: "mm",
        axes: machine.axes.iter().map(axis).collect(),
        mount: [
            [1.0, 0.0, 0.0, mount.x],
            [0.0, 1.0, 0.0, mount.y],
            [0.0, 0.0, 1.0, mount.z],
            [0.0, 0.0, 0.0, 1.0],
        ],
        gauge: machine.gauge.into(),
        tool_axis: machine.tool_axis.into(),
        edge: machine.edge.map(Into::into),
        // Told where their shapes are read.
        solid: Vec::new(),
        shapes: 0,
    }
}

fn axis(axis: &Axis) -> AxisMeta {
    let limit = |limit: f64| limit.is_finite().then(|| limit / axis.unit());
    AxisMeta {
        name: axis.name.clone(),
        kind: match axis.joint.rotary {
            true => "rotary",
            false => "linear",
        },
        direction: axis.joint.direction.into(),
        point: axis.joint.point.into(),
        carries: match axis.carries_part {
            true => "work",
            false => "tool",
        },
        travel: axis.travel.map(|travel| travel.map(|end| axis.reading(end))),
        cyclic: axis.travel.is_none(),
        zero: axis.zero / axis.unit(),
        max_feed: limit(axis.max_feed),
        max_accel: limit(axis.max_accel),
    }
}
