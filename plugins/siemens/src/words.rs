//! The words of the control and what they mean.

use post_plugin::{Meaning, VocabularyWord};

/// All of them; `tcp_on` and `tcp_off` are lines of the options.
pub(crate) fn vocabulary(tcp_on: &str, tcp_off: &str) -> Vec<VocabularyWord> {
    let word = |word: &str, meaning| VocabularyWord {
        word: word.to_owned().into(),
        meaning,
    };
    let fixed = WORDS.iter().map(|(text, meaning)| word(text, *meaning));
    let first = |lines: &str| lines.lines().next().unwrap_or_default().to_owned();
    let own = [
        (first(tcp_on), Meaning::TcpOn),
        (first(tcp_off), Meaning::TcpOff),
    ];
    let own = own.into_iter().filter(|(text, _)| !text.is_empty());
    fixed
        .chain(own.map(|(text, meaning)| word(&text, meaning)))
        .collect()
}

use Meaning as M;

const WORDS: &[(&str, Meaning)] = &[
    (";", M::Remark),
    ("N", M::BlockNumber),
    ("%_N_", M::Nothing),
    ("MSG", M::Nothing),
    ("TRANS", M::Nothing),
    ("ORIMKS", M::Nothing),
    ("ORIWKS", M::Nothing),
    ("ORIAXES", M::Nothing),
    ("LIMS=", M::Nothing),
    ("G710", M::Millimetre),
    ("G700", M::Inch),
    ("G90", M::Absolute),
    ("G91", M::Incremental),
    ("G17", M::PlaneXy),
    ("G18", M::PlaneZx),
    ("G19", M::PlaneYz),
    ("G0", M::Rapid),
    ("G1", M::Linear),
    ("G2", M::ArcClockwise),
    ("G3", M::ArcCounterClockwise),
    ("I", M::CentreX),
    ("J", M::CentreY),
    ("K", M::CentreZ),
    ("CR=", M::Radius),
    ("SUPA", M::MachineCoordinates),
    ("F", M::Feed),
    ("G94", M::FeedPerMinute),
    ("G93", M::InverseTime),
    ("G95", M::FeedPerRevolution),
    ("D", M::LengthOn),
    ("D0", M::LengthOff),
    ("G40", M::CompensationOff),
    ("G41", M::CompensationLeft),
    ("G42", M::CompensationRight),
    ("CYCLE800", M::TiltedPlane),
    ("CYCLE800()", M::TiltedPlaneOff),
    ("G54", M::WorkOffset),
    ("G55", M::WorkOffset),
    ("G56", M::WorkOffset),
    ("G57", M::WorkOffset),
    ("G5", M::WorkOffset),
    ("CYCLE832", M::Smoothing),
    ("COMPCAD", M::Smoothing),
    ("COMPSURF", M::Smoothing),
    ("COMPCURV", M::Smoothing),
    ("CYCLE832()", M::SmoothingOff),
    ("COMPOF", M::SmoothingOff),
    ("T", M::Tool),
    ("T=", M::Tool),
    ("M6", M::ToolChange),
    ("S", M::SpindleSpeed),
    ("M3", M::SpindleClockwise),
    ("M4", M::SpindleCounterClockwise),
    ("M5", M::SpindleOff),
    ("M19", M::SpindleOrient),
    ("M7", M::CoolantOn),
    ("M8", M::CoolantOn),
    ("M9", M::CoolantOff),
    ("G4", M::Dwell),
    ("M0", M::Stop),
    ("M1", M::OptionalStop),
    ("M30", M::End),
    ("M17", M::End),
    ("L", M::Subprogram),
    ("MEAS=", M::Probe),
    ("MCALL CYCLE81", M::CycleDrill),
    ("MCALL CYCLE82", M::CycleDrill),
    ("MCALL CYCLE83", M::CycleDeep),
    ("MCALL CYCLE84", M::CycleTap),
    ("MCALL CYCLE840", M::CycleTap),
    ("MCALL CYCLE85", M::CycleReam),
    ("MCALL CYCLE86", M::CycleBore),
    ("MCALL", M::CycleOff),
];
