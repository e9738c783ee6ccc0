//! What a motion asks of the machine's axes: their travel, at its ends and on its way, and their largest feeds.

use std::f64::consts::TAU;
use std::sync::Arc;

use post_machine::description::{Axis, Machine};
use post_machine::diagnostic::Diagnostic;
use post_machine::face_mode::FaceMode;
use post_machine::kinematics::MAX_AXES;
use post_machine::kinematics::travel::passed;
use post_machine::kinematics::{
    AxesWay, Joints, LinearMotion, Solver, TcpBlock, least_drive_minutes,
};
use post_machine::part_anywhere::{AxisEnds, AxisWay, needed};

use crate::{Curve, Interpolation, MachineState, Motion, MotionKind};

/// Distance beyond an end of travel that is rounding, mm or degrees.
const ROUNDED: f64 = 0.0015;

/// Share by which an axis may be faster than its largest feed, as printed feeds are rounded.
const SHARE: f64 = 0.01;

/// A block in which an axis would be so many times too fast has no time worth telling: its speed is no number to read.
const NO_TIME: f64 = 1e6;

/// Angles of one solution, radians: beside a pole they are known no better.
const SAME: f64 = 1e-4;

/// Most datums whose ways are kept; those of more are not known.
const MOST_DATUMS: usize = 64;

/// The tip of a tool misses the axis that its length moves by no more, mm of a mm.
const LEANS: f64 = 1e-6;

/// Places of a curve at which its axis values are looked at, of an arc for each turn: between three of them an axis
/// goes on a parabola, up to 4e-6 of the radius.
const LOOKS: u32 = 64;

/// Most places of a curve at which its axis values are looked at.
const MOST_LOOKS: u32 = 4096;

/// An axis passes a limit.
#[derive(Clone, Debug)]
pub struct AxisFault {
    /// What messages call it: `over-travel`, `max-feed`.
    pub code: &'static str,
    /// What is to be said of it.
    pub message: String,
    /// By how much, mm or degrees, or these a minute.
    pub by: f64,
}

/// What is known of the axes of a machine.
#[derive(Clone, Debug)]
pub struct AxisLimitCheck {
    /// Minutes that each axis needs for one mm or radian.
    slowness: Joints,
    /// Legs drive the machine, each with a largest feed.
    driven: bool,
    /// Some axis has a largest feed.
    limited: bool,
    /// Nobody says where the part sits: the ways of the axes.
    anywhere: Option<Box<PartWays>>,
}

/// By what words an axis was moved last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Led {
    /// By none, or by such as leave open where it stands.
    Nowhere,
    /// By words of the part: those of the machine lead elsewhere on each mount.
    Part,
    /// By words of the machine: it stands where they say, wherever the part sits.
    Machine,
}

/// What positions of the part count from, as far as nobody says where that is: only ways from one of them are known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Datum {
    /// Name of the work offset.
    offset: Option<String>,
    /// Register of the length, and the tool.
    length: Option<(Option<u32>, Option<u32>)>,
}

impl Datum {
    /// Of positions in this state.
    fn of(state: &MachineState) -> Self {
        let length = (state.length_register.filter(|register| *register != 0), state.tool);
        Self {
            offset: state.work_offset.clone().filter(|_| state.offset_assumed),
            length: (state.length == 0.0).then_some(length),
        }
    }
}

/// Ways of the axes in words of the part, on a machine whose part may sit anywhere.
#[derive(Clone, Debug)]
struct PartWays {
    led: [Led; MAX_AXES],
    /// By what they count from, of no more than [`MOST_DATUMS`].
    ends: Vec<(Datum, AxisEnds)>,
    /// The state of the last motion, and the place of its datum.
    last: Option<(Arc<MachineState>, usize)>,
    /// The axis that the length of a tool moves; none where it may move any.
    depth: Option<usize>,
}

impl PartWays {
    fn new(machine: &Machine) -> Self {
        let depth = machine.lies_along().filter(|(_, miss)| *miss < LEANS).map(|(place, _)| place);
        Self { led: [Led::Nowhere; MAX_AXES], ends: Vec::new(), last: None, depth }
    }

    /// Where ways of this state are kept.
    fn place(&mut self, state: &Arc<MachineState>) -> Option<usize> {
        if let Some((last, place)) = &self.last
            && Arc::ptr_eq(last, state)
        {
            return Some(*place);
        }
        let datum = Datum::of(state);
        let place = match self.ends.iter().position(|(known, _)| *known == datum) {
            Some(place) => place,
            None if self.ends.len() < MOST_DATUMS => {
                self.ends.push((datum, AxisEnds::NONE));
                self.ends.len() - 1
            }
            None => return None,
        };
        self.last = Some((Arc::clone(state), place));
        Some(place)
    }

    /// Ways of an axis, those together that count from the same; with the work offset where there are several.
    fn of(&self, joint: usize) -> Vec<(Option<&str>, AxisEnds)> {
        let lengths = self.depth.is_none_or(|depth| depth == joint);
        let mut joined: Vec<(&Datum, AxisEnds)> = Vec::new();
        for (datum, ends) in self.ends.iter().filter(|(_, ends)| ends.of(joint).is_some()) {
            let same = |(known, _): &&mut (&Datum, AxisEnds)| {
                known.offset == datum.offset && (!lengths || known.length == datum.length)
            };
            match joined.iter_mut().find(same) {
                Some((_, known)) => known.join(joint, ends),
                None => joined.push((datum, ends.clone())),
            }
        }
        let several = joined.iter().any(|(datum, _)| datum.offset != joined[0].0.offset);
        let told = joined.into_iter().map(|(datum, ends)| {
            let offset = datum.offset.as_deref().filter(|_| several);
            (offset, ends)
        });
        told.collect()
    }

    fn take(&mut self, motion: &Motion, [least, most]: [&Joints; 2]) {
        for joint in 0..MAX_AXES {
            let moved = motion.from.joints[joint] != motion.to.joints[joint];
            if moved {
                self.led[joint] = match motion.machine {
                    false => Led::Part,
                    true if motion.way == Interpolation::Axes => Led::Machine,
                    true => Led::Nowhere,
                };
            }
            // One that stands counts from where it was led.
            if (moved || least[joint] != most[joint])
                && self.led[joint] == Led::Part
                && let Some(place) = self.place(&motion.state)
            {
                self.ends[place].1.take(joint, [least[joint], most[joint]], |_| motion.line);
            }
        }
    }
}

impl AxisLimitCheck {
    /// Of `machine`, before its first motion.
    pub fn new(machine: &Machine) -> Self {
        let slowness = machine.slowness();
        let driven = machine.legs().any(|leg| leg.max_feed.is_finite());
        Self {
            slowness,
            driven,
            limited: driven || slowness.iter().any(|slowness| *slowness > 0.0),
            anywhere: machine.part_sits_anywhere().then(|| Box::new(PartWays::new(machine))),
        }
    }

    /// What a motion asks too much of the axes: travel, and at feed their largest feeds.
    pub fn passed(&mut self, machine: &Machine, motion: &Motion) -> [Option<AxisFault>; 2] {
        let bend = bend_between_words(motion);
        let fed = motion.kind != MotionKind::Rapid;
        let fast = fed.then(|| self.too_fast(machine, motion, bend)).flatten();
        [self.over_travel(machine, motion, bend), fast]
    }

    /// An axis leaves its travel; `bend` is [`bend_between_words`] of the motion.
    pub fn over_travel(
        &mut self,
        machine: &Machine,
        motion: &Motion,
        bend: Option<f64>,
    ) -> Option<AxisFault> {
        if let Some(mode) = &motion.state.face {
            let mut close = motion.to.joints;
            let [from, to] = [&motion.from, &motion.to].map(|end| mode.real_place(&end.joints));
            close[mode.across] = mode.centre + FaceMode::nearest(from, to);
            return self.beyond(machine, motion, [&close, &motion.to.joints]);
        }
        if motion.way == Interpolation::Axes {
            return self.beyond(machine, motion, [&motion.to.joints; 2]);
        }
        let (mut least, mut most) = (motion.to.joints, motion.to.joints);
        match &motion.way {
            Interpolation::Axes => {}
            Interpolation::Tip(Curve::Straight) | Interpolation::TipAndAxis => {
                if !stays_inside(machine, motion, bend)
                    && let Some(slides) = kept_tip(motion, &Joints::default(), f64::INFINITY)
                {
                    let Some(slides) = slides else {
                        return flat_between(motion);
                    };
                    for joint in 0..machine.axes.len() {
                        if slides.least[joint] <= slides.most[joint] {
                            least[joint] = least[joint].min(slides.least[joint]);
                            most[joint] = most[joint].max(slides.most[joint]);
                        }
                    }
                }
            }
            Interpolation::Tip(_) | Interpolation::TipAndFrame(_) => {
                let mut last = [motion.from.joints; 2];
                for (place, joints) in looked(motion).enumerate() {
                    for joint in 0..machine.axes.len() {
                        let three = [last[0][joint], last[1][joint], joints[joint]];
                        let turn = if place > 0 { vertex(three) } else { three[2] };
                        least[joint] = least[joint].min(joints[joint]).min(turn);
                        most[joint] = most[joint].max(joints[joint]).max(turn);
                    }
                    last = [last[1], joints];
                }
            }
        }
        self.beyond(machine, motion, [&least, &most])
    }

    /// The first axis whose least or largest value lies beyond its travel.
    #[inline]
    fn beyond(
        &mut self,
        machine: &Machine,
        motion: &Motion,
        [least, most]: [&Joints; 2],
    ) -> Option<AxisFault> {
        if let Some(ways) = &mut self.anywhere {
            ways.take(motion, [least, most]);
        }
        for (joint, axis) in machine.axes.iter().enumerate() {
            let slack = ROUNDED * axis.unit();
            let ends = match &self.anywhere {
                None => [least[joint], most[joint]],
                Some(ways) if ways.led[joint] == Led::Machine => [motion.to.joints[joint]; 2],
                Some(_) => continue,
            };
            // Of most motions both are the end.
            let count = if ends[0] == ends[1] { 1 } else { 2 };
            for value in ends.into_iter().take(count) {
                if let Some(limit) = passed(axis.travel, value, slack) {
                    let by = libm::fabs(value - limit) / axis.unit();
                    let message = beyond_travel(axis, value, limit);
                    return Some(AxisFault { code: "over-travel", message, by });
                }
            }
        }
        None
    }

    /// What is to be said of travel at the end, where the part may sit anywhere: that it fits nowhere, or how much the
    /// program needs; with the line that leads farthest out along the first axis of which that is said.
    pub fn part_place(&self, machine: &Machine) -> Option<(u64, Diagnostic)> {
        let ways = self.anywhere.as_ref()?;
        let mut outside = Vec::new();
        let mut line = 0;
        for (joint, axis) in machine.axes.iter().enumerate() {
            for (offset, found) in ways.of(joint) {
                let Some(ends) = found.of(joint) else {
                    continue;
                };
                let ends = ends.map(|end| axis.reading(end));
                let travel = axis.travel.map(|travel| travel.map(|end| axis.reading(end)));
                let way = AxisWay { name: &axis.name, ends, travel };
                if way.is_too_long() {
                    let lines = found.lines(joint);
                    let [first, last] = lines.map(|line| line.to_string());
                    return Some((lines[0].max(lines[1]), way.too_long([&first, &last])));
                }
                let Some(mut outside_by) = way.outside(machine) else {
                    continue;
                };
                if let (true, Some([least, most])) = (outside.is_empty(), travel) {
                    let upwards = ends[1] - most > least - ends[0];
                    line = found.lines(joint)[usize::from(upwards)];
                }
                if let Some(offset) = offset {
                    outside_by.push_str(&format!(" ({offset})"));
                }
                if !outside.contains(&outside_by) {
                    outside.push(outside_by);
                }
            }
        }
        (!outside.is_empty()).then(|| (line, needed(&outside, "")))
    }

    /// An axis passes its largest feed, if the control does what the program says; `bend` is [`bend_between_words`] of the
    /// motion.
    pub fn too_fast(
        &self,
        machine: &Machine,
        motion: &Motion,
        bend: Option<f64>,
    ) -> Option<AxisFault> {
        if !self.limited || motion.minutes <= 0.0 || self.is_slow(motion, bend) {
            return None;
        }
        let (minutes, joint) = self.least_minutes(machine, motion, motion.minutes_at_fastest)?;
        let factor = minutes / motion.minutes_at_fastest;
        if factor <= 1.0 + SHARE {
            return None;
        }
        let (max_feed, turns) = match joint.checked_sub(MAX_AXES) {
            None => (machine.axes[joint].max_feed, machine.axes[joint].joint.rotary),
            Some(place) => machine.legs().nth(place).map(|leg| (leg.max_feed, leg.turns()))?,
        };
        let (most, unit) = match turns {
            true => (max_feed.to_degrees(), "°/min"),
            false => (max_feed, "mm/min"),
        };
        let name = machine.mover(joint);
        let speed = match factor > NO_TIME {
            true => "in next to no time".to_owned(),
            false => format!("at {:.1} {unit}", most * factor),
        };
        let message = format!("{name} would go {speed}, and its max_feed is {most:.1} {unit}");
        Some(AxisFault { code: "max-feed", message, by: most * (factor - 1.0) })
    }

    /// No axis passes its largest feed: where all go linearly as their ways tell; where the control keeps the tip as arms
    /// alone do, the speed of an axis differing from that of the whole way by half of its second derivative at most.
    fn is_slow(&self, motion: &Motion, bend: Option<f64>) -> bool {
        if self.driven || motion.state.face.is_some() {
            return false;
        }
        let (from, to) = (&motion.from.joints, &motion.to.joints);
        let straight = (motion.way == Interpolation::Axes).then_some(0.0);
        let Some(bend) = straight.or(bend) else {
            return false;
        };
        motion.state.solver.chain().joints().iter().enumerate().all(|(index, joint)| {
            let faster = if joint.rotary { 0.0 } else { 0.5 * bend };
            (libm::fabs(to[index] - from[index]) + faster) * self.slowness[index]
                <= motion.minutes_at_fastest
        })
    }

    /// The least time in which no axis passes its largest feed, minutes, and the axis that asks for it. Where the
    /// control keeps the tip, what the linear axes do between the words is bounded from the chain, at most 0.2 % too
    /// long; where it is less than `enough` minutes, no closer than that. A drive of a leg stands at [`MAX_AXES`] and its
    /// place.
    pub fn least_minutes(
        &self,
        machine: &Machine,
        motion: &Motion,
        enough: f64,
    ) -> Option<(f64, usize)> {
        if let Some(mode) = &motion.state.face {
            return self.least_on_face(mode, motion);
        }
        let curved = motion.way.is_curved();
        let follows = motion.way != Interpolation::Axes && !curved;
        let (mut most, mut at) = (0.0, None);
        let ends = motion.from.joints.iter().zip(&motion.to.joints).zip(&self.slowness);
        for (joint, (axis, ((from, to), slowness))) in machine.axes.iter().zip(ends).enumerate() {
            let minutes = libm::fabs(to - from) * slowness;
            if minutes > most && (!curved || axis.joint.rotary) {
                (most, at) = (minutes, Some(joint));
            }
        }
        let mut slowest = at.map(|joint| (most, joint));
        let mut take = |minutes: f64, joint: usize| {
            if minutes > slowest.map_or(0.0, |(most, _)| most) {
                slowest = Some((minutes, joint));
            }
        };
        if follows && let Some(slides) = slides(motion, &self.slowness, enough) {
            take(slides.minutes, slides.slowest);
        }
        if curved {
            let looks = f64::from(looks(motion));
            let mut last = motion.from.joints;
            for joints in looked(motion) {
                for joint in 0..machine.axes.len() {
                    let way = libm::fabs(joints[joint] - last[joint]) * looks;
                    take(way * self.slowness[joint], joint);
                }
                last = joints;
            }
        }
        if self.driven
            && let Some((minutes, place)) = drive_minutes(machine, motion, enough)
        {
            take(minutes, MAX_AXES + place);
        }
        slowest
    }
}

/// The least time in which no drive of a leg passes its largest feed, minutes, and the place of that leg: bounded where the
/// axes or the tip go straight, along other curves by looks at them.
fn drive_minutes(machine: &Machine, motion: &Motion, enough: f64) -> Option<(f64, usize)> {
    let ends = [&motion.from.joints, &motion.to.joints];
    let turns = motion.turns();
    let way = match &motion.way {
        Interpolation::Axes => AxesWay::Straight,
        Interpolation::Tip(Curve::Straight) if !turns => AxesWay::Straight,
        Interpolation::Tip(Curve::Straight) => {
            AxesWay::KeepingTip { solver: &motion.state.solver, along: 0.0 }
        }
        _ => {
            let places: Vec<Joints> =
                std::iter::once(motion.from.joints).chain(looked(motion)).collect();
            let share = places.len().saturating_sub(1) as f64;
            let pieces = places.windows(2).filter_map(|pair| {
                let ends = [&pair[0], &pair[1]];
                least_drive_minutes(machine.legs(), AxesWay::Straight, ends, enough / share)
            });
            let slowest = pieces.max_by(|a, b| a.0.total_cmp(&b.0))?;
            return Some((slowest.0 * share, slowest.1));
        }
    };
    least_drive_minutes(machine.legs(), way, ends, enough)
        .filter(|(minutes, _)| minutes.is_finite())
}

impl AxisLimitCheck {
    /// [`AxisLimitCheck::least_minutes`] in polar interpolation.
    fn least_on_face(&self, mode: &FaceMode, motion: &Motion) -> Option<(f64, usize)> {
        let joints = [&motion.from, &motion.to].map(|end| &end.joints);
        let [from, to] = joints.map(|joints| mode.real_place(joints));
        let turning = FaceMode::most_turn(from, to) * self.slowness[mode.turning];
        let across = libm::hypot(to[0] - from[0], to[1] - from[1]) * self.slowness[mode.across];
        let others = (0..MAX_AXES).filter(|place| ![mode.turning, mode.across].contains(place));
        let others = others.map(|place| {
            ((joints[1][place] - joints[0][place]).abs() * self.slowness[place], place)
        });
        let polar = [(turning, mode.turning), (across, mode.across)];
        polar
            .into_iter()
            .chain(others)
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|most| most.0 > 0.0)
    }
}

/// Number of places at which a curve is looked at.
fn looks(motion: &Motion) -> u32 {
    let turns = match motion.way.curve() {
        Curve::Arc { sweep, .. } => libm::fabs(*sweep) / TAU,
        // Axes of an arm go no straighter than the tool turns, nor than they do themselves.
        Curve::Straight => {
            let ends = motion.from.joints.iter().zip(&motion.to.joints);
            let axes = motion.state.solver.chain().joints().iter().zip(ends);
            let turns = axes.filter(|(axis, _)| axis.rotary).map(|(_, (from, to))| to - from);
            turns.map(libm::fabs).sum::<f64>() / TAU
        }
        Curve::Spline(_) => 1.0,
    };
    // Of a short arc a parabola needs three places.
    let looks = libm::ceil(turns * f64::from(LOOKS)) as u32;
    looks.clamp(4, MOST_LOOKS)
}

/// Where the parabola through three values at the same distances has its vertex, if that lies between them; else the
/// last.
fn vertex([a, b, c]: [f64; 3]) -> f64 {
    let bend = a - 2.0 * b + c;
    let slope = 0.5 * (c - a);
    match libm::fabs(slope) < libm::fabs(bend) {
        true => b - slope * slope / (2.0 * bend),
        false => c,
    }
}

/// Which of the solutions for its last pose a motion ends in, counted from 1; none where there is one alone.
pub(super) fn solution(machine: &Machine, motion: &Motion) -> Option<usize> {
    let solver = &motion.state.solver;
    let branches = solver.orient(&motion.to.pose, SAME).ok()?;
    if branches.count() < 2 {
        return None;
    }
    let pointing = machine.pointing();
    (0..branches.count())
        .find(|branch| {
            let set = solver.angles(&branches, *branch);
            pointing.iter().all(|joint| {
                let apart = set.joints[*joint] - motion.to.joints[*joint];
                let turns = libm::rint(apart / TAU);
                set.free >> joint & 1 == 1 || libm::fabs(apart - turns * TAU) <= SAME
            })
        })
        .map(|branch| branch + 1)
}

fn beyond_travel(axis: &Axis, value: f64, limit: f64) -> String {
    let unit = match axis.joint.rotary {
        true => "°",
        false => " mm",
    };
    format!(
        "{} would be at {:.3}{unit}, its travel ends at {:.3}{unit}",
        axis.name,
        axis.reading(value),
        axis.reading(limit)
    )
}

/// A bound on the second derivatives of the linear axes where the control keeps the tip on a straight line, mm; none
/// where it does not, or nothing is known of it. Words are rounded: the last place is in it.
pub(super) fn bend_between_words(motion: &Motion) -> Option<f64> {
    let (Interpolation::Tip(Curve::Straight) | Interpolation::TipAndAxis) = motion.way else {
        return None;
    };
    if motion.state.face.is_some() {
        return None;
    }
    let ends = [&motion.from.joints, &motion.to.joints];
    let bend = TcpBlock::bend_by_arms(&motion.state.solver, ends, motion.to.pose.tip);
    bend.is_finite().then_some(bend + ROUNDED)
}

/// Where the control keeps the tip, its linear axes stay inside their travel between the words, as arms alone tell.
fn stays_inside(machine: &Machine, motion: &Motion, bend: Option<f64>) -> bool {
    let Some(bend) = bend else {
        return false;
    };
    // From the line between its ends an axis strays by an eighth of its second derivative.
    let bow = bend / 8.0;
    machine.axes.iter().enumerate().all(|(index, axis)| {
        let [from, to] = [motion.from.joints[index], motion.to.joints[index]];
        let inside = |value| passed(axis.travel, value, 0.0).is_none();
        axis.joint.rotary || inside(from.min(to) - bow) && inside(from.max(to) + bow)
    })
}

/// Linear axes that lie in one plane on the way would have to go without end to keep the tip. At rapid the control's own
/// way is anybody's guess.
fn flat_between(motion: &Motion) -> Option<AxisFault> {
    let message = "between the words the linear axes come to lie in one plane, and cannot keep the tip on its line";
    (motion.kind != MotionKind::Rapid).then(|| AxisFault {
        code: "out-of-reach",
        message: message.to_owned(),
        by: 0.0,
    })
}

/// [`kept_tip`], where that is known.
fn slides(motion: &Motion, slowness: &Joints, enough: f64) -> Option<LinearMotion> {
    kept_tip(motion, slowness, enough).flatten()
}

/// How the linear axes go while the control keeps the tip; none if nothing turns, or others than they place the tip. None
/// in that if they cannot follow, or nothing is proven of it. Times below `enough` minutes are looked into no closer.
fn kept_tip(motion: &Motion, slowness: &Joints, enough: f64) -> Option<Option<LinearMotion>> {
    let solver: &Solver = &motion.state.solver;
    let chain = solver.chain();
    let turns =
        chain.joints().iter().enumerate().any(|(index, joint)| {
            joint.rotary && motion.from.joints[index] != motion.to.joints[index]
        });
    if !turns || motion.kind == MotionKind::Rapid && slowness.iter().any(|slow| *slow > 0.0) {
        return None;
    }
    let (from, to) = (chain.traced(&motion.from.joints), chain.traced(&motion.to.joints));
    Some(TcpBlock::new(solver, 0.0, &from, &to)?.slides(slowness, enough))
}

/// Where the axes stand at each of the [`looks`] places along a curve, its end the last: up to where they cannot
/// follow.
pub(super) fn looked(motion: &Motion) -> impl Iterator<Item = Joints> + '_ {
    let looks = looks(motion);
    let ends = [&motion.from, &motion.to];
    (1..=looks).map_while(move |look| {
        if look == looks {
            return Some(motion.to.joints);
        }
        let share = f64::from(look) / f64::from(looks);
        let at = |near| motion.way.joints_at(&motion.state.solver, ends, share, near);
        at(&motion.from.joints).ok()
    })
}
