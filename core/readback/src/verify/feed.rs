//! The feed of a cut: never above what is asked, and below it only where something limits it.

use std::borrow::Cow;

use post_machine::check::number;

use super::Verifier;
use super::feed_sum::FeedTime;
use super::place::{ToolPlace, free, way_of};
use super::state::{PLACE, SHARE, SHORT};
use super::track::Element;
use crate::course::Course;
use crate::{Interpolation, Motion, MotionKind};

/// No printed feed is less than a tenth of what it should be by its last place.
const MOST_ROUNDED: f64 = 0.9;

/// Rounding of the ends of a way, mm.
pub(super) const ROUNDED: f64 = 0.003;

impl<C: Course> Verifier<'_, C> {
    /// Whether the feed is as asked, mm/min, if one is, or something limits it, which is noted then.
    pub(super) fn keeps_feed(
        &mut self,
        motion: &Motion,
        places: &[ToolPlace],
        asked: Option<f64>,
    ) -> bool {
        let Some(asked) = asked.filter(|asked| !self.is_as_fast_as_asked(motion, places, *asked))
        else {
            return true;
        };
        if motion.feed > asked {
            return false;
        }
        match self.feed_verdict(motion, places, asked) {
            FeedVerdict::AsAsked => {
                self.sum_feed(motion, places, asked, None);
                true
            }
            FeedVerdict::Limited(limit) => {
                self.note_limit(limit);
                true
            }
            FeedVerdict::None | FeedVerdict::Above(_) | FeedVerdict::Below(_) => false,
        }
    }

    /// Whether the feed is that which is asked for, mm/min, but for what is rounded in any case:
    /// [`Verifier::compare_feed`] allows for more.
    fn is_as_fast_as_asked(&self, motion: &Motion, places: &[ToolPlace], asked: f64) -> bool {
        if motion.feed > asked || motion.minutes <= 0.0 {
            return false;
        }
        let feed = way_of(places) / motion.minutes;
        let [above, below] = self.last_places(motion);
        feed <= asked * (1.0 + SHARE) + above && feed >= asked * (1.0 - SHARE) - below
    }

    /// What the last place of a feed makes upwards and downwards, mm/min: that of a time is a share of it.
    fn last_places(&self, motion: &Motion) -> [f64; 2] {
        match motion.by_time {
            true => [0.0; 2],
            false => [PLACE, self.rules.feed_place.max(PLACE)],
        }
    }

    /// The feed of an element, or of another that a motion lies on as a whole, if that is larger: what is left of a
    /// piece at a corner is within the tolerance of the next.
    pub(super) fn feed_of(&self, places: &[ToolPlace], element: &Element) -> Option<f64> {
        let feed = element.feed?;
        let last = self.reach.iter().rposition(|span| !span.is_empty())?;
        let [first, middle, end] = [0, places.len() / 2, places.len() - 1].map(|at| &places[at]);
        let ahead = end.point - first.point;
        let on = |other: &&Element| {
            let free = |place: &ToolPlace| free(place, &other.from, &other.to, &self.bound);
            let forward = ahead.dot(&(other.to.point - other.from.point)) >= 0.0;
            let whole = [first, middle, end].iter().all(|place| !free(place).is_empty());
            other.is_cut() && forward && whole
        };
        let kept = self.track.kept().iter().take(last + 1);
        let feeds = kept.filter(on).filter_map(|other| other.feed);
        Some(feeds.fold(feed, f64::max))
    }

    /// Compares the feed: never faster than asked, and slower only where an axis could not go faster.
    pub(super) fn compare_feed(
        &mut self,
        motion: &Motion,
        places: &[ToolPlace],
        element: &Element,
    ) {
        let Some(asked) = element.feed.or_else(|| turned_feed(motion, element)) else {
            return;
        };
        match self.feed_verdict(motion, places, asked) {
            FeedVerdict::AsAsked => self.sum_feed(motion, places, asked, Some(element.line)),
            FeedVerdict::Limited(limit) => self.note_limit(limit),
            FeedVerdict::None => {
                let message = "cuts without a feed".to_owned();
                self.fault("feed", message, Some(motion), Some(element.line), None);
            }
            FeedVerdict::Above(feed) => {
                let message =
                    format!("the feed is above that of the CL file, {} mm/min", number(asked, 3));
                let told = format!("{message}: {feed:.1} mm/min");
                self.limit_fault("feed", message, told, motion, element.line, feed - asked);
            }
            FeedVerdict::Below(feed) => {
                self.found.slower += 1;
                let message = format!(
                    "the feed is below that of the CL file, {} mm/min, and no axis asks for that",
                    number(asked, 3)
                );
                let told = format!("{message}: {feed:.1} mm/min");
                self.limit_fault("feed", message, told, motion, element.line, asked - feed);
            }
        }
    }

    /// A cut is slower than asked, and that is right.
    fn note_limit(&mut self, limit: FeedLimit) {
        self.found.limited += 1;
        self.block.limited_by = Some(match limit {
            FeedLimit::Axis(joint) => {
                Cow::Owned(format!("max_feed of {}", self.machine.mover(joint)))
            }
            FeedLimit::Time => Cow::Borrowed("the largest feed by time"),
            FeedLimit::Plan => Cow::Borrowed("the planned feed"),
        });
    }

    /// What is to be said of the feed of a motion where `asked` is asked for, mm/min.
    fn feed_verdict(&self, motion: &Motion, places: &[ToolPlace], asked: f64) -> FeedVerdict {
        let way = way_of(places);
        if way < SHORT {
            return FeedVerdict::AsAsked;
        }
        if motion.minutes <= 0.0 {
            return match motion.kind {
                MotionKind::Feed => FeedVerdict::None,
                _ => FeedVerdict::AsAsked,
            };
        }
        let feed = way / motion.minutes;
        let rounded = self.rounded_share(motion, way);
        let counted = self.least_way(motion, places, way);
        let [above, place] = self.last_places(motion);
        if counted / motion.minutes > asked * (1.0 + SHARE + rounded) + above {
            return FeedVerdict::Above(feed);
        }
        if feed >= asked * (1.0 - SHARE - rounded) - place {
            return FeedVerdict::AsAsked;
        }
        self.slower_for(motion, way).map_or(FeedVerdict::Below(feed), FeedVerdict::Limited)
    }

    /// What lets a motion that goes `way` mm be slower than asked, if anything does.
    fn slower_for(&self, motion: &Motion, way: f64) -> Option<FeedLimit> {
        let [_, place] = self.last_places(motion);
        // An axis is as fast as it may be where the motion is fastest.
        let quick = motion.minutes_at_fastest;
        match self.axes.least_minutes(self.machine, motion, 0.0) {
            // Of a slow feed the last place is much, and it is rounded down.
            Some((minutes, joint))
                if quick <= minutes * 1.05 || way / quick + 2.0 * place >= 0.95 * way / minutes =>
            {
                Some(FeedLimit::Axis(joint))
            }
            _ if motion.minutes <= self.rules.least_minutes * (1.0 + SHARE) => {
                Some(FeedLimit::Time)
            }
            _ => self.rules.planned.then_some(FeedLimit::Plan),
        }
    }

    /// The shortest way by which the time of a motion that goes `way` mm may have been counted, mm: where rotary axes turn
    /// the tip goes in a bow about it, out and back by the tolerance, and no more.
    fn least_way(&self, motion: &Motion, places: &[ToolPlace], way: f64) -> f64 {
        match turns(motion) {
            true => chord_of(places).max(way - 2.0 * self.rules.tolerance),
            false => way,
        }
    }

    /// Counts a motion among those of its cut that rounded words alone let pass, if it is one: its time by itself proves
    /// nothing.
    fn sum_feed(
        &mut self,
        motion: &Motion,
        places: &[ToolPlace],
        asked: f64,
        cl_line: Option<u64>,
    ) {
        let way = way_of(places);
        // Of a plan those that rounding makes slower are no fewer, and cannot be told from what the plan holds up.
        let nothing = way < SHORT || motion.minutes <= 0.0 || self.rules.planned;
        if nothing || self.is_as_fast_as_asked(motion, places, asked) {
            return;
        }
        if way / motion.minutes < asked && self.slower_for(motion, way).is_some() {
            return;
        }
        // Where axes turn about a tip that stands the feed counts degrees, and the points that a time was counted by are
        // within the tolerance of those that the tip comes to.
        let turned = if turns(motion) { self.rules.tolerance } else { 0.0 };
        if chord_of(places) < 2.0 * turned {
            return;
        }
        let [above, below] = self.printed_shares(motion);
        let time = FeedTime {
            taken: motion.minutes,
            asked: [self.least_way(motion, places, way) / asked, (way + turned) / asked],
            printed: [above * motion.minutes, below * motion.minutes],
            way,
            per_mm: 1.0 / asked,
        };
        self.sum_feeds(motion, &time, cl_line);
    }

    /// Share of the time of a motion that the last place of its printed feed makes, upwards and downwards.
    fn printed_shares(&self, motion: &Motion) -> [f64; 2] {
        if motion.by_time {
            return [(self.rules.time_place * motion.minutes).min(MOST_ROUNDED); 2];
        }
        let along = match motion.way {
            Interpolation::Axes => printed_way(motion).max(1e-6),
            _ => motion.feed * motion.minutes,
        };
        self.last_places(motion).map(|place| (place * motion.minutes / along).min(MOST_ROUNDED))
    }

    /// Share of the feed of a motion that goes `way` mm which rounded words make.
    fn rounded_share(&self, motion: &Motion, way: f64) -> f64 {
        // Of a short way a rounded word is much.
        let mut rounded = ROUNDED / way;
        if motion.by_time {
            rounded += (self.rules.time_place * motion.minutes).min(MOST_ROUNDED);
        }
        if motion.way == Interpolation::Axes {
            // What is printed is the feed along the axes, which may go a much shorter way than the tip; of rotary axes alone
            // it counts degrees. Rounded down, so that it is never above what is asked.
            if !motion.by_time {
                let along = printed_way(motion).max(1e-6);
                rounded += (2.0 * PLACE * motion.minutes / along).min(MOST_ROUNDED);
            }
            // Where rotary axes turn the tip goes another way than the points that its time was counted by, within the
            // tolerance.
            if turns(motion) {
                rounded += 2.0 * self.rules.tolerance / way;
            }
        }
        rounded
    }
}

/// The straight way from one end to the other, mm.
fn chord_of(places: &[ToolPlace]) -> f64 {
    (places[places.len() - 1].point - places[0].point).norm()
}

/// Whether all axes go evenly, and rotary ones turn.
fn turns(motion: &Motion) -> bool {
    let turned = |joint: usize| motion.to.joints[joint] != motion.from.joints[joint];
    let chain = motion.state.solver.chain().joints();
    motion.way == Interpolation::Axes
        && (0..chain.len()).any(|joint| chain[joint].rotary && turned(joint))
}

/// The way that a feed a minute counts, mm; degrees where no linear axis moves.
fn printed_way(motion: &Motion) -> f64 {
    let [mut linear, mut rotary] = [0.0; 2];
    for (index, joint) in motion.state.solver.chain().joints().iter().enumerate() {
        let way = motion.to.joints[index] - motion.from.joints[index];
        match joint.rotary {
            true => rotary += way * way,
            false => linear += way * way,
        }
    }
    match linear > 0.0 {
        true => linear.sqrt(),
        false => rotary.sqrt().to_degrees(),
    }
}

/// The feed that an element asks for in a revolution of the part, mm/min as fast as the part turns on the motion.
fn turned_feed(motion: &Motion, element: &Element) -> Option<f64> {
    let ends = [motion.from.pose.tip, motion.to.pose.tip];
    let [rpm, _] = motion.state.spindle.surface_rpm(ends)?;
    Some(element.turned_feed? * rpm)
}

/// What limits a feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FeedLimit {
    /// The axis at this place of the machine.
    Axis(usize),
    /// The largest feed by time.
    Time,
    /// The plan that the feed was made by.
    Plan,
}

/// What is to be said of a feed, mm/min.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FeedVerdict {
    AsAsked,
    /// The program states none.
    None,
    /// Faster than asked.
    Above(f64),
    /// Slower than asked, and that is right.
    Limited(FeedLimit),
    /// Slower than asked.
    Below(f64),
}
