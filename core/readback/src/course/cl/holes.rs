//! Holes: what a cycle does at a point becomes pieces.

use post_grammar::{Cycle, Record};
use post_machine::kinematics::Pose;

use super::feed::FeedWord;
use super::hole::Hole;
use super::modal::{Meant, Modal, Out};
use crate::course::Curve;
use crate::{CycleKind, MotionKind, Spindle, Told};

/// Ways shorter than this are none, mm.
const NONE: f64 = 1e-6;

impl Modal {
    pub(super) fn cycle_word(&mut self, record: &Record<'_>, cycle: &Cycle) -> Meant {
        match cycle {
            Cycle::Off => self.cycle = None,
            Cycle::On => self.cycle = self.last_cycle,
            Cycle::Define(definition) => {
                self.cycle = None;
                let hole = Hole::new(definition, self.scale);
                let hole = hole.map_err(|why| self.fault(record, why))?;
                let feed = match definition.feed {
                    Some(feed) => self.feed_word(record, feed)?,
                    // A thread's feed follows from its pitch.
                    None => match hole.pitch.filter(|_| hole.taps()) {
                        Some(pitch) => Some(FeedWord::PerRevolution(libm::fabs(pitch))),
                        None => self.feed.or(self.settings.feed.map(FeedWord::PerMinute)),
                    },
                };
                self.cycle = Some((hole, feed));
                self.last_cycle = self.cycle;
                self.measured = true;
            }
        }
        Ok(())
    }

    /// A hole at a pose: up to the level and aside, down to where the feed begins, in, and out to the level.
    pub(super) fn drill(
        &mut self,
        record: &Record<'_>,
        hole: Hole,
        feed: Option<FeedWord>,
        at: Pose,
        out: &mut Out,
    ) -> Meant {
        let feed = match (feed, hole.taps(), hole.pitch, self.tools.rpm()) {
            (_, true, Some(pitch), Some(rpm)) => Some(libm::fabs(pitch) * rpm),
            (Some(FeedWord::InverseTime(_)), ..) => {
                let message = "a cycle with a feed by time: of which of its ways?";
                return Err(self.fault(record, message.to_owned()));
            }
            (Some(word), ..) => self.per_minute(word, || None),
            (None, ..) => None,
        };
        let left = matches!(self.tools.spindle(), Spindle::CounterClockwise(_));
        let kind = match hole.kind {
            CycleKind::Tap if left => CycleKind::TapLeft,
            kind => kind,
        };
        let hole = Hole { kind, ..hole };
        if hole.taps() && hole.pitch.is_some_and(|pitch| pitch < 0.0) && !left {
            let message = "a left-hand thread, and the spindle turns right";
            return Err(self.fault(record, message.to_owned()));
        }
        let line = record.line;
        let height = |height: f64| Pose {
            tip: at.tip + at.axis * height,
            ..at
        };
        let rapid = (MotionKind::Rapid, None);
        // To the level above the hole: up before aside, aside before down.
        if let Some(from) = self.stands {
            let offset = from.tip - at.tip;
            let stands = at.axis.dot(&offset);
            let aside = offset - at.axis * stands;
            if aside.norm() > NONE {
                let up = stands.max(hole.level);
                if stands < hole.level {
                    let mut above = height(up);
                    above.tip += aside;
                    self.go(line, rapid, Curve::Straight, above, true, out);
                } else if stands > hole.level {
                    self.go(line, rapid, Curve::Straight, height(up), true, out);
                }
            }
        }
        self.go(line, rapid, Curve::Straight, height(hole.level), true, out);
        self.tell(record, Told::Cycle(hole.call(feed.unwrap_or(0.0))), out);
        if hole.level - hole.clearance > NONE {
            self.go(
                line,
                rapid,
                Curve::Straight,
                height(hole.clearance),
                true,
                out,
            );
        }
        let kind = match hole.taps() {
            true => MotionKind::Thread,
            false => MotionKind::Feed,
        };
        let pace = (kind, feed);
        self.go(line, pace, Curve::Straight, height(-hole.depth), true, out);
        let turns = hole.dwell_turns * 60.0 / self.tools.rpm().unwrap_or(f64::INFINITY);
        let time = hole.dwell + turns;
        if time > 0.0 {
            let revolutions = false;
            self.tell(record, Told::Dwell { time, revolutions }, out);
        }
        if hole.out_at_feed() {
            self.go(
                line,
                pace,
                Curve::Straight,
                height(hole.clearance),
                true,
                out,
            );
        }
        if !hole.out_at_feed() || hole.level - hole.clearance > NONE {
            self.go(line, rapid, Curve::Straight, height(hole.level), true, out);
        }
        self.tell(record, Told::CycleEnd, out);
        Ok(())
    }
}
