//! What the dialect declares, and the words of the control with what they mean.

use post_plugin::{Capabilities, Meaning, VocabularyWord};

use crate::Heidenhain;

impl Heidenhain {
    /// M128 moves nothing; length and radius are those of the tool table. Arcs and cycles lie across Z.
    pub(crate) fn declared(&self) -> Capabilities {
        use Capabilities as C;
        let some = |yes: bool, set: Capabilities| if yes { set } else { C::NONE };
        let arcs = C::ARC_XY
            .and(C::HELIX)
            .and(C::ARC_RADIUS)
            .and(C::CYCLE_IN_PLANE);
        let drills = C::CYCLE_DRILL.and(C::CYCLE_DEEP).and(C::CYCLE_BREAK_CHIP);
        let others = C::CYCLE_REAM
            .and(C::CYCLE_BORE)
            .and(C::CYCLE_TAP)
            .and(C::CYCLE_TAP_LEFT);
        let cycles = self.linear.is_some() && self.cycles.metric();
        let commands = C::SMOOTHING
            .and(C::OPERATION)
            .and(C::WORK_OFFSET)
            .and(C::SUBPROGRAM);
        C::TCP_STILL
            | C::TOOL_TABLE
            | C::INSTEAD
            | commands
            | some(self.rotary, C::PLANE)
            | some(self.linear.is_some(), arcs)
            | some(cycles, drills | others)
            | some(cycles && self.cycles.fine(), C::CYCLE_BORE_FINE)
            | some(self.tcp || !self.rotary, C::SURFACE)
            | some(self.tcp && self.vectors, C::TOOL_VECTOR)
    }
}

/// All of them; `tcp_on` and `tcp_off` are lines of the options.
pub(crate) fn vocabulary(tcp_on: &str, tcp_off: &str) -> Vec<VocabularyWord> {
    let word = |word: &str, meaning| VocabularyWord {
        word: word.to_owned().into(),
        meaning,
    };
    let fixed = WORDS.iter().map(|(text, meaning)| word(text, *meaning));
    let own = [(tcp_on, M::TcpOn), (tcp_off, M::TcpOff)];
    let own = own.into_iter().filter(|(text, _)| !text.is_empty());
    let first = |text: &str| text.lines().next().unwrap_or_default().to_owned();
    fixed
        .chain(own.map(|(text, meaning)| word(&first(text), meaning)))
        .collect()
}

use Meaning as M;

const WORDS: &[(&str, Meaning)] = &[
    (";", M::Remark),
    ("*", M::Remark),
    ("BEGIN PGM", M::Nothing),
    ("END PGM", M::End),
    ("BLK FORM", M::Nothing),
    ("MM", M::Millimetre),
    ("INCH", M::Inch),
    ("L", M::Linear),
    ("LN", M::Linear),
    ("FMAX", M::RapidBlock),
    ("CC", M::Nothing),
    ("DR-", M::ArcClockwise),
    ("DR+", M::ArcCounterClockwise),
    ("R", M::Radius),
    ("M91", M::MachineCoordinates),
    ("F", M::Feed),
    ("R0", M::CompensationOff),
    ("RL", M::CompensationLeft),
    ("RR", M::CompensationRight),
    ("PLANE SPATIAL", M::TiltedPlane),
    ("PLANE RESET", M::TiltedPlaneOff),
    ("CYCL DEF 247", M::WorkOffset),
    ("CYCL DEF 7", M::WorkOffset),
    ("TRANS DATUM AXIS", M::WorkOffset),
    ("CYCL DEF 32", M::Smoothing),
    ("TOOL CALL", M::ToolChange),
    ("TOOL DEF", M::Nothing),
    ("S", M::SpindleSpeed),
    ("M3", M::SpindleClockwise),
    ("M4", M::SpindleCounterClockwise),
    ("M5", M::SpindleOff),
    ("M8", M::CoolantOn),
    ("M9", M::CoolantOff),
    ("M126", M::Nothing),
    ("M127", M::Nothing),
    ("CYCL DEF 9", M::Dwell),
    ("M0", M::Stop),
    ("M1", M::OptionalStop),
    ("M30", M::End),
    ("CALL LBL", M::Subprogram),
    ("CALL PGM", M::Subprogram),
    ("CYCL DEF 200", M::CycleDrill),
    ("CYCL DEF 203", M::CycleBreakChip),
    ("CYCL DEF 206", M::CycleTap),
    ("CYCL DEF 207", M::CycleTap),
    ("CYCL DEF 201", M::CycleReam),
    ("CYCL DEF 202", M::CycleBore),
];
