//! Rapids that go lower than anything was cut before, where nobody says what the stock is.
//!
//! A program is run twice: once to learn from how high its cuts come down at each place, once to see what was cut before
//! each rapid. Places are cells across the tool axis; memory does not grow with the program, as cells do.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_readback::{BlockEffect, Motion, MotionKind};

/// Edge of a cell at first, mm.
const FINEST: f64 = 1.0;

/// Cells that are kept; of more they are made twice as large.
const MOST_CELLS: usize = 1 << 16;

/// Directions of the tool that are kept; rapids along others are not looked at.
const MOST_DIRECTIONS: usize = 16;

/// Places of a motion that are looked at, at most.
const MOST_PLACES: f64 = 4096.0;

/// A rapid may end so much below what was cut, mm: the decimals of an inch program.
const SLACK: f64 = 0.05;

/// A cut clears so much to each side, mm: half of a small cutter.
const CLEARED: f64 = 6.0;

/// Places of a rapid from cut to cut that are looked at.
const LOOKS: usize = 16;

/// Directions of the tool are one if they differ by less than half of a part of so many.
const DIRECTIONS: f64 = 1000.0;

/// What is known of a cell, heights along the tool axis, mm.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// The highest place at feed of the whole program.
    top: f64,
    /// The lowest place at feed so far.
    low: f64,
}

/// Cuts of one direction of the tool.
#[derive(Clone, Debug)]
struct Heights {
    /// Directions across the tool, and along it.
    frame: [Vector3<f64>; 3],
    /// Edge of the cells, mm.
    cell: f64,
    cells: BTreeMap<[i64; 2], Cell>,
    /// Least and largest coordinates across the tool, mm.
    extents: [[f64; 2]; 2],
}

/// A rapid that may go where nothing was cut, until the next motion tells.
#[derive(Clone, Copy, Debug)]
struct Suspect {
    line: u64,
    /// Where it ends below what its surroundings were cut to, mm.
    below: f64,
    /// It goes from a cut to a cut, or lower, as long as what follows is a cut that goes no lower.
    until: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// What a program cuts, by directions of the tool.
#[derive(Clone, Debug, Default)]
pub(super) struct CutDepths {
    heights: Vec<([i64; 3], Heights)>,
    /// The last motion was a cut that ended here.
    cut: Option<Vector3<f64>>,
    suspect: Option<Suspect>,
    /// Axes that were led to a position of the machine last, a bit by place: where that is on the part is not known.
    strange: u32,
}

/// A rapid into what was not cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeepRapid {
    /// Its line.
    pub line: u64,
    /// How far below, mm; zero where it is only level with the cut behind it.
    pub below: f64,
}

impl CutDepths {
    /// Learns where a program cuts.
    pub fn gather(&mut self, done: &BlockEffect) {
        let BlockEffect::Motion(motion) = done else {
            return;
        };
        if is_cut(motion)
            && let Some(heights) = self.heights_of(motion, true)
        {
            heights.take(motion, |cell, height| cell.top = cell.top.max(height));
        }
    }

    fn heights_of(&mut self, motion: &Motion, new: bool) -> Option<&mut Heights> {
        if motion.turns() {
            return None;
        }
        let axis = motion.to.pose.axis;
        let key = [axis.x, axis.y, axis.z].map(|part| libm::rint(part * DIRECTIONS) as i64);
        let known = self.heights.iter().position(|(known, _)| *known == key);
        let place = match known {
            Some(place) => place,
            None if new && self.heights.len() < MOST_DIRECTIONS => {
                self.heights.push((key, Heights::new(axis)));
                self.heights.len() - 1
            }
            None => return None,
        };
        Some(&mut self.heights[place].1)
    }

    /// Takes the next motion; gives a rapid before it that went where nothing was cut, if it was one.
    pub fn take(&mut self, machine: &Machine, motion: &Motion) -> Option<DeepRapid> {
        let suspect = self.suspect.take();
        let found = suspect.and_then(|suspect| suspect.told(motion));
        let strange = self.strange;
        for place in 0..machine.axes.len() {
            if motion.from.joints[place] != motion.to.joints[place] {
                let bit = 1 << place;
                self.strange =
                    if motion.machine { self.strange | bit } else { self.strange & !bit };
            }
        }
        if is_cut(motion) {
            if let Some(heights) = self.heights_of(motion, false) {
                heights.take(motion, |cell, height| cell.low = cell.low.min(height));
            }
            self.cut = Some(motion.to.pose.tip);
            return found;
        }
        let cut = self.cut.take();
        let linear = machine.axes.iter().enumerate().filter(|(_, axis)| !axis.joint.rotary);
        let linear: u32 = linear.map(|(place, _)| 1 << place).sum();
        let judged = motion.kind == MotionKind::Rapid && !motion.hole && !motion.machine;
        if !judged || self.strange & linear != 0 {
            return found;
        }
        let way = strange & linear == 0 && motion.led & linear == linear;
        if let Some(heights) = self.heights_of(motion, false) {
            self.suspect = heights.suspect(motion, way, cut.is_some());
        }
        found
    }

    /// A block was not understood: where the tool stands is not known.
    pub fn miss(&mut self) {
        self.suspect = None;
        self.cut = None;
        self.strange = u32::MAX;
    }

    /// The program is over.
    pub fn finish(&mut self) -> Option<DeepRapid> {
        let Suspect { line, below, until } = self.suspect.take()?;
        until.is_none().then_some(DeepRapid { line, below })
    }
}

impl Suspect {
    /// Whether it was one, as the motion behind it tells.
    fn told(self, next: &Motion) -> Option<DeepRapid> {
        let Self { line, below, until } = self;
        let sure = until.is_none_or(|(end, axis)| {
            let [from, to] = [next.from.pose.tip, next.to.pose.tip];
            is_cut(next) && (from - end).norm() < SLACK && (to - from).dot(&axis) > -SLACK
        });
        sure.then_some(DeepRapid { line, below })
    }
}

impl Heights {
    fn new(axis: Vector3<f64>) -> Self {
        let least = axis.iamin();
        let across = axis.cross(&Vector3::ith(least, 1.0)).normalize();
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        Self {
            frame: [across, axis.cross(&across), axis],
            cell: FINEST,
            cells: BTreeMap::new(),
            extents: [none; 2],
        }
    }

    fn key(&self, flat: [f64; 2]) -> [i64; 2] {
        flat.map(|at| libm::floor(at / self.cell) as i64)
    }

    /// Places along a motion, across the tool and along it.
    fn places(&self, motion: &Motion) -> impl Iterator<Item = ([f64; 2], f64)> + use<> {
        let [from, to] = [&motion.from, &motion.to].map(|end| end.pose.tip);
        let curved = motion.way.is_curved();
        // Of a curve a turn is not much longer than the axes go.
        let length = match curved {
            true => motion.feed * motion.minutes,
            false => (to - from).norm(),
        };
        let count = libm::ceil(2.0 * length / self.cell).clamp(1.0, MOST_PLACES);
        let (frame, motion) = (self.frame, motion.clone());
        (0..=count as u32).map(move |step| {
            let share = f64::from(step) / count;
            let tip = if curved { motion.at(share).tip } else { from + (to - from) * share };
            ([frame[0].dot(&tip), frame[1].dot(&tip)], frame[2].dot(&tip))
        })
    }

    /// Does something with the cells that a cut goes through.
    fn take(&mut self, motion: &Motion, change: impl Fn(&mut Cell, f64)) {
        for (flat, height) in self.places(motion) {
            let none = Cell { top: f64::NEG_INFINITY, low: f64::INFINITY };
            let key = self.key(flat);
            change(self.cells.entry(key).or_insert(none), height);
            for (extent, at) in self.extents.iter_mut().zip(flat) {
                *extent = [extent[0].min(at), extent[1].max(at)];
            }
        }
        while self.cells.len() > MOST_CELLS {
            self.cell *= 2.0;
            for (key, cell) in std::mem::take(&mut self.cells) {
                let kept = self.cells.entry(key.map(|at| at.div_euclid(2))).or_insert(cell);
                kept.top = kept.top.max(cell.top);
                kept.low = kept.low.min(cell.low);
            }
        }
    }

    /// Nothing was cut about a place so far that is as low.
    fn is_uncut(&self, flat: [f64; 2], height: f64) -> bool {
        let [x, y] = self.key(flat);
        let reach = libm::ceil(CLEARED / self.cell) as i64;
        let mut rows = x - reach..=x + reach;
        rows.all(|x| {
            let mut row = self.cells.range([x, y - reach]..=[x, y + reach]);
            row.all(|(_, cell)| cell.low > height + SLACK)
        })
    }

    /// A place lies inside of all that is cut, and not on its border: from there tools come in beside the part.
    fn is_inside(&self, flat: [f64; 2]) -> bool {
        self.extents.iter().zip(flat).all(|([least, most], at)| {
            let room = self.cell + 0.02 * (most - least);
            at > least + room && at < most - room
        })
    }

    /// Whether a rapid goes where nothing was cut before: on its `way`, or where it ends; `cut` says that it begins where a
    /// cut ended.
    fn suspect(&self, motion: &Motion, way: bool, cut: bool) -> Option<Suspect> {
        let axis = self.frame[2];
        let end = motion.to.pose.tip;
        let rises = (end - motion.from.pose.tip).dot(&axis);
        let places: Vec<_> = self.places(motion).collect();
        let looked = if way { &places[..] } else { &places[places.len() - 1..] };
        let is_deep =
            |flat: [f64; 2], height: f64| self.is_inside(flat) && self.is_uncut(flat, height);
        let mut below: f64 = 0.0;
        for (flat, height) in looked {
            let top = self.cells.get(&self.key(*flat)).map_or(f64::NEG_INFINITY, |cell| cell.top);
            // A cell is steep where what it has of the path is.
            if top - height > below.max(self.cell) && is_deep(*flat, *height) {
                below = top - height;
            }
        }
        let line = motion.line;
        if below > 0.0 {
            return Some(Suspect { line, below, until: None });
        }
        let some = looked.iter().rev().step_by(looked.len().div_ceil(LOOKS));
        let level = match rises < -SLACK {
            true => some.take(1).any(|(flat, height)| is_deep(*flat, *height)),
            false => {
                let mut some = some;
                cut && rises < SLACK && some.any(|(flat, height)| is_deep(*flat, *height))
            }
        };
        level.then_some(Suspect { line, below: 0.0, until: Some((end, axis)) })
    }
}

/// Something is cut on a motion, as far as the program says.
fn is_cut(motion: &Motion) -> bool {
    motion.kind != MotionKind::Rapid && !motion.fast && !motion.machine
}
