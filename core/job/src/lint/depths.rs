//! Rapids that go lower than anything was cut before, where nobody says what the stock is.
//!
//! A program is run twice: once to learn from how high its cuts come down at each place, once to see what was cut before
//! each rapid. Places are cells across the tool axis; memory does not grow with the program, as cells do.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::Pose;
use post_readback::{BlockEffect, Motion, MotionKind};

use super::passes::{Heading, Link, Pass, SLACK, is_cut};

/// Edge of a cell at first, mm.
const FINEST: f64 = 1.0;

/// Cells that are kept; of more they are made twice as large.
const MOST_CELLS: usize = 1 << 16;

/// Directions of the tool that are kept; rapids along others are not looked at.
const MOST_DIRECTIONS: usize = 16;

/// Places of a motion that are looked at, at most.
const MOST_PLACES: f64 = 4096.0;

/// A cut clears so much to each side, mm: half of a small cutter.
const CLEARED: f64 = 6.0;

/// Places of a rapid from cut to cut that are looked at.
const LOOKS: usize = 16;

/// Of ways to the depth one of so many goes by rapid by mistake, and of ways at one depth so many; where more do, the
/// program is written so.
const FEW: [u64; 2] = [12, 3];

/// Directions of the tool are one if they differ by less than half of a part of so many.
const DIRECTIONS: f64 = 1000.0;

/// What is known of a cell, heights along the tool axis, mm.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// The highest place at feed of the whole program.
    top: f64,
    /// The lowest and the highest place at feed so far.
    low: f64,
    high: f64,
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
    rapid: DeepRapid,
    /// Where it ends, and the tool axis there: it is one as long as what follows is a cut that goes no lower; none where it
    /// is one in any case.
    until: Option<(Vector3<f64>, Vector3<f64>)>,
}

/// What a program cuts, by directions of the tool.
#[derive(Clone, Debug, Default)]
pub(super) struct CutDepths {
    heights: Vec<([i64; 3], Heights)>,
    /// The last motion was a cut that went so.
    cut: Option<Heading>,
    suspect: Option<Suspect>,
    /// The tool is at the depth of the last cut: none but rapids across followed it.
    level: bool,
    /// How the last motion went, if it was a rapid on the part.
    rapid: Option<Heading>,
    link: Option<Link>,
    pass: Option<Pass>,
    /// Passes that begin by coming down at feed.
    fed_down: u64,
    /// Cuts that stay at their depth.
    level_cuts: u64,
    /// The first rapid down to the depth of a cut that may be beside the part, and the first across at the depth of cuts;
    /// how many there are of each.
    beside: [Option<(u64, u64)>; 2],
    /// Axes that were led to a position of the machine last, a bit by place: where that is on the part is not known.
    strange: u32,
}

/// A rapid into what was not cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeepRapid {
    /// Its line.
    pub line: u64,
    /// What tells so.
    pub why: Depth,
}

/// What tells that a rapid goes where nothing was cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Depth {
    /// It is so much below where cuts come down at feed, mm.
    Below(f64),
    /// It goes down to the depth of the cut behind it, or from cut to cut, within what is cut.
    Level,
    /// It goes down on a contour that is cut all around from there.
    Contour,
    /// It goes down to the depth of the cut behind it, and others come down at feed; it may be beside the part.
    Down,
    /// It goes from cut to cut at their depth, and others are cuts; it may be beside the part.
    Across,
    /// It goes on down as the rapid before it did, by little, to where a cut begins.
    Staged,
    /// It goes on as the cuts before and behind it do.
    Path,
    /// It ends inside the raw part, where nothing was cut before.
    Stock,
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

    /// Takes the next motion; `found` is told of rapids before it that went where nothing was cut.
    pub fn take(&mut self, machine: &Machine, motion: &Motion, mut found: impl FnMut(DeepRapid)) {
        let link = self.link.take().filter(|link| link.goes_on_in(motion));
        let suspected = self.suspect.take();
        let suspect = suspected.and_then(|suspect| suspect.told(motion));
        let carried = suspected.and_then(|suspect| suspect.carried(motion));
        if let Some(rapid) = suspect {
            if rapid.why == Depth::Down {
                self.pass = Some(Pass::new(rapid.line, motion));
            }
            match rapid.why {
                Depth::Down | Depth::Across if link.is_some() => {}
                Depth::Down | Depth::Across => {
                    let place = usize::from(rapid.why == Depth::Across);
                    self.beside[place].get_or_insert((rapid.line, 0)).1 += 1;
                }
                _ => found(rapid),
            }
        }
        let beside = suspect.is_none_or(|rapid| matches!(rapid.why, Depth::Down | Depth::Across));
        if let (true, Some(link)) = (beside, link) {
            found(DeepRapid { line: link.line, why: Depth::Path });
        }
        let strange = self.strange;
        for place in 0..machine.axes.len() {
            if motion.from.joints[place] != motion.to.joints[place] {
                let bit = 1 << place;
                self.strange =
                    if motion.machine { self.strange | bit } else { self.strange & !bit };
            }
        }
        let level = std::mem::take(&mut self.level);
        if is_cut(motion) {
            self.cut(motion, found);
            return;
        }
        self.pass = None;
        let (cut, before) = (self.cut.take(), self.rapid.take());
        let linear = machine.axes.iter().enumerate().filter(|(_, axis)| !axis.joint.rotary);
        let linear: u32 = linear.map(|(place, _)| 1 << place).sum();
        let judged = motion.kind == MotionKind::Rapid && !motion.hole && !motion.machine;
        if !judged || self.strange & linear != 0 {
            return;
        }
        let mills = machine.along.is_none() && motion.state.solver.chain().edge().is_none();
        let heading = Heading::of(motion);
        self.rapid = Some(heading);
        if let (true, Some(before)) = (mills, cut) {
            self.link = Some(Link { line: motion.line, before, way: heading });
        }
        let way = strange & linear == 0 && motion.led & linear == linear;
        let level = level || cut.is_some();
        self.level = level && is_across(motion);
        if let Some(heights) = self.heights_of(motion, false) {
            let suspect = heights.suspect(motion, way, level);
            let beside = |why| matches!(why, Depth::Down | Depth::Across);
            let suspect = suspect.filter(|suspect| mills || !beside(suspect.rapid.why));
            self.suspect = match (carried, suspect) {
                (Some(carried), Some(next)) if next.is_surer(carried) => Some(next),
                (Some(carried), _) => Some(carried),
                (None, next) => next,
            };
        }
        let unsure = |suspect: Suspect| suspect.until.is_some();
        if self.suspect.is_none_or(unsure)
            && mills
            && ends_in_stock(machine, motion)
            && self.is_uncut(motion)
        {
            let rapid = DeepRapid { line: motion.line, why: Depth::Stock };
            self.suspect = Some(Suspect { rapid, until: None });
        }
        let known = self.suspect.is_some_and(|suspect| !matches!(suspect.rapid.why, Depth::Down));
        let staged = mills && before.is_some_and(|before| heading.goes_on_down(before, motion));
        if staged && !known && self.is_uncut(motion) {
            let rapid = DeepRapid { line: motion.line, why: Depth::Staged };
            let Pose { tip, axis, .. } = motion.to.pose;
            self.suspect = Some(Suspect { rapid, until: Some((tip, axis)) });
        }
    }

    /// Nothing was cut so far about the end of a motion that is as low, as far as that is known.
    fn is_uncut(&mut self, motion: &Motion) -> bool {
        let tip = motion.to.pose.tip;
        self.heights_of(motion, false).is_none_or(|heights| {
            let [across, up, along] = heights.frame;
            heights.is_uncut([across.dot(&tip), up.dot(&tip)], along.dot(&tip))
        })
    }

    /// Takes a cut.
    fn cut(&mut self, motion: &Motion, mut found: impl FnMut(DeepRapid)) {
        if let Some(heights) = self.heights_of(motion, false) {
            heights.take(motion, |cell, height| {
                (cell.low, cell.high) = (cell.low.min(height), cell.high.max(height));
            });
        }
        self.rapid = None;
        let heading = Heading::of(motion);
        let way = motion.to.pose.tip - motion.from.pose.tip;
        let rises = way.dot(&motion.to.pose.axis);
        self.fed_down += u64::from(self.cut.is_none() && !motion.hole && rises < -SLACK);
        self.level_cuts += u64::from(libm::fabs(rises) < SLACK && heading.length > SLACK);
        // From the bottom of a hole nothing goes across.
        self.cut = (!motion.hole).then_some(heading);
        let around = self.pass.as_mut().is_some_and(|pass| pass.is_around(motion, heading));
        if let Some(pass) = self.pass.take_if(|_| around) {
            found(DeepRapid { line: pass.line, why: Depth::Contour });
        }
    }

    /// A block was not understood: where the tool stands is not known.
    pub fn miss(&mut self) {
        (self.suspect, self.link, self.pass) = (None, None, None);
        self.level = false;
        (self.cut, self.rapid) = (None, None);
        self.strange = u32::MAX;
    }

    /// The program is over.
    pub fn finish(&mut self, mut found: impl FnMut(DeepRapid)) {
        if let Some(Suspect { rapid, until: None }) = self.suspect.take() {
            found(rapid);
        }
        let kinds = [(Depth::Down, self.fed_down), (Depth::Across, self.level_cuts)];
        for ((beside, (why, others)), few) in self.beside.iter().zip(kinds).zip(FEW) {
            if let Some((line, count)) = *beside
                && count * few <= others
            {
                (0..count).for_each(|_| found(DeepRapid { line, why }));
            }
        }
    }
}

/// A motion stays at its height.
fn is_across(motion: &Motion) -> bool {
    let [from, to] = [&motion.from, &motion.to].map(|end| end.pose.tip);
    !motion.turns() && libm::fabs((to - from).dot(&motion.to.pose.axis)) < SLACK
}

/// A motion ends inside the box around the raw part, as far as that is known.
fn ends_in_stock(machine: &Machine, motion: &Motion) -> bool {
    let tip = motion.to.pose.tip;
    machine.stock_extents().is_some_and(|[least, most]| {
        (0..3).all(|part| tip[part] > least[part] + SLACK && tip[part] < most[part] - SLACK)
    })
}

impl Suspect {
    /// The rapid, if it was one, as the motion behind it tells.
    fn told(self, next: &Motion) -> Option<DeepRapid> {
        let sure = self.until.is_none_or(|(end, axis)| {
            let [from, to] = [next.from.pose.tip, next.to.pose.tip];
            is_cut(next) && (from - end).norm() < SLACK && (to - from).dot(&axis) > -SLACK
        });
        sure.then_some(self.rapid)
    }

    /// A way from cut to cut may be several rapids: it, where the rapid `next` goes on at its height.
    fn carried(self, next: &Motion) -> Option<Self> {
        let (end, _) = self.until?;
        let goes_on = (next.from.pose.tip - end).norm() < SLACK && is_across(next);
        let across = matches!(self.rapid.why, Depth::Level | Depth::Across);
        let Pose { tip, axis, .. } = next.to.pose;
        (across && goes_on && next.kind == MotionKind::Rapid)
            .then_some(Self { until: Some((tip, axis)), ..self })
    }

    /// It tells more than one that began before it on the same way.
    fn is_surer(&self, before: Self) -> bool {
        self.until.is_none() || before.rapid.why == Depth::Across && self.rapid.why == Depth::Level
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
            let none = Cell { top: f64::NEG_INFINITY, low: f64::INFINITY, high: f64::NEG_INFINITY };
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
                kept.high = kept.high.max(cell.high);
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

    /// A cut came down here at feed before, and not as low.
    fn is_plunged(&self, flat: [f64; 2], height: f64) -> bool {
        let known = self.cells.get(&self.key(flat));
        known.is_some_and(|Cell { low, high, .. }| *high > low + self.cell && height < low - SLACK)
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
        let is_level = |flat: [f64; 2], height: f64| {
            is_deep(flat, height) || self.is_plunged(flat, height) && self.is_uncut(flat, height)
        };
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
            return Some(Suspect {
                rapid: DeepRapid { line, why: Depth::Below(below) },
                until: None,
            });
        }
        let sinks = rises < -SLACK;
        if !(sinks || cut && rises < SLACK) {
            return None;
        }
        let looks = if sinks { 1 } else { LOOKS };
        let some = looked.iter().rev().step_by(looked.len().div_ceil(LOOKS)).take(looks);
        let why = match () {
            () if some.clone().any(|(flat, height)| is_level(*flat, *height)) => Depth::Level,
            () if !some.clone().any(|(flat, height)| self.is_uncut(*flat, *height)) => return None,
            () if sinks => Depth::Down,
            () => Depth::Across,
        };
        Some(Suspect { rapid: DeepRapid { line, why }, until: Some((end, axis)) })
    }
}
