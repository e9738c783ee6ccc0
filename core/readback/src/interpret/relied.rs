//! What a program relies on and does not say: modes that hold from whatever ran before, and that the tool stands clear.

use post_plugin::{Meaning, VocabularyWord};

use super::state::ControlState;

/// Modes of which one always holds: a program that sets none has that of the program before, or of the control's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModalGroup {
    /// Inch or millimetre: the worth of every length and feed.
    Units,
    /// Positions or ways: what the words of axes are.
    Distance,
    /// The plane of arcs, cycles and compensation.
    Plane,
    /// A feed by time, a minute or a revolution.
    Feed,
    /// Radius compensation: one that is left on shifts the path.
    Compensation,
    /// A cycle that drills at each position, until a word ends it.
    Cycle,
    /// A tilted plane: one that is left on turns all words.
    TiltedPlane,
}

/// Bits of the modes that may have been left on.
const LEFT_ON: u8 =
    ModalGroup::Compensation.bit() | ModalGroup::Cycle.bit() | ModalGroup::TiltedPlane.bit();

impl ModalGroup {
    /// The mode that a word with this meaning sets, if it sets one.
    pub fn of(meaning: Meaning) -> Option<Self> {
        Some(match meaning {
            Meaning::Millimetre
            | Meaning::Inch
            | Meaning::MillimetreLengths
            | Meaning::InchLengths => Self::Units,
            Meaning::Absolute | Meaning::Incremental => Self::Distance,
            Meaning::PlaneXy | Meaning::PlaneZx | Meaning::PlaneYz => Self::Plane,
            Meaning::FeedPerMinute
            | Meaning::FeedPerMinuteAllAxes
            | Meaning::InverseTime
            | Meaning::FeedPerRevolution
            | Meaning::SurfaceSpeedPerRevolution
            | Meaning::SurfaceSpeedPerMinute
            | Meaning::FixedSpeedPerRevolution
            | Meaning::FixedSpeedPerMinute => Self::Feed,
            Meaning::CompensationOff => Self::Compensation,
            Meaning::CycleOff => Self::Cycle,
            Meaning::TiltedPlaneOff => Self::TiltedPlane,
            _ => return None,
        })
    }

    /// What messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Units => "units",
            Self::Distance => "absolute or incremental",
            Self::Plane => "plane",
            Self::Feed => "feed mode",
            Self::Compensation => "radius compensation off",
            Self::Cycle => "cycles off",
            Self::TiltedPlane => "tilted planes off",
        }
    }

    /// Its bit in a set of modes.
    pub(crate) const fn bit(self) -> u8 {
        1 << self as u8
    }

    /// The bits of the modes that a dialect has words for: what its control has fixed, no program can set.
    pub(crate) fn named(words: &[VocabularyWord]) -> u8 {
        let groups = words.iter().filter_map(|word| Self::of(word.meaning));
        groups.fold(0, |bits, group| bits | group.bit())
    }
}

impl ControlState {
    /// A word sets a mode, if it has this meaning: from here on the program says it itself.
    pub(super) fn sets_group(&mut self, meaning: Meaning) {
        if let Some(group) = ModalGroup::of(meaning) {
            self.modal.unset &= !group.bit();
        }
    }

    /// What the block means hangs on a mode.
    #[inline]
    pub(super) fn relies_on(&mut self, group: ModalGroup) {
        if self.modal.unset & group.bit() != 0 {
            self.modal.unset &= !group.bit();
            self.report.relied.push((self.line, group));
        }
    }

    /// A tool is changed, or led to the part: has the program led the axes to their retract before?
    #[inline]
    pub(super) fn begins(&mut self) {
        if !std::mem::replace(&mut self.begun, true) {
            self.look_for_first_retract();
        }
    }

    /// The tool is led to the part by words: what was left on then would lead it elsewhere.
    #[inline]
    pub(super) fn relies_on_nothing_left(&mut self) {
        const LEFT: [ModalGroup; 3] =
            [ModalGroup::Compensation, ModalGroup::Cycle, ModalGroup::TiltedPlane];
        if self.modal.unset & LEFT_ON != 0 {
            LEFT.into_iter().for_each(|group| self.relies_on(group));
        }
    }

    /// A straight move at feed tells nothing more of what the program relies on: one before it has.
    pub(super) fn has_begun(&self) -> bool {
        let plane = if self.state.compensation != 0 { ModalGroup::Plane.bit() } else { 0 };
        let moves = ModalGroup::Units.bit() | ModalGroup::Distance.bit() | ModalGroup::Feed.bit();
        self.begun && self.modal.unset & (moves | plane | LEFT_ON) == 0
    }

    #[cold]
    fn look_for_first_retract(&mut self) {
        let retract = self.machine.frame.retract.iter().map(|(place, _)| *place);
        let unsaid = retract.filter(|place| self.said & (1 << place) == 0);
        let names: Vec<&str> = unsaid.map(|place| self.machine.axes[place].name.as_str()).collect();
        if !names.is_empty() {
            self.report.unretracted = Some((self.line, names.join(", ")));
        }
    }
}
