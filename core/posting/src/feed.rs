//! How fast a block goes, and how that is written.
//!
//! The feed of a CL file is that of the tip against the part. It fixes the time of the block, no shorter than
//! any axis' largest feed allows; the time is then written as the control understands it.

use post_plugin::{Feed, Format};

use crate::program::Pace;
use post_machine::axis_words::unit_length;
use post_machine::description::{FeedLength, FeedMode, Machine, Tcp};
use post_machine::kinematics::{Joints, MAX_AXES};

/// A tip that moves by no more than this stands still but for the rounding of the words, mm.
pub(crate) const STILL: f64 = 2e-3;

/// Writes feeds for one machine and dialect.
#[derive(Clone, Debug)]
pub struct Feeds {
    axes: Vec<AxisFeed>,
    tcp: Tcp,
    inverse_time: bool,
    length: FeedLength,
    unit: f64,
    feed: Printed,
    inverse: Printed,
}

#[derive(Clone, Copy, Debug)]
struct AxisFeed {
    rotary: bool,
    /// Minutes that the axis needs for one mm or radian at its largest feed.
    slowness: f64,
}

/// The time that a block is due by the CL file.
///
/// It is found for the move and shared out: pieces that are shorter than the words' decimals, or put off the path,
/// have no pace of their own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Due {
    /// Minutes.
    pub minutes: f64,
    /// The tip moves; else the feed is that of the axes.
    pub moves: bool,
}

impl Due {
    /// A share of it.
    #[inline]
    pub fn share(self, share: f64) -> Self {
        Self {
            minutes: self.minutes * share,
            ..self
        }
    }
}

/// A cut's feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paced {
    /// As written.
    pub feed: Feed,
    /// Time of the block, minutes.
    pub minutes: f64,
    /// An axis' largest feed made it slower than asked for.
    pub limited: bool,
}

impl Feeds {
    /// Feeds of `machine` as a dialect's `format` prints them. `None` if the machine asks for inverse time
    /// and the dialect has none.
    pub fn new(machine: &Machine, format: &Format) -> Option<Self> {
        let wanted = match machine.control.feed {
            FeedMode::Auto => machine.control.tcp == Tcp::Post && format.inverse_time.is_some(),
            FeedMode::PerMinute => false,
            FeedMode::InverseTime => true,
        };
        if wanted && format.inverse_time.is_none() {
            return None;
        }
        Some(Self {
            axes: machine
                .axes
                .iter()
                .map(|axis| AxisFeed {
                    rotary: axis.joint.rotary,
                    slowness: 1.0 / axis.max_feed,
                })
                .collect(),
            tcp: machine.control.tcp,
            inverse_time: wanted,
            length: machine.control.feed_length,
            unit: unit_length(machine.control.units),
            feed: Printed::new(format.feed),
            inverse: Printed::new(format.inverse_time.unwrap_or(0)),
        })
    }

    /// The least time in which the axes can go from `from` to `to`, minutes.
    #[inline]
    pub fn least_time(&self, from: &Joints, to: &Joints) -> f64 {
        let mut least: f64 = 0.0;
        for (index, axis) in self.axes.iter().enumerate() {
            least = least.max((to[index] - from[index]).abs() * axis.slowness);
        }
        least
    }

    /// What a move is due that goes `length` mm along the control point's path.
    #[inline]
    pub fn due(&self, pace: Pace, length: f64, from: &Joints, to: &Joints) -> Due {
        let moves = length > STILL;
        let minutes = match pace {
            Pace::PerMinute(feed) if moves => length / feed,
            // The tip stands still: the feed is taken along the axes, degrees as millimetres, as controls do.
            Pace::PerMinute(feed) => self.travels(from, to).combined / feed,
            Pace::InverseTime(feed) => 1.0 / feed,
            Pace::Rapid => 0.0,
        };
        Due { minutes, moves }
    }

    /// The feed of a block in which the control point goes `length` mm, and the tip, whose words a control that keeps
    /// it measures, `tip` mm. It is never faster than the CL file asks for.
    #[inline]
    pub fn cut(
        &self,
        pace: Pace,
        due: Due,
        [length, tip]: [f64; 2],
        from: &Joints,
        to: &Joints,
    ) -> Paced {
        let least = self.least_time(from, to);
        let asked = match pace {
            Pace::PerMinute(feed) if due.moves => due.minutes.max(length / feed),
            _ => due.minutes,
        };
        let minutes = asked.max(least).max(1e-9);
        let limited = least > asked * (1.0 + 1e-9);
        let turning = self.turning(from, to);
        let feed = if self.inverse_time && (turning || self.tcp == Tcp::Control) {
            Feed::InverseTime(self.inverse.floor(1.0 / minutes))
        } else {
            let per_minute = match pace {
                // No detour over lengths where the feed of the CL file can stand as it is.
                Pace::PerMinute(feed)
                    if !limited
                        && due.moves
                        && tip > STILL
                        && (!turning || self.tcp == Tcp::Control) =>
                {
                    feed / self.unit
                }
                _ => self.measured(&self.travels(from, to), tip) / minutes,
            };
            Feed::PerMinute(self.feed.floor(per_minute))
        };
        Paced {
            feed,
            minutes,
            limited,
        }
    }

    #[inline]
    fn turning(&self, from: &Joints, to: &Joints) -> bool {
        let mut axes = self.axes.iter().enumerate();
        axes.any(|(index, axis)| axis.rotary && from[index] != to[index])
    }

    /// The length that the control will divide by F, in the units of the program or degrees.
    fn measured(&self, travels: &Travels, tip: f64) -> f64 {
        let tip = tip / self.unit;
        let linear = travels.linear / self.unit;
        match (self.tcp, self.length) {
            (Tcp::Control, _) if tip > 1e-9 => tip,
            (Tcp::Control, _) => travels.rotary_longest,
            (Tcp::Post, FeedLength::Linear) if linear > 1e-9 => linear,
            (Tcp::Post, FeedLength::Linear) => travels.rotary,
            (Tcp::Post, FeedLength::Combined) => {
                libm::sqrt(linear * linear + travels.rotary * travels.rotary)
            }
            (Tcp::Post, FeedLength::Longest) => {
                (travels.linear_longest / self.unit).max(travels.rotary_longest)
            }
        }
    }

    fn travels(&self, from: &Joints, to: &Joints) -> Travels {
        let mut travels = Travels::default();
        let (mut linear, mut rotary) = (0.0, 0.0);
        for (index, axis) in self.axes.iter().enumerate().take(MAX_AXES) {
            let travel = (to[index] - from[index]).abs();
            if axis.rotary {
                let degrees = travel.to_degrees();
                rotary += degrees * degrees;
                travels.rotary_longest = travels.rotary_longest.max(degrees);
            } else {
                linear += travel * travel;
                travels.linear_longest = travels.linear_longest.max(travel);
            }
        }
        travels.combined = (linear + rotary).sqrt();
        travels.linear = linear.sqrt();
        travels.rotary = rotary.sqrt();
        travels
    }
}

/// How far the axes go in a block: mm and degrees.
#[derive(Clone, Copy, Debug, Default)]
struct Travels {
    linear: f64,
    rotary: f64,
    combined: f64,
    linear_longest: f64,
    rotary_longest: f64,
}

/// Numbers with so many decimals.
#[derive(Clone, Copy, Debug)]
struct Printed {
    /// Ten to the number of decimals.
    scale: f64,
    per_scale: f64,
}

impl Printed {
    fn new(decimals: u8) -> Self {
        let scale = (0..decimals).fold(1.0, |scale, _| scale * 10.0);
        Self {
            scale,
            per_scale: 1.0 / scale,
        }
    }

    /// The largest printed number not above `value`; a feed below the least printed number becomes that.
    #[inline]
    fn floor(&self, value: f64) -> f64 {
        // A value that is a printed number but for its last bits is that number.
        (value * self.scale + 1e-6).floor().max(1.0) * self.per_scale
    }
}
