//! Detours between two cuts: rapids that go where neither the course nor the machine file leads.

use std::f64::consts::TAU;

use post_machine::axis_words::is_depth;
use post_machine::description::Machine;
use post_machine::kinematics::orientation::on_two_faces;
use post_machine::kinematics::{Joints, Pose};

use super::retract;
use crate::Motion;

/// Ends of rapids that are remembered between two cuts, and as many places that are asked for.
const MOST: usize = 64;

/// A tool that leans by less than this, radians, is on the same line.
const SAME_LINE: f64 = 1e-3;

/// Where a tool goes between two cuts: to the places that are asked for, and on the line of the tool at one of them as
/// far off as it likes, and from over such a place down to it by the depth axis. Anywhere else each axis that it moves
/// stands between where it stands at those places, or where the machine file sends it (`retract`, `leave`, `change`,
/// `park`); the depth may be drawn back farther than at all of them. A retract in positions of the machine leads as far
/// as the machine file says. Where a way of the course leads the tip, its axes stand as that asks. In a program that was
/// posted for this machine file, rotary axes turn where the tool is retracted, or with the tip on a way of the course or
/// on the line of the tool at one of its places, and other axes stand between those places only if the tool was
/// retracted; in another program nothing is said of the other axes while one turns. An arm is held by its tip, not by its
/// axes: in a program that was posted it stands on a way of the course or on the line of the tool at one of its places, or
/// the tool is retracted; in another it comes no lower than at all places that are asked for, as the tool stands there
/// (between two faces of the part, in the box that these places span). No rapid goes down to where the last cut ended but
/// on the line of the tool there. Of a machine whose ways between
/// passes are those that bodies leave (`low_retracts`, `link`) it is said of positions of the machine alone that the
/// depth goes no deeper than at all places that are asked for, and nothing of where axes turn: that is a matter of
/// clearance.
#[derive(Debug, Default)]
pub(super) struct Detour {
    asked: Vec<AskedPlace>,
    /// Places of the course that were passed on the way to others.
    passed: Vec<Pose>,
    open: Vec<RapidEnd>,
}

/// A place of the course.
#[derive(Clone, Copy, Debug)]
struct AskedPlace {
    joints: Joints,
    pose: Pose,
    /// The last cut ended there.
    left: bool,
}

/// How far a rapid may end from what is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct RapidAllowance {
    /// Of linear axes, mm, and of rotary ones, radians.
    pub axes: [f64; 2],
    /// By how much the tool may lean otherwise, radians.
    pub lean: f64,
    /// Rotary axes place the tip: its place is looked at, not theirs.
    pub arm: bool,
}

/// Where a rapid ends that nothing asks for.
#[derive(Clone, Copy, Debug)]
struct RapidEnd {
    line: u64,
    number: Option<u64>,
    from: Joints,
    /// Where the tool came from.
    came: Pose,
    /// The program has said before where the tool goes.
    sent: bool,
    joints: Joints,
    pose: Pose,
    machine: bool,
    /// A way of the course leads the tip past it.
    led: bool,
    /// So many places were asked for before.
    behind: usize,
}

/// How a rapid went astray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StrayKind {
    /// An axis stands where nothing sends it.
    Far,
    /// A retract is too short.
    Short,
    /// A rotary axis turns where the tool is neither on the course nor retracted.
    Turns,
    /// The tip of an arm stands where nothing sends it.
    Tip,
    /// The tip of an arm stands lower than at all places that are asked for.
    Low,
}

/// A rapid that went astray.
#[derive(Debug)]
pub(super) struct StrayRapid {
    pub line: u64,
    pub number: Option<u64>,
    /// The axis, and how far it is from all where it could stand, or how far it turns: mm or degrees. Of an arm's tip how far
    /// that is, mm.
    pub axis: usize,
    pub by: f64,
    pub kind: StrayKind,
    /// It goes to positions of the machine.
    pub machine: bool,
}

impl Detour {
    /// A rapid ended; `asked` if the course leads there too, `led` if it leads the tip past there, `known` if it leads
    /// to where the rapid began.
    pub fn take(&mut self, motion: &Motion, [asked, led]: [bool; 2], known: bool) {
        if known && self.asked.is_empty() {
            self.ask(&motion.from.joints, &motion.from.pose, true);
        }
        if asked {
            self.ask(&motion.to.joints, &motion.to.pose, false);
        } else if self.open.len() < MOST {
            self.open.push(RapidEnd {
                line: motion.line,
                number: motion.number,
                from: motion.from.joints,
                came: motion.from.pose,
                sent: motion.led != 0,
                joints: motion.to.joints,
                pose: motion.to.pose,
                machine: motion.machine,
                led,
                behind: self.asked.len() + self.passed.len(),
            });
        }
    }

    /// A rapid passed a place of the course: another may end there.
    pub fn passes(&mut self, pose: Pose) {
        if self.passed.len() < MOST {
            self.passed.push(pose);
        }
    }

    /// A cut begins with `motion`, or the program ends: was there a rapid that went farther than `allowed` from all
    /// that is asked for? The first.
    pub fn end(
        &mut self,
        machine: &Machine,
        motion: Option<&Motion>,
        own: bool,
        allowed: RapidAllowance,
    ) -> Option<StrayRapid> {
        if let Some(motion) = motion {
            self.ask(&motion.from.joints, &motion.from.pose, false);
        }
        let asked = std::mem::take(&mut self.asked);
        let open = std::mem::take(&mut self.open);
        let passed = std::mem::take(&mut self.passed);
        if asked.is_empty() {
            return None;
        }
        let allowed = RapidAllowance { lean: allowed.lean + SAME_LINE, ..allowed };
        let RapidAllowance { axes: slack, lean, arm } = allowed;
        let passed = &passed;
        let on_a_line = |end: &RapidEnd| {
            let mut places = asked.iter().map(|asked| &asked.pose).chain(passed);
            !end.machine && places.any(|pose| end.on_the_line(pose, slack[0], lean))
        };
        let goes = |(place, end): &(usize, &RapidEnd)| {
            let mut passed = passed.iter();
            let next = open.get(place + 1).filter(|next| on_a_line(next));
            !end.machine
                && (passed.any(|pose| end.on_the_line(pose, slack[0], lean))
                    || !arm && next.is_some_and(|next| end.is_over(next, machine, slack)))
        };
        // An arm that is led to such a place has other values there than at the points that are asked for, and what turns
        // first has them already.
        let led: Vec<Joints> =
            open.iter().filter(|end| on_a_line(end)).map(|end| end.joints).collect();
        let open_ends = &open;
        let mut open = open.iter().enumerate().filter(|end| !goes(end));
        open.find_map(|(place, end)| {
            let poses = asked.iter().map(|asked| &asked.pose).chain(passed);
            // Ways that bodies leave are proven, wherever axes turn on them.
            let proven = machine.clearance.shortens_ways();
            match end.turns(machine, slack) {
                Some(_) if own && proven => None,
                _ if arm && own && !end.machine && !proven => {
                    end.tip_astray(machine, poses, slack[0])
                }
                _ if arm && !own && !end.machine => {
                    // Another hand may have it come from anywhere, and go home in the end.
                    let came = end.behind > 0 || open_ends[..place].iter().any(on_a_line);
                    let goes_on = motion.is_some() || end.behind < asked.len() + passed.len();
                    (came && goes_on).then(|| end.tip_low(&asked, poses, slack[0])).flatten()
                }
                Some(turns) if own => {
                    // The length of the tool may have been called off since it came there.
                    let before = place.checked_sub(1).map(|before| &open_ends[before]);
                    let before = before.filter(|before| before.joints == end.from);
                    let came = before.map_or(&end.came, |before| &before.pose);
                    end.turns_astray(machine, turns, came, poses, allowed)
                }
                _ if end.led && (own || end.leans_as(&asked, lean)) => None,
                _ => {
                    let retracted = retract::is_retracted(machine, &end.from, slack[0]);
                    let between = !own || proven || retracted;
                    end.astray(machine, &asked, &led, between, allowed)
                }
            }
        })
    }

    fn ask(&mut self, joints: &Joints, pose: &Pose, left: bool) {
        if self.asked.len() == MOST {
            self.asked.remove(0);
        }
        self.asked.push(AskedPlace { joints: *joints, pose: *pose, left });
    }
}

impl RapidEnd {
    /// The first rotary axis that turns, where words of the part say so.
    fn turns(&self, machine: &Machine, slack: [f64; 2]) -> Option<usize> {
        let turns = |place: &usize| {
            let turned = libm::fabs(self.joints[*place] - self.from[*place]);
            machine.axes[*place].joint.rotary && turned > slack[1]
        };
        let mut places = 0..machine.axes.len();
        places.find(turns).filter(|_| !self.machine)
    }

    /// An axis turns neither on a way of the course, nor with the tip on the line of the tool at one of its places, nor
    /// with the tool retracted: drawn back as far as `leave` says where that says no more, or where no one knows of the tool
    /// as a program begins.
    fn turns_astray<'p>(
        &self,
        machine: &Machine,
        axis: usize,
        came: &Pose,
        mut poses: impl Iterator<Item = &'p Pose>,
        RapidAllowance { axes: [slack, _], lean, .. }: RapidAllowance,
    ) -> Option<StrayRapid> {
        let leaves = retract::drawn_back(machine);
        let sent = |pose: &Pose| {
            let back = |distance: f64| {
                let out = (came.tip - pose.tip).dot(&pose.axis);
                on_the_line(came, pose, slack, lean) && out >= distance - slack
            };
            self.off_line(pose, slack) <= slack || leaves.is_some_and(back)
        };
        if retract::stays_retracted(machine, [&self.from, &self.joints], slack)
            || self.led
            || leaves.is_some() && !self.sent
            || poses.any(sent)
        {
            return None;
        }
        let turned = libm::fabs(self.joints[axis] - self.from[axis]);
        Some(self.stray(axis, turned / machine.axes[axis].unit(), StrayKind::Turns))
    }

    /// The tip of an arm stands neither on a way of the course, nor on the line of the tool at one of its places, nor is the
    /// tool retracted.
    fn tip_astray<'p>(
        &self,
        machine: &Machine,
        poses: impl Iterator<Item = &'p Pose>,
        slack: f64,
    ) -> Option<StrayRapid> {
        let off = poses.map(|pose| self.off_line(pose, slack)).fold(f64::INFINITY, f64::min);
        let sent = self.led
            || off <= slack
            || retract::stays_retracted(machine, [&self.from, &self.joints], slack);
        (!sent).then(|| self.stray(0, off, StrayKind::Tip))
    }

    /// The tip of an arm stands lower than at all places that are asked for, as the tool stands there, or goes down to where
    /// the last cut ended. Where the tool stands on two faces of the part, past which side it goes from one to the other is
    /// its own business, but not between them: below all of those places, in the box that they span.
    fn tip_low<'p>(
        &self,
        asked: &[AskedPlace],
        mut poses: impl Iterator<Item = &'p Pose>,
        slack: f64,
    ) -> Option<StrayRapid> {
        let first = &asked.first()?.pose.axis;
        let faces = asked.iter().any(|asked| on_two_faces(first, &asked.pose.axis));
        if self.led || poses.any(|pose| self.off_line(pose, slack) <= slack) {
            return None;
        }
        let tips = || asked.iter().map(|asked| asked.pose.tip);
        let least = tips().reduce(|least, tip| least.inf(&tip)).unwrap_or_default();
        let most = tips().reduce(|most, tip| most.sup(&tip)).unwrap_or_default();
        let tip = &self.pose.tip;
        if faces && (tip.inf(&least) != least || tip.sup(&most) != most) {
            return None;
        }
        let falls = |pose: &Pose| (self.came.tip - self.pose.tip).dot(&pose.axis) > slack;
        let below = |pose: &Pose| (pose.tip - self.pose.tip).dot(&pose.axis);
        let places = asked.iter().filter(|asked| !asked.left || !falls(&asked.pose));
        let by = places.map(|asked| below(&asked.pose)).fold(f64::INFINITY, f64::min);
        (by > slack && by.is_finite()).then(|| self.stray(0, by, StrayKind::Low))
    }

    /// How far the tip is off the line of a tool at a place of the course, from `slack` mm below that place outwards, mm.
    fn off_line(&self, asked: &Pose, slack: f64) -> f64 {
        let way = self.pose.tip - asked.tip;
        let along = way.dot(&asked.axis);
        match along >= -slack {
            true => (way - asked.axis * along).norm(),
            false => way.norm(),
        }
    }

    fn stray(&self, axis: usize, by: f64, kind: StrayKind) -> StrayRapid {
        let Self { line, number, machine, .. } = *self;
        StrayRapid { line, number, axis, by, kind, machine }
    }

    /// The axis that is farthest from where it could stand: between two places that are asked for, if `between`, or where
    /// it is `led` on the line of the tool at one.
    fn astray(
        &self,
        machine: &Machine,
        asked: &[AskedPlace],
        led: &[Joints],
        between: bool,
        allowed: RapidAllowance,
    ) -> Option<StrayRapid> {
        let RapidAllowance { axes: slack, lean, .. } = allowed;
        let mut places = asked.iter().map(|asked| &asked.pose);
        if !self.machine && places.any(|pose| self.on_the_line(pose, slack[0], lean)) {
            return None;
        }
        // While the part turns or the head swings, the linear axes go round with it: but the depth goes no deeper than
        // at all places that are asked for.
        let proven = self.machine && machine.clearance.shortens_ways();
        let goes_round = proven || !self.machine && self.turns(machine, slack).is_some();
        let mut worst: Option<(f64, StrayRapid)> = None;
        for (place, axis) in machine.axes.iter().enumerate() {
            if goes_round && !is_depth(machine, place) {
                continue;
            }
            let rotary = axis.joint.rotary;
            let slack = slack[usize::from(rotary)];
            let value = self.joints[place];
            // What stands is led nowhere.
            if libm::fabs(value - self.from[place]) <= slack {
                continue;
            }
            let (mut by, mut kind) = (f64::INFINITY, StrayKind::Far);
            let mut allow = |other: f64| {
                let mut apart = value - other;
                if rotary {
                    apart -= TAU * libm::rint(apart / TAU);
                }
                by = by.min(libm::fabs(apart));
            };
            // Down to where the last cut ended it goes on the line of the tool there alone.
            let away = axis.joint.direction.dot(&machine.tool_axis).signum();
            let falls = is_depth(machine, place) && away * (value - self.from[place]) < 0.0;
            let others = asked.iter().any(|asked| !asked.left);
            let sends = |asked: &&AskedPlace| !(asked.left && falls && others && !self.machine);
            let asked = || asked.iter().filter(sends);
            asked().for_each(|asked| allow(asked.joints[place]));
            if !is_depth(machine, place) {
                led.iter().for_each(|led| allow(led[place]));
            }
            let [least, most] = span(asked(), place);
            if between || self.machine || goes_round {
                allow(value.clamp(least, most.max(least)));
            }
            let frame = &machine.frame;
            let named = [&frame.retract, &frame.aside, &frame.change, &frame.park];
            for (other, value) in named.into_iter().flatten() {
                if *other == place {
                    allow(*value);
                }
            }
            if is_depth(machine, place) {
                let retract = frame.retract.iter().find(|(other, _)| *other == place);
                let least = match retract {
                    Some((_, retract)) if self.machine && !proven => {
                        kind = StrayKind::Short;
                        away * retract
                    }
                    _ => {
                        let asked = asked().map(|asked| away * asked.joints[place]);
                        asked.fold(f64::INFINITY, f64::min)
                    }
                };
                by = by.min((least - away * value).max(0.0));
            }
            if by > slack && worst.as_ref().is_none_or(|(most, _)| by / slack > *most) {
                worst = Some((by / slack, self.stray(place, by / axis.unit(), kind)));
            }
        }
        worst.map(|(_, astray)| astray)
    }

    /// The tool comes from here to where `next` ends by the depth axis alone, which was drawn back.
    fn is_over(&self, next: &Self, machine: &Machine, slack: [f64; 2]) -> bool {
        let mut axes = machine.axes.iter().enumerate();
        self.turns(machine, slack).is_none()
            && next.from == self.joints
            && axes.all(|(place, axis)| {
                let down = self.joints[place] - next.joints[place];
                match is_depth(machine, place) {
                    true => down * axis.joint.direction.dot(&machine.tool_axis) >= 0.0,
                    false => libm::fabs(down) <= slack[usize::from(axis.joint.rotary)],
                }
            })
    }

    /// The tool stands on its own line through a place, at it or farther off.
    fn leans_as(&self, asked: &[AskedPlace], lean: f64) -> bool {
        asked.iter().any(|asked| (self.pose.axis - asked.pose.axis).norm() <= lean)
    }

    fn on_the_line(&self, asked: &Pose, slack: f64, lean: f64) -> bool {
        on_the_line(&self.pose, asked, slack, lean)
    }
}

/// The tool stands as at a place that is asked for, and on its own line through that, there or farther off.
fn on_the_line(pose: &Pose, asked: &Pose, slack: f64, lean: f64) -> bool {
    let way = pose.tip - asked.tip;
    let along = way.dot(&asked.axis);
    (pose.axis - asked.axis).norm() <= lean
        && along >= -slack
        && (way - asked.axis * along).norm() <= slack + lean * along
}

/// The least and the largest value of an axis at all places that are asked for.
fn span<'a>(asked: impl Iterator<Item = &'a AskedPlace>, place: usize) -> [f64; 2] {
    let values = asked.map(|asked| asked.joints[place]);
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    values.fold(ends, |[least, most], value| [least.min(value), most.max(value)])
}
