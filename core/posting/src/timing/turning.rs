//! Feeds a revolution of the part: how long a cut takes follows from how fast the spindle turns on the way.

use nalgebra::{Vector2, Vector3};
use post_machine::axis_words::unit_length;
use post_machine::description::surface_rpm_on_way;
use post_machine::diagnostic::{Diagnostic, Short};
use post_plugin::{Feed, Spindle};

use super::TimingStage;
use crate::blocks::MotionBlock;

/// How fast the part turns, and where the tool stands.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TurningSpeed {
    /// Revolutions a minute; at a constant cutting speed the most of them.
    rpm: f64,
    /// The cutting speed that the control keeps, m/min.
    surface: Option<f64>,
    /// Of the tip across the line of the spindle, which is Z of the part, mm.
    place: Vector2<f64>,
}

impl TurningSpeed {
    /// The spindle turns at a speed of its own.
    pub(super) fn turn(&mut self, spindle: Spindle) {
        self.surface = None;
        self.rpm = match spindle {
            Spindle::On { rpm, .. } => rpm,
            Spindle::Off | Spindle::Orient => 0.0,
        };
    }

    /// The control keeps a cutting speed, m/min, at no more than `most` revolutions a minute.
    pub(super) fn keep(&mut self, speed: f64, most: Option<f64>) {
        self.surface = Some(speed);
        self.rpm = most.unwrap_or(f64::INFINITY);
    }

    /// The tip has come to a place, mm, part frame.
    pub(super) fn stand(&mut self, tip: Vector3<f64>) {
        self.place = tip.xy();
    }

    /// Revolutions a minute on the way to `tip`: those that the way takes as long with, and the most of them.
    fn on_way(&self, tip: Vector3<f64>) -> [f64; 2] {
        match self.surface {
            Some(speed) => surface_rpm_on_way(speed, [self.place, tip.xy()], self.rpm),
            None => [self.rpm; 2],
        }
    }
}

impl TimingStage<'_> {
    /// A cut at a feed a revolution: that of the CL file, or less where an axis would go too fast.
    pub(super) fn turned(&mut self, block: &mut MotionBlock, feed: f64) {
        let (least, limit, _) = self.least(block);
        let name = limit.map(|limit| limit.name(block));
        let [usual, fastest] = self.turning.on_way(block.tip);
        let allowed = match least > 0.0 {
            true => feed.min(block.way / (least * fastest)),
            false => feed,
        };
        if allowed < feed * (1.0 - 1e-9) {
            block.time.limit = name;
            self.statistics.limited += 1;
        }
        let Some(written) = self.feeds.per_revolution(allowed) else {
            let message = format!(
                "a feed of {} mm a revolution, and the dialect {} prints none so low",
                Short(allowed),
                self.base.control.dialect
            );
            let help = "a higher FEDRAT, or a feed a minute";
            self.findings.at(block.line, Diagnostic::error("low-feed", message).help(help));
            return;
        };
        let pace = written * unit_length(self.base.control.units) * usual;
        block.time.minutes = if pace > 0.0 { block.way / pace } else { 0.0 };
        block.time.feed = Some(Feed::PerRevolution(written));
        match block.loose {
            true => self.statistics.other += block.time.minutes,
            false => self.statistics.cutting += block.time.minutes,
        }
    }
}
