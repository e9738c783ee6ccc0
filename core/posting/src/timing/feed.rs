//! How a feed is written: per minute of what the control will divide by it, or as an inverse time.

use nalgebra::Matrix3;
use post_machine::axis_words::unit_length;
use post_machine::description::{FeedLength, FeedMode, InverseTime, Machine, Tcp, TcpFeedLength};
use post_machine::kinematics::batch::{Column, LANES};
use post_machine::kinematics::{Joints, MAX_AXES};
use post_plugin::{Capabilities, Feed, Format};

use crate::blocks::{AxisKinds, BlockKind, MotionBlock, STILL};
use crate::program::MoveFeed;

/// What a length of the control's may differ from the way of the tip to be the same.
const SAME: f64 = 1e-9;

/// Writes feeds for one machine and dialect.
#[derive(Clone, Debug)]
pub(super) struct FeedWriter {
    /// Ways as the control counts them.
    kinds: AxisKinds,
    /// Ways in mm and degrees.
    degrees: AxisKinds,
    tcp: Tcp,
    inverse_time: bool,
    length: FeedLength,
    tcp_length: TcpFeedLength,
    /// Where nothing turns, the control's length is the way of the tip.
    square: bool,
    /// No linear axis passes its largest feed if the tool goes no faster, mm/min.
    most: f64,
    unit: f64,
    feed: DecimalFormat,
    turn: DecimalFormat,
    /// The feed of rapids, program units a minute, where the control has no other speed for them.
    rapid: Option<f64>,
    /// None where the machine or the dialect has no feed by time.
    inverse: Option<DecimalFormat>,
}

/// A feed as it is written, and what comes of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WrittenFeed {
    /// As written.
    pub feed: Feed,
    /// What the control takes for the block, minutes.
    pub minutes: f64,
    /// The feed that it should have, if that is below the least that is printed.
    pub raised_from: Option<f64>,
    /// The control takes no larger F by time: the block is slowed down.
    pub capped: bool,
}

/// A way that a feed is written for.
#[derive(Clone, Copy, Debug)]
pub(super) struct FedWay {
    /// Way of the tip, mm.
    pub tip: f64,
    /// The feed that the CL file asks for, mm/min, where the tip moves at one.
    pub feed: Option<f64>,
    /// The time that it leaves it, minutes, and that which it asks for.
    pub minutes: f64,
    pub asked: f64,
    /// The tip bows aside from the straight way by no more, mm.
    pub bow: f64,
    /// Some rotary axis turns.
    pub turning: bool,
    /// Along an arc or a spline.
    pub curved: bool,
}

impl FedWay {
    /// The time in which the tip is no faster than asked, minutes: beside a pole it may go farther out and back than along, and
    /// a time of what it goes along would be one that no control keeps.
    fn bowed_minutes(&self) -> f64 {
        let out_and_back = 2.0 * self.bow;
        match self.feed {
            Some(feed) if self.turning && self.tip < out_and_back => out_and_back / feed,
            _ => 0.0,
        }
    }
}

impl FeedWriter {
    /// Feeds of `machine` as a dialect's `format` prints them, which `writes` says the control counts. `None` if the machine asks for inverse time
    /// and the dialect has none.
    pub(super) fn new(machine: &Machine, format: &Format, writes: Capabilities) -> Option<Self> {
        let wanted = match machine.control.feed {
            FeedMode::Auto => machine.control.tcp == Tcp::Post && format.inverse_time.is_some(),
            FeedMode::PerMinute => false,
            FeedMode::InverseTime => true,
        };
        if wanted && format.inverse_time.is_none() {
            return None;
        }
        let tcp = machine.control.tcp;
        let usual = match writes {
            _ if writes.has(Capabilities::FEED_ALL_AXES) => FeedLength::Combined,
            _ if writes.has(Capabilities::FEED_LONGEST_TURN) => FeedLength::LinearOrLongest,
            _ => FeedLength::Linear,
        };
        let length = machine.control.feed_length.unwrap_or(usual);
        Some(Self {
            degrees: AxisKinds::new(machine),
            kinds: AxisKinds::counted(machine, unit_length(machine.control.units)),
            tcp,
            inverse_time: wanted,
            length,
            tcp_length: machine.control.tcp_feed_length,
            square: length != FeedLength::Longest && square(machine),
            most: most(machine),
            unit: unit_length(machine.control.units),
            feed: DecimalFormat::new(format.feed),
            turn: DecimalFormat::new(format.feed_per_revolution),
            rapid: format.rapid_feed,
            inverse: match machine.control.feed {
                FeedMode::PerMinute => None,
                _ => format.inverse_time.map(|decimals| {
                    let most = format.most_inverse_time.unwrap_or(f64::INFINITY);
                    DecimalFormat::new(decimals).up_to(most).per(
                        match machine.control.inverse_time {
                            InverseTime::Minutes => 1.0,
                            InverseTime::Seconds => 60.0,
                        },
                    )
                }),
            },
        })
    }

    /// Whether some rotary axis turns from each of `count` places to the next.
    pub(super) fn turning_all(
        &self,
        joints: &[Column; MAX_AXES],
        count: usize,
        turns: &mut [bool; LANES],
    ) {
        self.kinds.turning_all(joints, count, turns);
    }

    /// A feed of `feed` mm a revolution as it is printed; none where the dialect prints none so low.
    pub(super) fn per_revolution(&self, feed: f64) -> Option<f64> {
        Some(self.turn.floor(feed / self.unit)).filter(|feed| *feed > 0.0)
    }

    /// The least feed a minute that is printed.
    pub(super) fn least(&self) -> f64 {
        self.feed.per_scale
    }

    /// The feed of a block from `from` that must take `least` minutes; it is never faster than the CL file asks for.
    #[inline]
    pub(super) fn write(&self, block: &MotionBlock, from: &Joints, least: f64) -> WrittenFeed {
        let tip = block.way;
        let feed = match block.pace {
            MoveFeed::PerMinute(feed) if block.nominal.moves => Some(feed),
            _ => None,
        };
        let minutes = block.nominal.minutes;
        let way = FedWay {
            tip,
            feed,
            minutes: feed.map_or(minutes, |feed| minutes.max(tip / feed)),
            asked: block.asked(),
            bow: block.deviation.tip,
            turning: self.kinds.turning(from, &block.joints),
            curved: matches!(block.kind, BlockKind::Arc | BlockKind::Spline),
        };
        self.write_way(&way, least, || self.measured(from, &block.joints, tip))
    }

    /// [`FeedWriter::write`] of a way; `measured` gives the length that the control will divide by F where that is not the
    /// way of the tip.
    #[inline]
    pub(super) fn write_way(
        &self,
        way: &FedWay,
        least: f64,
        measured: impl FnOnce() -> f64,
    ) -> WrittenFeed {
        let (tip, turning) = (way.tip, way.turning);
        let minutes = way.minutes.max(least).max(1e-9);
        if self.inverse_time
            && (turning || self.tcp == Tcp::Control)
            && let Some(printed) = self.inverse
        {
            return printed.inverse(1.0 / minutes.max(way.bowed_minutes()));
        }
        // No detour over the axes where their ways make no difference. Along a curve the tool goes its own way.
        let plain = match self.tcp {
            Tcp::Control => tip > SAME && (self.tcp_length == TcpFeedLength::Tip || !turning),
            Tcp::Post => !turning && self.square,
        } || way.curved;
        let length = if plain { tip / self.unit } else { measured() };
        if let Some(feed) = way.feed
            && tip > STILL
            && (plain || (length * self.unit - tip).abs() <= SAME * tip)
            && least <= way.asked * (1.0 + SAME)
        {
            // The feed of the CL file can stand as it is.
            return self.per_minute(feed / self.unit, length);
        }
        self.per_minute(length / minutes, length)
    }

    /// What a rapid takes at the least where the control has a feed for rapids, minutes.
    pub(super) fn rapid_minutes(&self, from: &Joints, block: &MotionBlock) -> f64 {
        self.rapid.map_or(0.0, |feed| self.measured(from, &block.joints, block.way) / feed)
    }

    /// The feed of a way of which only this is known: the tool comes linearly, the rotary axes standing.
    pub(super) fn approach(&self, feed: f64) -> (WrittenFeed, bool) {
        let allowed = feed.min(self.most);
        (self.per_minute(allowed / self.unit, 1.0), allowed < feed * (1.0 - SAME))
    }

    /// A feed of `value` a minute along `length`; where none so low is printed, the time of it, if there is a word for
    /// that.
    #[inline]
    fn per_minute(&self, value: f64, length: f64) -> WrittenFeed {
        let feed = self.feed.floor(value);
        if feed > 0.0 {
            return WrittenFeed {
                feed: Feed::PerMinute(feed),
                minutes: length / feed,
                raised_from: None,
                capped: false,
            };
        }
        self.too_low(value, length)
    }

    #[cold]
    fn too_low(&self, value: f64, length: f64) -> WrittenFeed {
        if let Some(printed) = self.inverse {
            let written = printed.inverse(value / length);
            if written.raised_from.is_none() {
                return written;
            }
        }
        let feed = self.least();
        WrittenFeed {
            feed: Feed::PerMinute(feed),
            minutes: length / feed,
            raised_from: Some(value),
            capped: false,
        }
    }

    /// The length that the control will divide by F, in the units of the program or degrees. A control that keeps the
    /// tip counts turns in degrees, where it counts them at all.
    pub(super) fn measured(&self, from: &Joints, to: &Joints, tip: f64) -> f64 {
        let travels = self.kinds.travels(from, to);
        let tip = tip / self.unit;
        let linear = travels.linear / self.unit;
        match (self.tcp, self.length) {
            (Tcp::Control, _) if self.tcp_length == TcpFeedLength::Combined => {
                libm::sqrt(tip * tip + travels.rotary * travels.rotary)
            }
            (Tcp::Control, _) if tip > SAME => tip,
            (Tcp::Control, _) => self.degrees.travels(from, to).rotary_longest,
            (Tcp::Post, FeedLength::Linear | FeedLength::LinearOrLongest) if linear > SAME => {
                linear
            }
            (Tcp::Post, FeedLength::Linear) => travels.rotary,
            (Tcp::Post, FeedLength::LinearOrLongest) => travels.rotary_longest,
            (Tcp::Post, FeedLength::Combined) => {
                libm::sqrt(linear * linear + travels.rotary * travels.rotary)
            }
            (Tcp::Post, FeedLength::Longest) => {
                (travels.linear_longest / self.unit).max(travels.rotary_longest)
            }
        }
    }
}

/// The linear axes stand square on one another whatever the rotary ones do, so that the root of the squares of their
/// ways is the way of the tool.
fn square(machine: &Machine) -> bool {
    let axes = &machine.axes;
    let sliding: Vec<usize> = (0..axes.len()).filter(|index| !axes[*index].joint.rotary).collect();
    let between = match (sliding.first(), sliding.last()) {
        (Some(first), Some(last)) => axes[*first..*last].iter().any(|axis| axis.joint.rotary),
        _ => false,
    };
    let across = |a: &usize, b: &usize| {
        let dot = axes[*a].joint.direction.dot(&axes[*b].joint.direction);
        a == b || dot.abs() < SAME
    };
    !between && sliding.iter().all(|a| sliding.iter().all(|b| across(a, b)))
}

/// How fast the tool can go in any direction, mm/min, so that no linear axis passes its largest feed.
fn most(machine: &Machine) -> f64 {
    let sliding = machine.axes.iter().filter(|axis| !axis.joint.rotary);
    let directions: Vec<_> = sliding.clone().map(|axis| axis.joint.direction).collect();
    // The control divides the ways of the axes themselves, or the way of the tip that they make together.
    let rows = match directions.as_slice() {
        [x, y, z] if machine.control.tcp == Tcp::Control => {
            Matrix3::from_columns(&[*x, *y, *z]).try_inverse()
        }
        _ => None,
    };
    let speeds = sliding.enumerate().map(|(row, axis)| {
        let share = rows.map_or(1.0, |rows| rows.row(row).norm());
        axis.max_feed / share
    });
    speeds.fold(f64::INFINITY, f64::min)
}

/// Numbers with a fixed number of decimals.
#[derive(Clone, Copy, Debug)]
struct DecimalFormat {
    /// Ten to the number of decimals.
    scale: f64,
    per_scale: f64,
    /// The largest of them.
    most: f64,
    /// Units that F counts, of those that it is one over, in a minute.
    per_minute: f64,
}

impl DecimalFormat {
    fn new(decimals: u8) -> Self {
        let scale = (0..decimals).fold(1.0, |scale, _| scale * 10.0);
        Self { scale, per_scale: 1.0 / scale, most: f64::INFINITY, per_minute: 1.0 }
    }

    /// Takes the number as one over a time of which a minute has `per_minute`.
    fn per(self, per_minute: f64) -> Self {
        Self { per_minute, ..self }
    }

    /// None above `most`.
    fn up_to(self, most: f64) -> Self {
        Self { most, ..self }
    }

    /// The largest printed number not above `value`, zero if none is.
    #[inline]
    fn floor(&self, value: f64) -> f64 {
        // A value that is a printed number but for its last bits is that number.
        (value * self.scale * (1.0 + 1e-12)).floor() * self.per_scale
    }

    /// `value` blocks a minute; the least printed number if it is below that.
    #[inline]
    fn inverse(&self, value: f64) -> WrittenFeed {
        let asked = value / self.per_minute;
        let printed = self.floor(asked.min(self.most));
        let feed = printed.max(self.per_scale);
        WrittenFeed {
            feed: Feed::InverseTime(feed),
            minutes: 1.0 / (feed * self.per_minute),
            raised_from: (printed <= 0.0).then_some(asked),
            capped: asked > self.most,
        }
    }
}
