//! What the control does by itself: work offsets, registers, subprograms, cutting speeds, smoothing, keeping the tip.

use post_machine::description::{OutputUnits, Smoothing, Tcp, TextPlace};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Capabilities, Event, SpindleSense};

use super::EmitStage;
use crate::program::ToolChange;

/// Millimetres in a foot.
const FOOT: f64 = 304.8;

impl EmitStage<'_> {
    /// Another work offset, the tool retracted and nothing in force that counts from the one before.
    pub(super) fn work_offset(&mut self, line: u64, number: u32) {
        let event = Event::WorkOffset { number, name: "" };
        if !self.writer.knows(Capabilities::WORK_OFFSET) {
            self.findings.at(line, refused(&event, "SET and OFSETL"));
            return;
        }
        if let Some(before) = self.offset.replace(number) {
            self.tell_other_mount(line, [before, number]);
        }
        self.leave(line);
        self.writer.push(line, event);
    }

    /// The work offset that was measured with the head that is in.
    pub(super) fn offset_of_head(&mut self, line: u64, number: u32) {
        let event = Event::WorkOffset { number, name: "" };
        match self.writer.knows(Capabilities::WORK_OFFSET) {
            true => {
                self.offset = Some(number);
                self.writer.push(line, event);
            }
            false => self.findings.at(line, refused(&event, "the offset of a head")),
        }
    }

    /// Axis positions count from where the axes stood when the offset was measured, with the head that was in.
    pub(super) fn tell_shared_offset(&self, line: u64, head: &str) {
        if self.machine.control.tcp == Tcp::Post {
            self.findings.at(
                line,
                Diagnostic::error(
                    "work-offset",
                    format!("head {head} would work with the work offset that was measured with the head before it: the words are axis positions (tcp = \"post\"), and its tip is elsewhere"),
                )
                .help(format!("[head.{head}] offset = 2 names the one that is measured with it (2 is G55), and each head that a program works with has its own")),
            );
        }
    }

    /// Travel, and axis positions, are those of the part on its one mount.
    fn tell_other_mount(&mut self, line: u64, [before, number]: [u32; 2]) {
        if self.machine.clearance.shortens_ways() {
            let message = format!(
                "work offset {number} behind {before}: ways between passes are those that bodies leave with the part on its one mount ([clearance] low_retracts, link)"
            );
            let help = "switch them off, or post the parts one by one, each with its --mount";
            self.findings.at(line, Diagnostic::error("work-offset", message).help(help));
        } else if self.machine.holds_on_mount_alone() {
            self.findings.at(
                line,
                Diagnostic::error(
                    "work-offset",
                    format!("work offset {number} behind {before}: the words are axis positions (tcp = \"post\"), and {}, so that they hold for one mount alone", self.machine.one_mount()),
                )
                .help("post the parts one by one, each with its --mount"),
            );
        } else if !std::mem::replace(&mut self.told_mount, true) {
            self.findings.at(
                line,
                Diagnostic::warning(
                    "work-offset",
                    format!("work offset {number} behind {before}: travel was checked with the part where [workpiece] mount says, for every offset"),
                ),
            );
        }
    }

    /// Another length register for the tool in the spindle: false if it is another tool, or the dialect knows only
    /// tool changes.
    pub(super) fn offsets(&mut self, line: u64, tool: &ToolChange) -> bool {
        if self.tool != Some(tool.number) || !self.writer.knows(Capabilities::OFFSETS) {
            self.tool = Some(tool.number);
            return false;
        }
        self.leave(line);
        self.texts.tool(tool);
        self.writer.push(line, Event::Offsets { length: Some(tool.register), radius: None });
        true
    }

    /// A subprogram of the control; what it leaves in force is not known.
    pub(super) fn subprogram(&mut self, line: u64, number: u32) {
        let event = Event::Subprogram { number: Some(number), times: 1, name: "" };
        if !self.writer.knows(Capabilities::SUBPROGRAM) {
            self.findings.at(line, refused(&event, "CALSUB"));
            return;
        }
        if self.spindle.waits.is_some() {
            self.wake(line);
        }
        self.writer.push(line, event);
        self.clear = false;
        self.spindle.turning = false;
        self.coolant.due = true;
        self.smoothing.on = None;
        if !std::mem::replace(&mut self.told_subprogram, true) {
            self.findings.at(
                line,
                Diagnostic::warning(
                    "subprogram",
                    format!("what subprogram {number} does is not checked; behind it the tool is retracted and comes near anew"),
                ),
            );
        }
    }

    /// A cutting speed in m/min that the control keeps.
    pub(super) fn surface_speed(
        &mut self,
        line: u64,
        (speed, most): (f64, Option<f64>),
        sense: SpindleSense,
    ) {
        let speed = match self.machine.control.units {
            OutputUnits::Mm => speed,
            OutputUnits::Inch => speed * 1000.0 / FOOT,
        };
        let event = Event::SurfaceSpeed { speed, most, sense };
        if !self.writer.knows(Capabilities::SURFACE_SPEED) {
            self.findings.at(line, refused(&event, "SPINDL/SMM and SPINDL/SFM"));
            return;
        }
        self.set_spindle(line, Some(event), event);
    }

    /// Retracts the tool, and cancels what would disturb a tool change, a reference or another offset.
    pub(super) fn leave(&mut self, line: u64) {
        self.retract(line);
        if self.smoothing.on.take().is_some() {
            self.set_smoothing(line, None);
        }
    }

    /// Smoothing as it is wanted, before the tool comes near: some controls take it with no length in force alone.
    pub(super) fn smooth(&mut self, line: u64) {
        if self.smoothing.on == self.smoothing.wanted {
            return;
        }
        self.smoothing.on = self.smoothing.wanted;
        self.set_smoothing(line, self.smoothing.wanted);
    }

    /// Smoothing on or off, by the machine file's own lines if it has any.
    fn set_smoothing(&mut self, line: u64, smoothing: Option<Smoothing>) {
        self.texts.smoothing(smoothing);
        let (at, event) = match smoothing {
            Some(smoothing) => (
                TextPlace::SmoothingOn,
                Event::Smoothing {
                    tolerance: smoothing.tolerance,
                    axis_tolerance: smoothing.axis_tolerance,
                },
            ),
            None => (TextPlace::SmoothingOff, Event::SmoothingOff),
        };
        if !self.say(line, at) {
            self.writer.push(line, event);
        }
    }

    /// The control keeps the tip from here on, or no longer; for a dialect that gets an event for it.
    pub(super) fn keep_tip(&mut self, line: u64, on: bool) {
        let switches =
            self.machine.control.tcp == Tcp::Control && self.writer.knows(Capabilities::TCP_SWITCH);
        if switches && self.keeps_tip != Some(on) {
            self.keeps_tip = Some(on);
            self.writer.push(line, Event::Tcp { on });
        }
    }
}

/// The CL file asks for what the dialect has no words for.
fn refused(event: &Event<'_>, words: &str) -> Diagnostic {
    Diagnostic::error("refused-word", event.refusal()).help(format!(
        "[cl.words] in the machine file gives the lines of the program for {words}, --allow leaves a word out"
    ))
}
