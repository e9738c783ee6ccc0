//! A block of words: what is modal is settled first, then the machine moves.
//!
//! Whatever order the words of a block are written in, a control takes them in one order: units and modes, feed and
//! speed, tool, spindle and coolant on, compensations, zeros, the motion, and last what ends something.

use post_grammar::nc::{NcBlock, NcItem, NcValue, NcWord};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{AxisWords, Language, Meaning};

use super::block_words::{BlockWords, bit};
use super::go::MotionTarget;
use super::spindle_request::SpindleRequest;
use super::state::{ControlState, FeedMeaning, MotionMode};
use super::{ModalGroup, ModesInForce, cycles, frames, names, planes};
use crate::g_code::GCode;
use crate::lexicon::WordMeaning;
use crate::{Curve, MotionKind, ProgramEvent};

/// What the words of one block ask for, besides what is modal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BlockRequest {
    /// Whether positions are machine coordinates.
    pub machine: bool,
    /// Reference position to go to, by way of a point.
    pub reference: Option<u8>,
    /// A wait.
    pub dwell: bool,
    /// A cycle: its G code, if it begins by one, and what it does.
    pub cycle: Option<(Option<GCode>, Meaning)>,
    /// Whether the cycle ends.
    pub cycle_off: bool,
    /// A tilted plane begins by this code.
    pub plane: Option<GCode>,
    /// The axes turn to the plane by this code.
    pub plane_turn: Option<GCode>,
    /// Whether the tilted plane ends.
    pub plane_off: bool,
    /// A shift or a turn of the coordinates: its code and its meaning.
    pub frame: Option<(GCode, Meaning)>,
    /// A work offset.
    pub work: Option<GCode>,
    /// Whether length compensation goes on.
    pub length_on: bool,
    /// Length compensation by the length that the block names.
    pub length_stated: bool,
    /// Whether length compensation goes off.
    pub length_off: bool,
    /// Whether tool centre point control goes on.
    pub tcp_on: bool,
    /// The G code that switches it on; none of a name.
    pub tcp_code: Option<GCode>,
    /// Whether tool axes are written as vectors.
    pub vectors: bool,
    /// Whether tool centre point control goes off.
    pub tcp_off: bool,
    /// The tool is changed.
    pub change: bool,
    /// M0 that changes the tool beside T or right behind it, and alone stops the program as everywhere.
    pub change_or_stop: bool,
    /// Spindle from here on.
    pub spindle: Option<SpindleRequest>,
    /// Coolant from here on: the number after M.
    pub coolant: Option<u16>,
    /// No coolant.
    pub coolant_off: bool,
    /// The program stops.
    pub stop: Option<Meaning>,
    /// A thread or tap without a cycle: its code and its meaning.
    pub thread: Option<(GCode, Meaning)>,
    /// A probing move.
    pub probe: bool,
    /// Whether this block goes at rapid.
    pub rapid: bool,
    /// The first code that has the words of axes for itself.
    pub own_axis_words: Option<GCode>,
    /// Another one.
    pub also_own: Option<GCode>,
    /// A code beside which no words of axes stand.
    pub no_axis_words: Option<GCode>,
}

/// Words of axes that no machine here has need to be said: they would move something.
const AXIS_LETTERS: u32 = bit(b'A')
    | bit(b'B')
    | bit(b'C')
    | bit(b'U')
    | bit(b'V')
    | bit(b'W')
    | bit(b'X')
    | bit(b'Y')
    | bit(b'Z');

/// Words that change how a motion goes: they are never passed over.
const SHAPES: u32 = bit(b'I') | bit(b'J') | bit(b'K') | bit(b'R');

/// Runs a block of words.
pub(super) fn run(
    control: &mut ControlState,
    block: &NcBlock,
    words: &mut BlockWords,
) -> Result<(), Box<Diagnostic>> {
    control.gather(block, words)?;
    if control.lexicon.commands_a_line() {
        control.is_one_command(block)?;
    }
    for remark in &block.remarks {
        control.remark(remark);
    }
    let mut asked = BlockRequest::default();
    if words.more {
        control.modal.named_register = None;
        names::take(control, block, words, &mut asked)?;
    }
    for index in 0..words.g.list().len() {
        control.g_code(words.g.list()[index], words, &mut asked)?;
    }
    if words.more {
        control.polar_place(words, &asked)?;
    }
    if std::mem::take(&mut control.cycles.cut_off) && !asked.cycle_off {
        control.report.cycle_cut_off.get_or_insert(control.line);
    }
    for index in 0..words.m.list().len() {
        control.m_code(words.m.list()[index], &mut asked)?;
    }
    if asked.change_or_stop {
        // T in a block ahead of it, and nothing has moved since.
        let ready = control.tools.ready_at == Some(control.at.joints);
        match words.present & bit(b'T') != 0 || ready {
            true => asked.change = true,
            false => asked.stop = Some(Meaning::Stop),
        }
    }
    if words.present == 0 && words.g.list().is_empty() && words.m.list().is_empty() && !words.more {
        return Ok(());
    }
    control.within_spline(words)?;
    let before = control.done.len();
    control.obey(words, &asked)?;
    control.along_word(words, before)?;
    control.left_over(words)
}

impl ControlState {
    /// Of a control whose line is a command and its parameters: one stands first, and no other behind it but where the first
    /// says what the second counts from (G53).
    #[cold]
    fn is_one_command(&self, block: &NcBlock) -> Result<(), Box<Diagnostic>> {
        let is_command = |letter| matches!(letter, b'G' | b'M');
        let written = |word: &NcWord| match &word.value {
            NcValue::Number(number) => format!("{}{}", char::from(word.letter), number.value),
            _ => char::from(word.letter).to_string(),
        };
        let [first, others @ ..] = block.items.as_slice() else {
            return Ok(());
        };
        let help = "a line of this control is one command and its parameters";
        let refused = |message: String| {
            Err(self.placed(Diagnostic::error("nc-word", message).help(help)).boxed())
        };
        let mut in_machine = match first {
            NcItem::Word(word) if is_command(word.letter) || word.letter == b'T' => {
                let code = match &word.value {
                    NcValue::Number(number) if word.letter == b'G' => GCode::of(number.value),
                    _ => None,
                };
                let sense = code.map(|code| self.lexicon.g(code));
                sense == Some(WordMeaning::Means(Meaning::MachineCoordinates))
            }
            NcItem::Word(word) => {
                let message = format!("{} begins a line, which is no command", written(word));
                return refused(message);
            }
            _ => return refused("the line begins with no command of a letter".to_owned()),
        };
        for item in others {
            match item {
                NcItem::Word(word)
                    if is_command(word.letter) && !std::mem::take(&mut in_machine) =>
                {
                    let message =
                        format!("{} stands behind the command of its line", written(word));
                    return refused(message);
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// A remark; one that names an operation says which.
    pub(super) fn remark(&mut self, remark: &str) {
        let text = remark.trim();
        if text.is_empty() {
            return;
        }
        match operation(text) {
            Some(name) => self.begin_operation(name),
            None => self.tell(ProgramEvent::Remark(text.to_owned())),
        }
        self.head_by_hand = self.head_named(text);
    }

    /// The head without a word of its own that the operator swaps in at the next stop, if a remark names it.
    fn head_named(&self, remark: &str) -> Option<usize> {
        let name = remark.strip_prefix("CHANGE TO HEAD ")?.trim();
        let mut heads = self.heads.iter();
        heads.position(|head| head.word.is_none() && head.name.eq_ignore_ascii_case(name))
    }

    /// The program stops; that may be for the operator to swap a head.
    pub(super) fn stop(&mut self, event: ProgramEvent) -> Result<(), Box<Diagnostic>> {
        match self.head_by_hand.take() {
            Some(head) => self.take_head(head),
            None => {
                self.stand_still();
                self.tell(event);
                Ok(())
            }
        }
    }

    /// An operation of this name begins.
    pub(super) fn begin_operation(&mut self, name: &str) {
        self.state.operation = Some(name.to_owned());
        self.state_changed();
        self.tell(ProgramEvent::Operation(name.to_owned()));
    }

    /// Takes a G code: what is modal holds from here on, the rest is asked for.
    #[inline]
    fn g_code(
        &mut self,
        code: GCode,
        words: &mut BlockWords,
        asked: &mut BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        match self.lexicon.g(code) {
            WordMeaning::Means(Meaning::Rapid) => self.motion(MotionMode::Rapid),
            WordMeaning::Means(Meaning::Linear) => self.motion(MotionMode::Linear),
            WordMeaning::Means(Meaning::ArcClockwise) => self.motion(MotionMode::Clockwise),
            WordMeaning::Means(Meaning::ArcCounterClockwise) => {
                self.motion(MotionMode::CounterClockwise)
            }
            _ => {
                let sense = self.lexicon.g_beside(code, |letter| words.get(letter));
                return self.other_g(code, sense, words, asked);
            }
        }
        Ok(())
    }

    #[inline]
    pub(super) fn motion(&mut self, mode: MotionMode) {
        self.modal.motion = mode;
        self.stand_behind_taps();
        if self.cycles.in_force() {
            self.cycles.cut_off = !self.lexicon.rapids_end_cycles();
            cycles::end(self);
        }
    }

    /// A G code that is no motion.
    fn other_g(
        &mut self,
        code: GCode,
        sense: WordMeaning,
        words: &mut BlockWords,
        asked: &mut BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        match sense {
            WordMeaning::Means(meaning) => {
                match self.lexicon.axis_words(code, meaning) {
                    AxisWords::Lead => {}
                    AxisWords::Own if asked.own_axis_words.is_none() => {
                        asked.own_axis_words = Some(code)
                    }
                    AxisWords::Own => asked.also_own = Some(code),
                    AxisWords::None => asked.no_axis_words = Some(code),
                }
                self.meant(Some(code), meaning, words, asked)
            }
            WordMeaning::Refused => Err(self.not_followed(Some(code))),
            WordMeaning::Unknown => {
                let help = "a G code may change where the machine goes, so none is passed over";
                let message = format!("{code} is no word that is known of this control");
                let finding = Diagnostic::error("nc-word", message).help(help);
                Err(self.placed(finding).boxed())
            }
        }
    }

    /// A word whose meaning is known and that is not run; `code` is its G code, if it has one.
    #[cold]
    pub(super) fn not_followed(&self, code: Option<GCode>) -> Box<Diagnostic> {
        let word = code.map_or_else(|| "a word of this block".to_owned(), |code| code.to_string());
        let message = format!("{word} is not run: what the machine does then is not followed");
        self.refuse("nc-word", message)
    }

    /// Takes an M code.
    pub(super) fn m_code(
        &mut self,
        code: u16,
        asked: &mut BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        if matches!(code, 67 | 68) && self.lexicon.language() == Language::Rs274 {
            let message = format!(
                "M{code} is not run: its output may be wired to what switches the kinematics"
            );
            let help = "a remap by which the machine file switches (M428, M429) is followed";
            let finding = Diagnostic::error("nc-word", message).help(help);
            return Err(self.placed(finding).boxed());
        }
        // Fanuc's word, and that of the controls whose dialect names it.
        self.modal.rigid_taps |= code == 29
            && self.lexicon.language() == Language::Macro
            && self.lexicon.m(code) == WordMeaning::Means(Meaning::Nothing);
        let clamps = self.clamps.take(&self.machine, code);
        match self.lexicon.m(code) {
            WordMeaning::Means(Meaning::ToolChange) if code == 0 => {
                asked.change_or_stop = true;
                Ok(())
            }
            WordMeaning::Means(Meaning::CoolantOn) => {
                asked.coolant = Some(code);
                Ok(())
            }
            WordMeaning::Means(meaning) => {
                self.meant(None, meaning, &mut BlockWords::default(), asked)
            }
            WordMeaning::Refused => Err(self.refuse(
                "nc-word",
                format!("M{code} is not run: it may change what the words behind it mean"),
            )),
            _ => {
                if !self.swap_head(code)? && !clamps {
                    self.unknown(&format!("M{code}"));
                }
                Ok(())
            }
        }
    }

    /// The word swaps a head in.
    fn swap_head(&mut self, code: u16) -> Result<bool, Box<Diagnostic>> {
        let mut heads = self.heads.iter();
        let head = heads.position(|head| head.word.as_deref().and_then(m_number) == Some(code));
        match head {
            Some(head) => self.take_head(head).map(|()| true),
            None => Ok(false),
        }
    }

    /// The head at this place among the machine's is swapped in.
    fn take_head(&mut self, head: usize) -> Result<(), Box<Diagnostic>> {
        let head = &self.heads[head];
        let (name, machine) = (head.name.clone(), std::sync::Arc::clone(&head.machine));
        self.head_changed(machine)?;
        self.tell(ProgramEvent::Head(name));
        Ok(())
    }

    /// Does what the block asks for, in the order in which controls do it.
    fn obey(
        &mut self,
        words: &mut BlockWords,
        asked: &BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        if asked.dwell {
            self.dwell(words)?;
        }
        if let Some(feed) = words.take(b'F') {
            let unit =
                if self.modal.feed_mode == FeedMeaning::Inverse { 1.0 } else { self.modal.unit };
            if feed < 0.0 {
                return Err(self.refuse("nc-feed", format!("F{feed} is no feed")));
            }
            self.modal.feed = Some(feed * unit);
        }
        if words.present & (bit(b'S') | bit(b'T')) != 0
            || self.modal.kept_speed
            || asked.change
            || asked.spindle.is_some()
        {
            self.tool_and_spindle(words, asked)?;
        }
        if let Some(code) = asked.coolant {
            self.coolant(code);
        }
        if asked.coolant_off && self.stops_ahead(asked) {
            self.coolant_off();
        }
        if asked.plane_off {
            planes::end(self)?;
        }
        self.compensations(words, asked)?;
        if let Some(code) = asked.work {
            self.work_offset(code, words)?;
        }
        self.move_as_asked(words, asked)?;
        if asked.spindle == Some(SpindleRequest::Off) {
            self.turn_spindle(SpindleRequest::Off);
        }
        if asked.coolant_off {
            self.coolant_off();
        }
        match asked.stop {
            Some(Meaning::Stop) => self.stop(ProgramEvent::Stop)?,
            Some(Meaning::OptionalStop) => self.stop(ProgramEvent::OptionalStop)?,
            Some(_) => self.end(),
            None => {}
        }
        Ok(())
    }

    /// What is in force that should end before a tool change or the end of the program, as messages call it.
    pub(super) fn in_force(&self) -> Vec<&'static str> {
        let holds = [
            (self.state.compensation != 0, "radius compensation"),
            (self.cycles.in_force(), "a cycle"),
            (self.frames.plane.is_some(), "a tilted plane"),
            (self.face.is_some(), "polar interpolation"),
            (self.state.wrap.is_some(), "cylinder interpolation"),
            (self.state.tcp, "tool centre point control"),
        ];
        holds.iter().filter(|(holds, _)| *holds).map(|(_, name)| *name).collect()
    }

    /// What the words count from is shifted or turned by the program, where the control keeps that past its end: a
    /// Siemens and a conversational one take it back there.
    fn shifted(&self) -> Option<&'static str> {
        let kept = matches!(self.lexicon.language(), Language::Macro | Language::Rs274);
        let shifted = !self.frames.outer.is_default() || !self.frames.inner.is_default();
        (kept && shifted).then_some("a shift or turn of the coordinates (G92, G52, G68)")
    }

    /// The program ends.
    pub(super) fn end(&mut self) {
        let mut modes = self.in_force();
        modes.extend(self.shifted());
        self.report.end = Some(ModesInForce { line: self.line, modes });
        self.tell(ProgramEvent::End);
        self.ended = true;
    }

    /// The motion, or what takes the words of axes instead.
    fn move_as_asked(
        &mut self,
        words: &mut BlockWords,
        asked: &BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        if words.present & self.axes.mask != 0 {
            self.relies_on(ModalGroup::Units);
            self.relies_on(ModalGroup::Distance);
            if words.present & bit(b'X') != 0 {
                self.relies_on(ModalGroup::Diameter);
            }
        }
        self.alone_on_face(asked)?;
        self.own_axis_words(words, asked)?;
        if let Some((code, meaning)) = asked.frame {
            return frames::code(self, code, meaning, words);
        }
        if let Some(code) = asked.plane {
            return planes::begin(self, code, words);
        }
        if let Some(code) = asked.plane_turn {
            return planes::turn(self, code, words);
        }
        if let Some(which) = asked.reference {
            return self.reference(which, words);
        }
        if asked.machine || self.modal.machine {
            return self.machine_move(words, asked.rapid);
        }
        if let Some((code, meaning)) = asked.thread {
            return self.thread(code, meaning, words);
        }
        if asked.probe {
            return Err(self.refuse(
                "nc-probe",
                "a probing move ends where it touches, which the program does not say",
            ));
        }
        if asked.cycle_off {
            cycles::end(self);
        }
        if let Some((code, meaning)) = asked.cycle {
            return cycles::hole(self, code, Some(meaning), words);
        }
        let moving =
            words.present & self.axes.mask != 0 || words.vector.is_some() || words.named_axes != 0;
        let spline = self.spline.is_some() && words.present & bit(b'P') != 0;
        let shaped = words.present & SHAPES != 0 || spline;
        if !moving && !shaped {
            return Ok(());
        }
        if self.cycles.in_force() && moving {
            return cycles::hole(self, None, None, words);
        }
        self.plain_motion(words, asked.rapid)
    }

    /// Words of axes that belong to a code of the block lead nowhere: what the code does with them is its own part, and where
    /// it has none, they are done with. Two codes that would have them, or one that has none, are refused.
    #[inline]
    fn own_axis_words(
        &self,
        words: &mut BlockWords,
        asked: &BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        if asked.own_axis_words.is_none() && asked.no_axis_words.is_none() {
            return Ok(());
        }
        let axes = AXIS_LETTERS | self.axes.mask;
        if words.present & axes == 0 && words.vector.is_none() && words.named_axes == 0 {
            return Ok(());
        }
        if let Some(code) = asked.no_axis_words {
            let message = format!(
                "{code} beside words of axes is not run: whether they move anything is not settled"
            );
            return Err(self.refuse("nc-word", message));
        }
        if let (Some(code), Some(other)) = (asked.own_axis_words, asked.also_own) {
            let message = format!(
                "{code} and {other} in one block: both have the words of axes for themselves"
            );
            return Err(self.refuse("nc-word", message));
        }
        let moves = asked.machine || asked.cycle.is_some() || asked.thread.is_some();
        if let (Some(code), true) = (asked.own_axis_words, moves) {
            let message = format!(
                "{code} has the words of axes for itself, and another word of the block moves them"
            );
            return Err(self.refuse("nc-word", message));
        }
        let taken = asked.frame.is_some() || asked.plane.is_some() || asked.reference.is_some();
        if !taken {
            words.present &= !(axes | SHAPES);
            words.vector = None;
            words.named_axes = 0;
        }
        Ok(())
    }

    /// A motion as the modal word says.
    #[inline]
    fn plain_motion(&mut self, words: &mut BlockWords, rapid: bool) -> Result<(), Box<Diagnostic>> {
        let mode = if rapid { MotionMode::Rapid } else { self.modal.motion };
        let kind = match mode {
            MotionMode::Rapid => MotionKind::Rapid,
            MotionMode::Linear | MotionMode::Clockwise | MotionMode::CounterClockwise => {
                MotionKind::Feed
            }
            MotionMode::Spline => return self.spline_block(words),
            MotionMode::None => {
                return Err(self
                    .refuse("nc-motion", "words of axes without a word that says how they move"));
            }
        };
        if kind == MotionKind::Feed
            && self.modal.feed_mode == FeedMeaning::Inverse
            && words.present & bit(b'F') == 0
        {
            return Err(self.refuse(
                "nc-feed",
                "under inverse time every block at feed says its F, and this one does not",
            ));
        }
        if kind == MotionKind::Rapid
            && let Some((joints, said)) = self.retracts(words)
        {
            return self.go_machine(kind, &joints, said);
        }
        self.begins();
        self.relies_on_nothing_left();
        self.relies_on_turning_plane();
        if std::mem::take(&mut self.modal.frame_dropped) {
            self.report.frame_dropped.get_or_insert(self.line);
        }
        if kind == MotionKind::Feed {
            self.relies_on(ModalGroup::Feed);
        } else if words.present & bit(b'F') != 0 {
            self.report.fed_rapids.get_or_insert((self.line, 0)).1 += 1;
        }
        if self.state.compensation != 0 {
            self.relies_on(ModalGroup::Plane);
        }
        let mut target = MotionTarget::default();
        self.put_target(words, &mut target)?;
        if self.modal.vectors {
            self.vector_words(words, &mut target);
        }
        match mode {
            MotionMode::Clockwise | MotionMode::CounterClockwise => {
                self.relies_on(ModalGroup::Plane);
                let path = self.arc_words(mode == MotionMode::Clockwise, words, &mut target)?;
                self.go(kind, &path, &target)?;
            }
            _ => self.go(kind, &Curve::Straight, &target)?,
        }
        cycles::at_point(self)
    }

    /// What was not made use of: refused where it may change a motion, else counted by name.
    #[inline]
    pub(super) fn left_over(&mut self, words: &BlockWords) -> Result<(), Box<Diagnostic>> {
        let left = words.present & !words.used;
        if left == 0 {
            return Ok(());
        }
        self.not_used(left)
    }

    #[cold]
    fn not_used(&mut self, left: u32) -> Result<(), Box<Diagnostic>> {
        for letter in b'A'..=b'Z' {
            if left & bit(letter) == 0 {
                continue;
            }
            let name = char::from(letter);
            if AXIS_LETTERS & bit(letter) != 0 {
                let axes: Vec<&str> =
                    self.machine.axes.iter().map(|axis| axis.name.as_str()).collect();
                let message = format!(
                    "{name} is no axis of {}, which has {}, or says nothing in this block",
                    self.machine.name,
                    axes.join(" ")
                );
                return Err(self.refuse("nc-axis", message));
            }
            if SHAPES & bit(letter) != 0 {
                return Err(self.refuse(
                    "nc-word",
                    format!("{name} says nothing beside these words, and might change the motion"),
                ));
            }
            if letter == b'O' {
                let message = "O within a block: the name of a program stands first, and in a number it is no zero";
                return Err(self.refuse("nc-word", message));
            }
            if self.lexicon.letter(letter) != Some(Meaning::Nothing) {
                self.unknown(&name.to_string());
            }
        }
        Ok(())
    }

    /// The target that the words of axes say, in the coordinates that are in force.
    pub(super) fn target(
        &mut self,
        words: &mut BlockWords,
    ) -> Result<MotionTarget, Box<Diagnostic>> {
        let mut target = MotionTarget::default();
        self.put_target(words, &mut target)?;
        Ok(target)
    }

    /// Puts what the words of axes say into `target`, which is empty: it is large, and not handed about.
    #[inline]
    fn put_target(
        &mut self,
        words: &mut BlockWords,
        target: &mut MotionTarget,
    ) -> Result<(), Box<Diagnostic>> {
        target.vector = words.vector;
        let mut left = words.present & self.axes.mask;
        words.used |= left;
        let incremental = if self.modal.incremental { !words.absolute } else { words.incremental };
        let unit = self.modal.unit;
        let point = if left & incremental != 0 { self.point() } else { Default::default() };
        if left & words.pointless != 0 {
            self.least_increments(words, self.axes.mask)?;
        }
        while left != 0 {
            let letter = left.trailing_zeros() as usize % 26;
            left &= left - 1;
            let place =
                usize::from(self.axes.letters[letter]).min(post_machine::kinematics::MAX_AXES - 1);
            let value = words.values[letter] * self.axes.scale[place];
            let way = incremental & (1 << letter) != 0;
            if way {
                target.ways |= 1 << place;
            }
            if self.axes.rotary & (1 << place) != 0 {
                let value = value.to_radians();
                let to = if way {
                    self.word_at(place) + value
                } else if words.approached & (1 << letter) != 0 {
                    self.approach(place, self.zero[place] + value, words.approaches[letter])
                } else {
                    self.turned(place, self.zero[place] + value)
                };
                target.say(place, to);
            } else if let 23..=25 = letter {
                let row = letter - 23;
                let from = if way { point[row] } else { 0.0 };
                let radius = row == 0 && way && self.modal.ways_are_radii;
                let value = if radius { 2.0 * value } else { value };
                target.point[row] = Some(from + value * unit);
            } else {
                let from = if way { self.at.joints[place] } else { self.zero[place] };
                target.say(place, from + value * unit);
            }
        }
        if words.named_axes != 0 {
            let mut left = words.named_axes;
            while left != 0 {
                let place =
                    (left.trailing_zeros() as usize).min(post_machine::kinematics::MAX_AXES - 1);
                left &= left - 1;
                target.say(place, words.named_values[place]);
            }
        }
        Ok(())
    }
}

/// `12` of `M12`; none for any other word.
pub(super) fn m_number(word: &str) -> Option<u16> {
    let number = word.trim().strip_prefix(['M', 'm'])?;
    number.parse().ok()
}

/// The name of the operation that a remark names: `OPERATION NAME: X`, `OPER: X`, `Operation : X`.
fn operation(remark: &str) -> Option<&str> {
    let (head, name) = remark.split_once([':', '='])?;
    let head = head.trim().to_ascii_uppercase();
    let named = matches!(head.as_str(), "OPERATION" | "OPERATION NAME" | "OPER" | "OP");
    let name = name.trim();
    (named && !name.is_empty()).then_some(name)
}
