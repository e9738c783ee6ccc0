//! What the words of the lexicon ask for.

use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::block::BlockRequest;
use super::block_words::{BlockWords, bit};
use super::spindle_request::SpindleRequest;
use super::state::{ArcPlane, ControlState, FeedMeaning, MotionMode, OrientationMode, ReturnTo};
use crate::g_code::GCode;

impl ControlState {
    /// A code or name whose meaning the lexicon knows; `code` is its G code, if it has one.
    pub(super) fn meant(
        &mut self,
        code: Option<GCode>,
        meaning: Meaning,
        words: &mut BlockWords,
        asked: &mut BlockRequest,
    ) -> Result<(), Box<Diagnostic>> {
        match meaning {
            Meaning::FaceTransformation => {
                self.face_zero(words)?;
                return self.begin_face(1.0);
            }
            Meaning::FaceTransformationOff => return self.end_face(),
            Meaning::CylinderTransformation => {
                return match code {
                    Some(code) => self.wrap_code(code, words),
                    None => self.begin_wrap(None, 1.0, "its word"),
                };
            }
            Meaning::TcpOn => self.drop_frame(true),
            // One word ends all transformations of some controls.
            Meaning::TcpOff => {
                let transforms = self.state.tcp || self.face.is_some() || self.state.wrap.is_some();
                self.drop_frame(transforms);
                self.end_face()?;
                self.end_wrap()?;
            }
            Meaning::Diameter | Meaning::DiameterOfPositions | Meaning::DiameterOff => {
                self.sets_group(meaning);
                return self.count_diameters(meaning);
            }
            Meaning::SurfaceSpeed => {
                if let Some(letter) = code.and_then(|code| self.lexicon.value_letter(code)) {
                    // Without it there is no limit.
                    self.modal.most_speed = words.take(letter);
                }
            }
            _ => {}
        }
        if self.sets_mode(meaning) || asked.takes(code, meaning) {
            return Ok(());
        }
        match meaning {
            Meaning::CompensationOff => self.compensate(0, words)?,
            Meaning::CompensationLeft => self.compensate(-1, words)?,
            Meaning::CompensationRight => self.compensate(1, words)?,
            Meaning::Smoothing => {
                let letter = code.and_then(|code| self.lexicon.value_letter(code));
                let tolerance = letter.and_then(|letter| words.take(letter));
                words.used |= bit(b'P') | bit(b'Q') | bit(b'R');
                let length = |value: f64| value * self.modal.unit;
                let (tolerance, merged) = (tolerance.map(length), words.get(b'Q').map(length));
                self.leaves_corners(code, tolerance, merged);
            }
            Meaning::SmoothingOff => {
                words.used |= bit(b'Q') | bit(b'P');
                self.keeps_corners(code);
            }
            Meaning::ExactStop => self.exact_stop = true,
            Meaning::CycleDrill
            | Meaning::CycleDeep
            | Meaning::CycleBreakChip
            | Meaning::CycleTap
            | Meaning::CycleTapLeft
            | Meaning::CycleReam
            | Meaning::CycleBore
            | Meaning::CycleBoreFine
            | Meaning::CycleBoreBack => {
                if !matches!(meaning, Meaning::CycleTap | Meaning::CycleTapLeft) {
                    self.stand_behind_taps();
                }
                asked.cycle = Some((code, meaning));
            }
            Meaning::CycleOff | Meaning::CycleOffSpindleOff => {
                self.stand_behind_taps();
                asked.cycle_off = true;
                if meaning == Meaning::CycleOffSpindleOff {
                    asked.spindle.get_or_insert(SpindleRequest::Off);
                }
            }
            Meaning::WorkOffsetOff => {
                let (number, _) = code.unwrap_or_default().parts();
                self.use_work_offset(&format!("G{number}"))?;
            }
            Meaning::SpeedLimit => {
                let most = words.take(b'S');
                words.present &= !bit(b'S');
                self.limit_speed(most)?;
            }
            Meaning::Subprogram
            | Meaning::LocalSubprogram
            | Meaning::Macro
            | Meaning::MacroModal => {
                return Err(self.refuse(
                    "nc-flow",
                    "a subprogram begins or ends here in a way that is not run",
                ));
            }
            Meaning::ReturnLevel if code.is_some() => self.return_level(words)?,
            Meaning::ReturnLevel => self.modal.return_to = ReturnTo::Level,
            Meaning::Spline => self.spline_word(code)?,
            Meaning::WorkOffsetBlock => {
                let help = "H0 beside it is what counts from the machine's zero";
                return Err(self.not_followed(code).help(help).boxed());
            }
            _ if is_not_followed(meaning) => return Err(self.not_followed(code)),
            // Letters, remarks and what does nothing.
            _ => {}
        }
        Ok(())
    }

    /// A transformation begins, or ends if one is in force: the work offset may have ended with that.
    fn drop_frame(&mut self, changes: bool) {
        self.modal.frame_dropped |= changes
            && self.state.work_offset.is_some()
            && self.lexicon.transformations_drop_frames();
    }

    /// The level to which cycles return: Z of G71, which moves nothing.
    fn return_level(&mut self, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
        let letter = [b'X', b'Y', b'Z'][self.modal.plane.coordinates()[2]];
        let level = words.take(letter).filter(|_| !self.modal.incremental);
        words.present &= !bit(letter);
        self.modal.return_level =
            Some(level.map(|level| level * self.modal.unit).ok_or_else(|| {
                self.refuse(
                    "nc-cycle",
                    "a level to which cycles return, and its position is not said",
                )
            })?);
        Ok(())
    }

    /// Whether a word sets a mode and nothing else, which it then does.
    fn sets_mode(&mut self, meaning: Meaning) -> bool {
        self.sets_group(meaning);
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
            Meaning::FeedPerMinute | Meaning::FeedPerMinuteAllAxes => {
                self.feed_of_its_own(FeedMeaning::PerMinute)
            }
            Meaning::InverseTime => self.feed_of_its_own(FeedMeaning::Inverse),
            Meaning::FeedPerRevolution => self.feed_of_its_own(FeedMeaning::PerRevolution),
            Meaning::ReturnStart => self.modal.return_to = ReturnTo::Start,
            Meaning::ReturnClearance => self.modal.return_to = ReturnTo::Clearance,
            Meaning::CentreAbsolute => self.modal.centres_absolute = true,
            Meaning::CentreIncremental => self.modal.centres_absolute = false,
            Meaning::SurfaceSpeed => self.cut_at_speed(),
            Meaning::SurfaceSpeedOff => self.keep_speed(),
            Meaning::SurfaceSpeedPerRevolution | Meaning::SurfaceSpeedPerMinute => {
                self.cut_at_speed();
                self.feed_mode(match meaning {
                    Meaning::SurfaceSpeedPerMinute => FeedMeaning::PerMinute,
                    _ => FeedMeaning::PerRevolution,
                });
            }
            Meaning::FixedSpeedPerRevolution | Meaning::FixedSpeedPerMinute => {
                self.keep_speed();
                self.feed_mode(match meaning {
                    Meaning::FixedSpeedPerMinute => FeedMeaning::PerMinute,
                    _ => FeedMeaning::PerRevolution,
                });
            }
            Meaning::RotaryShortest => self.modal.shortest = Some(true),
            Meaning::RotaryAsWritten => self.modal.shortest = Some(false),
            Meaning::MachineCoordinatesOn => self.modal.machine = true,
            Meaning::MachineCoordinatesOff => self.modal.machine = false,
            Meaning::InchLengths => self.modal.unit = 25.4,
            Meaning::MillimetreLengths => self.modal.unit = 1.0,
            // The tool axis under tool centre point control: how it goes between two blocks.
            Meaning::OrientationAxes | Meaning::OrientationMachine => {
                self.modal.orientation = OrientationMode::Axes;
            }
            Meaning::OrientationVector => self.modal.orientation = OrientationMode::Circle,
            Meaning::OrientationPart => self.modal.orientation = OrientationMode::Usual,
            _ => return false,
        }
        true
    }

    /// A kind of the feed that says nothing of the spindle, but may end its cutting speed.
    fn feed_of_its_own(&mut self, mode: FeedMeaning) {
        if self.lexicon.speed_goes_with_feed() {
            self.keep_speed();
        }
        self.feed_mode(mode);
    }

    pub(super) fn feed_mode(&mut self, mode: FeedMeaning) {
        if self.modal.feed_mode != mode {
            self.modal.feed_mode = mode;
            // A number that was a speed is no time.
            self.modal.feed = None;
        }
    }
}

/// Whether a word leads the machine in a way that is not run.
fn is_not_followed(meaning: Meaning) -> bool {
    matches!(
        meaning,
        Meaning::CycleOther
            | Meaning::NotFollowed
            | Meaning::Scale
            | Meaning::Mirror
            | Meaning::Polar
            | Meaning::LengthNegative
            | Meaning::LengthAdded
            | Meaning::LengthAlongTool
            | Meaning::OrientationAngles
            | Meaning::BuilderCoordinates
            | Meaning::ArcThrough
            | Meaning::ArcTangent
            | Meaning::Retract
    )
}

impl BlockRequest {
    /// Whether a word asks for something in its block and nothing else, which is then noted.
    fn takes(&mut self, code: Option<GCode>, meaning: Meaning) -> bool {
        match meaning {
            Meaning::MachineCoordinates => self.machine = true,
            Meaning::RapidBlock => self.rapid = true,
            Meaning::LengthOn => self.length_on = true,
            Meaning::LengthStated => self.length_stated = true,
            Meaning::LengthOff => self.length_off = true,
            Meaning::TcpOn => (self.tcp_on, self.tcp_code) = (true, code),
            Meaning::TcpVectorOn => {
                (self.tcp_on, self.tcp_code) = (true, code);
                self.vectors = true;
            }
            Meaning::TcpOff => self.tcp_off = true,
            Meaning::TiltedPlane => self.plane = Some(code.unwrap_or_default()),
            Meaning::TiltedPlaneTurn => self.plane_turn = Some(code.unwrap_or_default()),
            Meaning::TiltedPlaneOff => self.plane_off = true,
            Meaning::WorkOffset => self.work = Some(code.unwrap_or_default()),
            Meaning::ToolChange => self.change = true,
            Meaning::SpindleClockwise => self.spindle = Some(SpindleRequest::Clockwise),
            Meaning::SpindleCounterClockwise => {
                self.spindle = Some(SpindleRequest::CounterClockwise)
            }
            Meaning::SpindleOff => self.spindle = Some(SpindleRequest::Off),
            Meaning::SpindleOrient => self.spindle = Some(SpindleRequest::Oriented),
            Meaning::CoolantOn => self.coolant = Some(code.map_or(0, |code| code.parts().0)),
            Meaning::CoolantOff => self.coolant_off = true,
            Meaning::Dwell
            | Meaning::DwellSeconds
            | Meaning::DwellMilliseconds
            | Meaning::DwellTurns => self.dwell = true,
            Meaning::Stop | Meaning::OptionalStop | Meaning::End => self.stop = Some(meaning),
            Meaning::Probe => self.probe = true,
            // Bored in, and drawn out by hand.
            Meaning::CycleOther
                if code == Some(GCode::whole(87)) || code == Some(GCode::whole(88)) =>
            {
                self.cycle = Some((code, meaning))
            }
            Meaning::ReferenceReturn => self.reference = Some(1),
            Meaning::OtherReferenceReturn => self.reference = Some(2),
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
            | Meaning::RotationOff => self.frame = Some((code.unwrap_or_default(), meaning)),
            Meaning::SpindleClockwiseCoolant => {
                self.spindle = Some(SpindleRequest::Clockwise);
                self.coolant = Some(8);
            }
            Meaning::SpindleCounterClockwiseCoolant => {
                self.spindle = Some(SpindleRequest::CounterClockwise);
                self.coolant = Some(8);
            }
            Meaning::Thread | Meaning::ThreadAndBack | Meaning::ThreadBack => {
                self.thread = Some((code.unwrap_or_default(), meaning));
            }
            // What was called has led back before: here it ends the program.
            Meaning::SubprogramEnd => self.stop = Some(Meaning::End),
            _ => return false,
        }
        true
    }
}
