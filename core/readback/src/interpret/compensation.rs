//! Compensations of radius and length, tool centre point control, and work offsets.

use post_machine::description::{LengthAxis, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Language, Meaning};

use super::block::BlockRequest;
use super::block_words::{BlockWords, bit};
use super::state::{ArcPlane, ControlState};
use crate::ProgramEvent;
use crate::g_code::GCode;
use crate::lexicon::WordMeaning;

impl ControlState {
    pub(super) fn compensate(
        &mut self,
        side: i8,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let register = if side == 0 || self.lexicon.tools_have_edges() {
            None
        } else {
            let said = words.take_number(b'D', self)?;
            said.or(match self.lexicon.language() {
                // Without D the tool in the spindle is meant.
                Language::Rs274 => self.state.tool,
                _ => self.state.radius_register,
            })
        };
        if self.state.compensation == side && (side == 0 || self.state.radius_register == register)
        {
            return Ok(());
        }
        self.state.compensation = side;
        if side != 0 {
            self.state.radius_register = register;
        }
        self.state_changed();
        self.tell(ProgramEvent::Compensation { side, register });
        Ok(())
    }

    /// Why the length of a tool that does not turn the part would come on along another axis than it has: the plane across
    /// the tool says which, that in force (SINUMERIK, fundamentals, tool offsets: G17 Z, G18 Y, G19 X) or that of
    /// the tool call.
    pub(super) fn lies_off(&self, plane: ArcPlane, called: Option<&str>) -> Option<String> {
        // What keeps the tip knows the tool's direction, as long as the program says nothing else.
        let known = self.machine.control.tcp == Tcp::Control && plane == ArcPlane::Xy;
        if self.machine.spindle.surface_speed || known {
            return None;
        }
        let place = match self.machine.length_axis {
            LengthAxis::Said(place) => place,
            LengthAxis::Dialect => self.machine.lies_along()?.0,
            LengthAxis::None => return None,
        };
        let [word, letter] = match plane {
            ArcPlane::Xy => ["G17", "Z"],
            ArcPlane::Zx => ["G18", "Y"],
            ArcPlane::Yz => ["G19", "X"],
        };
        let axes = &self.machine.axes;
        let wanted = axes[place].joint.direction;
        let word = called.unwrap_or(word);
        let third = self.axes.cartesian[plane.coordinates()[2]];
        let alike =
            third.is_some_and(|third| libm::fabs(axes[third].joint.direction.dot(&wanted)) > 0.999);
        (!alike).then(|| {
            format!(
                "the length of the tool comes on along {letter}, as {word} has it, and the tool lies along {}",
                axes[place].name
            )
        })
    }

    /// Length, tool centre point control and edges.
    pub(super) fn compensations(
        &mut self,
        words: &mut BlockWords,
        asked: &BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        if self.lexicon.tools_have_edges() {
            if let Some(edge) = words.take_number(b'D', self)? {
                self.tools.by_tool = true;
                self.tools.length_on = edge != 0;
                self.tools.across = self.modal.plane;
                if let Some(lack) = self.lies_off(self.modal.plane, None).filter(|_| edge != 0) {
                    return Err(self.refuse("nc-word", lack));
                }
                self.state.length_register = (edge != 0).then_some(edge);
                self.length_changed()?;
            }
        } else if let Some(register) = words.present_number(b'D', self)? {
            words.used |= bit(b'D');
            if self.lexicon.names_lengths_by_d() {
                self.tools.by_tool = false;
                self.tools.length_on = register != 0;
                self.tools.across = self.modal.plane;
                self.state.length_register = (register != 0).then_some(register);
                self.length_changed()?;
            }
            self.state.radius_register = Some(register);
            self.state_changed();
        }
        if asked.tcp_off && self.state.tcp {
            self.set_tcp(false, None, false);
        }
        if asked.length_off {
            words.used |= bit(b'H');
            self.tools.length_on = false;
            self.state.length_register = None;
            self.state.length_of_spindle = false;
            if self.state.tcp && self.modal.tcp_by_length {
                self.set_tcp(false, None, false);
            }
            self.length_changed()?;
        }
        if asked.length_stated {
            return self.stated_length(words);
        }
        if asked.length_on && self.modal.tcp_by_length && !asked.tcp_on {
            let message = "the length comes on while tool centre point control goes by it: one ends the other, or the control stops";
            return Err(self.refuse("nc-length", message));
        }
        if asked.length_on || asked.tcp_on && asked.tcp_code.is_some() {
            self.length_by(words)?;
        } else if self.tools.length_on
            && !self.tools.by_tool
            && asked.work.is_none()
            && !asked.machine
            && let Some(register) = words.take_number(b'H', self)?
        {
            self.state.length_register = Some(register);
            self.length_changed()?;
        }
        if asked.tcp_on {
            self.set_tcp(true, asked.tcp_code, asked.vectors);
        }
        Ok(())
    }

    /// Length compensation by Z of the block: G43.1.
    pub(super) fn stated_length(&mut self, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
        let said = words.present & self.axes.mask;
        let (Some(length), true) = (words.take(b'Z'), said == bit(b'Z')) else {
            return Err(self.refuse("nc-length", "a length along other axes than Z is not run"));
        };
        self.tools.length_on = true;
        self.tools.by_tool = false;
        self.tools.stated = Some(length * self.modal.unit);
        self.state.length_register = None;
        // It is no coordinate.
        words.present &= !bit(b'Z');
        self.length_changed()
    }

    /// Length compensation by a register.
    pub(super) fn length_by(&mut self, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
        let register = match words.take_number(b'H', self)? {
            Some(register) => Some(register),
            // `HL=1` was taken among the names.
            None => self.modal.named_register.take(),
        };
        self.tools.length_on = true;
        self.tools.by_tool = false;
        self.tools.stated = None;
        self.state.length_register = match (register, self.lexicon.language()) {
            (Some(register), _) => Some(register),
            // Without H the tool in the spindle is meant.
            (None, Language::Rs274) => self.state.tool,
            (None, _) => self.state.length_register,
        };
        self.state.length_of_spindle =
            self.state.length_register.is_none() && self.lexicon.language() == Language::Rs274;
        self.length_changed()
    }

    /// Tool centre point control on or off; `code` is the G code that switches it on.
    pub(super) fn set_tcp(&mut self, on: bool, code: Option<GCode>, vectors: bool) {
        self.modal.tcp_by_length = on && code.is_some();
        // Some vocabularies have one meaning for both types: the second names vectors, G43.5.
        self.modal.vectors = on && (vectors || code.is_some_and(|code| code.parts().1 == 5));
        if self.state.tcp != on {
            self.state.tcp = on;
            self.state_changed();
        }
    }

    /// A work offset by its G word: `G54`, `G54.1 P3`, `G15 H1`.
    pub(super) fn work_offset(
        &mut self,
        code: GCode,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let mut name = code.to_string();
        for letter in [b'P', b'H'] {
            let of_it = letter == b'P'
                || self.lexicon.g(code) == WordMeaning::Means(Meaning::WorkOffset)
                    && code.parts().0 < 50;
            if of_it && let Some(which) = words.take_number(letter, self)? {
                name = format!("{name} {}{which}", char::from(letter));
            }
        }
        self.use_work_offset(&name)
    }

    /// The work offset of this name from here on.
    pub(super) fn use_work_offset(&mut self, name: &str) -> Result<(), Box<Diagnostic>> {
        self.modal.frame_dropped = false;
        if self.state.work_offset.as_deref() == Some(name) {
            return Ok(());
        }
        let place = self.offsets.work.iter().position(|work| work.name == name);
        if place.is_none() && self.state.work_offset.is_some() && !self.offsets_told {
            self.offsets_told = true;
            let message = format!(
                "the program uses several work offsets, and nothing is said of {name}: those of which nothing is said are all taken to be where the machine file has the part"
            );
            self.note(
                Diagnostic::warning("nc-work-offset", message)
                    .help("state them by --offsets, in tables [work.G54] and so on"),
            );
        }
        self.state.work_offset = Some(name.to_owned());
        self.state.offset_assumed = place.is_none();
        self.state_changed();
        self.tell(ProgramEvent::WorkOffset(name.to_owned()));
        if self.work != place {
            self.work = place;
            return self.solver_changed();
        }
        Ok(())
    }
}
