//! Holes: the control's own cycle in the place of the moves, where it does the same.
//!
//! The moves of a hole come through every stage before this one, so that travel, speed, time and certificate are those
//! of what the cycle does. They are written as a cycle if the rotary axes stand, and below the retract level
//! nothing but the depth word moves, toward minus (or along any axis, if the control has that where it keeps the tip);
//! else as they are.

use post_machine::axis_words::{self, WordValues, unit_length};
use post_machine::description::{Machine, Tcp};
use post_machine::diagnostic::{Diagnostic, Short};
use post_plugin::{Capabilities, Cycle, Event, Feed, ToolPose};

use super::EmitStage;
use crate::blocks::{BlockKind, MotionBlock};
use crate::program::{HoleCycle, MoveFeed};
use crate::stream::{HoleMoves, StreamItem};

/// A feed that differs by less is the same.
const SAME_FEED: f64 = 1e-6;

/// The cycle in force: what [`Event::Cycle`] said, and where its points have their retract level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CommandedCycle {
    kind: Cycle,
    feed: Feed,
    depth: f64,
    clearance: f64,
    retract: f64,
    step: Option<f64>,
    dwell: Option<f64>,
    pitch: Option<f64>,
    /// The words of the point, but for those across the tool that differ from hole to hole.
    level: WordValues,
}

/// A hole as a cycle.
struct NativeCycle {
    cycle: CommandedCycle,
    /// All axis words with the tip on the point.
    words: WordValues,
    /// Distance by which it is farther off the CL path than the moves are, mm.
    drift: f64,
}

/// Places of the words that cycles move.
pub(super) struct CycleWordPlaces {
    /// The word Z of the linear axis along which the cycles of a control drill.
    pub z: Option<usize>,
    /// The same, if the tool stands along it with every rotary axis at zero.
    pub depth: Option<usize>,
    /// Those of the other linear axes that move in cuts.
    pub across: Vec<usize>,
}

impl CycleWordPlaces {
    pub(super) fn new(machine: &Machine) -> Self {
        let order = axis_words::order(machine);
        let z = order.iter().position(|joint| machine.axes[*joint].word() == "Z");
        // Depths of a cycle are lengths: beside a word that is a multiple of its axis they would be of two sorts.
        let plain =
            |place: &usize| machine.word_map.as_ref().is_none_or(|map| map.is_plain(order[*place]));
        let z = z.filter(plain);
        let along = |place: &usize| axis_words::depth(machine) == Some(order[*place]);
        let moves = |place: &usize| {
            let axis = &machine.axes[order[*place]];
            !axis.joint.rotary && axis.indexed.is_none() && z != Some(*place)
        };
        Self { z, depth: z.filter(along), across: (0..order.len()).filter(moves).collect() }
    }
}

impl EmitStage<'_> {
    /// The cycle in force ends.
    #[inline]
    pub(super) fn end_cycle(&mut self, line: u64) {
        if self.cycle.take().is_some() {
            self.writer.push(line, Event::CycleOff);
        }
    }

    /// A hole, as a cycle or by its moves.
    pub(super) fn hole(&mut self, hole: &HoleMoves<MotionBlock>) {
        // On the way to it a tilted plane may begin, or end: what the control has there is known behind that.
        let moves_alone = points(&hole.above).count() == hole.above.len();
        let before = if moves_alone { self.native(hole) } else { None };
        // The control itself goes from hole to hole, if nothing else is on the way.
        let goes_on = before.as_ref().is_some_and(|native| {
            self.cycle == Some(native.cycle) && self.stays_level(&hole.above, &native.cycle.level)
        });
        if goes_on {
            self.pass(points(&hole.above), 0.0);
        } else {
            self.end_cycle(hole.line);
            self.elements(&hole.above);
        }
        let native = if moves_alone { before } else { self.native(hole) };
        if native.is_none() && never_waits(&hole.cycle) && self.drills_along().is_some() {
            self.findings.at(hole.line, waits_by_moves());
        }
        if native.is_none() && hole.cycle.alone {
            // Of a hole that is out of travel moves are missing: that stands for itself.
            if !self.findings.failed() || self.drills_along().is_none() {
                self.findings.at(hole.line, not_here());
            }
            for _ in points(&hole.into) {
                self.writer.place(self.writer.next());
            }
            return;
        }
        if self.spindle.waits.is_some() && native.is_some() {
            self.wake(hole.line);
        }
        match native {
            None => self.elements(&hole.into),
            Some(native) => {
                self.point(hole, &native, goes_on);
                let made = match goes_on {
                    true => points(&hole.above).count(),
                    false => 0,
                };
                for _ in 0..made + points(&hole.into).count() {
                    self.writer.place(0);
                }
            }
        }
    }

    /// Blocks that the control makes itself.
    fn pass<'b>(&mut self, blocks: impl Iterator<Item = &'b MotionBlock>, drift: f64) {
        for block in blocks.filter(|block| !block.still) {
            let mut drifted = *block;
            drifted.deviation.tip += drift;
            self.keep_limits(block, None);
            self.extremes.cover(&block.joints);
            self.extremes.go(&self.last, &block.joints);
            self.extremes.mark(&drifted, self.writer.next());
            self.last = block.joints;
        }
    }

    /// The cycle, unless it is in force, and its point.
    fn point(&mut self, hole: &HoleMoves<MotionBlock>, native: &NativeCycle, in_force: bool) {
        if self.clamps()
            && let Some(block) = points(&hole.into).find(|block| block.kind == BlockKind::Linear)
        {
            self.clamp(block);
        }
        let cycle = native.cycle;
        if !in_force {
            self.cycle = Some(cycle);
            self.writer.push(
                hole.line,
                Event::Cycle {
                    cycle: cycle.kind,
                    feed: cycle.feed,
                    depth: cycle.depth,
                    clearance: cycle.clearance,
                    retract: cycle.retract,
                    step: cycle.step,
                    dwell: cycle.dwell,
                    pitch: cycle.pitch,
                },
            );
        }
        self.pass(points(&hole.into), native.drift);
        self.extremes.blocks += 1;
        let words = &native.words[..self.writer.words()];
        let tool = Some(ToolPose { tip: hole.point.into(), axis: hole.axis.into() });
        self.writer.push(hole.line, Event::CyclePoint { tool, words });
    }

    /// Every block of the way to the next hole keeps to the level of the last one.
    fn stays_level(&self, above: &[StreamItem<MotionBlock>], level: &WordValues) -> bool {
        points(above)
            .all(|block| block.kind == BlockKind::Rapid && self.across_alone(&block.words, level))
    }

    /// Two sets of words differ in those across the tool alone.
    fn across_alone(&self, words: &WordValues, level: &WordValues) -> bool {
        (0..self.writer.words())
            .all(|place| self.cycle_words.across.contains(&place) || words[place] == level[place])
    }

    /// Place of the word along which the control drills here; none if it has no cycles here.
    fn drills_along(&self) -> Option<usize> {
        // Where the control keeps the tip, and where the plane is tilted, it must have said so.
        let tilted = self.plane.on || self.plane.wanted.is_some();
        let (place, needs) = match (tilted, self.machine.control.tcp) {
            (true, _) => (self.cycle_words.z, Capabilities::CYCLE_IN_PLANE),
            (false, Tcp::Control) => (self.cycle_words.z, Capabilities::CYCLE_TCP),
            (false, Tcp::Post) => (self.cycle_words.depth, Capabilities::NONE),
        };
        place.filter(|_| self.writer.knows(needs))
    }

    /// The hole as a cycle; none if it is not the same.
    fn native(&self, hole: &HoleMoves<MotionBlock>) -> Option<NativeCycle> {
        let machine = self.machine;
        let drilling = &hole.cycle;
        let place = self.drills_along()?;
        if never_waits(drilling)
            || drilling.waits() && self.writer.knows(Capabilities::CYCLE_NO_DWELL)
        {
            return None;
        }
        let level = points(&hole.above).last()?;
        let moves = points(&hole.into).all(|block| {
            matches!(block.kind, BlockKind::Rapid | BlockKind::Linear)
                && self.rotary_stand(&block.words, &level.words)
        });
        if !moves {
            return None;
        }
        let feed = self.cycle_feed(hole)?;
        let unit = unit_length(machine.control.units);
        let printed = |value: f64| self.words.printed(place, value);
        let lengths = [drilling.depth, drilling.clearance, drilling.retract].map(|way| way / unit);
        let mut words = level.words;
        let mut drift = 0.0;
        let [depth, clearance, retract] = if self.upright(hole, level, place) {
            drift = self.drift(hole, level, place)? * unit;
            let bottom = points(&hole.into).map(|block| block.words[place]);
            let bottom = bottom.fold(f64::INFINITY, f64::min);
            let start = points(&hole.into).next()?.words[place];
            words[place] = printed(level.words[place] - lengths[2])?;
            let point = words[place];
            // What the control makes of them are the printed heights of the moves.
            [
                printed(point - bottom)?,
                printed(start - point)?,
                printed(level.words[place] - point)?,
            ]
        } else {
            let any = machine.control.tcp == Tcp::Control
                && self.plane.wanted.is_none()
                && self.writer.knows(Capabilities::CYCLE_ANY_AXIS);
            if !any {
                return None;
            }
            self.words.print_tip(hole.point, &mut words)?;
            [printed(lengths[0])?, printed(lengths[1])?, printed(lengths[2])?]
        };
        // The words across the tool differ from hole to hole.
        let mut stands = level.words;
        for place in &self.cycle_words.across {
            stands[*place] = 0.0;
        }
        let in_units = |way: Option<f64>| way.map(|way| way / unit);
        Some(NativeCycle {
            cycle: CommandedCycle {
                kind: drilling.kind,
                feed,
                depth,
                clearance,
                retract,
                step: in_units(drilling.step),
                dwell: drilling.dwell,
                pitch: in_units(drilling.pitch),
                level: stands,
            },
            words,
            drift,
        })
    }

    /// The rotary words, and those of linear axes that stand between cuts, are the same.
    fn rotary_stand(&self, words: &WordValues, level: &WordValues) -> bool {
        (0..self.writer.words()).all(|place| {
            self.cycle_words.across.contains(&place)
                || Some(place) == self.cycle_words.depth
                || words[place] == level[place]
        })
    }

    /// The words of the way into the hole go down the depth word.
    fn upright(&self, hole: &HoleMoves<MotionBlock>, level: &MotionBlock, place: usize) -> bool {
        let bottom = points(&hole.into).map(|block| block.words[place]);
        let bottom = bottom.fold(f64::INFINITY, f64::min);
        let unit = unit_length(self.machine.control.units);
        let way = (hole.cycle.retract + hole.cycle.depth) / unit;
        // A tool that leans by more than rounding comes less far down, or goes aside.
        libm::fabs(level.words[place] - bottom - way) <= 1e-6 * way + self.rounding()
    }

    /// Four halves of a last decimal of the linear words: two heights, each rounded, and where the tool axis leans by what
    /// rounds off the rotary words.
    fn rounding(&self) -> f64 {
        let [linear, _] = self.words.half_decimal();
        4.0 * linear / unit_length(self.machine.control.units)
    }

    /// How far the moves leave the straight way down through the level's words, in program units; none if that is more than
    /// the tolerance leaves.
    fn drift(
        &self,
        hole: &HoleMoves<MotionBlock>,
        level: &MotionBlock,
        place: usize,
    ) -> Option<f64> {
        let unit = unit_length(self.machine.control.units);
        let (mut drift, mut deviation) = (0.0_f64, 0.0_f64);
        for block in points(&hole.into) {
            let square: f64 = (0..self.writer.words())
                .filter(|other| *other != place)
                .map(|other| block.words[other] - level.words[other])
                .map(|way| way * way)
                .sum();
            drift = drift.max(square.sqrt());
            deviation = deviation.max(block.deviation.tip);
        }
        let within = drift * unit + deviation <= self.machine.accuracy.tolerance;
        within.then_some(drift)
    }

    /// The feed of the cycle, per minute, as it is printed: that of its slowest block.
    fn cycle_feed(&self, hole: &HoleMoves<MotionBlock>) -> Option<Feed> {
        let unit = unit_length(self.machine.control.units);
        let mut slowest = f64::INFINITY;
        let mut asked = f64::INFINITY;
        for block in points(&hole.into) {
            if block.kind != BlockKind::Linear || block.still {
                continue;
            }
            let feed = match block.time.feed {
                Some(Feed::PerMinute(feed)) => feed,
                _ => block.way / unit / block.time.minutes,
            };
            slowest = slowest.min(feed);
            if let MoveFeed::PerMinute(feed) = block.pace {
                asked = asked.min(feed / unit);
            }
        }
        let scale = (0..self.writer.format().feed).fold(1.0, |scale, _| scale * 10.0);
        let feed = libm::floor(slowest * scale * (1.0 + 1e-12)) / scale;
        if !(feed.is_finite() && feed > 0.0) {
            return None;
        }
        if let Some(pitch) = hole.cycle.pitch {
            if slowest * (1.0 + SAME_FEED) + 1.0 / scale < asked {
                self.findings.at(hole.line, thread_too_fast(asked, slowest));
            }
            // What F is short of, the thread is short of over its depth.
            let short = (1.0 - feed / asked) * (hole.cycle.depth + hole.cycle.clearance);
            if short > self.machine.accuracy.tolerance {
                self.findings.at(hole.line, thread_rounded(pitch, asked, feed, short));
            }
        }
        Some(Feed::PerMinute(feed))
    }
}

/// A hole with a wait at the bottom, which dialects are not asked to write as a cycle of its kind.
fn never_waits(drilling: &HoleCycle) -> bool {
    let never = matches!(drilling.kind, Cycle::Deep | Cycle::BreakChip | Cycle::Bore);
    never && drilling.waits()
}

/// A hole whose cycle has no wait.
fn waits_by_moves() -> Diagnostic {
    Diagnostic::warning(
        "cycle",
        "a wait at the bottom of a hole that is pecked or bored: it is made by moves, not by the control's cycle",
    )
    .help("without DWELL in its CYCLE the control's own is written")
}

fn points(stream: &[StreamItem<MotionBlock>]) -> impl Iterator<Item = &MotionBlock> {
    stream.iter().filter_map(StreamItem::block)
}

/// A cycle that no moves can do, where the control has it in another place alone.
fn not_here() -> Diagnostic {
    Diagnostic::error(
        "cycle",
        "this cycle must be the control's own (moves cannot tie the feed to the spindle's turns, or stop the spindle \
         in the hole), and here the control has none: the tool does not stand along Z, or tool centre point control \
         is on",
    )
    .help("[control] planes = true where the control has tilted planes; or tcp = \"post\"; or thread milling")
}

fn thread_too_fast(asked: f64, possible: f64) -> Diagnostic {
    Diagnostic::error(
        "cycle",
        format!(
            "this thread needs F{}, and with the max_feed of the axes F{} is possible",
            Short(asked),
            Short(possible)
        ),
    )
    .help("a lower speed of the spindle")
}

fn thread_rounded(pitch: f64, asked: f64, feed: f64, short: f64) -> Diagnostic {
    Diagnostic::warning(
        "cycle",
        format!(
            "a thread of {} mm a turn needs F{}, and F{} is printed: over its depth the tap lags by {} mm",
            Short(pitch),
            Short(asked),
            Short(feed),
            Short(short)
        ),
    )
    .help("a speed of the spindle at which the feed has no more decimals; a dialect that writes the pitch prints no F")
}
