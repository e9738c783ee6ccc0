//! What the events speak of: feeds, spindle, coolant, compensation, cycles.

use std::fmt;

use crate::field::{Codes, Field, FieldReader, FieldShape, NotKnown, Promise, codes};
use crate::flat::Flat;
use crate::language::Language;
use crate::plane::PlaneAngles;
use crate::setup::Units;
use crate::vocabulary::Meaning;

/// Feed of a cut; already rounded down to the decimals of the dialect's format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feed {
    /// Length units a minute (G94).
    PerMinute(f64),
    /// The block takes 1/F minutes, or 1/F seconds where the machine file says so (G93). Only to dialects whose format
    /// allows it.
    InverseTime(f64),
    /// Length units a spindle revolution (G95).
    PerRevolution(f64),
}

impl fmt::Display for Feed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PerMinute(feed) => write!(f, "{feed} a minute (G94)"),
            Self::InverseTime(feed) => write!(f, "{feed} in inverse time (G93)"),
            Self::PerRevolution(feed) => write!(f, "{feed} a revolution (G95)"),
        }
    }
}

impl Feed {
    /// The number that is written.
    #[inline]
    pub const fn value(self) -> f64 {
        match self {
            Self::PerMinute(value) | Self::InverseTime(value) | Self::PerRevolution(value) => value,
        }
    }

    /// A feed of the same kind with another number.
    #[inline]
    pub const fn with(self, value: f64) -> Self {
        match self {
            Self::PerMinute(_) => Self::PerMinute(value),
            Self::InverseTime(_) => Self::InverseTime(value),
            Self::PerRevolution(_) => Self::PerRevolution(value),
        }
    }

    pub(crate) const CODES: Codes = Codes {
        name: "FEED",
        codes: &[("NONE", 0), ("PER_MINUTE", 1), ("INVERSE_TIME", 2), ("PER_REVOLUTION", 3)],
    };
}

impl Field<'_> for Option<Feed> {
    const SHAPE: FieldShape = FieldShape::Numbers(2);
    const SAMPLE: Self = Some(Feed::PerMinute(500.0));

    #[inline]
    fn put(self, to: &mut Flat) {
        to.numbers(&match self {
            None => [0.0, 0.0],
            Some(Feed::PerMinute(feed)) => [1.0, feed],
            Some(Feed::InverseTime(feed)) => [2.0, feed],
            Some(Feed::PerRevolution(feed)) => [3.0, feed],
        });
    }

    #[inline]
    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        let code = u32::get(from)?;
        let value = f64::get(from)?;
        match code {
            0 => Ok(None),
            1 => Ok(Some(Feed::PerMinute(value))),
            2 => Ok(Some(Feed::InverseTime(value))),
            3 => Ok(Some(Feed::PerRevolution(value))),
            _ => Err(NotKnown),
        }
    }

    #[inline]
    fn check(self, promise: &Promise) -> Result<(), String> {
        match self {
            None => Ok(()),
            Some(Feed::InverseTime(_)) if !promise.inverse_time => {
                Err("this control has no inverse-time feed".to_owned())
            }
            Some(feed) => {
                let value = feed.value();
                if value.is_finite() && value > 0.0 {
                    Ok(())
                } else {
                    Err(format!("the feed is {value}"))
                }
            }
        }
    }
}

impl Field<'_> for Feed {
    const SHAPE: FieldShape = FieldShape::Numbers(2);
    const SAMPLE: Self = Feed::PerMinute(500.0);

    #[inline]
    fn put(self, to: &mut Flat) {
        Some(self).put(to);
    }

    #[inline]
    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        Option::get(from)?.ok_or(NotKnown)
    }

    #[inline]
    fn check(self, promise: &Promise) -> Result<(), String> {
        Some(self).check(promise)
    }
}

/// Spindle commands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spindle {
    /// Turn.
    On {
        /// Revolutions a minute.
        rpm: f64,
        /// Sense.
        sense: SpindleSense,
    },
    /// Stop.
    Off,
    /// Oriented stop (M19).
    Orient,
}

impl Spindle {
    /// Codes of the commands; those of turning are the codes of [`SpindleSense`].
    pub(crate) const CODES: Codes = Codes {
        name: "SPINDLE",
        codes: &[
            ("OFF", 0),
            ("CLOCKWISE", SpindleSense::Clockwise.code()),
            ("COUNTER_CLOCKWISE", SpindleSense::CounterClockwise.code()),
            ("ORIENT", 3),
        ],
    };
}

impl Field<'_> for Spindle {
    const SHAPE: FieldShape = FieldShape::Numbers(2);
    const SAMPLE: Self = Spindle::On { rpm: 3000.0, sense: SpindleSense::Clockwise };

    fn put(self, to: &mut Flat) {
        to.numbers(&match self {
            Spindle::Off => [0.0, 0.0],
            Spindle::On { rpm, sense } => [sense.code().into(), rpm],
            Spindle::Orient => [3.0, 0.0],
        });
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        let code = u32::get(from)?;
        let rpm = f64::get(from)?;
        match (code, SpindleSense::of(code)) {
            (0, _) => Ok(Spindle::Off),
            (3, _) => Ok(Spindle::Orient),
            (_, Some(sense)) => Ok(Spindle::On { rpm, sense }),
            _ => Err(NotKnown),
        }
    }

    fn check(self, _: &Promise) -> Result<(), String> {
        match self {
            Spindle::On { rpm, .. } if !rpm.is_finite() || rpm < 0.0 => {
                Err(format!("its number is {rpm}"))
            }
            _ => Ok(()),
        }
    }
}

codes! {
    /// Sense of the spindle, seen from the spindle to the part.
    SpindleSense "SENSE" {
        /// M3.
        Clockwise = 1 "CLOCKWISE",
        /// M4.
        CounterClockwise = 2 "COUNTER_CLOCKWISE",
    }
}

codes! {
    /// Coolant commands.
    Coolant "COOLANT" {
        /// All off.
        Off = 0 "OFF",
        /// Flood.
        Flood = 1 "FLOOD",
        /// Mist.
        Mist = 2 "MIST",
        /// Through the tool.
        Through = 3 "THROUGH",
        /// Air.
        Air = 4 "AIR",
    }
}

codes! {
    /// Kinds of cycles.
    Cycle "CYCLE" {
        /// A hole in one go (G81), with a dwell where one is given (G82).
        Drill = 1 "DRILL",
        /// A hole in steps, out of the hole after each (G83).
        Deep = 2 "DEEP",
        /// A hole in steps, drawn back a little after each (G73).
        BreakChip = 3 "BREAK_CHIP",
        /// A thread with the spindle turning right (G84).
        Tap = 4 "TAP",
        /// A thread with the spindle turning left (G74).
        TapLeft = 5 "TAP_LEFT",
        /// Out at feed (G85), after a dwell where one is given (G89).
        Ream = 6 "REAM",
        /// Out at rapid with the spindle stopped (G86).
        Bore = 7 "BORE",
        /// Oriented, drawn off the wall and out (G76).
        BoreFine = 8 "BORE_FINE",
        /// Boring from below (G87).
        BoreBack = 9 "BORE_BACK",
    }
}

/// Cutter radius compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Compensation {
    /// G40.
    Off,
    /// G41.
    Left {
        /// Register.
        register: u32,
    },
    /// G42.
    Right {
        /// Register.
        register: u32,
    },
}

impl Compensation {
    pub(crate) const CODES: Codes =
        Codes { name: "COMPENSATE", codes: &[("OFF", 0), ("LEFT", 1), ("RIGHT", 2)] };
}

impl Field<'_> for Compensation {
    const SHAPE: FieldShape = FieldShape::Numbers(2);
    const SAMPLE: Self = Compensation::Left { register: 5 };

    fn put(self, to: &mut Flat) {
        let (code, register) = match self {
            Compensation::Off => (0, 0),
            Compensation::Left { register } => (1, register),
            Compensation::Right { register } => (2, register),
        };
        to.numbers(&[f64::from(code), f64::from(register)]);
    }

    fn get(from: &mut FieldReader<'_>) -> Result<Self, NotKnown> {
        let code = u32::get(from)?;
        let register = u32::get(from)?;
        match code {
            0 => Ok(Compensation::Off),
            1 => Ok(Compensation::Left { register }),
            2 => Ok(Compensation::Right { register }),
            _ => Err(NotKnown),
        }
    }
}

/// All numbers that stand for a word in the fields of events and of formats.
pub const CODES: &[Codes] = &[
    Units::CODES,
    Feed::CODES,
    Spindle::CODES,
    SpindleSense::CODES,
    Coolant::CODES,
    Compensation::CODES,
    Cycle::CODES,
    PlaneAngles::CODES,
    Language::CODES,
    Meaning::CODES,
];
