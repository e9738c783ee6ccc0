//! Cycles.

use nalgebra::Vector3;
use post_grammar::text::excerpt;
use post_grammar::{Cycle, CycleDefinition, Record};

use super::{FeedWord, Interpreter, SHOWN_NAME};
use crate::program::{CycleStep, DrillCycle, Pace, Step};

impl Interpreter {
    pub(super) fn drill(
        &mut self,
        drill: DrillCycle,
        feed: Pace,
        point: Vector3<f64>,
        emit: &mut impl FnMut(Step),
    ) {
        self.rapid = false;
        // Behind it the tool stands at the level between the holes.
        self.arrive(point + self.axis * drill.retract());
        emit(Step::Cycle(Box::new(CycleStep {
            cycle: drill,
            point: self.motion(point, feed),
        })));
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

    pub(super) fn cycle(
        &mut self,
        record: &Record<'_>,
        cycle: &Cycle,
        emit: &mut impl FnMut(Step),
    ) {
        if matches!(cycle, Cycle::Off | Cycle::Define(_)) {
            self.cycle_lost = false;
        }
        match cycle {
            Cycle::Off => {
                if self.cycle.take().is_some() {
                    emit(Step::EndCycle);
                }
            }
            Cycle::On => self.cycle = self.last_cycle,
            Cycle::Define(definition) => self.define_cycle(record, definition),
        }
    }

    pub(super) fn define_cycle(&mut self, record: &Record<'_>, definition: &CycleDefinition) {
        let drill = match DrillCycle::new(definition, self.scale) {
            Ok(drill) => drill,
            Err(message) => {
                self.cycle = None;
                self.cycle_lost = true;
                self.fault(
                    record,
                    "cycle",
                    message,
                    "let the CAM system write it as moves",
                );
                return;
            }
        };
        let feed = match definition.feed {
            Some(feed) => self.feed_word(record, feed),
            None => self.feed.or_else(|| self.told_feed()),
        };
        let left: Vec<String> = DrillCycle::left_out(definition).collect();
        if !left.is_empty() {
            self.warn(
                record,
                "cycle",
                format!(
                    "of this cycle is left out: {}",
                    excerpt(&left.join(", "), SHOWN_NAME)
                ),
            );
        }
        let Some(feed) = feed.filter(|feed| *feed != FeedWord::Pace(Pace::Rapid)) else {
            self.cycle = None;
            self.cycle_lost = true;
            self.fault(
                record,
                "no-feed",
                "the cycle has no feed".to_owned(),
                "the CAM system must write it with one; --feed MM_A_MINUTE is for cuts without one",
            );
            return;
        };
        self.cycle = Some((drill, feed));
        self.last_cycle = self.cycle;
        self.measured = true;
    }
}
