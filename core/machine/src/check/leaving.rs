//! How the tool leaves the part, where the machine file says so.

use crate::description::Machine;
use crate::diagnostic::Short;

/// What `[control] leave` does, in words; none where the depth axis leads away.
pub(super) fn told(machine: &Machine) -> Option<String> {
    let frame = &machine.frame;
    let distance = frame.leave?;
    let then = frame.retract.iter().chain(&frame.aside);
    let then = then.map(|(place, value)| {
        let axis = &machine.axes[*place];
        let unit = if axis.joint.rotary { "°" } else { " mm" };
        format!(", then {} to {}{unit}", axis.name, Short(axis.reading(*value)))
    });
    let back = format!("{} mm straight back along the tool", Short(distance));
    Some(then.fold(back, |told, then| told + &then))
}
