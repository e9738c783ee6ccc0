//! A point that stands far beside those before and behind it, as a digit or a sign that was mistaken leaves it.

use nalgebra::Vector3;
use post_readback::Motion;

use super::passes::is_cut;

/// The ways to such a point and back are so many times as long as those beside them.
const LONGER: f64 = 3.0;

/// The points before and behind it are as near to one another as this share of the shorter way.
const NEAR: f64 = 0.5;

/// The way behind it goes on as the one before it did, cosine: letters and edges are gone back along too.
const GOES_ON: f64 = 0.8;

/// A way out that is shorter is none, mm.
const LEAST: f64 = 0.5;

/// One cut of so many leads to such a point by mistake; where more do, the path is one of ways out and back.
const FEW: u64 = 30;

/// Looks for such points among cuts that follow one another.
#[derive(Clone, Debug, Default)]
pub(super) struct StrayPoints {
    /// Ways of the last cuts, the newest first, mm, part frame; and the line of each.
    ways: [Option<(Vector3<f64>, u64)>; 4],
    cuts: u64,
    found: Option<StrayPoint>,
    count: u64,
}

/// The farthest.
#[derive(Clone, Copy, Debug)]
pub(super) struct StrayPoint {
    /// Line that leads to it.
    pub line: u64,
    /// How far beside the points before and behind it, mm.
    pub aside: f64,
}

impl StrayPoints {
    /// Takes the next motion.
    pub fn take(&mut self, motion: &Motion) {
        if !is_cut(motion) || motion.hole || motion.way.is_curved() {
            self.ways = [None; 4];
            return;
        }
        let way = motion.to.pose.tip - motion.from.pose.tip;
        self.ways.rotate_right(1);
        self.ways[0] = Some((way, motion.line));
        self.cuts += 1;
        let [Some((behind, _)), Some((back, _)), Some((out, line)), Some((before, _))] = self.ways
        else {
            return;
        };
        let short = out.norm().min(back.norm());
        let beside = before.norm().max(behind.norm());
        let goes_on = before.dot(&behind) > GOES_ON * before.norm() * behind.norm();
        let near = (out + back).norm() < NEAR * short;
        if short > LEAST && short > LONGER * beside && near && goes_on {
            self.count += 1;
            if self.found.is_none_or(|known| short > known.aside) {
                self.found = Some(StrayPoint { line, aside: short });
            }
        }
    }

    /// A block was not understood: what follows has nothing before it.
    pub fn miss(&mut self) {
        self.ways = [None; 4];
    }

    /// The farthest of few, and how many there are.
    pub fn finish(&self) -> Option<(StrayPoint, u64)> {
        self.found.filter(|_| self.count * FEW <= self.cuts).map(|found| (found, self.count))
    }
}
