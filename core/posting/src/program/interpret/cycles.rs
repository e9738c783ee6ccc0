//! Cycles.

use nalgebra::Vector3;
use post_grammar::{Cycle, CycleDefinition, Record};

use super::{FeedWord, Interpreter};
use crate::program::cycle::{Drill, Leg};
use crate::program::motion::{Pace, Step};

impl Interpreter {
    pub(super) fn drill(
        &mut self,
        drill: Drill,
        feed: Pace,
        point: Vector3<f64>,
        emit: &mut impl FnMut(Step),
    ) {
        self.rapid = false;
        let axis = self.axis;
        // Between holes the tool goes up before it goes aside, and aside before it goes down.
        if let Some(tip) = self.tip {
            let height = axis.dot(&(tip - point));
            let aside = tip - point - axis * height;
            if aside.norm() > 1e-6 {
                let level = drill.retract();
                if height < level {
                    self.advance(point + aside + axis * level, Pace::Rapid, 0.0, emit);
                } else if height > level {
                    self.advance(point + axis * height, Pace::Rapid, 0.0, emit);
                }
            }
        }
        drill.legs(&mut |leg| match leg {
            Leg::Rapid(height) => self.advance(point + axis * height, Pace::Rapid, 0.0, emit),
            Leg::Feed(height) => self.advance(point + axis * height, feed, 0.0, emit),
            Leg::Dwell(seconds) => emit(Step::Dwell(seconds)),
        });
    }

    pub(super) fn cycle(&mut self, record: &Record<'_>, cycle: &Cycle) {
        match cycle {
            Cycle::Off => self.cycle = None,
            Cycle::On => self.cycle = self.last_cycle,
            Cycle::Define(definition) => self.define_cycle(record, definition),
        }
    }

    pub(super) fn define_cycle(&mut self, record: &Record<'_>, definition: &CycleDefinition) {
        let drill = match Drill::new(definition, self.scale) {
            Ok(drill) => drill,
            Err(message) => {
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
            None => self.feed,
        };
        let left: Vec<String> = Drill::left_out(definition).collect();
        if !left.is_empty() {
            self.warn(
                record,
                "cycle",
                format!("of this cycle is left out: {}", left.join(", ")),
            );
        }
        let Some(feed) = feed.filter(|feed| *feed != FeedWord::Pace(Pace::Rapid)) else {
            self.fault(record, "no-feed", "the cycle has no feed".to_owned(), "");
            return;
        };
        self.cycle = Some((drill, feed));
        self.last_cycle = self.cycle;
        self.measured = true;
    }
}
