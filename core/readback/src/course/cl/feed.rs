//! Feed words.

use post_grammar::{FeedRate, FeedUnit, Record, Units};
use post_machine::diagnostic::Diagnostic;

use super::modal::{ClModal, millimetres};

/// A feed as the file states it, in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum FeedWord {
    /// mm/min.
    PerMinute(f64),
    /// mm a turn of the spindle, whose speed at the move counts.
    PerRevolution(f64),
    /// The move takes 1/F minutes.
    InverseTime(f64),
}

impl ClModal {
    /// A feed word; none where the file writes 0 for want of one, and the user names a feed.
    pub(super) fn feed_word(
        &mut self,
        record: &Record<'_>,
        feed: FeedRate,
    ) -> Result<Option<FeedWord>, Box<Diagnostic>> {
        let value = feed.value.unwrap_or(0.0);
        if value <= 0.0 {
            return match self.settings.feed {
                Some(feed) if value == 0.0 => Ok(Some(FeedWord::PerMinute(feed))),
                _ => Err(self.fault(record, format!("a feed of {value}: it must be above zero"))),
            };
        }
        self.measured = true;
        let (metric, inch) = (Units::Millimetre, Units::Inch);
        Ok(Some(match feed.unit {
            None | Some(FeedUnit::PerMinute) => FeedWord::PerMinute(value * self.scale),
            Some(FeedUnit::MillimetresPerMinute) => {
                FeedWord::PerMinute(value * self.length(metric))
            }
            Some(FeedUnit::InchesPerMinute) => FeedWord::PerMinute(value * self.length(inch)),
            Some(FeedUnit::PerRevolution) => FeedWord::PerRevolution(value * self.scale),
            Some(FeedUnit::MillimetresPerRevolution) => {
                FeedWord::PerRevolution(value * self.length(metric))
            }
            Some(FeedUnit::InchesPerRevolution) => {
                FeedWord::PerRevolution(value * self.length(inch))
            }
            Some(FeedUnit::InverseTime) => FeedWord::InverseTime(value),
            Some(FeedUnit::Rapid) => return Ok(None),
        }))
    }

    /// mm in the unit that a feed word names. Where the user says that the file is wrong about its units, so are the feed
    /// words that agree with what it says.
    fn length(&self, word: Units) -> f64 {
        let inch = |units| matches!(units, Units::Inch | Units::Foot);
        match (self.settings.units, self.units) {
            (Some(told), Some(said)) if inch(said) == inch(word) => millimetres(told),
            _ => millimetres(word),
        }
    }

    /// A feed in mm/min, as the spindle turns and over the way of the move; none where one of them is not known.
    pub(super) fn per_minute(
        &self,
        feed: FeedWord,
        way: impl FnOnce() -> Option<f64>,
    ) -> Option<f64> {
        match feed {
            FeedWord::PerMinute(feed) => Some(feed),
            FeedWord::PerRevolution(feed) => Some(feed * self.tools.rpm()?),
            FeedWord::InverseTime(moves) => Some(way()? * moves),
        }
    }
}
