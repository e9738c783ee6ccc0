//! Set-points as rows.

use post_machine::axis_words;
use post_machine::description::Machine;
use post_machine::kinematics::Joints;

use super::Sample;
use crate::columns::Column;

/// The columns of the table; the axes in the order of their words.
pub fn columns(machine: &Machine) -> Vec<Column<Sample>> {
    type C = Column<Sample>;
    let mut columns = vec![
        C::new("time", "s", 6, |sample| sample.point.time),
        C::new("line", "", 0, |sample| sample.at.line),
        C::new("cl_line", "", 0, Sample::cl_line),
        C::new("cuts", "", 0, |sample| sample.at.cuts),
    ];
    type JointsOf = fn(&Sample) -> &Joints;
    let joints: [(&str, JointsOf); 2] = [
        ("", |sample| &sample.point.commanded_joints),
        ("_actual", |sample| &sample.point.actual_joints),
    ];
    for (which, joints) in joints {
        for place in axis_words::order(machine) {
            let axis = machine.axes[place].clone();
            let (name, unit) = (format!("{}{which}", axis.name), axis.unit_name());
            let value = move |sample: &Sample| axis.reading(joints(sample)[place]);
            columns.push(C::new(name, unit, 6, value));
        }
    }
    columns.extend([
        C::new("tip_x", "mm", 6, |sample| sample.point.commanded.tip.x),
        C::new("tip_y", "mm", 6, |sample| sample.point.commanded.tip.y),
        C::new("tip_z", "mm", 6, |sample| sample.point.commanded.tip.z),
        C::new("tip_x_actual", "mm", 6, |sample| sample.point.actual.tip.x),
        C::new("tip_y_actual", "mm", 6, |sample| sample.point.actual.tip.y),
        C::new("tip_z_actual", "mm", 6, |sample| sample.point.actual.tip.z),
        C::new("error_x", "mm", 7, |sample| sample.error()[0]),
        C::new("error_y", "mm", 7, |sample| sample.error()[1]),
        C::new("error_z", "mm", 7, |sample| sample.error()[2]),
        C::new("error", "mm", 7, Sample::size),
        C::new("axis_error", "deg", 7, |sample| sample.axis().to_degrees()),
        C::new("feed", "mm/min", 2, |sample| sample.feed),
        C::new("feed_programmed", "mm/min", 2, |sample| sample.programmed),
    ]);
    columns
}
