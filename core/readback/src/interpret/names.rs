//! What a block says besides letters with values: names, calls, texts.

use post_grammar::nc::{NcBlock, NcItem, NcValue};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{Language, Meaning};

use super::block::BlockRequest;
use super::block_words::{BlockWords, which};
use super::spindle_request::SpindleRequest;
use super::state::ControlState;
use super::{cycles, frames, planes};
use crate::ProgramEvent;
use crate::g_code::GCode;
use crate::lexicon::WordMeaning;

/// Takes what `gather` left.
pub(super) fn take(
    control: &mut ControlState,
    block: &NcBlock,
    words: &mut BlockWords,
    asked: &mut BlockRequest,
) -> Result<(), Box<Diagnostic>> {
    let mut modal_call = false;
    let mut items = block.items.iter().peekable();
    while let Some(item) = items.next() {
        match item {
            NcItem::Word(word) => {
                if let (b'T', NcValue::Text(name)) = (word.letter, &word.value) {
                    control.tools.ready_name = Some(name.clone());
                    control.tools.ready = None;
                }
            }
            NcItem::Named { name, value } => control.named(name, value, words, asked)?,
            NcItem::Name(name) => {
                let sense = control.lexicon.name(name);
                if sense != WordMeaning::Means(Meaning::CycleCallModal) {
                    control.name(name, words, asked)?;
                } else if matches!(items.peek(), Some(NcItem::Call { .. } | NcItem::Name(_))) {
                    modal_call = true;
                } else {
                    asked.cycle_off = true;
                }
            }
            NcItem::Call { name, arguments } => {
                control.call(name, arguments, modal_call, words, asked)?;
                modal_call = false;
            }
            NcItem::Assign { .. } | NcItem::Flow(_) => {
                return Err(control.refuse("nc-flow", "what leads the program elsewhere, or sets a variable, stands among words of motion"));
            }
            // Statements go a way of their own.
            NcItem::Statement(_) => {}
            NcItem::Number(number) => {
                let message = format!("{} stands alone", number.value);
                return Err(control.refuse("nc-word", message));
            }
            NcItem::Text(text) => control.unknown(&format!("\"{text}\"")),
        }
    }
    Ok(())
}

impl ControlState {
    /// A name with a value: `A3=0.5`, `CR=5`, an axis of a longer name.
    fn named(
        &mut self,
        name: &str,
        value: &NcValue,
        words: &mut BlockWords,
        asked: &mut BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        if let Some((_, place)) = self.axes.names.iter().find(|(known, _)| known == name) {
            let place = *place;
            return self.named_axis(place, value, words);
        }
        let worth = |control: &Self| {
            control.variables.worth(value).map_err(|finding| control.placed(*finding).boxed())
        };
        let mut part = |row: usize| -> Result<(), Box<Diagnostic>> {
            words.vector.get_or_insert_default()[row] = worth(self)?;
            Ok(())
        };
        if self.lexicon.language() == Language::Instructions
            && let Some(offset) = numbered_offset(self, name)
        {
            let number = worth(self)?;
            return self.use_work_offset(&format!("{offset}={number}"));
        }
        match self.lexicon.name(name) {
            WordMeaning::Means(Meaning::ToolAxisX) => part(0)?,
            WordMeaning::Means(Meaning::ToolAxisY) => part(1)?,
            WordMeaning::Means(Meaning::ToolAxisZ) => part(2)?,
            WordMeaning::Means(Meaning::Radius) => {
                words.radius = Some(worth(self)? * self.modal.unit)
            }
            WordMeaning::Means(Meaning::Turns) => words.turns = Some(worth(self)?),
            WordMeaning::Means(Meaning::LengthRegister) => {
                let value = worth(self)?;
                self.modal.named_register = Some(which(b'H', value, self)?);
            }
            WordMeaning::Means(Meaning::SpeedLimit) => {
                let most = worth(self)?;
                self.limit_speed(Some(most));
            }
            WordMeaning::Means(Meaning::Nothing) if name == "CTOL" => {
                let tolerance = worth(self)?;
                self.contour_tolerance(tolerance);
            }
            WordMeaning::Means(Meaning::Nothing) if name == "ADIS" => {
                let distance = worth(self)?;
                self.rounding_distance(distance);
            }
            WordMeaning::Means(Meaning::Nothing | Meaning::Smoothing) => {}
            WordMeaning::Means(Meaning::SmoothingOff) => {
                self.smooth(None);
                self.keeps_corners(None);
            }
            WordMeaning::Means(Meaning::SpindleOrient) => {
                asked.spindle = Some(SpindleRequest::Oriented)
            }
            WordMeaning::Means(Meaning::Probe) => {
                return Err(self.refuse(
                    "nc-probe",
                    "a probing move ends where it touches, which the program does not say",
                ));
            }
            WordMeaning::Unknown if name == "HL" => {
                let value = worth(self)?;
                self.modal.named_register = Some(which(b'H', value, self)?);
            }
            _ => {
                let message =
                    format!("{name}= is not run, and might change the motion of its block");
                return Err(self.refuse("nc-word", message));
            }
        }
        Ok(())
    }

    /// The value of an axis whose name is longer than a letter.
    fn named_axis(
        &mut self,
        place: usize,
        value: &NcValue,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        use post_grammar::nc::Approach;
        let approach = match value {
            NcValue::Approached(approach, _) => Some(*approach),
            _ => None,
        };
        let worth = self.variables.worth(value).map_err(|finding| self.placed(*finding).boxed())?;
        let rotary = self.axes.rotary & (1 << place) != 0;
        let worth = worth * self.axes.scale[place];
        let length = if rotary { worth.to_radians() } else { worth * self.modal.unit };
        let way = match approach {
            Some(Approach::Incremental) => true,
            Some(_) => false,
            None => self.modal.incremental,
        };
        let to = if way {
            self.word_at(place) + length
        } else if rotary {
            let to = self.zero[place] + length;
            match approach {
                Some(approach) if approach != Approach::Absolute => {
                    self.approach(place, to, Some(approach))
                }
                _ => self.turned(place, to),
            }
        } else {
            self.zero[place] + length
        };
        words.named_axes |= 1 << place;
        words.named_values[place] = to;
        Ok(())
    }

    /// A name alone.
    fn name(
        &mut self,
        name: &str,
        words: &mut BlockWords,
        asked: &mut BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        if frames::name(self, name, words)? {
            return Ok(());
        }
        match self.lexicon.name(name) {
            WordMeaning::Means(meaning) => self.meant(None, meaning, words, asked),
            // A name alone may be that of a subprogram.
            WordMeaning::Unknown if self.lexicon.language() == Language::Names => {
                Err(self.placed(*super::astray::elsewhere(name)).boxed())
            }
            WordMeaning::Unknown => {
                let message =
                    format!("{name} is not known, and might lead elsewhere or change what moves");
                Err(self.refuse("nc-word", message))
            }
            WordMeaning::Refused => {
                let message =
                    format!("{name} is not run, and might change the motion of its block");
                Err(self.refuse("nc-word", message))
            }
        }
    }

    /// A call with parentheses.
    fn call(
        &mut self,
        name: &str,
        arguments: &[Option<NcValue>],
        modal: bool,
        words: &mut BlockWords,
        asked: &mut BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        let empty = arguments.iter().all(Option::is_none);
        let sense = if empty { self.lexicon.empty_call(name) } else { self.lexicon.name(name) };
        match (name, sense) {
            ("MSG" | "#MSG", _) => {
                if let Some(Some(NcValue::Text(text))) = arguments.first() {
                    let text = text.clone();
                    self.tell(ProgramEvent::Message(text));
                }
            }
            (_, WordMeaning::Means(Meaning::TiltedPlane)) => {
                return planes::call(self, name, arguments);
            }
            (_, WordMeaning::Means(Meaning::TiltedPlaneOff)) => return planes::end(self),
            (_, WordMeaning::Means(Meaning::CylinderTransformation)) => {
                let diameter = match arguments.first() {
                    Some(Some(value)) => {
                        let worth = self.variables.worth(value);
                        Some(worth.map_err(|finding| self.placed(*finding).boxed())?)
                    }
                    _ => None,
                };
                let radius = diameter.map(|diameter| diameter * self.modal.unit / 2.0);
                return self.begin_wrap(radius, name);
            }
            (_, WordMeaning::Means(Meaning::Smoothing)) => {
                let tolerance = match arguments.first() {
                    Some(Some(NcValue::Text(words))) => deviation_in(words),
                    Some(Some(value)) => Some(
                        self.variables
                            .worth(value)
                            .map_err(|finding| self.placed(*finding).boxed())?,
                    ),
                    _ => None,
                };
                let tolerance = tolerance.map(|tolerance| tolerance * self.modal.unit);
                let allowed = self.allowed_off_path(None, tolerance);
                self.smooth(allowed);
                self.leaves_corners(None, tolerance);
            }
            (
                _,
                WordMeaning::Means(
                    meaning @ (Meaning::CycleDrill
                    | Meaning::CycleDeep
                    | Meaning::CycleBreakChip
                    | Meaning::CycleTap
                    | Meaning::CycleTapLeft
                    | Meaning::CycleReam
                    | Meaning::CycleBore
                    | Meaning::CycleBoreFine
                    | Meaning::CycleBoreBack),
                ),
            ) => return cycles::call(self, name, meaning, arguments, modal),
            (_, WordMeaning::Means(meaning @ Meaning::CycleOther)) if cycles::known(name) => {
                return cycles::call(self, name, meaning, arguments, modal);
            }
            (_, WordMeaning::Means(Meaning::Nothing)) => {}
            (_, WordMeaning::Means(meaning)) => return self.meant(None, meaning, words, asked),
            _ => {
                let message = format!(
                    "{name}(…) is no cycle or subprogram that is known here, and might move the machine"
                );
                return Err(self.refuse("nc-word", message));
            }
        }
        Ok(())
    }
}

/// How far the path may be left by the words of an instruction, program units: `CONTERROR 0.01` (Fagor),
/// `PATH_DEV=0.02 TRACK_DEV=1` (ISG).
fn deviation_in(words: &str) -> Option<f64> {
    let behind = |word| words.split_once(word).map(|(_, behind)| behind);
    let value = behind("CONTERROR").or_else(|| behind("PATH_DEV"))?;
    let value = value.trim_start_matches(|letter: char| letter == '=' || letter.is_whitespace());
    value.split(|letter: char| letter == ',' || letter.is_whitespace()).next()?.parse().ok()
}

/// The word of a work offset whose number stands behind it: `G159` of `G159=7`; none of any other.
fn numbered_offset<'n>(control: &ControlState, name: &'n str) -> Option<&'n str> {
    let code = GCode::nearest(name.strip_prefix('G')?.parse().ok()?)?;
    let offset = control.lexicon.g(code) == WordMeaning::Means(Meaning::WorkOffset);
    offset.then_some(name)
}
