//! Which of two solutions the rotary axes stand in.

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::Joints;
use post_machine::kinematics::chain::turn;

/// So near to the pole neither solution is told from the other.
const POLE: f64 = 1e-7;

/// What marks of a change say.
pub const CHANGED: &str = "the rotary axes change to their other solution";

/// Watches the rotary axes of a machine that has two.
pub struct Branch {
    /// Which axis turns the tool first, and the directions of both from the part to the tool.
    axes: Option<(usize, [Vector3<f64>; 2])>,
    tool: Vector3<f64>,
    /// The side on which the tool axis stood last.
    last: Option<bool>,
}

impl Branch {
    /// Of a machine with its tool.
    pub fn new(machine: &Machine) -> Self {
        let mut rotary = machine.axes.iter().enumerate();
        let mut next = || rotary.find(|(_, axis)| axis.joint.rotary);
        let axes = match [next(), next(), next()] {
            [Some((_, outer)), Some((inner, axis)), None] => {
                Some((inner, [outer.joint.direction, axis.joint.direction]))
            }
            _ => None,
        };
        Self { axes, tool: machine.tool_axis, last: None }
    }

    /// The axes come to stand here: whether that is the other solution than before. The tool axis, turned by the second
    /// rotary axis alone, stands on one side of the plane of both axis lines' directions or on the other.
    pub fn changes(&mut self, joints: &Joints) -> bool {
        let Some((inner, [outer, axis])) = self.axes else {
            return false;
        };
        let (sine, cosine) = libm::sincos(joints[inner]);
        let side = turn(self.tool, axis, sine, cosine).dot(&outer.cross(&axis));
        if libm::fabs(side) < POLE {
            return false;
        }
        let before = self.last.replace(side > 0.0);
        before.is_some_and(|before| before != (side > 0.0))
    }
}

#[cfg(test)]
mod tests {
    use post_machine::description::{Source, load};

    use super::*;

    #[test]
    fn the_other_side_of_the_pole_is_the_other_solution() {
        let text = include_str!("../../../../machines/ac-trunnion.toml");
        let source = Source { name: "ac-trunnion".to_owned(), text: text.to_owned() };
        let machine = load(source, &[], &mut |_| Err("none".to_owned())).unwrap();
        let a = machine.axes.iter().position(|axis| axis.name == "A");
        let mut branch = Branch::new(&machine);
        let mut changes = |angle: f64| {
            let mut joints = Joints::default();
            joints[a.unwrap()] = angle;
            branch.changes(&joints)
        };
        // The pole itself belongs to neither.
        let seen = [-0.2, -0.1, 0.0, -0.3, 0.0, 0.1, 0.2, -0.1].map(&mut changes);
        assert_eq!(seen, [false, false, false, false, false, true, false, true]);
    }
}
