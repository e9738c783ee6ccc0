//! What must be in order before the tool moves and before it cuts: axis, tool, cutter, spindle.

use nalgebra::Vector3;
use post_grammar::Record;
use post_machine::kinematics::orientation::on_two_faces;
use post_plugin::Spindle;

use super::{ClInterpreter, DefaultSpindle, StepSink};
use crate::program::{Command, ProgramStep};

/// Unit vectors that differ by less are one tool axis.
pub(super) const ONE_AXIS: f64 = 1e-3;

/// How an operation ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct EndAxis {
    /// The tool axis, unit vector, part frame.
    pub axis: Vector3<f64>,
    /// It began with the same: the rotary axes are positioned (3+2), and no way of the CAM system turns them.
    pub positions: bool,
}

impl ClInterpreter {
    /// What is to be seen to before a move: the axis after an index move, the tool that the user names, a
    /// cutter without a tool, the speed that the user names.
    #[cold]
    pub(super) fn before_move(&mut self, record: &Record<'_>, emit: &mut StepSink<'_>) {
        if std::mem::take(&mut self.check_axis)
            && let (Some(turned), Some(told)) = (self.frame.turned(), self.told_axis)
            && (turned * self.axis - told).norm() > 1e-3
        {
            self.fault(
                record,
                "rotabl",
                "the index angles (ROTABL) do not turn the tool to the axis that TLAXIS names"
                    .to_owned(),
                "one of the two is wrong: check the operation's set-up in the CAM system",
            );
        }
        self.refuse_suspects();
        if self.set_out.take().is_some() {
            self.fault(
                record,
                "arc",
                "INDIRV says where the tool sets out along a curve, and no TLON follows it"
                    .to_owned(),
                "",
            );
        }
        self.load_told(record, emit);
        if self.tools.loaded.is_none() && self.reading.nose.take().is_some() {
            self.fault(
                record,
                "tool",
                "the file loads no tool, and which point of its nose the control counts by follows from the tool ([cl] points)"
                    .to_owned(),
                "--tool names it",
            );
        }
        self.refuse_what_is_left(record);
        if std::mem::take(&mut self.tools.cutter_changed) {
            self.refuse_cutter(record);
        }
        if let (false, Some(rpm)) = (self.spindle.said, self.reading.spindle.speed()) {
            self.spindle.said = true;
            self.spindle.may_cut = true;
            self.spindle.rpm = Some(rpm);
            emit(ProgramStep::Command(Command::Spindle(Spindle::On {
                rpm,
                sense: self.spindle.sense,
            })));
        }
        if let Some(before) = self.axis_before.take() {
            self.turn_over(before, emit);
        }
        if self.begun_with.is_none() {
            self.begun_with = Some(self.frame.direction_to_part(self.axis));
        }
        self.due = false;
    }

    /// The first move of an operation: where it comes at rapid to another face of the part, the way of the CAM system
    /// between the two is none that a tool could go, and the tool is retracted first; behind one whose axis stood all the
    /// time, which a system leads away from its own face alone, wherever the axis is another one. So it is between two holes
    /// of a cycle, where nobody gives a way. `before` is how the operation, or the hole, before ended.
    pub(super) fn turn_over(&self, before: EndAxis, emit: &mut StepSink<'_>) {
        let EndAxis { axis, positions } = before;
        let next = self.frame.direction_to_part(self.axis);
        let rapid = self.rapid || self.rapid_feed || self.cycles.in_force.is_some();
        let other_face = match positions {
            true => (axis - next).norm() > ONE_AXIS,
            false => on_two_faces(&axis, &next),
        };
        if rapid && self.tip.is_some() && other_face {
            emit(ProgramStep::Command(Command::Leave));
        }
    }

    /// Another cutter was described, and no tool was loaded for it.
    fn refuse_cutter(&mut self, record: &Record<'_>) {
        if self.reading.allows("CUTTER") {
            self.allow("CUTTER", "is cut with the tool before", record);
            return;
        }
        let (message, help) = match self.tools.loaded {
            Some((number, ..)) if self.tools.file_loads => (
                format!("another cutter is described (CUTTER, TLDATA), and tool {number} is still in the spindle: this would be cut with it"),
                "the CAM system must load it as another tool (LOADTL); --allow CUTTER cuts on with the one before",
            ),
            _ => (
                "another cutter is described (CUTTER, TLDATA), and the file loads no tools: all would be cut with one".to_owned(),
                "--tool-from-cutter numbers tools in the order of their cutters; --allow CUTTER cuts all with one",
            ),
        };
        self.fault(record, "cutter", message, help);
    }

    /// The tool cuts though the spindle stands: the file switched it off, or never on.
    #[cold]
    pub(super) fn cut_standing(&mut self, record: &Record<'_>) {
        // Said once, until the spindle is spoken of again.
        self.spindle.may_cut = true;
        let (message, help) = if self.spindle.said {
            (
                "the tool cuts, and the file has switched the spindle off",
                "the CAM system should write SPINDL before this line (a list of points: `spindle,RPM`); --spindle off cuts with a spindle that stands",
            )
        } else {
            (
                "the tool cuts, and the spindle was not switched on",
                "the CAM system should write SPINDL before this line (a list of points: `spindle,RPM`); --spindle RPM switches it on at each tool for which the file does not, --spindle off lets it stand",
            )
        };
        self.fault(record, "spindle", message.to_owned(), help);
    }

    /// The tool cuts without turning: a knife, an extruder, or as the user says.
    pub(super) fn need_not_turn(&self) -> bool {
        self.reading.knife || self.reading.spindle == DefaultSpindle::Still
    }
}
