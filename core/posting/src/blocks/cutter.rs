//! Cutter radius compensation: the control's, refused where it would offset in the wrong plane.

use post_machine::description::{Machine, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::orientation::angle;
use post_plugin::Compensation;

use super::BlockStage;
use crate::accuracy::{PathNode, Placer};

/// The machine has a linear axis of this name.
fn slides(machine: &Machine, name: &str) -> bool {
    machine.axes.iter().any(|axis| !axis.joint.rotary && axis.word() == name)
}

impl BlockStage<'_> {
    /// Compensation is switched on or off.
    pub(super) fn compensate(&mut self, line: u64, to: Compensation) {
        self.compensating = to != Compensation::Off;
        if self.compensating && !self.compensates && !self.in_plane() {
            self.compensating = false;
            self.refuse_compensation(
                line,
                "under tool centre point control: this dialect does not say that its control can",
                "tcp = \"post\" writes axis positions (--tcp post); or let the CAM system write the tool centre \
                 path, with CUTCOM/OFF",
            );
        }
    }

    /// Radius compensation works in the plane of X and Y of the machine (of the part, where the control keeps
    /// the tip): a tool that does not stand upright in it would be moved sideways into the part.
    pub(super) fn check_compensation(&mut self, placer: &Placer, line: u64, node: &PathNode) {
        let machine = self.machine;
        let axis = match machine.control.tcp {
            // The tool stands upright in it.
            _ if self.in_plane() => machine.tool_axis,
            Tcp::Control => node.trace.pose.axis,
            Tcp::Post => self.in_machine(placer, node),
        };
        let tilt = angle(axis, machine.tool_axis);
        let turned = self.last.as_ref().is_some_and(|last| self.turn_between(last, node) > 0.0);
        let what = if tilt > 1e-3 {
            format!("the tool tilted by {:.3}°", tilt.to_degrees())
        } else if turned {
            "rotary axes turning".to_owned()
        } else if machine.face.is_some() {
            "the control interpolating in polar coordinates ([mode.face])".to_owned()
        } else if machine.wrap.is_some() {
            "the control interpolating on a cylinder ([mode.wrap])".to_owned()
        } else if !["X", "Y"].into_iter().all(|name| slides(machine, name)) {
            "a machine that has not both X and Y".to_owned()
        } else {
            return;
        };
        self.compensating = false;
        self.refuse_compensation(
            line,
            &format!("with {what}: the control would offset in the wrong plane"),
            "let the CAM system write the tool centre path, with CUTCOM/OFF",
        );
    }

    /// Reported once a program.
    fn refuse_compensation(&mut self, line: u64, why: &str, help: &str) {
        if std::mem::replace(&mut self.told_compensation, true) {
            return;
        }
        let message = format!("cutter radius compensation (CUTCOM) {why}");
        self.findings.at(line, Diagnostic::error("compensation", message).help(help));
    }
}
