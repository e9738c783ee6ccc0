//! Axes of a machine with all its heads.

use post_machine::description::Machine;

/// Names of the axes, each once, and whether they turn; those of the machine first.
pub fn of_all_heads(machine: &Machine) -> Vec<(String, bool)> {
    let heads = machine.heads.iter().map(|head| &head.machine);
    let mut axes: Vec<(String, bool)> = Vec::new();
    for axis in std::iter::once(machine).chain(heads).flat_map(|machine| &machine.axes) {
        if axes.iter().all(|(name, _)| *name != axis.name) {
            axes.push((axis.name.clone(), axis.joint.rotary));
        }
    }
    axes
}

/// The machine with the head of that name, and its number from 1; without one the machine itself, and 0.
pub fn with_head<'m>(machine: &'m Machine, name: &str) -> (&'m Machine, u64) {
    let place = machine.heads.iter().position(|head| head.name == name);
    place.map_or((machine, 0), |place| (&machine.heads[place].machine, place as u64 + 1))
}
