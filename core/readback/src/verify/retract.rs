//! Where a tool is changed, and where the program ends: a posted program has the tool retracted there.

use std::f64::consts::TAU;

use post_machine::description::Machine;
use post_machine::kinematics::Joints;

use super::report::BlockPlace;
use super::{RAPID_TURN, Verifier};
use crate::course::Course;

/// Distance by which the depth axes stand nearer to the part than the machine file retracts them: the axis that lacks
/// most, and how much, mm or radians; none if all of them are retracted, or stand where it has them for a tool change or at the
/// end. Of a machine with `leave` those are the axes that go behind the way out.
pub(super) fn lacks(machine: &Machine, joints: &Joints, slack: f64) -> Option<(usize, f64)> {
    let frame = &machine.frame;
    let named = [&frame.change, &frame.park, &frame.aside];
    let leaves = frame.leave.is_some();
    let then = frame.aside.iter().filter(|_| leaves);
    let lacks = frame.retract.iter().chain(then).map(|(place, retract)| {
        let away = machine.axes[*place].joint.direction.dot(&machine.tool_axis);
        let by = retract - joints[*place];
        // Where the file says how the tool leaves, its axes stand there, and nowhere beyond.
        let by = if leaves { libm::fabs(by) } else { away.signum() * by };
        (*place, by)
    });
    let short = lacks.filter(|(place, by)| {
        let slack = if machine.axes[*place].joint.rotary { RAPID_TURN } else { slack };
        let mut named = named.iter().flat_map(|list| list.iter());
        let there = |(other, value): &(usize, f64)| {
            other == place && libm::fabs(joints[*place] - value) <= slack
        };
        *by > slack && !named.any(there)
    });
    short.max_by(|(_, one), (_, other)| one.total_cmp(other))
}

/// The tool is as far off the part as the machine file retracts it; nowhere, where that is off its own line alone.
pub(super) fn is_retracted(machine: &Machine, joints: &Joints, slack: f64) -> bool {
    drawn_back(machine).is_none() && lacks(machine, joints, slack).is_none()
}

/// How far off the part the tool is drawn back along its own line where the machine file has no more than that (`leave`
/// without `then`), mm.
pub(super) fn drawn_back(machine: &Machine) -> Option<f64> {
    let frame = &machine.frame;
    frame.leave.filter(|_| frame.retract.is_empty() && frame.aside.is_empty())
}

/// A way from one place to another at which the machine file has the tool retracted.
pub(super) fn stays_retracted(machine: &Machine, ends: [&Joints; 2], slack: f64) -> bool {
    ends.iter().all(|joints| is_retracted(machine, joints, slack))
}

/// The axis that does not stand where the machine file has it for a tool change, and how far it is off, mm or degrees.
fn off_change(machine: &Machine, joints: &Joints, slack: f64) -> Option<(usize, f64)> {
    let off = machine.frame.change.iter().map(|(place, value)| {
        let axis = &machine.axes[*place];
        let mut apart = joints[*place] - value;
        if axis.joint.rotary {
            apart -= TAU * libm::rint(apart / TAU);
        }
        (*place, libm::fabs(apart) / axis.unit())
    });
    off.filter(|(_, by)| *by > slack).max_by(|(_, one), (_, other)| one.total_cmp(other))
}

impl<C: Course> Verifier<'_, C> {
    /// A tool is changed: retracted, and with the axes where the machine file has them for it, if the program was
    /// posted for that file.
    pub(super) fn look_at_change(&mut self, line: u64) {
        self.look_for_retract(line, "where the tool is changed");
        let Some(joints) = self.stands.filter(|_| self.rules.own) else {
            return;
        };
        let Some((place, by)) = off_change(self.machine, &joints, self.rules.rapid_tolerance)
        else {
            return;
        };
        let axis = &self.machine.axes[place];
        let (name, unit) = (&axis.name, if axis.joint.rotary { "°" } else { " mm" });
        let message = format!(
            "{name} stands {by:.3}{unit} from where the machine file has it for a tool change"
        );
        self.fault_at("rapid", message, Some(BlockPlace::of_line(line)), None, Some(by));
    }

    /// The tool must be retracted here, if the program was posted for this machine file.
    pub(super) fn look_for_retract(&mut self, line: u64, here: &str) {
        let Some(joints) = self.stands.filter(|_| self.rules.own) else {
            return;
        };
        let Some((place, by)) = lacks(self.machine, &joints, self.rapid_bound.point) else {
            return;
        };
        let axis = &self.machine.axes[place];
        let unit = if axis.joint.rotary { "°" } else { " mm" };
        let (name, by) = (&axis.name, by / axis.unit());
        let message = format!("{name} stands {by:.3}{unit} short of its retract {here}");
        self.fault_at("rapid", message, Some(BlockPlace::of_line(line)), None, Some(by));
    }
}
