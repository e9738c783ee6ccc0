//! What a program relies on: modes that it does not say and that hold from whatever ran before, or that it sets otherwise
//! than the machine file has them, and that the tool stands clear.

use post_machine::diagnostic::Diagnostic;
use post_plugin::{Meaning, VocabularyWord};

use super::state::{ArcPlane, ControlState};

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
    /// Diameters or radii: the worth of the words of X.
    Diameter,
    /// The frame of the tool that a robot leads straight.
    ToolFrame,
    /// What the poses of a robot count from.
    BaseFrame,
    /// Positions or ways: what the words of an extruder are.
    Extruder,
    /// Where the extruder stands as its first word comes.
    ExtruderStart,
    /// Whether an arm may come straight to a pose in another configuration than it says.
    Configuration,
}

/// A mode that stands otherwise where a motion depends on it than the machine file has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContraryMode {
    /// Line of the motion.
    pub line: u64,
    /// Which mode.
    pub group: ModalGroup,
    /// What the program has set.
    pub has: String,
    /// What it must be; none where the dialect names nothing.
    pub wants: Option<String>,
}

/// Contrary modes that are kept.
const MOST_CONTRARY: usize = 50;

/// Bits of the modes that may have been left on.
const LEFT_ON: u16 =
    ModalGroup::Compensation.bit() | ModalGroup::Cycle.bit() | ModalGroup::TiltedPlane.bit();

impl ModalGroup {
    /// The bits of an extruder's modes.
    pub(super) const OF_EXTRUDERS: u16 = Self::Extruder.bit() | Self::ExtruderStart.bit();

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
            Meaning::CycleOff | Meaning::CycleOffSpindleOff => Self::Cycle,
            Meaning::TiltedPlaneOff => Self::TiltedPlane,
            Meaning::Diameter | Meaning::DiameterOfPositions | Meaning::DiameterOff => {
                Self::Diameter
            }
            Meaning::ToolFrame | Meaning::OwnToolFrame => Self::ToolFrame,
            Meaning::WorkOffset | Meaning::WorkOffsetOff => Self::BaseFrame,
            Meaning::ExtruderPositions => Self::Extruder,
            Meaning::AnyConfiguration => Self::Configuration,
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
            Self::Diameter => "diameters or radii",
            Self::ToolFrame => "the frame of the tool",
            Self::BaseFrame => "the frame of poses",
            Self::Extruder => "positions of the extruder",
            Self::ExtruderStart => "where the extruder counts from (G92 E0)",
            Self::Configuration => "any configuration for straight moves",
        }
    }

    /// Its bit in a set of modes.
    pub(crate) const fn bit(self) -> u16 {
        1 << self as u8
    }

    /// The bits of what a robot's program must set itself: the frames that it has a word for, and another of what they must
    /// be, and whether configurations are watched.
    pub(crate) fn of_robots(words: &[VocabularyWord]) -> u16 {
        let has = |meaning| words.iter().any(|word| word.meaning == meaning);
        let [tool, base] = [
            has(Meaning::ToolFrame) && has(Meaning::OwnToolFrame),
            has(Meaning::WorkOffset) && has(Meaning::WorkOffsetOff),
        ];
        let free = has(Meaning::AnyConfiguration);
        let bits = [(tool, Self::ToolFrame), (base, Self::BaseFrame), (free, Self::Configuration)];
        bits.into_iter().filter(|(is, _)| *is).fold(0, |bits, (_, group)| bits | group.bit())
    }

    /// The bits of the modes that a dialect has words for: what its control has fixed, no program can set.
    pub(crate) fn named(words: &[VocabularyWord]) -> u16 {
        let groups = words.iter().filter_map(|word| Self::of(word.meaning));
        groups.fold(0, |bits, group| match group {
            Self::Extruder => bits | Self::OF_EXTRUDERS,
            _ => bits | group.bit(),
        })
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

    /// What the block means hangs on a mode that the program has set to `has`, and the machine file has otherwise.
    #[cold]
    pub(super) fn stands_otherwise(&mut self, group: ModalGroup, has: &str, wants: Option<String>) {
        let contrary = &mut self.report.contrary;
        let told = contrary.iter().any(|other| other.group == group && other.has == has);
        if !told && contrary.len() < MOST_CONTRARY {
            let has = has.to_owned();
            contrary.push(ContraryMode { line: self.line, group, has, wants });
        }
    }

    /// The plane has changed since the length was put on, and the control lays it along another axis with that.
    pub(super) fn length_goes_elsewhere(&self) -> bool {
        self.modal.plane != self.tools.across
            && self.tools.length_on
            && self.lexicon.lengths_go_across()
    }

    /// The lengths of a turning tool act in X and Z under G18, and in Y and X under G17 (SINUMERIK ONE, NC programming,
    /// 6FC5398-2EP40-0BA0, 12/2019, p. 750).
    #[inline]
    pub(super) fn relies_on_turning_plane(&mut self) {
        if !self.lengths_by_plane {
            if self.length_goes_elsewhere() {
                self.report.length_across.get_or_insert(self.line);
            }
            return;
        }
        if self.modal.unset & ModalGroup::Plane.bit() != 0 {
            self.relies_on(ModalGroup::Plane);
            // As lathes are set up.
            self.modal.plane = ArcPlane::Zx;
        }
        let has = match self.modal.plane {
            ArcPlane::Zx => return,
            ArcPlane::Xy => "G17",
            ArcPlane::Yz => "G19",
        };
        self.stands_otherwise(ModalGroup::Plane, has, Some("G18".to_owned()));
    }

    /// Words of X are diameters or radii from here on, whatever [word.X] of the machine file has.
    pub(super) fn count_diameters(&mut self, meaning: Meaning) -> Result<(), Box<Diagnostic>> {
        let Some(place) = self.axes.cartesian[0] else {
            return Ok(());
        };
        let factor = 1.0 / self.axes.scale[place];
        let coupled = self.machine.word_map.as_ref().is_some_and(|map| map.is_coupled(place));
        let known = [1.0, 2.0].iter().any(|known| libm::fabs(libm::fabs(factor) - known) < 1e-9);
        let diameter = meaning != Meaning::DiameterOff;
        if self.face.is_some() || self.wrap_outside.is_some() || coupled || !known {
            let message = "words of X become diameters or radii, and what they are here is told by the machine file alone";
            return Err(self.refuse("nc-word", message));
        }
        let value = if diameter { 0.5 } else { 1.0 };
        self.axes.scale[place] = libm::copysign(value, factor);
        self.modal.ways_are_radii = meaning == Meaning::DiameterOfPositions;
        Ok(())
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
        self.begun && self.modal.unset & (moves | plane | ModalGroup::Diameter.bit() | LEFT_ON) == 0
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
