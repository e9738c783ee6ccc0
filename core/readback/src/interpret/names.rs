//! What a block says besides letters with values: names, calls, texts.

use post_grammar::nc::{NcBlock, NcExpression, NcItem, NcValue};
use post_machine::diagnostic::Diagnostic;
use post_machine::work_spindle;
use post_plugin::{Language, Meaning};

use super::assigned::SETTINGS;
use super::block::BlockRequest;
use super::block_words::{BlockWords, which};
use super::spindle_request::SpindleRequest;
use super::state::ControlState;
use super::{cycles, frames, planes};
use crate::g_code::GCode;
use crate::lexicon::WordMeaning;
use crate::{ProgramEvent, SpindleState};

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
                if let b'@' | b'^' = word.letter {
                    control.polar_word(word.letter, &word.value, words)?;
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
            NcItem::Assign { variable, value }
                if control.lexicon.language() == Language::Names
                    && let NcExpression::Indexed { name, index } = &**variable
                    && SETTINGS.contains(&name.as_str()) =>
            {
                control.indexed(name, index, value, words)?;
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
    /// `LIMS[1]=2000`, `S[1]=500`, `M[1]=3`.
    fn indexed(
        &mut self,
        name: &str,
        index: &NcExpression,
        value: &NcExpression,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let worth = |control: &Self, value: &NcExpression| {
            let number = control.variables.number(value);
            number.map_err(|finding| control.placed(*finding).boxed())
        };
        if name == "ATOL" {
            let axis = match index {
                NcExpression::Variable(axis) => axis.clone(),
                _ => "an axis".to_owned(),
            };
            let message = format!(
                "ATOL of {axis} is not followed: how far it lets the control leave the path is not compared with the tolerance"
            );
            self.note(Diagnostic::warning("smoothing", message));
            return Ok(());
        }
        let number = which(b'S', worth(self, index)?, self)?;
        let value = worth(self, value)?;
        if name == "LIMS" {
            // Another spindle turns nothing that is followed here.
            if number == self.modal.master_spindle {
                self.limit_speed(Some(value))?;
            }
            return Ok(());
        }
        self.for_spindle(name.as_bytes()[0], number, value, words)
    }

    /// The letter and the spindle of `S1`, `M1`.
    fn spindle_word(&self, name: &str) -> Option<(u8, u32)> {
        let letter = *name.as_bytes().first().filter(|letter| matches!(letter, b'S' | b'M'))?;
        let number = name.get(1..)?.parse().ok()?;
        (self.lexicon.language() == Language::Names).then_some((letter, number))
    }

    /// S or M for one of the spindles: that of the master spindle is the plain word.
    fn for_spindle(
        &mut self,
        letter: u8,
        number: u32,
        value: f64,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let master = self.modal.master_spindle;
        if number != master {
            let name = char::from(letter);
            let message = format!(
                "{name}{number}= speaks to spindle {number}, and the one that is followed here is the master spindle, {master}"
            );
            return Err(self.refuse("nc-word", message));
        }
        self.add_word(letter, value, words)
    }

    /// `SETMS(1)`, `SETMS`: which spindle is the master; false for any other name.
    fn master_spindle(
        &mut self,
        name: &str,
        arguments: &[Option<NcValue>],
    ) -> Result<bool, Box<Diagnostic>> {
        if name != "SETMS" || self.lexicon.language() != Language::Names {
            return Ok(false);
        }
        let number = match arguments.first() {
            Some(Some(value)) => {
                let worth = self.variables.worth(value);
                which(b'S', worth.map_err(|finding| self.placed(*finding).boxed())?, self)?
            }
            _ => 1,
        };
        let stands = matches!(self.state.spindle, SpindleState::Off | SpindleState::Oriented);
        if number != self.modal.master_spindle && !stands {
            let message = format!(
                "spindle {number} becomes the master while spindle {} turns, and only one of them is followed",
                self.modal.master_spindle
            );
            return Err(self.refuse("nc-word", message));
        }
        let other = self.modal.spindle_used.filter(|used| *used != number);
        if let Some(used) = other
            && !work_spindle::turns_part(&self.machine)
        {
            let message = format!(
                "spindle {number} becomes the master, and spindle {used} turned the tool before: the machine file has one"
            );
            return Err(self.refuse("nc-word", message));
        }
        self.modal.master_spindle = number;
        Ok(true)
    }

    /// By how many degrees CYCLE832 lets the tool axis be turned off: its third argument where the tens of the second are
    /// 1, or its name says so.
    fn turn_of_cycle(&self, arguments: &[Option<NcValue>]) -> Result<Option<f64>, Box<Diagnostic>> {
        let [_, Some(kind), Some(turn), ..] = arguments else {
            return Ok(None);
        };
        let has_turn = match kind {
            NcValue::Number(number) => (10.0..20.0).contains(&number.value),
            NcValue::Expression(name) => match &**name {
                NcExpression::Variable(name) => name.starts_with("_ORI_"),
                _ => false,
            },
            _ => false,
        };
        if !has_turn {
            return Ok(None);
        }
        let worth = self.variables.worth(turn);
        worth.map(Some).map_err(|finding| self.placed(*finding).boxed())
    }

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
        if let Some((letter, number)) = self.spindle_word(name) {
            let value = worth(self)?;
            return self.for_spindle(letter, number, value, words);
        }
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
        match self.lexicon.name_beside(name, words.g.list()) {
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
                self.limit_speed(Some(most))?;
            }
            WordMeaning::Means(Meaning::Nothing) if name == "CTOL" => {
                let tolerance = worth(self)?;
                self.contour_tolerance(tolerance);
            }
            WordMeaning::Means(Meaning::Nothing) if name == "ADIS" => {
                let distance = worth(self)?;
                self.rounding_distance(distance);
            }
            WordMeaning::Means(Meaning::Nothing) if name == "OTOL" => {
                let angle = worth(self)?;
                self.turn_tolerance(angle);
            }
            WordMeaning::Means(Meaning::Nothing | Meaning::Smoothing) => {}
            WordMeaning::Means(Meaning::SmoothingOff) => self.keeps_corners(None),
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
        let across = match approach {
            Some(Approach::Across(across)) => Some(across),
            _ => None,
        };
        let counted = across.map_or(Ok(1.0), |across| self.across(place, across))?;
        let worth = worth * counted * self.axes.scale[place];
        let length = if rotary { worth.to_radians() } else { worth * self.modal.unit };
        let way = match approach {
            Some(Approach::Incremental) => true,
            Some(Approach::Across(across)) => across.incremental,
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
        if frames::name(self, name, words)? || self.master_spindle(name, &[])? {
            return Ok(());
        }
        match self.lexicon.name(name) {
            WordMeaning::Means(meaning) => {
                if meaning == Meaning::TcpOn {
                    self.is_own_transformation(name, &[])?;
                }
                self.meant(None, meaning, words, asked)
            }
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

    /// Refuses other kinematics than those that `tcp_on` of the machine file names: `#KIN ID [91]`.
    fn is_own_kinematics(&self, arguments: &[Option<NcValue>]) -> Result<(), Box<Diagnostic>> {
        let number = match arguments.first() {
            Some(Some(NcValue::Text(text))) => text.trim().parse().ok(),
            _ => self.argument(arguments, 0)?,
        };
        let known = self.lexicon.values_of_call("#KIN ID");
        if number.is_some_and(|number| known == [number]) {
            return Ok(());
        }
        let message = "which kinematics of the control the machine file tells of is not said, or these are others";
        let help = "the lines of `tcp_on` name it: [\"#KIN ID [1]\", …]";
        Err(self.placed(Diagnostic::error("nc-mode", message).help(help)).boxed())
    }

    /// The value of the argument at a place of a call, if something stands there.
    fn argument(
        &self,
        arguments: &[Option<NcValue>],
        place: usize,
    ) -> Result<Option<f64>, Box<Diagnostic>> {
        let Some(Some(value)) = arguments.get(place) else { return Ok(None) };
        let worth = self.variables.worth(value);
        worth.map(Some).map_err(|finding| self.placed(*finding).boxed())
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
            ("#KIN ID", _) => self.is_own_kinematics(arguments)?,
            (_, WordMeaning::Means(Meaning::TiltedPlane)) => {
                return planes::call(self, name, arguments);
            }
            (_, WordMeaning::Means(Meaning::TiltedPlaneOff)) => return planes::end(self),
            (_, WordMeaning::Means(Meaning::CylinderTransformation)) => {
                let diameter = self.argument(arguments, 0)?;
                let radius = diameter.map(|diameter| diameter * self.modal.unit / 2.0);
                let data_set = self.argument(arguments, 1)?.unwrap_or(1.0);
                return self.begin_wrap(radius, data_set, name);
            }
            (_, WordMeaning::Means(Meaning::FaceTransformation)) => {
                let data_set = self.argument(arguments, 0)?.unwrap_or(1.0);
                return self.begin_face(data_set);
            }
            (_, WordMeaning::Means(Meaning::SmoothingOff))
                if self.lexicon.language() == Language::Names =>
            {
                self.smoothing_cycle_off();
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
                let unit = if self.lexicon.smooths_in_mm() { 1.0 } else { self.modal.unit };
                let tolerance = tolerance.map(|tolerance| tolerance * unit);
                if self.lexicon.language() == Language::Names {
                    let turn = self.turn_of_cycle(arguments)?;
                    self.smoothing_cycle(tolerance, turn);
                } else {
                    self.leaves_corners(None, tolerance, None);
                }
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
            _ if self.master_spindle(name, arguments)? => {}
            (_, WordMeaning::Means(meaning)) => {
                if meaning == Meaning::TcpOn && self.lexicon.language() == Language::Names {
                    let values: Vec<Option<f64>> = (0..arguments.len())
                        .map(|place| self.argument(arguments, place))
                        .collect::<Result<_, _>>()?;
                    self.is_own_transformation(name, &values)?;
                }
                return self.meant(None, meaning, words, asked);
            }
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
