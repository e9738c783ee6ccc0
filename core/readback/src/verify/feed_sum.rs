//! The feeds of short blocks as a whole: rounded words make much of the way of one, and next to nothing of that of many.

use super::Verifier;
use super::feed::ROUNDED;
use super::state::SHARE;
use crate::Motion;
use crate::course::Course;

/// Errors of many rounded ways, each within its bound and of either sign, come together to no more than this times the root
/// of the sum of their squares.
const SPREAD: f64 = 2.0;

/// How long a motion at feed takes beside what is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct FeedTime {
    /// What it takes, min.
    pub taken: f64,
    /// What is asked for, by the shortest and by the longest way that may count, min.
    pub asked: [f64; 2],
    /// What the last place of the printed feed makes of it, upwards and downwards, min.
    pub printed: [f64; 2],
    /// The way, mm.
    pub way: f64,
    /// What a mm of it takes, min.
    pub per_mm: f64,
}

/// Times of the blocks of a cut whose feeds rounding alone lets pass.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FeedSum {
    taken: f64,
    asked: [f64; 2],
    printed: [f64; 2],
    /// Sum of the squares of what rounded ends make, min².
    spread: f64,
    /// What rounding makes longer, a little with each block, min.
    longer: f64,
}

impl FeedSum {
    fn take(&mut self, time: &FeedTime) {
        self.taken += time.taken;
        for side in 0..2 {
            self.asked[side] += time.asked[side];
            self.printed[side] += time.printed[side];
        }
        let rounded = ROUNDED * time.per_mm;
        self.spread += rounded * rounded;
        // An end aside by r makes a way w longer by r²/2w, whichever side it is.
        self.longer += rounded * (0.5 * ROUNDED / time.way).min(1.0);
    }

    /// How many times as fast as asked the blocks are together, if rounding does not make them so.
    fn off(&self) -> Option<f64> {
        let slack = SPREAD * self.spread.sqrt() + self.longer;
        let [shortest, longest] = self.asked;
        let [faster, slower] = self.printed;
        if self.taken + slack + faster < shortest * (1.0 - SHARE) {
            return Some(shortest / self.taken);
        }
        (self.taken - slack - slower > longest * (1.0 + SHARE)).then(|| longest / self.taken)
    }
}

impl<C: Course> Verifier<'_, C> {
    /// Adds a motion whose feed is as asked but for its rounded words, and tells where those before it in the cut are off
    /// together.
    pub(super) fn sum_feeds(&mut self, motion: &Motion, time: &FeedTime, cl_line: Option<u64>) {
        self.feeds.take(time);
        let Some(times) = self.feeds.off() else {
            return;
        };
        self.feeds = FeedSum::default();
        let side = if times > 1.0 { "above" } else { "below" };
        let message =
            format!("the feed of short blocks is {side} that of the CL file, taken together");
        let told = format!("{message}: {times:.2} times it");
        self.limit_fault("feed", message, told, motion, cl_line.unwrap_or(0), (times - 1.0).abs());
    }
}
