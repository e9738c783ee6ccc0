//! Where a program strays too far from its path, as it is predicted: cells of the path that are to be gone more gently.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_posting::{TightPlace, Tightening};

/// Length of a cell, mm.
const CELL: f64 = 0.25;

/// The share by which the limit is undershot where it was exceeded: what follows is no faster, but it is not the same.
const MARGIN: f64 = 0.03;

/// No place is tightened to less than this share of the limit: where that does not help, nothing will.
const LEAST: f64 = 0.02;

/// A stretch of the path in one line of the CL file.
#[derive(Clone, Copy, Debug)]
struct PathCell {
    line: u64,
    tips: [Vector3<f64>; 2],
    times: [f64; 2],
    /// From one set-point to the next, mm.
    step: f64,
}

/// An instant at which the tool was too far off.
#[derive(Clone, Copy, Debug)]
struct ExcessInstant {
    time: f64,
    /// What the limit is to be multiplied with.
    share: f64,
}

/// How fast servos settle, s.
#[derive(Clone, Copy, Debug)]
pub struct Settling {
    /// What makes an error lies no longer before it, and what would do away with it no longer behind.
    pub stretch: f64,
    /// Nothing is left of a rapid after it.
    pub memory: f64,
}

/// The tool off the commanded path.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContourExcess {
    /// mm.
    pub error: f64,
    /// Line of the program.
    pub nc_line: u64,
    /// Line of the CL file.
    pub cl_line: u64,
}

/// Gathers cells around the instants at which the tool is too far off; it remembers those of a settling time.
#[derive(Debug)]
pub struct Excess {
    limit: f64,
    settling: Settling,
    tightening: Arc<Tightening>,
    /// When the tool was last seen at rapid, or standing: what it is off by until it has settled is left of that.
    entered: f64,
    /// At most, what rapids do apart.
    pub largest: ContourExcess,
    /// What rapids before or behind a cut do, at most.
    pub beside_rapid: ContourExcess,
    cells: VecDeque<PathCell>,
    hot: VecDeque<ExcessInstant>,
    places: Vec<TightPlace>,
    /// Set-points in cuts at which the tool is too far off.
    pub over: u64,
}

impl Excess {
    /// Of a limit in mm, servos that settle so fast, and what was tightened before.
    pub fn new(limit: f64, settling: Settling, tightening: Arc<Tightening>) -> Self {
        Self {
            limit,
            settling,
            tightening,
            entered: f64::NEG_INFINITY,
            largest: ContourExcess::default(),
            beside_rapid: ContourExcess::default(),
            cells: VecDeque::new(),
            hot: VecDeque::new(),
            places: Vec::new(),
            over: 0,
        }
    }

    /// At `time` (s) the tool does not cut.
    pub fn rests(&mut self, time: f64) {
        self.entered = time;
    }

    /// At a place of a cut the tool is off by what a rapid before or behind it does.
    pub fn take_beside_rapid(&mut self, off: ContourExcess) {
        if off.error > self.beside_rapid.error {
            self.beside_rapid = off;
        }
    }

    /// At `time` (s) the tool is nearest to `tip` (mm, part frame) of the path that the CL file asks for.
    pub fn take(&mut self, time: f64, tip: &Vector3<f64>, off: ContourExcess) {
        let ContourExcess { error, cl_line: line, .. } = off;
        if time < self.entered + self.settling.memory {
            return self.take_beside_rapid(off);
        }
        if error > self.largest.error {
            self.largest = off;
        }
        match self.cells.back_mut() {
            Some(cell) if cell.line == line && (tip - cell.tips[0]).norm() < CELL => {
                cell.step = cell.step.max((tip - cell.tips[1]).norm());
                (cell.tips[1], cell.times[1]) = (*tip, time);
            }
            last => {
                let step = last.map_or(0.0, |last| (tip - last.tips[1]).norm());
                self.cells.push_back(PathCell {
                    line,
                    tips: [*tip; 2],
                    times: [time; 2],
                    // A rapid in between is no step.
                    step: step.min(CELL),
                });
            }
        }
        if error > self.limit {
            self.over += 1;
            let share = (1.0 - MARGIN) * self.limit / error;
            self.hot.push_back(ExcessInstant { time, share });
        }
        self.settle(time);
    }

    /// Decides on cells that nothing which is still to come can concern.
    fn settle(&mut self, time: f64) {
        while let Some(cell) = self.cells.front()
            && cell.times[1] + self.settling.stretch < time
        {
            self.decide();
        }
    }

    fn decide(&mut self) {
        let Some(cell) = self.cells.pop_front() else {
            return;
        };
        let [first, last] = cell.times;
        while self.hot.front().is_some_and(|hot| hot.time + self.settling.stretch < first) {
            self.hot.pop_front();
        }
        let near = self.hot.iter().take_while(|hot| hot.time - self.settling.stretch <= last);
        let share = near.fold(1.0, |least: f64, hot| least.min(hot.share));
        if share == 1.0 {
            return;
        }
        let [from, to] = cell.tips;
        let middle = (from + to) / 2.0;
        // Where the limit was not what the feed was held by, tightening it a little does nothing: each round that has not
        // helped counts twice more.
        let rounds = self.tightening.rounds_at(cell.line, &middle);
        let before = self.tightening.share(cell.line, &middle);
        let share = libm::pow(share, (2 * rounds + 1) as f64).max(LEAST / before);
        if share < 1.0 {
            self.places.push(TightPlace {
                line: cell.line,
                tip: [middle.x as f32, middle.y as f32, middle.z as f32],
                reach: ((to - from).norm() / 2.0 + cell.step) as f32,
                share: share as f32,
            });
        }
    }

    /// There is no more: the cells that are to be gone more gently.
    pub fn finish(mut self) -> Vec<TightPlace> {
        while !self.cells.is_empty() {
            self.decide();
        }
        self.places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settling(memory: f64) -> Settling {
        Settling { stretch: 0.1, memory }
    }

    fn at(x: f64) -> Vector3<f64> {
        Vector3::new(x, 0.0, 0.0)
    }

    /// 10 mm/s along X, a line a millimetre, 20 µm off from 5 mm on for 0.2 mm, else 10 µm.
    fn run(mut excess: Excess) -> Excess {
        for step in 0..=1000 {
            let time = 1e-3 * f64::from(step);
            let x = 10.0 * time;
            let off = ContourExcess {
                error: if (500..520).contains(&step) { 0.02 } else { 0.01 },
                nc_line: 0,
                cl_line: 1 + x as u64,
            };
            excess.take(time, &at(x), off);
        }
        excess
    }

    #[test]
    fn what_lies_within_a_settling_time_of_an_excess_is_tightened() {
        let excess = run(Excess::new(0.01, settling(0.1), Arc::default()));
        assert_eq!((excess.over, excess.largest.cl_line), (20, 6));
        let places = excess.finish();
        let first = places.iter().map(|it| it.tip[0] - it.reach).fold(f32::MAX, f32::min);
        let last = places.iter().map(|it| it.tip[0] + it.reach).fold(0.0, f32::max);
        // A millimetre to both sides, and what is left of a cell.
        assert!((3.7..=4.0).contains(&first), "{first}");
        assert!((6.19..6.5).contains(&last), "{last}");
        for place in &places {
            assert!((place.share - 0.485).abs() < 1e-6);
            assert_eq!(place.line, 1 + place.tip[0] as u64);
        }
        // No gap between them.
        for pair in places.windows(2) {
            let gap = pair[1].tip[0] - pair[0].tip[0] - pair[0].reach - pair[1].reach;
            assert!(gap <= 0.0, "{gap}");
        }
    }

    #[test]
    fn what_did_not_help_is_tightened_by_more_and_no_more_than_makes_sense() {
        let mut tightening = Tightening::default();
        for round in 1..10 {
            let arc = Arc::new(tightening.clone());
            let places = run(Excess::new(0.01, settling(0.1), arc)).finish();
            let before = tightening.share(6, &at(5.1));
            tightening.push(places);
            let now = tightening.share(6, &at(5.1));
            let want = (before * libm::pow(0.485, f64::from(2 * round - 1))).max(LEAST);
            assert!((now / want - 1.0).abs() < 1e-5, "{round}: {now} {want}");
        }
    }

    #[test]
    fn nothing_is_tightened_where_the_limit_is_kept_or_a_rapid_has_just_ended() {
        let excess = run(Excess::new(0.02, settling(0.1), Arc::default()));
        assert_eq!((excess.over, excess.finish()), (0, Vec::new()));
        let mut entered = Excess::new(0.01, settling(0.6), Arc::default());
        entered.rests(0.0);
        let excess = run(entered);
        assert_eq!((excess.beside_rapid.error, excess.largest.error), (0.02, 0.01));
        assert_eq!((excess.over, excess.finish()), (0, Vec::new()));
    }
}
