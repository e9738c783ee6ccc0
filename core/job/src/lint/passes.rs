//! How cuts and rapids follow one another: a rapid that is one path with its neighbours, a pass that ends where it began.

use nalgebra::Vector3;
use post_readback::{Motion, MotionKind};

/// A rapid may end so much below what was cut, mm: the decimals of an inch program.
pub(super) const SLACK: f64 = 0.05;

/// A move that is shorter has no direction, mm.
const SHORT: f64 = 1e-6;

/// A rapid goes on as the cuts before and behind it do if no corner is sharper, cosine.
const SMOOTH: f64 = 0.8;

/// It is no longer than so many times the longer of them.
const AS_LONG: f64 = 3.0;

/// From no farther above are cuts come down to at feed, mm: half an inch.
const STAGE: f64 = 12.7;

/// Two ways are on one line, cosine: the decimals of a program at a short one.
const ALIGNED: f64 = 0.9999;

/// A way out that goes back on the way in, cosine.
const BACK: f64 = -0.99;

/// Something is cut on a motion, as far as the program says.
pub(super) fn is_cut(motion: &Motion) -> bool {
    motion.kind != MotionKind::Rapid && !motion.fast && !motion.machine
}

/// How a motion begins and ends: unit vectors, zero where it does not move the tip; and its length, mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heading {
    begins: Vector3<f64>,
    ends: Vector3<f64>,
    pub length: f64,
}

/// A way at rapid from cut to cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub line: u64,
    pub before: Heading,
    pub way: Heading,
}

/// Cuts without a rapid among them, the first at the depth to which a rapid came down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pass {
    pub line: u64,
    /// Where it begins, part frame.
    start: Vector3<f64>,
    /// How its first cut begins; none before it.
    begins: Option<Vector3<f64>>,
}

impl Heading {
    /// Of a motion.
    pub fn of(motion: &Motion) -> Self {
        const NEAR: f64 = 1e-3;
        let [from, to] = [&motion.from, &motion.to].map(|end| end.pose.tip);
        let straight = !motion.way.is_curved() && !motion.turns();
        let unit = |way: Vector3<f64>| way.try_normalize(SHORT).unwrap_or_default();
        match straight {
            true => {
                let way = to - from;
                Self { begins: unit(way), ends: unit(way), length: way.norm() }
            }
            false => {
                let begins = unit((motion.at(NEAR).tip - from) / NEAR);
                let ends = unit((to - motion.at(1.0 - NEAR).tip) / NEAR);
                let length = (motion.feed * motion.minutes).max((to - from).norm());
                Self { begins, ends, length }
            }
        }
    }
}

impl Heading {
    /// The rapid `motion`, which goes so, is the last and shorter part of one way down along the tool, as is come down at feed.
    pub fn goes_on_down(&self, before: Self, motion: &Motion) -> bool {
        !motion.turns()
            && self.length > SLACK
            && self.length < before.length.min(STAGE)
            && before.ends.dot(&self.begins) > ALIGNED
            && self.begins.dot(&motion.to.pose.axis) < -ALIGNED
    }
}

impl Link {
    /// The cut before it, it and the cut `next` are one path, as smooth as cuts are.
    pub fn goes_on_in(&self, next: &Motion) -> bool {
        if !is_cut(next) {
            return false;
        }
        let Self { before, way, .. } = self;
        let behind = Heading::of(next);
        let smooth = |from: &Vector3<f64>, to: &Vector3<f64>| from.dot(to) > SMOOTH;
        way.length > SLACK
            && way.length < AS_LONG * before.length.max(behind.length)
            && smooth(&before.ends, &way.begins)
            && smooth(&way.ends, &behind.begins)
    }
}

impl Pass {
    /// Of the rapid on this line, and the cut behind it.
    pub fn new(line: u64, first: &Motion) -> Self {
        Self { line, start: first.from.pose.tip, begins: None }
    }

    /// The cut ends where the pass began, and comes there on another way than it left: the pass begins on a contour, and not
    /// on a way to it. Under compensation of the radius the first way leads there.
    pub fn is_around(&mut self, motion: &Motion, heading: Heading) -> bool {
        let begins = *self.begins.get_or_insert(heading.begins);
        motion.state.compensation == 0
            && (motion.to.pose.tip - self.start).norm() < SLACK
            && heading.length > SLACK
            && heading.ends.dot(&begins) > BACK
    }
}
