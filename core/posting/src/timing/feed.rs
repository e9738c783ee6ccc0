//! How a feed is written: per minute of what the control will divide by it, or as an inverse time.

use post_machine::axis_words::unit_length;
use post_machine::description::{FeedLength, FeedMode, Machine, Tcp};
use post_machine::kinematics::Joints;
use post_plugin::{Feed, Format};

use crate::blocks::{Block, Kinds, STILL, Travels};
use crate::program::Pace;

/// Writes feeds for one machine and dialect.
#[derive(Clone, Debug)]
pub(super) struct FeedWriter {
    kinds: Kinds,
    tcp: Tcp,
    inverse_time: bool,
    length: FeedLength,
    unit: f64,
    feed: Printed,
    inverse: Printed,
}

impl FeedWriter {
    /// Feeds of `machine` as a dialect's `format` prints them. `None` if the machine asks for inverse time
    /// and the dialect has none.
    pub(super) fn new(machine: &Machine, format: &Format) -> Option<Self> {
        let wanted = match machine.control.feed {
            FeedMode::Auto => machine.control.tcp == Tcp::Post && format.inverse_time.is_some(),
            FeedMode::PerMinute => false,
            FeedMode::InverseTime => true,
        };
        if wanted && format.inverse_time.is_none() {
            return None;
        }
        Some(Self {
            kinds: Kinds::new(machine),
            tcp: machine.control.tcp,
            inverse_time: wanted,
            length: machine.control.feed_length,
            unit: unit_length(machine.control.units),
            feed: Printed::new(format.feed),
            inverse: Printed::new(format.inverse_time.unwrap_or(0)),
        })
    }

    /// The feed of a block that takes `minutes` from `from`; it is never faster than the CL file asks for.
    #[inline]
    pub(super) fn write(&self, block: &Block, from: &Joints, minutes: f64) -> Feed {
        let (to, [_, tip]) = (&block.joints, block.way);
        let turning = self.kinds.turning(from, to);
        if self.inverse_time && (turning || self.tcp == Tcp::Control) {
            return Feed::InverseTime(self.inverse.floor(1.0 / minutes));
        }
        let per_minute = match block.pace {
            // No detour over lengths where the feed of the CL file can stand as it is.
            Pace::PerMinute(feed)
                if block.time.limit.is_none()
                    && block.nominal.moves
                    && tip > STILL
                    && (!turning || self.tcp == Tcp::Control) =>
            {
                feed / self.unit
            }
            _ => self.measured(&self.kinds.travels(from, to), tip) / minutes,
        };
        Feed::PerMinute(self.feed.floor(per_minute))
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
