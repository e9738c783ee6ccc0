//! Axes of a machine with all its heads, as columns.

use post_machine::axis_words;
use post_machine::description::Machine;
use post_machine::kinematics::Joints;

/// An axis that has a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AxisColumn {
    /// Its name.
    pub name: String,
    /// It turns.
    pub rotary: bool,
}

/// Axes in the order of the chain, each name once, those of the machine first.
pub fn of_all_heads(machine: &Machine) -> Vec<AxisColumn> {
    columns(machine, |machine| (0..machine.axes.len()).collect())
}

/// Axes in the order of their words, each name once, those of the machine first.
pub fn by_words(machine: &Machine) -> Vec<AxisColumn> {
    columns(machine, axis_words::order)
}

fn columns(machine: &Machine, order: impl Fn(&Machine) -> Vec<usize>) -> Vec<AxisColumn> {
    let heads = machine.heads.iter().map(|head| &head.machine);
    let mut columns: Vec<AxisColumn> = Vec::new();
    for machine in std::iter::once(machine).chain(heads) {
        for place in order(machine) {
            let axis = &machine.axes[place];
            if columns.iter().all(|column| column.name != axis.name) {
                columns.push(AxisColumn { name: axis.name.clone(), rotary: axis.joint.rotary });
            }
        }
    }
    columns
}

/// What the control shows of the axes of a machine, in the order of its chain.
pub fn readings(machine: &Machine, joints: &Joints) -> Joints {
    let mut readings = Joints::default();
    for ((reading, value), axis) in readings.iter_mut().zip(joints).zip(&machine.axes) {
        *reading = axis.reading(*value);
    }
    readings
}

/// Values of the axes of a machine, by columns; none for an axis that it has not.
pub fn in_columns(columns: &[AxisColumn], machine: &Machine, values: &Joints) -> Vec<Option<f64>> {
    let value = |(place, column): (usize, &AxisColumn)| {
        // Without heads the columns stand as the axes do.
        if machine.axes.get(place).is_some_and(|axis| axis.name == column.name) {
            return Some(values[place]);
        }
        let mut axes = machine.axes.iter().zip(values);
        axes.find(|(axis, _)| axis.name == column.name).map(|(_, value)| *value)
    };
    columns.iter().enumerate().map(value).collect()
}

/// The machine with the head of that name, and its number from 1; without one the machine itself, and 0.
pub fn with_head<'m>(machine: &'m Machine, name: &str) -> (&'m Machine, u64) {
    let place = machine.heads.iter().position(|head| head.name == name);
    place.map_or((machine, 0), |place| (&machine.heads[place].machine, place as u64 + 1))
}
