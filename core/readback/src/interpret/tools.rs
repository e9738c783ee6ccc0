//! Tools and their lengths, as the control's tables have them.

use post_machine::diagnostic::Diagnostic;

use super::state::Control;
use crate::Told;

/// What the control knows of the tool and its length.
#[derive(Clone, Debug, Default)]
pub(super) struct Tools {
    /// The tool that is made ready, or that M6 will bring.
    pub ready: Option<u32>,
    /// Its name, where it is called by one.
    pub ready_name: Option<String>,
    /// Length compensation is on.
    pub length_on: bool,
    /// The length comes from the tool's own table (D, TOOL CALL), not from a register.
    pub by_tool: bool,
    /// What is added to the length of the table: DL, mm.
    pub longer: f64,
    /// The length that a block has named: G43.1, mm.
    pub stated: Option<f64>,
    /// Registers and tools of which was told that their length is taken for granted.
    told: Vec<u32>,
}

impl Control {
    /// The tool `number` is in the spindle now.
    pub fn change_tool(
        &mut self,
        number: Option<u32>,
        name: Option<String>,
    ) -> Result<(), Box<Diagnostic>> {
        self.state.tool = number;
        self.tools.longer = 0.0;
        self.state_changed();
        self.tell(Told::ToolChange { number, name });
        if self.tools.by_tool && self.tools.length_on {
            return self.length_changed();
        }
        Ok(())
    }

    /// The length in force may be another: finds it, and what the words count from with it.
    ///
    /// # Errors
    /// It matters and nobody knows it.
    pub fn length_changed(&mut self) -> Result<(), Box<Diagnostic>> {
        let length = if self.tools.length_on {
            self.length_in_force()? + self.tools.longer
        } else {
            0.0
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
        let find = |list: &[(u32, f64)], wanted: Option<u32>| {
            let mut entries = list.iter();
            wanted.and_then(|wanted| {
                entries
                    .find(|(number, _)| *number == wanted)
                    .map(|(_, length)| *length)
            })
        };
        let register = if self.tools.by_tool {
            None
        } else {
            self.state.length_register
        };
        if register == Some(0) {
            return Ok(0.0);
        }
        let tool = if self.tools.by_tool || register.is_none() {
            self.state.tool
        } else {
            register
        };
        let known = find(&self.offsets.lengths, register)
            .or_else(|| find(&self.offsets.tools, tool))
            .or(self.offsets.length)
            .or_else(|| find(&self.machine.tools, tool));
        if let Some(length) = known {
            return Ok(length);
        }
        let what = match (register, tool) {
            (Some(register), _) => format!("the length in register H{register}"),
            (None, Some(tool)) => format!("the length of tool {tool}"),
            (None, None) => "the length of the tool".to_owned(),
        };
        let turned = self
            .machine
            .axes
            .iter()
            .any(|axis| axis.joint.rotary && !axis.carries_part);
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
}
