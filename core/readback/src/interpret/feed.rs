//! How long a motion takes at the feed that the program states.

use nalgebra::Vector3;
use post_machine::description::{FeedLength, InverseTime, TcpFeedLength};

use super::state::{ControlState, FeedMeaning};
use crate::{Curve, Interpolation, MotionKind, Stance};

/// A tip that goes less far than this stands, mm: turned about itself it comes back to its last digits.
const STANDS: f64 = 1e-9;

/// How fast and how long a motion goes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MotionTime {
    /// Feed of the tip against the part, mm/min.
    pub feed: f64,
    /// Minutes.
    pub minutes: f64,
    /// Minutes, as fast as it is anywhere on its way.
    pub at_fastest: f64,
}

impl MotionTime {
    fn even(feed: f64, minutes: f64) -> Self {
        Self { feed, minutes, at_fastest: minutes }
    }
}

impl ControlState {
    /// How fast and how long a motion goes; zero where the program states no feed.
    #[inline]
    pub(super) fn timed(
        &self,
        kind: MotionKind,
        way: &Interpolation,
        from: &Stance,
        to: &Stance,
    ) -> MotionTime {
        if kind == MotionKind::Rapid {
            return MotionTime::even(0.0, self.rapid_minutes(way, from, to));
        }
        let Some(feed) = self.modal.feed.filter(|feed| *feed > 0.0) else {
            return MotionTime::default();
        };
        let tip = tip_length(way, from, to);
        let mode = if kind == MotionKind::Thread {
            FeedMeaning::PerRevolution
        } else {
            self.modal.feed_mode
        };
        let mut share = 1.0;
        let minutes = match mode {
            FeedMeaning::Inverse => match self.machine.control.inverse_time {
                InverseTime::Minutes => 1.0 / feed,
                InverseTime::Seconds => 1.0 / (60.0 * feed),
            },
            FeedMeaning::PerMinute => self.feed_length(way, tip, from, to) / feed,
            FeedMeaning::PerRevolution => {
                let ends = [from.pose.tip, to.pose.tip];
                let fixed = [self.modal.speed; 2];
                let [rpm, fastest] = self.state.spindle.surface_rpm(ends).unwrap_or(fixed);
                if rpm <= 0.0 {
                    return MotionTime::default();
                }
                if fastest.is_finite() {
                    share = rpm / fastest;
                }
                self.feed_length(way, tip, from, to) / (feed * rpm)
            }
        };
        match minutes > 0.0 {
            true => MotionTime { feed: tip / minutes, minutes, at_fastest: minutes * share },
            false => MotionTime::default(),
        }
    }

    /// The length that F a minute counts along, mm, or degrees where rotary axes alone turn.
    #[inline]
    fn feed_length(&self, way: &Interpolation, tip: f64, from: &Stance, to: &Stance) -> f64 {
        let counted = self.machine.control.tcp_feed_length;
        if self.face.is_some() || self.state.tcp && tip > STANDS && counted == TcpFeedLength::Tip {
            return tip;
        }
        if let Some(mode) = &self.state.wrap {
            return mode.way(&from.joints, &to.joints);
        }
        let mut squares = 0.0;
        let mut longest = 0.0;
        let mut turned = 0.0;
        for (place, axis) in self.machine.axes.iter().enumerate() {
            let way = to.joints[place] - from.joints[place];
            if way == 0.0 {
                continue;
            }
            if axis.joint.rotary {
                // mm along the circle that the control counts, or degrees (in an inch program each is 25.4 of F's mm).
                let along_circle = !self.state.tcp || counted == TcpFeedLength::Combined;
                let way = match axis.feed_diameter.filter(|_| along_circle) {
                    Some(diameter) => way * 0.5 * diameter,
                    None => way.to_degrees() * self.modal.unit,
                };
                turned += way * way;
                if libm::fabs(way) > longest {
                    longest = libm::fabs(way);
                }
            } else if !self.state.tcp {
                // Where the control keeps the tip they only follow.
                squares += way * way;
                if libm::fabs(way) > longest {
                    longest = libm::fabs(way);
                }
            }
        }
        if self.state.tcp && counted == TcpFeedLength::Combined {
            return (tip * tip + turned).sqrt();
        }
        if way.is_curved() {
            return tip;
        }
        match self.machine.control.feed_length.unwrap_or(self.lexicon.feed_length()) {
            FeedLength::Linear | FeedLength::LinearOrLongest if squares > 0.0 => squares.sqrt(),
            FeedLength::Linear => turned.sqrt(),
            FeedLength::LinearOrLongest => longest,
            FeedLength::Combined => (squares + turned).sqrt(),
            FeedLength::Longest => longest,
        }
    }

    /// Minutes of a rapid: its slowest axis at its largest feed, zero where the machine file names none; where G0 goes at F
    /// no less than at that.
    #[inline]
    fn rapid_minutes(&self, way: &Interpolation, from: &Stance, to: &Stance) -> f64 {
        let mut minutes: f64 = match self.modal.feed {
            Some(feed) if self.lexicon.rapids_at_feed() && feed > 0.0 => {
                self.feed_length(way, tip_length(way, from, to), from, to) / feed
            }
            _ => 0.0,
        };
        for (place, axis) in self.machine.axes.iter().enumerate() {
            let way = libm::fabs(to.joints[place] - from.joints[place]);
            // Of an axis without a largest feed it is zero.
            let own = way / axis.max_feed;
            if own > minutes {
                minutes = own;
            }
        }
        minutes
    }
}

/// The way of the tip against the part, mm.
pub(super) fn tip_length(way: &Interpolation, from: &Stance, to: &Stance) -> f64 {
    let chord = to.pose.tip - from.pose.tip;
    match way.curve() {
        Curve::Straight => chord.norm(),
        Curve::Arc { centre, normal, sweep } => {
            let arm = from.pose.tip - centre;
            let across: Vector3<f64> = arm - normal * normal.dot(&arm);
            let along = normal.dot(&chord);
            libm::hypot(across.norm() * sweep, along)
        }
        Curve::Spline(spline) => spline.length(),
    }
}
