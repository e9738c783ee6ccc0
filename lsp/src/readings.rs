//! What the axes of a machine show.

use post_machine::axis_words;
use post_machine::description::Machine;
use post_machine::kinematics::Joints;
use post_plugin::fixed;

/// Decimals that are shown, mm and degrees.
const DECIMALS: u8 = 3;

/// `X 12.500 C 90.000°`, in the order of the words of a program.
pub fn text(machine: &Machine, joints: &Joints) -> String {
    let mut text = String::new();
    for place in axis_words::order(machine) {
        let axis = &machine.axes[place];
        if !text.is_empty() {
            text.push(' ');
        }
        text.push_str(&axis.name);
        text.push(' ');
        fixed(&mut text, axis.reading(joints[place]), DECIMALS);
        if axis.joint.rotary {
            text.push('°');
        }
    }
    text
}
