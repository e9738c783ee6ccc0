//! Tools and their lengths, as the control's tables have them.

use post_machine::description::LengthAxis;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_plugin::{Language, Lengths};

use super::ModesInForce;
use super::state::{ArcPlane, ControlState};
use crate::{Coolants, ProgramEvent};

/// What the control knows of the tool and its length.
#[derive(Clone, Debug, Default)]
pub(super) struct ToolState {
    /// The tool that is made ready, or that M6 will bring.
    pub ready: Option<u32>,
    /// Where the axes stood at the block that named it.
    pub ready_at: Option<Joints>,
    /// Name of the tool that is made ready, where it is called by one.
    pub ready_name: Option<String>,
    /// Length compensation is on.
    pub length_on: bool,
    /// The length comes from the tool's own table (D, TOOL CALL), not from a register.
    pub by_tool: bool,
    /// What is added to the length of the table: DL, mm.
    pub longer: f64,
    /// What is added to the radius of the table and to that of its corner, program units: DR, DR2.
    pub thicker: [f64; 2],
    /// The length that a block has named: G43.1, mm.
    pub stated: Option<f64>,
    /// The plane across the tool as the length came on: a control with edges, or with a tool call that names the axis,
    /// puts the length along its third axis.
    pub across: ArcPlane,
    /// Registers and tools whose length is reported to be taken for granted.
    told: Vec<u32>,
}

impl ControlState {
    /// The tool `number` is in the spindle now.
    pub fn change_tool(
        &mut self,
        number: Option<u32>,
        name: Option<String>,
    ) -> Result<(), Box<Diagnostic>> {
        self.begins();
        if self.report.changed.is_none() {
            let modes = self.in_force();
            let held = (!modes.is_empty()).then_some(ModesInForce { line: self.line, modes });
            self.report.changed = held;
        }
        self.state.tool = number;
        self.state.length_of_spindle = false;
        self.tools.longer = 0.0;
        self.tools.ready_at = None;
        self.state.standstill.change = Some(self.line);
        // "No other changes" by M6, as RS274/NGC has it.
        let flows = self.state.coolants != Coolants::default();
        let ends = flows && self.lexicon.language() != Language::Rs274;
        self.state.standstill.dry_change = ends.then_some(self.line);
        self.state_changed();
        self.tell(ProgramEvent::ToolChange { number, name });
        // What is not called counts too: the work offset was measured with the tool.
        match self.is_whole() || !self.tools.length_on || self.tools.by_tool {
            true => self.length_changed(),
            false => self.solver_changed(),
        }
    }

    /// T0101: the turret turns to the tool, unless it stands there, and the offsets of the last two digits are in force.
    pub(super) fn tool_and_offset(&mut self, number: u32) -> Result<(), Box<Diagnostic>> {
        let [tool, offset] = [number / 100, number % 100];
        if tool == 0 && offset != 0 {
            let message = format!("T{number} has the offsets {offset} and names no tool");
            return Err(self.refuse("nc-word", message));
        }
        if tool != 0 && self.state.tool != Some(tool) {
            self.change_tool(Some(tool), None)?;
        }
        self.tools.by_tool = false;
        self.tools.stated = None;
        self.tools.length_on = offset != 0;
        self.state.length_register = (offset != 0).then_some(offset);
        self.length_changed()
    }

    /// The words have the whole tool in them, whether its length is called or not: the work offset was measured with it
    /// in the spindle, or no linear axis is there that could be shifted.
    fn is_whole(&self) -> bool {
        let mut axes = self.machine.axes.iter();
        self.lexicon.language() == Language::Joints
            || self.lexicon.lengths() == Lengths::WorkOffset
            || self.machine.length_axis == LengthAxis::None
            || axes.all(|axis| axis.joint.rotary)
    }

    /// The length in force may be another: finds it, and what the words count from with it.
    ///
    /// # Errors
    /// The length matters and is not known.
    pub fn length_changed(&mut self) -> Result<(), Box<Diagnostic>> {
        let length = match self.tools.length_on {
            true => self.length_in_force()? + self.tools.longer,
            false if self.is_whole() => self.length_of(self.state.tool).unwrap_or(0.0),
            false => 0.0,
        };
        self.state.length = length;
        self.state_changed();
        self.solver_changed()
    }

    /// The length by register or tool.
    fn length_in_force(&mut self) -> Result<f64, Box<Diagnostic>> {
        if let Some(length) = self.tools.stated {
            return Ok(length);
        }
        let register = if self.tools.by_tool { None } else { self.state.length_register };
        if register == Some(0) {
            return Ok(0.0);
        }
        let tool =
            if self.tools.by_tool || register.is_none() { self.state.tool } else { register };
        // A register that holds 0 says nothing of how long the tool is.
        let registers: &[(u32, f64)] = match self.machine.length_axis {
            LengthAxis::None => &[],
            LengthAxis::Dialect | LengthAxis::Said(_) => &self.offsets.lengths,
        };
        if let Some(length) = find(registers, register).or_else(|| self.length_of(tool)) {
            return Ok(length);
        }
        let what = match (register, tool) {
            (Some(register), _) => format!("the length in register H{register}"),
            (None, Some(tool)) => format!("the length of tool {tool}"),
            (None, None) => "the length of the tool".to_owned(),
        };
        let turned = self.machine.axes.iter().any(|axis| axis.joint.rotary && !axis.carries_part);
        let help = "state it by --offsets (a table [length] or [tool]), by --tool-length, or in [tools] of the machine file";
        if turned {
            let message = format!(
                "{what} is not known, and a rotary axis carries the tool: where the tip is hangs on it"
            );
            return Err(Diagnostic::error("nc-length", message).help(help).boxed());
        }
        let key = register.or(tool).unwrap_or(0);
        if !self.tools.told.contains(&key) {
            self.tools.told.push(key);
            let message = format!(
                "{what} is not known and is taken as 0: no rotary axis carries the tool, so its tip goes the same way"
            );
            let note = Diagnostic::warning("nc-length", message).help(help);
            self.note(note);
        }
        Ok(0.0)
    }

    /// How long a tool is, as far as that is said.
    fn length_of(&self, tool: Option<u32>) -> Option<f64> {
        find(&self.offsets.tools, tool)
            .or(self.offsets.length)
            .or_else(|| find(&self.machine.tools, tool))
    }

    /// Where the axes stand that axis positions count from, without the work offset: `exact` where that is with the tip of
    /// the tool on the part origin, as on a machine with nothing along which a length could be put.
    pub(super) fn counted_from(&self, exact: Joints) -> Joints {
        if self.lexicon.language() == Language::Joints {
            let mut shown = Joints::default();
            for (shown, axis) in shown.iter_mut().zip(&self.machine.axes) {
                *shown = -axis.zero;
            }
            return shown;
        }
        // Whoever changes the tool measures the work offset with it.
        if self.lexicon.lengths() == Lengths::WorkOffset {
            return exact;
        }
        let [.., z] = self.axes.cartesian;
        let place = match (self.machine.length_axis, self.lexicon.language()) {
            (LengthAxis::None, _) => None,
            (LengthAxis::Said(place), _) => Some(place),
            (LengthAxis::Dialect, language) => {
                let named = matches!(language, Language::Names | Language::Conversational);
                let third = self.axes.cartesian[self.tools.across.coordinates()[2]];
                match if named { third } else { z } {
                    Some(place) => Some(place),
                    // Nothing moves along it.
                    None => return exact,
                }
            }
        };
        let called = (self.tools.length_on && place.is_some()).then_some(self.state.length);
        let tool = self.state.tool;
        let known = self.length_of(tool).or_else(|| find(&self.offsets.lengths, tool));
        let put_on = called.unwrap_or(0.0);
        let zero = |length| self.machine.counted_from(length, put_on, place);
        known.or(called).and_then(zero).unwrap_or(exact)
    }
}

/// The value of `wanted` in a table.
fn find(list: &[(u32, f64)], wanted: Option<u32>) -> Option<f64> {
    let mut entries = list.iter();
    entries.find(|(number, _)| Some(*number) == wanted).map(|(_, length)| *length)
}
