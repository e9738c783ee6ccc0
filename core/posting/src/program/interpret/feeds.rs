//! Feed words.

use post_grammar::{FeedRate, FeedUnit, Record, Units};

use super::{ClInterpreter, ModalFeed, millimetres};
use crate::program::MoveFeed;
use crate::program::limits::{FEEDS, FEEDS_A_TURN, FEEDS_BY_TIME};
use post_machine::diagnostic::Short;

impl ClInterpreter {
    /// A feed word as the spindle turns now.
    #[inline]
    pub(super) fn resolved(&mut self, record: &Record<'_>, feed: ModalFeed) -> Option<MoveFeed> {
        if !self.spindle.may_cut {
            self.cut_standing(record);
        }
        match (feed, self.spindle.rpm) {
            (ModalFeed::Pace(pace), _) => Some(pace),
            (ModalFeed::PerRevolution(feed), Some(rpm)) if rpm > 0.0 => {
                self.in_range(record, (feed * rpm, FEEDS, "mm/min")).map(MoveFeed::PerMinute)
            }
            (ModalFeed::PerRevolution(_), _) => {
                let (message, help) = match self.spindle.surface_speed {
                    Some(_) => (
                        "a feed per revolution at a constant cutting speed: how many revolutions a minute that is nobody knows here",
                        "a program without a planned feed (--plan); or a feed a minute (MMPM, IPM), or the speed in revolutions (RPM)",
                    ),
                    None => (
                        "a feed per revolution needs a spindle speed",
                        "put a SPINDL before it, or say --spindle RPM",
                    ),
                };
                self.fault(record, "feed", message.to_owned(), help);
                None
            }
        }
    }

    /// A feed of so many mm a revolution of the part, which the control keeps.
    pub(super) fn turned_feed(&mut self, record: &Record<'_>, feed: f64) -> Option<MoveFeed> {
        let turns = self.spindle.surface_speed.is_some() || self.spindle.rpm.is_some();
        if !turns {
            return self.resolved(record, ModalFeed::PerRevolution(feed));
        }
        if !self.spindle.may_cut {
            self.cut_standing(record);
        }
        if std::mem::take(&mut self.tools.threads) {
            self.fault(
                record,
                "thread",
                "a cut with a tool for threads (TLDATA/THREAD): a move at a feed does not begin at the same angle of the spindle in each pass"
                    .to_owned(),
                "the thread by the control's own words: [cl.words] in the machine file gives its lines",
            );
        }
        Some(MoveFeed::PerRevolution(feed))
    }

    /// The feed of cuts that the file gives none.
    pub(super) fn told_feed(&self) -> Option<ModalFeed> {
        let feed = self.reading.feed?;
        Some(ModalFeed::Pace(MoveFeed::PerMinute(feed)))
    }

    pub(super) fn set_feed(&mut self, record: &Record<'_>, feed: FeedRate) {
        self.rapid_feed = feed.unit == Some(FeedUnit::Rapid);
        if self.rapid_feed {
            return;
        }
        if let Some(pace) = self.feed_word(record, feed) {
            self.feed = Some(pace);
        }
    }

    /// A feed in mm.
    pub(super) fn feed_word(&mut self, record: &Record<'_>, feed: FeedRate) -> Option<ModalFeed> {
        let value = feed.value.unwrap_or(0.0);
        if value <= 0.0 {
            // CAM systems write 0 where no feed was given.
            let told = self.told_feed().filter(|_| value == 0.0);
            if told.is_none() {
                self.fault(
                    record,
                    "feed",
                    format!("a feed of {}: it must be above zero", Short(value)),
                    "the CAM system must write one; --feed MM_A_MINUTE stands for a feed of 0",
                );
            }
            return told;
        }
        self.measured = true;
        // Where the units are overridden, a word of the units that the file declares goes with its lengths.
        let length = |this: &Self, units: Units| match (this.reading.units, this.units) {
            (Some(told), Some(declared)) if is_inch(declared) == is_inch(units) => {
                millimetres(told)
            }
            _ => millimetres(units),
        };
        let (per_revolution, scale) = match feed.unit {
            None | Some(FeedUnit::PerMinute) => (false, self.scale),
            Some(FeedUnit::MillimetresPerMinute) => {
                self.feed_units = Some(Units::Millimetre);
                (false, length(self, Units::Millimetre))
            }
            Some(FeedUnit::InchesPerMinute) => {
                self.feed_units = Some(Units::Inch);
                (false, length(self, Units::Inch))
            }
            Some(FeedUnit::PerRevolution) => (true, self.scale),
            Some(FeedUnit::MillimetresPerRevolution) => (true, length(self, Units::Millimetre)),
            Some(FeedUnit::InchesPerRevolution) => (true, length(self, Units::Inch)),
            Some(FeedUnit::InverseTime) => {
                return self
                    .in_range(record, (value, FEEDS_BY_TIME, "moves a minute"))
                    .map(|feed| ModalFeed::Pace(MoveFeed::InverseTime(feed)));
            }
            Some(FeedUnit::Rapid) => return Some(ModalFeed::Pace(MoveFeed::Rapid)),
        };
        let feed = value * scale;
        if per_revolution {
            return self
                .in_range(record, (feed, FEEDS_A_TURN, "mm a revolution"))
                .map(ModalFeed::PerRevolution);
        }
        self.in_range(record, (feed, FEEDS, "mm/min"))
            .map(|feed| ModalFeed::Pace(MoveFeed::PerMinute(feed)))
    }

    /// The value, if it lies within its limits; else a fault.
    fn in_range(
        &mut self,
        record: &Record<'_>,
        (value, [least, most], unit): (f64, [f64; 2], &str),
    ) -> Option<f64> {
        if (least..=most).contains(&value) {
            return Some(value);
        }
        let message = format!(
            "a feed of {} {unit}: from {} to {} {unit} is possible",
            Short(value),
            Short(least),
            Short(most)
        );
        self.fault(record, "feed", message, "let the CAM system write another");
        None
    }
}

fn is_inch(units: Units) -> bool {
    matches!(units, Units::Inch | Units::Foot)
}
