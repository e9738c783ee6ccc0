//! What the dialect declares, and the words of the control with what they mean.

use post_plugin::{Capabilities, Meaning, VocabularyWord};

use crate::Heidenhain;

impl Heidenhain {
    /// M128 moves nothing; length and radius are those of the tool table. Arcs and cycles lie across Z.
    pub(crate) fn declared(&self) -> Capabilities {
        use Capabilities as C;
        let some = |yes: bool, set: Capabilities| if yes { set } else { C::NONE };
        let arcs =
            C::ARC_XY.and(C::HELIX).and(C::HELIX_BY_TURN).and(C::ARC_RADIUS).and(C::CYCLE_IN_PLANE);
        let drills = C::CYCLE_DRILL.and(C::CYCLE_DEEP).and(C::CYCLE_BREAK_CHIP);
        let others = C::CYCLE_REAM.and(C::CYCLE_BORE).and(C::CYCLE_TAP).and(C::CYCLE_TAP_LEFT);
        let cycles = self.linear.is_some();
        let commands = C::SMOOTHING.and(C::OPERATION).and(C::WORK_OFFSET).and(C::SUBPROGRAM);
        C::TCP_STILL
            | C::TOOL_TABLE
            | C::LENGTH_ALONG_DEPTH
            | C::INSTEAD
            | commands
            | some(self.takes_runs(), C::CUTS)
            | some(self.rotary, C::PLANE)
            | some(self.linear.is_some(), arcs)
            | some(cycles, drills | others)
            | some(cycles && self.cycles.fine(), C::CYCLE_BORE_FINE)
            | some(self.tcp || !self.rotary, C::SURFACE)
            | some(self.tcp && self.vectors, C::TOOL_VECTOR)
    }
}

/// Words of the control; `tcp_on` and `tcp_off` are lines of the options, `coolant` the words that they name for
/// coolants, what ends one of them first.
pub(crate) fn vocabulary<'a>(
    tcp_on: &'a str,
    tcp_off: &'a str,
    coolant: impl IntoIterator<Item = (&'a str, Meaning)>,
) -> Vec<VocabularyWord> {
    let first = |text: &str| text.lines().next().unwrap_or_default().trim().to_owned();
    let mut words: Vec<VocabularyWord> =
        WORDS.iter().map(|(text, meaning)| VocabularyWord::new(text, *meaning)).collect();
    let own = [(tcp_on, M::TcpOn), (tcp_off, M::TcpOff)];
    for (text, meaning) in own.into_iter().chain(coolant) {
        let word = first(text);
        if !word.is_empty() && !words.iter().any(|known| known.word == word) {
            words.push(VocabularyWord { word: word.into(), meaning });
        }
    }
    words
}

use Meaning as M;

/// Cycles stand with their number alone: `CYCL DEF 32` is 32.0, 32.1 and 32.2. Words of a cycle or a plane (Q200, SPA,
/// MB) belong to the word that opens their block.
const WORDS: &[(&str, Meaning)] = &[
    (";", M::Remark),
    ("*", M::Remark),
    ("BEGIN PGM", M::Nothing),
    ("END PGM", M::Nothing),
    ("BLK FORM", M::Nothing),
    ("MM", M::Millimetre),
    ("INCH", M::Inch),
    ("L", M::Linear),
    ("LN", M::Linear),
    ("FMAX", M::RapidBlock),
    ("CC", M::Centre),
    ("C", M::Arc),
    ("CR", M::Arc),
    ("CP", M::Arc),
    ("CT", M::ArcTangent),
    ("CTP", M::ArcTangent),
    ("DR-", M::ArcClockwise),
    ("DR+", M::ArcCounterClockwise),
    ("R", M::Radius),
    ("R0", M::CompensationOff),
    ("RL", M::CompensationLeft),
    ("RR", M::CompensationRight),
    ("NX", M::NormalX),
    ("NY", M::NormalY),
    ("NZ", M::NormalZ),
    ("TX", M::ToolAxisX),
    ("TY", M::ToolAxisY),
    ("TZ", M::ToolAxisZ),
    ("M91", M::MachineCoordinates),
    ("M92", M::BuilderCoordinates),
    ("M140", M::Retract),
    ("F", M::Feed),
    ("FU", M::FeedPerRevolution),
    ("M136", M::FeedPerRevolution),
    ("M137", M::FeedPerMinute),
    ("M128", M::TcpOn),
    ("FUNCTION TCPM", M::TcpOn),
    ("M129", M::TcpOff),
    ("FUNCTION RESET TCPM", M::TcpOff),
    ("M126", M::RotaryShortest),
    ("M127", M::RotaryAsWritten),
    ("M116", M::RotaryFeedLength),
    ("M117", M::RotaryFeedAngle),
    ("M94", M::Nothing),
    ("PLANE SPATIAL", M::TiltedPlane),
    ("PLANE PROJECTED", M::TiltedPlane),
    ("PLANE EULER", M::TiltedPlane),
    ("PLANE VECTOR", M::TiltedPlane),
    ("PLANE POINTS", M::TiltedPlane),
    ("PLANE RELATIV", M::TiltedPlane),
    ("PLANE AXIAL", M::TiltedPlane),
    ("CYCL DEF 19", M::TiltedPlane),
    ("PLANE RESET", M::TiltedPlaneOff),
    ("MOVE", M::TiltedPlaneTurn),
    ("TURN", M::TiltedPlaneTurn),
    ("CYCL DEF 247", M::WorkOffset),
    ("CYCL DEF 7", M::LocalOffset),
    ("TRANS DATUM AXIS", M::LocalOffset),
    ("TRANS DATUM RESET", M::LocalOffsetOff),
    ("CYCL DEF 8", M::Mirror),
    ("CYCL DEF 10", M::Rotation),
    ("CYCL DEF 11", M::Scale),
    ("CYCL DEF 26", M::Scale),
    ("CYCL DEF 32", M::Smoothing),
    ("TOOL CALL", M::ToolChange),
    ("TOOL DEF", M::Preselect),
    ("S", M::SpindleSpeed),
    ("M3", M::SpindleClockwise),
    ("M4", M::SpindleCounterClockwise),
    ("M5", M::SpindleOff),
    ("M13", M::SpindleClockwiseCoolant),
    ("M14", M::SpindleCounterClockwiseCoolant),
    ("M8", M::CoolantOn),
    ("M9", M::CoolantOff),
    ("CYCL DEF 9", M::Dwell),
    ("FUNCTION DWELL", M::Dwell),
    ("STOP", M::Stop),
    ("M0", M::Stop),
    ("M1", M::OptionalStop),
    ("M2", M::End),
    ("M30", M::End),
    ("CALL LBL", M::Subprogram),
    ("CALL PGM", M::Subprogram),
    ("CYCL DEF 200", M::CycleDrill),
    ("CYCL DEF 240", M::CycleDrill),
    ("CYCL DEF 201", M::CycleReam),
    ("CYCL DEF 202", M::CycleBoreFine),
    ("CYCL DEF 203", M::CycleBreakChip),
    ("CYCL DEF 204", M::CycleBoreBack),
    ("CYCL DEF 205", M::CycleDeep),
    ("CYCL DEF 206", M::CycleTap),
    ("CYCL DEF 207", M::CycleTap),
    ("CYCL DEF 209", M::CycleTap),
    ("CYCL DEF 208", M::CycleOther),
    ("CYCL DEF 241", M::CycleOther),
    ("CYCL CALL", M::CycleCall),
    ("M99", M::CycleCall),
    ("M89", M::CycleCallModal),
];
