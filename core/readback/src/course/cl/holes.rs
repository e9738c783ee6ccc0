//! Holes: what a cycle does at a point becomes pieces.

use post_grammar::{Cycle, CycleDefinition, Record};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;

use super::feed::FeedWord;
use super::hole::ClHole;
use super::modal::{ActiveCycle, ClModal, CourseItems, MotionFeed, RecordResult};
use crate::course::Curve;
use crate::{CycleKind, MotionKind, ProgramEvent, SpindleState};

/// Ways shorter than this are none, mm.
const NONE: f64 = 1e-6;

impl ClModal {
    pub(super) fn cycle_word(&mut self, record: &Record<'_>, cycle: &Cycle) -> RecordResult {
        match cycle {
            Cycle::Off => self.cycle = None,
            Cycle::On => self.cycle = self.last_cycle,
            Cycle::Define(definition) => {
                self.cycle = None;
                let hole = self.hole(record, definition)?;
                let feed = match definition.feed {
                    Some(feed) => self.feed_word(record, feed)?,
                    // A thread's feed follows from its pitch.
                    None => match hole.pitch.filter(|_| hole.taps()) {
                        Some(pitch) => Some(FeedWord::PerRevolution(libm::fabs(pitch))),
                        None => self.feed.or(self.settings.feed.map(FeedWord::PerMinute)),
                    },
                };
                self.cycle = Some(ActiveCycle { hole, feed });
                self.last_cycle = self.cycle;
                self.measured = true;
            }
        }
        Ok(())
    }

    /// What a definition says, in the way of its writer.
    fn hole(
        &self,
        record: &Record<'_>,
        definition: &CycleDefinition,
    ) -> Result<ClHole, Box<Diagnostic>> {
        let faulty = |why: &str| Err(self.fault(record, why.to_owned()));
        if let Some(kind) = ClHole::without_pecks(definition)
            && !self.settings.allows(kind)
        {
            return faulty(&format!("CYCLE/{kind} without a peck"));
        }
        let bare = definition.bare.as_slice();
        let by_feed = definition.feed.is_some() && definition.bare_before_feed > 1;
        let by_table = self.strange.catia && definition.feed.is_none() && bare.len() > 1;
        if by_feed || by_table {
            return faulty("which of the numbers of this cycle is a height is not known");
        }
        let mut hole =
            ClHole::new(definition, self.scale).map_err(|why| self.fault(record, why))?;
        match (self.strange.autodesk, bare) {
            (true, [_, level]) => {
                let below = definition.rapid_to.unwrap_or(0.0);
                hole.planes = Some([*level, level - below].map(|height| height * self.scale));
            }
            (true, [_, _, ..]) => return faulty("numbers behind the clearance plane of a cycle"),
            _ => {}
        }
        Ok(hole)
    }

    /// The hole whose bottom is at a pose, and the pose at its top.
    fn above(
        &self,
        record: &Record<'_>,
        hole: ClHole,
        bottom: Pose,
    ) -> Result<(ClHole, Pose), Box<Diagnostic>> {
        let Some(planes) = hole.planes else {
            return Ok((hole, bottom));
        };
        let mut at = bottom;
        at.tip.z += hole.depth;
        let [level, clearance] = planes.map(|height| height - at.tip.z);
        let upright = bottom.axis.z > 1.0 - 1e-9;
        match upright && clearance >= 0.0 && level >= clearance {
            true => Ok((ClHole { level, clearance, ..hole }, at)),
            false => {
                let message =
                    "the planes of this cycle do not lie above its hole, or the tool leans";
                Err(self.fault(record, message.to_owned()))
            }
        }
    }

    /// A hole at a pose: up to the level and aside, down to where the feed begins, in, and out to the level.
    pub(super) fn drill(
        &mut self,
        record: &Record<'_>,
        cycle: ActiveCycle,
        at: Pose,
        out: &mut CourseItems,
    ) -> RecordResult {
        let (hole, at) = self.above(record, cycle.hole, at)?;
        let feed = match (cycle.feed, hole.taps(), hole.pitch, self.tools.rpm()) {
            (_, true, Some(pitch), Some(rpm)) => Some(libm::fabs(pitch) * rpm),
            (Some(FeedWord::InverseTime(_)), ..) => {
                let message = "a cycle with a feed by time: of which of its ways?";
                return Err(self.fault(record, message.to_owned()));
            }
            (Some(word), ..) => self.per_minute(word, || None),
            (None, ..) => None,
        };
        let left = matches!(self.tools.spindle(), SpindleState::CounterClockwise(_));
        let kind = match hole.kind {
            CycleKind::Tap if left => CycleKind::TapLeft,
            kind => kind,
        };
        let hole = ClHole { kind, ..hole };
        if hole.taps() && hole.pitch.is_some_and(|pitch| pitch < 0.0) && !left {
            let message = "a left-hand thread, and the spindle turns right";
            return Err(self.fault(record, message.to_owned()));
        }
        let line = record.line;
        let height = |height: f64| Pose { tip: at.tip + at.axis * height, ..at };
        let rapid = MotionFeed::RAPID;
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
        self.tell(record, ProgramEvent::Cycle(hole.call(feed.unwrap_or(0.0))), out);
        if hole.level - hole.clearance > NONE {
            self.go(line, rapid, Curve::Straight, height(hole.clearance), true, out);
        }
        let kind = match hole.taps() {
            true => MotionKind::Thread,
            false => MotionKind::Feed,
        };
        let pace = MotionFeed { kind, feed };
        self.go(line, pace, Curve::Straight, height(-hole.depth), true, out);
        let turns = hole.dwell_turns * 60.0 / self.tools.rpm().unwrap_or(f64::INFINITY);
        let time = hole.dwell + turns;
        if time > 0.0 {
            let revolutions = false;
            self.tell(record, ProgramEvent::Dwell { time, revolutions }, out);
        }
        if hole.out_at_feed() {
            self.go(line, pace, Curve::Straight, height(hole.clearance), true, out);
        }
        if !hole.out_at_feed() || hole.level - hole.clearance > NONE {
            self.go(line, rapid, Curve::Straight, height(hole.level), true, out);
        }
        self.tell(record, ProgramEvent::CycleEnd, out);
        Ok(())
    }
}
