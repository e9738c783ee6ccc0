//! Where the control keeps the tip, the machine's own linear axes leave the straight line between the words: how far
//! they go on the way, and how fast.
//!
//! A cheap bound clears nearly all blocks; the others are worked out ([`TcpBlock`]).

use post_machine::description::{Machine, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::batch::{Column, LANES, Lanes, groups, largest, widely};
use post_machine::kinematics::travel::{OverTravel, over};
use post_machine::kinematics::{Joints, MAX_AXES, TcpBlock};

use super::PathLeg;
use crate::accuracy::{PathNode, Placer, RunColumns};
use crate::findings::Findings;
use crate::refusal::{self, FINDS_A_MOUNT};

/// No control resolves less, mm: an axis may pass the end of its travel by this between the words.
const RESOLVED: f64 = 1e-4;

/// What range and way of an axis may be off by in a block without its being worked out, mm.
const UNSEEN: f64 = 1e-3;

/// The least time of a block in which the linear axes keep up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FollowTime {
    /// Minutes; zero where nothing has to follow.
    pub minutes: f64,
    /// What asks for it: the place of an axis in the chain, or [`MAX_AXES`] and the place of a leg among the legs.
    pub joint: usize,
}

/// What the linear axes do between the words, over the program.
#[derive(Clone, Debug)]
pub(crate) struct CompensatingMotion {
    /// The control keeps the tip.
    keeps: bool,
    /// Minutes that each axis needs for one mm or radian at its largest feed.
    slowness: Joints,
    /// Least and largest values in the blocks that were worked out, mm.
    least: Joints,
    most: Joints,
    /// What each axis goes beside the way from word to word, mm.
    beside: Joints,
}

impl CompensatingMotion {
    pub(super) fn new(machine: &Machine) -> Self {
        Self {
            keeps: machine.control.tcp == Tcp::Control,
            slowness: machine.slowness(),
            least: [f64::INFINITY; MAX_AXES],
            most: [f64::NEG_INFINITY; MAX_AXES],
            beside: Joints::default(),
        }
    }

    /// Another head is in.
    pub(super) fn set(&mut self, machine: &Machine) {
        self.keeps = machine.control.tcp == Tcp::Control;
        self.slowness = machine.slowness();
    }

    /// The control keeps the tip.
    pub(super) fn keeps(&self) -> bool {
        self.keeps
    }

    /// The least value of an axis between the words, mm; infinite if nothing is known of one.
    pub(crate) fn least(&self, joint: usize) -> f64 {
        self.least[joint]
    }

    /// The largest value of an axis between the words, mm; infinitely small if nothing is known of one.
    pub(crate) fn most(&self, joint: usize) -> f64 {
        self.most[joint]
    }

    /// What an axis goes beside the way from word to word, mm.
    pub(crate) fn beside(&self, joint: usize) -> f64 {
        self.beside[joint]
    }

    /// A block in which something turns, and for which the CL file asks `asked` minutes at least. If it leaves travel on
    /// the way, that is a finding.
    #[inline]
    pub(super) fn block(
        &mut self,
        machine: &Machine,
        (leg, [from, to]): (&PathLeg<'_>, [&PathNode; 2]),
        asked: f64,
        findings: &Findings,
    ) -> FollowTime {
        if !self.keeps {
            return FollowTime::default();
        }
        let along = leg.placer.control_point().along;
        let Some(kept) = TcpBlock::new(leg.placer.solver(), along, &from.trace, &to.trace) else {
            return FollowTime::default();
        };
        let ends = [&from.trace.joints, &to.trace.joints];
        if let Some(follow) = self.cleared(machine, leg.placer, kept.quick(), ends, asked) {
            return follow;
        }
        self.look_into(machine, &kept, (leg, [from, to]), asked, findings)
    }

    /// The least time, if the cheap bound says all that there is to know: inside travel, in time, and nothing of
    /// range or way goes unseen.
    #[inline]
    pub(super) fn cleared(
        &self,
        machine: &Machine,
        placer: &Placer,
        bend: f64,
        [from, to]: [&Joints; 2],
        asked: f64,
    ) -> Option<FollowTime> {
        let mut follow = FollowTime::default();
        for joint in placer.solver().sliding()? {
            let slide = Slide::new(machine.axes[joint].travel, self.slowness[joint]);
            let (minutes, clear) = slide.follow(bend, from[joint], to[joint]);
            if !clear || minutes > asked {
                return None;
            }
            if minutes > follow.minutes {
                follow = FollowTime { minutes, joint };
            }
        }
        Some(follow)
    }

    /// [`CompensatingMotion::cleared`] of the blocks of a run, whose second derivatives keep to `bends`, mm: the run ends
    /// before the first that has to be looked into. Where nothing turns nothing has to follow.
    pub(super) fn cleared_all(
        &self,
        machine: &Machine,
        placer: &Placer,
        bends: &Lanes,
        run: &mut RunColumns,
    ) {
        let Some(sliding) = placer.solver().sliding() else {
            return run.end_before(|_, _| true);
        };
        let joints = placer.solver().chain().joints();
        let [mut doubts, mut turning] = [[0.0; LANES]; 2];
        let doubt = widely(
            #[inline(always)]
            || {
                let RunColumns { count, joints: values, way, feeds, follow, .. } = run;
                *follow = [0.0; LANES];
                for (joint, values) in joints.iter().zip(values.iter()) {
                    if joint.rotary {
                        mark_turns(values, *count, &mut turning);
                    }
                }
                for joint in sliding {
                    let slide = Slide::new(machine.axes[joint].travel, self.slowness[joint]);
                    slide.follow_all(bends, &values[joint], *count, (follow, &mut doubts));
                }
                for lane in 0..groups(*count) {
                    let late = follow[lane] > way[lane] / feeds[lane];
                    let doubt = if late { 1.0 } else { doubts[lane] };
                    doubts[lane] = doubt * turning[lane];
                    follow[lane] *= turning[lane];
                }
                largest(&doubts[..*count])
            },
        );
        if doubt > 0.0 {
            run.end_before(|_, lane| doubts[lane] > 0.0);
        }
    }

    #[inline(never)]
    fn look_into(
        &mut self,
        machine: &Machine,
        kept: &TcpBlock<'_>,
        (leg, [from, to]): (&PathLeg<'_>, [&PathNode; 2]),
        asked: f64,
        findings: &Findings,
    ) -> FollowTime {
        let Some(slides) = kept.slides(&self.slowness, asked) else {
            findings.at(
                leg.line,
                Diagnostic::error(
                    "out-of-reach",
                    format!(
                        "between the words the linear axes of {} cannot keep the tip on its line while {}",
                        machine.name,
                        turning(machine, [from, to])
                    ),
                )
                .help("they lie in one plane on the way: a point between, or tcp = \"post\""),
            );
            return FollowTime::default();
        };
        for joint in kept.sliding() {
            let (least, most) = (slides.least[joint], slides.most[joint]);
            let (first, last) = (from.trace.joints[joint], to.trace.joints[joint]);
            if least < first.min(last) - RESOLVED {
                self.least[joint] = self.least[joint].min(least);
            }
            if most > first.max(last) + RESOLVED {
                self.most[joint] = self.most[joint].max(most);
            }
            self.beside[joint] += (slides.way[joint] - (last - first).abs()).max(0.0);
            for value in [least, most] {
                let travel = machine.axes[joint].travel;
                if let Err(over) = over(joint, travel, value, RESOLVED) {
                    findings.at(leg.line, over_travel(machine, &over, [from, to]));
                    break;
                }
            }
        }
        FollowTime { minutes: slides.minutes, joint: slides.slowest }
    }
}

/// A linear axis that follows.
#[derive(Clone, Copy)]
struct Slide {
    /// Travel, mm.
    least: f64,
    most: f64,
    /// Minutes that it needs for one mm.
    slowness: f64,
}

impl Slide {
    fn new(travel: Option<[f64; 2]>, slowness: f64) -> Self {
        let [least, most] = travel.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        Self { least, most, slowness }
    }

    /// The least time of a block from `first` to `last`, mm, whose second derivative keeps to `bend`, minutes; and whether
    /// it stays inside travel and nothing of its range or way goes unseen.
    #[inline(always)]
    fn follow(self, bend: f64, first: f64, last: f64) -> (f64, bool) {
        // A curve strays from its chord by an eighth of what its second derivative can be, its slope from the
        // chord's by half of it, and a curve that turns back goes a quarter of it more at most.
        let (strays, faster) = (bend / 8.0, bend / 2.0);
        let chord = (last - first).abs();
        let low = if first < last { first } else { last };
        let high = if first < last { last } else { first };
        let inside = (low - strays >= self.least) & (high + strays <= self.most);
        let clear = (chord >= faster) | ((bend <= 4.0 * UNSEEN) & inside);
        ((chord + faster) * self.slowness, clear)
    }

    /// [`Slide::follow`] of many blocks: keeps the longest times, and marks by 1 what is not clear.
    #[inline(always)]
    fn follow_all(
        self,
        bends: &Lanes,
        values: &Column,
        count: usize,
        (times, doubts): (&mut Lanes, &mut Lanes),
    ) {
        for lane in 0..groups(count) {
            let (minutes, clear) = self.follow(bends[lane], values[lane], values[lane + 1]);
            times[lane] = if minutes > times[lane] { minutes } else { times[lane] };
            doubts[lane] = if clear { doubts[lane] } else { 1.0 };
        }
    }
}

/// Marks by 1 the blocks in which a joint turns.
#[inline(always)]
fn mark_turns(values: &Column, count: usize, turning: &mut Lanes) {
    for lane in 0..groups(count) {
        turning[lane] = if values[lane] != values[lane + 1] { 1.0 } else { turning[lane] };
    }
}

/// `B turns from -10.000° to 10.000°`.
fn turning(machine: &Machine, [from, to]: [&PathNode; 2]) -> String {
    let mut turns = Vec::new();
    for (joint, axis) in machine.axes.iter().enumerate() {
        let (first, last) = (from.trace.joints[joint], to.trace.joints[joint]);
        if axis.joint.rotary && first != last {
            turns.push(format!(
                "{} turns from {:.3}° to {:.3}°",
                axis.name,
                axis.reading(first),
                axis.reading(last)
            ));
        }
    }
    turns.join(" and ")
}

fn over_travel(machine: &Machine, over: &OverTravel, ends: [&PathNode; 2]) -> Diagnostic {
    Diagnostic::error(
        "over-travel",
        format!(
            "between the words of this block {} would be {}: the control keeps the tip on its line while {}",
            machine.axes[over.joint].name,
            refusal::beyond(machine, over),
            turning(machine, ends)
        ),
    )
    .extreme(refusal::extreme(machine, over))
    .help(format!(
        "{FINDS_A_MOUNT}; or give the tool's length, or retract before the axes turn"
    ))
}
