//! A cycle as its event tells it, for dialects that write it only where its first point is known.

use crate::{Cycle, Event, Feed};

/// The fields of an [`Event::Cycle`], with what follows from them. Lengths are in program units, along the tool axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drilling {
    /// Kind of the cycle.
    pub cycle: Cycle,
    /// Feed of the cycle.
    pub feed: Feed,
    /// Depth from the point down to the bottom.
    pub depth: f64,
    /// Distance from the point up to where the feed begins.
    pub clearance: f64,
    /// Distance from the point up to where the tool goes on the way to the next one.
    pub retract: f64,
    /// Into the part in one go: the whole depth if the event tells none.
    pub step: f64,
    /// Wait at the bottom, seconds; 0 if there is none.
    pub dwell: f64,
    /// A thread's way a turn, where the event tells it.
    pub pitch: Option<f64>,
}

impl Drilling {
    /// The same hole for controls whose cycles need a depth below the surface, and how far its point is raised for
    /// that.
    ///
    /// A CL file may have the bottom at the point itself or above it: such a hole is counted from where its feed
    /// begins.
    pub fn below_its_point(self) -> (Self, f64) {
        if self.depth > 0.0 {
            return (self, 0.0);
        }
        let raised = self.clearance;
        let depth = self.depth + raised;
        let counted = Drilling {
            depth,
            clearance: 0.0,
            retract: self.retract - raised,
            step: if self.step > 0.0 { self.step } else { depth },
            ..self
        };
        (counted, raised)
    }

    /// The fields of a cycle; none of another event.
    pub fn of(event: &Event<'_>) -> Option<Self> {
        match *event {
            Event::Cycle { cycle, feed, depth, clearance, retract, step, dwell, pitch } => {
                Some(Drilling {
                    cycle,
                    feed,
                    depth,
                    clearance,
                    retract,
                    step: step.unwrap_or(depth),
                    dwell: dwell.unwrap_or(0.0),
                    pitch,
                })
            }
            _ => None,
        }
    }

    /// Whether the cycle cuts a thread: its pitch is its feed.
    pub fn is_thread(&self) -> bool {
        matches!(self.cycle, Cycle::Tap | Cycle::TapLeft)
    }

    /// Feed, program units a minute, with the spindle at `rpm`; none if that is not known.
    pub fn feed_per_minute(&self, rpm: Option<f64>) -> Option<f64> {
        match self.feed {
            Feed::PerMinute(feed) => Some(feed),
            Feed::PerRevolution(feed) => Some(feed * rpm?),
            Feed::InverseTime(_) => None,
        }
    }

    /// A thread's way a turn, with the spindle at `rpm`; none if neither tells it.
    pub fn thread(&self, rpm: Option<f64>) -> Option<f64> {
        match (self.pitch, self.feed) {
            (Some(pitch), _) | (None, Feed::PerRevolution(pitch)) => Some(pitch),
            (None, _) => Some(self.feed_per_minute(rpm)? / rpm?),
        }
    }
}
