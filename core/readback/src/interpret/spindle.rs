//! Tool changes, spindle, coolant and waits.

use post_machine::diagnostic::Diagnostic;
use post_plugin::{Language, Meaning};

use super::block::BlockRequest;
use super::block_words::{BlockWords, bit, which};
use super::spindle_request::SpindleRequest;
use super::state::ControlState;
use crate::g_code::GCode;
use crate::{ProgramEvent, SpindleState};

/// Metres in a foot.
const FOOT: f64 = 0.3048;

impl ControlState {
    pub(super) fn tool_and_spindle(
        &mut self,
        words: &mut BlockWords,
        asked: &BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        let kept = std::mem::take(&mut self.modal.kept_speed) && asked.spindle.is_none();
        let speed = words.take(b'S');
        if let Some(speed) = speed {
            self.name_speed(speed);
        }
        if speed.is_some() || kept {
            // Beside a word that turns it the new speed never has the old sense.
            if matches!(asked.spindle, None | Some(SpindleRequest::Off)) {
                self.speed_changed();
            }
        }
        if let Some(number) = words.take(b'T').filter(|number| !number.is_nan()) {
            let number = which(b'T', number, self)?;
            if self.lexicon.letter(b'T') == Some(Meaning::ToolAndOffset) {
                self.tool_and_offset(number)?;
            } else {
                self.tools.ready = Some(number);
                self.tools.ready_name = None;
                self.tools.ready_at = Some(self.at.joints);
                if !self.lexicon.changes_by_word() {
                    self.change_tool(Some(number), None)?;
                } else if !asked.change {
                    self.tell(ProgramEvent::Preselect(number));
                }
            }
        }
        if asked.change {
            let (number, name) = (self.tools.ready, self.tools.ready_name.clone());
            self.change_tool(number, name)?;
        }
        match asked.spindle {
            Some(SpindleRequest::Off) if !self.stops_ahead(asked) => {}
            Some(turning) => self.turn_spindle(turning),
            None => {}
        }
        Ok(())
    }

    /// What a block switches off stands still before it moves: on RS-274/NGC and Siemens, and where it drills; else when
    /// the motion has come to its end, as ISO 6983 has it.
    pub(super) fn stops_ahead(&self, asked: &BlockRequest) -> bool {
        let drills = asked.cycle.is_some() || self.cycles.in_force() && !asked.cycle_off;
        drills || matches!(self.lexicon.language(), Language::Rs274 | Language::Names)
    }

    /// S: the spindle's speed from here on, revolutions a minute or of the cut.
    pub(super) fn name_speed(&mut self, speed: f64) {
        self.modal.speed = speed;
        if speed > 0.0 {
            self.report.speed.get_or_insert(self.line);
        }
    }

    /// The program stops: where the control stops the spindle and the coolant with it, what is on now is off behind it.
    pub(super) fn stand_still(&mut self) {
        if !self.lexicon.stops_spindle() {
            return;
        }
        let standstill = &mut self.state.standstill;
        if !matches!(self.state.spindle, SpindleState::Off | SpindleState::Oriented) {
            standstill.spindle = Some(self.line);
        }
        if self.state.coolants != crate::Coolants::default() {
            standstill.coolant = Some(self.line);
        }
        self.state_changed();
    }

    /// The largest speed at a constant cutting speed from here on, revolutions a minute; none: any.
    ///
    /// # Errors
    /// The spindle turns faster at a speed of its own: some controls hold it back then, too (Siemens, Mitsubishi).
    pub(super) fn limit_speed(&mut self, most: Option<f64>) -> Result<(), Box<Diagnostic>> {
        self.modal.most_speed = most;
        match (self.state.spindle, most) {
            (SpindleState::Surface { .. }, _) => self.speed_changed(),
            (
                SpindleState::Clockwise(speed) | SpindleState::CounterClockwise(speed),
                Some(most),
            ) if speed > most => {
                let message = format!(
                    "a limit of {most} while the spindle turns at S{speed}: whether that holds it back hangs on the control"
                );
                return Err(self.refuse("nc-word", message));
            }
            _ => {}
        }
        Ok(())
    }

    /// The cutting speed is kept from here on: S is one, also that which stands.
    pub(super) fn cut_at_speed(&mut self) {
        self.modal.kept_speed |= !std::mem::replace(&mut self.modal.surface_speed, true);
    }

    /// The cutting speed is kept no more: the spindle turns on as fast as it does where the tool stands, until S says another
    /// speed.
    pub(super) fn keep_speed(&mut self) {
        if !std::mem::take(&mut self.modal.surface_speed) {
            return;
        }
        let tip = self.at.pose.tip;
        let turning = self.state.spindle.surface_rpm([tip, tip]);
        // Without a limit there is no speed on the line of the spindle.
        if let Some([rpm, _]) = turning.filter(|[rpm, _]| rpm.is_finite()) {
            self.modal.speed = rpm;
            self.modal.kept_speed = true;
        }
    }

    /// S changed while the spindle turns. One that a stop has stopped stays so.
    pub(super) fn speed_changed(&mut self) {
        let standstill = self.state.standstill;
        self.turn_at_speed();
        if self.state.standstill != standstill {
            self.state.standstill = standstill;
            self.state_changed();
        }
    }

    fn turn_at_speed(&mut self) {
        match self.state.spindle {
            SpindleState::Clockwise(_) => self.turn_spindle(SpindleRequest::Clockwise),
            SpindleState::CounterClockwise(_) => {
                self.turn_spindle(SpindleRequest::CounterClockwise)
            }
            SpindleState::Surface { clockwise, .. } => self.turn_spindle(if clockwise {
                SpindleRequest::Clockwise
            } else {
                SpindleRequest::CounterClockwise
            }),
            SpindleState::Off | SpindleState::Oriented => {}
        }
    }

    /// What the spindle does from here on.
    pub(super) fn turn_spindle(&mut self, turning: SpindleRequest) {
        self.modal.tapped = false;
        let spindle = match turning {
            SpindleRequest::Clockwise | SpindleRequest::CounterClockwise
                if self.modal.surface_speed =>
            {
                SpindleState::Surface {
                    // Feet a minute in an inch program.
                    speed: self.modal.speed * if self.modal.unit > 1.0 { FOOT } else { 1.0 },
                    most: self.modal.most_speed,
                    clockwise: turning == SpindleRequest::Clockwise,
                }
            }
            SpindleRequest::Clockwise => SpindleState::Clockwise(self.modal.speed),
            SpindleRequest::CounterClockwise => SpindleState::CounterClockwise(self.modal.speed),
            SpindleRequest::Off => SpindleState::Off,
            SpindleRequest::Oriented => SpindleState::Oriented,
        };
        if !matches!(spindle, SpindleState::Off | SpindleState::Oriented) {
            self.modal.spindle_used = Some(self.modal.master_spindle);
        }
        let standstill = &mut self.state.standstill;
        if standstill.spindle.take().is_some() | standstill.change.take().is_some() {
            self.state_changed();
        }
        if self.state.spindle != spindle {
            self.state.spindle = spindle;
            self.state_changed();
            self.tell(ProgramEvent::Spindle(spindle));
        }
    }

    /// A rigid tapping cycle is over: the spindle, which was an axis in it, stands.
    pub(super) fn stand_behind_taps(&mut self) {
        self.modal.rigid_taps = false;
        if self.modal.tapped {
            self.turn_spindle(SpindleRequest::Off);
        }
    }

    /// Coolant of an M code from here on.
    pub(super) fn coolant(&mut self, code: u16) {
        let mut coolants = self.state.coolants;
        match code {
            7 => coolants.mist = true,
            8 => coolants.flood = true,
            _ => coolants.other = true,
        }
        self.flow_of_coolant(coolants);
    }

    /// No coolant from here on.
    pub(super) fn coolant_off(&mut self) {
        self.flow_of_coolant(crate::Coolants::default());
    }

    pub(super) fn flow_of_coolant(&mut self, coolants: crate::Coolants) {
        let standstill = &mut self.state.standstill;
        if standstill.coolant.take().is_some() | standstill.dry_change.take().is_some() {
            self.state_changed();
        }
        if self.state.coolants != coolants {
            self.state.coolants = coolants;
            self.state_changed();
            self.tell(ProgramEvent::Coolant(coolants));
        }
    }

    /// G4: seconds, turns of the spindle where the control counts them.
    pub(super) fn dwell(&mut self, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
        let told = |time, revolutions| ProgramEvent::Dwell { time, revolutions };
        let told = match self.lexicon.language() {
            Language::Names => match (words.take(b'F'), words.take(b'S')) {
                (Some(time), _) => told(time, false),
                (None, Some(turns)) => told(turns, true),
                (None, None) => return Err(self.refuse("nc-dwell", "G4 says neither F nor S")),
            },
            _ => self.letters_dwell(words)?,
        };
        // They were times, and are nothing else in this block.
        words.present &= !(bit(b'F') | bit(b'S') | bit(b'X') | bit(b'U') | bit(b'K'));
        self.tell(told);
        Ok(())
    }

    /// The time of a wait by its letter: as the dialect says of it, else X, U and F in seconds.
    pub(super) fn letters_dwell(
        &mut self,
        words: &mut BlockWords,
    ) -> Result<ProgramEvent, Box<Diagnostic>> {
        const G4: GCode = GCode::whole(4);
        for letter in [b'P', b'X', b'U', b'F', b'S', b'K'] {
            let meaning = self.lexicon.letter_beside(G4, letter);
            let usual = matches!(letter, b'X' | b'U' | b'F').then_some(Meaning::DwellSeconds);
            let Some(meaning) = meaning.or(usual) else {
                continue;
            };
            let Some(value) = words.take(letter) else {
                continue;
            };
            let pointed = words.pointed & bit(letter) != 0;
            let time = match meaning {
                Meaning::DwellMilliseconds if !pointed => value / 1000.0,
                _ => value,
            };
            let revolutions = meaning == Meaning::DwellTurns;
            return Ok(ProgramEvent::Dwell { time, revolutions });
        }
        Err(self.refuse("nc-dwell", "the wait does not say how long in a way that is known"))
    }
}
