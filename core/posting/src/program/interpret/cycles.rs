//! Cycles.

use nalgebra::Vector3;
use post_grammar::text::excerpt;
use post_grammar::{Cycle, CycleDefinition, Record};
use post_machine::diagnostic::Short;
use post_plugin::SpindleSense;

use super::{ClInterpreter, ModalFeed, SHOWN_NAME, StepSink};
use crate::program::{CycleStep, DrillCycle, MoveFeed, ProgramStep};

/// Pitch and feed a turn agree but for so much: a feed a minute is written without decimals.
const SAME_PITCH: f64 = 0.01;

/// The speed that the control gets, rpm: S has no decimals.
fn printed_speed(rpm: f64) -> f64 {
    libm::round(rpm).max(1.0)
}

impl ClInterpreter {
    /// The cycle in force at a point; nothing if its thread cannot be.
    pub(super) fn drill(
        &mut self,
        record: &Record<'_>,
        drill: DrillCycle,
        feed: MoveFeed,
        point: Vector3<f64>,
        emit: &mut StepSink<'_>,
    ) {
        if std::mem::take(&mut self.rapid) {
            self.warn(
                record,
                "cycle",
                "RAPID ahead of a point while a cycle is on: a hole is made there all the same, until CYCLE/OFF".to_owned(),
            );
        }
        let (drill, point) = match drill.on_bottom(point, self.axis) {
            Ok(Some(above)) => above,
            Ok(None) => (drill, point),
            Err(message) => {
                self.fault(record, "cycle", message, "let the CAM system write it as moves");
                return;
            }
        };
        let (drill, feed) = match drill.taps() {
            false => (drill, feed),
            true => match self.thread(record, drill, feed) {
                Some(threaded) => threaded,
                None => return,
            },
        };
        // After it the tool stands at the level between the holes.
        self.arrive(point + self.axis * drill.retract());
        emit(ProgramStep::Cycle(Box::new(CycleStep {
            cycle: drill,
            point: self.motion(point, feed),
        })));
    }

    /// A thread with its pitch, which is what the tool goes in one turn of the spindle, and the feed that makes it at the speed
    /// that is printed.
    fn thread(
        &mut self,
        record: &Record<'_>,
        drill: DrillCycle,
        feed: MoveFeed,
    ) -> Option<(DrillCycle, MoveFeed)> {
        let (MoveFeed::PerMinute(feed), Some(rpm)) =
            (feed, self.spindle.rpm.filter(|rpm| *rpm > 0.0))
        else {
            self.fault(
                record,
                "cycle",
                "a thread needs a spindle that turns, and a feed a minute or a turn".to_owned(),
                "put a SPINDL before it",
            );
            return None;
        };
        let turned = feed / rpm;
        let pitch = drill.pitch().unwrap_or(turned);
        if libm::fabs(libm::fabs(pitch) - turned) > SAME_PITCH * turned {
            self.fault(
                record,
                "cycle",
                format!(
                    "a thread of {} mm a turn, at {} turns a minute, needs a feed of {} mm/min, and it has {}",
                    Short(libm::fabs(pitch)),
                    Short(rpm),
                    Short(libm::fabs(pitch) * rpm),
                    Short(feed)
                ),
                "the pitch, the speed of the spindle or the feed is wrong",
            );
            return None;
        }
        let left = self.spindle.sense == SpindleSense::CounterClockwise;
        if pitch < 0.0 && !left {
            self.fault(
                record,
                "cycle",
                format!(
                    "a left-hand thread ({} mm a turn), and the spindle turns right",
                    Short(pitch)
                ),
                "SPINDL/…,CCLW turns it left",
            );
            return None;
        }
        let feed = MoveFeed::PerMinute(libm::fabs(pitch) * printed_speed(rpm));
        Some((drill.threaded(pitch, left), feed))
    }

    /// A point of a cycle that was refused: the tool is taken to stand there, so that nothing is said of its moves.
    pub(super) fn lost_hole(
        &mut self,
        record: &Record<'_>,
        point: [f64; 3],
        axis: Option<[f64; 3]>,
    ) {
        self.rapid = false;
        if self.set_axis(record, axis)
            && let Some(tip) = self.point(record, point)
        {
            self.arrive(tip);
        }
    }

    pub(super) fn cycle(&mut self, record: &Record<'_>, cycle: &Cycle, emit: &mut StepSink<'_>) {
        if matches!(cycle, Cycle::Off | Cycle::Define(_)) {
            self.cycles.lost = false;
        }
        match cycle {
            Cycle::Off => {
                if self.cycles.in_force.take().is_some() {
                    emit(ProgramStep::EndCycle);
                }
            }
            Cycle::On => self.cycles.in_force = self.cycles.last,
            Cycle::Define(definition) => self.define_cycle(record, definition),
        }
    }

    /// Whether the form is one that says what it means: its pecks, and what stands where.
    fn written(&mut self, record: &Record<'_>, definition: &CycleDefinition) -> Result<(), String> {
        if let Some(kind) = DrillCycle::lacks_pecks(definition) {
            if !self.reading.allows(kind) {
                return Err(format!(
                    "CYCLE/{kind} without a peck (STEP, PECKING, 1STPECK, INCR): the tool would go to the bottom in one go; --allow {kind} lets it"
                ));
            }
            self.allow(kind, "is drilled in one go", record);
        }
        if definition.feed.is_some() && definition.bare_before_feed > 1 {
            return Err(
                "more than one number stands before the unit of the feed: which of them is the feed (Creo's fixed form) and which a height, nobody here knows"
                    .to_owned(),
            );
        }
        let by_position = definition.bare.len() > 1 && definition.feed.is_none();
        if self.writer.catia && by_position {
            return Err(
                "in CATIA's files the place of a number in CYCLE is that of the machine's NC table: which of them is the feed and which a height, nobody here knows"
                    .to_owned(),
            );
        }
        if self.writer.autodesk && definition.bare.len() > 2 {
            return Err("the numbers behind the clearance plane are not known here".to_owned());
        }
        Ok(())
    }

    /// Takes heights as the stock APT posts of Autodesk do: the depth counts from the stock down to the point, which is
    /// the bottom, and the clearance plane is a height of the part.
    fn with_heights(
        &mut self,
        record: &Record<'_>,
        drill: DrillCycle,
        definition: &CycleDefinition,
    ) -> DrillCycle {
        let (true, [_, plane]) = (self.writer.autodesk, definition.bare.as_slice()) else {
            return drill;
        };
        if !std::mem::replace(&mut self.writer.told_heights, true) {
            self.warn(
                record,
                "cycle",
                "the points of cycles are taken for the bottoms of the holes and their clearance plane for a height of the part, as \
                 the published text of Autodesk's stock APT post has it: look at the first hole"
                    .to_owned(),
            );
        }
        let plane = plane * self.scale;
        drill.by_planes(plane, plane - definition.rapid_to.unwrap_or(0.0) * self.scale)
    }

    pub(super) fn define_cycle(&mut self, record: &Record<'_>, definition: &CycleDefinition) {
        let drill =
            self.written(record, definition).and_then(|()| DrillCycle::new(definition, self.scale));
        let drill = match drill {
            Ok(drill) => self.with_heights(record, drill, definition),
            Err(message) => {
                self.cycles.in_force = None;
                self.cycles.lost = true;
                self.fault(record, "cycle", message, "let the CAM system write it as moves");
                return;
            }
        };
        let feed = match definition.feed {
            // A thread's feed follows from its pitch where none is given.
            None if drill.taps() && drill.pitch().is_some() => {
                drill.pitch().map(|pitch| ModalFeed::PerRevolution(libm::fabs(pitch)))
            }
            Some(feed) => self.feed_word(record, feed),
            None => self.feed.or_else(|| self.told_feed()),
        };
        let left: Vec<String> = DrillCycle::left_out(definition).collect();
        if !left.is_empty() {
            self.warn(
                record,
                "cycle",
                format!("of this cycle is left out: {}", excerpt(&left.join(", "), SHOWN_NAME)),
            );
        }
        let Some(feed) = feed.filter(|feed| *feed != ModalFeed::Pace(MoveFeed::Rapid)) else {
            self.cycles.in_force = None;
            self.cycles.lost = true;
            self.fault(
                record,
                "no-feed",
                "the cycle has no feed".to_owned(),
                "the CAM system must write it with one; --feed MM_A_MINUTE is for cuts without one",
            );
            return;
        };
        self.cycles.in_force = Some((drill, feed));
        self.cycles.last = self.cycles.in_force;
        self.measured = true;
    }
}
