//! A hole of a cycle, and the strokes that make it.

use post_machine::diagnostic::Diagnostic;

use super::super::spindle_request::SpindleRequest;
use crate::{CycleCall, CycleKind};

/// Strokes that one hole may have: a peck that is tiny against the depth is refused.
const MOST: usize = 100_000;

/// Two levels nearer than this are one, mm.
pub(super) const SAME: f64 = 1e-9;

/// A hole: levels along the tool axis, in the coordinates of the words, mm; feeds in mm/min.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CycleHole {
    /// Kind of the cycle.
    pub kind: CycleKind,
    /// Where the feed begins.
    pub clearance: f64,
    /// The surface, where the cycle names it.
    pub surface: Option<f64>,
    /// Level of the bottom.
    pub bottom: f64,
    /// Where the tool stands when it is done.
    pub away: f64,
    /// Feed down.
    pub feed: f64,
    /// The cycle states its feed itself, or the pitch that it follows from: that of the program does not matter.
    pub own_feed: bool,
    /// Feed of the first peck against the others.
    pub first_share: Option<f64>,
    /// Whether the feed, or that of a thread, is stated by the revolution.
    pub per_revolution: bool,
    /// The way back to the clearance.
    pub out: Withdrawal,
    /// Whether that way leads to where the tool stands when it is done, not to the clearance alone.
    pub out_all: bool,
    /// Pecks; none: in one go.
    pub pecks: Option<Pecking>,
    /// Wait at the bottom.
    pub wait: HoleDwell,
    /// Way off the wall before the way out: along the first and second direction of the plane and along the axis, mm.
    pub lift: [f64; 3],
    /// The operator draws the tool out, or is asked to: the program stops at the bottom.
    pub stop: bool,
    /// How the cycle itself turns the spindle in the hole and after it; none: it leaves it as it is.
    pub turning: Option<[SpindleRequest; 2]>,
}

/// How the tool comes back to the clearance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Withdrawal {
    /// The tool comes back at rapid.
    #[default]
    Rapid,
    /// The tool comes back at this feed, mm/min.
    Feed(f64),
    /// Along the thread, at this feed, mm/min.
    Thread(f64),
}

/// A wait.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HoleDwell {
    /// Seconds, or turns of the spindle.
    pub time: f64,
    /// Whether the time is in turns.
    pub revolutions: bool,
}

impl HoleDwell {
    /// A wait of `time` seconds.
    pub fn seconds(time: f64) -> Self {
        Self { time, revolutions: false }
    }
}

/// How a hole is made in steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pecking {
    /// Depth of the first peck, mm.
    pub first: f64,
    /// Decrease from each peck to the next, mm.
    pub less: f64,
    /// Least peck, mm.
    pub least: f64,
    /// What is left for the last two is halved.
    pub halved: bool,
    /// Pecks after which the tool comes out of the hole, 1 for each; 0: never.
    pub out_after: u32,
    /// Out of the hole it goes at this feed; none: at rapid.
    pub out_feed: Option<f64>,
    /// How far it is drawn back where it does not come out, mm.
    pub back: f64,
    /// Coming in again it goes at rapid up to so far above the depth that was reached, mm.
    pub ahead: f64,
    /// Wait at the depth of each.
    pub wait: HoleDwell,
    /// Wait outside of the hole.
    pub wait_out: HoleDwell,
    /// The pecks are threads: in, and out again with the spindle turning back.
    pub thread: bool,
}

/// A stroke of a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum HoleStroke {
    /// A move at rapid to a level.
    Rapid(f64),
    /// A move at feed to a level: level, mm/min.
    Feed(f64, f64),
    /// A move tied to the spindle to a level: level, mm/min.
    Thread(f64, f64),
    /// A move at rapid to the side, along the plane's directions and the axis, mm.
    Aside([f64; 3]),
    /// A wait.
    Wait(HoleDwell),
    /// The program stops.
    Stop,
}

impl CycleHole {
    /// The cycle as it is reported.
    pub fn call(&self) -> CycleCall {
        CycleCall {
            kind: self.kind,
            depth: libm::fabs(self.clearance - self.bottom),
            clearance: self.surface.map_or(0.0, |surface| libm::fabs(self.clearance - surface)),
            peck: self.pecks.map_or(0.0, |pecks| pecks.first),
            later_peck: 0.0,
            dwell: if self.wait.revolutions { 0.0 } else { self.wait.time },
            feed: self.feed,
            per_revolution: self.per_revolution,
        }
    }

    /// Strokes of the hole, with the tool at the level `from` over it.
    ///
    /// # Errors
    /// Its pecks are too many, or lead nowhere.
    pub fn strokes(&self, from: f64) -> Result<Vec<HoleStroke>, Box<Diagnostic>> {
        let mut strokes = Vec::new();
        if libm::fabs(from - self.clearance) > SAME {
            strokes.push(HoleStroke::Rapid(self.clearance));
        }
        if self.pecks.is_some_and(|pecks| pecks.first < self.depth() - SAME) {
            self.in_pecks(&mut strokes)?;
        } else {
            let feed = self.feed * self.first_share.unwrap_or(1.0);
            strokes.push(self.down(self.bottom, feed));
        }
        if self.wait.time > 0.0 {
            strokes.push(HoleStroke::Wait(self.wait));
        }
        if self.stop {
            strokes.push(HoleStroke::Stop);
        }
        let lifted = self.lift != [0.0; 3];
        if lifted {
            strokes.push(HoleStroke::Aside(self.lift));
        }
        match self.out {
            Withdrawal::Rapid if lifted => {}
            Withdrawal::Rapid => return Ok(self.ended(strokes)),
            Withdrawal::Feed(feed) => strokes.push(HoleStroke::Feed(self.out_level(), feed)),
            Withdrawal::Thread(feed) => strokes.push(HoleStroke::Thread(self.out_level(), feed)),
        }
        let mut strokes = self.ended(strokes);
        if lifted {
            let [x, y, _] = self.lift;
            strokes.push(HoleStroke::Aside([-x, -y, 0.0]));
        }
        Ok(strokes)
    }

    fn ended(&self, mut strokes: Vec<HoleStroke>) -> Vec<HoleStroke> {
        let stands = match strokes.last() {
            Some(
                HoleStroke::Feed(level, _)
                | HoleStroke::Thread(level, _)
                | HoleStroke::Rapid(level),
            ) => Some(*level),
            _ => None,
        };
        if stands.is_none_or(|level| libm::fabs(level - self.away) > SAME) {
            strokes.push(HoleStroke::Rapid(self.away));
        }
        strokes
    }

    fn out_level(&self) -> f64 {
        if self.out_all { self.away } else { self.clearance }
    }

    fn depth(&self) -> f64 {
        libm::fabs(self.bottom - self.pecked_from())
    }

    /// Pecks count from here.
    fn pecked_from(&self) -> f64 {
        // Controls that name the surface count from it.
        self.surface.unwrap_or(self.clearance)
    }

    /// 1 where the hole goes up, else -1.
    fn sign(&self) -> f64 {
        if self.bottom > self.clearance { 1.0 } else { -1.0 }
    }

    fn down(&self, level: f64, feed: f64) -> HoleStroke {
        let thread = matches!(self.out, Withdrawal::Thread(_))
            || self.pecks.is_some_and(|pecks| pecks.thread);
        match thread {
            true => HoleStroke::Thread(level, feed),
            false => HoleStroke::Feed(level, feed),
        }
    }

    fn in_pecks(&self, strokes: &mut Vec<HoleStroke>) -> Result<(), Box<Diagnostic>> {
        let Some(pecks) = self.pecks else {
            return Ok(());
        };
        let sign = self.sign();
        let start = self.pecked_from();
        let depth = self.depth();
        let (mut reached, mut step) = (0.0, pecks.first);
        let mut inside = 0;
        loop {
            let left = depth - reached;
            let goes = match pecks.halved && reached > 0.0 {
                true if left <= step + SAME => left,
                true if left < 2.0 * step => left / 2.0,
                _ => libm::fmin(step, left),
            };
            if goes <= SAME || strokes.len() > MOST {
                return Err(Diagnostic::error(
                    "nc-cycle",
                    format!("a hole of {depth} mm in pecks from {} mm on, {} mm less each: they do not come to its bottom", pecks.first, pecks.less),
                )
                .boxed());
            }
            let feed = match reached == 0.0 {
                true => self.feed * self.first_share.unwrap_or(1.0),
                false => self.feed,
            };
            reached += goes;
            if depth - reached <= SAME {
                strokes.push(self.down(self.bottom, feed));
                return Ok(());
            }
            let level = start + sign * reached;
            strokes.push(self.down(level, feed));
            if pecks.wait.time > 0.0 {
                strokes.push(HoleStroke::Wait(pecks.wait));
            }
            inside += 1;
            if pecks.out_after > 0 && inside >= pecks.out_after {
                inside = 0;
                strokes.push(match (pecks.out_feed, pecks.thread) {
                    (Some(feed), _) => HoleStroke::Feed(self.clearance, feed),
                    (None, true) => HoleStroke::Thread(self.clearance, feed),
                    (None, false) => HoleStroke::Rapid(self.clearance),
                });
                if pecks.wait_out.time > 0.0 {
                    strokes.push(HoleStroke::Wait(pecks.wait_out));
                }
                let again = level - sign * pecks.ahead;
                // Not above where it stands.
                if !pecks.thread && (again - self.clearance) * sign > 0.0 {
                    strokes.push(HoleStroke::Rapid(again));
                }
            } else if pecks.back > 0.0 {
                let back = level - sign * pecks.back;
                // Not out of the hole.
                let back = if (back - self.clearance) * sign > 0.0 { back } else { self.clearance };
                strokes.push(match pecks.thread {
                    true => HoleStroke::Thread(back, feed),
                    false => HoleStroke::Rapid(back),
                });
            }
            step = libm::fmax(step - pecks.less, libm::fmax(pecks.least, 0.0));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drilled(pecks: Option<Pecking>) -> Vec<HoleStroke> {
        let hole = CycleHole {
            clearance: 2.0,
            bottom: -10.0,
            away: 20.0,
            feed: 100.0,
            pecks,
            ..CycleHole::default()
        };
        hole.strokes(20.0).unwrap()
    }

    #[test]
    fn a_plain_hole_goes_in_and_out() {
        use HoleStroke::{Feed, Rapid};
        assert_eq!(drilled(None), [Rapid(2.0), Feed(-10.0, 100.0), Rapid(20.0)]);
    }

    #[test]
    fn pecks_come_out_or_break_the_chip() {
        use HoleStroke::{Feed, Rapid};
        let out =
            Pecking { first: 5.0, least: 5.0, out_after: 1, ahead: 0.5, ..Pecking::default() };
        let strokes = [
            Rapid(2.0),
            Feed(-3.0, 100.0),
            Rapid(2.0),
            Rapid(-2.5),
            Feed(-8.0, 100.0),
            Rapid(2.0),
            Rapid(-7.5),
            Feed(-10.0, 100.0),
            Rapid(20.0),
        ];
        assert_eq!(drilled(Some(out)), strokes);
        let breaks = Pecking { first: 5.0, least: 5.0, back: 1.0, ..Pecking::default() };
        let strokes = [
            Rapid(2.0),
            Feed(-3.0, 100.0),
            Rapid(-2.0),
            Feed(-8.0, 100.0),
            Rapid(-7.0),
            Feed(-10.0, 100.0),
            Rapid(20.0),
        ];
        assert_eq!(drilled(Some(breaks)), strokes);
    }

    #[test]
    fn pecks_that_grow_less_and_never_end_are_refused() {
        let hole = CycleHole {
            bottom: -100.0,
            feed: 1.0,
            pecks: Some(Pecking { first: 5.0, less: 1.0, ..Pecking::default() }),
            ..CycleHole::default()
        };
        assert!(hole.strokes(0.0).is_err());
    }

    #[test]
    fn the_bottom_is_reached_whatever_the_pecks() {
        // Brute force over pecks, decrements and halves: each goes down from where it was left, and ends at the bottom.
        for first in 1..40_u32 {
            for less in 0..4_u32 {
                for halved in [false, true] {
                    let pecks = Pecking {
                        first: f64::from(first) * 0.3,
                        less: f64::from(less) * 0.2,
                        least: 0.25,
                        halved,
                        out_after: first % 3,
                        back: 0.2,
                        ahead: 0.3,
                        ..Pecking::default()
                    };
                    let strokes = drilled(Some(pecks));
                    let mut deepest = 2.0;
                    let mut at = 20.0;
                    for stroke in &strokes {
                        match *stroke {
                            HoleStroke::Feed(level, _) => {
                                assert!(
                                    at >= deepest - 1e-9,
                                    "air is fed through, never rapid through the part"
                                );
                                deepest = f64::min(deepest, level);
                                at = level;
                            }
                            HoleStroke::Rapid(level) => {
                                assert!(level >= deepest - 1e-9, "a rapid below what is drilled");
                                at = level;
                            }
                            _ => {}
                        }
                    }
                    assert_eq!((deepest, at), (-10.0, 20.0));
                }
            }
        }
    }
}
