//! A block of words: what is modal is settled first, then the machine moves.
//!
//! Whatever order the words of a block are written in, a control takes them in one order: units and modes, feed and
//! speed, tool, spindle and coolant on, compensations, zeros, the motion, and last what ends something.

use post_grammar::nc::NcBlock;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::gathered::{Gathered, bit, which};
use super::go::{Path, Target};
use super::state::{ArcPlane, Control, FeedMode, MotionMode, Orientation};
use super::{cycles, frames, names, planes};
use crate::lexicon::{Language, Sense};
use crate::{MotionKind, Spindle, Told};

/// What the words of one block ask for, besides what is modal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Asked {
    /// In machine coordinates.
    pub machine: bool,
    /// By way of a point to this reference position.
    pub reference: Option<u8>,
    /// A wait.
    pub dwell: bool,
    /// A cycle: ten times its number, and what it does.
    pub cycle: Option<(u16, Meaning)>,
    /// The cycle ends.
    pub cycle_off: bool,
    /// A tilted plane, its turn, and its end: ten times the number.
    pub plane: Option<u16>,
    /// The axes turn to it.
    pub plane_turn: Option<u16>,
    /// It ends.
    pub plane_off: bool,
    /// A shift or a turn of the coordinates: ten times the number of its word, and its meaning.
    pub frame: Option<(u16, Meaning)>,
    /// A work offset: ten times its number.
    pub work: Option<u16>,
    /// Length compensation on: ten times the number of its word, or 0 of a word without one.
    pub length_on: Option<u16>,
    /// Length compensation by the length that the block names.
    pub length_stated: bool,
    /// And off.
    pub length_off: bool,
    /// Tool centre point control on: ten times the number of its word, 0 of a word without G.
    pub tcp_on: Option<u16>,
    /// With vectors.
    pub vectors: bool,
    /// And off.
    pub tcp_off: bool,
    /// The tool is changed.
    pub change: bool,
    /// Spindle from here on.
    pub spindle: Option<Turning>,
    /// Coolant from here on: the number behind M.
    pub coolant: Option<u16>,
    /// No coolant.
    pub coolant_off: bool,
    /// The program stops.
    pub stop: Option<Meaning>,
    /// A thread or tap without a cycle: ten times the number of its word, and its meaning.
    pub thread: Option<(u16, Meaning)>,
    /// A probing move.
    pub probe: bool,
    /// This block at rapid.
    pub rapid: bool,
}

/// What the spindle does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Turning {
    Clockwise,
    CounterClockwise,
    Off,
    Oriented,
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
    control: &mut Control,
    block: &NcBlock,
    words: &mut Gathered,
) -> Result<(), Box<Diagnostic>> {
    control.gather(block, words)?;
    for remark in &block.remarks {
        control.remark(remark);
    }
    let mut asked = Asked::default();
    if words.more {
        names::take(control, block, words, &mut asked)?;
    }
    for index in 0..words.g.list().len() {
        control.g_code(words.g.list()[index], words, &mut asked)?;
    }
    for index in 0..words.m.list().len() {
        control.m_code(words.m.list()[index], &mut asked)?;
    }
    if words.present == 0 && words.g.list().is_empty() && words.m.list().is_empty() && !words.more {
        return Ok(());
    }
    control.obey(words, &asked)?;
    control.left_over(words)
}

impl Control {
    /// A remark; one that names an operation says which.
    pub(super) fn remark(&mut self, remark: &str) {
        let text = remark.trim();
        if text.is_empty() {
            return;
        }
        match operation(text) {
            Some(name) => self.begin_operation(name),
            None => self.tell(Told::Remark(text.to_owned())),
        }
    }

    /// An operation of this name begins.
    pub(super) fn begin_operation(&mut self, name: &str) {
        self.state.operation = Some(name.to_owned());
        self.state_changed();
        self.tell(Told::Operation(name.to_owned()));
    }

    /// Takes a G code: what is modal holds from here on, the rest is asked for.
    #[inline]
    fn g_code(
        &mut self,
        code: u16,
        words: &mut Gathered,
        asked: &mut Asked,
    ) -> Result<(), Box<Diagnostic>> {
        match self.lexicon.g(code) {
            Sense::Means(Meaning::Rapid) => self.motion(MotionMode::Rapid),
            Sense::Means(Meaning::Linear) => self.motion(MotionMode::Linear),
            Sense::Means(Meaning::ArcClockwise) => self.motion(MotionMode::Clockwise),
            Sense::Means(Meaning::ArcCounterClockwise) => self.motion(MotionMode::CounterClockwise),
            _ => {
                let sense = self.lexicon.g_beside(code, |letter| words.get(letter));
                return self.other_g(code, sense, words, asked);
            }
        }
        Ok(())
    }

    #[inline]
    fn motion(&mut self, mode: MotionMode) {
        self.modal.motion = mode;
        if self.cycles.in_force() {
            cycles::end(self);
        }
    }

    /// A G code that is no motion.
    fn other_g(
        &mut self,
        code: u16,
        sense: Sense,
        words: &mut Gathered,
        asked: &mut Asked,
    ) -> Result<(), Box<Diagnostic>> {
        let name = f64::from(code) / 10.0;
        match sense {
            Sense::Means(meaning) => self.meant(code, meaning, words, asked),
            Sense::Refused => Err(self.not_followed(code)),
            Sense::Unknown => {
                let help = "a G code may change where the machine goes, so none is passed over";
                let message = format!("G{name} is no word that is known of this control");
                let finding = Diagnostic::error("nc-word", message).help(help);
                Err(self.placed(finding).boxed())
            }
        }
    }

    /// A word whose meaning is known and that is not run; `code` is ten times the number behind G, 0 of other words.
    #[cold]
    fn not_followed(&self, code: u16) -> Box<Diagnostic> {
        let word = if code == 0 {
            "a word of this block".to_owned()
        } else {
            format!("G{}", f64::from(code) / 10.0)
        };
        let message = format!("{word} is not run: what the machine does then is not followed");
        self.refuse("nc-word", message)
    }

    /// A code or name whose meaning the lexicon knows; `code` is ten times the number behind G, or 0.
    pub(super) fn meant(
        &mut self,
        code: u16,
        meaning: Meaning,
        words: &mut Gathered,
        asked: &mut Asked,
    ) -> Result<(), Box<Diagnostic>> {
        match meaning {
            Meaning::Rapid => self.motion(MotionMode::Rapid),
            Meaning::Linear => self.motion(MotionMode::Linear),
            Meaning::ArcClockwise => self.motion(MotionMode::Clockwise),
            Meaning::ArcCounterClockwise => self.motion(MotionMode::CounterClockwise),
            Meaning::Millimetre => self.modal.unit = 1.0,
            Meaning::Inch => self.modal.unit = 25.4,
            Meaning::Absolute => self.modal.incremental = false,
            Meaning::Incremental => self.modal.incremental = true,
            Meaning::PlaneXy => self.modal.plane = ArcPlane::Xy,
            Meaning::PlaneZx => self.modal.plane = ArcPlane::Zx,
            Meaning::PlaneYz => self.modal.plane = ArcPlane::Yz,
            Meaning::FeedPerMinute => self.feed_mode(FeedMode::PerMinute),
            Meaning::InverseTime => self.feed_mode(FeedMode::Inverse),
            Meaning::FeedPerRevolution => self.feed_mode(FeedMode::PerRevolution),
            Meaning::MachineCoordinates => asked.machine = true,
            Meaning::RapidBlock => asked.rapid = true,
            Meaning::LengthOn => asked.length_on = Some(code),
            Meaning::LengthStated => asked.length_stated = true,
            Meaning::LengthOff => asked.length_off = true,
            Meaning::CompensationOff => self.compensate(0, words)?,
            Meaning::CompensationLeft => self.compensate(-1, words)?,
            Meaning::CompensationRight => self.compensate(1, words)?,
            Meaning::TcpOn => asked.tcp_on = Some(code),
            Meaning::TcpVectorOn => {
                asked.tcp_on = Some(code);
                asked.vectors = true;
            }
            Meaning::TcpOff => asked.tcp_off = true,
            Meaning::TiltedPlane => asked.plane = Some(code),
            Meaning::TiltedPlaneTurn => asked.plane_turn = Some(code),
            Meaning::TiltedPlaneOff => asked.plane_off = true,
            Meaning::WorkOffset => asked.work = Some(code),
            Meaning::Smoothing => {
                let letter = self.lexicon.tolerance_letter(code);
                let tolerance = letter.and_then(|letter| words.take(letter));
                words.used |= bit(b'P') | bit(b'Q') | bit(b'R');
                self.smooth(tolerance.map(|tolerance| tolerance * self.modal.unit));
            }
            Meaning::SmoothingOff => {
                words.used |= bit(b'Q') | bit(b'P');
                self.smooth(None);
            }
            Meaning::ToolChange => asked.change = true,
            Meaning::SpindleClockwise => asked.spindle = Some(Turning::Clockwise),
            Meaning::SpindleCounterClockwise => asked.spindle = Some(Turning::CounterClockwise),
            Meaning::SpindleOff => asked.spindle = Some(Turning::Off),
            Meaning::SpindleOrient => asked.spindle = Some(Turning::Oriented),
            Meaning::CoolantOn => asked.coolant = Some(code / 10),
            Meaning::CoolantOff => asked.coolant_off = true,
            Meaning::Dwell
            | Meaning::DwellSeconds
            | Meaning::DwellMilliseconds
            | Meaning::DwellTurns => asked.dwell = true,
            Meaning::Stop | Meaning::OptionalStop | Meaning::End => asked.stop = Some(meaning),
            Meaning::Probe => asked.probe = true,
            Meaning::CycleDrill
            | Meaning::CycleDeep
            | Meaning::CycleBreakChip
            | Meaning::CycleTap
            | Meaning::CycleTapLeft
            | Meaning::CycleReam
            | Meaning::CycleBore
            | Meaning::CycleBoreFine
            | Meaning::CycleBoreBack => asked.cycle = Some((code, meaning)),
            Meaning::CycleOff => asked.cycle_off = true,
            Meaning::ReturnStart => self.modal.return_start = true,
            Meaning::ReturnClearance => self.modal.return_start = false,
            Meaning::ReferenceReturn => asked.reference = Some(1),
            Meaning::OtherReferenceReturn => asked.reference = Some(2),
            Meaning::LocalOffset
            | Meaning::LocalOffsetAdded
            | Meaning::LocalOffsetOff
            | Meaning::SetPosition
            | Meaning::SetPositionOff
            | Meaning::SetPositionAgain
            | Meaning::TableData
            | Meaning::TableDataOff
            | Meaning::Rotation
            | Meaning::RotationAdded
            | Meaning::RotationOff => asked.frame = Some((code, meaning)),
            Meaning::WorkOffsetOff => self.use_work_offset(&format!("G{}", code / 10))?,
            Meaning::WorkOffsetBlock => asked.machine = true,
            Meaning::CentreAbsolute => self.modal.centres_absolute = true,
            Meaning::CentreIncremental => self.modal.centres_absolute = false,
            Meaning::SurfaceSpeed => self.modal.surface_speed = true,
            Meaning::SurfaceSpeedOff => self.modal.surface_speed = false,
            Meaning::SpeedLimit => {
                self.modal.most_speed = words.take(b'S');
                words.present &= !bit(b'S');
            }
            Meaning::RotaryShortest => self.modal.shortest = Some(true),
            Meaning::RotaryAsWritten => self.modal.shortest = Some(false),
            Meaning::InchLengths => self.modal.unit = 25.4,
            Meaning::MillimetreLengths => self.modal.unit = 1.0,
            Meaning::SpindleClockwiseCoolant => {
                asked.spindle = Some(Turning::Clockwise);
                asked.coolant = Some(8);
            }
            Meaning::SpindleCounterClockwiseCoolant => {
                asked.spindle = Some(Turning::CounterClockwise);
                asked.coolant = Some(8);
            }
            // The tool axis under tool centre point control: how it goes between two blocks.
            Meaning::OrientationAxes | Meaning::OrientationMachine => {
                self.modal.orientation = Orientation::Axes;
            }
            Meaning::OrientationVector => self.modal.orientation = Orientation::Circle,
            Meaning::OrientationPart => self.modal.orientation = Orientation::Usual,
            Meaning::Thread | Meaning::ThreadAndBack | Meaning::ThreadBack => {
                asked.thread = Some((code, meaning));
            }
            Meaning::Subprogram
            | Meaning::LocalSubprogram
            | Meaning::SubprogramEnd
            | Meaning::Macro
            | Meaning::MacroModal => {
                return Err(self.refuse(
                    "nc-flow",
                    "a subprogram begins or ends here in a way that is not run",
                ));
            }
            Meaning::Spline
            | Meaning::Scale
            | Meaning::Mirror
            | Meaning::Polar
            | Meaning::FaceTransformation
            | Meaning::CylinderTransformation
            | Meaning::Diameter
            | Meaning::LengthNegative
            | Meaning::LengthAdded
            | Meaning::LengthAlongTool
            | Meaning::OrientationAngles
            | Meaning::CycleOther
            | Meaning::BuilderCoordinates
            | Meaning::ArcThrough
            | Meaning::ArcTangent
            | Meaning::Retract => return Err(self.not_followed(code)),
            // Letters, remarks and what does nothing.
            _ => {}
        }
        Ok(())
    }

    fn feed_mode(&mut self, mode: FeedMode) {
        if self.modal.feed_mode != mode {
            self.modal.feed_mode = mode;
            // A number that was a speed is no time.
            self.modal.feed = None;
        }
    }

    pub(super) fn compensate(
        &mut self,
        side: i8,
        words: &mut Gathered,
    ) -> Result<(), Box<Diagnostic>> {
        let register = if side == 0 || self.lexicon.tools_have_edges() {
            None
        } else {
            words
                .take_number(b'D', self)?
                .or(self.state.radius_register)
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
        self.tell(Told::Compensation { side, register });
        Ok(())
    }

    /// The control may leave the path by `tolerance` mm; none: it keeps it, or by how much is not said.
    pub(super) fn smooth(&mut self, tolerance: Option<f64>) {
        if self.state.smoothing != tolerance {
            self.state.smoothing = tolerance;
            self.state_changed();
        }
    }

    /// Takes an M code.
    pub(super) fn m_code(&mut self, code: u16, asked: &mut Asked) -> Result<(), Box<Diagnostic>> {
        if matches!(code, 67 | 68) && self.lexicon.language() == Language::Rs274 {
            let message = format!(
                "M{code} is not run: its output may be wired to what switches the kinematics"
            );
            let help = "a remap by which the machine file switches (M428, M429) is followed";
            let finding = Diagnostic::error("nc-word", message).help(help);
            return Err(self.placed(finding).boxed());
        }
        match self.lexicon.m(code) {
            Sense::Means(meaning) => {
                // `meant` takes ten times the number, as of G.
                let code = if meaning == Meaning::CoolantOn {
                    code * 10
                } else {
                    0
                };
                return self.meant(code, meaning, &mut Gathered::default(), asked);
            }
            Sense::Refused => Err(self.refuse(
                "nc-word",
                format!("M{code} is not run: it may change what the words behind it mean"),
            )),
            _ => {
                if !self.swap_head(code)? && !self.clamps(code) {
                    self.unknown(&format!("M{code}"));
                }
                Ok(())
            }
        }
    }

    /// The word clamps an axis of the machine, or lets it go.
    fn clamps(&self, code: u16) -> bool {
        let own = |word: &str| m_number(word) == Some(code);
        let clamps = self
            .machine
            .axes
            .iter()
            .filter_map(|axis| axis.clamp.as_ref());
        clamps
            .into_iter()
            .any(|clamp| own(&clamp.on) || own(&clamp.off))
    }

    /// The word swaps a head in.
    fn swap_head(&mut self, code: u16) -> Result<bool, Box<Diagnostic>> {
        let mut heads = self.heads.iter();
        let head = heads.find(|head| head.word.as_deref().and_then(m_number) == Some(code));
        let Some(head) = head else {
            return Ok(false);
        };
        let (name, machine) = (head.name.clone(), std::sync::Arc::clone(&head.machine));
        self.head_changed(machine)?;
        self.tell(Told::Head(name));
        Ok(true)
    }

    /// Does what the block asks for, in the order in which controls do it.
    fn obey(&mut self, words: &mut Gathered, asked: &Asked) -> Result<(), Box<Diagnostic>> {
        if asked.dwell {
            self.dwell(words)?;
        }
        if let Some(feed) = words.take(b'F') {
            let unit = if self.modal.feed_mode == FeedMode::Inverse {
                1.0
            } else {
                self.modal.unit
            };
            self.modal.feed = Some(feed * unit);
        }
        if words.present & (bit(b'S') | bit(b'T')) != 0 || asked.change || asked.spindle.is_some() {
            self.tool_and_spindle(words, asked)?;
        }
        if let Some(code) = asked.coolant {
            self.coolant(code);
        }
        if asked.plane_off {
            planes::end(self)?;
        }
        self.compensations(words, asked)?;
        if let Some(code) = asked.work {
            self.work_offset(code, words)?;
        }
        self.move_as_asked(words, asked)?;
        if asked.spindle == Some(Turning::Off) {
            self.turn_spindle(Turning::Off);
        }
        if asked.coolant_off {
            self.coolant_off();
        }
        match asked.stop {
            Some(Meaning::Stop) => self.tell(Told::Stop),
            Some(Meaning::OptionalStop) => self.tell(Told::OptionalStop),
            Some(_) => self.end(),
            None => {}
        }
        Ok(())
    }

    /// The program ends.
    pub(super) fn end(&mut self) {
        self.tell(Told::End);
        self.ended = true;
    }

    fn tool_and_spindle(
        &mut self,
        words: &mut Gathered,
        asked: &Asked,
    ) -> Result<(), Box<Diagnostic>> {
        if let Some(speed) = words.take(b'S') {
            self.modal.speed = speed;
            self.speed_changed();
        }
        if let Some(number) = words.take(b'T').filter(|number| !number.is_nan()) {
            let number = which(b'T', number, self)?;
            self.tools.ready = Some(number);
            self.tools.ready_name = None;
            if !self.lexicon.changes_by_word() {
                self.change_tool(Some(number), None)?;
            } else if !asked.change {
                self.tell(Told::Preselect(number));
            }
        }
        if asked.change {
            let (number, name) = (self.tools.ready, self.tools.ready_name.clone());
            self.change_tool(number, name)?;
        }
        match asked.spindle {
            // It stops when the motion has come to its end; on RS-274/NGC before.
            Some(Turning::Off) if self.lexicon.language() != Language::Rs274 => {}
            Some(turning) => self.turn_spindle(turning),
            None => {}
        }
        Ok(())
    }

    /// S changed while the spindle turns.
    pub(super) fn speed_changed(&mut self) {
        match self.state.spindle {
            Spindle::Clockwise(_) => self.turn_spindle(Turning::Clockwise),
            Spindle::CounterClockwise(_) => self.turn_spindle(Turning::CounterClockwise),
            Spindle::Surface { clockwise, .. } => self.turn_spindle(if clockwise {
                Turning::Clockwise
            } else {
                Turning::CounterClockwise
            }),
            Spindle::Off | Spindle::Oriented => {}
        }
    }

    /// What the spindle does from here on.
    pub(super) fn turn_spindle(&mut self, turning: Turning) {
        let spindle = match turning {
            Turning::Clockwise | Turning::CounterClockwise if self.modal.surface_speed => {
                Spindle::Surface {
                    speed: self.modal.speed,
                    most: self.modal.most_speed,
                    clockwise: turning == Turning::Clockwise,
                }
            }
            Turning::Clockwise => Spindle::Clockwise(self.modal.speed),
            Turning::CounterClockwise => Spindle::CounterClockwise(self.modal.speed),
            Turning::Off => Spindle::Off,
            Turning::Oriented => Spindle::Oriented,
        };
        if self.state.spindle != spindle {
            self.state.spindle = spindle;
            self.state_changed();
            self.tell(Told::Spindle(spindle));
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

    fn flow_of_coolant(&mut self, coolants: crate::Coolants) {
        if self.state.coolants != coolants {
            self.state.coolants = coolants;
            self.state_changed();
            self.tell(Told::Coolant(coolants));
        }
    }

    /// G4: seconds, turns of the spindle where the control counts them.
    fn dwell(&mut self, words: &mut Gathered) -> Result<(), Box<Diagnostic>> {
        let told = |time, revolutions| Told::Dwell { time, revolutions };
        let told = match self.lexicon.language() {
            Language::Names => match (words.take(b'F'), words.take(b'S')) {
                (Some(time), _) => told(time, false),
                (None, Some(turns)) => told(turns, true),
                (None, None) => return Err(self.refuse("nc-dwell", "G4 says neither F nor S")),
            },
            _ => self.letters_dwell(words)?,
        };
        // They were times, and are nothing else in this block.
        words.present &= !(bit(b'F') | bit(b'S') | bit(b'X') | bit(b'U'));
        self.tell(told);
        Ok(())
    }

    /// The time of a wait by its letter: as the dialect says of it, else X, U and F in seconds.
    fn letters_dwell(&mut self, words: &mut Gathered) -> Result<Told, Box<Diagnostic>> {
        const G4: u16 = 40;
        for letter in [b'P', b'X', b'U', b'F', b'S'] {
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
            return Ok(Told::Dwell { time, revolutions });
        }
        Err(self.refuse(
            "nc-dwell",
            "the wait does not say how long in a way that is known",
        ))
    }

    /// Length, tool centre point control and edges.
    fn compensations(
        &mut self,
        words: &mut Gathered,
        asked: &Asked,
    ) -> Result<(), Box<Diagnostic>> {
        if self.lexicon.tools_have_edges() {
            if let Some(edge) = words.take_number(b'D', self)? {
                self.tools.by_tool = true;
                self.tools.length_on = edge != 0;
                self.state.length_register = (edge != 0).then_some(edge);
                self.length_changed()?;
            }
        } else if let Some(register) = words.present_number(b'D', self)? {
            words.used |= bit(b'D');
            self.state.radius_register = Some(register);
            self.state_changed();
        }
        if asked.tcp_off && self.state.tcp {
            self.set_tcp(false, 0, false);
        }
        if asked.length_off {
            words.used |= bit(b'H');
            self.tools.length_on = false;
            self.state.length_register = None;
            if self.state.tcp && self.modal.tcp_by_length {
                self.set_tcp(false, 0, false);
            }
            self.length_changed()?;
        }
        if asked.length_stated {
            return self.stated_length(words);
        }
        let on = asked.length_on.or(asked.tcp_on.filter(|code| *code != 0));
        if on.is_some() {
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
        if let Some(code) = asked.tcp_on {
            self.set_tcp(true, code, asked.vectors);
        }
        Ok(())
    }

    /// Length compensation by Z of the block: G43.1.
    fn stated_length(&mut self, words: &mut Gathered) -> Result<(), Box<Diagnostic>> {
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
    fn length_by(&mut self, words: &mut Gathered) -> Result<(), Box<Diagnostic>> {
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
        self.length_changed()
    }

    /// Tool centre point control on or off; `code` is ten times the number of its G word, 0 of any other.
    pub(super) fn set_tcp(&mut self, on: bool, code: u16, vectors: bool) {
        self.modal.tcp_by_length = on && code != 0;
        // Some vocabularies have one meaning for both types: the second names vectors, G43.5.
        self.modal.vectors = on && (vectors || code % 10 == 5);
        if self.state.tcp != on {
            self.state.tcp = on;
            self.state_changed();
        }
    }

    /// A work offset by its G word: `G54`, `G54.1 P3`, `G15 H1`.
    fn work_offset(&mut self, code: u16, words: &mut Gathered) -> Result<(), Box<Diagnostic>> {
        let number = f64::from(code) / 10.0;
        let mut name = format!("G{number}");
        for letter in [b'P', b'H'] {
            let of_it = letter == b'P'
                || self.lexicon.g(code) == Sense::Means(Meaning::WorkOffset) && code < 500;
            if of_it && let Some(which) = words.take_number(letter, self)? {
                name = format!("{name} {}{which}", char::from(letter));
            }
        }
        self.use_work_offset(&name)
    }

    /// The work offset of this name from here on.
    pub(super) fn use_work_offset(&mut self, name: &str) -> Result<(), Box<Diagnostic>> {
        if self.state.work_offset.as_deref() == Some(name) {
            return Ok(());
        }
        let place = self.offsets.work.iter().position(|work| work.name == name);
        if place.is_none() && self.state.work_offset.is_some() {
            let message = format!(
                "the program uses several work offsets, and nothing is said of {name}: it is taken to be the machine file's mount, as all are"
            );
            self.note(
                Diagnostic::warning("nc-work-offset", message)
                    .help("state them by --offsets, in tables [work.G54] and so on"),
            );
        }
        self.state.work_offset = Some(name.to_owned());
        self.state_changed();
        self.tell(Told::WorkOffset(name.to_owned()));
        if self.work != place {
            self.work = place;
            return self.solver_changed();
        }
        Ok(())
    }

    /// The motion, or what takes the words of axes instead.
    fn move_as_asked(
        &mut self,
        words: &mut Gathered,
        asked: &Asked,
    ) -> Result<(), Box<Diagnostic>> {
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
        if asked.machine {
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
        let shaped = words.present & SHAPES != 0;
        if !moving && !shaped {
            return Ok(());
        }
        if self.cycles.in_force() && moving {
            return cycles::hole(self, 0, None, words);
        }
        self.plain_motion(words, asked.rapid)
    }

    /// A motion as the modal word says.
    #[inline]
    fn plain_motion(&mut self, words: &mut Gathered, rapid: bool) -> Result<(), Box<Diagnostic>> {
        let mode = if rapid {
            MotionMode::Rapid
        } else {
            self.modal.motion
        };
        let kind = match mode {
            MotionMode::Rapid => MotionKind::Rapid,
            MotionMode::Linear | MotionMode::Clockwise | MotionMode::CounterClockwise => {
                MotionKind::Feed
            }
            MotionMode::None => {
                return Err(self.refuse(
                    "nc-motion",
                    "words of axes without a word that says how they move",
                ));
            }
        };
        let mut target = self.target(words)?;
        if self.modal.vectors {
            self.vector_words(words, &mut target);
        }
        match mode {
            MotionMode::Clockwise | MotionMode::CounterClockwise => {
                let path = self.arc_words(mode == MotionMode::Clockwise, words, &mut target)?;
                self.go(kind, &path, &target)?;
            }
            _ => self.go(kind, &Path::Straight, &target)?,
        }
        cycles::at_point(self)
    }

    /// What was not made use of: refused where it may change a motion, else counted by name.
    #[inline]
    pub(super) fn left_over(&mut self, words: &Gathered) -> Result<(), Box<Diagnostic>> {
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
                let axes: Vec<&str> = self
                    .machine
                    .axes
                    .iter()
                    .map(|axis| axis.name.as_str())
                    .collect();
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
            if self.lexicon.letter(letter) != Some(Meaning::Nothing) {
                self.unknown(&name.to_string());
            }
        }
        Ok(())
    }

    /// The target that the words of axes say, in the coordinates that are in force.
    #[inline]
    pub(super) fn target(&mut self, words: &mut Gathered) -> Result<Target, Box<Diagnostic>> {
        let mut target = Target {
            vector: words.vector,
            ..Target::default()
        };
        let mut left = words.present & self.axes.mask;
        words.used |= left;
        let incremental = if self.modal.incremental {
            !words.absolute
        } else {
            words.incremental
        };
        let unit = self.modal.unit;
        let point = if left & incremental != 0 {
            self.point()
        } else {
            Default::default()
        };
        if left & words.pointless != 0 {
            self.least_increments(words)?;
        }
        while left != 0 {
            let letter = left.trailing_zeros() as usize % 26;
            left &= left - 1;
            let place = usize::from(self.axes.letters[letter]) % post_machine::kinematics::MAX_AXES;
            let value = words.values[letter];
            let way = incremental & (1 << letter) != 0;
            if self.axes.rotary & (1 << place) != 0 {
                let value = value.to_radians();
                let to = if way {
                    self.at.joints[place] + value
                } else if words.approached & (1 << letter) != 0 {
                    self.approach(place, self.zero[place] + value, words.approaches[letter])
                } else {
                    self.turned(place, self.zero[place] + value)
                };
                target.say(place, to);
            } else if let 23..=25 = letter {
                let row = letter - 23;
                let from = if way { point[row] } else { 0.0 };
                target.point[row] = Some(from + value * unit);
            } else {
                let from = if way {
                    self.at.joints[place]
                } else {
                    self.zero[place]
                };
                target.say(place, from + value * unit);
            }
        }
        if words.named_axes != 0 {
            let mut left = words.named_axes;
            while left != 0 {
                let place = left.trailing_zeros() as usize % post_machine::kinematics::MAX_AXES;
                left &= left - 1;
                target.say(place, words.named_values[place]);
            }
        }
        Ok(target)
    }
}

/// `12` of `M12`; none for any other word.
fn m_number(word: &str) -> Option<u16> {
    let number = word.trim().strip_prefix(['M', 'm'])?;
    number.parse().ok()
}

/// The name of the operation that a remark names: `OPERATION NAME: X`, `OPER: X`, `Operation : X`.
fn operation(remark: &str) -> Option<&str> {
    let (head, name) = remark.split_once([':', '='])?;
    let head = head.trim().to_ascii_uppercase();
    let named = matches!(
        head.as_str(),
        "OPERATION" | "OPERATION NAME" | "OPER" | "OP"
    );
    let name = name.trim();
    (named && !name.is_empty()).then_some(name)
}
