//! Words that the controls of a language read the same way, whether our dialects write them or not.
//!
//! A dialect lists what it writes; programs of others hold more. Only what moves and what changes the meaning of words
//! stands here, and what is known to do neither. What differs from control to control (planes, tool centre point
//! control, smoothing, units) is for the dialect alone.

use post_plugin::Meaning as M;

use super::{Language, Sense};

/// The words of a language that dialects need not name.
pub(super) fn words(language: Language) -> Vec<(&'static str, Sense)> {
    let means = |list: &'static [(&'static str, M)]| {
        list.iter()
            .map(|(word, meaning)| (*word, Sense::Means(*meaning)))
    };
    let mut words: Vec<(&'static str, Sense)> = means(SHARED).collect();
    match language {
        Language::Macro => {
            words.extend(means(LETTERS));
            words.extend_from_slice(LETTER_SENSES);
            words.extend(means(MACRO));
            words.extend_from_slice(MACRO_SENSES);
        }
        Language::Rs274 => {
            words.extend(means(LETTERS));
            words.extend_from_slice(LETTER_SENSES);
            words.extend(means(RS274));
            words.extend_from_slice(RS274_SENSES);
        }
        Language::Names => {
            words.extend(means(NAMES));
            words.extend_from_slice(NAME_SENSES);
        }
        Language::Conversational => words.extend(means(CONVERSATIONAL)),
    }
    words
}

/// Of all languages.
const SHARED: &[(&str, M)] = &[
    ("M0", M::Stop),
    ("M1", M::OptionalStop),
    ("M2", M::End),
    ("M30", M::End),
    ("M3", M::SpindleClockwise),
    ("M4", M::SpindleCounterClockwise),
    ("M5", M::SpindleOff),
    ("M6", M::ToolChange),
    ("M7", M::CoolantOn),
    ("M8", M::CoolantOn),
    ("M9", M::CoolantOff),
    ("M19", M::SpindleOrient),
];

/// Of controls whose words are letters.
const LETTERS: &[(&str, M)] = &[
    ("G0", M::Rapid),
    ("G1", M::Linear),
    ("G2", M::ArcClockwise),
    ("G3", M::ArcCounterClockwise),
    ("G4", M::Dwell),
    ("G17", M::PlaneXy),
    ("G18", M::PlaneZx),
    ("G19", M::PlaneYz),
    ("G20", M::Inch),
    ("G21", M::Millimetre),
    ("G40", M::CompensationOff),
    ("G41", M::CompensationLeft),
    ("G42", M::CompensationRight),
    ("G43", M::LengthOn),
    ("G49", M::LengthOff),
    ("G53", M::MachineCoordinates),
    ("G54", M::WorkOffset),
    ("G55", M::WorkOffset),
    ("G56", M::WorkOffset),
    ("G57", M::WorkOffset),
    ("G58", M::WorkOffset),
    ("G59", M::WorkOffset),
    ("G61", M::SmoothingOff),
    ("G64", M::Smoothing),
    ("G73", M::CycleBreakChip),
    ("G74", M::CycleTapLeft),
    ("G76", M::CycleBoreFine),
    ("G80", M::CycleOff),
    ("G81", M::CycleDrill),
    ("G82", M::CycleDrill),
    ("G83", M::CycleDeep),
    ("G84", M::CycleTap),
    ("G85", M::CycleReam),
    ("G86", M::CycleBore),
    ("G87", M::CycleBoreBack),
    ("G89", M::CycleReam),
    ("G90", M::Absolute),
    ("G91", M::Incremental),
    ("G93", M::InverseTime),
    ("G94", M::FeedPerMinute),
    ("G95", M::FeedPerRevolution),
    ("G98", M::ReturnStart),
    ("G99", M::ReturnClearance),
    ("M98", M::Subprogram),
];

const LETTER_SENSES: &[(&str, Sense)] = &[
    ("G28", Sense::Reference(1)),
    ("G30", Sense::Reference(2)),
    ("G52", Sense::LocalZero),
    ("G92", Sense::Preset),
    ("G10", Sense::Table),
    ("G96", Sense::SurfaceSpeed),
    ("G97", Sense::SpindleSpeed),
    ("M99", Sense::Return),
];

const MACRO: &[(&str, M)] = &[
    ("G9", M::Nothing),
    ("G22", M::Nothing),
    ("G23", M::Nothing),
    ("G25", M::Nothing),
    ("G26", M::Nothing),
    ("G50.1", M::Nothing),
    ("G62", M::Nothing),
    ("G67", M::Nothing),
    ("M97", M::Subprogram),
];

const MACRO_SENSES: &[(&str, Sense)] = &[
    ("G68", Sense::Turned),
    ("G69", Sense::TurnedOff),
    ("G92.1", Sense::Preset),
];

const RS274: &[(&str, M)] = &[
    ("G38.2", M::Probe),
    ("G38.3", M::Probe),
    ("G38.4", M::Probe),
    ("G38.5", M::Probe),
    ("G59.1", M::WorkOffset),
    ("G59.2", M::WorkOffset),
    ("G59.3", M::WorkOffset),
    ("G61.1", M::SmoothingOff),
    ("M48", M::Nothing),
    ("M49", M::Nothing),
    ("M50", M::Nothing),
    ("M51", M::Nothing),
    ("M52", M::Nothing),
    ("M53", M::Nothing),
];

const RS274_SENSES: &[(&str, Sense)] = &[
    ("G43.1", Sense::LengthByWords),
    ("G43.2", Sense::Refused),
    ("G92.1", Sense::Preset),
    ("G92.2", Sense::Preset),
    ("G92.3", Sense::Preset),
    ("G90.1", Sense::CentresAbsolute),
    ("G91.1", Sense::CentresIncremental),
    ("G33", Sense::Thread),
    ("G33.1", Sense::Thread),
    // An analogue output may be wired to what switches the kinematics.
    ("M67", Sense::Refused),
    ("M68", Sense::Refused),
];

const NAMES: &[(&str, M)] = &[
    ("G0", M::Rapid),
    ("G1", M::Linear),
    ("G2", M::ArcClockwise),
    ("G3", M::ArcCounterClockwise),
    ("G4", M::Dwell),
    ("G9", M::Nothing),
    ("G17", M::PlaneXy),
    ("G18", M::PlaneZx),
    ("G19", M::PlaneYz),
    ("G40", M::CompensationOff),
    ("G41", M::CompensationLeft),
    ("G42", M::CompensationRight),
    ("G53", M::MachineCoordinates),
    ("G153", M::MachineCoordinates),
    ("SUPA", M::MachineCoordinates),
    ("G54", M::WorkOffset),
    ("G55", M::WorkOffset),
    ("G56", M::WorkOffset),
    ("G57", M::WorkOffset),
    ("G500", M::WorkOffset),
    ("G60", M::SmoothingOff),
    ("G601", M::Nothing),
    ("G602", M::Nothing),
    ("G603", M::Nothing),
    ("G64", M::Smoothing),
    ("G641", M::Smoothing),
    ("G642", M::Smoothing),
    ("G643", M::Smoothing),
    ("G644", M::Smoothing),
    ("G645", M::Smoothing),
    ("G70", M::Inch),
    ("G71", M::Millimetre),
    ("G700", M::Inch),
    ("G710", M::Millimetre),
    ("G90", M::Absolute),
    ("G91", M::Incremental),
    ("G93", M::InverseTime),
    ("G94", M::FeedPerMinute),
    ("G95", M::FeedPerRevolution),
    ("COMPOF", M::SmoothingOff),
    ("COMPON", M::Smoothing),
    ("COMPCAD", M::Smoothing),
    ("COMPCURV", M::Smoothing),
    ("COMPSURF", M::Smoothing),
    ("M17", M::End),
    ("MCALL", M::CycleOff),
    ("BRISK", M::Nothing),
    ("SOFT", M::Nothing),
    ("DRIVE", M::Nothing),
    ("FFWON", M::Nothing),
    ("FFWOF", M::Nothing),
    ("FNORM", M::Nothing),
    ("FLIN", M::Nothing),
    ("CFC", M::Nothing),
    ("CFTCP", M::Nothing),
    ("CFIN", M::Nothing),
    ("STOPRE", M::Nothing),
    ("UPATH", M::Nothing),
    ("SPATH", M::Nothing),
    ("NORM", M::Nothing),
    ("KONT", M::Nothing),
    ("CDOF", M::Nothing),
    ("OSOF", M::Nothing),
    ("DYNNORM", M::Nothing),
    ("DYNFINISH", M::Nothing),
    ("DYNSEMIFIN", M::Nothing),
    ("DYNROUGH", M::Nothing),
    ("DYNPOS", M::Nothing),
    ("LIMS", M::Nothing),
    ("CTOL", M::Nothing),
    ("OTOL", M::Nothing),
    ("ADIS", M::Nothing),
    ("ADISPOS", M::Nothing),
    ("WORKPIECE", M::Nothing),
];

const NAME_SENSES: &[(&str, Sense)] = &[
    ("G96", Sense::SurfaceSpeed),
    ("G97", Sense::SpindleSpeed),
    ("G74", Sense::Reference(1)),
    ("G75", Sense::Refused),
    ("G33", Sense::Refused),
    ("G63", Sense::Refused),
    ("G331", Sense::Refused),
    ("G332", Sense::Refused),
];

const CONVERSATIONAL: &[(&str, M)] = &[
    ("M13", M::SpindleClockwise),
    ("M14", M::SpindleCounterClockwise),
];
